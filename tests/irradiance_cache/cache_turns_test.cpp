// Points on emissive surfaces that take turns in lighting what hemicubes see.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <glm/gtc/constants.hpp>

#include "device.hpp"
#include "math_modes.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t lights = 4;
const glm::vec3 powers[lights] = {{1, 2, 4}, {3, 1, 2}, {2, 5, 1}, {4, 3, 3}};

// Horizontal light from one side each; nothing is in its way.
EmitterBuffers from_all_sides(const glm::vec3 (&sides)[lights]) {
    std::vector<Emitter> emitters(lights);
    for (std::uint32_t k = 0; k < lights; ++k) {
        emitters[k] = Emitter{};
        emitters[k].kind = EMITTER_DIRECTIONAL;
        emitters[k].axis = glm::vec4(sides[k], 0.0f);
        emitters[k].intensity = glm::vec4(powers[k], 0.0f);
    }
    EmitterBuffers out = no_emitters();
    out.emitters = test::upload(emitters);
    return out;
}

// In the middle of a dome, horizontal light of E lux on one of its sides brings
//
//   rho E / pi int max(sin t cos f, 0) cos t dw = rho E 2 / (3 pi)
//
// and about as much where the lights take turns from block to block: less exactly where blocks are
// few. Rows of 32 and 64 pixels have 2 and 4 blocks each, two rows of 24 have 3.
TEST(CachePasses, LinkByLightsInTurnsOnAllSides) {
    Scene sphere = furnace({.subdivisions = 4});
    Material& material = sphere.materials[0];
    material.base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
    material.metallic = material.specular = 0.0f;
    const DeviceScene scene = test::on_device(sphere);
    const cl::CommandQueue& queue = test::device().queue;
    const GBufferPasses drawing(test::programs(), test::usual_build());
    CacheParams params{};
    params.count = 2;
    params.stride = params.row_stride = plane;
    params.emitter_count = lights;
    params.every = params.thin = 1;
    const glm::vec3 x(1, 0, 0), z(0, 0, 1);
    const glm::vec3 arrangements[2][lights] = {{x, -x, z, -z}, {x, -x, -z, z}};
    const glm::vec3 power = powers[0] + powers[1] + powers[2] + powers[3];
    for (const std::uint32_t size : {16u, 24u, 32u, 64u}) {
        TwoRecords two;
        look_up(two.b, size);
        drawing.raster_views(queue, {0, 10, size, size, 6 * size * size}, two.b.views, scene,
                             two.b.visibility, Pixels::visibility);
        params.size = size;
        for (const auto& sides : arrangements)
            for (const Form form : {Form::packets, Form::groups})
                for (const std::uint32_t step : {1u, 2u, 3u, 4u}) {
                    BuildOptions build = test::usual_build();
                    build.form = form;
                    params.emitter_step = step;
                    CachePasses(test::programs(), build)
                        .link(queue, params, two.tree, scene, from_all_sides(sides), two.b);
                    const auto found = test::download<float>(two.b.reflected, 3 * plane);
                    for (int c = 0; c < 3; ++c)
                        for (std::size_t i = 0; i < 2; ++i) {
                            const double wanted = double{material.base_color[c]} * power[c] * 2.0 /
                                                  (3.0 * glm::pi<double>());
                            EXPECT_NEAR(found[static_cast<std::size_t>(c) * plane + i], wanted,
                                        (step > 1 ? 1.6 / size : 0.01) * wanted)
                                << size << " " << step << " " << c << " " << i;
                        }
                }
    }
}

}  // namespace
}  // namespace clgi
