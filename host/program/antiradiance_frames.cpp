// SPDX-License-Identifier: MIT
#include "program/antiradiance_frames.hpp"

#include <fmt/format.h>

#include "lab/sweep_pictures.hpp"

namespace clgi::program {
namespace {

// The first step of an iteration brings the light itself: its residual is 1 but for rounding.
constexpr double first_residual = 1.0 + 1e-5;

double residual_of(const AntiradianceStatus& status) {
    return status.residuals.empty() ? 1.0 : status.residuals.back();
}

// With a number of steps that was asked for, only growth is worth a word.
bool is_unsettled(const AntiradianceStatus& status, const AntiradianceOptions& options) {
    if (status.given_up || status.converged) return false;
    return options.steps == 0 || (options.steps > 1 && residual_of(status) > first_residual);
}

// Nothing of a single picture; " in 2 of 10 frames, first in frame 3".
std::string where(const FramesTold& told, int frames) {
    if (frames == 1) return "";
    return fmt::format(" in {} of {} frames, first in frame {}", told.count, frames, told.first);
}

}  // namespace

void FramesTold::add(int frame, const AntiradianceStatus& of) {
    if (count++ > 0) return;
    first = frame;
    status = of;
}

void AntiradianceFrames::add(int frame, const AntiradianceStatus& of,
                             const AntiradianceOptions& options) {
    ++count;
    last = of;
    diverged = diverged || of.diverged;
    converged = converged && of.converged;
    if (of.given_up) given_up.add(frame, of);
    if (is_unsettled(of, options)) unsettled.add(frame, of);
    non_finite += of.non_finite;
}

std::vector<std::string> AntiradianceFrames::warnings(const AntiradianceOptions& options,
                                                      std::uint32_t in_pictures) const {
    std::vector<std::string> out;
    if (given_up.count > 0)
        out.push_back(fmt::format(
            "the {} iteration diverged{}; the picture has no light that it would have brought. {}",
            lab::name_of(given_up.status.iteration), where(given_up, count),
            given_up.status.iteration == Iteration::symmetric && given_up.status.lets_through
                ? "Try --iteration asymmetric"
                : "Try --spread precise, more bins or a smaller --bin-share"));
    if (unsettled.count > 0)
        out.push_back(fmt::format("after {} steps the residual is {:.2g}, not below {:.2g}{}",
                                  unsettled.status.residuals.size(), residual_of(unsettled.status),
                                  options.steps == 0 ? options.residual : 1.0,
                                  where(unsettled, count)));
    if (non_finite + in_pictures > 0)
        out.push_back(
            fmt::format("{} leaves and {} packets of pixels held numbers that were not "
                        "finite",
                        non_finite, in_pictures));
    return out;
}

}  // namespace clgi::program
