// What VPLs are made from and what they send: place, receive and emit in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "vpl_heap.hpp"

namespace clgi {
namespace {

using test::VplHeap;

using test::nan;

TEST(Place, TakesMeansOfReflectanceAndTurnsBacks) {
    VplHeap heap(50);
    Scene world = test::plain_scene();
    test::add_floor(world, 1.0);
    for (const float metallic : {0.0f, 0.3f, 0.8f}) {
        Material material;
        material.metallic = metallic;
        material.roughness = 0.4f;
        test::add_material(world, material);
    }
    const DeviceScene scene = test::on_device(world);
    const auto materials = test::download<MaterialRecord>(scene.materials(), 4);
    EXPECT_LT(materials[3].reflectance.x, materials[1].reflectance.x);
    const SiteBuffers& b = heap.buffers;
    test::Random random(6);
    std::vector<cl_int> ids(GBUFFER_ID_PLANES * b.sample_stride, 99);
    for (std::uint32_t k = 0; k < b.sample_count; ++k)
        ids[GBUFFER_MATERIAL * b.sample_stride + k] = random.integer(-1, 3);
    // Brighter than is allowed: the last site, all of paper.
    const Site& bright = heap.sites.back();
    for (std::uint32_t k = 0; k < bright.sample_count; ++k) {
        ids[bright.first_sample + k] = 0;
        for (int c = 0; c < 3; ++c)
            heap.samples[(GBUFFER_BASE + c) * b.sample_stride + bright.first_sample + k] =
                1.0f + 0.5f * c;
    }
    heap.buffers.samples = test::upload(heap.samples);
    test::vpl_passes().place(test::device().queue, scene, heap.buffers, test::upload(ids));
    const auto planes = test::download<float>(b.planes, SITE_PLANES * b.stride);
    const auto after = test::download<float>(b.samples, heap.samples.size());
    std::vector<float> wanted = heap.samples;  // every plane of the samples
    for (std::size_t i = 0; i < heap.sites.size(); ++i) {
        const Site& site = heap.sites[i];
        const float sign = site.flags & SITE_BACK ? -1.0f : 1.0f;
        glm::dvec3 mean(0);
        for (std::uint32_t k = site.first_sample; k < site.first_sample + site.sample_count; ++k) {
            const int material = ids[GBUFFER_MATERIAL * b.sample_stride + k];
            const float share = material < 0 ? 0.0f : materials[material].reflectance.x;
            for (int c = 0; c < 3; ++c) {
                mean[c] += double{share} * heap.samples[(GBUFFER_BASE + c) * b.sample_stride + k] /
                           site.sample_count;
                wanted[(GBUFFER_BASE + c) * b.sample_stride + k] *= share;
                wanted[(GBUFFER_NORMAL + c) * b.sample_stride + k] *= sign;
                wanted[(GBUFFER_GEOMETRIC + c) * b.sample_stride + k] *= sign;
            }
        }
        const std::size_t center = b.sample_count + i;
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(planes[(SITE_POSITION + c) * b.stride + i],
                      heap.samples[(GBUFFER_POSITION + c) * b.sample_stride + center]);
            EXPECT_EQ(planes[(SITE_NORMAL + c) * b.stride + i],
                      sign * heap.samples[(GBUFFER_GEOMETRIC + c) * b.sample_stride + center]);
            const float albedo = planes[(SITE_ALBEDO + c) * b.stride + i];
            const bool clamped = i + 1 == heap.sites.size();
            EXPECT_NEAR(albedo, clamped ? double{SITE_BRIGHTEST} : mean[c],
                        clamped ? 0.0 : 31 * 0x1p-24)
                << "site " << i;
        }
    }
    EXPECT_EQ(after, wanted);
}

TEST(Receive, TakesTheMeanOfEachChannel) {
    const VplHeap heap(70);
    const SiteBuffers& b = heap.buffers;
    test::Random random(8);
    std::vector<float> irradiance(3 * b.sample_stride);
    for (float& value : irradiance) value = static_cast<float>(random(0, 9));
    test::vpl_passes().receive(test::device().queue, b, test::upload(irradiance));
    const auto light = test::download<float>(b.light, SITE_LIGHT_PLANES * b.stride);
    for (std::size_t i = 0; i < heap.sites.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            double mean = 0.0;
            for (std::uint32_t k = 0; k < heap.sites[i].sample_count; ++k)
                mean += double{irradiance[c * b.sample_stride + heap.sites[i].first_sample + k]} /
                        heap.sites[i].sample_count;
            EXPECT_NEAR(light[(SITE_UNSHOT + c) * b.stride + i], mean, mean * 31 * 0x1p-24);
            EXPECT_EQ(light[(SITE_RECEIVED + c) * b.stride + i],
                      light[(SITE_UNSHOT + c) * b.stride + i]);
        }
}

// ---- emit
// ----------------------------------------------------------------------------------------

struct Emitted {
    VplHeap heap;
    std::vector<float> planes, before, after, shot, power;
    std::vector<cl_uint> chosen;
    Emitted(cl_uint mode, const ArgMax& strongest, float threshold = 0.0f) : heap(40, 10) {
        const SiteBuffers& b = heap.buffers;
        test::Random random(11);
        planes.resize(SITE_PLANES * b.stride);
        before.resize(SITE_LIGHT_PLANES * b.stride);
        for (float& value : planes) value = static_cast<float>(random(0.1, 1));
        for (float& value : before) value = static_cast<float>(random(0.1, 9));
        SiteBuffers with = b;
        with.planes = test::upload(planes);
        with.light = test::upload(before);
        test::vpl_passes().emit(test::device().queue,
                                {5, 1, 0, b.site_count, b.stride, 1.0f, mode, threshold}, with,
                                test::upload(std::vector<ArgMax>{strongest}));
        after = test::download<float>(with.light, before.size());
        shot = test::download<float>(b.shot, 3 * b.stride);
        power = test::download<float>(b.power, b.stride);
        chosen = test::download<cl_uint>(b.chosen, b.site_count);
    }
    void expect_shot(std::size_t i) {
        const SiteBuffers& b = heap.buffers;
        for (int c = 0; c < 3; ++c) {
            const double wanted = double{planes[(SITE_ALBEDO + c) * b.stride + i]} *
                                  heap.sites[i].area * before[(SITE_UNSHOT + c) * b.stride + i];
            EXPECT_NEAR(shot[c * b.stride + i], wanted, 2e-7 * wanted);
            EXPECT_EQ(after[(SITE_UNSHOT + c) * b.stride + i], 0.0f);
        }
        EXPECT_EQ(power[i], 0.0f);
    }
    void expect_kept(std::size_t i) {
        const SiteBuffers& b = heap.buffers;
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(after[(SITE_UNSHOT + c) * b.stride + i],
                      before[(SITE_UNSHOT + c) * b.stride + i])
                << i;
        EXPECT_EQ(power[i], 3.0f);
    }
    void expect_received_as_before() {
        for (std::size_t k = SITE_RECEIVED * heap.buffers.stride; k < before.size(); ++k)
            EXPECT_EQ(after[k], before[k]);
    }
};

TEST(Emit, TakesTheUnshotLightOfAll) {
    Emitted all(SHOOT_ALL, {1.0f, 7, 0, 0}, 1e9f);  // whatever was strongest
    for (std::size_t i = 0; i < all.heap.sites.size(); ++i) all.expect_shot(i);
    for (const cl_uint site : all.chosen) EXPECT_EQ(site, 77u);
    all.expect_received_as_before();
}

TEST(Emit, TakesTheUnshotLightOfTheStrongest) {
    Emitted one(SHOOT_STRONGEST, {2.0f, 23, 0, 0}, 1.999f);
    for (std::size_t i = 0; i < one.heap.sites.size(); ++i)
        i == 23 ? one.expect_shot(i) : one.expect_kept(i);
    for (std::size_t k = 0; k < one.chosen.size(); ++k)
        EXPECT_EQ(one.chosen[k], k == 5 ? 23u : 77u);
    one.expect_received_as_before();
    EXPECT_TRUE(std::isnan(one.shot[0]));
}

TEST(Emit, ShootsNothingBelowTheThresholdOrWithoutASite) {
    for (const ArgMax& strongest : {ArgMax{2.0f, 23, 0, 0}, ArgMax{9.0f, ARG_MAX_NONE, 0, 0},
                                    ArgMax{9.0f, 40, 0, 0}, ArgMax{nan, 3, 0, 0}}) {
        Emitted none(SHOOT_STRONGEST, strongest, 2.0f);
        for (std::size_t i = 0; i < none.heap.sites.size(); ++i) none.expect_kept(i);
        EXPECT_EQ(none.chosen[5], 0u);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(none.shot[c * none.heap.buffers.stride], 0.0f);
        none.expect_received_as_before();
    }
}

}  // namespace
}  // namespace clgi
