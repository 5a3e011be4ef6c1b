// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "lab/sweep_antiradiance.hpp"
#include "lab/sweep_settings.hpp"

namespace clgi::lab {
namespace {

constexpr int most_bins = 1024;  // that are asked about an error, twice as many as are judged

PictureSetting named(PictureSetting one, const std::string& series) {
    const AntiradianceOptions& options = one.options.antiradiance;
    one.method = antiradiance_method;
    one.series = series;
    one.estimate = series != "grid" && 2 * options.bins <= most_bins;
    one.knobs = {{"bins", std::to_string(options.bins)},
                 {"elements", std::to_string(options.elements.requested)},
                 {"iteration", name_of(options.iteration)},
                 {"steps", options.steps == 0 ? "converged" : std::to_string(options.steps)},
                 {"spread", options.links.spread == clgi::Spread::precise ? "precise" : "none"},
                 {"bin-share", fmt::format("{:g}", options.links.bin_share)},
                 {"storage", one.options.picture.build.storage == Storage::half ? "half" : "full"}};
    return one;
}

}  // namespace

std::string name_of(Iteration iteration) {
    return iteration == Iteration::symmetric    ? "symmetric"
           : iteration == Iteration::asymmetric ? "asymmetric"
                                                : "auto";
}

std::vector<PictureSetting> antiradiance_settings(bool quick, const BuildOptions& build,
                                                  bool alone) {
    const bool few = quick || !alone;  // of each knob
    std::vector<PictureSetting> out;
    const auto add = [&](PictureSetting one, const std::string& series) {
        out.push_back(named(std::move(one), series));
    };
    PictureSetting base;
    base.options.method = Method::antiradiance;
    base.options.antiradiance.bins = few ? 64 : 128;
    base.options.antiradiance.elements.requested = few ? 1000 : 8192;
    base.options.picture.build = build;
    const auto bins = [](PictureSetting& to, int n) { to.options.antiradiance.bins = n; };
    const auto elements = [](PictureSetting& to, int n) {
        to.options.antiradiance.elements.requested = static_cast<std::size_t>(n);
    };
    const auto steps = [](PictureSetting& to, int n) { to.options.antiradiance.steps = n; };
    using Values = std::vector<int>;
    vary(base, "bins", few ? Values{32, 64, 128} : Values{64, 128, 208, 512, 1024}, bins, add);
    vary(base, "elements", few ? Values{250, 1000} : Values{500, 2000, 8192, 32768}, elements, add);
    vary(
        base, "iteration",
        std::vector<Iteration>{Iteration::symmetric, Iteration::asymmetric, Iteration::automatic},
        [](PictureSetting& to, Iteration kind) { to.options.antiradiance.iteration = kind; }, add);
    PictureSetting symmetric = base;
    symmetric.options.antiradiance.iteration = Iteration::symmetric;
    vary(symmetric, "steps", few ? Values{1, 4, 0} : Values{1, 2, 4, 8, 16, 0}, steps, add);
    vary(
        base, "spread", std::vector<clgi::Spread>{clgi::Spread::none, clgi::Spread::precise},
        [](PictureSetting& to, clgi::Spread kind) { to.options.antiradiance.links.spread = kind; },
        add);
    vary(
        base, "bin-share",
        few ? std::vector<double>{1.0, 0.5} : std::vector<double>{2.0, 1.0, 0.5, 0.25},
        [](PictureSetting& to, double share) { to.options.antiradiance.links.bin_share = share; },
        add);
    vary(
        base, "storage", std::vector<Storage>{Storage::half, Storage::full},
        [](PictureSetting& to, Storage kind) { to.options.picture.build.storage = kind; }, add);
    if (quick) return out;
    // Together. Rows of many elements with many bins would fill the memory of most devices, and
    // take longer than what other systems are compared at.
    const int most_numbers = alone ? 1 << 23 : 1 << 20;
    for (const int m : alone ? Values{64, 128, 208, 512} : Values{64, 128, 256})
        for (const int n : alone ? Values{2000, 8192, 32768} : Values{500, 2000, 8192})
            for (const int k : alone ? Values{4, 0} : Values{4, 8, 0}) {
                if (m * n > most_numbers) continue;
                PictureSetting one = base;
                bins(one, m);
                elements(one, n);
                steps(one, k);
                add(std::move(one), "grid");
            }
    return out;
}

}  // namespace clgi::lab
