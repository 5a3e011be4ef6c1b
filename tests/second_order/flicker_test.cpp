// Lights that change from picture to picture: nothing is allocated, nothing waits, and every handle
// that a caller copied stays valid.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <limits>

#include "frames.hpp"
#include "opencl_calls.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

using test::calls;

Scene two_spots() {
    Scene scene = test::patchwork(80, 95, false);
    for (Material& material : scene.materials) material.emission = glm::vec3(0.0f);
    scene.lights = {test::spot_light({0.3, 1.2, 0.4}, {-0.2f, -1, -0.3f}, 0.7, 30.0f),
                    test::spot_light({-0.9, 0.6, 0.8}, {0.8f, -0.5f, -0.7f}, 0.5, 10.0f)};
    scene.lights[0].intensity *= glm::vec3(1.0f, 0.5f, 0.2f);
    scene.lights[1].inner_angle = 0.1f;
    scene.cameras = {test::camera_at({1.5, 1.1, 1.8}, {0, 0, 0})};
    return scene;
}

SecondOrderOptions small() {
    SecondOrderOptions options;
    options.width = 64;
    options.height = 48;
    options.emitters.vpls = 60;
    options.emitters.shadow_size = 128;
    options.emitters.face_size = 64;
    options.negative_vpls = 20;
    return options;
}

std::vector<cl_mem> handles(const SecondOrderSolver& solver) {
    return {solver.radiance()(), solver.irradiance()(),    solver.planes()(),        solver.ids()(),
            solver.vpls()(),     solver.negative_vpls()(), solver.gbuffer().planes()};
}

// Brighter, dimmer, dark, narrower, wider, turned, another colour: each time the bits of a solver
// that has never known anything else.
TEST(Flicker, TakesNoMemoryAndNoTimeAndGivesTheBitsOfAFreshSolver) {
    Scene world = two_spots();
    DeviceScene scene = test::on_device(world);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, small());
    solver.render(world.cameras[0]).wait();
    const std::vector<cl_mem> before = handles(solver);
    const std::size_t bytes = solver.bytes();
    const auto change = [](int step, Light& light) {
        if (step == 0) light.intensity *= 3.0f;
        if (step == 1) light.intensity = glm::vec3(0.0f);
        if (step == 2) light.intensity = {0.5f, 8.0f, 2.0f};
        if (step == 3) light.outer_angle = 0.2f;
        if (step == 4) light.outer_angle = 1.0f, light.inner_angle = 0.9f;
        if (step == 5) light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.1f));
    };
    for (int step = 0; step < 6; ++step) {
        change(step, world.lights[1]);
        scene.set_light(1, world.lights[1]);
        calls.clear();
        solver.lights_changed();
        const cl::Event done = solver.render(world.cameras[0]);
        EXPECT_EQ(calls.buffers, 0) << step;
        EXPECT_EQ(calls.blocking, 0) << step;
        EXPECT_EQ(calls.builds, 0) << step;
        done.wait();
        EXPECT_EQ(handles(solver), before) << step;
        EXPECT_EQ(solver.bytes(), bytes);
        // The exposure of the scene that was loaded stays; a fresh scene has its own.
        DeviceScene same = test::on_device(two_spots());
        same.set_light(1, world.lights[1]);
        SecondOrderSolver fresh(test::programs(), test::device().queue, same, small());
        fresh.render(world.cameras[0]).wait();
        const test::Frame found = test::read_frame(test::device().queue, scene, solver);
        const test::Frame wanted = test::read_frame(test::device().queue, same, fresh);
        EXPECT_TRUE(test::same_bits(found.radiance, wanted.radiance)) << step;
        EXPECT_TRUE(test::same_bits(found.lights, wanted.lights)) << step;
    }
}

// A change is enqueued behind the picture that is still to come, without waiting for it.
TEST(Flicker, ComesAfterThePictureThatIsStillOnItsWay) {
    const Scene world = two_spots();
    DeviceScene scene = test::on_device(world);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, small());
    solver.render(world.cameras[0]).wait();
    const test::Frame first = test::read_frame(test::device().queue, scene, solver);
    cl::UserEvent gate(test::device().context);
    const cl::Event held = solver.render(world.cameras[0], {gate});
    const cl::Buffer copy = test::empty<float>(RADIANCE_PLANES * solver.stride());
    const WaitList after{held};
    test::device().queue.enqueueCopyBuffer(
        solver.radiance(), copy, 0, 0, RADIANCE_PLANES * solver.stride() * sizeof(float), &after);
    Light light = world.lights[0];
    light.intensity *= 0.25f;
    scene.set_light(0, light);
    solver.lights_changed();  // would never return if it waited
    const cl::Event changed = solver.render(world.cameras[0]);
    gate.setStatus(CL_COMPLETE);
    changed.wait();
    const auto held_back = test::vectors(test::device().queue, copy, solver.stride(), first.pixels);
    EXPECT_TRUE(test::same_bits(held_back, first.radiance));
    const test::Frame dimmer = test::read_frame(test::device().queue, scene, solver);
    EXPECT_FALSE(test::same_bits(dimmer.radiance, first.radiance));
}

// What was counted since the solver was made stays counted.
TEST(Flicker, KeepsTheCountOfWhatWasNotFinite) {
    const Scene world = two_spots();
    DeviceScene scene = test::on_device(world);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, small());
    solver.render(world.cameras[0]).wait();
    const GBuffer given = solver.gbuffer();
    std::vector<float> planes = test::download<float>(given.planes, GBUFFER_PLANES * given.stride);
    std::fill_n(planes.begin() + GBUFFER_BASE * given.stride, given.stride,
                std::numeric_limits<float>::quiet_NaN());
    solver
        .render(world.cameras[0],
                GBuffer{test::upload(planes), given.ids, given.stride, given.storage})
        .wait();
    const std::uint32_t counted = solver.status().non_finite;
    EXPECT_GT(counted, 0u);
    solver.lights_changed();
    solver.render(world.cameras[0]).wait();
    EXPECT_EQ(solver.status().non_finite, counted);
}

}  // namespace
}  // namespace clgi
