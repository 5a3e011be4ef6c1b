// SPDX-License-Identifier: MIT
#include "methods/light_atlas/flatten.hpp"

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "methods/light_atlas/overlap.hpp"
#include "methods/light_atlas/placement.hpp"
#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

using Triangles = std::vector<std::uint32_t>;

// Axes of a plane with this normal; (first, second, normal) is right-handed.
std::pair<glm::dvec3, glm::dvec3> axes_of(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const glm::dvec3 least = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                             : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                  : glm::dvec3(0, 0, 1);
    const glm::dvec3 first = glm::normalize(glm::cross(least, normal));
    return {first, glm::cross(normal, first)};
}

class Flattener {
public:
    Flattener(const Scene& scene, const Adjacency* mesh)
        : scene_(scene), place_(scene.triangles.size()), mesh_(mesh) {
        for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
            areas_.push_back(doubled_area_of(scene, t));
    }

    bool has_area(std::uint32_t triangle) const { return glm::length(areas_[triangle]) > 0.0; }

    // Splits a region until each part lies flat in its plane.
    void add(std::uint32_t region, Triangles triangles) {
        std::vector<Task> tasks;
        tasks.push_back({std::move(triangles), std::nullopt});
        while (!tasks.empty()) {
            Task task = std::move(tasks.back());
            tasks.pop_back();
            const glm::dvec3 normal = task.normal ? *task.normal : plane_of(task.triangles);
            Triangles kept, rest;
            for (const std::uint32_t t : task.triangles)
                (lies_in(t, normal) ? kept : rest).push_back(t);
            if (!rest.empty()) {
                for (Triangles& part : pieces(rest)) tasks.push_back({std::move(part), {}});
                tasks.push_back({std::move(kept), normal});
                continue;
            }
            FlatChart chart{region, std::move(task.triangles), {}, {}};
            project(chart, normal);
            std::vector<Triangles> sheets = sheets_of(chart);
            if (sheets.size() > 1) {
                for (Triangles& sheet : sheets) tasks.push_back({std::move(sheet), {}});
                continue;
            }
            chart.extent = turn_upright(chart.corners);
            charts_.push_back(std::move(chart));
        }
    }

    std::vector<FlatChart> take() { return std::move(charts_); }

private:
    struct Task {
        Triangles triangles;
        std::optional<glm::dvec3> normal;  // of the plane; none: their own
    };

    bool lies_in(std::uint32_t t, const glm::dvec3& normal) const {
        return glm::dot(areas_[t], normal) >= least_share * glm::length(areas_[t]);
    }

    // The mean normal, or that of the largest triangle where the mean fits none of them, as for a
    // closed surface: at least one triangle lies in the plane.
    glm::dvec3 plane_of(const Triangles& triangles) const {
        glm::dvec3 sum(0.0);
        double total = 0.0, largest = -1.0;
        std::uint32_t chosen = triangles.front();
        for (const std::uint32_t t : triangles) {
            const double area = glm::length(areas_[t]);
            sum += areas_[t];
            total += area;
            if (area > largest) {
                largest = area;
                chosen = t;
            }
        }
        if (glm::length(sum) > 1e-6 * total) {
            const glm::dvec3 mean = glm::normalize(sum);
            for (const std::uint32_t t : triangles)
                if (lies_in(t, mean)) return mean;
        }
        return areas_[chosen] / largest;
    }

    // Corners relative to one of them: positions may be far from the origin.
    void project(FlatChart& chart, const glm::dvec3& normal) const {
        const auto [first, second] = axes_of(normal);
        const auto position = [&](std::uint32_t t, int k) {
            return scene_.positions[scene_.triangles[t].vertex[k]];
        };
        const glm::dvec3 origin = position(chart.triangles.front(), 0);
        chart.corners.reserve(3 * chart.triangles.size());
        for (const std::uint32_t t : chart.triangles)
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 at = position(t, k) - origin;
                chart.corners.emplace_back(glm::dot(at, first), glm::dot(at, second));
            }
    }

    const Adjacency& mesh() {
        if (!mesh_) mesh_ = &made_.emplace(adjacency(scene_));
        return *mesh_;
    }

    // For every index into `triangles`, visit(index, neighbour's index).
    template <typename Visit>
    void each_neighbour(const Triangles& triangles, Visit&& visit) {
        for (std::uint32_t i = 0; i < triangles.size(); ++i) place_[triangles[i]] = i;
        for (std::uint32_t i = 0; i < triangles.size(); ++i)
            for (const std::uint32_t other : mesh().neighbours[triangles[i]]) {
                if (other == no_index) continue;
                const std::uint32_t at = place_[other];
                if (at < triangles.size() && triangles[at] == other) visit(i, at);
            }
    }

    // What edges connect.
    std::vector<Triangles> pieces(const Triangles& triangles) {
        DisjointSets sets(triangles.size());
        each_neighbour(triangles, [&](std::uint32_t a, std::uint32_t b) { sets.join(a, b); });
        std::vector<Triangles> out;
        const std::vector<std::uint32_t> number = sets.numbered();
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            if (number[i] == out.size()) out.emplace_back();
            out[number[i]].push_back(triangles[i]);
        }
        return out;
    }

    // Indices from neighbour to neighbour, so that a sheet is followed where it leads.
    std::vector<std::uint32_t> walk(const Triangles& triangles) {
        std::vector<std::vector<std::uint32_t>> beside(triangles.size());
        each_neighbour(triangles,
                       [&](std::uint32_t a, std::uint32_t b) { beside[a].push_back(b); });
        std::vector<std::uint32_t> out;
        std::vector<bool> seen(triangles.size());
        for (std::uint32_t start = 0; start < triangles.size(); ++start) {
            if (seen[start]) continue;
            seen[start] = true;
            out.push_back(start);
            for (std::size_t next = out.size() - 1; next < out.size(); ++next)
                for (const std::uint32_t other : beside[out[next]]) {
                    if (seen[other]) continue;
                    seen[other] = true;
                    out.push_back(other);
                }
        }
        return out;
    }

    // Parts without overlap; one where there is none.
    std::vector<Triangles> sheets_of(const FlatChart& chart) {
        glm::dvec2 low(1e300), high(-1e300);
        for (const glm::dvec2& corner : chart.corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        // Neighbours may come as far onto each other as their vertices were rounded.
        const auto pairs = overlapping(chart.corners, 1e-5 * glm::length(high - low));
        if (pairs.empty()) return {};
        std::vector<std::vector<std::uint32_t>> under(chart.triangles.size());
        for (const auto& [a, b] : pairs) {
            under[a].push_back(b);
            under[b].push_back(a);
        }
        constexpr std::uint32_t none = 0xffffffffu;
        std::vector<std::uint32_t> sheet(chart.triangles.size(), none);
        std::vector<Triangles> out;
        for (const std::uint32_t i : walk(chart.triangles)) {
            std::vector<bool> taken(out.size());
            for (const std::uint32_t other : under[i])
                if (sheet[other] != none) taken[sheet[other]] = true;
            const auto free = std::find(taken.begin(), taken.end(), false);
            sheet[i] = static_cast<std::uint32_t>(free - taken.begin());
            if (free == taken.end()) out.emplace_back();
            out[sheet[i]].push_back(chart.triangles[i]);
        }
        return out;
    }

    const Scene& scene_;
    std::vector<glm::dvec3> areas_;     // doubled, along the normals, m^2
    std::vector<std::uint32_t> place_;  // of a triangle in the list looked at last
    const Adjacency* mesh_;             // null until something has to be split
    std::optional<Adjacency> made_;     // where none was given
    std::vector<FlatChart> charts_;
};

}  // namespace

std::vector<FlatChart> flatten(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                               const Adjacency* mesh) {
    Flattener out(scene, mesh);
    // Regions have any numbers; in the order in which they appear they are always the same.
    std::map<std::uint32_t, std::size_t> place;
    std::vector<std::pair<std::uint32_t, Triangles>> regions;
    for (std::uint32_t t = 0; t < region_of.size(); ++t) {
        if (region_of[t] == no_chart || !out.has_area(t)) continue;
        const auto [found, is_new] = place.try_emplace(region_of[t], regions.size());
        if (is_new) regions.push_back({region_of[t], {}});
        regions[found->second].second.push_back(t);
    }
    for (auto& [region, triangles] : regions) out.add(region, std::move(triangles));
    return out.take();
}

}  // namespace clgi
