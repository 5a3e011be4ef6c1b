// SPDX-License-Identifier: MIT
#include "scene/emission.hpp"

#include <algorithm>

#include "scene/luminance.hpp"

namespace clgi {
namespace {

// Samples along a side of a masked triangle: two a texel, within bounds.
constexpr double samples_per_texel = 2.0;
constexpr int fewest_samples = 8, most_samples = 128;

bool shines(const Material& material) { return luminance(material.emission) > 0.0f; }

}  // namespace

EmissionMeans::EmissionMeans(const Scene& scene) : scene_(scene), coverage_(scene) {
    std::vector<bool> read(scene.textures.size());
    for (const Material& material : scene.materials)
        if (shines(material) && material.emission_texture.texture >= 0)
            read[static_cast<std::size_t>(material.emission_texture.texture)] = true;
    for (std::size_t t = 0; t < read.size(); ++t)
        textures_.push_back(read[t] ? TextureMean(scene.textures[t]) : TextureMean());
}

// What alpha leaves is decided point by point, in another texture than that of emission: the sum
// over a lattice of both.
glm::dvec3 EmissionMeans::masked(const SceneTriangle& triangle) const {
    const TextureSlot& emission = scene_.materials[triangle.material].emission_texture;
    UvTriangle emission_uv{};
    double texels = coverage_.texels(triangle);
    if (emission.texture >= 0) {
        emission_uv = slot_uvs(scene_, triangle, emission);
        texels = std::max(texels, textures_[emission.texture].extent(emission_uv));
    }
    const int side = static_cast<int>(
        std::clamp(samples_per_texel * texels, double{fewest_samples}, double{most_samples}));
    glm::dvec3 sum(0.0);
    for_lattice(side, [&](const glm::dvec3& weight) {
        const double share = coverage_(triangle, weight);
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
