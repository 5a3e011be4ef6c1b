// Random trees of elements, and comparison of their light.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "element_light.hpp"

namespace clgi::test {

inline glm::vec3 scaled(const DirectionBins& bins, const glm::dvec3& normal) {
    return glm::vec3(normal * bins.hemisphere_scale(normal));
}

// Inner elements with up to four below them, five levels deep; some lie in one plane.
inline void grow(HandElements& scene, const DirectionBins& bins, std::uint32_t parent, int depth,
                 std::mt19937& random, glm::vec3 plane = glm::vec3(0.0f)) {
    std::uniform_real_distribution<float> number(0.0f, 1.0f);
    const bool is_leaf = depth == 5 || (depth > 1 && number(random) < 0.25f);
    if (plane == glm::vec3(0.0f) && (is_leaf || (depth > 1 && number(random) < 0.3f))) {
        std::normal_distribution<double> normal;
        plane = scaled(bins,
                       glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
    }
    if (is_leaf) {
        scene.leaf(parent, plane, 0.1f + number(random),
                   {number(random), 2.0f * number(random), 3.0f * number(random)},
                   {number(random), 0.8f * number(random), 0.5f * number(random)});
        return;
    }
    const std::uint32_t i = scene.inner(parent, plane);
    const int below = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < below; ++k) grow(scene, bins, i, depth + 1, random, plane);
    scene.close(i);
}

inline HandElements random_elements(unsigned seed, int count) {
    const DirectionBins bins = direction_bins(count);
    HandElements scene(direction_rows(bins));
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(0.0f, 1.0f);
    grow(scene, bins, ELEMENT_NONE, 0, random);
    const auto any = [&](std::size_t most) { return static_cast<std::uint32_t>(random() % most); };
    // Elements at the end send before them alone.
    for (std::size_t i = 0; i < 24 * scene.elements.size(); ++i) {
        const HandLink link = {any(scene.elements.size()), any(scene.elements.size()),
                               any(scene.bins()), 0.15f * number(random)};
        if (scene.cosine(link) > 0.0f ||
            scene.elements[link.sender].end < 0.7 * scene.elements.size())
            scene.links.push_back(link);
    }
    for (glm::vec4& sky : scene.sky)
        sky = {number(random), 0.5f * number(random), 2.0f * number(random), 0.0f};
    return scene;
}

template <typename Found, typename Wanted>
void expect_alike(const std::vector<Found>& found, const std::vector<Wanted>& wanted, double within,
                  const char* what) {
    ASSERT_EQ(found.size(), wanted.size());
    double largest = 0.0;
    for (const Wanted& value : wanted)
        largest =
            std::max<double>({largest, std::abs(value.x), std::abs(value.y), std::abs(value.z)});
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(found[i][c], wanted[i][c], within * largest)
                << what << " " << i << " channel " << c;
}

}  // namespace clgi::test
