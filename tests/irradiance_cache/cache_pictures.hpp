// Small pictures by an irradiance cache.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/irradiance_cache.hpp>

#include "frames.hpp"
#include "math_modes.hpp"

namespace clgi {

constexpr int cache_width = 48, cache_height = 36;

struct CachePicture {
    std::vector<glm::vec3> radiance;
    IrradianceCacheStatus status;
};

inline IrradianceCacheOptions cache_options(int seen = 100, int met = 200) {
    IrradianceCacheOptions out;
    out.seen = seen;
    out.met = met;
    out.picture.width = cache_width;
    out.picture.height = cache_height;
    out.picture.build = test::usual_build();
    return out;
}

inline CachePicture pictured(const Scene& scene, const IrradianceCacheOptions& options) {
    const DeviceScene device = test::on_device(scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    cache.render(scene.cameras.at(0)).wait();
    const std::size_t pixels = std::size_t{cache_width} * cache_height;
    return {test::vectors(test::device().queue, cache.picture().radiance(),
                          cache.picture().stride(), pixels),
            cache.status()};
}

inline glm::dvec3 mean_radiance(const std::vector<glm::vec3>& picture) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& value : picture) sum += glm::dvec3(value);
    return sum / static_cast<double>(picture.size());
}

}  // namespace clgi
