// SPDX-License-Identifier: MIT
#include "methods/transfer/rings.hpp"

#include <algorithm>
#include <utility>

namespace clgi {

Rings::Rings(std::vector<glm::uvec3> corners, std::uint32_t vertices)
    : corners_(std::move(corners)),
      first_(vertices + std::size_t{1}, 0),
      vertex_seen_(vertices, 0),
      triangle_seen_(corners_.size(), 0) {
    for (const glm::uvec3& t : corners_)
        for (int k = 0; k < 3; ++k) ++first_[t[k] + std::size_t{1}];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < corners_.size(); ++t)
        for (int k = 0; k < 3; ++k) around_[next[corners_[t][k]]++] = t;
}

std::vector<std::uint32_t> Rings::around(std::uint32_t vertex, int rings) {
    std::vector<std::uint32_t> vertices{vertex}, out;
    ++search_;
    vertex_seen_[vertex] = search_;
    std::size_t begin = 0;
    for (int ring = 0; ring <= rings; ++ring) {
        const std::size_t end = vertices.size();
        for (; begin < end; ++begin) add_triangles(vertices[begin], vertices, out);
    }
    std::sort(out.begin(), out.end());
    return out;
}

bool Rings::touches(std::uint32_t triangle, std::uint32_t vertex) const {
    const glm::uvec3& t = corners_[triangle];
    return t.x == vertex || t.y == vertex || t.z == vertex;
}

void Rings::add_triangles(std::uint32_t at, std::vector<std::uint32_t>& vertices,
                          std::vector<std::uint32_t>& triangles) {
    for (std::uint32_t i = first_[at]; i < first_[at + std::size_t{1}]; ++i) {
        const std::uint32_t t = around_[i];
        if (triangle_seen_[t] == search_) continue;
        triangle_seen_[t] = search_;
        triangles.push_back(t);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = corners_[t][k];
            if (vertex_seen_[other] == search_) continue;
            vertex_seen_[other] = search_;
            vertices.push_back(other);
        }
    }
}

}  // namespace clgi
