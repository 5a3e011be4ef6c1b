// SPDX-License-Identifier: MIT
#include "methods/antiradiance/element_places.hpp"

#include <clgi/shared/antiradiance.h>

#include "methods/antiradiance/motion_refine.hpp"

namespace clgi {

std::vector<ElementPlace> element_places(const ElementTree& tree,
                                         const std::vector<ElementTree>& poses,
                                         const DirectionBins& bins, const Scene& scene,
                                         const DeviceScene& device) {
    std::vector<std::uint32_t> on_device(scene.triangles.size(), ELEMENT_NONE);
    for (std::uint32_t t = 0; t < device.triangle_order().size(); ++t)
        on_device[device.triangle_order()[t]] = t;
    const std::vector<double> radii = largest_radii(poses);
    const double scale = device.frame().scale;
    std::vector<ElementPlace> out(tree.count());
    for (std::size_t i = 0; i < tree.count(); ++i) {
        const double radius = tree.is_leaf(i) ? 0.0 : radii[i] * scale;
        out[i].position =
            glm::vec4(device.frame().to_local(tree.positions[i]), static_cast<float>(radius));
        if (tree.is_flat(i))
            out[i].normal =
                glm::vec4(glm::dvec4(tree.normals[i], bins.hemisphere_scale(tree.normals[i])));
        out[i].area = static_cast<float>(tree.areas[i] * scale * scale);
        out[i].triangle = tree.is_patch(i) ? on_device[tree.triangles[i]] : ELEMENT_NONE;
    }
    return out;
}

}  // namespace clgi
