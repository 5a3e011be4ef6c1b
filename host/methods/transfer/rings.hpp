// The triangles around a vertex, a few edges away.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

class Rings {
public:
    // corners: vertices of each triangle, below `vertices`; welded ones, if seams shall not count.
    Rings(std::vector<glm::uvec3> corners, std::uint32_t vertices);

    // Triangles with a corner at most `rings` edges away, ascending.
    std::vector<std::uint32_t> around(std::uint32_t vertex, int rings);

    bool touches(std::uint32_t triangle, std::uint32_t vertex) const;

private:
    // Triangles at `at` and their vertices that the search has not come to yet.
    void add_triangles(std::uint32_t at, std::vector<std::uint32_t>& vertices,
                       std::vector<std::uint32_t>& triangles);

    std::vector<glm::uvec3> corners_;
    std::vector<std::uint32_t> first_, around_;               // triangles of each vertex
    std::vector<std::uint32_t> vertex_seen_, triangle_seen_;  // the last search that came there
    std::uint32_t search_ = 0;
};

}  // namespace clgi
