// Frames in the light of an atlas: baked once, lit anew for every frame. [Schaerfig16, section 6.2]
// SPDX-License-Identifier: MIT
#include <clgi/advanced/bake_layout.hpp>
#include <clgi/advanced/light_atlas_view.hpp>
#include <clgi/error.hpp>
#include <clgi/light_atlas.hpp>
#include <optional>
#include <utility>

#include "lab/picture_methods.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_settings.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

struct AtlasPicture : SweepSetting {
    std::uint32_t vpls = 1600;
    int size = 256;
};

// The smallest pages that hold all charts, from the setting's on, up to `largest`; 0: none do.
int page_of(const Scene& scene, const AtlasPicture& one, int largest) {
    VplOptions vpls;
    vpls.count = one.vpls;
    AtlasOptions atlas;
    atlas.size = one.size;
    atlas.largest_size = largest;
    try {
        return make_bake_layout(scene, vpls, atlas).atlas.size;
    } catch (const InputError&) {  // charts that do not fit
        return 0;
    }
}

// The settings whose charts fit. Where those of the usual page do not, all pages are larger.
std::vector<AtlasPicture> settings_of(const Scene& scene, bool quick) {
    constexpr int largest_page = 4096;
    AtlasPicture base;
    if (quick) base = {{}, 400, 64};
    // Scenes of many small charts need larger pages than others.
    const int found = page_of(scene, base, largest_page);
    base.size = found > 0 ? found : largest_page;
    std::vector<AtlasPicture> out;
    const auto add = [&](AtlasPicture one, const std::string& series) {
        if (page_of(scene, one, one.size) == 0) return;
        one.method = light_atlas_method;
        one.series = series + ", atlas";
        one.knobs = {{"vpls", std::to_string(one.vpls)}, {"atlas-size", std::to_string(one.size)}};
        out.push_back(std::move(one));
    };
    vary(
        base, "vpls",
        quick ? std::vector<std::uint32_t>{50, 400} : std::vector<std::uint32_t>{100, 400, 1600},
        [](AtlasPicture& to, std::uint32_t n) { to.vpls = n; }, add);
    const int page = base.size;
    vary(
        base, "atlas-size",
        quick ? std::vector<int>{page / 2, page}
              : std::vector<int>{page / 4, page / 2, page, 2 * page},
        [](AtlasPicture& to, int n) { to.size = n; }, add);
    return out;
}

// warm: kernels have been built and run once.
Measured measure(const PictureTask& task, const AtlasPicture& one, bool warm, SweepPoint* result,
                 const Progress& part) {
    constexpr double slow = 1000.0;  // milliseconds
    const cl::CommandQueue& queue = task.setup.queue;
    Measured out;
    std::optional<BakeLayout> layout;
    out.once = time_frame(queue, [&] {
        VplOptions vpls;
        vpls.count = one.vpls;
        AtlasOptions atlas;
        atlas.size = one.size;
        layout = make_bake_layout(task.setup.scene, vpls, atlas);
    });
    LightAtlasOptions options;
    options.build = task.setup.build;
    const auto make = [&] {
        return LightAtlasSolver(task.programs, queue, task.scene, layout->vpls, layout->atlas,
                                options);
    };
    const auto bake = [&](LightAtlasSolver& solver) {
        if (!solver.run(part)) throw_cancelled();
    };
    if (!warm) {
        LightAtlasSolver first = make();
        bake(first);
    }
    LightAtlasSolver solver = make();
    LightAtlasViewOptions shown;
    shown.width = task.width;
    shown.height = task.height;
    shown.emitters.shadow_size = task.shadow_size;
    shown.build = task.setup.build;
    LightAtlasView view(task.programs, queue, task.scene, layout->atlas, shown);
    *out.once += time_frame(queue, [&] { bake(solver); });
    const auto picture = [&] {
        return view.render(task.camera, solver.irradiance_planes(), solver.stride());
    };
    picture().wait();
    for (int k = 0; k < 2 && out.again; ++k) {
        out.milliseconds.push_back(time_frame(queue, [&] {
            solver.lights_changed();
            view.lights_changed();
            solver.run();
            picture();
        }));
        out.again = out.milliseconds.back() <= slow;
    }
    out.non_finite = solver.status().non_finite + view.picture().non_finite();
    if (result) {
        result->picture = radiance_picture(queue, view.picture());
        judge(*result, task.truths);
    }
    return out;
}

}  // namespace

PictureMethod light_atlas_pictures(const PictureTask& task) {
    const std::vector<AtlasPicture> settings = settings_of(task.setup.scene, task.setup.quick);
    PictureMethod out;
    out.knobs = {"vpls", "atlas-size"};
    out.settings = names_of(settings);
    out.measure = [&task, settings, warm = false](std::size_t i, SweepPoint* result,
                                                  const Progress& part) mutable {
        return measure(task, settings[i], std::exchange(warm, true), result, part);
    };
    return out;
}

}  // namespace clgi::lab
