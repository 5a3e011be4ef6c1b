// clgi render SCENE -o out.exr [--png out.png]: from glTF to picture.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/clgi.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "core/opencl/timing.hpp"
#include "lab/preview.hpp"
#include "program/ask.hpp"
#include "program/bake_common.hpp"
#include "program/commands.hpp"
#include "program/effects.hpp"
#include "program/gl_frames.hpp"
#include "program/motion.hpp"
#include "program/render_flags.hpp"
#include "program/stats.hpp"
#include "program/threshold.hpp"

namespace clgi::program {
namespace {

void parse_low_res(const std::string& text, SecondOrderOptions& options) {
    if (text.empty()) return;
    const float threshold = parse_threshold("--low-res", text, {{"off", -1.0f}});
    if (threshold < 0.0f)
        options.low_resolution_step = 1;
    else
        options.discontinuity_threshold = threshold;
}

std::vector<std::string> effects_of(const DeviceScene& scene, const SecondOrderSolver& solver) {
    std::vector<std::string> out;
    const SecondOrderOptions& options = solver.options();
    const bool lit = options.indirect && solver.emitters().vpl_count > 0;
    if (options.direct) out = direct_effects(scene, solver.emitters());
    if (options.direct && scene.environment()) out.push_back("environment");
    if (lit) out.push_back("one-bounce");
    if (lit && options.negative_vpls > 0) out.push_back("negative-lights");
    return out;
}

void run_second_order(RenderFlags flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    parse_low_res(flags.low_res, flags.options);
    const TuningTarget request = request_of("render", flags.ask);
    const bool asked = request.frame_ms || request.error;
    if (asked && flags.method == "direct")
        throw Error(
            "render: --method direct has no settings to find; it excludes --target-error and "
            "--time-budget");
    if (flags.gbuffer == "gl" && (asked || flags.replicates > 1))
        throw Error("render: --gbuffer gl excludes --replicates, --target-error and --time-budget");
    flags.options.direct = !flags.no_direct;
    flags.options.indirect = flags.method != "direct";
    flags.options.build = build_of(flags.device);

    Scene scene = scene_of(flags);
    check_camera("render", flags.camera, scene);
    prepare_motion(flags, scene);
    const Camera camera = scene.cameras[flags.camera];
    std::optional<GlFrames> gl;
    if (flags.gbuffer == "gl") gl.emplace();
    const Session session =
        gl ? open_session(flags.device,
                          [&](const cl::Device& device) { return gl->properties(device); })
           : session_of(flags);

    const auto build_start = timing::Clock::now();
    DeviceScene device_scene(session.context, session.device, scene);
    SecondOrderSolver solver(session.queue, device_scene, flags.options);
    if (gl) gl->open(session.queue, device_scene, solver.options().build);
    Motion motion(flags, scene, device_scene, session.queue);
    if (flags.fps && motion.at(0).lights) solver.lights_changed();  // builds its kernels
    RenderRecord record;
    record.build_ms = timing::milliseconds(timing::Clock::now() - build_start);

    catch_interrupts();
    const auto bar = progress_bar("render", flags.device.quiet);
    // The first picture warms up and is not timed: some drivers compile on the first launch.
    if (gl) {
        gl->render(solver, camera).wait();
        if (!bar(1.0)) throw Interrupted();
    } else if (!solver.run(camera, [&](double done) { return bar(done); })) {
        throw Interrupted();
    }
    const auto go_on = [](double) { return !interrupted(); };
    if (asked) {
        const auto found =
            tune_second_order(session.queue, device_scene, solver, camera, request, go_on);
        if (!found || !solver.run(camera, nullptr)) throw Interrupted();
        record.ask = AskRecord{request, *found};
    }
    for (int frame = 0; frame < flags.frames; ++frame) {
        Camera at = camera;
        const auto step = [&] {
            const Motion::Step moved = motion.at(frame);
            at = moved.camera;
            if (moved.lights) solver.lights_changed();
        };
        if (!flags.fps) step();
        record.frame_ms.push_back(lab::time_frame(session.queue, [&] {
            if (flags.fps) step();  // the frame's time has the pose in it
            if (gl)
                gl->render(solver, at);
            else
                solver.render(at);
        }));
        record.passes.push_back(lab::pass_times(solver));
        if (flags.fps)
            save_picture(lab::radiance_picture(session.queue, solver),
                         numbered(flags.picture, frame));
        if (interrupted()) throw Interrupted();
    }
    motion.report();
    record.status = solver.status();
    if (flags.replicates > 1) {
        record.replicates = lab::replicate(session.queue, solver, camera, flags.replicates, go_on);
        if (!record.replicates) throw Interrupted();
        save_picture(record.replicates->mean, flags.picture);
    } else if (!flags.fps) {
        save_picture(lab::radiance_picture(session.queue, solver), flags.picture);
    }

    if (record.status.non_finite > 0)
        notice(
            false,
            fmt::format(
                "warning: {} packets of pixels had numbers that were not finite and were replaced",
                record.status.non_finite));
    if (gl) {
        record.gl_renderer = gl->renderer();
        record.gl_path = gl->path();
        notice(flags.device.quiet, fmt::format("OpenGL {}; {}", gl->renderer(), gl->path()));
        if (const std::uint32_t texels = gl->non_finite())
            notice(false, fmt::format("warning: {} texels of the G-buffer were not finite and "
                                      "became background",
                                      texels));
    }
    const lab::Spread times = lab::spread(record.frame_ms);
    if (record.ask) {
        const std::string warning = ask_warning(*record.ask);
        if (!warning.empty()) notice(false, warning);
    }
    if (!flags.device.quiet) {
        fmt::print(
            "{}: {:.1f} ms a frame ({} frames, {} VPLs and {} negative VPLs, {} "
            "triangles)\n",
            names_of(flags.picture), times.median, record.frame_ms.size(),
            solver.emitters().vpl_count,
            flags.options.indirect ? solver.options().negative_vpls : 0, scene.triangles.size());
        if (record.ask) fmt::print("{}\n", ask_line(*record.ask, times.median));
        if (record.replicates)
            fmt::print(
                "mean of {} replicates: standard error {:.3g} % of the mean, of one alone "
                "{:.3g} %\n",
                record.replicates->count, 100.0 * record.replicates->error,
                100.0 * record.replicates->single_error);
    }
    if (!flags.stats.empty()) {
        record.device = session.device;
        record.build = flags.options.build;
        record.gbuffer = flags.gbuffer;
        record.method = flags.method;
        record.triangles = scene.triangles.size();
        record.lights = solver.emitters().emitters.size();
        record.effects = effects_of(device_scene, solver);
        record.bytes = device_scene.bytes() + solver.bytes() + motion.bytes();
        record.warnings = scene.warnings;
        record.planned = flags.planned;
        save_stats(record, flags.stats);
    }
}

void refuse(bool wrong, const std::vector<std::string>& given, const std::string& why) {
    if (wrong && !given.empty()) throw Error("render: " + given.front() + " goes " + why);
}

void check_flags(const RenderFlags& flags) {
    const bool atlas = flags.method == "atlas", transfer = flags.method == "transfer";
    const bool antiradiance = flags.method == "antiradiance", plans = flags.method == "auto";
    const bool second_order = !atlas && !transfer && !antiradiance;
    refuse(!second_order, flags.second_order_only, "not with --method " + flags.method);
    refuse(!second_order, flags.asked, "not with --method " + flags.method);
    refuse(!plans, flags.auto_only, "only with --method auto");
    refuse(!atlas, flags.atlas_only, "only with --method atlas");
    refuse(!transfer, flags.transfer_only, "only with --method transfer");
    refuse(!antiradiance, flags.antiradiance_only, "only with --method antiradiance");
    refuse(transfer, flags.not_transfer, "not with --method transfer");
    refuse(antiradiance, flags.not_antiradiance, "not with --method antiradiance");
}

void run_render(RenderFlags flags) {
    // Flags of second-order illumination choose it, and so does a G-buffer by OpenGL.
    if (flags.method == "auto" && (!flags.second_order_asked.empty() || flags.gbuffer != "cl"))
        flags.method = "second-order";
    check_flags(flags);
    if (flags.method == "auto") plan_render(flags);
    if (flags.method == "atlas") return run_atlas(std::move(flags));
    if (flags.method == "transfer") return run_transfer(std::move(flags));
    if (flags.method == "antiradiance") return run_antiradiance(std::move(flags));
    run_second_order(std::move(flags));
}

}  // namespace

void add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a glTF scene");
    const auto flags = std::make_shared<RenderFlags>();
    SecondOrderOptions& options = flags->options;
    command->add_option("scene", flags->scene, ".gltf or .glb file")
        ->required()
        ->type_name("SCENE");
    add_picture_flags(*command, flags->picture, options.width, options.height);
    command
        ->add_option(
            "--method", flags->method,
            "auto: what the scene calls for (clgi plan), second-order where flags of it are given; "
            "atlas: many bounces, baked first; transfer: light of the "
            "environment with its shadows; antiradiance: many bounces, no visibility; "
            "direct: no indirect light")
        ->type_name("METHOD")
        ->check(
            CLI::IsMember({"auto", "second-order", "atlas", "transfer", "antiradiance", "direct"}));
    add_place_options(*command, flags->scene_index, flags->camera);
    command->add_option("--vpls", options.emitters.vpls, "VPLs of all emitters together")
        ->type_name("N")
        ->default_str(fmt::format("{}; atlas: {}", options.emitters.vpls, flags->atlas.vpls.count))
        ->check(CLI::Range(0, 1 << 20));
    command->add_option("--negative-vpls", options.negative_vpls, "Negative VPLs; 0: none")
        ->type_name("N")
        ->check(CLI::Range(0, 1 << 20));
    command
        ->add_option("--low-res", flags->low_res,
                     "Discontinuity threshold; off or 0: every pixel is gathered, inf: none")
        ->type_name("off|T")
        ->default_str(fmt::format("{}", options.discontinuity_threshold));
    command
        ->add_option("--low-res-step", options.low_resolution_step,
                     "Pixels between low-resolution points")
        ->type_name("N")
        ->check(CLI::IsMember({2, 4}));
    add_emitter_flags(*command, options.emitters);
    add_environment_flags(*command, flags->environment);
    add_bake_flags(*command, "atlas: ", flags->atlas.bake, flags->atlas.layout);
    command
        ->add_option(
            "--least-change", flags->atlas.least_change,
            "atlas, with --spin-light: change of a VPL's power that lights texels anew, of "
            "the mean power of VPLs")
        ->type_name("X");
    add_transfer_flags(*command, flags->transfer);
    add_antiradiance_flags(*command, flags->antiradiance);
    command->add_option("--gbuffer", flags->gbuffer, "What rasterises the camera's view")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"cl", "gl"}));
    add_ask_flags(*command, flags->ask);
    add_plan_flags(*command, flags->plan);
    command->add_flag("--no-direct", flags->no_direct,
                      "Leave out direct light, emission and the environment");
    add_animation_flags(*command, flags->animation);
    command->add_option("--frames", flags->frames, "Pictures to render and time; the last is kept")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    command
        ->add_option("--fps", flags->fps,
                     "Play the animation at F frames a second from --time on; every frame is kept, "
                     "FILE.0000.exr and so on")
        ->type_name("F")
        ->default_str("none");
    command
        ->add_option("--replicates", flags->replicates,
                     "Render N randomised replicates, keep the mean and its standard error")
        ->type_name("N")
        ->default_str("none")
        ->check(CLI::Range(2, 100000));
    command->add_flag("--orbit", flags->orbit, "Turn the camera around the scene over the frames");
    command->add_flag("--spin-light", flags->spin_light, "Turn the lights over the frames");
    command->add_option("--stats", flags->stats, "JSON file with times and settings")
        ->type_name("FILE")
        ->default_str("none");
    add_device_flags(*command, flags->device);
    command->callback([flags, command] {
        flags->second_order_only =
            given(*command, {"--negative-vpls", "--low-res", "--low-res-step", "--replicates"});
        flags->second_order_asked = flags->second_order_only;
        for (const std::string& flag :
             given(*command, {"--vpls", "--environment-lights", "--no-direct"}))
            flags->second_order_asked.push_back(flag);
        flags->shadow_size_given = command->count("--shadow-size") > 0;
        flags->face_size_given = command->count("--face-size") > 0;
        flags->area_samples_given = command->count("--area-samples") > 0;
        flags->asked = given(*command, {"--target-error", "--time-budget"});
        flags->auto_only = given(*command, {"--tolerance", "--with", "--without"});
        flags->atlas_only = given(*command, {"--bounces", "--atlas-size", "--hemicube-size",
                                             "--refine", "--least-change"});
        flags->transfer_only = given(
            *command, {"--sh-order", "--mask", "--table", "--mask-block", "--sh-window", "--coarse",
                       "--rings", "--per-pixel", "--probe-step", "--interreflections"});
        flags->antiradiance_only =
            given(*command, {"--bins", "--elements", "--iteration", "--iterations", "--residual",
                             "--least-gloss", "--bin-share", "--spread", "--poses"});
        flags->not_antiradiance = given(*command, {"--vpls", "--environment-lights"});
        flags->not_transfer = given(*command, {"--vpls", "--no-direct", "--environment-lights"});
        flags->atlas.bake.emitters = flags->options.emitters;
        if (command->count("--shadow-size") == 0)
            flags->atlas.bake.emitters.shadow_size = bake_emitters().shadow_size;
        if (command->count("--vpls") > 0)
            flags->atlas.vpls.count = static_cast<std::uint32_t>(flags->options.emitters.vpls);
        run_render(*flags);
    });
}

}  // namespace clgi::program
