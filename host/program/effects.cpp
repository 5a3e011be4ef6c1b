// SPDX-License-Identifier: MIT
#include "program/effects.hpp"

namespace clgi::program {

std::vector<std::string> direct_effects(const DeviceScene& scene, const EmitterSet& emitters) {
    std::vector<std::string> out;
    if (!emitters.emitters.empty()) out.push_back("direct");
    if (scene.has_lobes()) out.push_back("glossy-direct");
    if (!scene.emissive().empty()) out.push_back("emission");
    return out;
}

std::vector<std::string> all_effects(const DeviceScene& scene, const Picture& picture, bool sky) {
    std::vector<std::string> out;
    if (picture.options().direct) out = direct_effects(scene, picture.emitters());
    if (sky && scene.environment()) out.push_back("environment");
    out.push_back("indirect");
    return out;
}

}  // namespace clgi::program
