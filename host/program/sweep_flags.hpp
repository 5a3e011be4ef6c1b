// What clgi sweep was asked for.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "program/animation.hpp"
#include "program/environment.hpp"
#include "program/session.hpp"

namespace clgi::program {

struct SweepFlags {
    DeviceFlags device;
    EnvironmentFlags environment;
    AnimationFlags animation;
    std::string scene;
    std::string output;
    std::string method = "all";
    std::string size;
    std::string reference;
    std::string sheet_time = "100ms";
    int atlas_size = 0;
    int scene_index = -1;
    int camera = 0;
    int samples = 0;
    int rounds = 0;
    bool quick = false;
    // Steps of the iterations of antiradiance instead of accuracy against time; 0: the default.
    bool convergence = false;
    int bins = 0;
    int elements = 0;
    int steps = 0;
    std::string command;
    // Flags given that go with one kind of sweep alone, and those that go with all but convergence.
    std::vector<std::string> pictures_only, atlas_only, all_only, convergence_only, not_convergence;
};

// The scene in its pose, and an existing folder for results. Throws InputError.
Scene open_sweep_scene(const SweepFlags& flags);
void make_folder(const std::string& folder);

// Measures how antiradiance converges, and writes the files.
void run_convergence(const SweepFlags& flags);

}  // namespace clgi::program
