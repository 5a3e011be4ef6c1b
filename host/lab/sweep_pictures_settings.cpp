// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <limits>

#include "lab/sweep_pictures.hpp"
#include "plan/tuning_models.hpp"

namespace clgi::lab {
namespace {

std::string low_resolution_text(const SecondOrderOptions& options) {
    if (options.low_resolution_step == 1) return "off";
    return fmt::format("{}/{:g}", options.low_resolution_step, options.discontinuity_threshold);
}

PictureSetting setting(const std::string& series, const SecondOrderOptions& options) {
    RendererOptions all;
    all.picture.emitters = options.emitters;
    all.picture.build = options.build;
    all.second_order = options;
    return {{second_order_method,
             series,
             {{"vpls", std::to_string(options.emitters.vpls)},
              {"negative-vpls", std::to_string(options.negative_vpls)},
              {"low-res", low_resolution_text(options)},
              {"shadow-size", std::to_string(options.emitters.shadow_size)},
              {"area-samples", std::to_string(options.emitters.area_samples)},
              {"math", options.build.math == Math::fast ? "fast" : "strict"},
              {"storage", options.build.storage == Storage::half ? "half" : "full"}}},
            all};
}

}  // namespace

std::vector<PictureSetting> second_order_settings(bool quick, const BuildOptions& build,
                                                  const SecondOrderFront* front) {
    SecondOrderOptions base;
    base.build = build;
    base.emitters.vpls = 300;
    base.negative_vpls = 150;
    std::vector<PictureSetting> out;
    const auto add = [&](const std::string& series, const SecondOrderOptions& options) {
        out.push_back(setting(series, options));
    };
    const std::vector<int> lights =
        quick ? std::vector<int>{30, 300, 3000} : std::vector<int>{30, 100, 300, 1000, 3000, 10000};
    SecondOrderOptions full = base;
    full.low_resolution_step = 1;
    full.emitters.shadow_size = 1024;
    for (const int negative : {0, 150})
        for (const int count : lights) {
            SecondOrderOptions options = full;
            options.emitters.vpls = count;
            options.negative_vpls = negative;
            add(negative == 0 ? "vpls, unshadowed" : "vpls", options);
        }
    for (const int negative :
         quick ? std::vector<int>{0, 500} : std::vector<int>{0, 50, 150, 500, 1500}) {
        SecondOrderOptions options = full;
        options.emitters.vpls = lights.back();
        options.negative_vpls = negative;
        add("negative-vpls", options);
    }
    constexpr float none = std::numeric_limits<float>::infinity();
    struct LowResolution {
        int step;
        float threshold;
    };
    const std::vector<LowResolution> low =
        quick ? std::vector<LowResolution>{{4, none}, {4, 0.02f}}
              : std::vector<LowResolution>{{4, none},   {4, 0.1f},  {4, 0.02f},
                                           {4, 0.005f}, {2, 0.02f}, {2, 0.005f}};
    for (const LowResolution& setting : low) {
        SecondOrderOptions options = base;
        options.low_resolution_step = setting.step;
        options.discontinuity_threshold = setting.threshold;
        add("low-res", options);
    }
    for (const int size :
         quick ? std::vector<int>{256, 1024} : std::vector<int>{256, 512, 1024, 2048}) {
        SecondOrderOptions options = full;
        options.emitters.shadow_size = size;
        options.emitters.face_size = size / 4;
        add("shadow-size", options);
    }
    for (const int samples : quick ? std::vector<int>{4} : std::vector<int>{1, 4, 16, 32}) {
        SecondOrderOptions options = full;
        options.emitters.area_samples = samples;
        add("area-samples", options);
    }
    for (const Storage storage : {Storage::full, Storage::half})
        for (const Math math : {Math::strict, Math::fast}) {
            SecondOrderOptions options = base;
            options.build.math = math;
            options.build.storage = storage;
            add("math", options);
        }
    if (!quick && front)
        for (std::size_t i = 0; i < front->refinements.size(); ++i)
            add("front",
                with_settings(base, settings_of(*front, {i, front->refinements[i].from_vpls})));
    // Together: only what lies near the front of the knobs alone.
    if (!quick)
        for (const int count : lights)
            for (const double share : {0.15, 0.5})
                for (const LowResolution& setting : {low[1], low[2], low[3]})
                    for (const int size : {512, 2048}) {
                        SecondOrderOptions options = base;
                        options.emitters.vpls = count;
                        options.negative_vpls = static_cast<int>(share * count);
                        options.low_resolution_step = setting.step;
                        options.discontinuity_threshold = setting.threshold;
                        options.emitters.shadow_size = size;
                        options.emitters.face_size = size / 4;
                        add("grid", options);
                    }
    return out;
}

}  // namespace clgi::lab
