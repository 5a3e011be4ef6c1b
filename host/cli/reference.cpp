// clgi reference SCENE -o ref.exr: ground truth by path tracing.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/percent.hpp"
#include "cli/picture.hpp"
#include "cli/session.hpp"
#include "cli/version.hpp"
#include "io/atomic_file.hpp"
#include "report/reference_picture.hpp"

namespace clgi::cli {
namespace {

struct ReferenceFlags {
    std::string scene;
    PictureFlags picture;
    reference::Options options;
    std::string effects;
    std::string error;
    int scene_index = -1;
    int camera = 0;
    std::string stats;
    bool quiet = false;
};

void save_stats(const reference::Picture& picture, const Scene& scene,
                const ReferenceFlags& flags) {
    const nlohmann::ordered_json json = {
        {"clgi", CLGI_VERSION},
        {"method", "reference"},
        {"scene", {{"triangles", scene.triangles.size()}, {"lights", scene.lights.size()}}},
        {"effects", flags.effects.empty() ? "all" : flags.effects},
        {"samples", picture.samples},
        {"relative_error", picture.relative_error},
        {"seconds", picture.seconds},
        {"non_finite", picture.non_finite},
        {"seed", flags.options.seed},
        {"converged",
         flags.options.target == 0.0 || (picture.samples >= reference::Options::least_samples &&
                                         picture.relative_error <= flags.options.target)},
        {"warnings", scene.warnings}};
    io::AtomicFile file(flags.stats);
    const std::string text =
        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
}

void run_reference(ReferenceFlags flags) {
    check_picture("reference", flags.picture, flags.options.width, flags.options.height);
    flags.options.effects = reference::parse_effects(flags.effects);
    if (!flags.error.empty())
        flags.options.target = parse_percent("reference", "--error", flags.error);
    const Scene scene = open_scene(flags.scene, flags.scene_index, flags.quiet);
    if (flags.camera >= static_cast<int>(scene.cameras.size()))
        throw Error(fmt::format("reference: --camera is {}, the scene has {}", flags.camera,
                                scene.cameras.size()));
    const reference::PathTracer tracer(scene);
    catch_interrupts();
    const auto bar = progress_bar("reference", flags.quiet);
    const reference::Picture picture =
        tracer.render(scene.cameras[static_cast<std::size_t>(flags.camera)], flags.options, bar);
    if (picture.cancelled) throw Interrupted();
    if (bar) bar(1.0);
    save_picture(report::reference_image(picture, flags.effects), flags.picture);
    if (picture.non_finite > 0)
        notice(false, fmt::format("warning: {} samples were not finite and were left out",
                                  picture.non_finite));
    if (!flags.quiet)
        fmt::print("{}: {} samples a pixel, {:.1f} s, standard error {:.3g} % of the mean\n",
                   flags.picture.exr.empty() ? flags.picture.png : flags.picture.exr,
                   picture.samples, picture.seconds, 100.0 * picture.relative_error);
    if (!flags.stats.empty()) save_stats(picture, scene, flags);
}

}  // namespace

void add_reference(CLI::App& app) {
    CLI::App* command = app.add_subcommand("reference", "Ground truth by path tracing, on the CPU");
    const auto flags = std::make_shared<ReferenceFlags>();
    command->add_option("scene", flags->scene, ".gltf or .glb file")
        ->required()
        ->type_name("SCENE");
    add_picture_flags(*command, flags->picture);
    command->add_option("--spp", flags->options.samples, "Samples a pixel, at most")
        ->check(CLI::Range(1, 1 << 24));
    command->add_option("--error", flags->error,
                        "Stop at this standard error, of the mean: 0.5% or 0.005");
    command->add_option("--effects", flags->effects,
                        "Which paths count: emission,direct,indirect,one-bounce,bounces=K,"
                        "unshadowed-indirect,diffuse,diffuse-indirect; default all");
    command->add_option("--seed", flags->options.seed, "Another one gives other noise");
    command
        ->add_option("--roulette-depth", flags->options.roulette_depth,
                     "Surfaces met before chance may end a path")
        ->check(CLI::Range(0, 1000000));
    command->add_option("--threads", flags->options.threads, "0: all cores")
        ->check(CLI::Range(0, 4096));
    command->add_option("--scene", flags->scene_index, "Which scene of the file");
    command->add_option("--camera", flags->camera, "Which camera of the scene")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--stats", flags->stats, "JSON file of samples, error and time");
    command->add_flag("--quiet", flags->quiet, "Only errors");
    command->callback([flags] { run_reference(*flags); });
}

}  // namespace clgi::cli
