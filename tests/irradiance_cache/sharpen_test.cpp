// Light of records that interpolation between them blurs less.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "drawing.hpp"
#include "planted.hpp"
#include "shares_by_hand.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

using LightOfRecords = std::vector<std::array<double, 3>>;

std::vector<float> planes_of(const LightOfRecords& light, std::uint32_t stride) {
    std::vector<float> out(3 * std::size_t{stride}, 0.0f);
    for (std::size_t i = 0; i < light.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) out[c * stride + i] = static_cast<float>(light[i][c]);
    return out;
}

// The light and what it becomes, of both.
struct SharpenedLight {
    std::vector<float> light, more;
    std::uint32_t stride = 0;
    float of(std::size_t c, std::size_t i) const { return light[c * stride + i]; }
    float of_more(std::size_t c, std::size_t i) const { return more[c * stride + i]; }
};

SharpenedLight sharpened(const test::Planted& planted, const LightOfRecords& light,
                         const LightOfRecords& more, const CacheSharpenParams& params) {
    const std::uint32_t stride = planted.on_device.stride;
    const std::size_t size = 3 * std::size_t{stride};
    const cl::Buffer to = test::upload(std::vector<float>(size, -7.0f)),
                     more_to = test::upload(std::vector<float>(size, -7.0f));
    CachePasses(test::programs(), test::usual_build())
        .sharpen(test::device().queue, params, planted.on_device, planted.b,
                 {test::upload(planes_of(light, stride)), to},
                 {test::upload(planes_of(more, stride)), more_to})
        .wait();
    return {test::download<float>(to, size), test::download<float>(more_to, size), stride};
}

// A bent surface, some of it turned away from its neighbours.
std::vector<CacheRecord> bent_records(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<float> side(-1.0f, 1.0f);
    std::vector<CacheRecord> out;
    while (out.size() < count) {
        const float x = side(random), z = side(random);
        CacheRecord one;
        one.position = {x, 0.2f * x * x, z};
        one.normal = glm::normalize(glm::vec3(-0.4f * x, 1.0f, 0.3f * side(random)));
        if (out.size() % 9 == 8) one.normal = glm::normalize(glm::vec3(1.0f, 0.1f, side(random)));
        one.geometric = one.normal;
        out.push_back(one);
    }
    return out;
}

CLGI_IN_BOTH_MATHS(Sharpen);

// By the shares of each record's own list, of hemicubes and of pixels, with and without a second
// light, which is less than 0 in places. Some records are so dark beside others that they change
// by half of what they have; of what bright ones lie above the others the less is added the more
// that is.
TEST_P(Sharpen, IsThatOfTheDefinition) {
    std::mt19937 random(81);
    constexpr std::size_t count = 211;
    const std::vector<CacheRecord> records = bent_records(count, random);
    const test::Planted planted(records);
    std::normal_distribution<double> about;
    LightOfRecords light, more;
    for (std::size_t i = 0; i < count; ++i) {
        const double dark = i % 6 == 5 ? 0.01 : i % 31 == 7 ? 0.0 : 1.0;
        light.push_back({dark * (2.0 + std::abs(about(random))), 3.0 + std::abs(about(random)),
                         dark * (1.0 + records[i].position.x * records[i].position.x)});
        more.push_back({about(random), -1.0, 3.0 * about(random)});
    }
    int within = 0, limited = 0, above = 0;
    for (const CacheSharpenParams& params :
         {CacheSharpenParams{CACHE_FEW, 0, 1, 0}, CacheSharpenParams{CACHE_LISTED, 1, 1, 0},
          CacheSharpenParams{CACHE_LISTED, 1, 0, 0}}) {
        const SharpenedLight found = sharpened(planted, light, more, params);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t* list = planted.listed(records[i]);
            std::vector<glm::dvec3> at, normals;
            std::vector<std::uint32_t> who;
            for (std::uint32_t k = 0; k < params.most && list[k] != CACHE_NONE; ++k) {
                who.push_back(list[k]);
                at.push_back(records[list[k]].position);
                normals.push_back(records[list[k]].normal);
            }
            const glm::dvec3 point = records[i].position;
            std::vector<double> share = shares_by_hand(at, normals, point, records[i].normal);
            if (params.carried) share = carried_by_hand(share, at, point);
            for (std::size_t c = 0; c < 3; ++c) {
                double mean = 0.0, mean_more = 0.0;
                for (std::size_t k = 0; k < who.size(); ++k) {
                    mean += share[k] * light[who[k]][c];
                    mean_more += share[k] * more[who[k]][c];
                }
                const double off = light[i][c] - mean, most = 0.5 * light[i][c];
                double part = std::abs(off) > most ? most / std::abs(off) : 1.0;
                within += off < 0.0 && part == 1.0 && -off > 0.1 * most;
                limited += off < 0.0 && part < 1.0;
                if (off > 0.0) part = 1.0 / (1.0 + off * off / (most * most));
                above += off > 0.3 * most;
                const double wanted = light[i][c] + part * off;
                EXPECT_NEAR(found.of(c, i), wanted, 1e-3 * wanted + 1e-6) << i << " " << c;
                const double of_more = more[i][c] + part * (more[i][c] - mean_more);
                EXPECT_NEAR(found.of_more(c, i), params.more ? of_more : -7.0, 4e-3)
                    << i << " " << c;
            }
        }
    }
    EXPECT_GT(within, 250);
    EXPECT_GT(limited, 200);
    EXPECT_GT(above, 150);
}

// Light that falls off as beside a lamp, on a wall whose records stand in a grid: pixels
// between them are nearer to it than without, by half and more; even light stays even.
TEST_P(Sharpen, PixelsBesideALampAreNearerToItsLight) {
    constexpr int across = 21;
    constexpr double spacing = 0.1;
    const auto lamp = [](const glm::dvec3& at) { return 1.0 / (0.04 + at.x * at.x); };
    std::vector<CacheRecord> records;
    LightOfRecords light;
    const std::array<double, 3> color{1.0, 0.5, 2.0};
    for (int x = 0; x < across; ++x)
        for (int y = 0; y < across; ++y) {
            CacheRecord one;
            one.position = {spacing * x, spacing * y, 0.0};
            one.normal = one.geometric = {0.0f, 0.0f, 1.0f};
            records.push_back(one);
            const double e = lamp(one.position);
            light.push_back({color[0] * e, color[1] * e, color[2]});
        }
    const test::Planted planted(records);
    const SharpenedLight sharp = sharpened(planted, light, light, {CACHE_LISTED, 1, 0, 0});
    std::mt19937 random(82);
    std::uniform_real_distribution<float> along(0.25f, 1.75f);
    constexpr std::uint32_t points = 256;
    const std::uint32_t stride = test::padded(points);
    std::vector<float> planes(GBUFFER_PLANES * stride, 0.0f);
    for (std::uint32_t k = 0; k < points; ++k) {
        planes[(GBUFFER_POSITION + 0) * stride + k] = along(random);
        planes[(GBUFFER_POSITION + 1) * stride + k] = along(random);
        planes[(GBUFFER_NORMAL + 2) * stride + k] = 1.0f;
    }
    const auto shown = [&](const std::vector<float>& of) {
        CacheBuffers b = planted.b;
        b.light = test::upload(of);
        const cl::Buffer irradiance = test::empty<float>(3 * std::size_t{stride}),
                         doubt = test::empty<float>(stride);
        CachePasses(test::programs(), test::usual_build())
            .show(test::device().queue, {points, stride, 0, 0}, planted.on_device, b,
                  points_of(planes, stride), irradiance, doubt)
            .wait();
        return test::download<float>(irradiance, 3 * std::size_t{stride});
    };
    const std::vector<float> before = shown(planes_of(light, planted.on_device.stride)),
                             after = shown(sharp.light);
    for (std::size_t c = 0; c < 3; ++c) {
        double was = 0.0, is = 0.0;
        for (std::uint32_t k = 0; k < points; ++k) {
            const glm::dvec3 at(planes[GBUFFER_POSITION * stride + k], 0, 0);
            const double wanted = c == 2 ? color[2] : color[c] * lamp(at);
            was += std::abs(before[c * stride + k] / wanted - 1.0);
            is += std::abs(after[c * stride + k] / wanted - 1.0);
        }
        if (c == 2) {
            EXPECT_NEAR(is / points, 0.0, 1e-5);
            continue;
        }
        EXPECT_GT(was / points, 0.01) << c;
        EXPECT_LT(is, 0.5 * was) << c;
    }
}

// A record that turns so far that none of the list of its place stands in for it, and one of even
// light, are left alone; of none nothing is written.
TEST_P(Sharpen, LeavesAloneWhereNothingStandsIn) {
    std::vector<CacheRecord> records(3);
    for (std::size_t i = 0; i < 3; ++i) {
        records[i].position = {0.1f * static_cast<float>(i), 0.0f, 0.0f};
        records[i].normal = records[i].geometric = {0.0f, 1.0f, 0.0f};
    }
    test::Planted planted(records);
    const LightOfRecords even(3, {2.0, 3.0, 5.0});
    const CacheSharpenParams params{CACHE_LISTED, 1, 0, 0};
    const SharpenedLight same = sharpened(planted, even, even, params);
    planted.b.lists = test::upload(std::vector<std::uint32_t>(planted.lists.size(), CACHE_NONE));
    const SharpenedLight alone = sharpened(planted, even, even, params);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(same.of(c, i), even[i][c], 1e-5) << i << " " << c;
            EXPECT_EQ(alone.of(c, i), static_cast<float>(even[i][c])) << i << " " << c;
        }
    planted.on_device.record_count = 0;
    EXPECT_EQ(sharpened(planted, even, even, params).of(0, 0), -7.0f);
}

}  // namespace
}  // namespace clgi
