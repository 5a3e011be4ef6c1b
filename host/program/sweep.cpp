// clgi sweep SCENE -o folder/: what accuracy costs in time, or how antiradiance converges.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "lab/convergence.hpp"
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_summary.hpp"
#include "lab/sweep_transfer.hpp"
#include "program/commands.hpp"
#include "program/count_flag.hpp"
#include "program/duration.hpp"
#include "program/environment.hpp"
#include "program/picture.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

// What clgi sweep was asked for.
struct SweepFlags {
    DeviceFlags device;
    SceneFlags scene;
    std::string output;
    std::string method = "all";
    std::string size;
    std::string reference;
    std::string sheet_time = "100ms";
    int atlas_size = 0;
    int samples = 0;
    int rounds = 0;
    bool quick = false;
    // Steps of the iterations of antiradiance instead of accuracy against time; 0: the default.
    bool convergence = false;
    int bins = 0;
    int elements = 0;
    int steps = 0;
    std::string command;
    // Flags given that go with one kind of sweep alone, and those that go with all but convergence.
    std::vector<std::string> pictures_only, atlas_only, all_only, convergence_only, not_convergence;
};

bool of_atlas(const SweepFlags& flags) { return flags.method == "atlas"; }
bool of_transfer(const SweepFlags& flags) { return flags.method == "transfer"; }
bool of_all(const SweepFlags& flags) { return flags.method == "all"; }

lab::PictureSweep pictures_of(const SweepFlags& flags) {
    lab::PictureSweep out;
    out.camera = flags.scene.camera;
    out.width = flags.quick ? 160 : 320;
    out.height = flags.quick ? 120 : 240;
    if (flags.method == "antiradiance") out.methods = {lab::antiradiance_method};
    if (of_all(flags))
        out.methods = {lab::second_order_method, lab::antiradiance_method, lab::light_atlas_method,
                       lab::dynamic_transfer_method};
    parse_size("sweep", flags.size, 4096, out.width, out.height);
    return out;
}

lab::AtlasSweep atlas_of(const SweepFlags& flags) {
    lab::AtlasSweep out;
    out.layout.size = flags.atlas_size > 0 ? flags.atlas_size : flags.quick ? 64 : 256;
    out.reference = flags.reference;
    return out;
}

int samples_of(const SweepFlags& flags) {
    if (flags.samples > 0) return flags.samples;
    if (of_atlas(flags)) return flags.quick ? 100 : 400;
    if (of_transfer(flags)) return flags.quick ? 256 : 1024;
    return flags.quick ? 64 : 192;
}

void make_folder(const std::string& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw InputError(fmt::format("{}: {}", folder, failed.message()));
}

// Shows how far it is; Ctrl-C ends it.
std::function<bool(double)> sweep_progress(const SweepFlags& flags) {
    catch_interrupts();
    return [bar = progress_bar("sweep", flags.device.quiet)](double done) {
        if (!bar(done)) throw Interrupted();
        return true;
    };
}

// How the iterations of antiradiance come to rest.
void run_convergence(const SweepFlags& flags) {
    Scene scene = open_scene(flags.scene, flags.device.quiet);
    arrange_scene("sweep", flags.scene, scene);
    const Session session = open_session(flags.device);
    make_folder(flags.output);
    lab::ConvergenceSetup setup{session.queue, scene};
    setup.options.bins = flags.bins > 0 ? flags.bins : flags.quick ? 64 : 128;
    setup.options.elements.requested = static_cast<std::size_t>(flags.elements > 0 ? flags.elements
                                                                : flags.quick      ? 2000
                                                                                   : 8192);
    setup.options.build = build_of(flags.device);
    setup.steps = flags.steps > 0 ? flags.steps : flags.quick ? 40 : 100;
    setup.progress = sweep_progress(flags);
    const lab::Convergence found = lab::measure_convergence(setup);
    setup.progress(1.0);
    const std::string why =
        lab::save_convergence(found, {flags.command, CLGI_VERSION}, flags.output);
    if (!why.empty()) notice(flags.device.quiet, "no plot: " + why);
    if (flags.device.quiet) return;
    for (const std::string& line : lab::summary(found)) fmt::print("{}\n", line);
    fmt::print("{}: convergence.csv, convergence.json{}\n", flags.output,
               why.empty() ? ", convergence.svg" : "");
}

void run_sweep(const SweepFlags& flags) {
    const auto refuse = [](bool wrong, const std::vector<std::string>& given,
                           const std::string& why) {
        if (wrong && !given.empty())
            throw Error(fmt::format("sweep: {} goes {}", given.front(), why));
    };
    refuse(flags.convergence, flags.not_convergence, "not with --convergence");
    refuse(!flags.convergence, flags.convergence_only, "only with --convergence");
    if (flags.convergence) return run_convergence(flags);
    refuse(of_atlas(flags) || of_transfer(flags), flags.pictures_only,
           "not with --method " + flags.method);
    refuse(!of_atlas(flags), flags.atlas_only, "only with --method atlas");
    refuse(!of_all(flags), flags.all_only, "only with --method all");
    const double sheet_time = parse_milliseconds("sweep", "--sheet-time", flags.sheet_time);
    Scene scene = open_scene(flags.scene, flags.device.quiet, of_atlas(flags));
    lab::TransferSweep motion;
    Scene animated;  // as it was before it is posed
    if (of_transfer(flags) && flags.scene.animation.given()) {
        motion.clip = clip_of("sweep", scene, flags.scene.animation);
        animated = scene;
        motion.animated = &animated;
    }
    arrange_scene("sweep", flags.scene, scene);
    const lab::PictureSweep pictures =
        of_atlas(flags) || of_transfer(flags) ? lab::PictureSweep() : pictures_of(flags);
    const Session session = open_session(flags.device);
    lab::SweepSetup setup{session.queue, scene};
    setup.quick = flags.quick;
    setup.solver = flags.method != "reference";
    setup.path_tracer = flags.method != "second-order";
    setup.rounds = flags.rounds > 0 ? flags.rounds : flags.quick ? 2 : 3;
    setup.reference_samples = samples_of(flags);
    setup.build = build_of(flags.device);
    setup.folder = flags.output;
    make_folder(flags.output);
    setup.progress = sweep_progress(flags);
    const lab::Sweep result = of_atlas(flags)      ? lab::sweep_atlas(setup, atlas_of(flags))
                              : of_transfer(flags) ? lab::sweep_transfer(setup, motion)
                                                   : lab::sweep_pictures(setup, pictures);
    setup.progress(1.0);
    const std::string why = lab::save_sweep(result, {flags.command, CLGI_VERSION}, setup.folder);
    if (!why.empty()) notice(flags.device.quiet, "no plots: " + why);
    if (of_all(flags)) {
        const lab::Raster sheet = draw_sheet(lab::contact_sheet(result, sheet_time));
        io::save_png(sheet.width, sheet.height, sheet.rgba, setup.folder / "methods.png");
    }
    if (result.non_finite > 0)
        notice(false, fmt::format("warning: {} packets held numbers that are not finite",
                                  result.non_finite));
    if (flags.device.quiet) return;
    for (const std::string& line : lab::summary(result)) fmt::print("{}\n", line);
    fmt::print("{}: index.html, sweep.csv, sweep.json{}{}\n", flags.output,
               of_all(flags) ? ", methods.png" : "", why.empty() ? ", error-*.svg" : "");
}

// The command with what was given, without the folders of files.
std::string command_of(const CLI::App& command, const SweepFlags& flags) {
    const auto file = [](const std::string& path) {
        return std::filesystem::path(path).filename().string();
    };
    std::string out =
        fmt::format("clgi sweep {} -o {}", file(flags.scene.file), file(flags.output));
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || option->get_positional() || name == "--output" ||
            name == "--quiet")
            continue;
        out += " " + name;
        if (option->get_expected_max() > 0) out += " " + file(option->as<std::string>());
    }
    return out;
}

}  // namespace

void add_sweep(CLI::App& app) {
    CLI::App* command = app.add_subcommand("sweep", "Measure accuracy against time");
    const auto flags = std::make_shared<SweepFlags>();
    add_scene_flags(*command, flags->scene);
    command
        ->add_option("-o,--output", flags->output,
                     "Folder for the results; references in it are used again")
        ->required()
        ->type_name("FOLDER");
    command->add_option("--method", flags->method, "What to measure")
        ->type_name("METHOD")
        ->check(CLI::IsMember(
            {"second-order", "reference", "all", "atlas", "transfer", "antiradiance"}));
    command->add_flag("--quick", flags->quick, "Fewer settings, smaller pictures, under a minute");
    command->add_flag("--convergence", flags->convergence,
                      "Instead: how the iterations of antiradiance converge, step by step");
    add_count(*command, "--bins", flags->bins, "convergence: Bins of directions, a multiple of 4",
              32, 4096)
        ->default_str("128; with --quick 64");
    add_count(*command, "--elements", flags->elements,
              "convergence: Parts that surfaces are cut to, about", 1, 1 << 24)
        ->default_str("8192; with --quick 2000");
    add_count(*command, "--iterations", flags->steps, "convergence: Steps of each iteration", 1,
              10000)
        ->default_str("100; with --quick 40");
    command->add_option("--size", flags->size, "Pixels across and down")
        ->type_name("WxH")
        ->default_str("320x240; with --quick 160x120");
    add_count(*command, "--atlas-size", flags->atlas_size, "atlas: texels, side of a page", 1, 8192)
        ->default_str("256; with --quick 64");
    command
        ->add_option("--reference", flags->reference,
                     "atlas: EXR of the irradiance that bakes are compared with")
        ->type_name("FILE")
        ->default_str("made with --spp");
    add_count(*command, "--spp", flags->samples,
              "Samples per pixel, texel or vertex of the references", 2, 1 << 20)
        ->default_str("192, atlas 400, transfer 1024; with --quick 64, 100, 256");
    add_count(*command, "--rounds", flags->rounds, "Times that every setting is measured", 1, 1000)
        ->default_str("3; with --quick 2");
    command
        ->add_option("--sheet-time", flags->sheet_time,
                     "all: Time of a frame that pictures of methods.png may take")
        ->type_name("TIME");
    add_camera_flags(*command, flags->scene);
    add_device_flags(*command, flags->device);
    command->callback([flags, command] {
        flags->pictures_only = given(*command, {"--size", "--camera", "--eye", "--look-at"});
        flags->atlas_only = given(*command, {"--atlas-size", "--reference"});
        flags->all_only = given(*command, {"--sheet-time"});
        flags->convergence_only = given(*command, {"--bins", "--elements", "--iterations"});
        flags->not_convergence =
            given(*command, {"--method", "--size", "--camera", "--eye", "--look-at", "--spp",
                             "--rounds", "--atlas-size", "--reference", "--sheet-time"});
        flags->command = command_of(*command, *flags);
        run_sweep(*flags);
    });
}

}  // namespace clgi::program
