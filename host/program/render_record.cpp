// What a finished render says of itself, whatever its method.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "lab/sweep_pictures.hpp"
#include "program/effects.hpp"
#include "program/stats.hpp"

namespace clgi::program {
namespace {

AntiradianceSummary summary_of(const AntiradianceSolver& solver, const AntiradianceFrames& frames) {
    const AntiradianceStatus& status = frames.last;
    return {solver.elements().count(),
            solver.elements().leaves,
            solver.link_count(),
            solver.moving_links(),
            solver.options().bins,
            lab::name_of(status.iteration),
            frames.diverged,
            frames.given_up.count,
            frames.converged,
            status.lets_through,
            status.residuals.size(),
            status.residuals.empty() ? 0.0 : status.residuals.back(),
            1e3 * solver.linking_seconds()};
}

TransferSummary summary_of(const DynamicTransferSolver& solver, const Renderer& renderer,
                           std::size_t triangles) {
    return {solver.receivers().count, static_cast<std::uint32_t>(triangles),
            sh::terms(solver.options().masks.bands), renderer.transfer_view()->receiver_pixels()};
}

}  // namespace

void fill(RenderRecord& record, const Renderer& renderer, const Scene& scene) {
    record.build = renderer.options().picture.build;
    record.method = name_of(renderer.options().method);
    record.triangles = scene.triangles.size();
    record.lights = renderer.emitters().emitters.size();
    record.effects = effects_of(renderer);
    record.samples = renderer.samples();
    const RendererStatus status = renderer.status();
    record.status.non_finite = status.non_finite;
    record.warnings.insert(record.warnings.end(), status.warnings.begin(), status.warnings.end());
    if (const SecondOrderSolver* solver = renderer.second_order()) record.status = solver->status();
    record.bake = renderer.bake();
    if (const AntiradianceSolver* solver = renderer.antiradiance()) {
        record.antiradiance = summary_of(*solver, record.exchanges);
        for (const std::string& warning : troubles(renderer, record.exchanges))
            record.warnings.push_back(warning);
    }
    if (const IrradianceCache* solver = renderer.irradiance_cache())
        record.cache = solver->status();
    if (const DynamicTransferSolver* solver = renderer.dynamic_transfer())
        record.transfer = summary_of(*solver, renderer, scene.triangles.size());
}

std::vector<std::string> troubles(const Renderer& renderer, const AntiradianceFrames& exchanges) {
    const std::uint32_t all = renderer.status().non_finite;
    std::vector<std::string> out;
    const auto add = [&](std::uint32_t count, const char* what) {
        if (count > 0) out.push_back(fmt::format("{} {}", count, what));
    };
    if (const AntiradianceSolver* solver = renderer.antiradiance())
        return exchanges.warnings(solver->options(), all - solver->status().non_finite);
    if (const DynamicTransferSolver* solver = renderer.dynamic_transfer()) {
        const TransferStatus status = solver->status();
        add(status.bad_receivers, "vertices had positions or normals that were not finite");
        add(status.bad_blockers, "triangles were not finite and cast no shadow");
        add(status.bad_texels, "numbers of the environment were not finite and were read as 0");
        add(all, "packets of vertices or pixels had numbers that were not finite");
    } else if (renderer.light_atlas()) {
        add(all, "packets of pixels or texels held numbers that were not finite");
    } else {
        add(all, "packets of pixels had numbers that were not finite and were replaced");
    }
    return out;
}

std::string summary(const RenderRecord& record, const Renderer& renderer) {
    const double ms = lab::spread(record.frame_ms).median;
    const std::size_t frames = record.frame_ms.size();
    if (const auto& bake = record.bake)
        return fmt::format("{:.2f} s for {} texels lit by {} VPLs, {:.1f} ms a frame ({} frames)",
                           1e-3 * (bake->layout_ms + record.prepare_ms), bake->texels, bake->vpls,
                           ms, frames);
    if (const auto& exchange = record.antiradiance)
        return fmt::format(
            "{:.1f} ms a frame ({} frames, {} elements, {} links, {} of them moving, {} steps, "
            "{}), {:.2f} s to link",
            ms, frames, exchange->elements, exchange->links, exchange->moving_links,
            exchange->steps, exchange->iteration, 1e-3 * exchange->linking_ms);
    if (const auto& transfer = record.transfer)
        return fmt::format(
            "{:.1f} ms a frame ({} frames, {} receivers at vertices, {} at pixels, {} triangles)",
            ms, frames, transfer->receivers, transfer->receiver_pixels, transfer->triangles);
    if (const auto& cache = record.cache)
        return fmt::format(
            "{:.1f} ms a frame ({} frames, {} records seen, {} met and {} refined, {} reflections)",
            ms, frames, cache->seen, cache->met, cache->refined, cache->bounces);
    const SecondOrderOptions& options = renderer.second_order()->options();
    std::string out =
        fmt::format("{:.1f} ms a frame ({} frames, {} VPLs and {} negative VPLs, {} triangles)", ms,
                    frames, renderer.emitters().vpl_count,
                    options.indirect ? options.negative_vpls : 0, record.triangles);
    if (record.ask) out += "\n" + ask_line(*record.ask, ms);
    if (record.replicates)
        out += fmt::format(
            "\nmean of {} replicates: standard error {:.3g} % of the mean, of one alone {:.3g} %",
            record.replicates->count, 100.0 * record.replicates->error,
            100.0 * record.replicates->single_error);
    return out;
}

}  // namespace clgi::program
