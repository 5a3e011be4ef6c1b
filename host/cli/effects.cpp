// SPDX-License-Identifier: MIT
#include "cli/effects.hpp"

namespace clgi::cli {

std::vector<std::string> direct_effects(const DeviceScene& scene, const EmitterSet& emitters) {
    std::vector<std::string> out;
    if (!emitters.emitters.empty()) out.push_back("direct");
    if (scene.has_lobes()) out.push_back("glossy-direct");
    if (!scene.emissive().empty()) out.push_back("emission");
    return out;
}

}  // namespace clgi::cli
