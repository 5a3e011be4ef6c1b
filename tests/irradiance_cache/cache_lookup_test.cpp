// Light of many records at points that lie side by side in a picture and far apart in the scene.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>

#include "planted.hpp"
#include "shares_by_hand.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t count = 400, points = 112, stride = 432;

// Crowded in one corner, so that leaves lie one to six levels deep; few face down, so that lists
// have different lengths.
std::vector<CacheRecord> crowded_records(std::mt19937& random) {
    std::normal_distribution<float> about(0.0f, 1.0f);
    std::uniform_real_distribution<float> depth(0.0f, 5.0f);
    std::vector<CacheRecord> out;
    while (out.size() < count) {
        CacheRecord one;
        one.position =
            glm::vec3(3.0f, -1.0f, 2.0f) +
            std::exp2(-depth(random)) * glm::vec3(about(random), about(random), about(random));
        one.normal = glm::normalize(glm::vec3(about(random), about(random), about(random)));
        if (one.normal.y < 0.3f && out.size() > 3) continue;
        one.geometric = one.normal;
        out.push_back(one);
    }
    return out;
}

void put(std::vector<float>& planes, std::uint32_t plane_of, std::uint32_t at, const glm::vec3& v) {
    for (int c = 0; c < 3; ++c)
        planes[(plane_of + static_cast<std::uint32_t>(c)) * stride + at] = v[c];
}

CLGI_IN_BOTH_MATHS(CacheLookup);

// By the list that the tree on the host has for each point, and its shares in double precision.
// Points of one packet have leaves of different depth, lists of different length, and ways to face
// of their own.
TEST_P(CacheLookup, IsThatOfEachPointsOwnList) {
    std::mt19937 random(71);
    const std::vector<CacheRecord> records = crowded_records(random);
    const test::Planted planted(records);
    std::normal_distribution<float> about(0.0f, 1.0f);
    std::vector<float> held(RECORD_PLANES * stride, 0.0f), light(3 * stride, 0.0f),
        planes(GBUFFER_PLANES * stride, 0.0f);
    for (std::uint32_t i = 0; i < count; ++i) {
        put(held, RECORD_POSITION, i, records[i].position);
        put(held, RECORD_NORMAL, i, records[i].normal);
        put(light, 0, i,
            glm::vec3(1.0f, 5.0f, 2.0f) + std::abs(about(random)) * glm::vec3(3.0f, 1.0f, 0.2f));
    }
    std::vector<CacheRecord> places;
    for (std::uint32_t k = 0; k < points; ++k) {
        CacheRecord place = records[37 * k % count];
        place.position += 0.1f * glm::vec3(about(random), about(random), about(random));
        place.normal = glm::normalize(
            place.normal + 0.3f * glm::vec3(about(random), about(random), about(random)));
        if (k % 7 == 6) place.normal = {0.0f, -1.0f, 0.0f};
        put(planes, GBUFFER_POSITION, k, place.position);
        put(planes, GBUFFER_NORMAL, k, place.normal);
        places.push_back(place);
    }
    CacheTree tree = planted.on_device;
    tree.stride = stride;
    CacheBuffers b = planted.b;
    b.planes = test::upload(held);
    b.light = test::upload(light);
    const cl::Buffer irradiance = test::empty<float>(3 * stride),
                     doubt = test::empty<float>(stride);
    CachePasses(test::programs(), test::usual_build())
        .show(test::device().queue, {points, stride, 0, 0}, tree, b, points_of(planes, stride),
              irradiance, doubt)
        .wait();
    const auto found = test::download<float>(irradiance, 3 * stride);
    const auto doubts = test::download<float>(doubt, stride);
    std::size_t shortest = CACHE_LISTED, longest = 0;
    for (std::uint32_t k = 0; k < points; ++k) {
        const std::uint32_t* list = planted.listed(places[k]);
        std::vector<glm::dvec3> at, normals;
        std::vector<std::uint32_t> who;
        for (int i = 0; i < CACHE_LISTED && list[i] != CACHE_NONE; ++i) {
            who.push_back(list[i]);
            at.push_back(records[list[i]].position);
            normals.push_back(records[list[i]].normal);
        }
        shortest = std::min(shortest, who.size());
        longest = std::max(longest, who.size());
        const std::vector<double> share =
            carried_by_hand(shares_by_hand(at, normals, places[k].position, places[k].normal), at,
                            places[k].position);
        glm::dvec3 wanted(0.0);
        for (std::size_t i = 0; i < who.size(); ++i)
            for (int c = 0; c < 3; ++c)
                wanted[c] += share[i] * light[static_cast<std::uint32_t>(c) * stride + who[i]];
        const glm::dvec3 weights(0.2126, 0.7152, 0.0722);
        double spread = 0.0;
        for (std::size_t i = 0; i < who.size(); ++i) {
            glm::dvec3 off = -wanted;
            for (int c = 0; c < 3; ++c)
                off[c] += light[static_cast<std::uint32_t>(c) * stride + who[i]];
            spread += share[i] * std::pow(glm::dot(off, weights), 2.0);
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[static_cast<std::uint32_t>(c) * stride + k], wanted[c],
                        1e-3 * wanted[c])
                << k << " " << c;
        EXPECT_NEAR(doubts[k], spread, 1e-3 * (spread + 1.0)) << k;
    }
    EXPECT_LT(shortest, 6u);
    EXPECT_EQ(longest, std::size_t{CACHE_LISTED});
}

// Of what is picked: what the records that stand in differ by, a tenth of what they say, and what
// records around it have where those that stand in are far off, all in double precision. Of places
// on a wall beside records of their own nothing is unknown; of some that face down, all.
TEST_P(CacheLookup, WeighsPlacesOnWhichNoRecordStands) {
    std::mt19937 random(72);
    const std::vector<CacheRecord> records = crowded_records(random);
    const test::Planted planted(records);
    std::normal_distribution<float> about(0.0f, 1.0f);
    std::vector<float> light(3 * std::size_t{planted.on_device.stride}, 0.0f),
        held(PICK_PLANES * stride, 0.0f);
    std::vector<double> shines;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 e(1.0f + std::abs(about(random)), 2.0f, 3.0f * std::abs(about(random)));
        for (int c = 0; c < 3; ++c)
            light[static_cast<std::uint32_t>(c) * planted.on_device.stride + i] = e[c];
        shines.push_back(glm::dot(glm::dvec3(e), glm::dvec3(0.2126, 0.7152, 0.0722)));
    }
    std::vector<CacheRecord> places;
    for (std::uint32_t k = 0; k < points; ++k) {
        CacheRecord place = records[41 * k % count];
        if (k % 5 != 4)  // others lie on their records
            place.position += 0.02f * glm::vec3(about(random), about(random), about(random));
        if (k % 3 == 0)
            place.normal = glm::normalize(glm::vec3(about(random), about(random), about(random)));
        if (k % 7 == 6) place.normal = {0.0f, -1.0f, 0.0f};
        put(held, RECORD_POSITION, k, place.position);
        put(held, RECORD_NORMAL, k, place.normal);
        held[PICK_REFLECTANCE * stride + k] = 0.2f + 0.005f * static_cast<float>(k);
        places.push_back(place);
    }
    CacheBuffers b = planted.b;
    b.light = test::upload(light);
    CacheParams params{};
    params.count = 1;
    params.picks = points;
    params.pick_stride = stride;
    const cl::Buffer worth = test::empty<float>(stride),
                     nearest = test::empty<std::uint32_t>(stride);
    CachePasses(test::programs(), test::usual_build())
        .weigh(test::device().queue, params, planted.on_device, b, test::upload(held), worth,
               nearest)
        .wait();
    const auto found = test::download<float>(worth, stride);
    int known = 0, unknown = 0;
    for (std::uint32_t k = 0; k < points; ++k) {
        const glm::dvec3 point = places[k].position, normal = places[k].normal;
        const auto listed = [&](const CacheRecord& place, int most) {
            std::vector<std::uint32_t> out;
            const std::uint32_t* list = planted.listed(place);
            for (int i = 0; i < most && list[i] != CACHE_NONE; ++i) out.push_back(list[i]);
            return out;
        };
        double mean = 0.0, spread = 0.0, near = 1e30, standing = 1e30, most = 0.0;
        const std::vector<std::uint32_t> own = listed(places[k], CACHE_LISTED);
        std::vector<glm::dvec3> at, normals;
        for (const std::uint32_t i : own) {
            at.push_back(records[i].position);
            normals.push_back(records[i].normal);
        }
        const std::vector<double> share = shares_by_hand(at, normals, point, normal);
        for (std::size_t i = 0; i < own.size(); ++i) mean += share[i] * shines[own[i]];
        for (std::size_t i = 0; i < own.size(); ++i)
            spread += share[i] * std::pow(shines[own[i]] - mean, 2.0);
        for (int way = 0; way < CACHE_WAYS; ++way) {
            CacheRecord turned = places[k];
            turned.normal = glm::vec3(0.0f);
            turned.normal[way / 2] = way % 2 == 0 ? 1.0f : -1.0f;
            const bool own_way = planted.listed(turned) == planted.listed(places[k]);
            for (const std::uint32_t i : listed(turned, 5)) {
                const glm::dvec3 d = glm::dvec3(records[i].position) - point, n = records[i].normal;
                const double off = 4.0 * (std::abs(glm::dot(n, d)) + std::abs(glm::dot(normal, d)));
                near = std::min(near, glm::dot(d, d));
                most = std::max(most, shines[i]);
                if (own_way && glm::dot(n, normal) > 0.3)
                    standing = std::min(standing, glm::dot(d, d) + off * off);
            }
        }
        const double bare =
            standing > 0.0 ? std::max(1.0 - 16.0 * near / standing, 0.0) * most : 0.0;
        const double wanted =
            (0.2 + 0.005 * k) * std::sqrt(spread + 0.01 * mean * mean + bare * bare);
        EXPECT_NEAR(found[k], wanted, 2e-3 * wanted) << k;
        known += bare == 0.0;
        unknown += bare > 0.9 * most;
    }
    EXPECT_GT(known, 10);
    EXPECT_GT(unknown, 10);
}

}  // namespace
}  // namespace clgi
