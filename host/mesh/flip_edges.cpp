// SPDX-License-Identifier: MIT
#include "mesh/flip_edges.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace clgi::mesh {
namespace {

constexpr double turned_away = 0.5;  // cosine to the surface below which a triangle is looked at
constexpr double gain = 1e-6;        // less is rounding, and flips could go round in circles
constexpr int most_passes = 16;

using Edge = std::pair<unsigned int, unsigned int>;

class Mesh {
public:
    Mesh(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
         std::vector<unsigned int>& indices)
        : positions_(positions), normals_(normals), indices_(indices) {
        for (unsigned int t = 0; t < indices.size() / 3; ++t)
            for (unsigned int k = 0; k < 3; ++k) ++uses_[side(t, k)];
    }

    // Whether something was flipped.
    bool pass() {
        std::map<Edge, unsigned int> opposite;  // triangle and side of every directed edge
        for (unsigned int i = 0; i < indices_.size(); ++i) opposite[side(i / 3, i % 3)] = i;
        std::vector<bool> done(indices_.size() / 3, false);
        bool flipped = false;
        for (unsigned int i = 0; i < indices_.size(); ++i) {
            const Edge ab = side(i / 3, i % 3);
            const auto other = opposite.find({ab.second, ab.first});
            if (other == opposite.end() || done[i / 3] || done[other->second / 3]) continue;
            if (!flip(i, other->second)) continue;
            done[i / 3] = done[other->second / 3] = flipped = true;
        }
        return flipped;
    }

private:
    Edge side(unsigned int triangle, unsigned int k) const {
        return {indices_[3 * triangle + k], indices_[3 * triangle + (k + 1) % 3]};
    }
    unsigned int across(unsigned int i) const { return indices_[i / 3 * 3 + (i + 2) % 3]; }

    // Cosine between the triangle and the fine surface at its corners; -1 of one without area.
    double facing(unsigned int a, unsigned int b, unsigned int c) const {
        const glm::dvec3 p(positions_[a]);
        const glm::dvec3 n =
            glm::cross(glm::dvec3(positions_[b]) - p, glm::dvec3(positions_[c]) - p);
        const glm::dvec3 surface(normals_[a] + normals_[b] + normals_[c]);
        const double length = glm::length(n) * glm::length(surface);
        return length > 0.0 ? glm::dot(n, surface) / length : -1.0;
    }

    bool there(unsigned int a, unsigned int b) const {
        const auto is = [&](const Edge& edge) {
            const auto found = uses_.find(edge);
            return found != uses_.end() && found->second > 0;
        };
        return is({a, b}) || is({b, a});
    }

    // i and j: sides of two triangles along one edge, in opposite directions.
    bool flip(unsigned int i, unsigned int j) {
        const Edge ab = side(i / 3, i % 3);
        const unsigned int a = ab.first, b = ab.second, c = across(i), d = across(j);
        // Three and more triangles along one edge stay as they are.
        if (c == d || uses_[ab] != 1 || uses_[{b, a}] != 1 || there(c, d)) return false;
        const double now = std::min(facing(a, b, c), facing(b, a, d));
        if (now > turned_away) return false;
        if (std::min(facing(c, a, d), facing(d, b, c)) < now + gain) return false;
        const unsigned int first[3] = {c, a, d}, second[3] = {d, b, c};
        std::copy(first, first + 3, &indices_[i / 3 * 3]);
        std::copy(second, second + 3, &indices_[j / 3 * 3]);
        uses_[ab] = uses_[{b, a}] = 0;
        uses_[{c, d}] = uses_[{d, c}] = 1;
        return true;
    }

    const std::vector<glm::vec3>& positions_;
    const std::vector<glm::vec3>& normals_;
    std::vector<unsigned int>& indices_;
    std::map<Edge, int> uses_;  // of directed edges
};

}  // namespace

void flip_edges(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
                std::vector<unsigned int>& indices) {
    Mesh mesh(positions, normals, indices);
    for (int i = 0; i < most_passes && mesh.pass(); ++i) {
    }
}

}  // namespace clgi::mesh
