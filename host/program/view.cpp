// clgi view SCENE: a window, in which a scene is looked at and lit.
// SPDX-License-Identifier: MIT
#include "view/viewer.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <memory>

#include "program/commands.hpp"
#include "program/duration.hpp"
#include "program/picture.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/triple.hpp"

namespace clgi::program {
namespace {

struct ViewFlags {
    SceneFlags scene;
    DeviceFlags device;
    std::string size, method = "auto", output = "view.exr", turntable;
    std::optional<float> exposure;
};

// What of the flags a saved picture's command repeats.
std::string repeated(const SceneFlags& flags) {
    const auto quoted = [](std::string text) {
        if (text.find_first_of(" \t'\"\\$&;()<>|*?") == std::string::npos) return text;
        for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4)
            text.replace(at, 1, "'\\''");
        return "'" + text + "'";
    };
    std::string out = quoted(flags.file);
    if (flags.index >= 0) out += fmt::format(" --scene {}", flags.index);
    if (flags.camera > 0) out += fmt::format(" --camera {}", flags.camera);
    const EnvironmentFlags& sky = flags.environment;
    if (!sky.source.empty()) out += " --environment " + quoted(sky.source);
    if (sky.scale != 1.0) out += fmt::format(" --environment-scale {}", sky.scale);
    for (const std::string& light : flags.lights) out += " --light " + quoted(light);
    return out;
}

void run_view(const ViewFlags& flags) {
    view::ViewerOptions options;
    parse_size("view", flags.size, 4096, options.pictures.width, options.pictures.height);
    options.pictures.build = build_of(flags.device);
    options.method = method_of(flags.method);
    options.exposure = flags.exposure;
    options.output = flags.output;
    if (!flags.turntable.empty())
        options.turntable = 1e-3 * parse_milliseconds("view", "--turntable", flags.turntable);
    view::Subject subject;
    subject.scene = open_scene(flags.scene, flags.device.quiet, true);
    place_scene("view", flags.scene, subject.scene);
    if (flags.scene.animation.given()) {
        subject.clip = clip_of("view", subject.scene, flags.scene.animation);
        options.seconds = flags.scene.animation.time;
    }
    if (!flags.scene.eye.empty() || !flags.scene.target.empty()) {
        const Camera& camera = camera_of(flags.scene, subject.scene);
        options.viewpoint = {camera.position,
                             parse_triple(flags.scene.target)
                                 .value_or(camera.position + glm::dvec3(camera.forward))};
    }
    subject.camera = static_cast<std::size_t>(flags.scene.camera);
    subject.flags = repeated(flags.scene);
    subject.turned = flags.scene.environment.rotation;
    const Session session = open_session(flags.device);
    const view::Viewed viewed = view::view(programs_of(session), std::move(subject), options);
    if (options.turntable && !flags.device.quiet)
        fmt::print("{} pictures in {:.2f} s, {:.1f} a second\n", viewed.frames, viewed.seconds,
                   static_cast<double>(viewed.frames) / viewed.seconds);
}

}  // namespace

void add_view(CLI::App& app) {
    CLI::App* command = app.add_subcommand("view", "Look at a glTF scene in a window");
    const auto flags = std::make_shared<ViewFlags>();
    add_scene_flags(*command, flags->scene);
    add_camera_flags(*command, flags->scene);
    command->add_option("--size", flags->size, "Of pictures and window, to begin with")
        ->type_name("WxH")
        ->default_str("640x480");
    command->add_option("--method", flags->method, "To begin with; auto: a plan chooses")
        ->type_name("METHOD")
        ->check(CLI::IsMember(
            {"auto", "second-order", "atlas", "transfer", "antiradiance", "cache", "direct"}));
    command
        ->add_option("-o,--output", flags->output,
                     "EXR of saved pictures, with a number where it exists")
        ->type_name("FILE");
    command->add_option("--exposure", flags->exposure, "To begin with; at 0, 1 is white")
        ->type_name("STOPS")
        ->default_str("from the picture");
    command
        ->add_option(
            "--turntable", flags->turntable,
            "Turn the camera for so long, such as 10s, then print the pictures a second and "
            "leave")
        ->type_name("T")
        ->default_str("none");
    add_device_flags(*command, flags->device);
    command->callback([flags] { run_view(*flags); });
}

}  // namespace clgi::program
