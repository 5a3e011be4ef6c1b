// What must not change a picture: where the scene is, how large, how bright, and how it is
// computed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "drawing.hpp"
#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Frame;

SecondOrderOptions small_frame(const test::Build& build = test::usual_build()) {
    SecondOrderOptions options;
    options.build = build;
    options.width = 47;
    options.height = 35;
    options.emitters.vpls = 100;
    options.emitters.shadow_size = 128;
    options.emitters.face_size = 64;
    options.negative_vpls = 50;
    return options;
}

// Every corner on a multiple of 2^-4, so that the scene can be moved far away without rounding.
Scene table(Light::Kind kind) {
    Scene scene = test::plain_scene();
    scene.materials[0].roughness = 0.5f;  // with a lobe
    scene.materials[0].specular = 1.0f;
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    test::add_box(scene, {-0.5, -0.5, -0.5}, {0.5, -0.375, 0.25}, 1);
    test::add_box(scene, {-0.25, 0.125, -0.5}, {0.5, 0.375, -0.0625}, 1);
    const glm::dvec3 lamp(0.25, 0.875, 0.5);
    if (kind == Light::Kind::spot) {
        scene.lights = {test::spot_light(lamp, {-0.25f, -1, -0.5f}, 0.6)};
    } else if (kind == Light::Kind::point) {
        scene.lights = {test::point_light(lamp)};
    } else {
        scene.triangles.erase(scene.triangles.begin() + 6,
                              scene.triangles.begin() + 8);  // the ceiling
        scene.lights = {test::directional_light({0.25f, -1, -0.5f})};
    }
    scene.cameras = {test::camera_at({0, 0.125, 0.9375}, {0, -0.3, -1}, 1.1f)};
    return scene;
}

constexpr Light::Kind kinds[] = {Light::Kind::spot, Light::Kind::point, Light::Kind::directional};

Frame render(const Scene& scene, const SecondOrderOptions& options = small_frame()) {
    return test::render(scene, scene.cameras[0], options);
}

// The frame that the others are held against, rendered once.
const Frame& usual_frame(Light::Kind kind, const test::Build& build = test::usual_build()) {
    static std::map<std::tuple<Light::Kind, Math, Storage>, Frame> known;
    const auto [at, added] = known.try_emplace({kind, build.math, build.storage});
    if (added) at->second = render(table(kind), small_frame(build));
    return at->second;
}

CLGI_IN_ALL_MODES(Picture);

// In fast math and half storage one kind of light shows what holds.
std::vector<Light::Kind> shown_kinds() {
    if (test::usual_build() != BuildOptions{}) return {Light::Kind::spot};
    return {std::begin(kinds), std::end(kinds)};
}

// The same numbers reach the device, so fast math and half storage find the same bits too.
TEST_P(Picture, IsTheSameAtEveryPowerOfTwoInSize) {
    const SecondOrderOptions options = small_frame();
    for (const Light::Kind kind : shown_kinds()) {
        const Scene scene = table(kind);
        const Frame& usual = usual_frame(kind);
        ASSERT_GT(usual.radiance[usual.pixels / 2].x, 0.0f);
        for (const int k : {-13, -1, 20}) {
            Scene scaled = scene;
            const double size = std::ldexp(1.0, k);
            for (glm::dvec3& position : scaled.positions) position *= size;
            scaled.cameras[0].position *= size;
            scaled.lights[0].position *= size;
            // Candela over metres squared: four times the light at twice the distance.
            if (kind != Light::Kind::directional)
                scaled.lights[0].intensity *= static_cast<float>(size * size);
            EXPECT_TRUE(test::same_bits(render(scaled, options).radiance, usual.radiance)) << k;
        }
    }
}

TEST_P(Picture, IsTheSameFarFromTheOrigin) {
    for (const Light::Kind kind : shown_kinds()) {
        const Scene scene = table(kind);
        const Frame& usual = usual_frame(kind);
        for (const glm::dvec3& offset :
             {glm::dvec3(1e5, 0, 0), glm::dvec3(1e6, -1e6, 1e5), glm::dvec3(0.0625, -1e6, 3)}) {
            Scene moved = scene;
            for (glm::dvec3& position : moved.positions) position += offset;
            moved.cameras[0].position += offset;
            moved.lights[0].position += offset;
            EXPECT_TRUE(test::same_bits(render(moved).radiance, usual.radiance)) << offset.x;
        }
    }
}

TEST_P(Picture, IsProportionalToItsLight) {
    const SecondOrderOptions options = small_frame();
    for (const Light::Kind kind : shown_kinds()) {
        const Scene scene = table(kind);
        const Frame& usual = usual_frame(kind);
        for (const int k : {-66, 1, 66}) {
            Scene brighter = scene;
            brighter.lights[0].intensity *= std::ldexp(1.0f, k);
            Frame frame = render(brighter, options);
            for (glm::vec3& radiance : frame.radiance) radiance *= std::ldexp(1.0f, -k);
            EXPECT_TRUE(test::same_bits(frame.radiance, usual.radiance)) << k;
        }
    }
}

// The exposure follows the brightest light: beside 1e20 cd one of 1e-20 is nothing, and does no
// harm.
TEST_P(Picture, StaysFiniteWithLightsOfAllPowers) {
    Scene scene = table(Light::Kind::point);
    scene.lights[0].intensity = glm::vec3(1e20f);
    scene.lights.push_back(test::point_light({-0.25, 0.5, 0.5}, 1e-20f));
    const Frame frame = render(scene, small_frame());
    EXPECT_EQ(frame.status.non_finite, 0u);
    for (const glm::vec3& radiance : frame.radiance)
        EXPECT_TRUE(std::isfinite(radiance.x) && radiance.x >= 0.0f);
}

TEST_P(Picture, OfTwoLightsIsTheSumOfTwoPictures) {
    Scene both = table(Light::Kind::point);
    both.lights.push_back(test::point_light({-0.5, 0.75, 0.25}));
    SecondOrderOptions options = small_frame();
    options.low_resolution_step = 1;
    options.negative_vpls = 0;  // their directions depend on all lights together
    options.emitters.vpls = 200;
    const Frame sum = render(both, options);
    options.emitters.vpls = 100;
    Scene first = both, second = both;
    first.lights.pop_back();
    second.lights.erase(second.lights.begin());
    const Frame a = render(first, options), b = render(second, options);
    // A hundred additions in another order; halves are rounded in three pictures.
    const double off = 1e-5 + 2 * test::half_error();
    for (std::size_t p = 0; p < sum.pixels; ++p)
        EXPECT_NEAR(sum.radiance[p].x, a.radiance[p].x + b.radiance[p].x, off * sum.radiance[p].x);
}

TEST_P(Picture, IsTheSameEveryTime) {
    SecondOrderOptions options = small_frame();
    options.width = 23;
    options.height = 17;
    options.emitters.face_size = 32;
    for (const Light::Kind kind : shown_kinds()) {
        if (kind == Light::Kind::directional) continue;
        const Scene scene = table(kind);
        const DeviceScene placed = test::on_device(scene);
        SecondOrderSolver solver(test::programs(), test::device().queue, placed, options);
        const auto frame = [&] {
            solver.render(scene.cameras[0]).wait();
            return test::read_frame(test::device().queue, placed, solver);
        };
        const Frame first = frame();
        for (int run = 0; run < 100; ++run) {
            const Frame again = frame();
            ASSERT_TRUE(test::same_bits(again.radiance, first.radiance)) << run;
            ASSERT_TRUE(test::same_bits(again.lights, first.lights)) << run;
            ASSERT_TRUE(test::same_bits(again.negative, first.negative)) << run;
        }
    }
}

TEST_P(Picture, IsTheSameOnAQueueOutOfOrder) {
    const test::Device& on = test::device();
    if (!(on.device.getInfo<CL_DEVICE_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE))
        GTEST_SKIP() << "the device has no such queue";
    const cl::CommandQueue queue(on.context, on.device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    for (const Light::Kind kind : shown_kinds()) {
        const Scene scene = table(kind);
        EXPECT_TRUE(
            test::same_bits(test::render(scene, scene.cameras[0], small_frame(), queue).radiance,
                            usual_frame(kind).radiance));
    }
}

TEST(Picture, IsTheSameForEveryWorkGroupAndPacket) {
    const Scene scene = table(Light::Kind::spot);
    const Frame& usual = usual_frame(Light::Kind::spot);
    for (const BuildOptions& build :
         {BuildOptions{.packet_width = 1, .local_size = 7, .atomics64 = false},
          {.packet_width = 4, .local_size = 1},
          {.local_size = 256}}) {
        SecondOrderOptions options = small_frame();
        options.build = build;
        const Frame other = render(scene, options);
        EXPECT_TRUE(test::same_bits(other.radiance, usual.radiance))
            << "width " << build.packet_width << ", group " << build.local_size;
        EXPECT_TRUE(test::same_bits(other.lights, usual.lights));
    }
}

// Fast math may round otherwise and may decide otherwise about single pixels, no more.
TEST(Picture, IsNearlyTheSameWithFastMath) {
    for (const Light::Kind kind : kinds) {
        const Frame& strict = usual_frame(kind);
        const Frame& fast = usual_frame(kind, Math::fast);
        double difference = 0.0, sum = 0.0;
        for (std::size_t p = 0; p < strict.pixels; ++p) {
            ASSERT_TRUE(std::isfinite(fast.radiance[p].x) && fast.radiance[p].x >= 0.0f);
            difference += std::abs(fast.radiance[p].x - strict.radiance[p].x);
            sum += strict.radiance[p].x;
        }
        EXPECT_LT(difference, 0.002 * sum);
    }
}

}  // namespace
}  // namespace clgi
