// The tree that finds the list of a place (clgi/shared/cache.h).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/cache.h>
#include <clgi/opencl.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// A place on a surface, local frame. The normals are unit and face the side that is lit.
struct CacheRecord {
    glm::vec3 position, normal, geometric;
};

// Leaves hold few records. What they list is up to CachePasses::list, which reads the rest.
struct RecordTree {
    glm::vec3 centre = glm::vec3(0.0f);
    float half_side = 1.0f;
    std::vector<std::uint32_t> nodes;
    std::vector<CacheLeaf> leaves;
    CacheListParams params{};
    std::vector<std::uint32_t> order;   // [params.stride] of records
    std::vector<float> records, boxes;  // [6][params.stride], [6][params.crowd_stride]
};

RecordTree make_tree(const std::vector<CacheRecord>& records);

// Where among all lists that of a place begins.
std::size_t list_of(const RecordTree& tree, const CacheRecord& place);

}  // namespace clgi
