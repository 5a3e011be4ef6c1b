// The environment's coefficients are projected once, but never taken for projected when the passes
// did not run.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/environment_light.hpp>
#include <numbers>

#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const glm::vec3 sky_colour(0.9f, 2.0f, 3.5f);

Scene sphere_under_a_sky() {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {3, -2, 5}, 0.7, 1);
    test::light_by_gradient(scene, sky_colour, {0, 0, 0});
    return scene;
}

// A convex solid under one sky_colour has irradiance pi times it.
void expect_lit(const DynamicTransferSolver& solver, const DeviceScene& device) {
    for (const glm::dvec3& e : test::irradiance_of(solver, device))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c] / (pi * sky_colour[c]), 1.0, 1e-3);
}

// What a call waits for may fail long after the call.
TEST(EnvironmentLight, IsProjectedAgainAfterAFailure) {
    const Scene scene = sphere_under_a_sky();
    for (const cl_command_queue_properties order :
         {cl_command_queue_properties{0},
          cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE}}) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        const DeviceScene device = test::on_device(scene);
        DynamicTransferSolver solver(test::programs(), queue, scene, device);
        solver.transfer().wait();
        cl::UserEvent gate(test::device().context);
        const cl::Event done = solver.light({gate});
        gate.setStatus(CL_DEVICE_NOT_AVAILABLE);
        EXPECT_THROW(done.wait(), cl::Error);
        solver.light().wait();
        expect_lit(solver, device);
        EXPECT_EQ(solver.status().bad_texels, 0u);
    }
}

TEST(EnvironmentLight, IsProjectedAgainAfterACancelledRecord) {
    const DeviceScene device = test::on_device(sphere_under_a_sky());
    const TransferPasses passes(test::programs());
    EnvironmentLight light(device, passes.bands());
    Recorder record(test::device().queue, "test");
    BufferTable table("test");
    light.add_to(table);
    table.allocate(record);
    light.write(record);
    record.begin({}, [](double) { return false; });
    record.report(0.0);
    ASSERT_TRUE(record.cancelled());
    light.project(record, passes);
    record.begin({});
    light.project(record, passes);
    EXPECT_EQ(record.events().size(), 3u);
    record.wait();
    const auto found = test::download<float>(light.light(), 4);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] * device.frame().exposure / (sky_colour[c] * std::sqrt(4 * pi)), 1.0,
                    1e-3);
    // Once it has run, only what may have changed is computed again.
    record.begin({});
    light.project(record, passes);
    EXPECT_EQ(record.events().size(), 1u);
    record.wait();
}

}  // namespace
}  // namespace clgi
