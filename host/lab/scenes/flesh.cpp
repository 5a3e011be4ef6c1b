// SPDX-License-Identifier: MIT
#include "lab/scenes/flesh.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "lab/scenes/remesh.hpp"

namespace clgi::generated {

Slope Bone::slope(const glm::dvec3& p) const {
    const glm::dvec3 axis = to - from;
    const double square = glm::dot(axis, axis);
    const double along = square > 0.0 ? glm::dot(p - from, axis) / square : 0.0;
    const double share = std::clamp(along, 0.0, 1.0);
    const glm::dvec3 beside = p - from - share * axis;
    const double length = glm::length(beside);
    Slope out{length - glm::mix(from_radius, to_radius, share),
              length > 0.0 ? beside / length : glm::dvec3(0.0)};
    if (square > 0.0 && along == share) out.gradient -= (to_radius - from_radius) / square * axis;
    return out;
}

void Flesh::add_pair(std::uint32_t left, std::uint32_t right, const glm::dvec3& from,
                     const glm::dvec3& to, double from_radius, double to_radius) {
    const glm::dvec3 mirror(-1.0, 1.0, 1.0);
    bones.push_back({left, from, to, from_radius, to_radius});
    bones.push_back({right, from * mirror, to * mirror, from_radius, to_radius});
}

Slope Flesh::slope(const glm::dvec3& p) const {
    std::vector<Slope> each;
    each.reserve(bones.size());
    double least = INFINITY;
    for (const Bone& bone : bones) {
        each.push_back(bone.slope(p));
        least = std::min(least, each.back().distance);
    }
    double sum = 0.0;
    glm::dvec3 gradient(0.0);
    for (const Slope& one : each) {
        const double beyond = (one.distance - least) / blend;
        if (beyond >= 30.0) continue;
        const double weight = std::exp(-beyond);
        sum += weight;
        gradient += weight * one.gradient;
    }
    return {least - blend * std::log(sum), gradient / sum};
}

glm::dvec3 Flesh::leave(const glm::dvec3& from, const glm::dvec3& direction, double gap) const {
    double inside = 0.0, outside = 0.0;
    while (slope(from + outside * direction).distance < gap) {
        inside = outside;
        outside += 0.25 * blend;
    }
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (inside + outside);
        (slope(from + middle * direction).distance < gap ? inside : outside) = middle;
    }
    return from + outside * direction;
}

namespace {

// Marching tetrahedra: six in each cell of a grid, all around the same diagonal, so that neighbours
// fit. A vertex on each edge that the surface crosses. [derived: Doi and Koide 1991]
FleshMesh march(const Flesh& flesh, double cell) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const Bone& bone : flesh.bones)
        for (const auto& [place, radius] :
             {std::pair(bone.from, bone.from_radius), std::pair(bone.to, bone.to_radius)}) {
            low = glm::min(low, place - radius - 4.0 * flesh.blend);
            high = glm::max(high, place + radius + 4.0 * flesh.blend);
        }
    const glm::ivec3 size = glm::ivec3((high - low) / cell) + 2;
    const auto node = [&](const glm::ivec3& i) {
        return (static_cast<std::uint32_t>(i.z) * static_cast<std::uint32_t>(size.y) +
                static_cast<std::uint32_t>(i.y)) *
                   static_cast<std::uint32_t>(size.x) +
               static_cast<std::uint32_t>(i.x);
    };
    const auto place = [&](const glm::ivec3& i) { return low + cell * glm::dvec3(i); };
    std::vector<double> values;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                values.push_back(flesh.slope(place({x, y, z})).distance);

    FleshMesh mesh;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings;
    const auto crossing = [&](const glm::ivec3& a, const glm::ivec3& b) {
        const auto [found, fresh] = crossings.try_emplace(
            std::minmax(node(a), node(b)), static_cast<std::uint32_t>(mesh.positions.size()));
        if (fresh) {
            const double from = values[node(a)], to = values[node(b)];
            // Away from the ends, where triangles would have no area.
            const double share = std::clamp(from / (from - to), 0.1, 0.9);
            mesh.positions.push_back(glm::mix(place(a), place(b), share));
        }
        return found->second;
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c,
                         const glm::dvec3& outward) {
        const glm::dvec3& p = mesh.positions[a];
        const glm::dvec3 normal = glm::cross(mesh.positions[b] - p, mesh.positions[c] - p);
        if (glm::dot(normal, outward) < 0.0) std::swap(b, c);
        mesh.triangles.push_back({a, b, c});
    };
    const auto tetrahedron = [&](const std::array<glm::ivec3, 4>& corners) {
        std::vector<glm::ivec3> in, out;
        for (const glm::ivec3& corner : corners)
            (values[node(corner)] < 0.0 ? in : out).push_back(corner);
        if (in.empty() || out.empty()) return;
        glm::dvec3 outward(0.0);
        for (const glm::ivec3& corner : out) outward += glm::dvec3(corner) / double(out.size());
        for (const glm::ivec3& corner : in) outward -= glm::dvec3(corner) / double(in.size());
        if (in.size() == 2) {
            const std::uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                                c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
            add(a, b, c, outward);
            add(a, c, d, outward);
            return;
        }
        const glm::ivec3 single = in.size() == 1 ? in[0] : out[0];
        const std::vector<glm::ivec3>& others = in.size() == 1 ? out : in;
        add(crossing(single, others[0]), crossing(single, others[1]), crossing(single, others[2]),
            outward);
    };
    constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int z = 0; z + 1 < size.z; ++z)
        for (int y = 0; y + 1 < size.y; ++y)
            for (int x = 0; x + 1 < size.x; ++x)
                for (const auto& order : orders) {
                    std::array<glm::ivec3, 4> corners;
                    corners.fill({x, y, z});
                    for (std::size_t k = 0; k < 3; ++k)
                        for (std::size_t later = k + 1; later < 4; ++later)
                            ++corners[later][order[k]];
                    tetrahedron(corners);
                }
    return mesh;
}

}  // namespace

FleshMesh mesh_of(const Flesh& flesh, std::size_t vertices) {
    const auto project = [&](const glm::dvec3& p) {
        glm::dvec3 at = p;
        for (int i = 0; i < 2; ++i) {
            const auto [distance, gradient] = flesh.slope(at);
            at -= gradient * (distance / std::max(glm::dot(gradient, gradient), 0.1));
        }
        return at;
    };
    // An equilateral triangle of edge e has the area sqrt(3) / 4 e^2, and there are two a vertex.
    const auto edge_for = [&](double area) {
        return std::sqrt(2.0 * area / (std::sqrt(3.0) * static_cast<double>(vertices)));
    };
    FleshMesh coarse = march(flesh, 1.5 * flesh.blend);
    if (coarse.triangles.size() + 4 != 2 * coarse.positions.size())
        throw Error("scene: a body of " + std::to_string(coarse.positions.size()) +
                    " vertices and " + std::to_string(coarse.triangles.size()) +
                    " triangles is not one closed surface without handles");
    Remesher remesher(std::move(coarse), project);
    double edge = edge_for(remesher.area());
    for (int attempt = 0; attempt < 3; ++attempt) {
        remesher.even_out(edge, attempt == 0 ? 5 : 2);
        edge *= std::sqrt(static_cast<double>(remesher.vertices()) / static_cast<double>(vertices));
    }
    remesher.reach(vertices);
    remesher.relax(3);
    remesher.iron();
    return remesher.mesh();
}

std::vector<std::vector<double>> weights_of(const Flesh& flesh, const FleshMesh& mesh,
                                            const std::vector<int>& parents, int smoothings) {
    const std::size_t joints = parents.size();
    std::vector<std::vector<double>> weights;
    for (const glm::dvec3& p : mesh.positions) {
        std::vector<double> distances(joints, INFINITY);
        for (const Bone& bone : flesh.bones)
            distances[bone.joint] = std::min(distances[bone.joint], bone.slope(p).distance);
        const auto nearest = static_cast<std::size_t>(
            std::min_element(distances.begin(), distances.end()) - distances.begin());
        std::vector<double> shares(joints, 0.0);
        double sum = 0.0;
        for (std::size_t j = 0; j < joints; ++j) {
            const bool related = j == nearest || parents[j] == static_cast<int>(nearest) ||
                                 parents[nearest] == static_cast<int>(j);
            if (!related) continue;
            shares[j] = std::exp(-(distances[j] - distances[nearest]) / flesh.blend);
            sum += shares[j];
        }
        for (double& share : shares) share /= sum;
        weights.push_back(std::move(shares));
    }
    std::vector<std::vector<std::uint32_t>> beside(mesh.positions.size());
    for (const auto& corner : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) beside[corner[k]].push_back(corner[(k + 1) % 3]);
    for (int i = 0; i < smoothings; ++i) {
        const std::vector<std::vector<double>> before = weights;
        for (std::size_t v = 0; v < weights.size(); ++v)
            for (std::size_t j = 0; j < joints; ++j) {
                double sum = 0.0;
                for (const std::uint32_t other : beside[v]) sum += before[other][j];
                weights[v][j] =
                    0.5 * before[v][j] + 0.5 * sum / static_cast<double>(beside[v].size());
            }
    }
    return weights;
}

std::vector<std::vector<double>> weights_near(const std::vector<glm::dvec3>& points,
                                              const FleshMesh& mesh,
                                              const std::vector<std::vector<double>>& weights) {
    std::vector<std::vector<double>> out;
    for (const glm::dvec3& point : points) {
        const auto nearer = [&](const glm::dvec3& a, const glm::dvec3& b) {
            return glm::length(a - point) < glm::length(b - point);
        };
        const auto nearest = std::min_element(mesh.positions.begin(), mesh.positions.end(), nearer);
        out.push_back(weights[static_cast<std::size_t>(nearest - mesh.positions.begin())]);
    }
    return out;
}

}  // namespace clgi::generated
