// Frames whose camera view was drawn elsewhere.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "frames.hpp"
#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

SecondOrderOptions small() {
    SecondOrderOptions options;
    options.width = 65;
    options.height = 47;
    return options;
}

cl::Buffer copy_of(const cl::Buffer& buffer) {
    const std::size_t bytes = buffer.getInfo<CL_MEM_SIZE>();
    cl::Buffer out(test::device().context, CL_MEM_READ_WRITE, bytes);
    test::device().queue.enqueueCopyBuffer(buffer, out, 0, 0, bytes);
    return out;
}

GBuffer copy_of(const SecondOrderSolver& solver) {
    GBuffer out{copy_of(solver.planes()), copy_of(solver.ids()), solver.stride()};
    test::device().queue.finish();
    return out;
}

// What the solver drew itself, given back to it: the same picture, and one pass less than drawn.
TEST(GivenGBuffer, IsLitLikeTheSolversOwn) {
    for (const Scene& scene : {box(), cornell()}) {
        const DeviceScene placed = test::on_device(scene);
        SecondOrderSolver solver(test::programs(), test::device().queue, placed, small());
        solver.render(scene.cameras[0]).wait();
        const test::Frame own = test::read_frame(test::device().queue, placed, solver);
        const GBuffer given = copy_of(solver);

        SecondOrderSolver other(test::programs(), test::device().queue, placed, small());
        other.render(scene.cameras[0], given).wait();
        const test::Frame lit = test::read_frame(test::device().queue, placed, other);
        EXPECT_TRUE(test::same_bits(own.radiance, lit.radiance));
        EXPECT_TRUE(test::same_bits(own.negative, lit.negative));
        EXPECT_EQ(other.planes()(), given.planes());
        EXPECT_LT(lit.launches, own.launches);
        for (const PassEvent& pass : other.events()) EXPECT_NE(pass.name, "gbuffer.resolve");

        // And back to its own view.
        other.render(scene.cameras[0]).wait();
        EXPECT_TRUE(test::same_bits(
            own.radiance, test::read_frame(test::device().queue, placed, other).radiance));
        EXPECT_EQ(other.planes()(), other.gbuffer().planes());
    }
}

// What is given counts, not what the scene would show.
TEST(GivenGBuffer, IsSeenInsteadOfTheScene) {
    const Scene scene = box();
    const DeviceScene placed = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, placed, small());
    solver.render(scene.cameras[0]).wait();
    const auto before = test::read_frame(test::device().queue, placed, solver).radiance;
    const cl::CommandQueue& queue = test::device().queue;
    const std::size_t plane = solver.stride() * sizeof(float);
    // Albedo is halved and emission added, in the solver's own buffers.
    auto planes = test::download<float>(solver.planes(), GBUFFER_PLANES * solver.stride());
    for (std::size_t i = 0; i < 3 * solver.stride(); ++i) {
        planes[GBUFFER_BASE * solver.stride() + i] *= 0.5f;
        planes[GBUFFER_EMISSION * solver.stride() + i] = 0.25f;
    }
    queue.enqueueWriteBuffer(solver.gbuffer().planes, CL_TRUE, 0, GBUFFER_PLANES * plane,
                             planes.data());
    solver.render(scene.cameras[0], solver.gbuffer()).wait();
    const auto after = test::read_frame(queue, placed, solver).radiance;
    const auto glow = static_cast<float>(0.25 * placed.frame().exposure);
    for (std::size_t p = 0; p < before.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const float wanted = 0.5f * before[p][c] + glow;
            ASSERT_NEAR(after[p][c], wanted, 2e-6f * wanted) << p;
        }
}

// A wall that is in no scene, half a metre before the lamp, red and shining green. An empty scene
// has no sources, whatever its lamps; a dark one has none either.
TEST(GivenGBuffer, IsLitByTheSourcesOfTheSceneAlone) {
    Scene lit = test::plain_scene();
    test::add_floor(lit, 1.0, -1.0);
    lit.lights = {test::point_light({0, 0, 0}, 10.0f)};
    Scene dark = lit;
    dark.lights.clear();
    Scene empty;
    empty.lights = lit.lights;
    for (const Scene& scene : {lit, dark, empty}) {
        const DeviceScene placed = test::on_device(scene);
        const SceneFrame& frame = placed.frame();
        SecondOrderOptions options = small();
        options.indirect = false;
        SecondOrderSolver solver(test::programs(), test::device().queue, placed, options);
        const std::uint32_t stride = solver.stride();
        const std::size_t pixels = 65 * 47;
        std::vector<float> planes(GBUFFER_PLANES * stride);
        const glm::vec3 position = frame.to_local({0, 0, -0.5});
        for (std::size_t p = 0; p < pixels; ++p) {
            for (std::size_t c = 0; c < 3; ++c)
                planes[c * stride + p] = position[static_cast<int>(c)];
            planes[(GBUFFER_NORMAL + 2) * stride + p] = 1.0f;
            planes[(GBUFFER_GEOMETRIC + 2) * stride + p] = 1.0f;
            planes[GBUFFER_BASE * stride + p] = 1.0f;
            planes[(GBUFFER_EMISSION + 1) * stride + p] = 1.0f;
        }
        const GBuffer given{test::upload(planes),
                            test::upload(std::vector<cl_int>(GBUFFER_ID_PLANES * stride, -1)),
                            stride};
        Camera camera;
        camera.position = {0, 0, 2};
        solver.render(camera, given).wait();
        const auto radiance =
            test::vectors(test::device().queue, solver.radiance(), stride, pixels);
        // Candela over metres squared over pi.
        const bool shines = !scene.lights.empty() && !scene.triangles.empty();
        const double direct = shines ? 10.0 / 0.25 / 3.14159265358979 : 0.0;
        for (std::size_t p = 0; p < pixels; ++p) {
            ASSERT_NEAR(radiance[p].x, direct, 2e-6 * direct);
            ASSERT_FLOAT_EQ(radiance[p].y, static_cast<float>(frame.exposure));
            ASSERT_EQ(radiance[p].z, 0.0f);
        }
        EXPECT_EQ(solver.status().non_finite, 0u);
    }
}

// Normals say where something is. On the left a wall that shines green, on the right the sky.
TEST(GivenGBuffer, HidesTheEnvironmentWithoutIds) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0, -1.0);
    scene.environment = test::even_sky({1, 2, 3});
    const DeviceScene placed = test::on_device(scene);
    SecondOrderOptions options = small();
    options.indirect = false;
    options.emitters.environment_lights = 0;
    SecondOrderSolver solver(test::programs(), test::device().queue, placed, options);
    const std::uint32_t stride = solver.stride();
    const std::size_t pixels = 65 * 47;
    const auto is_wall = [](std::size_t p) { return p % 65 < 31; };
    std::vector<float> planes(GBUFFER_PLANES * stride);
    for (std::size_t p = 0; p < pixels; ++p) {
        if (!is_wall(p)) continue;
        planes[(GBUFFER_NORMAL + 2) * stride + p] = 1.0f;
        planes[(GBUFFER_GEOMETRIC + 2) * stride + p] = 1.0f;
        planes[(GBUFFER_EMISSION + 1) * stride + p] = 1.0f;
    }
    const GBuffer given{test::upload(planes),
                        test::upload(std::vector<cl_int>(GBUFFER_ID_PLANES * stride, -1)), stride};
    solver.render(test::camera_at({0, 0, 2}, {0, 0, 0}), given).wait();
    const auto radiance = test::vectors(test::device().queue, solver.radiance(), stride, pixels);
    const glm::vec3 green(0.0f, static_cast<float>(placed.frame().exposure), 0.0f);
    for (std::size_t p = 0; p < pixels; ++p)
        ASSERT_EQ(radiance[p], is_wall(p) ? green : glm::vec3(1, 2, 3)) << p;
}

TEST(GivenGBuffer, WaitsForItsEvents) {
    const Scene scene = box();
    const DeviceScene placed = test::on_device(scene);
    for (const cl_command_queue_properties order :
         {cl_command_queue_properties{0},
          cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE}}) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        SecondOrderSolver solver(test::programs(), queue, placed, small());
        solver.render(scene.cameras[0]).wait();
        const GBuffer given = copy_of(solver);
        cl::UserEvent gate(test::device().context);
        const cl::Event event = solver.render(scene.cameras[0], given, {gate});
        queue.flush();
        // Work on buffers of its own shows that the device had the time to begin.
        const cl::Buffer other = test::empty<float>(1 << 20);
        test::device().queue.enqueueFillBuffer(other, 1.0f, 0, sizeof(float) << 20);
        test::device().queue.finish();
        ASSERT_FALSE(solver.events().empty());
        EXPECT_GE(solver.events().front().event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(),
                  CL_SUBMITTED)
            << solver.events().front().name;
        EXPECT_GE(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_SUBMITTED);
        gate.setStatus(CL_COMPLETE);
        event.wait();
        EXPECT_EQ(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE);
    }
}

TEST(GivenGBuffer, MustFit) {
    const Scene scene = box();
    const DeviceScene placed = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, placed, small());
    const GBuffer whole = solver.gbuffer();
    const auto refused = [&](const GBuffer& given, const std::string& because) {
        try {
            solver.render(scene.cameras[0], given);
            ADD_FAILURE() << "accepted, though " << because;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
        }
    };
    const std::uint32_t stride = solver.stride();
    refused({whole.planes, whole.ids, stride + 16}, "stride is " + std::to_string(stride + 16));
    refused({test::empty<char>(64 * stride - 1), whole.ids, stride}, "planes hold");
    refused({whole.planes, test::empty<char>(8 * stride - 1), stride}, "ids hold");
    refused({cl::Buffer(), whole.ids, stride}, "planes hold 0 bytes");
}

}  // namespace
}  // namespace clgi
