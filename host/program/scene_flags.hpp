// Flags that name a scene and say how it is seen and lit, and the scene that they make.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/scene.hpp>
#include <string>
#include <vector>

#include "program/animation.hpp"
#include "program/environment.hpp"

namespace clgi::program {

struct SceneFlags {
    std::string file;
    int index = -1;  // of the scene in the file; -1: the file's default
    int camera = 0;
    std::string eye, target;          // "X,Y,Z"; empty: as the file's camera
    std::vector<std::string> lights;  // "0:position=1,2,3"
    EnvironmentFlags environment;
    AnimationFlags animation;
};

// SCENE, --scene, --environment, --time and what goes with them.
void add_scene_flags(CLI::App& command, SceneFlags& flags);
// --camera, --eye, --look-at and --light, of commands that make pictures.
void add_camera_flags(CLI::App& command, SceneFlags& flags);

// Loads the file, prints its warnings and adds the environment of the flags. Adds a camera and a
// light if the file has none, and prints a note. lightmaps: keeps texture coordinates without
// textures.
Scene open_scene(const SceneFlags& flags, bool quiet, bool lightmaps = false);

// Brings the scene into the pose of --time, and camera and lights to where the flags put them.
// Throws Error that begins with the command's name for what the scene has not, and for a place that
// is none.
void arrange_scene(const std::string& command, const SceneFlags& flags, Scene& scene);
// The same without the pose.
void place_scene(const std::string& command, const SceneFlags& flags, Scene& scene);

inline const Camera& camera_of(const SceneFlags& flags, const Scene& scene) {
    return scene.cameras[static_cast<std::size_t>(flags.camera)];
}

}  // namespace clgi::program
