// SPDX-License-Identifier: MIT
#include "scene/emission.hpp"

#include <algorithm>

#include "scene/coverage.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

// Samples along a side of a masked triangle: two a texel, within bounds.
constexpr double samples_per_texel = 2.0;
constexpr int fewest_samples = 8, most_samples = 128;

bool shines(const Material& material) { return luminance(material.emission) > 0.0f; }

}  // namespace

EmissionMeans::EmissionMeans(const Scene& scene) : scene_(scene) {
    std::vector<bool> read(scene.textures.size());
    const auto note = [&](const TextureSlot& slot) {
        if (slot.texture >= 0) read[static_cast<std::size_t>(slot.texture)] = true;
    };
    for (const Material& material : scene.materials) {
        if (!shines(material)) continue;
        note(material.emission_texture);
        if (material.alpha_mode != AlphaMode::opaque) note(material.base_texture);
    }
    for (std::size_t t = 0; t < read.size(); ++t)
        textures_.push_back(read[t] ? TextureMean(scene.textures[t]) : TextureMean());
}

// Which texels a mask leaves is decided point by point, in another texture than that of emission:
// the sum over a lattice of both.
glm::dvec3 EmissionMeans::masked(const SceneTriangle& triangle) const {
    const Material& material = scene_.materials[triangle.material];
    const TextureSlot &emission = material.emission_texture, &base = material.base_texture;
    UvTriangle emission_uv{}, base_uv{};
    double texels = 0.0;
    if (emission.texture >= 0) {
        emission_uv = slot_uvs(scene_, triangle, emission);
        texels = textures_[emission.texture].extent(emission_uv);
    }
    if (base.texture >= 0) {
        base_uv = slot_uvs(scene_, triangle, base);
        texels = std::max(texels, textures_[base.texture].extent(base_uv));
    }
    const int side = static_cast<int>(
        std::clamp(samples_per_texel * texels, double{fewest_samples}, double{most_samples}));
    glm::dvec3 sum(0.0);
    for_lattice(side, [&](const glm::dvec3& weight) {
        double alpha = material.base_color.a;
        if (base.texture >= 0) alpha *= textures_[base.texture].alpha(between(base_uv, weight));
        if (!scene_.colors.empty()) {
            double vertex_alpha = 0.0;
            for (int k = 0; k < 3; ++k)
                vertex_alpha += weight[k] * double{scene_.colors[triangle.vertex[k]].a};
            alpha *= vertex_alpha;
        }
        const double share = covered(material, alpha);
        if (share == 0.0) return;
        sum += share * (emission.texture >= 0
                            ? textures_[emission.texture].at(between(emission_uv, weight))
                            : glm::dvec3(1.0));
    });
    return sum / (double(side) * side);
}

glm::dvec3 EmissionMeans::operator()(const SceneTriangle& triangle) const {
    const Material& material = scene_.materials[triangle.material];
    if (!shines(material)) return glm::dvec3(0.0);
    const glm::dvec3 factor(material.emission);
    if (material.alpha_mode != AlphaMode::opaque) return factor * masked(triangle);
    const TextureSlot& slot = material.emission_texture;
    if (slot.texture < 0) return factor;
    return factor * textures_[slot.texture].over(slot_uvs(scene_, triangle, slot));
}

}  // namespace clgi
