// What a window shows, and what it has drawn of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <clgi/reference.hpp>
#include <clgi/renderer.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "view/viewpoint.hpp"

namespace clgi::view {

struct Shown {
    std::optional<Viewpoint> viewpoint;      // none: the camera of the file
    std::map<std::size_t, Light> lights;     // those that are not as the scene has them
    double turn = 0.0;                       // degrees, the environment's rotation beside its own
    std::optional<double> seconds;           // of the clip; none: as the file stores the scene
    std::optional<Method> method;            // none: a plan chooses
    std::optional<RendererOptions> by_hand;  // none: a plan finds the settings

    // How often they were changed: the viewpoint, the pose, lights and turn, method and settings.
    std::uint64_t moved = 0, posed = 0, lit = 0, set = 0;
    std::uint64_t version() const { return moved + posed + lit + set; }
};

struct Drawn {
    Shown shown;
    RendererOptions options;  // with the samples of the picture
    io::Image picture;        // radiance, cd/m^2
    Camera camera;            // that it was drawn from
    std::vector<Light> lights;
    bool preview = false;  // by what draws while something moves
    double prepared_ms = 0.0, frame_ms = 0.0;
    std::optional<reference::Verification> check;
    std::vector<std::string> warnings;
};

// What a window does not change.
struct Subject {
    Scene scene;
    std::size_t camera = 0, clip = 0;
    std::string flags;    // of the file, its scene, camera and sky: "scene.glb --camera 1"
    double turned = 0.0;  // degrees, --environment-rotation
};

// The scene as it is shown, in a pose that stays, without its focus.
Scene scene_of(const Subject& subject, const Shown& shown);

// What flags of `clgi render` say of these options, and nothing else.
RendererOptions as_flags(const RendererOptions& options);

// Of pictures while something moves: one bounce, few VPLs and shadow maps.
RendererOptions preview_options();

// A word as a shell reads it.
std::string quoted(const std::string& word);

// The command that makes the same picture.
std::string command_of(const Subject& subject, const Drawn& drawn);

}  // namespace clgi::view
