// What leaves the texels of an atlas: L = rho / pi E + L_e.          [docs/materials.md]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/atlas_light.hpp>
#include <clgi/device_scene.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "methods/light_atlas/lookup.hpp"
#include "scene/coverage.hpp"
#include "scene/texture_mean.hpp"
#include "scene/texture_pool.hpp"

namespace clgi {
namespace {

// Of a texture, along a side of a texel: of a level, and of what a mask cuts, which levels blur.
constexpr double most_samples = 4.0, most_masked_samples = 16.0;

// A texture with its mip levels.
class Levels {
public:
    Levels() = default;
    explicit Levels(const Texture& texture) : textures_(texture_levels(texture)) {
        for (const Texture& level : textures_) means_.emplace_back(level);
    }
    // The finest level of which a part that is so large is few texels.
    const TextureMean& for_extent(double extent) const {
        const double level = std::ceil(std::log2(std::max(1.0, extent / most_samples)));
        const double last = static_cast<double>(means_.size() - 1);
        return means_[static_cast<std::size_t>(std::min(level, last))];
    }

private:
    std::vector<Texture> textures_;
    std::vector<TextureMean> means_;
};

// The weights of a triangle's corners at a place of the page, moved onto the triangle.
class Weights {
public:
    Weights(const AtlasLayout& atlas, std::uint32_t triangle)
        : first_(atlas_place(atlas, triangle, 0.0, 0.0)),
          a_(atlas_place(atlas, triangle, 1.0, 0.0) - first_),
          b_(atlas_place(atlas, triangle, 0.0, 1.0) - first_) {}

    glm::dvec3 at(const glm::dvec2& place) const {
        const double whole = a_.x * b_.y - a_.y * b_.x;
        const glm::dvec2 to = place - first_;
        double b1 = std::max(0.0, (to.x * b_.y - to.y * b_.x) / whole);
        double b2 = std::max(0.0, (a_.x * to.y - a_.y * to.x) / whole);
        if (!std::isfinite(b1 + b2)) return {1.0, 0.0, 0.0};
        const double beyond = std::max(1.0, b1 + b2);
        return {1.0 - (b1 + b2) / beyond, b1 / beyond, b2 / beyond};
    }

private:
    glm::dvec2 first_, a_, b_;
};

class TexelColors {
public:
    TexelColors(const Scene& scene, const AtlasLayout& atlas) : scene_(scene), atlas_(atlas) {
        std::vector<bool> read(scene.textures.size());
        for (const Material& material : scene.materials)
            for (const int texture :
                 {material.base_texture.texture, material.emission_texture.texture})
                if (texture >= 0) read[static_cast<std::size_t>(texture)] = true;
        for (std::size_t t = 0; t < read.size(); ++t)
            textures_.push_back(read[t] ? Levels(scene.textures[t]) : Levels());
        for (const Material& material : scene.materials)
            diffuse_.push_back(double{reflectance(material).diffuse});
    }

    // Of a texel that receives 1, and of one that receives nothing.
    struct Colors {
        glm::dvec3 reflectance, emission;
    };
    Colors of(const AtlasTexel& texel) const {
        const SceneTriangle& triangle = scene_.triangles[texel.triangle];
        const Material& material = scene_.materials[triangle.material];
        Colors out{glm::dvec3(material.base_color) * diffuse_[triangle.material],
                   glm::dvec3(material.emission)};
        if (!scene_.colors.empty()) {
            const glm::dvec3 weight(1.0 - double{texel.b1} - double{texel.b2}, texel.b1, texel.b2);
            glm::dvec3 color(0.0);
            for (int k = 0; k < 3; ++k)
                color += weight[k] * glm::dvec3(scene_.colors[triangle.vertex[k]]);
            out.reflectance *= color;
        }
        if (material.base_texture.texture >= 0) {
            const bool masked = material.alpha_mode != AlphaMode::opaque;
            out.reflectance *= mean(material.base_texture, texel, masked ? &material : nullptr);
        }
        if (material.emission_texture.texture >= 0 && out.emission != glm::dvec3(0.0))
            out.emission *= mean(material.emission_texture, texel, nullptr);
        return out;
    }

private:
    // Over the texel's part of its triangle, less what the alpha of a masked material cuts out.
    glm::dvec3 mean(const TextureSlot& slot, const AtlasTexel& texel,
                    const Material* masked) const {
        const SceneTriangle& triangle = scene_.triangles[texel.triangle];
        const Levels& levels = textures_[static_cast<std::size_t>(slot.texture)];
        const UvTriangle uv = slot_uvs(scene_, triangle, slot);
        const Weights weights(atlas_, texel.triangle);
        const glm::dvec2 centre =
            atlas_place(atlas_, texel.triangle, double{texel.b1}, double{texel.b2});
        const glm::dvec2 low = texel.centre ? centre - 0.5 : glm::floor(centre);
        const auto place = [&](double x, double y) {
            return between(uv, weights.at(low + glm::dvec2(x, y)));
        };
        const auto extent = [&](const TextureMean& level) {
            return std::max(level.extent({place(0, 0), place(1, 0), place(1, 1)}),
                            level.extent({place(0, 0), place(0, 1), place(1, 1)}));
        };
        const TextureMean& finest = levels.for_extent(0.0);
        const TextureMean& texture = masked ? finest : levels.for_extent(extent(finest));
        const int side = static_cast<int>(std::clamp(std::ceil(extent(texture)), 1.0,
                                                     masked ? most_masked_samples : most_samples));
        glm::dvec3 left(0.0), all(0.0);
        double shares = 0.0;
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                const glm::dvec2 at = place((column + 0.5) / side, (row + 0.5) / side);
                const glm::dvec3 color = texture.at(at);
                all += color;
                const double share =
                    masked ? covered(*masked, masked->base_color.a * texture.alpha(at)) : 1.0;
                left += share * color;
                shares += share;
            }
        return shares > 0.0 ? left / shares : all / double(side * side);
    }

    const Scene& scene_;
    const AtlasLayout& atlas_;
    std::vector<Levels> textures_;  // empty ones that no material reads
    std::vector<double> diffuse_;   // share of the base colour, by material
};

}  // namespace

std::vector<glm::vec3> atlas_radiance(const Scene& scene, const AtlasLayout& atlas,
                                      const std::vector<glm::vec3>& irradiance) {
    need_layout_of("atlas_radiance", scene, atlas);
    need_light_of("atlas_radiance", atlas, irradiance.size());
    const TexelColors colors(scene, atlas);
    std::vector<glm::vec3> out;
    out.reserve(irradiance.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        const TexelColors::Colors color = colors.of(atlas.texels[i]);
        out.emplace_back(color.reflectance * glm::one_over_pi<double>() *
                             glm::dvec3(irradiance[i]) +
                         color.emission);
    }
    return out;
}

}  // namespace clgi
