// clgi verify PICTURE SCENE: the error of a picture of any origin, by a few path-traced pixels.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "io/image_formats.hpp"
#include "lab/preview.hpp"
#include "program/commands.hpp"
#include "program/duration.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/verify.hpp"

namespace clgi::program {
namespace {

struct VerifyPictureFlags {
    std::string picture;
    SceneFlags scene;
    std::string time = "2s";
    std::string effects;
    std::string filter;
    std::uint64_t seed = 1;
    bool json = false;
    bool quiet = false;
};

// Throws InputError for a picture that is not of radiance.
io::Image read_radiance(const std::string& path) {
    io::Image out = io::read_image(path);
    for (const char* name : {"R", "G", "B"})
        if (!out.find(name)) throw InputError(path + ": it has no channel " + name);
    if (const std::size_t bad = io::make_finite(out))
        throw InputError(fmt::format("{}: {} samples are not finite", path, bad));
    return out;
}

void run_verify(const VerifyPictureFlags& flags) {
    reference::VerifyOptions options;
    options.seconds = 1e-3 * parse_milliseconds("verify", "--limit", flags.time);
    options.samples = 1 << 20;  // time is the limit
    options.seed = flags.seed;
    options.effects = reference::parse_effects(flags.effects);
    const io::Image picture = read_radiance(flags.picture);
    const auto says = picture.attributes.find("clgi:filter");
    options.filter = filter_of(!flags.filter.empty()              ? flags.filter
                               : says != picture.attributes.end() ? says->second
                                                                  : "center");
    Scene scene = open_scene(flags.scene, flags.quiet);
    arrange_scene("verify", flags.scene, scene);
    const reference::PathTracer tracer(scene);
    catch_interrupts();
    const reference::Verification found =
        tracer.verify(camera_of(flags.scene, scene), picture.width, picture.height,
                      lab::radiance_of(picture), options, progress_bar("verify", flags.quiet));
    if (found.cancelled) throw Interrupted();
    if (flags.json)
        fmt::print("{}\n", picture_json(found).dump(2));
    else
        fmt::print("{}: {}\n{}", flags.picture, verify_line(found), largest_lines(found));
}

}  // namespace

void add_verify(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "verify", "The error of a picture, by path-tracing some hundred of its pixels");
    const auto flags = std::make_shared<VerifyPictureFlags>();
    command
        ->add_option(
            "picture", flags->picture,
            "The picture to judge, .exr or .hdr: radiance in cd/m^2 from the scene's camera")
        ->required()
        ->type_name("PICTURE");
    add_scene_flags(*command, flags->scene);
    add_camera_flags(*command, flags->scene);
    command->add_option("--limit", flags->time, "How long pixels are traced")->type_name("TIME");
    command
        ->add_option("--effects", flags->effects,
                     "Light paths that count, as those of clgi reference")
        ->type_name("LIST")
        ->default_str("all");
    add_filter_flag(*command, flags->filter);
    command->get_option("--filter")->default_str("what the picture says, else center");
    command->add_option("--seed", flags->seed, "Seed of the random numbers")->type_name("N");
    command->add_flag("--json", flags->json, "Print JSON");
    add_quiet_flag(*command, flags->quiet);
    command->callback([flags] { run_verify(*flags); });
}

}  // namespace clgi::program
