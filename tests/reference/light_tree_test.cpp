// Lamps that are chosen by what they may bring.
// SPDX-License-Identifier: MIT
#include "reference/light_tree.hpp"

#include <gtest/gtest.h>
#include <cmath>

namespace clgi::reference {
namespace {

std::vector<LightTree::Item> lamps(int count) {
    std::vector<LightTree::Item> out;
    for (int k = 0; k < count; ++k) {
        Random random(3, 0, static_cast<std::uint64_t>(k));
        const float x = random(), y = random(), z = random();
        out.push_back({{4.0f * x, 2.0f * y, z}, 0.01f + 0.1f * random(), 0.1 + 10.0 * random()});
    }
    return out;
}

// As often as it says, and one of all.
TEST(LightTree, DrawsByItsProbability) {
    for (const int count : {1, 2, 3, 13}) {
        const LightTree tree(lamps(count));
        for (const glm::vec3& point : {glm::vec3(0.3f, 0.4f, 0.5f), glm::vec3(9.0f, -3.0f, 1.0f)}) {
            double sum = 0.0;
            std::vector<double> found(static_cast<std::size_t>(count), 0.0);
            constexpr int draws = 40000;
            for (int k = 0; k < draws; ++k) {
                Random random(8, 0, static_cast<std::uint64_t>(k));
                found[tree.sample(point, random)] += 1.0 / draws;
            }
            for (std::uint32_t k = 0; k < found.size(); ++k) {
                const double wanted = tree.probability(k, point);
                sum += wanted;
                EXPECT_NEAR(found[k], wanted, 5.0 * std::sqrt(wanted / draws) + 1e-9) << count;
            }
            EXPECT_NEAR(sum, 1.0, 1e-5);
        }
    }
}

// Two lamps: by power over the square of the distance, and within its sphere by power over the
// square of the radius.
TEST(LightTree, WeighsPowerAndDistance) {
    const LightTree tree({{{0, 0, 0}, 0.1f, 3.0f}, {{4, 0, 0}, 0.2f, 2.0f}});
    const double near = 3.0 / 1.0, far = 2.0 / 9.0;
    EXPECT_NEAR(tree.probability(0, {1, 0, 0}), near / (near + far), 1e-6);
    EXPECT_NEAR(tree.probability(1, {1, 0, 0}), far / (near + far), 1e-6);
    const double inside = 3.0 / 0.01, outside = 2.0 / 16.0;
    EXPECT_NEAR(tree.probability(1, {0, 0, 0}) / (outside / (inside + outside)), 1.0, 1e-5);
}

// As bright and as dim as numbers get: what is drawn is told its probability, and none is not a
// number.
TEST(LightTree, HoldsAnyPower) {
    const LightTree tree(
        {{{0, 0, 0}, 0.0f, 3e40}, {{1, 0, 0}, 0.1f, 1e-40}, {{0, 1, 0}, 0.1f, 2e40}});
    for (const glm::vec3& point : {glm::vec3(0.0f), glm::vec3(1, 0, 0), glm::vec3(0, 0.5f, 0)}) {
        double sum = 0.0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(tree.probability(k, point) >= 0.0f) << k;
            sum += double{tree.probability(k, point)};
        }
        EXPECT_NEAR(sum, 1.0, 1e-5);
        Random random(1, 0, 0);
        for (int k = 0; k < 100; ++k)
            EXPECT_GT(tree.probability(tree.sample(point, random), point), 0.0f);
    }
}

// The lamp of each of two hundred rooms is found there many times as often as one in two hundred.
TEST(LightTree, FindsTheLampOfARoom) {
    std::vector<LightTree::Item> rooms;
    for (int k = 0; k < 200; ++k)
        rooms.push_back({{5.0f * (k % 20), 2.5f, 5.0f * (k / 20)}, 0.5f, 1.0f});
    const LightTree tree(rooms);
    for (const std::uint32_t k : {0u, 7u, 111u, 199u})
        EXPECT_GT(tree.probability(k, rooms[k].centre + glm::vec3(0.8f, -1.5f, -0.4f)), 0.03f) << k;
}

}  // namespace
}  // namespace clgi::reference
