// Hemicubes of records of an irradiance cache, drawn where a test puts them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/cache.hpp>
#include <numeric>
#include <vector>

#include "device.hpp"

namespace clgi::test {

struct RecordPlace {
    glm::dvec3 eye;     // metres
    glm::dvec3 normal;  // unit
};

constexpr std::uint32_t record_stride = 16;  // of their planes

// Planes of at most record_stride records, and their faces of size x size pixels.
inline CacheBuffers record_cubes(const DeviceScene& scene, const std::vector<RecordPlace>& places,
                                 std::uint32_t size) {
    const auto count = static_cast<std::uint32_t>(places.size());
    std::vector<float> planes(RECORD_PLANES * record_stride, 0.0f);
    for (std::uint32_t r = 0; r < count; ++r) {
        const glm::dvec3 local = scene.frame().scale * (places[r].eye - scene.frame().origin);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const int axis = static_cast<int>(c);
            planes[c * record_stride + r] = static_cast<float>(local[axis]);
            for (const std::uint32_t first : {RECORD_NORMAL, RECORD_GEOMETRIC})
                planes[(first + c) * record_stride + r] =
                    static_cast<float>(places[r].normal[axis]);
        }
    }
    CacheBuffers out;
    out.planes = upload(planes);
    out.views = empty<View>(5 * count);
    out.visibility = empty<std::uint64_t>(3 * count * size * size);
    CubeParams cube{};
    cube.point_count = count;
    cube.faces = 5;
    cube.size = size;
    cube.stride = record_stride;
    cube.near = 1e-5f;
    cube.turned = 1;
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    const GBufferPasses gbuffer(programs(), usual_build());
    gbuffer.cubes(device().queue, cube, out.planes, upload(all), out.views);
    gbuffer.raster_views(device().queue, {0, 5 * count, size, size, 3 * count * size * size},
                         out.views, scene, out.visibility, Pixels::visibility);
    return out;
}

}  // namespace clgi::test
