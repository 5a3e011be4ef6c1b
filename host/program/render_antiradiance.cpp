// clgi render --method antiradiance: light between elements without visibility, then the picture.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "lab/preview.hpp"
#include "lab/sweep_antiradiance.hpp"
#include "program/antiradiance_frames.hpp"
#include "program/bake_common.hpp"
#include "program/effects.hpp"
#include "program/motion.hpp"
#include "program/picture_record.hpp"
#include "program/render_flags.hpp"
#include "program/stats.hpp"

namespace clgi::program {
namespace {

const std::map<std::string, Iteration> iterations = {{"auto", Iteration::automatic},
                                                     {"symmetric", Iteration::symmetric},
                                                     {"asymmetric", Iteration::asymmetric}};
const std::map<std::string, Spread> spreads = {
    {"precise", Spread::precise}, {"gaussian", Spread::gaussian}, {"none", Spread::none}};

}  // namespace

void run_antiradiance(RenderFlags flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    const bool quiet = flags.device.quiet;
    Scene scene = scene_of(flags);
    if (flags.gbuffer != "cl")
        throw Error("render: --gbuffer gl goes not with --method antiradiance");
    check_camera("render", flags.camera, scene);
    prepare_motion(flags, scene);
    const Session session = session_of(flags);

    const Stopwatch build;
    DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    AntiradianceOptions options = flags.antiradiance.solver;
    options.iteration = iterations.at(flags.antiradiance.iteration);
    options.links.spread = spreads.at(flags.antiradiance.spread);
    options.elements.requested = static_cast<std::size_t>(flags.antiradiance.elements);
    options.emitters = flags.options.emitters;
    options.build = build_of(flags.device);
    if (flags.fps)
        options.poses = vertex_poses(scene, clip_of("render", scene, flags.animation),
                                     flags.antiradiance.poses);
    AntiradianceSolver solver(programs, session.queue, scene, device_scene, options);
    AntiradianceView view(programs, session.queue, device_scene, solver, picture_options(flags));
    Motion motion(flags, scene, device_scene, session.queue);
    RenderRecord record;
    AntiradianceFrames frames;
    record.build_ms = 1e3 * build.seconds();

    catch_interrupts();
    const auto bar = progress_bar("render", quiet);
    // The first picture warms up and is not timed; links are made for poses, so it is in one.
    if (solver.moving_elements() > 0) {
        if (motion.at(0).lights) solver.lights_changed();
        solver.geometry_changed();
    }
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
        if (solver.moving_elements() > 0) solver.geometry_changed();
        if (!solver.run([](double) { return !interrupted(); })) throw Interrupted();
        view.render(step.camera);
        session.queue.finish();
        record.frame_ms.push_back(1e3 * frame_watch.seconds());
        frames.add(frame, solver.status(), solver.options());
        std::vector<PassEvent> passes = solver.events();
        const std::vector<PassEvent>& shown = view.picture().events();
        passes.insert(passes.end(), shown.begin(), shown.end());
        record.passes.push_back(lab::pass_times(passes));
        if (flags.fps) save_picture(picture(), numbered(flags.picture, frame));
        if (interrupted()) throw Interrupted();
    }
    if (!flags.fps) save_picture(picture(), flags.picture);
    motion.report();

    const AntiradianceStatus& status = frames.last;
    const std::uint32_t in_pictures = view.picture().non_finite();
    record.status.non_finite = frames.non_finite + in_pictures;
    const std::vector<std::string> warnings = frames.warnings(solver.options(), in_pictures);
    for (const std::string& warning : warnings) notice(false, "warning: " + warning);
    const AntiradianceSummary summary{solver.elements().count(),
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
    if (!quiet) {
        fmt::print(
            "{}: {:.1f} ms a frame ({} frames, {} elements, {} links, {} of them moving, {} steps, "
            "{}), {:.2f} s to link\n",
            names_of(flags.picture), lab::spread(record.frame_ms).median, record.frame_ms.size(),
            summary.elements, summary.links, summary.moving_links, summary.steps, summary.iteration,
            1e-3 * summary.linking_ms);
    }
    if (flags.stats.empty()) return;
    record_picture(record, session, scene, device_scene, view.picture(),
                   solver.bytes() + view.bytes() + motion.bytes());
    record.method = "antiradiance";
    record.effects = all_effects(device_scene, view.picture(), true);
    if (solver.gloss().count > 0) record.effects.push_back("glossy-indirect");
    record.antiradiance = summary;
    record.planned = flags.planned;
    record.warnings.insert(record.warnings.end(), warnings.begin(), warnings.end());
    save_stats(record, flags.stats);
}

void add_antiradiance_flags(CLI::App& command, AntiradianceFlags& flags) {
    AntiradianceOptions& options = flags.solver;
    command.add_option("--bins", options.bins, "antiradiance: Bins of directions, a multiple of 4")
        ->type_name("N")
        ->check(CLI::Range(32, 4096));
    command
        .add_option("--elements", flags.elements,
                    "antiradiance: Parts that surfaces are cut to, about")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 24));
    command
        .add_option("--poses", flags.poses,
                    "antiradiance: Poses of the animation that links are made for, with --fps")
        ->type_name("N")
        ->check(CLI::Range(3, 200));
    command
        .add_option("--iteration", flags.iteration,
                    "antiradiance: How reflections and light that is let through alternate; auto: "
                    "symmetric, unless that diverges")
        ->type_name("KIND")
        ->check(CLI::IsMember({"auto", "symmetric", "asymmetric"}));
    command
        .add_option("--iterations", options.steps,
                    "antiradiance: Steps; 0: until the residual is below --residual")
        ->type_name("N")
        ->check(CLI::Range(0, 10000));
    command
        .add_option("--residual", options.residual,
                    "antiradiance: Change in a step at which it ends, of the light that arrives")
        ->type_name("X")
        ->check(CLI::Range(1e-6, 1.0));
    command
        .add_option("--least-gloss", options.least_gloss,
                    "antiradiance: Share of all light above which lobes count; 1: none does")
        ->type_name("X")
        ->check(CLI::Range(0.0, 1.0));
    command
        .add_option("--bin-share", options.links.bin_share,
                    "antiradiance: Size at which linked elements are refined, of a bin's solid "
                    "angle")
        ->type_name("X")
        ->check(CLI::PositiveNumber);
    command
        .add_option("--spread", flags.spread,
                    "antiradiance: How light from what is larger than a bin arrives in bins")
        ->type_name("KIND")
        ->check(CLI::IsMember({"precise", "gaussian", "none"}));
}

}  // namespace clgi::program
