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

}  // namespace
}  // namespace clgi
