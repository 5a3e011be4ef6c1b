// The settings of the methods that draw the pictures of a sweep.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <clgi/advanced/bake_layout.hpp>
#include <clgi/error.hpp>
#include <limits>
#include <utility>

#include "lab/sweep_pictures.hpp"
#include "plan/tuning_models.hpp"

namespace clgi::lab {
namespace {

using Values = std::vector<int>;

void name_second_order(PictureSetting& one) {
    const SecondOrderOptions& options = one.options.second_order;
    one.options.picture.emitters = options.emitters;
    one.options.picture.build = options.build;
    one.method = second_order_method;
    one.knobs = {{"vpls", std::to_string(options.emitters.vpls)},
                 {"negative-vpls", std::to_string(options.negative_vpls)},
                 {"low-res", options.low_resolution_step == 1
                                 ? "off"
                                 : fmt::format("{}/{:g}", options.low_resolution_step,
                                               options.discontinuity_threshold)},
                 {"shadow-size", std::to_string(options.emitters.shadow_size)},
                 {"area-samples", std::to_string(options.emitters.area_samples)},
                 {"math", options.build.math == Math::fast ? "fast" : "strict"},
                 {"storage", options.build.storage == Storage::half ? "half" : "full"}};
}

void name_antiradiance(PictureSetting& one) {
    constexpr int most_bins = 1024;  // that are asked about an error, twice as many as are judged
    const AntiradianceOptions& options = one.options.antiradiance;
    one.method = antiradiance_method;
    one.estimate = one.series != "grid" && 2 * options.bins <= most_bins;
    one.knobs = {{"bins", std::to_string(options.bins)},
                 {"elements", std::to_string(options.elements.requested)},
                 {"iteration", name_of(options.iteration)},
                 {"steps", options.steps == 0 ? "converged" : std::to_string(options.steps)},
                 {"spread", options.links.spread == clgi::Spread::precise ? "precise" : "none"},
                 {"bin-share", fmt::format("{:g}", options.links.bin_share)},
                 {"storage", one.options.picture.build.storage == Storage::half ? "half" : "full"}};
}

void name_light_atlas(PictureSetting& one) {
    one.method = light_atlas_method;
    one.knobs = {{"vpls", std::to_string(one.options.vpls.count)},
                 {"atlas-size", std::to_string(one.options.layout.size)}};
}

void name_dynamic_transfer(PictureSetting& one) {
    const DynamicTransferOptions& options = one.options.transfer;
    one.method = dynamic_transfer_method;
    one.knobs = {{"mask", std::to_string(options.masks.size)},
                 {"interreflections", std::to_string(options.interreflections)}};
}

// The smallest pages that hold all charts, from the setting's on, up to `largest`; 0: none do.
int page_of(const Scene& scene, const RendererOptions& options, int largest) {
    AtlasOptions layout = options.layout;
    layout.largest_size = largest;
    try {
        return make_bake_layout(scene, options.vpls, layout).atlas.size;
    } catch (const InputError&) {  // charts that do not fit
        return 0;
    }
}

}  // namespace

std::vector<PictureSetting> second_order_settings(bool quick, const BuildOptions& build,
                                                  const SecondOrderFront* front) {
    constexpr float none = std::numeric_limits<float>::infinity();
    using LowResolution = std::pair<int, float>;  // step, threshold
    const auto vpls = [](PictureSetting& to, int n) { to.options.second_order.emitters.vpls = n; };
    const auto negative = [](PictureSetting& to, int n) {
        to.options.second_order.negative_vpls = n;
    };
    const auto low = [](PictureSetting& to, const LowResolution& value) {
        to.options.second_order.low_resolution_step = value.first;
        to.options.second_order.discontinuity_threshold = value.second;
    };
    const auto shadows = [](PictureSetting& to, int n) {
        to.options.second_order.emitters.shadow_size = n;
        to.options.second_order.emitters.face_size = n / 4;
    };
    const auto samples = [](PictureSetting& to, int n) {
        to.options.second_order.emitters.area_samples = n;
    };
    SettingList<PictureSetting> list(quick, name_second_order);
    PictureSetting base;
    base.options.second_order.build = build;
    vpls(base, 300);
    negative(base, 150);
    PictureSetting full = base;
    full.options.second_order.low_resolution_step = 1;
    full.options.second_order.emitters.shadow_size = 1024;
    PictureSetting unshadowed = full, many = full;
    negative(unshadowed, 0);
    const Values lights = {30, 100, 300, 1000, 3000, 10000};
    vpls(many, quick ? 3000 : lights.back());
    list.vary("vpls, unshadowed", unshadowed, {30, 300, 3000}, lights, vpls);
    list.vary("vpls", full, {30, 300, 3000}, lights, vpls);
    list.vary("negative-vpls", many, {0, 500}, {0, 50, 150, 500, 1500}, negative);
    const std::vector<LowResolution> all_low = {{4, none},   {4, 0.1f},  {4, 0.02f},
                                                {4, 0.005f}, {2, 0.02f}, {2, 0.005f}};
    list.vary("low-res", base, quick ? std::vector<LowResolution>{{4, none}, {4, 0.02f}} : all_low,
              low);
    list.vary("shadow-size", full, {256, 1024}, {256, 512, 1024, 2048}, shadows);
    list.vary("area-samples", full, {4}, {1, 4, 16, 32}, samples);
    list.vary("math", base,
              std::vector<std::pair<Storage, Math>>{{Storage::full, Math::strict},
                                                    {Storage::full, Math::fast},
                                                    {Storage::half, Math::strict},
                                                    {Storage::half, Math::fast}},
              [](PictureSetting& to, const std::pair<Storage, Math>& value) {
                  to.options.second_order.build.storage = value.first;
                  to.options.second_order.build.math = value.second;
              });
    if (quick) return list.settings;
    if (front)
        for (std::size_t i = 0; i < front->refinements.size(); ++i) {
            PictureSetting one = base;
            one.options.second_order =
                with_settings(base.options.second_order,
                              settings_of(*front, {i, front->refinements[i].from_vpls}));
            list.add("front", std::move(one));
        }
    // Together: only what lies near the front of the knobs alone.
    for (const int count : lights)
        for (const double share : {0.15, 0.5})
            for (const std::size_t k : {1, 2, 3})
                for (const int size : {512, 2048}) {
                    PictureSetting one = base;
                    vpls(one, count);
                    negative(one, static_cast<int>(share * count));
                    low(one, all_low[k]);
                    shadows(one, size);
                    list.add("grid", std::move(one));
                }
    return list.settings;
}

std::string name_of(Iteration iteration) {
    return iteration == Iteration::symmetric    ? "symmetric"
           : iteration == Iteration::asymmetric ? "asymmetric"
                                                : "auto";
}

std::vector<PictureSetting> antiradiance_settings(bool quick, const BuildOptions& build,
                                                  bool alone) {
    const bool few = quick || !alone;  // of each knob
    const auto bins = [](PictureSetting& to, int n) { to.options.antiradiance.bins = n; };
    const auto elements = [](PictureSetting& to, int n) {
        to.options.antiradiance.elements.requested = static_cast<std::size_t>(n);
    };
    const auto iteration = [](PictureSetting& to, Iteration kind) {
        to.options.antiradiance.iteration = kind;
    };
    const auto steps = [](PictureSetting& to, int n) { to.options.antiradiance.steps = n; };
    SettingList<PictureSetting> list(few, name_antiradiance);
    PictureSetting base;
    base.options.method = Method::antiradiance;
    base.options.picture.build = build;
    bins(base, few ? 64 : 128);
    elements(base, few ? 1000 : 8192);
    PictureSetting symmetric = base;
    iteration(symmetric, Iteration::symmetric);
    list.vary("bins", base, {32, 64, 128}, {64, 128, 208, 512, 1024}, bins);
    list.vary("elements", base, {250, 1000}, {500, 2000, 8192, 32768}, elements);
    list.vary(
        "iteration", base,
        std::vector<Iteration>{Iteration::symmetric, Iteration::asymmetric, Iteration::automatic},
        iteration);
    list.vary("steps", symmetric, {1, 4, 0}, {1, 2, 4, 8, 16, 0}, steps);
    list.vary(
        "spread", base, std::vector<clgi::Spread>{clgi::Spread::none, clgi::Spread::precise},
        [](PictureSetting& to, clgi::Spread kind) { to.options.antiradiance.links.spread = kind; });
    list.vary(
        "bin-share", base,
        few ? std::vector<double>{1.0, 0.5} : std::vector<double>{2.0, 1.0, 0.5, 0.25},
        [](PictureSetting& to, double share) { to.options.antiradiance.links.bin_share = share; });
    list.vary("storage", base, std::vector<Storage>{Storage::half, Storage::full},
              [](PictureSetting& to, Storage kind) { to.options.picture.build.storage = kind; });
    if (quick) return list.settings;
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
                list.add("grid", std::move(one));
            }
    return list.settings;
}

std::vector<PictureSetting> light_atlas_settings(const Scene& scene, bool quick) {
    constexpr int largest_page = 4096;
    SettingList<PictureSetting> list(quick, name_light_atlas);
    PictureSetting base;
    base.options.method = Method::light_atlas;
    base.options.least_change = 0.0;  // a frame has a whole bake
    base.options.vpls.count = quick ? 400 : 1600;
    base.options.layout.size = quick ? 64 : 256;
    // Scenes of many small charts need larger pages than others.
    const int found = page_of(scene, base.options, largest_page);
    const int page = base.options.layout.size = found > 0 ? found : largest_page;
    list.vary("vpls, atlas", base, {50, 400}, {100, 400, 1600},
              [](PictureSetting& to, int n) { to.options.vpls.count = n; });
    list.vary("atlas-size, atlas", base, {page / 2, page}, {page / 4, page / 2, page, 2 * page},
              [](PictureSetting& to, int n) { to.options.layout.size = n; });
    std::erase_if(list.settings, [&](const PictureSetting& one) {
        return page_of(scene, one.options, one.options.layout.size) == 0;
    });
    return list.settings;
}

std::vector<PictureSetting> dynamic_transfer_settings(bool quick) {
    SettingList<PictureSetting> list(quick, name_dynamic_transfer);
    PictureSetting base;
    base.options.method = Method::dynamic_transfer;
    base.options.transfer.masks.size = 32;
    base.options.transfer.interreflections = 1;
    list.vary("mask, transfer", base, {16, 32}, {8, 16, 32, 64},
              [](PictureSetting& to, int n) { to.options.transfer.masks.size = n; });
    list.vary("interreflections, transfer", base, {0, 1}, {0, 1},
              [](PictureSetting& to, int n) { to.options.transfer.interreflections = n; });
    return list.settings;
}

}  // namespace clgi::lab
