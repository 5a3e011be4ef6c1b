// What hemicubes of records see, with buffers of the test's own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "device.hpp"
#include "math_modes.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

// Below a sky that is lit on one side alone half of pi L arrives; a share of the blocks has as many
// on both sides, though rows of 32 and 64 pixels have 2 and 4 blocks each.
TEST(CachePasses, LinkByBlocksOnAllSides) {
    const DeviceScene scene = test::on_device(furnace({.subdivisions = 1}));
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    for (const std::uint32_t size : {16u, 32u, 64u}) {
        TwoRecords two;
        look_up(two.b, size);
        two.b.sky = test::upload(std::vector<float>{0, 0, 0, 1, 2, 4});
        CacheParams params{};
        params.count = 2;
        params.stride = params.row_stride = plane;
        params.size = size;
        params.sky = {1.0f, 1.0f, 1.0f, 1.0f};
        params.sky_width = 2;
        params.sky_height = 1;
        params.emitter_step = params.every = 1;
        for (const std::uint32_t thin : {1u, 8u}) {
            params.thin = thin;
            passes.link(queue, params, two.tree, scene, no_emitters(), two.b);
            std::vector<float> base(3 * plane);
            queue.enqueueReadBuffer(two.b.base, CL_TRUE, 0, base.size() * sizeof(float),
                                    base.data());
            const double near = thin == 1 ? 0.02 : 0.2;
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 2; ++i) {
                    const double wanted = glm::half_pi<double>() * (1 << c);
                    EXPECT_NEAR(base[c * plane + i], wanted, near * wanted) << size << " " << thin;
                }
        }
    }
}

// In a glowing sphere every part of a hemicube sees the same, so any share of its blocks finds
// pi L; picks tell what surfaces reflect, in other directions from another sample on.
TEST(CachePasses, LinkByAShareOfTheBlocksAndPickWhatReflects) {
    Scene sphere = furnace({.subdivisions = 2});
    sphere.materials[0].emission = glm::vec3(1.0f, 2.0f, 4.0f);
    sphere.materials[0].base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
    sphere.materials[0].metallic = 0.5f;
    sphere.materials[0].roughness = 0.5f;
    const DeviceScene scene = test::on_device(sphere);
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    constexpr std::uint32_t size = 16;
    TwoRecords two;
    look_up(two.b, size);
    GBufferPasses(test::programs(), test::usual_build())
        .raster_views(queue, {0, 10, size, size, 6 * size * size}, two.b.views, scene,
                      two.b.visibility, Pixels::visibility);
    CacheParams params{};
    params.count = 2;
    params.stride = params.row_stride = plane;
    params.size = size;
    params.emission = CACHE_EMISSION_ALL;
    params.picks = 4;
    params.pick_stride = plane;
    params.emitter_step = params.every = 1;
    const EmitterBuffers emitters = no_emitters();
    const glm::dvec3 exposed = glm::dvec3(sphere.materials[0].emission) / scene.frame().exposure;
    for (const std::uint32_t thin : {1u, 3u, 8u}) {
        params.thin = thin;
        passes.link(queue, params, two.tree, scene, emitters, two.b);
        std::vector<float> base(3 * plane);
        queue.enqueueReadBuffer(two.b.base, CL_TRUE, 0, base.size() * sizeof(float), base.data());
        for (int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_NEAR(base[static_cast<std::size_t>(c) * plane + i],
                            glm::pi<double>() * exposed[c], 1e-4 * exposed[c])
                    << thin;
    }
    const cl::Buffer places = test::empty<float>(PICK_PLANES * plane);
    std::vector<float> picked[2];
    for (const std::uint32_t sample : {0u, 5u}) {
        params.first_sample = sample;
        passes.pick(queue, params, scene, two.b, places);
        std::vector<float>& found = picked[sample / 5];
        found.resize(PICK_PLANES * plane);
        queue.enqueueReadBuffer(places, CL_TRUE, 0, found.size() * sizeof(float), found.data());
        // Half a metal of alpha 0.25: integrals of D V, and of D V (1 - v.h)^5.
        const float albedo = 0.8793f, grazing = 0.018f;
        const auto reflects = [&](float base) {
            return (0.5f + 0.5f * (albedo - grazing)) * base + 0.5f * grazing;
        };
        const float bases[] = {0.2f, 0.5f, 0.7f};
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_NEAR(found[PICK_REFLECTANCE * plane + i],
                        reflects(0.2126f * 0.2f + 0.7152f * 0.5f + 0.0722f * 0.7f), 1e-3f);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(found[(PICK_ALBEDO + c) * plane + i], reflects(bases[c]), 1e-3f) << c;
        }
    }
    EXPECT_NE(picked[0], picked[1]);
}

// Half a sphere that glows on one side, open to the sky on the other half: of a sky in one half of
// what a record sees pi/2 arrives, of what glows in a quarter pi/4, and all surfaces together
// reflect half of the albedo; whether they are looked at in all pixels or in a quarter of them.
TEST(CachePasses, LinkBySurfacesInSomePixels) {
    Scene half = furnace({.subdivisions = 4});
    half.materials[0].base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
    half.materials.push_back(half.materials[0]);
    half.materials[1].emission = glm::vec3(1.0f, 2.0f, 4.0f);
    const auto middle = [&](const SceneTriangle& t) {
        return half.positions[t.vertex[0]] + half.positions[t.vertex[1]] +
               half.positions[t.vertex[2]];
    };
    // But for its far end, which keeps the middle of the scene where it is.
    const double radius = glm::length(glm::dvec3(half.positions[0]));
    std::erase_if(half.triangles, [&](const SceneTriangle& t) {
        const glm::dvec3 at = middle(t);
        return at.z < 0.0 && at.z > -2.99 * radius;
    });
    half.parts = {{"half", 0, static_cast<std::uint32_t>(half.triangles.size())}};
    for (SceneTriangle& t : half.triangles) t.material = middle(t).x > 0.0 ? 1 : 0;
    const DeviceScene scene = test::on_device(half);
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t size = 48;
    TwoRecords two;
    look_up(two.b, size);
    GBufferPasses(test::programs(), test::usual_build())
        .raster_views(queue, {0, 10, size, size, 6 * size * size}, two.b.views, scene,
                      two.b.visibility, Pixels::visibility);
    std::vector<float> records = test::download<float>(two.b.planes, RECORD_PLANES * plane);
    records[(RECORD_NORMAL + 1) * plane + 2] = -1.0f;
    two.b.planes = test::upload(records);
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    for (std::size_t way = 0; way < CACHE_WAYS; ++way) lists[way * CACHE_LISTED] = 2;
    two.b.lists = test::upload(lists);
    two.b.sky = test::upload(std::vector<float>{3.0f, 5.0f, 0.5f});
    CacheParams params{};
    params.count = 2;
    constexpr std::uint32_t row = 3 * plane;  // of the transport alone
    params.stride = plane;
    params.row_stride = row;
    params.size = size;
    params.sky = {1.0f, 1.0f, 1.0f, 1.0f};
    params.sky_width = params.sky_height = 1;
    params.emission = CACHE_EMISSION_ALL;
    params.emitter_step = params.thin = 1;
    const glm::dvec3 glow = glm::dvec3(half.materials[1].emission) / scene.frame().exposure,
                     sky(3.0, 5.0, 0.5), albedo(0.2, 0.5, 0.7);
    for (const Form form : {Form::packets, Form::groups}) {  // link.cl, link_group.cl
        BuildOptions build = test::usual_build();
        build.form = form;
        const CachePasses passes(test::programs(), build);
        for (const auto& [every, thin] : {std::pair(1u, 1u), {2u, 1u}, {3u, 1u}, {1u, 3u}}) {
            params.every = every;
            params.thin = thin;
            two.b.rows = test::upload(std::vector<float>(6 * row, 9.0f));  // to be overwritten
            two.b.base = test::upload(std::vector<float>(3 * plane, 9.0f));
            passes.link(queue, params, two.tree, scene, no_emitters(), two.b);
            const auto base = test::download<float>(two.b.base, 3 * plane),
                       rows = test::download<float>(two.b.rows, 6 * row);
            for (int c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 2; ++i) {
                    const auto of = static_cast<std::size_t>(c);
                    const double wanted =
                        glm::half_pi<double>() * sky[c] + glm::quarter_pi<double>() * glow[c];
                    EXPECT_NEAR(base[of * plane + i], wanted, 0.015 * thin * wanted)
                        << every << " " << thin << " " << c;
                    double reflected = 0.0;
                    for (std::size_t j = 0; j < row; ++j) reflected += rows[(3 * i + of) * row + j];
                    EXPECT_NEAR(reflected, 0.455 * albedo[c], 0.01 * thin * albedo[c])
                        << every << " " << thin << " " << c;
                }
        }
        params.every = 4;  // 12 pixels are no multiple of 8
        EXPECT_THROW(passes.link(queue, params, two.tree, scene, no_emitters(), two.b), Error);
        params.every = 0;
        EXPECT_THROW(passes.link(queue, params, two.tree, scene, no_emitters(), two.b), Error);
    }
}

}  // namespace
}  // namespace clgi
