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
    std::map<std::size_t, Light> lights;     // those that were moved or dimmed
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
    bool preview = false;     // by what draws while something moves
    double prepared_ms = 0.0, frame_ms = 0.0;
    std::optional<reference::Verification> check;
    std::vector<std::string> warnings;
};

// Without what its window does not change: the file, its scene, camera and environment, as flags.
struct Subject {
    Scene scene;
    std::size_t camera = 0, clip = 0;
    std::string flags;    // "scene.glb --camera 1"
    double turned = 0.0;  // degrees, --environment-rotation
};

Camera camera_of(const Subject& subject, const Shown& shown);

// The scene as it is shown, in a pose that stays.
Scene scene_of(const Subject& subject, const Shown& shown, int width, int height);

// What flags of `clgi render` say of these options, and nothing else.
RendererOptions as_flags(const RendererOptions& options);

// The arguments of `clgi render` that make the same picture.
std::string command_of(const Subject& subject, const Drawn& drawn);

}  // namespace clgi::view
