// Scenes with glossy surfaces, lit without visibility and shown.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/planes.hpp>
#include <set>
#include <string>

#include "element_light.hpp"
#include "frames.hpp"
#include "rooms.hpp"

namespace clgi::test {

constexpr int shown_width = 96, shown_height = 72;

struct GlossyPicture {
    explicit GlossyPicture(const Scene& of, const AntiradianceOptions& options = {})
        : scene(on_device(of)),
          solver(programs(), device().queue, of, scene, options),
          view(programs(), device().queue, scene, solver, picture_options(options)) {}

    static PictureOptions picture_options(const AntiradianceOptions& options) {
        PictureOptions out;
        out.width = shown_width;
        out.height = shown_height;
        out.direct = false;
        out.build = options.build;
        return out;
    }
    std::vector<glm::vec3> picture(const Camera& camera) {
        view.render(camera).wait();
        return vectors(device().queue, view.picture().radiance(), view.picture().stride(),
                       std::size_t{shown_width} * shown_height);
    }
    std::set<std::string> passes() const {
        std::set<std::string> out;
        for (const PassEvent& pass : solver.events()) out.insert(pass.name);
        for (const PassEvent& pass : view.picture().events()) out.insert(pass.name);
        return out;
    }

    DeviceScene scene;
    AntiradianceSolver solver;
    AntiradianceView view;
};

// Places of the pixels' surfaces.
inline std::vector<glm::vec3> places_of(const Picture& picture) {
    return vectors(device().queue, picture.gbuffer().planes, picture.stride(),
                   std::size_t{shown_width} * shown_height);
}

inline AntiradianceOptions antiradiance_options(const Build& build, int bins, std::size_t leaves) {
    AntiradianceOptions out;
    out.bins = bins;
    out.elements.requested = leaves;
    out.build = build;
    return out;
}

inline Material metal(const glm::vec3& color, float roughness) {
    Material out;
    out.base_color = glm::vec4(color, 1.0f);
    out.metallic = 1.0f;
    out.roughness = roughness;
    return out;
}

}  // namespace clgi::test
