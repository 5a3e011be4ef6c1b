// SPDX-License-Identifier: MIT
#include "scene/uv_texels.hpp"

#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <cmath>
#include <string>

#include "scene/texel_centre.hpp"

namespace clgi {
namespace {

// Texels whose centres lie from low to high, as a range.
std::pair<int, int> covered(double low, double high, int size) {
    return {static_cast<int>(std::clamp(std::floor(low * size - 0.5), 0.0, double(size))),
            static_cast<int>(std::clamp(std::ceil(high * size + 0.5), 0.0, double(size)))};
}

}  // namespace

std::array<glm::dvec2, 3> uv_corners(const Scene& scene, std::uint32_t triangle, int uv_set) {
    std::array<glm::dvec2, 3> out;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec4& both = scene.uvs[scene.triangles[triangle].vertex[k]];
        out[k] = uv_set == 0 ? glm::dvec2(both.x, both.y) : glm::dvec2(both.z, both.w);
    }
    return out;
}

UvTexels uv_texels(const Scene& scene, int uv_set, int size) {
    if (uv_set != 0 && uv_set != 1)
        throw Error("uv texels: the uv set is " + std::to_string(uv_set) + ", 0 or 1 needed");
    if (size < 1 || size > 16384)
        throw Error("uv texels: the size is " + std::to_string(size) + ", 1 to 16384 needed");
    UvTexels out;
    if (scene.uvs.empty()) {
        out.without_area = scene.triangles.size();
        return out;
    }
    const auto side = static_cast<std::size_t>(size);
    std::vector<std::uint8_t> times(side * side);  // covered: 0, 1, more
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const std::array<glm::dvec2, 3> corner = uv_corners(scene, t, uv_set);
        const TexelCentre centre(corner, size);
        if (centre.without_area()) {
            ++out.without_area;
            continue;
        }
        const glm::dvec2 low = glm::min(corner[0], glm::min(corner[1], corner[2]));
        const glm::dvec2 high = glm::max(corner[0], glm::max(corner[1], corner[2]));
        const double edge = 0.5 / size;
        if (std::min(low.x, low.y) < -edge || std::max(high.x, high.y) > 1.0 + edge) {
            ++out.outside;
            continue;
        }
        const auto [left, right] = covered(low.x, high.x, size);
        const auto [top, bottom] = covered(low.y, high.y, size);
        for (int row = top; row < bottom; ++row)
            for (int column = left; column < right; ++column) {
                double b1, b2;
                if (!centre.covers(column, row, b1, b2)) continue;
                const auto texel =
                    static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column);
                if (times[texel] == 0)
                    out.texels.push_back({static_cast<std::uint32_t>(texel), t, b1, b2});
                if (times[texel] == 1) ++out.overlapping;
                times[texel] = static_cast<std::uint8_t>(std::min(times[texel] + 1, 2));
            }
    }
    std::sort(out.texels.begin(), out.texels.end(),
              [](const UvTexel& a, const UvTexel& b) { return a.texel < b.texel; });
    return out;
}

UvPlace place_at(const Scene& scene, const UvTexel& texel) {
    const auto& vertex = scene.triangles[texel.triangle].vertex;
    const glm::dvec3 corner[3] = {scene.positions[vertex[0]], scene.positions[vertex[1]],
                                  scene.positions[vertex[2]]};
    UvPlace out{};
    out.position =
        corner[0] + texel.b1 * (corner[1] - corner[0]) + texel.b2 * (corner[2] - corner[0]);
    const glm::dvec3 wound = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const glm::dvec3 between = (1.0 - texel.b1 - texel.b2) * glm::dvec3(scene.normals[vertex[0]]) +
                               texel.b1 * glm::dvec3(scene.normals[vertex[1]]) +
                               texel.b2 * glm::dvec3(scene.normals[vertex[2]]);
    const double area = glm::length(wound), length = glm::length(between);
    const glm::dvec3 first(scene.normals[vertex[0]]);
    out.normal = length > 0.0 ? between / length : glm::normalize(first);
    out.geometric = area > 0.0 ? wound / area : out.normal;
    if (!(glm::dot(out.normal, out.geometric) > 0.0)) out.normal = out.geometric;
    return out;
}

}  // namespace clgi
