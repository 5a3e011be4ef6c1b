// What clgi render was asked for, for all of its methods.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/animation.hpp"
#include "program/ask.hpp"
#include "program/environment.hpp"
#include "program/picture.hpp"
#include "program/plan_request.hpp"
#include "program/session.hpp"
#include "program/vector_flags.hpp"

namespace clgi::program {

// What --method atlas bakes before it shows the scene.
struct AtlasFlags {
    VplOptions vpls;
    AtlasOptions layout;
    LightAtlasOptions bake;
    std::string least_change = "0.1%";  // that a VPL sends on, of the mean power of VPLs
};

// How --method transfer finds the environment's light.
struct TransferFlags : VectorFlags {
    std::string per_pixel = "0.1";
    int probe_step = 8;
};

// How --method antiradiance cuts the scene and exchanges light.
struct AntiradianceFlags {
    AntiradianceOptions solver;
    int elements = static_cast<int>(ElementOptions().requested);
    std::string iteration = "auto";
    std::string spread = "precise";
    int poses = 16;
};

// What --method auto has loaded and planned before a method runs.
struct Planned {
    Plan plan;
    Scene scene;  // planned_scene(), moved out by the method
    Session session;
    double milliseconds = 0.0;  // that analysis and probe took
};

struct RenderFlags {
    DeviceFlags device;
    PictureFlags picture;
    AskFlags ask;
    EnvironmentFlags environment;
    AnimationFlags animation;
    std::optional<double> fps;  // frames a second of the animation, each in a file of its own
    std::string scene;
    int scene_index = -1;
    int camera = 0;
    std::string method = "auto";
    std::string low_res;
    std::string gbuffer = "cl";
    std::string stats;
    int frames = 1;
    int replicates = 0;
    bool orbit = false;
    bool spin_light = false;
    bool no_direct = false;
    // By a flag, so no plan changes it.
    bool shadow_size_given = false, face_size_given = false, area_samples_given = false;
    SecondOrderOptions options;
    AtlasFlags atlas;
    TransferFlags transfer;
    AntiradianceFlags antiradiance;
    PlanFlags plan;
    std::shared_ptr<Planned> planned;  // --method auto alone
    // Flags given that go with one kind of method alone, and those that do not go with some.
    std::vector<std::string> second_order_only, atlas_only, transfer_only, antiradiance_only,
        not_transfer, not_antiradiance, auto_only;
    std::vector<std::string> second_order_asked;  // those given that choose it under auto
    std::vector<std::string> asked;               // --target-error and --time-budget
};

// The scene and the device that a method works on: those of the plan, or opened here.
// lightmaps: as open_scene takes it.
Scene scene_of(const RenderFlags& flags, bool lightmaps = false);
Session session_of(const RenderFlags& flags);

// Plans, and sets the flags to the method and the settings of the plan.
void plan_render(RenderFlags& flags);

// Bakes an atlas and shows the scene with it.
void run_atlas(RenderFlags flags);

// Finds the light of the environment at vertices and pixels.
void run_transfer(RenderFlags flags);
void add_transfer_flags(CLI::App& command, TransferFlags& flags);

// Exchanges light between the elements of the scene.
void run_antiradiance(RenderFlags flags);
void add_antiradiance_flags(CLI::App& command, AntiradianceFlags& flags);

}  // namespace clgi::program
