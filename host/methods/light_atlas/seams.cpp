// SPDX-License-Identifier: MIT
#include "methods/light_atlas/seams.hpp"

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/atlas_light.hpp>
#include <cmath>
#include <limits>

#include "methods/light_atlas/placement.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

const double planes_agree = std::cos(30.0 * 3.14159265358979 / 180.0);
const double normals_agree = std::cos(1.0 * 3.14159265358979 / 180.0);
// Texels: nearer coordinates are one place, which was rounded to floats twice.
constexpr double one_place = 1e-3;

// One side of an edge, from its first end to its second.
struct Side {
    Side(const Scene& scene, const AtlasLayout& atlas, const EdgeUse& use)
        : triangle(use.triangle), chart(atlas.triangle_chart[use.triangle]) {
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t corner = (use.side + (use.forward ? i : 1 - i)) % 3;
            const std::uint32_t vertex = scene.triangles[triangle].vertex[corner];
            position[i] = scene.positions[vertex];
            normal[i] = scene.normals[vertex];
            place[i] = atlas.uvs[3 * std::size_t{triangle} + corner];
        }
    }
    std::uint32_t triangle, chart;
    glm::dvec3 position[2], normal[2];
    glm::dvec2 place[2];
};

bool is_smooth(const Scene& scene, const Side& a, const Side& b) {
    const glm::dvec3 m = doubled_area_of(scene, a.triangle), n = doubled_area_of(scene, b.triangle);
    if (!(glm::dot(m, n) > planes_agree * glm::length(m) * glm::length(n))) return false;
    for (int i = 0; i < 2; ++i)
        if (!(glm::dot(a.normal[i], b.normal[i]) > normals_agree)) return false;
    return true;
}

bool is_cut(const Side& a, const Side& b) {
    if (a.chart != b.chart) return true;
    return glm::distance(a.place[0], b.place[0]) > one_place ||
           glm::distance(a.place[1], b.place[1]) > one_place;
}

}  // namespace

std::vector<SeamPoint> seam_points(const Scene& scene, const AtlasLayout& atlas) {
    const Adjacency mesh = adjacency(scene);
    const AtlasLookup lookup(atlas);
    std::vector<SeamPoint> out;
    for (const MeshEdge& edge : mesh.edges) {
        if (edge.kind != EdgeKind::manifold) continue;
        const Side a(scene, atlas, mesh.uses[edge.first_use]);
        const Side b(scene, atlas, mesh.uses[edge.first_use + 1]);
        if (a.chart == no_chart || b.chart == no_chart || !is_cut(a, b) || !is_smooth(scene, a, b))
            continue;
        const double texels =
            std::max(glm::distance(a.place[0], a.place[1]), glm::distance(b.place[0], b.place[1]));
        const int points = std::max(1, static_cast<int>(std::ceil(texels)));
        const double length = glm::distance(a.position[0], a.position[1]) / points;
        for (int i = 0; i < points; ++i) {
            const double t = (i + 0.5) / points;
            const SeamPoint point{{lookup.at(a.chart, glm::mix(a.place[0], a.place[1], t)),
                                   lookup.at(b.chart, glm::mix(b.place[0], b.place[1], t))},
                                  length};
            if (point.side[0].count > 0 && point.side[1].count > 0) out.push_back(point);
        }
    }
    return out;
}

AtlasSeams atlas_seams(const Scene& scene, const AtlasLayout& atlas,
                       const std::vector<glm::vec3>& irradiance) {
    need_layout_of("atlas_seams", scene, atlas);
    need_light_of("atlas_seams", atlas, irradiance.size());
    AtlasSeams out;
    double light = 0.0, area = 0.0;
    for (std::size_t i = 0; i < irradiance.size(); ++i) {
        light += double{atlas.texels[i].area} * luminance(glm::dvec3(irradiance[i]));
        area += double{atlas.texels[i].area};
    }
    std::vector<std::pair<double, double>> jumps;  // size and length
    double squares = 0.0;
    for (const SeamPoint& point : seam_points(scene, atlas)) {
        const double jump =
            luminance(point.side[0].of(irradiance)) - luminance(point.side[1].of(irradiance));
        squares += point.length * jump * jump;
        out.length += point.length;
        jumps.emplace_back(std::abs(jump), point.length);
    }
    if (!(out.length > 0.0) || light == 0.0) return out;
    const double mean = light / area;
    out.difference = std::sqrt(squares / out.length) / mean;
    out.worst = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(out.difference)) return out;
    std::sort(jumps.begin(), jumps.end());
    double longer = out.length;  // than this and all before it
    for (const auto& [jump, length] : jumps) {
        out.worst = jump / mean;
        longer -= length;
        if (longer <= 0.01 * out.length) break;
    }
    return out;
}

}  // namespace clgi
