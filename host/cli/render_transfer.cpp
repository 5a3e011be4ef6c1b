// clgi render --method transfer: the environment's light, self-shadowed anew whenever geometry
// moves, beside the direct light of all other lights.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>

#include "cli/bake_room.hpp"
#include "cli/motion.hpp"
#include "cli/render_flags.hpp"
#include "cli/stats.hpp"
#include "report/preview.hpp"

namespace clgi::cli {
namespace {

float threshold_of(const std::string& text) {
    if (text == "off") return std::numeric_limits<float>::infinity();
    if (text == "all") return 0.0f;
    std::size_t used = 0;
    float value = -1.0f;
    try {
        value = std::stof(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used != text.size() || !(value >= 0.0f))
        throw Error(fmt::format(
            "render: --per-pixel is '{}', off, all or a threshold of at least 0 needed", text));
    return value;
}

DynamicTransferOptions solver_options(const RenderFlags& flags) {
    DynamicTransferOptions out = flags.transfer.solver;
    const TransferFlags& given = flags.transfer;
    out.masks.bands = given.order + 1;
    out.masks.planes = given.table > 0 ? EdgePlanes::table : EdgePlanes::exact;
    if (given.table > 0) out.masks.table_size = given.table;
    out.window = given.window == "hann"      ? sh::Window::hann
                 : given.window == "lanczos" ? sh::Window::lanczos
                                             : sh::Window::none;
    out.build = build_of(flags.device);
    return out;
}

DynamicTransferViewOptions view_options(const RenderFlags& flags) {
    DynamicTransferViewOptions out;
    out.picture.width = flags.options.width;
    out.picture.height = flags.options.height;
    out.picture.emitters = flags.options.emitters;
    out.picture.build = build_of(flags.device);
    out.threshold = threshold_of(flags.transfer.per_pixel);
    out.probe_step = flags.transfer.probe_step;
    return out;
}

std::vector<std::string> effects_of(const DeviceScene& scene, const DynamicTransferSolver& solver,
                                    const Picture& picture) {
    std::vector<std::string> out;
    if (!picture.emitters().emitters.empty()) out.push_back("direct");
    if (scene.has_lobes()) out.push_back("glossy-direct");
    if (!scene.emissive().empty()) out.push_back("emission");
    if (scene.environment()) out.push_back("environment");
    if (scene.environment() && solver.glossy()) out.push_back("glossy-environment");
    if (scene.environment() && solver.options().bounces > 0) out.push_back("one-bounce");
    return out;
}

void warn(const TransferStatus& status, std::uint32_t in_picture) {
    const auto say = [](std::uint32_t count, const char* what) {
        if (count > 0) notice(false, fmt::format("warning: {} {}", count, what));
    };
    say(status.bad_receivers, "vertices had positions or normals that were not finite");
    say(status.bad_blockers, "triangles were not finite and cast no shadow");
    say(status.bad_texels, "numbers of the environment were not finite and were read as 0");
    say(status.non_finite + in_picture,
        "packets of vertices or pixels had numbers that were not finite");
}

}  // namespace

void run_transfer(RenderFlags flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    const bool quiet = flags.device.quiet;
    const DynamicTransferViewOptions options = view_options(flags);
    Scene scene = open_scene(flags.scene, flags.scene_index, flags.environment, quiet);
    if (flags.gbuffer != "cl") throw Error("render: --gbuffer gl goes not with --method transfer");
    if (flags.camera >= static_cast<int>(scene.cameras.size()))
        throw Error(fmt::format("render: --camera is {}, the scene has {}", flags.camera,
                                scene.cameras.size()));
    prepare_motion(flags, scene);
    const Session session = open_session(flags.device);

    const Stopwatch build;
    DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    DynamicTransferSolver solver(programs, session.queue, scene, device_scene,
                                 solver_options(flags));
    DynamicTransferView view(programs, session.queue, device_scene, solver, options);
    Motion motion(flags, scene, device_scene, session.queue);
    RenderRecord record;
    record.build_ms = 1e3 * build.seconds();

    catch_interrupts();
    const auto bar = progress_bar("render", quiet);
    // The first picture warms up and is not timed.
    if (!solver.run([&](double done) { return bar(done); })) throw Interrupted();
    view.render(scene.cameras[static_cast<std::size_t>(flags.camera)]).wait();
    const auto picture = [&] { return report::radiance_picture(session.queue, view.picture()); };
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
        record.passes.push_back(report::pass_times(passes));
        if (flags.fps) save_picture(picture(), numbered(flags.picture, frame));
        if (interrupted()) throw Interrupted();
    }
    if (!flags.fps) save_picture(picture(), flags.picture);
    motion.report();

    const TransferStatus status = solver.status();
    const std::uint32_t in_picture = view.picture().non_finite();
    record.status.non_finite = status.non_finite + in_picture;
    warn(status, in_picture);
    const TransferSummary summary{solver.receivers().count,
                                  static_cast<std::uint32_t>(scene.triangles.size()),
                                  sh::terms(solver.options().masks.bands), view.receiver_pixels()};
    if (!quiet) {
        const bool both = !flags.picture.exr.empty() && !flags.picture.png.empty();
        fmt::print(
            "{}{}{}: {:.1f} ms a frame ({} frames, {} receivers at vertices, {} at pixels, "
            "{} triangles)\n",
            flags.picture.exr, both ? ", " : "", flags.picture.png,
            report::spread(record.frame_ms).median, record.frame_ms.size(), summary.receivers,
            summary.receiver_pixels, summary.triangles);
    }
    if (flags.stats.empty()) return;
    record.device = session.device;
    record.build = view.picture().options().build;
    record.method = "transfer";
    record.triangles = scene.triangles.size();
    record.lights = view.picture().emitters().emitters.size();
    record.effects = effects_of(device_scene, solver, view.picture());
    record.bytes = device_scene.bytes() + solver.bytes() + view.bytes() + motion.bytes();
    record.warnings = scene.warnings;
    record.transfer = summary;
    save_stats(record, flags.stats);
}

void add_transfer_flags(CLI::App& command, TransferFlags& flags) {
    add_count(command, "--sh-order", flags.order,
              "transfer: Highest degree of spherical harmonics; 4 has 25 terms", 0,
              sh::most_bands - 1);
    command
        .add_option("--mask", flags.solver.masks.size,
                    "transfer: Pixels, width of a visibility mask")
        ->type_name("N")
        ->check(CLI::IsMember({8, 16, 32, 64, 128}));
    command
        .add_option("--table", flags.table,
                    "transfer: Size of the table of half-planes; 0: none, planes are exact")
        ->type_name("N")
        ->check(CLI::IsMember({0, 16, 32, 64, 128, 256, 512}));
    command
        .add_option("--mask-block", flags.solver.masks.block,
                    "transfer: Pixels, width of the cells of a mask that are integrated")
        ->type_name("N")
        ->check(CLI::IsMember({1, 2, 4, 8}));
    command.add_option("--sh-window", flags.window, "transfer: Window against ringing")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"none", "hann", "lanczos"}));
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

}  // namespace clgi::cli
