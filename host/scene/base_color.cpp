// SPDX-License-Identifier: MIT
#include "scene/base_color.hpp"

namespace clgi {

BaseColorMeans::BaseColorMeans(const Scene& scene)
    : scene_(scene), textures_(scene.textures.size()) {
    for (const Material& material : scene.materials) {
        const int texture = material.base_texture.texture;
        if (texture >= 0)
            textures_[static_cast<std::size_t>(texture)] =
                TextureMean(scene.textures[static_cast<std::size_t>(texture)]);
    }
}

glm::dvec3 BaseColorMeans::operator()(const SceneTriangle& triangle) const {
    const Material& material = scene_.materials[triangle.material];
    const glm::dvec3 factor(material.base_color);
    const TextureSlot& slot = material.base_texture;
    if (slot.texture < 0) return factor;
    return factor *
           textures_[static_cast<std::size_t>(slot.texture)].over(slot_uvs(scene_, triangle, slot));
}

}  // namespace clgi
