// --environment and its further flags.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/scene.hpp>
#include <string>

namespace clgi::program {

struct EnvironmentFlags {
    std::string source;     // a picture's file or R,G,B; empty: none
    double rotation = 0.0;  // degrees about +Y
    double scale = 1.0;
};
void add_environment_flags(CLI::App& command, EnvironmentFlags& flags);

// Adds the environment of the flags, if any, to the scene. Prints a warning about unusual content
// unless quiet. Throws InputError for a file that is no such picture, Error for a colour below 0.
void add_environment(const EnvironmentFlags& flags, Scene& scene, bool quiet);

}  // namespace clgi::program
