// SPDX-License-Identifier: MIT
#include "scene/coverage.hpp"

#include <algorithm>

namespace clgi {

double covered(const Material& material, double alpha) {
    switch (material.alpha_mode) {
        case AlphaMode::mask:
            return alpha >= double{material.alpha_cutoff} ? 1.0 : 0.0;
        case AlphaMode::blend:
            return std::clamp(alpha, 0.0, 1.0);
        case AlphaMode::opaque:
            break;
    }
    return 1.0;
}

bool Coverage::reads(const Material& material) const {
    return material.alpha_mode != AlphaMode::opaque && material.base_texture.texture >= 0;
}

Coverage::Coverage(const Scene& scene) : scene_(scene), textures_(scene.textures.size()) {
    for (const Material& material : scene.materials) {
        if (!reads(material)) continue;
        const auto texture = static_cast<std::size_t>(material.base_texture.texture);
        textures_[texture] = TextureMean(scene.textures[texture], false);
    }
}

double Coverage::operator()(const SceneTriangle& triangle, const glm::dvec3& weight) const {
    const Material& material = scene_.materials[triangle.material];
    if (material.alpha_mode == AlphaMode::opaque) return 1.0;
    double alpha = material.base_color.a;
    if (reads(material))
        alpha *= textures_[material.base_texture.texture].alpha(
            between(slot_uvs(scene_, triangle, material.base_texture), weight));
    if (!scene_.colors.empty()) {
        double vertex_alpha = 0.0;
        for (int k = 0; k < 3; ++k)
            vertex_alpha += weight[k] * double{scene_.colors[triangle.vertex[k]].a};
        alpha *= vertex_alpha;
    }
    return covered(material, alpha);
}

double Coverage::texels(const SceneTriangle& triangle) const {
    const Material& material = scene_.materials[triangle.material];
    if (!reads(material)) return 0.0;
    return textures_[material.base_texture.texture].extent(
        slot_uvs(scene_, triangle, material.base_texture));
}

}  // namespace clgi
