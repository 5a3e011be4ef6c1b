// Light that a scene reflects to itself once, from the visibility of masks.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "mask_tools.hpp"
#include "math_modes.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const glm::vec3 sky(0.8f, 1.0f, 1.5f);

CLGI_IN_BOTH_MATHS(TransferBounce);

// E = pi L where all that is seen has the radiance L. The triangles around the receiver are seen
// from their back; both sides have light of their own.
TEST_P(TransferBounce, OfASurroundingSurfaceIsItsRadiance) {
    for (const int width : {0, 1, 4}) {
        const BuildOptions how{.math = GetParam(), .packet_width = width};
        for (const bool turned : {false, true}) {
            auto around = test::icosahedron();
            if (turned)
                for (test::Triangle& t : around) std::swap(t[1], t[2]);
            const test::Blockers blockers(around);
            test::Eyes eyes;
            eyes.normals[0] = {0.3f, -0.5f, 0.8f, 0};
            const test::Drawn drawn = test::draw_masks(blockers, eyes, {}, how);
            std::vector<glm::vec4> exitance(40);
            for (std::size_t t = 0; t < 40; ++t)
                exitance[t] = t < 20 ? glm::vec4(1, 2, 3, 0) : glm::vec4(5, 7, 11, 0);
            const std::uint32_t stride = drawn.receivers.stride;
            const cl::Buffer irradiance = test::upload(std::vector<float>(3 * stride, 0.5f));
            const cl::Buffer counted = test::upload(std::vector<cl_uint>{7});
            test::mask_passes({}, how).bounce(test::device().queue, drawn.receivers, drawn.blockers,
                                              test::upload(pixel_heights(32)),
                                              test::upload(exitance), irradiance, counted);
            EXPECT_EQ(test::download<cl_uint>(counted, 1)[0], 7u);
            const auto found = test::download<float>(irradiance, 3 * stride);
            // Corners go counter-clockwise seen from the front.
            const auto& t = around[0];
            const bool front = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), t[0]) < 0;
            EXPECT_EQ(front, turned);
            const double wanted[] = {front ? 1.0 : 5.0, front ? 2.0 : 7.0, front ? 3.0 : 11.0};
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_NEAR(found[c * stride], 0.5 + pi * wanted[c], 1e-5 * wanted[c] * pi);
                EXPECT_EQ(found[c * stride + 1], 0.5f);
            }
        }
    }
}

TEST_P(TransferBounce, IsReflectedByBothSidesOfTriangles) {
    constexpr std::uint32_t stride = 16;
    const std::vector<glm::uvec4> triangles = {{0, 1, 2, 9}, {2, 1, 3, 9}};
    const std::vector<cl_uint> other = {5, 4, 6, RECEIVER_NONE};
    std::vector<float> reflectance(3 * stride), irradiance(3 * stride);
    for (std::size_t i = 0; i < reflectance.size(); ++i) {
        reflectance[i] = 0.1f + 0.015f * static_cast<float>(i);
        irradiance[i] = static_cast<float>((7 * i) % 11);
    }
    const cl::Buffer out = test::upload(std::vector<glm::vec4>(4, glm::vec4(-1)));
    test::mask_passes({}, {.math = GetParam()})
        .exitance(test::device().queue, {2, stride, 0, 0}, test::upload(triangles),
                  test::upload(other), test::upload(reflectance), test::upload(irradiance), out);
    const auto found = test::download<glm::vec4>(out, 4);
    const std::vector<std::vector<std::size_t>> corners = {{0, 1, 2}, {2, 1, 3}, {5, 4, 6}, {}};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            double wanted = 0.0;
            for (const std::size_t v : corners[k])
                wanted += double{reflectance[c * stride + v]} * irradiance[c * stride + v];
            EXPECT_NEAR(found[k][static_cast<int>(c)], wanted / (3 * pi), 1e-6 * (1 + wanted));
        }
}

// Rays of the path tracer from the same vertices, with one bounce: a hall without a roof, finely
// cut, with a ball in it. Colours differ, and the ball stands on nothing.
TEST_P(TransferBounce, AgreesWithThePathTracer) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    Material blue;
    blue.base_color = {0.2f, 0.4f, 0.8f, 1.0f};
    test::add_material(scene, blue);
    const auto sheet = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                           std::uint32_t material) {
        constexpr int cuts = 12;
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (int i = 0; i <= cuts; ++i)
            for (int j = 0; j <= cuts; ++j) {
                scene.positions.push_back(corner + u * (i / double{cuts}) + v * (j / double{cuts}));
                scene.normals.emplace_back(glm::normalize(glm::cross(u, v)));
            }
        for (std::uint32_t i = 0; i < cuts; ++i)
            for (std::uint32_t j = 0; j < cuts; ++j) {
                const std::uint32_t a = first + i * (cuts + 1) + j, b = a + cuts + 1;
                scene.triangles.push_back({{a, b, b + 1}, material});
                scene.triangles.push_back({{a, b + 1, a + 1}, material});
            }
    };
    sheet({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);    // floor
    sheet({-1, 0, -1}, {0, 1.5, 0}, {0, 0, 2}, 1);  // walls
    sheet({1, 0, -1}, {0, 0, 2}, {0, 1.5, 0}, 0);
    sheet({-1, 0, -1}, {2, 0, 0}, {0, 1.5, 0}, 1);
    sheet({-1, 0, 1}, {0, 1.5, 0}, {2, 0, 0}, 0);
    // A vertex in a wall's plane sees the wall edge-on: its outside is what blocks.
    const double out = 1.02;
    for (const double side : {-out, out}) {
        test::add_quad(
            scene,
            {glm::dvec3(side, 0, -out), {side, 0, out}, {side, 1.5, out}, {side, 1.5, -out}});
        test::add_quad(
            scene,
            {glm::dvec3(-out, 0, side), {out, 0, side}, {out, 1.5, side}, {-out, 1.5, side}});
    }
    test::add_sphere(scene, {0.2, 0.7, 0.1}, 0.35, 2, 1);
    test::light_by(scene, sky);
    const DeviceScene device = test::on_device(scene);
    DynamicTransferOptions options;
    options.build.math = GetParam();
    options.interreflections = 1;
    DynamicTransferSolver solver(test::programs(), test::device().queue, scene, device, options);
    ASSERT_TRUE(solver.run());
    const auto found = test::irradiance_of(solver, device);
    std::vector<reference::Place> places;
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::uint32_t v = device.vertex_order()[i];
        const glm::dvec3& p = scene.positions[v];
        // Vertices in the edges of the hall see only one of the sheets that meet there.
        const int edges = (std::abs(p.x) > 0.99) + (std::abs(p.z) > 0.99) + (p.y < 0.01);
        if (edges > 1 || std::abs(p.x) > 1.01 || std::abs(p.z) > 1.01) continue;
        places.push_back({p, scene.normals[v]});
        at.push_back(i);
    }
    reference::Options rays;
    rays.samples = 1024;
    rays.effects = reference::parse_effects("emission,direct,one-bounce");
    const auto truth = reference::PathTracer(scene).irradiance(places, rays);
    rays.effects = reference::parse_effects("emission,direct");
    const auto direct = reference::PathTracer(scene).irradiance(places, rays);
    double apart = 0.0, whole = 0.0;
    glm::dvec3 sum(0.0), wanted(0.0), without(0.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3 w(truth.values[i]), d = found[at[i]] - w;
        apart += glm::dot(d, d);
        whole += glm::dot(w, w);
        sum += found[at[i]];
        wanted += w;
        without += glm::dvec3(direct.values[i]);
    }
    std::printf("bounce: error %.2f %%, noise %.2f %%, energy %.4f %.4f %.4f, share %.3f\n",
                100 * std::sqrt(apart / whole), 100 * truth.relative_error, sum.x / wanted.x,
                sum.y / wanted.y, sum.z / wanted.z, 1 - without.x / wanted.x);
    EXPECT_LT(std::sqrt(apart / whole), 0.06);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum[c] / wanted[c], 1.0, 0.015) << c;
        EXPECT_LT(without[c], 0.9 * wanted[c]) << c;
    }
}

// Light that the bounce makes infinite is counted; what was not finite before has been.
TEST_P(TransferBounce, CountsWhatIsNotFinite) {
    const float infinite = std::numeric_limits<float>::infinity();
    const BuildOptions how{.math = GetParam()};
    test::Eyes eyes;
    eyes.positions.assign(3, eyes.positions[0]);
    eyes.normals.assign(3, eyes.normals[0]);
    const test::Drawn drawn = test::draw_masks(test::Blockers(test::icosahedron()), eyes, {}, how);
    const std::uint32_t stride = drawn.receivers.stride;
    for (const float light : {1.0f, infinite, -infinite, std::nanf("")}) {
        std::vector<float> before(3 * stride, 0.5f);
        before[stride + 1] = infinite;
        const cl::Buffer irradiance = test::upload(before);
        const cl::Buffer counted = test::upload(std::vector<cl_uint>{7});
        test::mask_passes({}, how).bounce(
            test::device().queue, drawn.receivers, drawn.blockers, test::upload(pixel_heights(32)),
            test::upload(std::vector<glm::vec4>(40, glm::vec4(1, 1, light, 0))), irradiance,
            counted);
        EXPECT_EQ(test::download<cl_uint>(counted, 1)[0], light == 1.0f ? 7u : 9u) << light;
        EXPECT_EQ(std::isfinite(test::download<float>(irradiance, 3 * stride)[2 * stride]),
                  light == 1.0f);
    }
}

TEST_P(TransferBounce, RefusesWhatDoesNotFit) {
    const test::Drawn drawn = test::draw_masks(test::Blockers(test::icosahedron()));
    const MaskPasses& passes = test::mask_passes({}, {.math = GetParam()});
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer heights = test::upload(pixel_heights(32)), one = test::empty<float>(1);
    const cl::Buffer some = test::upload(std::vector<float>(2000, 0.0f));
    EXPECT_NO_THROW(
        passes.bounce(queue, drawn.receivers, drawn.blockers, heights, some, some, some));
    EXPECT_THROW(passes.bounce(queue, drawn.receivers, drawn.blockers, one, some, some, some),
                 Error);
    EXPECT_THROW(passes.bounce(queue, drawn.receivers, drawn.blockers, heights, one, some, some),
                 Error);
    EXPECT_THROW(passes.bounce(queue, drawn.receivers, drawn.blockers, heights, some, one, some),
                 Error);
    const cl::Buffer none(test::device().context, CL_MEM_READ_WRITE, 2);
    EXPECT_THROW(passes.bounce(queue, drawn.receivers, drawn.blockers, heights, some, some, none),
                 Error);
    EXPECT_THROW(passes.exitance(queue, {20, 16, 0, 0}, one, some, some, some, some), Error);
    EXPECT_THROW(passes.exitance(queue, {20, 16, 0, 0}, some, some, one, some, some), Error);
    EXPECT_THROW(passes.exitance(queue, {20, 16, 0, 0}, some, some, some, some, one), Error);
}

}  // namespace
}  // namespace clgi
