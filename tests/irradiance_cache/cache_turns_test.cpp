// Points on emissive surfaces that take turns in lighting what hemicubes see.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <utility>

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

// Records in the middle of a dome.
struct UnderADome {
    static constexpr std::uint32_t count = 32;

    UnderADome() {
        sphere.materials[0].base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
        sphere.materials[0].metallic = sphere.materials[0].specular = 0.0f;
        scene.emplace(test::on_device(sphere));
        params.count = count;
        params.stride = params.row_stride = plane;
        params.emitter_count = lights;
        params.every = params.thin = 1;
    }

    void draw(std::uint32_t size) {
        params.size = size;
        look_up(records.b, size, count);
        GBufferPasses(test::programs(), test::usual_build())
            .raster_views(test::device().queue,
                          {0, 5 * count, size, size, std::size_t{3} * size * size * count},
                          records.b.views, *scene, records.b.visibility, Pixels::visibility);
    }

    // Of each channel and record.
    std::vector<float> reflected(const glm::vec3 (&sides)[lights], Form form) const {
        BuildOptions build = test::usual_build();
        build.form = form;
        CachePasses(test::programs(), build)
            .link(test::device().queue, params, records.tree, *scene, from_all_sides(sides),
                  records.b);
        return test::download<float>(records.b.reflected, 3 * plane);
    }

    // Of all lights, by the closed form below.
    double wanted(int c) const {
        const glm::vec3 power = powers[0] + powers[1] + powers[2] + powers[3];
        return double{sphere.materials[0].base_color[c]} * power[c] * 2.0 /
               (3.0 * glm::pi<double>());
    }

    Scene sphere = furnace({.subdivisions = 4});
    std::optional<DeviceScene> scene;
    TwoRecords records;
    CacheParams params{};
};

const glm::vec3 x(1, 0, 0), z(0, 0, 1);
const glm::vec3 arrangements[2][lights] = {{x, -x, z, -z}, {x, -x, -z, z}};

// In the middle of a dome, horizontal light of E lux on one of its sides brings
//
//   rho E / pi int max(sin t cos f, 0) cos t dw = rho E 2 / (3 pi)
//
// and about as much where the lights take turns from block to block: less exactly where blocks are
// few. Rows of 32 and 64 pixels have 2 and 4 blocks each, two rows of 24 have 3; of those that are
// looked at, which are one of `every` columns and rows.
TEST(CachePasses, LinkByLightsInTurnsOnAllSides) {
    UnderADome dome;
    for (const auto& [size, every] :
         {std::pair(16u, 1u), {24u, 1u}, {32u, 1u}, {48u, 1u}, {64u, 1u}, {64u, 2u}, {64u, 4u}}) {
        dome.draw(size);
        dome.params.every = every;
        for (const auto& sides : arrangements)
            for (const Form form : {Form::packets, Form::groups})
                for (std::uint32_t step = 1; step <= lights; ++step) {
                    dome.params.emitter_step = step;
                    const std::vector<float> found = dome.reflected(sides, form);
                    const double near = every * (step > 1 ? 1.6 / size : 0.01);
                    for (int c = 0; c < 3; ++c)
                        for (std::size_t i = 0; i < 2; ++i)
                            EXPECT_NEAR(found[static_cast<std::size_t>(c) * plane + i],
                                        dome.wanted(c), near * dome.wanted(c))
                                << size << " " << every << " " << step << " " << c << " " << i;
                }
    }
}

// Where one of eight blocks counts a record has few of the lights; all of them together have each
// as often.
TEST(CachePasses, LinkByLightsInTurnsWhereFewBlocksCount) {
    UnderADome dome;
    dome.params.thin = 8;
    dome.params.emitter_step = lights;
    for (const std::uint32_t size : {8u, 16u, 32u}) {
        dome.draw(size);
        const std::vector<float> found = dome.reflected(arrangements[0], Form::packets);
        for (int c = 0; c < 3; ++c) {
            double mean = 0.0;
            for (std::size_t i = 0; i < dome.count; ++i)
                mean += double{found[static_cast<std::size_t>(c) * plane + i]} / dome.count;
            EXPECT_NEAR(mean, dome.wanted(c), 0.2 * dome.wanted(c)) << size << " " << c;
        }
    }
}

}  // namespace
}  // namespace clgi
