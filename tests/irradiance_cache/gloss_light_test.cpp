// The light that lobes reflect, beside that of surfaces.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <glm/gtc/constants.hpp>

#include "glossy_records.hpp"

namespace clgi {
namespace {

// Light that corrections change scales what lobes reflect by it; as it is shown, by cache.show, it
// does not, wherever between the records and beside them.
TEST(GlossLight, IsReflectedAsItIsWhereItIsAsShown) {
    const glm::dvec3 up(0, 1, 0), colour(2.0, 1.0, 0.5);
    Glossy in(finishes, {{{-1, 0, 0}, up}, {{1, 0, 0}, up}, {{1.2, 0, 2}, up}}, 16);
    for (std::uint32_t slot = 0; slot < 3; ++slot) in.fill(slot, colour);
    std::vector<float> light(3 * test::record_stride, 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r)
            light[c * test::record_stride + r] = static_cast<float>(1 + 4 * r);
    for (const glm::dvec3& place : {glm::dvec3(0.3, 0, 0.4), glm::dvec3(2.5, 0, 1.0)}) {
        in.b.light = test::upload(std::vector<float>(3 * test::record_stride, 1.0f));
        const std::vector<Point> point = {{place, up, glm::dvec3(0.7, 0.4, 0.2), 2, -1}};
        const glm::dvec3 even = in.reflected(point)[0];
        in.b.light = test::upload(light);
        std::vector<float> planes(GBUFFER_PLANES * plane, 0.0f);
        const glm::dvec3 local = in.scene.frame().scale * (place - in.scene.frame().origin);
        for (std::uint32_t c = 0; c < 3; ++c) {
            planes[(GBUFFER_POSITION + c) * plane] = static_cast<float>(local[static_cast<int>(c)]);
            planes[(GBUFFER_NORMAL + c) * plane] = static_cast<float>(up[static_cast<int>(c)]);
        }
        const cl::Buffer shown = test::empty<float>(3 * plane), doubt = test::empty<float>(plane);
        CachePasses(test::programs(), test::usual_build())
            .show(test::device().queue, {1, plane, 0, 0}, in.tree, in.b, points_of(planes, plane),
                  shown, doubt);
        const glm::dvec3 found = in.reflected(point, test::download<float>(shown, 1)[0])[0];
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], even[c], 1e-3 * even[c]) << c;
    }
}

// Emission, and what surfaces reflect of the light of records: in a sphere the same everywhere.
TEST(GlossLight, IsWhatShinesAroundRecords) {
    Scene sphere = furnace({.subdivisions = 2});
    const glm::dvec3 emission(1.0, 2.0, 4.0), albedo(0.2, 0.5, 0.7), light(3.0, 1.0, 5.0);
    sphere.materials[0].emission = glm::vec3(emission);
    sphere.materials[0].base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    const DeviceScene scene = test::on_device(sphere);
    CacheBuffers b = test::record_cubes(scene, {{{0, 0, 0}, {0, 1, 0}}}, 8);
    std::vector<float> lights(3 * test::record_stride, 0.0f);
    for (int c = 0; c < 3; ++c)
        lights[static_cast<std::size_t>(c) * test::record_stride] = static_cast<float>(light[c]);
    b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    std::vector<float> planes =
        test::download<float>(b.planes, RECORD_PLANES * test::record_stride);
    // A record for each way to face, of which the first has the hemicube.
    for (std::uint32_t way = 0; way < CACHE_WAYS; ++way) {
        lists[way * CACHE_LISTED] = 1 + way;
        for (std::uint32_t c = 0; c < 3; ++c) {
            planes[(RECORD_NORMAL + c) * test::record_stride + 1 + way] =
                c == way / 2 ? (way % 2 == 0 ? 1.0f : -1.0f) : 0.0f;
            lights[c * test::record_stride + 1 + way] = static_cast<float>(light[int(c)]);
        }
    }
    b.lists = test::upload(lists);
    b.planes = test::upload(planes);
    b.light = test::upload(lights);
    b.sky = test::empty<float>(4);
    CacheParams params{};
    params.count = 1;
    params.stride = test::record_stride;
    params.size = 8;
    params.emission = CACHE_EMISSION_ALL;
    params.emitter_step = params.thin = params.every = 1;
    const CacheAround of = {1, 0, 1, 8};
    const std::size_t words = around_bytes(of) / sizeof(std::uint64_t);
    const cl::Buffer around = test::empty<std::uint64_t>(words);
    CachePasses(test::programs(), test::usual_build())
        .around(test::device().queue, params, of, one_leaf(7, test::record_stride), scene,
                no_emitters(), b, around)
        .wait();
    const glm::dvec3 wanted =
        emission / scene.frame().exposure + albedo / glm::pi<double>() * light;
    for (const std::uint64_t word : test::download<std::uint64_t>(around, words))
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(unpacked(word)[c], wanted[c], 1e-4 * wanted[2]) << c;
}

}  // namespace
}  // namespace clgi
