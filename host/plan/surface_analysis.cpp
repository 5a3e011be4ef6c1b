// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <clgi/device_scene.hpp>
#include <cmath>
#include <limits>

#include "plan/one_colour.hpp"
#include "plan/parts.hpp"
#include "scene/base_color.hpp"
#include "scene/luminance.hpp"
#include "scene/texture_pool.hpp"

namespace clgi {
namespace {

constexpr double least_gloss = 1e-4;  // as DeviceScene::has_lobes has it
// Up to so many triangles are looked at in nine points each, more in one: there are enough of them.
constexpr std::size_t few_triangles = 30000;

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
    return varies(material.base_texture) ||
           (material.emission != glm::vec3(0.0f) && varies(material.emission_texture));
}

bool has_holes(const Scene& scene, const Material& material, const MaterialUse& use) {
    if (material.alpha_mode != AlphaMode::mask) return false;
    double least = double{material.base_color.a} * use.least_alpha;
    if (material.base_texture.texture >= 0) {
        const auto& rgba =
            scene.textures[static_cast<std::size_t>(material.base_texture.texture)].rgba;
        std::uint8_t lowest = 255;
        for (std::size_t i = 3; i < rgba.size(); i += 4) lowest = std::min(lowest, rgba[i]);
        least *= double_of(lowest);
    }
    return !(least >= double{material.alpha_cutoff});
}

double longest_edge(const Scene& scene, const SceneTriangle& triangle) {
    double out = 0.0;
    for (int k = 0; k < 3; ++k)
        out = std::max(out, glm::distance(scene.positions[triangle.vertex[k]],
                                          scene.positions[triangle.vertex[(k + 1) % 3]]));
    return out;
}

// [materials]
std::vector<Reflectance> reflectances_of(const Scene& scene) {
    std::vector<Reflectance> out;
    for (const Material& material : scene.materials)
        out.push_back(reflectance(material.metallic, material.roughness));
    return out;
}

// Areas and what they reflect, as sums; then as means and shares.
void add_areas(const Scene& scene, const std::vector<TriangleAlbedo>& albedos,
               SurfaceAnalysis& out) {
    const std::vector<Reflectance> reflectances = reflectances_of(scene);
    double gloss = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const double area = triangle_area(scene, scene.triangles[t]);
        const TriangleAlbedo& albedo = albedos[t];
        const Material& material = scene.materials[scene.triangles[t].material];
        const Reflectance& shares = reflectances[scene.triangles[t].material];
        out.area += area;
        out.mean_albedo += area * albedo.all;
        gloss += area * luminance(albedo.gloss);
        if (double{shares.coat} + double{shares.lobe} > least_gloss) out.glossy_area += area;
        if (material.double_sided) out.double_sided_area += area;
        if (!(area > 0.0)) continue;
        for (int c = 0; c < 3; ++c) {
            least = std::min(least, albedo.least[c]);
            out.largest_albedo = std::max(out.largest_albedo, albedo.most[c]);
        }
    }
    if (!(out.area > 0.0)) return;
    out.smallest_albedo = least;
    const double reflected = luminance(out.mean_albedo);
    if (reflected > 0.0) out.gloss = gloss / reflected;
    out.mean_albedo /= out.area;
    out.glossy_area /= out.area;
    out.double_sided_area /= out.area;
}

// Per channel, linear.
struct Texels {
    glm::dvec3 darkest = glm::dvec3(1.0), brightest = glm::dvec3(1.0);
};

Texels texels_of(const Texture& texture, const std::vector<float>& srgb) {
    // Of 16 texels next to each other: vectors of bytes.
    std::array<std::uint8_t, 64> least, most;
    least.fill(255);
    most.fill(0);
    const auto take = [&](std::size_t c, std::uint8_t low, std::uint8_t high) {
        least[c] = std::min(least[c], low);
        most[c] = std::max(most[c], high);
    };
    const std::vector<std::uint8_t>& bytes = texture.rgba;
    std::size_t i = 0;
    for (; i + most.size() <= bytes.size(); i += most.size())
        for (std::size_t c = 0; c < most.size(); ++c) take(c, bytes[i + c], bytes[i + c]);
    for (; i < bytes.size(); ++i) take(i % 4, bytes[i], bytes[i]);
    for (std::size_t c = 4; c < most.size(); ++c) take(c % 4, least[c], most[c]);
    const auto linear = [&](std::uint8_t byte) {
        return texture.srgb ? double{srgb[byte]} : double_of(byte);
    };
    return {{linear(least[0]), linear(least[1]), linear(least[2])},
            {linear(most[0]), linear(most[1]), linear(most[2])}};
}

// [textures] 1 where no base colour reads them.
std::vector<Texels> darkest_and_brightest(const Scene& scene) {
    const std::vector<float> srgb = srgb_decode_table();
    std::vector<bool> read(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.base_texture.texture >= 0)
            read[static_cast<std::size_t>(material.base_texture.texture)] = true;
    std::vector<Texels> out(scene.textures.size());
    for (std::size_t index = 0; index < out.size(); ++index)
        if (read[index]) out[index] = texels_of(scene.textures[index], srgb);
    return out;
}

// What the colours at its corners make of a triangle's base colour.
struct VertexColours {
    glm::dvec3 mean = glm::dvec3(1.0), least = glm::dvec3(1.0), most = glm::dvec3(1.0);
};
VertexColours vertex_colours(const Scene& scene, const SceneTriangle& triangle) {
    if (scene.colors.empty()) return {};
    VertexColours out{glm::dvec3(0.0), glm::dvec3(std::numeric_limits<double>::infinity()),
                      glm::dvec3(0.0)};
    for (const std::uint32_t vertex : triangle.vertex) {
        const glm::dvec3 color(scene.colors[vertex]);
        out.mean += color / 3.0;
        out.least = glm::min(out.least, color);
        out.most = glm::max(out.most, color);
    }
    return out;
}

}  // namespace

double triangle_area(const Scene& scene, const SceneTriangle& triangle) {
    const glm::dvec3& a = scene.positions[triangle.vertex[0]];
    return 0.5 * glm::length(glm::cross(scene.positions[triangle.vertex[1]] - a,
                                        scene.positions[triangle.vertex[2]] - a));
}

std::vector<TriangleAlbedo> triangle_albedos(const Scene& scene) {
    const BaseColorMeans base_colors(scene, false);
    const int side = scene.triangles.size() <= few_triangles ? 3 : 1;
    const std::vector<Texels> texels = darkest_and_brightest(scene);
    const std::vector<Reflectance> reflectances = reflectances_of(scene);
    std::vector<TriangleAlbedo> out;
    out.reserve(scene.triangles.size());
    for (const SceneTriangle& triangle : scene.triangles) {
        const Material& material = scene.materials[triangle.material];
        const Reflectance& shares = reflectances[triangle.material];
        const VertexColours colours = vertex_colours(scene, triangle);
        const glm::dvec3 base = base_colors.estimate(triangle, side) * colours.mean;
        const glm::dvec3 color(material.base_color);
        const int texture = material.base_texture.texture;
        const Texels read = texture >= 0 ? texels[static_cast<std::size_t>(texture)] : Texels();
        const glm::dvec3 least = color * colours.least * read.darkest;
        const glm::dvec3 most = color * colours.most * read.brightest;
        const double coat = shares.coat, lobe = shares.lobe, diffuse = shares.diffuse;
        const glm::dvec3 gloss = base * lobe + coat;
        const auto reflected = [&](const glm::dvec3& of) { return of * (diffuse + lobe) + coat; };
        out.push_back({base * diffuse + gloss, gloss, reflected(least), reflected(most)});
    }
    return out;
}

SurfaceAnalysis surface_analysis(const Scene& scene, const std::vector<LocalTriangle>& triangles,
                                 const std::vector<TriangleAlbedo>& albedos) {
    SurfaceAnalysis out;
    out.triangles = scene.triangles.size();
    out.vertices = scene.positions.size();
    out.degenerate = static_cast<std::size_t>(
        std::count_if(triangles.begin(), triangles.end(),
                      [](const LocalTriangle& triangle) { return triangle.is_line(); }));
    add_areas(scene, albedos, out);
    const std::vector<MaterialUse> uses = uses_of(scene);
    for (std::size_t m = 0; m < uses.size(); ++m) {
        if (!uses[m].used) continue;
        out.textures = out.textures || has_textures(scene, scene.materials[m]);
        out.cutouts = out.cutouts || has_holes(scene, scene.materials[m], uses[m]);
    }
    std::vector<double> edges;
    for (const SceneTriangle& triangle : scene.triangles)
        if (triangle_area(scene, triangle) > 0.0) edges.push_back(longest_edge(scene, triangle));
    if (edges.empty()) return out;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    out.median_edge = *middle;
    const auto [least, most] = std::minmax_element(edges.begin(), edges.end());
    out.smallest_edge = *least;
    out.largest_edge = *most;
    return out;
}

}  // namespace clgi
