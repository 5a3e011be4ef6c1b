// clgi render --method atlas: bakes the indirect light into an atlas, then shows the scene with it
// from any number of places.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "cli/bake_room.hpp"
#include "cli/effects.hpp"
#include "cli/motion.hpp"
#include "cli/percent.hpp"
#include "cli/picture_record.hpp"
#include "cli/render_flags.hpp"
#include "cli/stats.hpp"
#include "report/preview.hpp"

namespace clgi::cli {
namespace {

void check(const RenderFlags& flags, const Scene& scene) {
    if (flags.gbuffer != "cl") throw Error("render: --gbuffer gl goes not with --method atlas");
    if (flags.atlas.vpls.count < 1)
        throw Error("render: --vpls is 0, at least 1 needed with --method atlas");
    check_camera("render", flags.camera, scene);
}

// The bake of a scene that stands still, or of what stands still of it and what lights the rest.
class Bake {
public:
    Bake(const RenderFlags& flags, Scene& scene, const Session& session, bool quiet)
        : moves_(flags.fps && moves(scene)) {
        const AtlasFlags& atlas = flags.atlas;
        if (moves_)
            apart_ = lay_out_still(scene, atlas.vpls, atlas.layout, quiet);
        else
            layout_ = lay_out(scene, atlas.vpls, atlas.layout, quiet);
        if (moves_) still_.emplace(session.context, session.device, apart_.still.scene);
        apart_.still.scene = Scene();  // it is on the device
    }

    BakeSummary summary() const {
        const AtlasLayout& atlas = shown();
        return {layout().vpls.vpls.size(), atlas.texels.size(), atlas.pages, atlas.size,
                1e3 * (moves_ ? apart_.seconds : layout_.seconds)};
    }

    const clgi::BakeLayout& layout() const { return moves_ ? apart_.layout : layout_; }
    const AtlasLayout& shown() const { return moves_ ? apart_.whole : layout_.atlas; }
    std::optional<IrradianceVolume> volume() const {
        return moves_ ? std::optional(apart_.volume) : std::nullopt;
    }
    std::vector<BakePoint> points() const {
        return moves_ ? points_of(apart_.volume) : std::vector<BakePoint>();
    }

    // That is baked; whole: that is shown.
    const DeviceScene& scene(const DeviceScene& whole) const { return moves_ ? *still_ : whole; }
    void lights_changed(const DeviceScene& whole) {
        if (moves_) still_->set_lights(whole.lights());
    }
    std::size_t bytes() const { return moves_ ? still_->bytes() : 0; }

private:
    bool moves_;
    BakeLayout layout_;
    StillBake apart_;
    std::optional<DeviceScene> still_;
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
    need_room("render", session.device, atlas_flags.vpls);

    Bake baked(flags, scene, session, quiet);
    BakeSummary bake = baked.summary();
    const Stopwatch build;
    DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    atlas_flags.bake.build = build_of(flags.device);
    LightAtlasSolver solver(programs, session.queue, baked.scene(device_scene), baked.layout().vpls,
                            baked.layout().atlas, atlas_flags.bake, baked.points());
    LightAtlasView view(programs, session.queue, device_scene, baked.shown(),
                        picture_options(flags), baked.volume());
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
    const auto picture = [&] { return report::radiance_picture(session.queue, view.picture()); };
    for (int frame = 0; frame < flags.frames; ++frame) {
        const Stopwatch frame_watch;
        const Motion::Step step = motion.at(frame);
        if (step.lights) {  // the frame's time has the change of the bake in it
            baked.lights_changed(device_scene);
            solver.lights_changed();
            view.lights_changed();
            if (!solver.update(least_change, [](double) { return !interrupted(); }))
                throw Interrupted();
        }
        view.render(step.camera, solver.irradiance_planes(), solver.stride());
        session.queue.finish();
        record.frame_ms.push_back(1e3 * frame_watch.seconds());
        record.passes.push_back(report::pass_times(view.picture().events()));
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
                   bake.vpls, report::spread(record.frame_ms).median, record.frame_ms.size());
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

}  // namespace clgi::cli
