// Words of depth alone against words with triangles: the same closeness but for the lowest bit,
// which says whether the back of a single-sided triangle is seen.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>

#include "drawing.hpp"

namespace clgi::test {

constexpr std::uint64_t no_triangle = ~std::uint64_t{0};

// As clgi/shared/gbuffer.h defines it.
inline double closeness(const View& view, double depth) {
    if (view.eye.w == 0.0f) return 1.0 / depth;
    const double near = view.forward.w, far = view.window.z;
    return (far - depth) / (far - near);
}

inline float seen_closeness(const Drawing& drawing, std::size_t pixel) {
    const auto bits = ~static_cast<std::uint32_t>(drawing.visibility[pixel] >> 32);
    float out = 0.0f;
    std::memcpy(&out, &bits, sizeof out);
    return out;
}

// All but the lowest bit.
inline void expect_closeness(const std::vector<std::uint32_t>& depth,
                             const std::vector<std::uint64_t>& words, const std::string& label) {
    ASSERT_EQ(depth.size(), words.size()) << label;
    std::size_t wrong = 0;
    for (std::size_t p = 0; p < words.size(); ++p) {
        wrong += (depth[p] | 1u) != (static_cast<std::uint32_t>(words[p] >> 32) | 1u);
        wrong += words[p] == no_triangle && depth[p] != ~0u;
    }
    EXPECT_EQ(wrong, 0u) << label;
}

struct Sides {
    std::size_t fronts = 0, backs = 0, wrong = 0;
};

// Which sides are seen in a view, by the triangle of each pixel: (eye - a) . n. Triangles seen
// nearly edge on are left out, since their corners are rounded on the screen.
inline void count_sides(const DeviceScene& scene, const View& view,
                        const std::vector<std::uint32_t>& depth,
                        const std::vector<std::uint64_t>& words, Sides& sides) {
    const auto triangles = download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    const auto positions = download<glm::vec4>(scene.positions(), scene.info().vertex_count);
    for (std::size_t p = view.first_pixel; p < view.first_pixel + view.width * view.height; ++p) {
        if (words[p] == no_triangle) continue;
        const glm::uvec4 t = triangles[static_cast<std::uint32_t>(words[p])];
        const glm::dvec3 a(glm::vec3(positions[t.x])), b(glm::vec3(positions[t.y])),
            c(glm::vec3(positions[t.z]));
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const glm::dvec3 to_eye = view.eye.w == 0.0f ? glm::dvec3(glm::vec3(view.eye)) - a
                                                     : -glm::dvec3(glm::vec3(view.forward));
        const double cosine = glm::dot(n, to_eye) / (glm::length(n) * glm::length(to_eye));
        if (std::abs(cosine) < 0.02) continue;
        const bool back = cosine < 0.0 && !(t.w & std::uint32_t(TRIANGLE_DOUBLE_SIDED));
        ++(back ? sides.backs : sides.fronts);
        sides.wrong += back != ((depth[p] & 1u) != 0);
    }
}

}  // namespace clgi::test
