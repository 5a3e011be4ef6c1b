// What an irradiance cache owns, and the steps of its picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/irradiance_cache.hpp>
#include <clgi/passes/cache.hpp>
#include <cstddef>
#include <vector>

#include "methods/irradiance_cache/coarse_sky.hpp"
#include "methods/irradiance_cache/records.hpp"

namespace clgi {

constexpr std::uint32_t picks_per_record = 16;

struct IrradianceCache::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          const IrradianceCacheOptions& wanted);
    void add_to(BufferTable& table);
    // Reads whole planes, waiting.
    std::vector<CacheRecord> read_records(const cl::Buffer& planes, std::size_t plane_floats,
                                          std::size_t count);
    void write_records();
    // The scene as records from `first` on see it.
    void draw(std::size_t first);
    CacheParams params(std::size_t first, std::size_t count) const;
    // What the records from `first` on see becomes up to `count` more records.
    void meet(std::size_t first, std::size_t count);
    void choose(const View& view);
    // A tree of all records, for one of two uses.
    void plant(CacheTree& planted, cl::Buffer& nodes, cl::Buffer& lists);
    // More records where others see light that is in doubt and that reaches the picture.
    void weigh(std::size_t count);
    // The transport of the records from `first` on, from those that light goes between, by one
    // block of pixels in `thin`.
    void link(std::size_t first, std::uint32_t thin = 1);
    // How many nodes a tree has is known when it is made.
    void grow(cl::Buffer& buffer, std::size_t size);
    // Until the light rests, or so many reflections.
    void light(int limit);
    void bounce(std::size_t first);
    // More records where the light changes between those that are there, in rounds of ever smaller
    // blocks. They gather what the last reflection did for the others, which have no light of
    // theirs.
    void refine(const View& view);
    std::vector<float> read_doubt();
    // Whether the last step changed little.
    bool rests();
    void show();

    const DeviceScene& scene;
    IrradianceCacheOptions options;
    Picture picture;
    CachePasses passes;
    GBufferPasses cubes;
    CacheBuffers b;
    CacheTree tree{}, all_tree{};  // of those that light goes between, of these and refined ones
    CoarseSky sky;
    cl::Buffer all_nodes, all_lists;  // of all_tree
    cl::Buffer chosen, places, worth, nearest, doubt;
    std::vector<CacheRecord> records;
    std::vector<CacheRecord> shown;  // what each pixel shows
    std::size_t capacity = 0, pick_stride = 0;
    std::uint32_t stride = 0;
    IrradianceCacheStatus found;
};

}  // namespace clgi
