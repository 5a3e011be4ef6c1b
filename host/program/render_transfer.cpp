// clgi render --method transfer: the environment's light, self-shadowed anew whenever geometry
// moves, beside the direct light of all other lights.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>

#include "lab/preview.hpp"
#include "program/bake_common.hpp"
#include "program/effects.hpp"
#include "program/motion.hpp"
#include "program/picture_record.hpp"
#include "program/render_flags.hpp"
#include "program/stats.hpp"
#include "program/threshold.hpp"

namespace clgi::program {
namespace {

DynamicTransferViewOptions view_options(const RenderFlags& flags) {
    DynamicTransferViewOptions out;
    out.picture = picture_options(flags);
    out.threshold =
        parse_threshold("--per-pixel", flags.transfer.per_pixel,
                        {{"off", std::numeric_limits<float>::infinity()}, {"all", 0.0f}});
    out.probe_step = flags.transfer.probe_step;
    return out;
}

std::vector<std::string> effects_of(const DeviceScene& scene, const DynamicTransferSolver& solver,
                                    const Picture& picture) {
    std::vector<std::string> out = direct_effects(scene, picture.emitters());
    if (scene.environment()) out.push_back("environment");
    if (scene.environment() && solver.glossy()) out.push_back("glossy-environment");
    if (scene.environment() && solver.options().bounces > 0) out.push_back("one-bounce");
    return out;
}

}  // namespace

void run_transfer(RenderFlags flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    const bool quiet = flags.device.quiet;
    const DynamicTransferViewOptions options = view_options(flags);
    Scene scene = scene_of(flags);
    if (flags.gbuffer != "cl") throw Error("render: --gbuffer gl goes not with --method transfer");
    check_camera("render", flags.camera, scene);
    prepare_motion(flags, scene);
    const Session session = session_of(flags);

    const Stopwatch build;
    DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    DynamicTransferSolver solver(
        programs, session.queue, scene, device_scene,
        vector_options("render", flags.transfer, scene, build_of(flags.device)));
    DynamicTransferView view(programs, session.queue, device_scene, solver, options);
    Motion motion(flags, scene, device_scene, session.queue);
    RenderRecord record;
    record.build_ms = 1e3 * build.seconds();

    catch_interrupts();
    const auto bar = progress_bar("render", quiet);
    // The first picture warms up and is not timed.
    if (!solver.run([&](double done) { return bar(done); })) throw Interrupted();
    view.render(scene.cameras[static_cast<std::size_t>(flags.camera)]).wait();
    const auto picture = [&] { return lab::radiance_picture(session.queue, view.picture()); };
    for (int frame = 0; frame < flags.frames; ++frame) {
        const Stopwatch frame_watch;
        const Motion::Step step = motion.at(frame);
        if (step.lights) {
            solver.lights_changed();
            view.lights_changed();
        }
        std::vector<PassEvent> passes;
        const auto keep = [&](const std::vector<PassEvent>& events) {
            passes.insert(passes.end(), events.begin(), events.end());
        };
        // Vectors stay good while nothing moves; a picture alone is drawn from none.
        if (flags.fps || frame == 0) {
            solver.transfer();
            session.queue.finish();
            keep(solver.events());
        }
        solver.light();
        session.queue.finish();
        keep(solver.events());
        view.render(step.camera);
        session.queue.finish();
        record.frame_ms.push_back(1e3 * frame_watch.seconds());
        if (solver.glossy()) keep(solver.events());
        keep(view.picture().events());
        record.passes.push_back(lab::pass_times(passes));
        if (flags.fps) save_picture(picture(), numbered(flags.picture, frame));
        if (interrupted()) throw Interrupted();
    }
    if (!flags.fps) save_picture(picture(), flags.picture);
    motion.report();

    const TransferStatus status = solver.status();
    const std::uint32_t in_picture = view.picture().non_finite();
    record.status.non_finite = status.non_finite + in_picture;
    warn_of(status, in_picture);
    const TransferSummary summary{solver.receivers().count,
                                  static_cast<std::uint32_t>(scene.triangles.size()),
                                  sh::terms(solver.options().masks.bands), view.receiver_pixels()};
    if (!quiet) {
        fmt::print(
            "{}: {:.1f} ms a frame ({} frames, {} receivers at vertices, {} at pixels, "
            "{} triangles)\n",
            names_of(flags.picture), lab::spread(record.frame_ms).median, record.frame_ms.size(),
            summary.receivers, summary.receiver_pixels, summary.triangles);
    }
    if (flags.stats.empty()) return;
    record_picture(record, session, scene, device_scene, view.picture(),
                   solver.bytes() + view.bytes() + motion.bytes());
    record.method = "transfer";
    record.effects = effects_of(device_scene, solver, view.picture());
    record.transfer = summary;
    record.planned = flags.planned;
    save_stats(record, flags.stats);
}

void add_transfer_flags(CLI::App& command, TransferFlags& flags) {
    add_vector_flags(command, "transfer: ", flags);
    command
        .add_option("--per-pixel", flags.per_pixel,
                    "transfer: Difference from the light between vertices at which pixels have "
                    "masks of their own; off: none, all")
        ->type_name("off|all|X");
    add_count(command, "--interreflections", flags.solver.bounces,
              "transfer: Times that light is reflected diffusely before it reaches what is seen", 0,
              1);
    add_count(command, "--probe-step", flags.probe_step,
              "transfer: Pixels between the probes that --per-pixel compares", 2, 64);
}

}  // namespace clgi::program
