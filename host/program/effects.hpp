// Which effects a picture has, by the words of --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <string>
#include <vector>

namespace clgi::program {

// Those of direct light: of lights, glossy, and of what shines itself.
std::vector<std::string> direct_effects(const DeviceScene& scene, const EmitterSet& emitters);

// Those of a picture with indirect light. sky: with that of the environment.
std::vector<std::string> all_effects(const DeviceScene& scene, const Picture& picture, bool sky);

}  // namespace clgi::program
