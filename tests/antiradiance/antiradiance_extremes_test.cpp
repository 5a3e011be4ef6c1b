// Antiradiance at the edges of its numbers: dim light of small leaves in half storage.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "moving_room.hpp"
#include "rooms.hpp"
#include "solved_antiradiance.hpp"

namespace clgi {
namespace {

// A room under a dim coloured lamp. A spot light outside, which lights nothing, is so bright that
// the exposure is its own.
Scene dim_room(float dimmer) {
    Scene scene = test::furnished_room(5);
    scene.lights[0].intensity = dimmer * glm::vec3(0.5f, 1.0f, 0.25f);
    scene.lights.push_back(test::spot_light({-1, 1, 1}, {-1, 0, 0}, 0.3, 1.0f));
    return scene;
}

// As a share of all that arrives: by how much light of half storage differs.
double difference(const Scene& scene, AntiradianceOptions options) {
    options.steps = 6;
    options.iteration = Iteration::symmetric;
    options.build.storage = Storage::full;
    const test::Solved full(scene, options);
    options.build.storage = Storage::half;
    const test::Solved half(scene, options);
    EXPECT_TRUE(full.solver.status().lets_through);
    const auto wanted = full.irradiances(), found = half.irradiances();
    double apart = 0.0, whole = 0.0;
    for (std::size_t row = 0; row < wanted.size(); ++row) {
        const double area = full.solver.elements().areas[full.element(row)];
        for (int c = 0; c < 3; ++c) {
            apart += area * std::abs(double{found[row][c]} - wanted[row][c]);
            whole += area * double{wanted[row][c]};
        }
    }
    return apart / whole;
}

// Numbers of rows are rounded by 2^-12 on average, those that are let through are the smaller part
// of the light, and their errors have both signs: less than 2^-10 in all. Areas are some 2^-11 of
// the frame and dim radiance is 2^-13 and less: their product would be about the smallest half,
// 2^-24, so that shadows would be gone.
TEST(AntiradianceHalf, KeepsDimLightOfSmallLeaves) {
    AntiradianceOptions options = test::options_of(test::usual_build(), 64, 6000);
    for (const float dimmer : {1.0f, 0x1p-12f, 0x1p-14f}) {
        const double found = difference(dim_room(dimmer), options);
        std::printf("dimmed by %g: %.5f\n", double{dimmer}, found);
        EXPECT_LT(found, 0x1p-10) << dimmer;
    }
}

// Exponents follow areas: twice the area, one more.
TEST(AntiradianceHalf, HasRowsOfTheOrderOfRadiance) {
    const Scene scene = dim_room(1.0f);
    AntiradianceOptions options = test::options_of(test::usual_build(), 64, 400);
    for (const Storage storage : {Storage::full, Storage::half}) {
        options.build.storage = storage;
        const test::Solved of(scene, options, false);
        const auto elements =
            test::download<Element>(of.solver.links().elements, of.solver.links().element_count);
        for (const Element& element : elements) {
            const double share = std::ldexp(double{element.normal.w}, -element.row_exponent);
            if (storage == Storage::full) {
                EXPECT_EQ(element.row_exponent, 0);
            } else if (element.normal.w > 0.0f) {
                EXPECT_GE(share, 0.5);
                EXPECT_LT(share, 1.0);
            }
        }
    }
}

// Moving links are made on the device: they know the exponents too.
TEST(AntiradianceHalf, KeepsTheLightOfWhatMoves) {
    test::MovingRoom room;
    room.scene.lights[0].intensity *= 0x1p-16f;
    room.scene.lights.push_back(test::spot_light({-1, 1, 1}, {-1, 0, 0}, 0.3, 1.0f));
    AntiradianceOptions options = test::options_of(test::usual_build(), 64, 1500);
    options.poses = room.poses(3);
    options.steps = 6;
    options.iteration = Iteration::symmetric;
    std::vector<glm::vec4> light[2];
    for (const Storage storage : {Storage::full, Storage::half}) {
        options.build.storage = storage;
        DeviceScene scene = test::on_device(room.scene);
        AntiradianceSolver solver(test::programs(), test::device().queue, room.scene, scene,
                                  options);
        SceneMover mover(test::programs(), test::device().queue, scene);
        room.move(mover, 0.4);
        solver.geometry_changed();
        ASSERT_TRUE(solver.run());
        ASSERT_GT(solver.moving_links(), 1000u);
        light[storage == Storage::half] =
            test::download<glm::vec4>(solver.leaves().irradiances, solver.elements().leaves);
    }
    double apart = 0.0, whole = 0.0;
    for (std::size_t row = 0; row < light[0].size(); ++row)
        for (int c = 0; c < 3; ++c) {
            apart += std::abs(double{light[1][row][c]} - light[0][row][c]);
            whole += std::abs(double{light[0][row][c]});
        }
    EXPECT_GT(whole, 0.0);
    EXPECT_LT(apart, 0x1p-7 * whole);  // as above
}

}  // namespace
}  // namespace clgi
