// SPDX-License-Identifier: MIT
#include "program/effects.hpp"

namespace clgi::program {

std::vector<std::string> effects_of(const Renderer& renderer) {
    const DeviceScene& scene = renderer.scene();
    const Method method = renderer.options().method;
    const bool direct = renderer.options().picture.direct;
    std::vector<std::string> out;
    const auto add = [&](bool is, const char* name) {
        if (is) out.emplace_back(name);
    };
    add(direct && !renderer.emitters().emitters.empty(), "direct");
    add(direct && scene.has_lobes(), "glossy-direct");
    add(direct && !scene.emissive().empty(), "emission");
    // Antiradiance has the sky's light in its bins, also without direct light.
    const bool sky = scene.environment() && (direct || method == Method::antiradiance);
    add(sky, "environment");
    if (const SecondOrderSolver* solver = renderer.second_order()) {
        const bool lit = solver->options().indirect && solver->emitters().vpl_count > 0;
        add(lit, "one-bounce");
        add(lit && solver->options().negative_vpls > 0, "negative-lights");
    } else if (const DynamicTransferSolver* transfer = renderer.dynamic_transfer()) {
        add(sky && transfer->glossy(), "glossy-environment");
        add(sky && transfer->options().interreflections > 0, "one-bounce");
    } else {
        out.emplace_back("indirect");
    }
    if (const AntiradianceSolver* solver = renderer.antiradiance())
        add(solver->gloss().count > 0, "glossy-indirect");
    return out;
}

}  // namespace clgi::program
