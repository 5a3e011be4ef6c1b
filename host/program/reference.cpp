// clgi reference SCENE -o ref.exr: ground truth by path tracing, of a picture or a light atlas.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "lab/reference_picture.hpp"
#include "program/commands.hpp"
#include "program/percent.hpp"
#include "program/picture.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/verify.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

struct ReferenceFlags {
    SceneFlags scene;
    PictureFlags picture;
    int atlas = 0;    // texels, side; 0: a camera's picture
    int uv_set = -1;  // -1: 1 where that is a lightmap, else 0
    reference::Options options;
    std::string effects;
    std::string error;
    std::string filter = "center";
    std::string stats;
    bool quiet = false;
};

// The result for a picture or an atlas.
struct Outcome {
    io::Image image;
    std::size_t texels = 0;  // that were lit; 0: a picture
    int samples = 0;
    double relative_error = 0.0;
    double seconds = 0.0;
    std::size_t non_finite = 0;
};

Outcome trace_picture(const reference::PathTracer& tracer, const Scene& scene,
                      const ReferenceFlags& flags, const Progress& progress) {
    const reference::Picture found =
        tracer.render(camera_of(flags.scene, scene), flags.options, progress);
    if (found.cancelled) throw Interrupted();
    return {lab::reference_image(found, flags.effects),
            0,
            found.samples,
            found.relative_error,
            found.seconds,
            found.non_finite};
}

Outcome trace_atlas(const reference::PathTracer& tracer, const lab::AtlasPlaces& atlas,
                    const ReferenceFlags& flags, const Progress& progress) {
    const reference::Irradiance found = tracer.irradiance(atlas.places, flags.options, progress);
    if (found.cancelled) throw Interrupted();
    return {lab::atlas_image(atlas, found, flags.effects),
            atlas.places.size(),
            found.samples,
            found.relative_error,
            found.seconds,
            found.non_finite};
}

void save_stats(const Outcome& outcome, const Scene& scene, const ReferenceFlags& flags) {
    nlohmann::ordered_json json = {
        {"clgi", CLGI_VERSION},
        {"method", "reference"},
        {"scene", {{"triangles", scene.triangles.size()}, {"lights", scene.lights.size()}}},
        {"effects", flags.effects.empty() ? "all" : flags.effects},
        {"samples", outcome.samples},
        {"relative_error", outcome.relative_error},
        {"seconds", outcome.seconds},
        {"non_finite", outcome.non_finite},
        {"seed", flags.options.seed},
        {"converged",
         flags.options.target == 0.0 || (outcome.samples >= reference::Options::least_samples &&
                                         outcome.relative_error <= flags.options.target)},
        {"warnings", scene.warnings}};
    if (flags.atlas > 0) json["texels"] = outcome.texels;
    io::AtomicFile file(flags.stats);
    const std::string text =
        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
}

void run_reference(ReferenceFlags flags) {
    check_picture("reference", flags.picture, flags.options.width, flags.options.height);
    flags.options.effects = reference::parse_effects(flags.effects);
    flags.options.filter = filter_of(flags.filter);
    if (!flags.error.empty())
        flags.options.target = parse_percent("reference", "--error", flags.error);
    Scene scene = open_scene(flags.scene, flags.quiet, flags.atlas > 0);
    arrange_scene("reference", flags.scene, scene);
    lab::AtlasPlaces atlas;
    if (flags.atlas > 0) {
        atlas = lab::atlas_places(scene, flags.atlas, flags.uv_set);
        flags.picture.full = true;  // daylight, in lux, is beyond the range of half
    }
    for (const std::string& warning : atlas.warnings) {
        notice(flags.quiet, "warning: " + warning);
        scene.warnings.push_back(warning);
    }
    const reference::PathTracer tracer(scene);
    catch_interrupts();
    const auto bar = progress_bar("reference", flags.quiet);
    const Outcome outcome = flags.atlas > 0 ? trace_atlas(tracer, atlas, flags, bar)
                                            : trace_picture(tracer, scene, flags, bar);
    if (bar) bar(1.0);
    save_picture(outcome.image, flags.picture);
    if (outcome.non_finite > 0)
        notice(false, fmt::format("warning: {} samples were not finite and were left out",
                                  outcome.non_finite));
    if (!flags.quiet)
        fmt::print("{}: {}{} samples a {}, {:.1f} s, standard error {:.3g} % of the mean\n",
                   flags.picture.exr.empty() ? flags.picture.png : flags.picture.exr,
                   flags.atlas > 0
                       ? fmt::format("{} texels of uv set {}, ", outcome.texels, atlas.uv_set)
                       : "",
                   outcome.samples, flags.atlas > 0 ? "texel" : "pixel", outcome.seconds,
                   100.0 * outcome.relative_error);
    if (!flags.stats.empty()) save_stats(outcome, scene, flags);
}

}  // namespace

void add_reference(CLI::App& app) {
    CLI::App* command = app.add_subcommand("reference", "Ground truth by path tracing, on the CPU");
    const auto flags = std::make_shared<ReferenceFlags>();
    add_scene_flags(*command, flags->scene);
    add_picture_flags(*command, flags->picture, flags->options.width, flags->options.height);
    CLI::Option* atlas =
        command
            ->add_option("--atlas", flags->atlas,
                         "Write the irradiance of a lightmap with SIZE x SIZE texels")
            ->type_name("SIZE")
            ->default_str("none")
            ->check(CLI::Range(1, 8192))
            ->excludes("--size");
    command->add_option("--uv-set", flags->uv_set, "UV set of the lightmap")
        ->type_name("N")
        ->default_str("1, else 0")
        ->check(CLI::Range(0, 1))
        ->needs(atlas);
    command->add_option("--spp", flags->options.samples, "Largest number of samples per pixel")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 24));
    command
        ->add_option("--error", flags->error,
                     "Stop at this standard error, relative to the mean: 0.5% or 0.005")
        ->type_name("X")
        ->default_str("none");
    command
        ->add_option("--effects", flags->effects,
                     "Light paths that count: emission,direct,indirect,one-bounce,bounces=K,"
                     "unshadowed-indirect,diffuse,diffuse-indirect")
        ->type_name("LIST")
        ->default_str("all");
    add_filter_flag(*command, flags->filter);
    command->add_option("--seed", flags->options.seed, "Seed of the random numbers")
        ->type_name("N");
    command
        ->add_option("--roulette-depth", flags->options.roulette_depth,
                     "Surfaces on a path before Russian roulette may end it")
        ->type_name("N")
        ->check(CLI::Range(0, 1000000));
    command->add_option("--threads", flags->options.threads, "Threads; 0: one for each core")
        ->type_name("N")
        ->check(CLI::Range(0, 4096));
    add_camera_flags(*command, flags->scene);
    for (const char* name : {"--camera", "--eye", "--look-at"})
        command->get_option(name)->excludes(atlas);
    command->add_option("--stats", flags->stats, "JSON file with samples, error and time")
        ->type_name("FILE")
        ->default_str("none");
    add_quiet_flag(*command, flags->quiet);
    command->callback([flags] { run_reference(*flags); });
}

}  // namespace clgi::program
