// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <clgi/device_scene.hpp>
#include <cmath>

#include "core/on_threads.hpp"
#include "plan/one_colour.hpp"
#include "plan/parts.hpp"
#include "scene/base_color.hpp"
#include "scene/coverage.hpp"
#include "scene/luminance.hpp"
#include "scene/texture_pool.hpp"

namespace clgi {
namespace {

constexpr double least_gloss = 1e-4;  // as DeviceScene::has_lobes has it
// Up to so many triangles are looked at in nine points each. Of more, each counts with a mean of
// its whole texture.
constexpr std::size_t few_triangles = 30000;
constexpr int points_along = 3;
constexpr int most_along = 64;  // texels of a mean, along a side

double double_of(std::uint8_t byte) { return byte / 255.0; }

// Which materials some triangle has, and the least vertex alpha of their triangles.
struct MaterialUse {
    bool used = false;
    double least_alpha = 1.0;
};

std::vector<MaterialUse> uses_of(const Scene& scene) {
    std::vector<MaterialUse> out(scene.materials.size());
    for (const SceneTriangle& triangle : scene.triangles) {
        MaterialUse& use = out[triangle.material];
        use.used = true;
        if (scene.colors.empty()) continue;
        for (const std::uint32_t vertex : triangle.vertex)
            use.least_alpha = std::min(use.least_alpha, double{scene.colors[vertex].a});
    }
    return out;
}

bool has_textures(const Scene& scene, const Material& material) {
    const auto varies = [&](const TextureSlot& slot) {
        return slot.texture >= 0 &&
               !one_colour(scene.textures[static_cast<std::size_t>(slot.texture)]);
    };
    return material.normal_texture.texture >= 0 ||
           material.metallic_roughness_texture.texture >= 0 || varies(material.base_texture) ||
           (material.emission != glm::vec3(0.0f) && varies(material.emission_texture));
}

bool has_holes(const Scene& scene, const Material& material, const MaterialUse& use) {
    if (material.alpha_mode == AlphaMode::opaque) return false;
    double least = double{material.base_color.a} * use.least_alpha;
    if (material.base_texture.texture >= 0) {
        const auto& rgba =
            scene.textures[static_cast<std::size_t>(material.base_texture.texture)].rgba;
        std::uint8_t lowest = 255;
        for (std::size_t i = 3; i < rgba.size(); i += 4) lowest = std::min(lowest, rgba[i]);
        least *= double_of(lowest);
    }
    return covered(material, least) < 1.0;
}

// [materials]
std::vector<Reflectance> reflectances_of(const Scene& scene) {
    std::vector<Reflectance> out;
    for (const Material& material : scene.materials) out.push_back(reflectance(material));
    return out;
}

// Per channel, linear.
glm::dvec3 brightest_texel(const Texture& texture, const std::vector<float>& srgb) {
    // Of 16 texels next to each other: vectors of bytes.
    std::array<std::uint8_t, 64> most;
    most.fill(0);
    const auto take = [&](std::size_t c, std::uint8_t byte) { most[c] = std::max(most[c], byte); };
    const std::vector<std::uint8_t>& bytes = texture.rgba;
    std::size_t i = 0;
    for (; i + most.size() <= bytes.size(); i += most.size())
        for (std::size_t c = 0; c < most.size(); ++c) take(c, bytes[i + c]);
    for (; i < bytes.size(); ++i) take(i % 4, bytes[i]);
    for (std::size_t c = 4; c < most.size(); ++c) take(c % 4, most[c]);
    const auto linear = [&](std::uint8_t byte) {
        return texture.srgb ? double{srgb[byte]} : double_of(byte);
    };
    return {linear(most[0]), linear(most[1]), linear(most[2])};
}

// Linear, of texels that are spread evenly.
glm::dvec3 mean_of_some(const Texture& texture) {
    const TextureMean texels(texture, false);
    const int side = std::min(most_along, std::max(texture.width, texture.height));
    glm::dvec3 sum(0.0);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            sum += texels.at((glm::dvec2(column, row) + 0.5) / static_cast<double>(side));
    return sum / (static_cast<double>(side) * side);
}

// [textures] 1 where no base colour reads them.
std::vector<glm::dvec3> brightest_texels(const Scene& scene) {
    const std::vector<float> srgb = srgb_decode_table();
    std::vector<bool> read(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.base_texture.texture >= 0)
            read[static_cast<std::size_t>(material.base_texture.texture)] = true;
    std::vector<glm::dvec3> out(scene.textures.size(), glm::dvec3(1.0));
    for_each_of(out.size(), 1, [&](std::size_t index) {
        if (read[index]) out[index] = brightest_texel(scene.textures[index], srgb);
    });
    return out;
}

// What the colours at its corners make of a triangle's base colour.
struct VertexColours {
    glm::dvec3 mean = glm::dvec3(1.0), most = glm::dvec3(1.0);
};
VertexColours vertex_colours(const Scene& scene, const SceneTriangle& triangle) {
    if (scene.colors.empty()) return {};
    VertexColours out{glm::dvec3(0.0), glm::dvec3(0.0)};
    for (const std::uint32_t vertex : triangle.vertex) {
        const glm::dvec3 color(scene.colors[vertex]);
        out.mean += color / 3.0;
        out.most = glm::max(out.most, color);
    }
    return out;
}

// What a triangle reflects of what meets it, per channel.
struct TriangleAlbedo {
    glm::dvec3 all;    // diffuse and gloss
    glm::dvec3 gloss;  // of lobe and coat alone
    glm::dvec3 most;   // no point of it reflects more
};

class TriangleAlbedos {
public:
    explicit TriangleAlbedos(const Scene& scene)
        : scene_(scene),
          base_colors_(scene, false),
          brightest_(brightest_texels(scene)),
          reflectances_(reflectances_of(scene)) {
        if (scene.triangles.size() <= few_triangles) return;
        means_.resize(scene.textures.size());
        for_each_of(means_.size(), 1,
                    [&](std::size_t k) { means_[k] = mean_of_some(scene.textures[k]); });
    }

    TriangleAlbedo operator()(const SceneTriangle& triangle) const {
        const Material& material = scene_.materials[triangle.material];
        const Reflectance& shares = reflectances_[triangle.material];
        const VertexColours colours = vertex_colours(scene_, triangle);
        const glm::dvec3 color(material.base_color);
        glm::dvec3 base = color * colours.mean, most = color * colours.most;
        if (material.base_texture.texture >= 0) {
            const auto texture = static_cast<std::size_t>(material.base_texture.texture);
            base = means_.empty() ? base_colors_.estimate(triangle, points_along) * colours.mean
                                  : base * means_[texture];
            most *= brightest_[texture];
        }
        const double coat = shares.coat, lobe = shares.lobe, diffuse = shares.diffuse;
        const glm::dvec3 gloss = base * lobe + coat;
        return {base * diffuse + gloss, gloss, most * (diffuse + lobe) + coat};
    }

    double gloss_of(std::uint32_t material) const {
        return double{reflectances_[material].coat} + double{reflectances_[material].lobe};
    }

private:
    const Scene& scene_;
    BaseColorMeans base_colors_;
    std::vector<glm::dvec3> brightest_, means_;  // [textures]; no means: points of each triangle
    std::vector<Reflectance> reflectances_;      // [materials]
};

// Areas and what they reflect, as sums; then as shares.
void add_areas(const Scene& scene, SurfacesFound& found) {
    const TriangleAlbedos albedos(scene);
    SurfaceAnalysis& out = found.analysis;
    found.reflects.reserve(scene.triangles.size());
    double gloss = 0.0, reflected = 0.0;
    for (const SceneTriangle& triangle : scene.triangles) {
        const double area = triangle_area(scene, triangle);
        const TriangleAlbedo albedo = albedos(triangle);
        found.reflects.push_back(std::max({albedo.all.x, albedo.all.y, albedo.all.z}));
        out.area += area;
        reflected += area * luminance(albedo.all);
        gloss += area * luminance(albedo.gloss);
        if (albedos.gloss_of(triangle.material) > least_gloss) out.glossy_area += area;
        if (scene.materials[triangle.material].double_sided) out.double_sided_area += area;
        if (!(area > 0.0)) continue;
        for (int c = 0; c < 3; ++c)
            out.largest_albedo = std::max(out.largest_albedo, albedo.most[c]);
    }
    if (!(out.area > 0.0)) return;
    if (reflected > 0.0) out.gloss = gloss / reflected;
    out.glossy_area /= out.area;
    out.double_sided_area /= out.area;
}

}  // namespace

double triangle_area(const Scene& scene, const SceneTriangle& triangle) {
    const glm::dvec3& a = scene.positions[triangle.vertex[0]];
    return 0.5 * glm::length(glm::cross(scene.positions[triangle.vertex[1]] - a,
                                        scene.positions[triangle.vertex[2]] - a));
}

SurfacesFound surface_analysis(const Scene& scene, const std::vector<LocalTriangle>& triangles) {
    SurfacesFound found;
    SurfaceAnalysis& out = found.analysis;
    out.triangles = scene.triangles.size();
    out.vertices = scene.positions.size();
    out.degenerate = static_cast<std::size_t>(
        std::count_if(triangles.begin(), triangles.end(),
                      [](const LocalTriangle& triangle) { return triangle.is_line(); }));
    add_areas(scene, found);
    const std::vector<MaterialUse> uses = uses_of(scene);
    for (std::size_t m = 0; m < uses.size(); ++m) {
        if (!uses[m].used) continue;
        out.textures = out.textures || has_textures(scene, scene.materials[m]);
        out.cutouts = out.cutouts || has_holes(scene, scene.materials[m], uses[m]);
    }
    return found;
}

}  // namespace clgi
