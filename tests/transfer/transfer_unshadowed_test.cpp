// Dynamic transfer without shadows: the light of vertices and pixels where nothing blocks an
// environment, against closed forms and against masks of which none is blocked.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/dynamic_transfer_view.hpp>
#include <clgi/error.hpp>
#include <numbers>
#include <set>

#include "frames.hpp"
#include "math_modes.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const glm::vec3 colour(0.9f, 2.0f, 3.5f);

CLGI_IN_BOTH_MATHS(Unshadowed);

DynamicTransferOptions options_of(Math math, bool shadowed) {
    DynamicTransferOptions out;
    out.occlusion = shadowed ? Occlusion::automatic : Occlusion::none;
    out.build.math = math;
    return out;
}

struct Solved {
    Solved(const Scene& file, const DynamicTransferOptions& options)
        : device(test::on_device(file)),
          solver(test::programs(), test::device().queue, file, device, options) {
        EXPECT_TRUE(solver.run());
        irradiance = test::irradiance_of(solver, device);
    }
    DeviceScene device;
    DynamicTransferSolver solver;
    std::vector<glm::dvec3> irradiance;
};

// Under L = 1 + s . a a plate that covers everything above a tilted sheet takes its light away; if
// nothing blocks, E(n) = pi + (2 pi / 3) n . a on all sides of both (STABILITY 1.5).
TEST_P(Unshadowed, LightsWhatLiesUnderAPlate) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 1, -0.2));
    const glm::dvec3 u = glm::normalize(glm::cross(n, glm::dvec3(0, 0, 1))), v = glm::cross(n, u);
    test::add_quad(scene, {-u - v, u - v, u + v, v - u});
    test::add_quad(scene, {-9.0 * u - 9.0 * v + 0.2 * n, 9.0 * u - 9.0 * v + 0.2 * n,
                           9.0 * u + 9.0 * v + 0.2 * n, 9.0 * v - 9.0 * u + 0.2 * n});
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
    test::light_by_gradient(scene, colour, axis);
    const Solved open(scene, options_of(GetParam(), false));
    const Solved shadowed(scene, options_of(GetParam(), true));
    ASSERT_EQ(open.irradiance.size(), 16u);
    int covered = 0;
    for (std::uint32_t i = 0; i < 16; ++i) {
        const std::uint32_t vertex = i < 8 ? i : i - 8;
        const std::uint32_t of_file = open.device.vertex_order()[vertex];
        const glm::dvec3 facing =
            (i < 8 ? 1.0 : -1.0) * glm::normalize(glm::dvec3(scene.normals[of_file]));
        const double wanted = pi + 2 * pi / 3 * glm::dot(facing, axis);
        for (int c = 0; c < 3; ++c)  // the picture has 128 texels a turn: a thousandth
            EXPECT_NEAR(open.irradiance[i][c] / (colour[c] * wanted), 1.0, 1e-3) << i;
        covered += shadowed.irradiance[i].y < 0.2 * open.irradiance[i].y;
    }
    EXPECT_GE(covered, 4);
    const TransferStatus status = open.solver.status();
    EXPECT_EQ(status.bad_receivers + status.bad_blockers + status.bad_texels + status.non_finite,
              0u);
}

// Solids that see nothing of the scene: what masks find, up to rounding, and of lobes every bit.
TEST_P(Unshadowed, IsWhatMasksFindWhereNothingBlocks) {
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.3f});
    scene.materials[0].roughness = 0.4f;
    scene.materials[0].specular = 1.0f;
    test::add_sphere(scene, {3, -2, 5}, 0.7, 2);
    test::light_by_gradient(scene, colour, glm::normalize(glm::dvec3(-0.4, 0.2, 0.9)));
    for (const sh::Window window : {sh::Window::none, sh::Window::lanczos}) {
        DynamicTransferOptions options = options_of(GetParam(), true);
        options.window = window;
        Solved with(scene, options);
        options.occlusion = Occlusion::none;
        Solved without(scene, options);
        ASSERT_EQ(with.irradiance.size(), without.irradiance.size());
        for (std::size_t i = 0; i < with.irradiance.size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(without.irradiance[i][c] / with.irradiance[i][c], 1.0, 2e-5) << i;
        ASSERT_TRUE(without.solver.glossy());
        const glm::vec3 eye(0.5f, -0.8f, 0.3f);
        with.solver.reflect(eye).wait();
        without.solver.reflect(eye).wait();
        const std::uint32_t stride = with.solver.receivers().stride;
        std::vector<float> gloss[2];
        for (const Solved* solved : {&with, &without})
            gloss[solved == &without] =
                test::download<float>(solved->solver.gloss(), 3 * std::size_t{stride});
        float most = 0.0f;
        for (int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < with.irradiance.size(); ++i) {
                EXPECT_EQ(gloss[0][c * std::size_t{stride} + i],
                          gloss[1][c * std::size_t{stride} + i]);
                most = std::max(most, gloss[0][c * std::size_t{stride} + i]);
            }
        EXPECT_GT(most, 0.0f);
    }
}

struct OpenView {
    std::vector<glm::vec3> radiance;
    std::vector<glm::dvec3> irradiance, normals;  // lux; (0, 0, 0) where no surface is
    std::set<std::string> passes;
    std::uint32_t receivers = 0;
};

OpenView picture_of(const Scene& scene, const DynamicTransferOptions& options, float threshold) {
    const DeviceScene device = test::on_device(scene);
    const cl::CommandQueue& queue = test::device().queue;
    DynamicTransferSolver solver(test::programs(), queue, scene, device, options);
    DynamicTransferViewOptions shown;
    shown.picture.width = 75;
    shown.picture.height = 50;
    shown.picture.build = options.build;
    shown.threshold = threshold;
    DynamicTransferView view(test::programs(), queue, device, solver, shown);
    EXPECT_TRUE(solver.run());
    view.render(scene.cameras.at(0)).wait();
    const std::size_t pixels = 75 * 50, stride = view.picture().stride();
    OpenView out;
    out.radiance = test::vectors(queue, view.picture().radiance(), stride, pixels);
    out.receivers = view.receiver_pixels();
    for (const PassEvent& pass : view.picture().events()) out.passes.insert(pass.name);
    EXPECT_EQ(view.picture().non_finite(), 0u);
    if (options.build.storage == Storage::half) return out;
    for (const glm::vec3& e : test::vectors(queue, view.picture().irradiance(), stride, pixels))
        out.irradiance.push_back(device.frame().exposure * glm::dvec3(e));
    const auto planes =
        test::download<float>(view.picture().gbuffer().planes, (GBUFFER_NORMAL + 3) * stride);
    for (std::size_t i = 0; i < pixels; ++i)
        out.normals.emplace_back(planes[GBUFFER_NORMAL * stride + i],
                                 planes[(GBUFFER_NORMAL + 1) * stride + i],
                                 planes[(GBUFFER_NORMAL + 2) * stride + i]);
    return out;
}

// A coarse sphere, a dish that is seen from both sides and a plate over both.
Scene covered_solids(float roughness) {
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.3f});
    scene.materials[0].roughness = roughness;
    scene.materials[0].double_sided = true;
    test::add_sphere(scene, {-0.4, 0, 0}, 0.6, 0);
    test::add_triangle(scene, {0.3, -0.5, 0.4}, {1.3, -0.3, 0.1}, {0.9, 0.6, -0.2});
    scene.normals[scene.normals.size() - 1] = glm::normalize(glm::vec3(-0.5f, 0.2f, 1.0f));
    test::add_floor(scene, 3.0, 0.9);
    scene.cameras = {test::camera_at({0.3, 0.2, 3.0}, {0.1, 0.1, 0}, 0.75f)};
    return scene;
}

// Each pixel has the light of its own normal, however coarse the mesh.
TEST_P(Unshadowed, LightsEachPixelByItsOwnNormal) {
    Scene scene = covered_solids(1.0f);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, -0.8, 0.5));
    test::light_by_gradient(scene, colour, axis);
    DynamicTransferOptions options = options_of(GetParam(), false);
    options.gloss = false;
    const OpenView full = picture_of(scene, options, 0.1f);
    int surfaces = 0;
    for (std::size_t i = 0; i < full.normals.size(); ++i) {
        const bool surface = full.normals[i] != glm::dvec3(0.0);
        surfaces += surface;
        for (int c = 0; c < 3; ++c) {
            const double wanted =
                surface ? colour[c] * (pi + 2 * pi / 3 * glm::dot(full.normals[i], axis)) : 0.0;
            EXPECT_NEAR(full.irradiance[i][c], wanted, 1e-3 * colour[c] * pi) << i;
        }
    }
    EXPECT_GT(surfaces, 1000);
    EXPECT_EQ(full.receivers, 0u);
    for (const char* pass : {"transfer.mask", "transfer.integrate", "transfer.shade",
                             "transfer.show", "transfer.pixels", "parallel.list"})
        EXPECT_EQ(full.passes.count(pass), 0u) << pass;
    EXPECT_EQ(full.passes.count("transfer.open"), 1u);

    options.build.storage = Storage::half;
    const OpenView half = picture_of(scene, options, 0.1f);
    for (std::size_t i = 0; i < full.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c)  // normals, colours and irradiance have 11 bits
            EXPECT_NEAR(half.radiance[i][c], full.radiance[i][c],
                        3e-3f * (full.radiance[i][c] + 0.1f));
}

// Lobes at every pixel are those that masks find where nothing blocks; between vertices and probes
// they are near them.
TEST_P(Unshadowed, ShowsLobesAsMasksDo) {
    Scene ball = test::plain_scene();
    test::add_sphere(ball, {0, 0, 0}, 0.9, 0);
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.3f});
    scene.materials[0].roughness = 0.5f;
    scene.materials[0].specular = 1.0f;
    // Flat faces, so that nothing lies above the horizon of a pixel.
    for (const SceneTriangle& t : ball.triangles)
        test::add_triangle(scene, ball.positions[t.vertex[0]], ball.positions[t.vertex[1]],
                           ball.positions[t.vertex[2]]);
    scene.cameras = {test::camera_at({0.3, 0.2, 3.0}, {0.1, 0.1, 0}, 0.75f)};
    test::light_by_gradient(scene, colour, glm::normalize(glm::dvec3(0.3, -0.8, 0.5)));
    const OpenView open = picture_of(scene, options_of(GetParam(), false), 0.0f);
    const OpenView masked = picture_of(scene, options_of(GetParam(), true), 0.0f);
    EXPECT_EQ(open.receivers, masked.receivers);
    EXPECT_EQ(open.passes.count("transfer.mask"), 0u);
    EXPECT_EQ(open.passes.count("transfer.integrate_gloss"), 1u);
    const OpenView near = picture_of(scene, options_of(GetParam(), false), 0.1f);
    double sum = 0.0, apart = 0.0, coarse = 0.0;
    for (std::size_t i = 0; i < open.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            sum += double{masked.radiance[i][c]};
            apart += std::abs(double{open.radiance[i][c]} - double{masked.radiance[i][c]});
            coarse += std::abs(double{near.radiance[i][c]} - double{open.radiance[i][c]});
        }
    EXPECT_LT(apart, 2e-5 * sum);
    EXPECT_LT(coarse, 0.05 * sum);
    EXPECT_GT(coarse, 0.0);
}

TEST(UnshadowedSolver, RefusesWhatNeedsMasks) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    const DeviceScene device = test::on_device(scene);
    const auto make = [&](const DynamicTransferOptions& options) {
        return DynamicTransferSolver(test::programs(), test::device().queue, scene, device,
                                     options);
    };
    DynamicTransferOptions options;
    options.occlusion = Occlusion::none;
    options.interreflections = 1;
    EXPECT_THROW(make(options), Error);
    EXPECT_THROW(estimate(test::device().device, scene, device, options), Error);
    options.interreflections = 0;
    DynamicTransferSolver solver(test::programs(), test::device().queue, scene, device, options);
    EXPECT_THROW(solver.look(), Error);
    EXPECT_THROW(solver.sets(), Error);
    EXPECT_THROW(solver.restrict({}), Error);
    EXPECT_EQ(solver.bytes(), estimate(test::device().device, scene, device, options).bytes);
}

}  // namespace
}  // namespace clgi
