// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/tree.hpp"

#include <algorithm>
#include <clgi/advanced/planes.hpp>

namespace clgi {
namespace {

constexpr std::size_t most_in_leaf = 2;
constexpr int deepest = 20;

// Of a place in a cube around a centre.
std::uint32_t octant(const glm::vec3& p, const glm::vec3& centre) {
    return (p.x > centre.x ? 1u : 0u) | (p.y > centre.y ? 2u : 0u) | (p.z > centre.z ? 4u : 0u);
}

// From the centre of a cube to that of its octant.
glm::vec3 toward(std::uint32_t octant, float half) {
    return {(octant & 1u) ? half : -half, (octant & 2u) ? half : -half,
            (octant & 4u) ? half : -half};
}

// As cache_way (kernels/cache/lookup.clh).
std::uint32_t way_of(const glm::vec3& n) {
    const glm::vec3 a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return static_cast<std::uint32_t>(2 * axis + (n[axis] < 0.0f ? 1 : 0));
}

std::uint32_t add_node(RecordTree& out, const std::vector<CacheRecord>& records,
                       const glm::vec3& centre, float half_side,
                       const std::vector<std::uint32_t>& inside, int depth) {
    if (inside.size() <= most_in_leaf || depth == deepest) {
        CacheLeaf& leaf = out.leaves.emplace_back();
        leaf = {};
        leaf.cube = glm::vec4(centre, half_side);
        leaf.before = static_cast<std::uint32_t>(out.order.size());
        out.order.insert(out.order.end(), inside.begin(), inside.end());
        return CACHE_LEAF | static_cast<std::uint32_t>(out.leaves.size() - 1);
    }
    const auto place = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes.resize(place + 8);
    for (std::uint32_t child = 0; child < 8; ++child) {
        std::vector<std::uint32_t> part;
        for (const std::uint32_t i : inside)
            if (octant(records[i].position, centre) == child) part.push_back(i);
        const float half = 0.5f * half_side;
        const std::uint32_t made =
            add_node(out, records, centre + toward(child, half), half, part, depth + 1);
        out.nodes[place + child] = made;
    }
    return place;
}

// In the order of leaves, with a box around every crowd.
void add_crowds(RecordTree& out, const std::vector<CacheRecord>& records) {
    const std::size_t count = records.size(), crowds = (count + CACHE_CROWD - 1) / CACHE_CROWD;
    const std::size_t stride = plane_stride(count), crowd_stride = plane_stride(crowds);
    out.params = {static_cast<std::uint32_t>(out.leaves.size()), static_cast<std::uint32_t>(count),
                  static_cast<std::uint32_t>(stride), static_cast<std::uint32_t>(crowd_stride)};
    out.order.resize(stride, CACHE_NONE);
    out.records.assign(6 * stride, 0.0f);
    out.boxes.assign(6 * crowd_stride, 0.0f);
    for (std::size_t i = 0; i < count; ++i) {
        const CacheRecord& record = records[out.order[i]];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float at = record.position[static_cast<int>(axis)];
            out.records[axis * stride + i] = at;
            out.records[(3 + axis) * stride + i] = record.normal[static_cast<int>(axis)];
            float& low = out.boxes[axis * crowd_stride + i / CACHE_CROWD];
            float& high = out.boxes[(3 + axis) * crowd_stride + i / CACHE_CROWD];
            low = i % CACHE_CROWD == 0 ? at : std::min(low, at);
            high = i % CACHE_CROWD == 0 ? at : std::max(high, at);
        }
    }
}

}  // namespace

RecordTree make_tree(const std::vector<CacheRecord>& records) {
    RecordTree out;
    std::vector<std::uint32_t> all;
    glm::vec3 low(0.0f), high(0.0f);
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        const glm::vec3& p = records[i].position;
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
        all.push_back(i);
    }
    out.centre = 0.5f * (low + high);
    const glm::vec3 half = 0.5f * (high - low);
    out.half_side = std::max({half.x, half.y, half.z, 1e-6f});
    out.nodes.push_back(0);
    const std::uint32_t root = add_node(out, records, out.centre, out.half_side, all, 0);
    out.nodes[0] = root;
    add_crowds(out, records);
    return out;
}

std::size_t list_of(const RecordTree& tree, const CacheRecord& place) {
    glm::vec3 centre = tree.centre;
    float half = tree.half_side;
    std::uint32_t node = tree.nodes[0];
    while (!(node & CACHE_LEAF)) {
        const std::uint32_t child = octant(place.position, centre);
        half *= 0.5f;
        centre += toward(child, half);
        node = tree.nodes[node + child];
    }
    return (std::size_t{node & ~CACHE_LEAF} * CACHE_WAYS + way_of(place.normal)) * CACHE_LISTED;
}

}  // namespace clgi
