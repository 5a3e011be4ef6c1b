// A tree of records, and the lists that the device makes for it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/planes.hpp>
#include <clgi/passes/cache.hpp>
#include <vector>

#include "device.hpp"
#include "methods/irradiance_cache/tree.hpp"

namespace clgi::test {

struct Planted {
    RecordTree tree;
    CacheTree on_device{};
    CacheBuffers b;
    std::vector<std::uint32_t> lists;

    explicit Planted(const std::vector<CacheRecord>& records,
                     const BuildOptions& build = usual_build())
        : tree(make_tree(records)) {
        const std::uint32_t stride = plane_stride(records.size());
        std::vector<float> held(RECORD_PLANES * std::size_t{stride}, 0.0f);
        for (std::size_t i = 0; i < records.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                held[static_cast<std::size_t>(c) * stride + i] = records[i].position[c];
                held[(RECORD_NORMAL + static_cast<std::size_t>(c)) * stride + i] =
                    records[i].normal[c];
            }
        on_device.centre = {tree.centre.x, tree.centre.y, tree.centre.z, tree.half_side};
        on_device.node_count = static_cast<std::uint32_t>(tree.nodes.size());
        on_device.record_count = static_cast<std::uint32_t>(records.size());
        on_device.stride = stride;
        b.nodes = upload(tree.nodes);
        b.planes = upload(held);
        const std::size_t words = tree.leaves.size() * CACHE_WAYS * CACHE_LISTED;
        b.lists = empty<std::uint32_t>(words);
        CachePasses(programs(), build)
            .list(
                device().queue, tree.params,
                {upload(tree.leaves), upload(tree.records), upload(tree.order), upload(tree.boxes)},
                b.lists);
        lists = download<std::uint32_t>(b.lists, words);
    }

    const std::uint32_t* listed(const CacheRecord& place) const {
        return &lists[list_of(tree, place)];
    }
};

}  // namespace clgi::test
