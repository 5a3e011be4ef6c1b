// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "methods/light_atlas/placement.hpp"
#include "scene/disjoint_sets.hpp"
#include "scene/texel_centre.hpp"

namespace clgi {
namespace {

// [vertices] the same number for vertices of the same position and texture coordinates.
std::vector<std::uint32_t> numbers_of(const Scene& scene, int uv_set) {
    const auto key = [&](std::uint32_t i) {
        const glm::dvec3& p = scene.positions[i];
        const glm::vec4& uv = scene.uvs[i];
        return std::array<double, 5>{p.x, p.y, p.z, double{uv_set == 0 ? uv.x : uv.z},
                                     double{uv_set == 0 ? uv.y : uv.w}};
    };
    std::vector<std::uint32_t> order(scene.positions.size()), out(order.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i)
        out[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? out[order[i - 1]] : order[i];
    return out;
}

struct Edge {
    std::uint32_t low, high, triangle;
    bool operator<(const Edge& other) const {
        return low != other.low     ? low < other.low
               : high != other.high ? high < other.high
                                    : triangle < other.triangle;
    }
};

// [triangles] the chart of each, numbered as they first appear; no_chart without area.
std::vector<std::uint32_t> connected(const Scene& scene, int uv_set,
                                     const std::vector<bool>& has_area) {
    const std::vector<std::uint32_t> number = numbers_of(scene, uv_set);
    std::vector<Edge> edges;
    edges.reserve(3 * scene.triangles.size());
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (!has_area[t]) continue;
        const auto& vertex = scene.triangles[t].vertex;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = number[vertex[k]], b = number[vertex[(k + 1) % 3]];
            edges.push_back({std::min(a, b), std::max(a, b), t});
        }
    }
    std::sort(edges.begin(), edges.end());
    DisjointSets sets(scene.triangles.size());
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high)
            sets.join(edges[i].triangle, edges[i - 1].triangle);
    std::vector<std::uint32_t> out(scene.triangles.size(), no_chart), number_of(out);
    std::uint32_t next = 0;
    for (std::uint32_t t = 0; t < out.size(); ++t) {
        if (!has_area[t]) continue;
        std::uint32_t& chart = number_of[sets.find(t)];
        if (chart == no_chart) chart = next++;
        out[t] = chart;
    }
    return out;
}

}  // namespace

AtlasPlacement place_by_uvs(const Scene& scene, int uv_set, int size) {
    AtlasPlacement out;
    out.corners.resize(3 * scene.triangles.size());
    std::vector<bool> has_area(scene.triangles.size());
    double texels = 0.0, metres = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const std::array<glm::dvec2, 3> corner = uv_corners(scene, t, uv_set);
        const double in_uvs = std::abs(doubled_area(corner[0], corner[1], corner[2]));
        const double on_surface = glm::length(doubled_area_of(scene, t));
        // A place of no surface in a lightmap is still a texel of it, as for the reference.
        has_area[t] = in_uvs > 0.0;
        if (!has_area[t]) continue;
        std::copy(corner.begin(), corner.end(), out.corners.begin() + 3 * std::ptrdiff_t{t});
        texels += in_uvs * size * size;
        metres += on_surface;
    }
    out.texels_per_metre = metres > 0.0 ? std::sqrt(texels / metres) : 0.0;
    out.triangle_chart = connected(scene, uv_set, has_area);

    std::vector<glm::dvec2> low, high;
    for (std::size_t t = 0; t < out.triangle_chart.size(); ++t) {
        const std::uint32_t chart = out.triangle_chart[t];
        if (chart == no_chart) continue;
        if (chart == low.size()) {
            low.emplace_back(1.0);
            high.emplace_back(0.0);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            low[chart] = glm::min(low[chart], out.corners[3 * t + k]);
            high[chart] = glm::max(high[chart], out.corners[3 * t + k]);
        }
    }
    for (std::size_t i = 0; i < low.size(); ++i) {
        const glm::ivec2 first(glm::clamp(glm::floor(low[i] * double(size)), 0.0, size - 1.0));
        const glm::ivec2 end(
            glm::clamp(glm::ceil(high[i] * double(size)), glm::dvec2(first + 1), glm::dvec2(size)));
        out.charts.push_back({0, first.x, first.y, end.x - first.x, end.y - first.y, no_chart});
    }
    return out;
}

}  // namespace clgi
