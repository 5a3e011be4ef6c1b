// clgi render --method atlas: bakes the indirect light into an atlas, then shows the scene with it
// from any number of places.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "lab/preview.hpp"
#include "program/bake_common.hpp"
#include "program/effects.hpp"
#include "program/motion.hpp"
#include "program/percent.hpp"
#include "program/picture_record.hpp"
#include "program/render_flags.hpp"
#include "program/stats.hpp"

namespace clgi::program {
namespace {

void check(const RenderFlags& flags, const Scene& scene) {
    if (flags.gbuffer != "cl") throw Error("render: --gbuffer gl goes not with --method atlas");
    if (flags.atlas.vpls.count < 1)
        throw Error("render: --vpls is 0, at least 1 needed with --method atlas");
    check_camera("render", flags.camera, scene);
}

// What is baked: the scene, or what stands still of it, with what lights the rest.
struct Bake {
    Bake(const RenderFlags& flags, Scene& scene, const Session& session) {
        const AtlasFlags& atlas = flags.atlas;
        const bool quiet = flags.device.quiet;
        if (!flags.fps || !moves(scene)) {
            layout = lay_out(scene, atlas.vpls, atlas.layout, quiet);
            return;
        }
        StaticBake apart = lay_out_static(scene, atlas.vpls, atlas.layout, quiet);
        static_scene.emplace(session.context, session.device, apart.static_scene.scene);
        static_cast<clgi::BakeLayout&>(layout) = std::move(apart.layout);
        layout.seconds = apart.seconds;
        whole = std::move(apart.whole);
        volume = apart.volume;
        points = points_of(apart.volume);
    }

    const AtlasLayout& shown() const { return whole ? *whole : layout.atlas; }
    std::size_t bytes() const { return static_scene ? static_scene->bytes() : 0; }

    BakeLayout layout;
    std::optional<DeviceScene>
        static_scene;  // none: the scene itself is baked, and so for the others
    std::optional<AtlasLayout> whole;
    std::optional<IrradianceVolume> volume;
    std::vector<BakePoint> points;
};

}  // namespace

void run_atlas(RenderFlags flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    AtlasFlags& atlas_flags = flags.atlas;
    const bool quiet = flags.device.quiet;
    const double least_change = parse_percent("render", "--least-change", atlas_flags.least_change);
    Scene scene = scene_of(flags, true);
    check(flags, scene);
    prepare_motion(flags, scene);
    const Session session = session_of(flags);
    check_capacity("render", session.device, atlas_flags.vpls);

    Bake baked(flags, scene, session);
    const AtlasLayout& atlas = baked.shown();
    BakeSummary bake{baked.layout.vpls.vpls.size(), atlas.texels.size(), atlas.pages, atlas.size,
                     1e3 * baked.layout.seconds};
    const Stopwatch build;
    DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    atlas_flags.bake.build = build_of(flags.device);
    LightAtlasSolver solver(programs, session.queue,
                            baked.static_scene ? *baked.static_scene : device_scene,
                            baked.layout.vpls, baked.layout.atlas, atlas_flags.bake, baked.points);
    LightAtlasView view(programs, session.queue, device_scene, atlas, picture_options(flags),
                        baked.volume);
    Motion motion(flags, scene, device_scene, session.queue);
    RenderRecord record;
    record.build_ms = 1e3 * build.seconds();

    catch_interrupts();
    const Stopwatch baking;
    if (!solver.run(progress_bar("bake", quiet))) throw Interrupted();
    bake.bake_ms = 1e3 * baking.seconds();
    // The first picture warms up and is not timed.
    const Camera camera = scene.cameras[static_cast<std::size_t>(flags.camera)];
    view.render(camera, solver.irradiance_planes(), solver.stride()).wait();
    const auto picture = [&] { return lab::radiance_picture(session.queue, view.picture()); };
    for (int frame = 0; frame < flags.frames; ++frame) {
        const Stopwatch frame_watch;
        const Motion::Step step = motion.at(frame);
        if (step.lights) {  // the frame's time has the change of the bake in it
            if (baked.static_scene) baked.static_scene->set_lights(device_scene.lights());
            solver.lights_changed();
            view.lights_changed();
            if (!solver.update(least_change, [](double) { return !interrupted(); }))
                throw Interrupted();
        }
        view.render(step.camera, solver.irradiance_planes(), solver.stride());
        session.queue.finish();
        record.frame_ms.push_back(1e3 * frame_watch.seconds());
        record.passes.push_back(lab::pass_times(view.picture().events()));
        if (flags.fps) save_picture(picture(), numbered(flags.picture, frame));
        if (interrupted()) throw Interrupted();
    }
    if (!flags.fps) save_picture(picture(), flags.picture);

    motion.report();
    record.status.non_finite = view.picture().non_finite() + solver.status().non_finite;
    if (record.status.non_finite > 0)
        notice(false, fmt::format("warning: {} packets of pixels or texels held numbers that were "
                                  "not finite",
                                  record.status.non_finite));
    if (!quiet) {
        fmt::print("{}: {:.2f} s for {} texels lit by {} VPLs, {:.1f} ms a frame ({} frames)\n",
                   names_of(flags.picture), 1e-3 * (bake.layout_ms + bake.bake_ms), bake.texels,
                   bake.vpls, lab::spread(record.frame_ms).median, record.frame_ms.size());
    }
    if (flags.stats.empty()) return;
    record_picture(record, session, scene, device_scene, view.picture(),
                   solver.bytes() + view.picture().bytes() + baked.bytes());
    record.method = "atlas";
    record.effects = all_effects(device_scene, view.picture(), view.picture().options().direct);
    record.bake = bake;
    record.planned = flags.planned;
    save_stats(record, flags.stats);
}

}  // namespace clgi::program
