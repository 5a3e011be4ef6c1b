// SPDX-License-Identifier: MIT
#include "program/scene_flags.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>

#include "program/session.hpp"
#include "program/triple.hpp"

namespace clgi::program {
namespace {

glm::dvec3 place_of(const std::string& command, const char* flag, const std::string& text) {
    if (const auto place = parse_triple(text)) return *place;
    throw Error(fmt::format("{}: {} is '{}', X,Y,Z in metres needed", command, flag, text));
}

void place_camera(const std::string& command, const SceneFlags& flags, Camera& camera) {
    if (flags.eye.empty() && flags.target.empty()) return;
    const glm::dvec3 eye =
        flags.eye.empty() ? camera.position : place_of(command, "--eye", flags.eye);
    const glm::dvec3 target = flags.target.empty() ? eye + glm::dvec3(camera.forward)
                                                   : place_of(command, "--look-at", flags.target);
    try {
        camera = look_at(camera, eye, target);
    } catch (const Error& error) {
        throw Error(command + ": --eye and --look-at: " + error.what());
    }
}

// "0:position=1,2,3"
void place_light(const std::string& command, const std::string& text, Scene& scene) {
    const auto refuse = [&](const std::string& why) {
        throw Error(fmt::format("{}: --light is '{}', {}", command, text, why));
    };
    std::size_t index = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, index);
    const std::string rest(end, last);
    const std::size_t equal = rest.find('=');
    if (error != std::errc() || rest.empty() || rest[0] != ':' || equal == std::string::npos)
        refuse("N:position=X,Y,Z needed, or direction or intensity");
    if (index >= scene.lights.size())
        refuse(fmt::format("the scene has {} lights", scene.lights.size()));
    const std::string what = rest.substr(1, equal - 1);
    const auto values = parse_triple(rest.substr(equal + 1));
    if (!values) refuse("three numbers needed");
    Light& light = scene.lights[index];
    if (what == "position") {
        light.position = *values;
    } else if (what == "direction") {
        const double length = glm::length(*values);
        if (!(length > 0.0)) refuse("a direction needed");
        // One of unit length keeps its bits.
        light.direction = glm::vec3(*values);
        if (std::abs(length - 1.0) > 1e-6) light.direction = glm::vec3(*values / length);
    } else if (what == "intensity") {
        light.intensity = glm::vec3(*values);
        for (int c = 0; c < 3; ++c)
            if (!(light.intensity[c] >= 0.0f) || !std::isfinite(light.intensity[c]))
                refuse("intensities of at least 0 needed");
    } else {
        refuse("position, direction or intensity needed");
    }
}

}  // namespace

void add_scene_flags(CLI::App& command, SceneFlags& flags) {
    command.add_option("scene", flags.file, ".gltf or .glb file")->required()->type_name("SCENE");
    command.add_option("--scene", flags.index, "Index of the scene in the file")
        ->type_name("N")
        ->default_str("the file's default");
    add_environment_flags(command, flags.environment);
    add_animation_flags(command, flags.animation);
}

void add_camera_flags(CLI::App& command, SceneFlags& flags) {
    command.add_option("--camera", flags.camera, "Index of the camera in the scene")
        ->type_name("N")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--eye", flags.eye, "Where the camera stands, in metres")
        ->type_name("X,Y,Z")
        ->default_str("as the camera of the file");
    command.add_option("--look-at", flags.target, "What the camera looks at, in metres; +Y is up")
        ->type_name("X,Y,Z")
        ->default_str("as the camera of the file");
    command
        .add_option("--light", flags.lights,
                    "N:position=X,Y,Z, N:direction=X,Y,Z or N:intensity=R,G,B of light N of the "
                    "scene; may be repeated")
        ->type_name("LIGHT")
        ->default_str("as the file has them")
        ->expected(1)
        ->take_all();
}

Scene open_scene(const SceneFlags& flags, bool quiet, bool lightmaps) {
    io::GltfOptions options;
    options.scene = flags.index;
    options.lightmaps = lightmaps;
    Scene scene = io::load_gltf(flags.file, options);
    for (const std::string& warning : scene.warnings) notice(quiet, "warning: " + warning);
    if (scene.cameras.empty()) {
        scene.cameras.push_back(default_camera(scene));
        notice(quiet, "note: the scene has no camera; a default camera is used");
    }
    add_environment(flags.environment, scene, quiet);
    if (scene.lights.empty() && !has_emission(scene) && !scene.environment) {
        scene.lights.push_back(default_light(scene));
        notice(quiet, "note: the scene has no light; a directional light of pi lux is used");
    }
    return scene;
}

void arrange_scene(const std::string& command, const SceneFlags& flags, Scene& scene) {
    pose_scene(command, flags.animation, scene);
    place_scene(command, flags, scene);
}

void place_scene(const std::string& command, const SceneFlags& flags, Scene& scene) {
    const auto camera = static_cast<std::size_t>(flags.camera);
    if (camera >= scene.cameras.size())
        throw Error(fmt::format("{}: --camera is {}, the scene has {}", command, flags.camera,
                                scene.cameras.size()));
    place_camera(command, flags, scene.cameras[camera]);
    for (const std::string& light : flags.lights) place_light(command, light, scene);
}

}  // namespace clgi::program
