// SPDX-License-Identifier: MIT
#include <clgi/advanced/vpl_layout.hpp>

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "methods/light_atlas/even_points.hpp"
#include "methods/light_atlas/regions.hpp"
#include "methods/light_atlas/sites.hpp"
#include "methods/light_atlas/strips.hpp"
#include "methods/light_atlas/vpl_count.hpp"
#include "methods/light_atlas/walls.hpp"
#include "scene/coverage.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t most_samples_per_vpl = 4096;
constexpr double most_samples = 1u << 28;
constexpr double most_gap_density = 1000.0;
constexpr double least_coverage = 1.0 / 1024.0;  // no VPL is without area

// Shares of a cell. VPLs keep off each other and off borders; what they leave is in rows, so a
// little remains. Samples count what is hidden behind straight edges, and rows may be parallel to
// these.
constexpr double site_jitter = 0.25, sample_jitter = 0.5;

// Height above the surface, as a share of the way, at which what stands on it divides two points.
constexpr double walk_lift = 1.0 / 64.0;

[[noreturn]] void fail(const char* name, const std::string& got, const std::string& needs) {
    throw Error(std::string("place_vpls: ") + name + " is " + got + ", needs " + needs);
}

}  // namespace

double area_of(const Patches& patches) {
    double out = 0.0;
    for (const Patch& patch : patches.patches) out += (patch.double_sided ? 2.0 : 1.0) * patch.area;
    return out;
}

std::uint32_t vpl_count(const Scene& scene, const Patches& patches, const VplOptions& options) {
    if (patches.triangle_patch.size() != scene.triangles.size())
        fail("patches", "of " + std::to_string(patches.triangle_patch.size()) + " triangles",
             "the scene's " + std::to_string(scene.triangles.size()));
    if (options.samples_per_vpl < 1 || options.samples_per_vpl > most_samples_per_vpl)
        fail("samples_per_vpl", std::to_string(options.samples_per_vpl),
             "1 to " + std::to_string(most_samples_per_vpl));
    if (!(options.density >= 0.0 && std::isfinite(options.density)))
        fail("density", std::to_string(options.density), "a number of at least 0");
    if (!(options.gap_density >= 1.0 && options.gap_density <= most_gap_density))
        fail("gap_density", std::to_string(options.gap_density),
             "1 to " + std::to_string(most_gap_density));
    const bool by_density = options.density > 0.0;
    const double count = by_density ? std::max(1.0, std::round(options.density * area_of(patches)))
                                    : double(options.count);
    if (!(count >= 1.0 && count <= double(options.most)))
        fail(by_density ? "density times area" : "count", std::to_string(count),
             "1 to " + std::to_string(options.most) + " (most)");
    if (count * options.samples_per_vpl > most_samples)
        fail("count times samples_per_vpl", std::to_string(count * options.samples_per_vpl),
             "at most " + std::to_string(most_samples));
    return static_cast<std::uint32_t>(count);
}

namespace {

struct Frame {
    glm::dvec3 x, y, z;  // unit, orthogonal
};

// z is the normal. x lies along the borders of the region, as well as a cross can: the mean of the
// fourth powers of their directions.
Frame frame_of(const Scene& scene, const Patches& patches,
               const std::vector<std::uint32_t>& patch_region,
               const std::vector<std::uint32_t>& triangles, std::uint32_t number,
               const glm::dvec3& normal) {
    const glm::dvec3 away = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(away - glm::dot(away, normal) * normal);
    const glm::dvec3 y = glm::cross(normal, x);
    double real = 0.0, imaginary = 0.0;
    for (const std::uint32_t t : triangles)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t next = patches.neighbours[t][k];
            if (next != no_index && patch_region[patches.triangle_patch[next]] == number) continue;
            const auto& vertex = scene.triangles[t].vertex;
            const glm::dvec3 side =
                scene.positions[vertex[(k + 1) % 3]] - scene.positions[vertex[k]];
            const double a = glm::dot(side, x), b = glm::dot(side, y);
            const double angle = 4.0 * std::atan2(b, a), length = std::hypot(a, b);
            real += length * std::cos(angle);
            imaginary += length * std::sin(angle);
        }
    const double turn = 0.25 * std::atan2(imaginary, real);
    return {std::cos(turn) * x + std::sin(turn) * y, std::cos(turn) * y - std::sin(turn) * x,
            normal};
}

// Weights in floats that still lie in the triangle.
SamplePoint sample_of(std::uint32_t triangle, const glm::dvec2& b) {
    SamplePoint out{triangle, std::clamp(static_cast<float>(b.x), 0.0f, 1.0f),
                    std::clamp(static_cast<float>(b.y), 0.0f, 1.0f)};
    while (1.0f - out.b1 - out.b2 < 0.0f || out.b1 + out.b2 > 1.0f) {
        float& larger = out.b1 > out.b2 ? out.b1 : out.b2;
        larger = std::nextafter(larger, 0.0f);
    }
    return out;
}

// What place_vpls fills, region by region.
class Placement {
public:
    Placement(const Scene& scene, const Patches& patches, VplLayout& out)
        : scene_(scene), patches_(patches), out_(out), walls_(scene), coverage_(scene) {}

    // Metres along the axes of its frame.
    glm::dvec3 size_of(const Region& region, std::uint32_t number) const {
        const std::vector<std::uint32_t> triangles = triangles_of(region);
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const PieceTriangle& t : pieces_of(triangles, frame(region, number, triangles)))
            for (const glm::dvec3& p : {t.first, t.first + t.edge1, t.first + t.edge2}) {
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
        return high - low;
    }

    void place(const Region& region, std::uint32_t number, std::uint32_t sample_count,
               const glm::dvec3& stretch) {
        const std::vector<std::uint32_t> triangles = triangles_of(region);
        std::vector<PieceTriangle> pieces = pieces_of(triangles, frame(region, number, triangles));
        for (PieceTriangle& t : pieces) {  // areas only count relative to each other
            t.first *= stretch;
            t.edge1 *= stretch;
            t.edge2 *= stretch;
        }

        const Points sites = spread(pieces, triangles, region.vpls, site_jitter);
        Points samples = sites;
        std::vector<std::uint32_t> owner(region.vpls);
        std::iota(owner.begin(), owner.end(), 0u);
        if (sample_count > region.vpls) {
            samples = spread(pieces, triangles, sample_count, sample_jitter);
            owner = nearest_sites(
                samples.positions, sites.positions, [&](std::uint32_t i, std::uint32_t s) {
                    return divided(region, number, samples.points[i], sites.points[s]);
                });
        }
        append(region, number, sites.points, samples.points, owner);
    }

private:
    std::vector<std::uint32_t> triangles_of(const Region& region) const {
        std::vector<std::uint32_t> out;
        for (const std::uint32_t p : region.patches) {
            const auto first = patches_.triangles.begin() + patches_.patches[p].first;
            out.insert(out.end(), first, first + patches_.patches[p].count);
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    Frame frame(const Region& region, std::uint32_t number,
                const std::vector<std::uint32_t>& triangles) const {
        return frame_of(scene_, patches_, out_.patch_region, triangles, number, region.normal);
    }

    std::vector<PieceTriangle> pieces_of(const std::vector<std::uint32_t>& triangles,
                                         const Frame& frame) const {
        const auto corner = [&](std::uint32_t t, int k) {
            return scene_.positions[scene_.triangles[t].vertex[k]];
        };
        const auto turned = [&](const glm::dvec3& d) {
            return glm::dvec3(glm::dot(d, frame.x), glm::dot(d, frame.y), glm::dot(d, frame.z));
        };
        const glm::dvec3 origin = corner(triangles[0], 0);
        std::vector<PieceTriangle> out;
        out.reserve(triangles.size());
        for (const std::uint32_t t : triangles) {
            const glm::dvec3 first = corner(t, 0);
            const glm::dvec3 edge1 = turned(corner(t, 1) - first);
            const glm::dvec3 edge2 = turned(corner(t, 2) - first);
            out.push_back(
                {turned(first - origin), edge1, edge2, glm::length(glm::cross(edge1, edge2))});
        }
        return out;
    }

    struct Points {
        std::vector<SamplePoint> points;
        std::vector<glm::dvec3> positions;  // of the rounded points, metres, in the region's frame
    };

    static Points spread(const std::vector<PieceTriangle>& pieces,
                         const std::vector<std::uint32_t>& triangles, std::uint32_t count,
                         double jitter) {
        Points out;
        for (const EvenPoint& point : even_points(pieces, count, jitter)) {
            const PieceTriangle& t = pieces[point.triangle];
            const SamplePoint s = sample_of(triangles[point.triangle], point.b);
            out.points.push_back(s);
            out.positions.push_back(t.first + double{s.b1} * t.edge1 + double{s.b2} * t.edge2);
        }
        return out;
    }

    // Does another surface stand between two points, on a side that counts? The way from one to the
    // other runs a little above the surface; across a convex one it would run inside, which says
    // nothing.
    bool divided(const Region& region, std::uint32_t number, const SamplePoint& a,
                 const SamplePoint& b) const {
        const SurfacePoint from = surface_point(a), to = surface_point(b);
        const glm::dvec3 way = to.position - from.position;
        const double lift = walk_lift * glm::length(way);
        const auto counts = [&](std::uint32_t triangle) {
            const std::uint32_t patch = patches_.triangle_patch[triangle];
            return patch == no_index || out_.patch_region[patch] != number;
        };
        for (const double side : {lift, -lift}) {
            if (side < 0.0 && !region.double_sided) continue;
            const double sign = side < 0.0 ? -1.0 : 1.0;
            if (sign * glm::dot(way, from.normal) < -lift) continue;
            if (sign * glm::dot(way, to.normal) > lift) continue;
            if (walls_.between(from.position + side * from.normal, to.position + side * to.normal,
                               counts))
                return true;
        }
        return false;
    }

    struct SurfacePoint {
        glm::dvec3 position, normal;
    };

    SurfacePoint surface_point(const SamplePoint& point) const {
        const auto& vertex = scene_.triangles[point.triangle].vertex;
        const glm::dvec3 first = scene_.positions[vertex[0]];
        const glm::dvec3 edge1 = scene_.positions[vertex[1]] - first;
        const glm::dvec3 edge2 = scene_.positions[vertex[2]] - first;
        return {first + double{point.b1} * edge1 + double{point.b2} * edge2,
                glm::normalize(glm::cross(edge1, edge2))};
    }

    double coverage_at(const SamplePoint& point) const {
        const double b1 = point.b1, b2 = point.b2;
        return coverage_(scene_.triangles[point.triangle], {1.0 - b1 - b2, b1, b2});
    }

    void append(const Region& region, std::uint32_t number, const std::vector<SamplePoint>& sites,
                const std::vector<SamplePoint>& samples, const std::vector<std::uint32_t>& owner) {
        std::vector<std::vector<std::uint32_t>> members(sites.size());
        for (std::uint32_t i = 0; i < samples.size(); ++i) members[owner[i]].push_back(i);
        for (std::size_t s = 0; s < sites.size(); ++s)
            for (const bool back : {false, true}) {
                if (back && !region.double_sided) continue;
                const double share = double(members[s].size()) / double(samples.size());
                double covers = 0.0;
                for (const std::uint32_t i : members[s]) covers += coverage_at(samples[i]);
                covers = std::max(covers / double(members[s].size()), least_coverage);
                out_.vpls.push_back({sites[s].triangle, sites[s].b1, sites[s].b2,
                                     static_cast<std::uint32_t>(out_.samples.size()),
                                     static_cast<std::uint32_t>(members[s].size()), number,
                                     static_cast<float>(share * region.area), back,
                                     static_cast<float>(covers)});
                for (const std::uint32_t i : members[s]) out_.samples.push_back(samples[i]);
            }
    }

    const Scene& scene_;
    const Patches& patches_;
    VplLayout& out_;
    const Walls walls_;
    const Coverage coverage_;
};

}  // namespace

VplLayout place_vpls(const Scene& scene, const Patches& patches, const VplOptions& options) {
    VplLayout out;
    out.area = area_of(patches);
    const std::uint32_t count = vpl_count(scene, patches, options);
    std::vector<Region> regions = make_regions(patches, count);
    out.region_count = static_cast<std::uint32_t>(regions.size());
    out.patch_region.assign(patches.patches.size(), no_index);
    for (std::uint32_t r = 0; r < regions.size(); ++r)
        for (const std::uint32_t p : regions[r].patches) out.patch_region[p] = r;

    Placement placement(scene, patches, out);
    std::vector<glm::dvec3> sizes;
    std::vector<double> extents;
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
        sizes.push_back(placement.size_of(regions[r], r));
        extents.push_back(std::max(sizes[r].x, sizes[r].y));
    }
    raise_density(regions, extents, out.area / count, options.gap_density);
    share_out(regions, count);

    double weight = 0.0;
    for (const Region& region : regions)
        weight += (region.double_sided ? 2.0 : 1.0) * region.density * region.area;
    const double wanted = double(count) * options.samples_per_vpl;
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
        const Region& region = regions[r];
        const double share = region.density * region.area / weight * wanted;
        placement.place(region, r,
                        std::max(region.vpls, static_cast<std::uint32_t>(std::lround(share))),
                        region.density > 1.0 ? stretch_of(sizes[r]) : glm::dvec3(1.0));
    }
    if (!out.samples.empty()) out.sample_area = out.area / double(out.samples.size());
    return out;
}

}  // namespace clgi
