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

// What of the flags a saved picture's command repeats; what may change in a window is not among it.
std::string repeated(const ViewFlags& flags) {
    const SceneFlags& scene = flags.scene;
    std::string out = view::quoted(scene.file);
    if (!flags.device.device.empty()) out += " --device " + view::quoted(flags.device.device);
    if (scene.index >= 0) out += fmt::format(" --scene {}", scene.index);
    if (scene.camera > 0) out += fmt::format(" --camera {}", scene.camera);
    const EnvironmentFlags& sky = scene.environment;
    if (!sky.source.empty()) out += " --environment " + view::quoted(sky.source);
    if (sky.scale != 1.0) out += fmt::format(" --environment-scale {}", sky.scale);
    return out;
}

// The scene as the file has it, and what flags change of it: camera, lights, pose.
view::Shown first_of(const ViewFlags& flags, const Scene& scene) {
    view::Shown out;
    out.method = method_of(flags.method);
    out.seconds = flags.scene.animation.time;
    Scene placed = scene;
    arrange_scene("view", flags.scene, placed);
    const Camera& camera = camera_of(flags.scene, placed);
    if (!flags.scene.target.empty())
        out.viewpoint = {camera.position, *parse_triple(flags.scene.target)};
    else if (!flags.scene.eye.empty())
        out.viewpoint = view::viewpoint_of(camera, bounds(placed));
    for (const std::string& light : flags.scene.lights) {
        const std::size_t index = std::stoul(light);
        out.lights[index] = placed.lights[index];
    }
    return out;
}

void run_view(const ViewFlags& flags) {
    view::ViewerOptions options;
    parse_size("view", flags.size, 4096, options.pictures.width, options.pictures.height);
    options.pictures.build = build_of(flags.device);
    options.exposure = flags.exposure;
    options.output = flags.output;
    if (flags.output.empty()) throw Error("view: -o is empty, a file needed");
    check_formats("view", {flags.output});
    if (!flags.turntable.empty())
        options.turntable = 1e-3 * parse_milliseconds("view", "--turntable", flags.turntable);
    view::Subject subject;
    subject.scene = open_scene(flags.scene, flags.device.quiet, true);
    options.first = first_of(flags, subject.scene);
    if (flags.scene.animation.given())
        subject.clip = clip_of("view", subject.scene, flags.scene.animation);
    subject.camera = static_cast<std::size_t>(flags.scene.camera);
    subject.flags = repeated(flags);
    subject.turned = flags.scene.environment.rotation;
    const Session session = open_session(flags.device);
    const view::Viewed viewed = view::view(programs_of(session), std::move(subject), options);
    if (options.turntable && !flags.device.quiet && viewed.seconds > 0.0)
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
