// What clgi render was asked for, for all of its methods.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/renderer.hpp>
#include <optional>
#include <string>
#include <vector>

#include "program/ask.hpp"
#include "program/option_flags.hpp"
#include "program/picture.hpp"
#include "program/plan_request.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/verify.hpp"

namespace clgi::program {

struct RenderFlags {
    DeviceFlags device;
    PictureFlags picture;
    AskFlags ask;
    VerifyFlags verify;
    SceneFlags scene;
    std::optional<double> fps;  // frames a second of the animation, each in a file of its own
    std::string method = "auto";
    RendererOptions options;
    std::vector<const OptionRow*> given;  // options that flags have set
    int coarse = 0;  // triangles of the mesh that blocks far away; 0: the scene's own
    std::string gbuffer = "cl";
    std::string stats;
    int frames = 1;
    int replicates = 0;
    bool orbit = false;
    bool spin_light = false;
    PlanFlags plan;
    bool plan_given = false;  // some of its flags
};

inline bool is_given(const RenderFlags& flags, const std::string& name) {
    return std::any_of(flags.given.begin(), flags.given.end(),
                       [&](const OptionRow* row) { return row->name == name; });
}

}  // namespace clgi::program
