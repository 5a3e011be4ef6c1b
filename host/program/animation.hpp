// Which pose of an animated scene a command shows.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/scene.hpp>
#include <optional>
#include <string>

namespace clgi::program {

struct AnimationFlags {
    std::optional<double> time;  // seconds
    std::string clip;            // name or index; empty: the first

    bool given() const { return time || !clip.empty(); }
};
void add_animation_flags(CLI::App& command, AnimationFlags& flags);

// The clip of the flags. Throws Error that begins with the command's name if the scene has none.
std::size_t clip_of(const std::string& command, const Scene& scene, const AnimationFlags& flags);

// Brings the scene into the pose of the flags, if they are given.
void pose_scene(const std::string& command, const AnimationFlags& flags, Scene& scene);

}  // namespace clgi::program
