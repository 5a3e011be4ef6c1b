// SPDX-License-Identifier: MIT
#include "program/animation.hpp"

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>

namespace clgi::program {

void add_animation_flags(CLI::App& command, AnimationFlags& flags) {
    command.add_option("--time", flags.time, "Time of the scene's animation, in seconds")
        ->type_name("T")
        ->default_str("none");
    command.add_option("--animation", flags.clip, "Name or index of the animation")
        ->type_name("CLIP")
        ->default_str("0");
}

std::size_t clip_of(const std::string& command, const Scene& scene, const AnimationFlags& flags) {
    if (!scene.animation) throw Error(command + ": the scene has no animation");
    try {
        return find_clip(*scene.animation, flags.clip);
    } catch (const Error& error) {
        throw Error(command + ": " + error.what());
    }
}

void pose_scene(const std::string& command, const AnimationFlags& flags, Scene& scene) {
    if (!flags.given()) return;
    const std::size_t clip = clip_of(command, scene, flags);
    scene = posed(scene, pose_at(*scene.animation, clip, flags.time.value_or(0.0)));
}

}  // namespace clgi::program
