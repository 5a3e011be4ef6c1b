// SPDX-License-Identifier: MIT
#include "lab/scenes/remesh.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

namespace clgi::generated {
namespace {

constexpr std::uint32_t nowhere = UINT32_MAX;

}  // namespace

Remesher::Remesher(FleshMesh mesh, Project project)
    : places_(std::move(mesh.positions)), project_(std::move(project)) {
    around_.resize(places_.size());
    alive_ = places_.size();
    triangles_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) attach(t, mesh.triangles[t]);
}

void Remesher::attach(std::size_t triangle, const Triangle& corners) {
    triangles_[triangle] = corners;
    for (const std::uint32_t v : corners) around_[v].push_back(triangle);
}

void Remesher::detach(std::size_t triangle) {
    for (const std::uint32_t v : triangles_[triangle]) {
        std::vector<std::size_t>& list = around_[v];
        list.erase(std::find(list.begin(), list.end(), triangle));
    }
    triangles_[triangle] = {nowhere, nowhere, nowhere};
}

double Remesher::length(std::uint32_t a, std::uint32_t b) const {
    return glm::length(places_[a] - places_[b]);
}

glm::dvec3 Remesher::cross_of(const Triangle& c) const {
    return glm::cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]);
}

double Remesher::area() const {
    double sum = 0.0;
    for (const Triangle& triangle : triangles_)
        if (triangle[0] != nowhere) sum += 0.5 * glm::length(cross_of(triangle));
    return sum;
}

std::uint32_t Remesher::opposite(std::uint32_t a, std::uint32_t b, std::size_t& triangle) const {
    for (const std::size_t t : around_[a])
        for (std::size_t k = 0; k < 3; ++k)
            if (triangles_[t][k] == a && triangles_[t][(k + 1) % 3] == b) {
                triangle = t;
                return triangles_[t][(k + 2) % 3];
            }
    return nowhere;
}

bool Remesher::has_edge(std::uint32_t a, std::uint32_t b) const {
    std::size_t ignored = 0;
    return opposite(a, b, ignored) != nowhere;
}

std::vector<std::array<std::uint32_t, 2>> Remesher::edges() const {
    std::vector<std::array<std::uint32_t, 2>> list;
    for (const Triangle& triangle : triangles_)
        for (std::size_t k = 0; k < 3; ++k)
            if (triangle[0] != nowhere && triangle[k] < triangle[(k + 1) % 3])
                list.push_back({triangle[k], triangle[(k + 1) % 3]});
    return list;
}

std::vector<std::uint32_t> Remesher::neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> list;
    for (const std::size_t t : around_[v])
        for (std::size_t k = 0; k < 3; ++k)
            if (triangles_[t][k] == v) list.push_back(triangles_[t][(k + 1) % 3]);
    return list;
}

glm::dvec3 Remesher::middle(std::uint32_t v) const {
    const std::vector<std::uint32_t> list = neighbours(v);
    glm::dvec3 sum(0.0);
    for (const std::uint32_t other : list) sum += places_[other];
    return sum / static_cast<double>(list.size());
}

glm::dvec3 Remesher::normal(std::uint32_t v) const {
    glm::dvec3 sum(0.0);
    for (const std::size_t t : around_[v]) sum += cross_of(triangles_[t]);
    return glm::normalize(sum);
}

// To the middle of the edge. Refused where the mesh would touch itself, where a triangle would turn
// over, and where an edge would be longer than the longest.
bool Remesher::collapse(std::uint32_t a, std::uint32_t b, double longest) {
    std::size_t left = 0, right = 0;
    const std::uint32_t c = opposite(a, b, left), d = opposite(b, a, right);
    if (c == nowhere || d == nowhere || c == d) return false;
    if (around_[c].size() <= 4 || around_[d].size() <= 4) return false;
    if (around_[a].size() + around_[b].size() > 14) return false;
    std::vector<std::uint32_t> of_a = neighbours(a), of_b = neighbours(b), both;
    std::sort(of_a.begin(), of_a.end());
    std::sort(of_b.begin(), of_b.end());
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                          std::back_inserter(both));
    if (both.size() != 2) return false;

    const glm::dvec3 centre = project_(0.5 * (places_[a] + places_[b]));
    for (const std::vector<std::uint32_t>* list : {&of_a, &of_b})
        for (const std::uint32_t v : *list)
            if (v != a && v != b && glm::length(places_[v] - centre) > longest) return false;
    for (const std::uint32_t end : {a, b})
        for (const std::size_t t : around_[end]) {
            if (t == left || t == right) continue;
            const glm::dvec3 before = cross_of(triangles_[t]);
            const glm::dvec3 kept = places_[end];
            places_[end] = centre;
            const glm::dvec3 after = cross_of(triangles_[t]);
            places_[end] = kept;
            if (glm::dot(before, after) < 0.25 * glm::length(before) * glm::length(after) ||
                glm::length(after) == 0.0)
                return false;
        }
    detach(left);
    detach(right);
    const std::vector<std::size_t> moved = around_[b];
    for (const std::size_t t : moved) {
        Triangle corners = triangles_[t];
        detach(t);
        std::replace(corners.begin(), corners.end(), b, a);
        attach(t, corners);
    }
    places_[a] = centre;
    --alive_;
    return true;
}

void Remesher::split(std::uint32_t a, std::uint32_t b) {
    std::size_t left = 0, right = 0;
    const std::uint32_t c = opposite(a, b, left), d = opposite(b, a, right);
    const auto centre = static_cast<std::uint32_t>(places_.size());
    places_.push_back(project_(0.5 * (places_[a] + places_[b])));
    around_.emplace_back();
    ++alive_;
    detach(left);
    detach(right);
    attach(left, {a, centre, c});
    attach(right, {b, centre, d});
    triangles_.resize(triangles_.size() + 2);
    attach(triangles_.size() - 2, {centre, b, c});
    attach(triangles_.size() - 1, {centre, a, d});
}

void Remesher::flip_edges() {
    for (const auto& [a, b] : edges()) {
        std::size_t left = 0, right = 0;
        const std::uint32_t c = opposite(a, b, left), d = opposite(b, a, right);
        if (c == nowhere || d == nowhere || c == d || has_edge(c, d) || has_edge(d, c)) continue;
        const auto off = [&](std::uint32_t v, int change) {
            return std::abs(static_cast<int>(around_[v].size()) + change - 6);
        };
        if (around_[a].size() <= 4 || around_[b].size() <= 4) continue;
        if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) >=
            off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0))
            continue;
        const Triangle first = {a, d, c}, second = {d, b, c};
        const glm::dvec3 before = cross_of(triangles_[left]) + cross_of(triangles_[right]);
        const double size = glm::length(before);
        const glm::dvec3 one = cross_of(first), two = cross_of(second);
        if (glm::dot(one, before) < 0.5 * size * glm::length(one) ||
            glm::dot(two, before) < 0.5 * size * glm::length(two))
            continue;
        detach(left);
        detach(right);
        attach(left, first);
        attach(right, second);
    }
}

void Remesher::relax(int rounds) {
    for (int round = 0; round < rounds; ++round) {
        std::vector<glm::dvec3> moved = places_;
        for (std::uint32_t v = 0; v < places_.size(); ++v) {
            if (around_[v].empty()) continue;
            const glm::dvec3 up = normal(v);
            glm::dvec3 way = middle(v) - places_[v];
            way -= up * glm::dot(up, way);
            moved[v] = project_(places_[v] + 0.6 * way);
        }
        places_ = std::move(moved);
    }
}

void Remesher::iron() {
    for (int round = 0; round < 64; ++round) {
        std::vector<bool> creased(places_.size());
        bool any = false;
        for (const Triangle& triangle : triangles_) {
            if (triangle[0] == nowhere) continue;
            const glm::dvec3 face = cross_of(triangle);
            for (const std::uint32_t v : triangle)
                if (glm::dot(face, normal(v)) < 0.05 * glm::length(face)) {
                    for (const std::uint32_t other : neighbours(v)) creased[other] = true;
                    creased[v] = true;
                    any = true;
                }
        }
        if (!any) return;
        std::vector<glm::dvec3> moved = places_;
        for (std::uint32_t v = 0; v < places_.size(); ++v)
            if (creased[v]) moved[v] = glm::mix(places_[v], middle(v), 0.5);
        places_ = std::move(moved);
    }
}

void Remesher::even_out(double edge, int rounds) {
    const double longest = edge * 4.0 / 3.0, shortest = edge * 4.0 / 5.0;
    for (int round = 0; round < rounds; ++round) {
        for (const auto& [a, b] : edges())
            if (length(a, b) > longest) split(a, b);
        for (const auto& [a, b] : edges())
            if (has_edge(a, b) && length(a, b) < shortest) collapse(a, b, longest);
        flip_edges();
        relax(2);
    }
}

void Remesher::reach(std::size_t vertices) {
    for (int attempt = 0; attempt < 64 && alive_ != vertices; ++attempt) {
        std::vector<std::array<std::uint32_t, 2>> list = edges();
        const bool fewer = alive_ > vertices;
        std::stable_sort(list.begin(), list.end(), [&](const auto& one, const auto& two) {
            const double p = length(one[0], one[1]), q = length(two[0], two[1]);
            return fewer ? p < q : p > q;
        });
        // No more than a few at once: what is changed is not the shortest or longest any more.
        list.resize(std::min(list.size(), std::size_t{64}));
        for (const auto& [a, b] : list) {
            if (alive_ == vertices || !has_edge(a, b)) continue;
            if (fewer) {
                collapse(a, b, INFINITY);
            } else {
                split(a, b);
            }
        }
        flip_edges();
        relax(1);
    }
    if (alive_ != vertices)
        throw Error("scene: a mesh has " + std::to_string(alive_) + " vertices, " +
                    std::to_string(vertices) + " needed");
}

FleshMesh Remesher::mesh() const {
    FleshMesh out;
    std::vector<std::uint32_t> number(places_.size(), nowhere);
    for (std::size_t v = 0; v < places_.size(); ++v) {
        if (around_[v].empty()) continue;
        number[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(places_[v]);
    }
    for (const Triangle& triangle : triangles_)
        if (triangle[0] != nowhere)
            out.triangles.push_back(
                {number[triangle[0]], number[triangle[1]], number[triangle[2]]});
    return out;
}

}  // namespace clgi::generated
