// The tree that names the records near each place (clgi/shared/cache.h).
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

struct RecordTree {
    glm::vec3 centre = glm::vec3(0.0f);
    float half_side = 1.0f;
    std::vector<std::uint32_t> nodes, lists;
};

// Leaves hold few records, and list those nearest to their centres, of each way to face.
RecordTree make_tree(const std::vector<CacheRecord>& records);

// The list that the tree has for a place, CACHE_NONE after its last record.
const std::uint32_t* listed(const RecordTree& tree, const CacheRecord& place);

}  // namespace clgi
