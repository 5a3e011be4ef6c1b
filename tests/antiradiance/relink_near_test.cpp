// Links on the device between elements that come nearer to each other than in all poses.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/antiradiance.hpp>
#include <clgi/scene_mover.hpp>
#include <cmath>

#include "device.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(RelinkNear);

// A floor that is one element for what is far above it in all poses: what comes close to its middle
// sees no more than half of the sphere.
TEST_P(RelinkNear, BoundsWhatComesNearerThanInAllPoses) {
    Scene scene = test::plain_scene();
    constexpr int n = 6;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double a = 1.0 / n, x = i * a, z = k * a;
            test::add_quad(scene,
                           {glm::dvec3(x, 0, z), {x, 0, z + a}, {x + a, 0, z + a}, {x + a, 0, z}});
        }
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    test::add_triangle(scene, {0.49, 20, 0.49}, {0.51, 20, 0.49}, {0.49, 20, 0.51});
    scene.lights = {test::point_light({0.5, 5.0, 0.5})};
    const auto at = [&](const glm::dvec3& by) {
        std::vector<glm::dvec3> out = scene.positions;
        for (std::uint32_t v = first; v < out.size(); ++v) out[v] += by;
        return out;
    };
    AntiradianceOptions options;
    options.bins = 32;
    options.elements.max_area = 1.0;
    options.elements.backs = false;
    options.steps = 4;
    options.build.math = GetParam();
    options.poses = {at({0, 0, 0}), at({0.1, 0, 0}), at({0.2, 0, 0})};
    DeviceScene device = test::on_device(scene);
    AntiradianceSolver solver(test::programs(), test::device().queue, scene, device, options);
    SceneMover mover(test::programs(), test::device().queue, device);
    mover.move(0, at({0, -19.99, 0}), scene.normals).wait();
    solver.geometry_changed();
    ASSERT_TRUE(solver.run());
    EXPECT_EQ(solver.status().non_finite, 0u);
    const ElementTree& tree = solver.elements();
    const auto elements = test::download<Element>(solver.links().elements, tree.count());
    const auto firsts =
        test::download<std::uint32_t>(solver.links().first_links, 2 * tree.count() + 1);
    const auto senders = test::download<std::uint32_t>(solver.links().senders, solver.link_count());
    const auto bins = test::download<std::uint16_t>(solver.links().bins, solver.link_count());
    const auto factors = test::download<float>(solver.links().form_factors, solver.link_count());
    double largest = 0.0;
    for (std::size_t r = 0; r < tree.count(); ++r)
        for (std::uint32_t k = firsts[2 * r + 1]; tree.moves(r) && k < firsts[2 * r + 2]; ++k)
            for (const Element& sender : elements) {
                if (sender.sends != senders[k]) continue;
                const glm::dvec3& w = solver.bins().directions[bins[k]];
                largest = std::max(largest, factors[k] * sender.normal.w *
                                                std::abs(glm::dot(glm::dvec3(sender.normal), w)) *
                                                solver.bins().solid_angles[bins[k]]);
            }
    EXPECT_NEAR(largest, 2.0 * 3.14159265358979, 1e-4);
}

}  // namespace
}  // namespace clgi
