// SPDX-License-Identifier: MIT
#include "scene/base_color.hpp"

namespace clgi {

BaseColorMeans::BaseColorMeans(const Scene& scene, bool sums)
    : scene_(scene), textures_(scene.textures.size()) {
    std::vector<bool> seen(textures_.size());
    for (const Material& material : scene.materials) {
        if (material.base_texture.texture < 0) continue;
        const auto texture = static_cast<std::size_t>(material.base_texture.texture);
        if (seen[texture]) continue;
        seen[texture] = true;
        textures_[texture] = TextureMean(scene.textures[texture], sums);
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

glm::dvec3 BaseColorMeans::estimate(const SceneTriangle& triangle, int side) const {
    const Material& material = scene_.materials[triangle.material];
    const glm::dvec3 factor(material.base_color);
    const TextureSlot& slot = material.base_texture;
    if (slot.texture < 0) return factor;
    const TextureMean& texture = textures_[static_cast<std::size_t>(slot.texture)];
    const UvTriangle uv = slot_uvs(scene_, triangle, slot);
    glm::dvec3 sum(0.0);
    for_lattice(side, [&](const glm::dvec3& weight) { sum += texture.at(between(uv, weight)); });
    return factor * sum / static_cast<double>(side * side);
}

}  // namespace clgi
