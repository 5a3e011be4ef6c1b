// Which effects a picture has, by the words of --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <string>
#include <vector>

namespace clgi::cli {

// Those of direct light: of lights, glossy, and of what shines itself.
std::vector<std::string> direct_effects(const DeviceScene& scene, const EmitterSet& emitters);

}  // namespace clgi::cli
