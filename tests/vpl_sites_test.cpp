// What VPLs are made from and what they send: place, receive, weigh and emit in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "vpl_tools.hpp"

namespace clgi {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Sites of 1 to 30 samples with random planes of everything.
struct Heap {
    std::vector<Site> sites;
    std::vector<float> samples;  // [GBUFFER_PLANES][sample_stride]
    SiteBuffers buffers;
    explicit Heap(int count, std::uint64_t seed = 5) {
        test::Random random(seed);
        cl_uint first = 0;
        for (int i = 0; i < count; ++i) {
            const auto many = static_cast<cl_uint>(i == 3 ? 1 : random.integer(1, 30));
            sites.push_back({first, many, static_cast<float>(random(0.01, 2.0)),
                             i % 3 == 1 ? cl_uint{SITE_BACK} : 0});
            first += many;
        }
        SiteBuffers& b = buffers;
        b.site_count = static_cast<std::uint32_t>(count);
        b.stride = test::padded(sites.size());
        b.sample_count = first;
        b.sample_stride = test::padded(first + sites.size()) + 16;
        samples.resize(GBUFFER_PLANES * b.sample_stride);
        for (float& value : samples) value = static_cast<float>(random(0.01, 1.0));
        b.sites = test::upload(sites);
        b.samples = test::upload(samples);
        b.planes = test::upload(std::vector<float>(SITE_PLANES * b.stride, nan));
        b.light = test::upload(std::vector<float>(SITE_LIGHT_PLANES * b.stride, nan));
        b.weights = test::upload(std::vector<float>(b.sample_stride, nan));
        b.power = test::upload(std::vector<float>(b.stride, 3.0f));
        b.shot = test::upload(std::vector<float>(3 * b.stride, nan));
        b.chosen = test::upload(std::vector<cl_uint>(sites.size() + 1, 77));
    }
};

TEST(Place, TakesMeansOfReflectanceAndTurnsBacks) {
    Heap heap(50);
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
    const Heap heap(70);
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

// L(rho_k (E_k + I - E)) over its mean. The mean itself comes to 1.
TEST(Weigh, SharesPowerByLightAndColourOfTheSamples) {
    const Heap heap(60);
    const SiteBuffers& b = heap.buffers;
    test::Random random(9);
    std::vector<float> irradiance(3 * b.sample_stride), light(SITE_LIGHT_PLANES * b.stride, nan);
    for (float& value : irradiance) value = static_cast<float>(random(0, 9));
    for (std::size_t i = 0; i < heap.sites.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            double mean = 0.0;
            const Site& site = heap.sites[i];
            for (std::uint32_t k = site.first_sample; k < site.first_sample + site.sample_count;
                 ++k) {
                float& value = irradiance[c * b.sample_stride + k];
                if (i == 5) value = 0.0f;  // no light at all
                if (i == 6) value = 2.0f;  // even light
                mean += double{value} / site.sample_count;
            }
            // Reflected light between none and twice the direct.
            light[(SITE_RECEIVED + c) * b.stride + i] =
                i == 5 ? 0.0f : static_cast<float>(mean * random(1.0, 3.0));
        }
    SiteBuffers with = b;
    with.light = test::upload(light);
    test::vpl_passes().weigh(test::device().queue, with, test::upload(irradiance));
    const auto weights = test::download<float>(b.weights, b.sample_stride);
    const double luminance[3] = {0.2126, 0.7152, 0.0722};
    for (std::size_t i = 0; i < heap.sites.size(); ++i) {
        const Site& site = heap.sites[i];
        const std::uint32_t last = site.first_sample + site.sample_count;
        double mean[3] = {0, 0, 0}, sum = 0.0, sum_found = 0.0;
        for (int c = 0; c < 3; ++c)
            for (std::uint32_t k = site.first_sample; k < last; ++k)
                mean[c] += double{irradiance[c * b.sample_stride + k]} / site.sample_count;
        std::vector<double> wanted;
        for (std::uint32_t k = site.first_sample; k < last; ++k) {
            double value = 0.0;
            for (int c = 0; c < 3; ++c)
                value += luminance[c] * heap.samples[(GBUFFER_BASE + c) * b.sample_stride + k] *
                         (double{irradiance[c * b.sample_stride + k]} +
                          light[(SITE_RECEIVED + c) * b.stride + i] - mean[c]);
            wanted.push_back(value);
            sum += value;
        }
        for (std::uint32_t k = 0; k < site.sample_count; ++k) {
            const double found = weights[site.first_sample + k];
            sum_found += found;
            const double share = sum > 0.0 ? wanted[k] * site.sample_count / sum : 1.0;
            EXPECT_NEAR(found, share, 2e-5 * std::max(share, 1.0)) << "site " << i;
            EXPECT_TRUE(i != 5 || found == 1.0);
        }
        EXPECT_NEAR(sum_found / site.sample_count, 1.0, 1e-5);
    }
}

// Weights stay numbers whatever the light is: too dark or too bright to be summed.
TEST(Weigh, StaysFinite) {
    for (const float value :
         {1e-42f, 1e-39f, 1e-30f, 1e30f, 3e38f, nan, std::numeric_limits<float>::infinity()}) {
        const Heap heap(4);
        const SiteBuffers& b = heap.buffers;
        SiteBuffers with = b;
        with.light = test::upload(std::vector<float>(SITE_LIGHT_PLANES * b.stride, value));
        test::vpl_passes().weigh(test::device().queue, with,
                                 test::upload(std::vector<float>(3 * b.sample_stride, value)));
        const auto weights = test::download<float>(b.weights, b.sample_stride);
        for (const Site& site : heap.sites) {
            double sum = 0.0;
            for (std::uint32_t k = 0; k < site.sample_count; ++k)
                sum += weights[site.first_sample + k];
            EXPECT_NEAR(sum, site.sample_count, 1e-5 * site.sample_count) << value;
        }
    }
}

// ---- emit
// ----------------------------------------------------------------------------------------

struct Emitted {
    Heap heap;
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
