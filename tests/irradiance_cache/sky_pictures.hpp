// Pictures of many samples below a sky, and the path tracer's beside them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/irradiance_cache.hpp>
#include <clgi/reference.hpp>

#include "apart.hpp"
#include "cache_pictures.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {

// Posts on a tilted ground, under a sky that is brighter and of another colour on one side.
inline Scene posts() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_quad(scene, {glm::dvec3(-4, -1, 4), {4, 0.5, 4}, {4, 0.5, -4}, {-4, -1, -4}});
    for (int k = 0; k < 6; ++k) {
        const double x = -1.2 + 0.5 * k, z = k % 2 == 0 ? -0.6 : 0.5, y = x * 3.0 / 16.0 - 0.3;
        test::add_box(scene, {x, y - 0.2, z}, {x + 0.12, y + 1.0, z + 0.12}, 1);
    }
    scene.environment = test::picture_sky(32, 16, [](int row, int column) {
        return row >= 8 ? 0.0f : column > 9 && column < 16 && row > 1 && row < 7 ? 10.0f : 0.7f;
    });
    scene.environment->factor = {1.0f, 0.8f, 0.5f};
    scene.cameras = {test::camera_at({0.6, 2.4, 3.0}, {0.1, 0, 0}, 0.8f)};
    return scene;
}

// Mean of samples that look through the same places of pixels, or, where later samples look aside,
// by so many pixels.
inline std::vector<glm::vec3> sampled(IrradianceCache& cache, const Camera& camera,
                                      std::uint32_t samples,
                                      const glm::vec2& aside = glm::vec2(0.0f)) {
    std::vector<glm::dvec3> sum(std::size_t{cache_width} * cache_height, glm::dvec3(0.0));
    for (std::uint32_t index = 0; index < samples; ++index) {
        cache.sample(index);
        Camera later = camera;
        later.offset += aside;
        (index == 0 ? cache.render(camera) : cache.render_again(later)).wait();
        const auto one = test::vectors(test::device().queue, cache.picture().radiance(),
                                       cache.picture().stride(), sum.size());
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += glm::dvec3(one[i]) / static_cast<double>(samples);
    }
    std::vector<glm::vec3> out;
    for (const glm::dvec3& value : sum) out.emplace_back(value);
    return out;
}

inline test::Twice truth_of(const Scene& scene) {
    reference::Options out;
    out.width = cache_width;
    out.height = cache_height;
    out.samples = 256;
    return test::render_twice(scene, scene.cameras[0], out);
}

}  // namespace clgi
