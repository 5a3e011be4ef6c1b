// What views of dynamic transfer must get right besides the picture of a heap of solids: small
// pictures, orthographic cameras, other surfaces between probes, gloss between vertices.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <chrono>
#include <clgi/advanced/dynamic_transfer_view.hpp>
#include <functional>
#include <limits>
#include <thread>

#include "frames.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

constexpr float vertices_alone = std::numeric_limits<float>::infinity();

struct Size {
    int width = 96, height = 96;
};

struct ShownView {
    std::vector<glm::vec3> radiance;
    std::vector<int> triangles;   // of the scene, -1: none
    std::uint32_t receivers = 0;  // pixels
    std::uint32_t non_finite = 0;
};

ShownView picture_of(const Scene& scene, const Camera& camera, float threshold, Size size = {},
                     const BuildOptions& build = {}) {
    const DeviceScene device = test::on_device(scene);
    const cl::CommandQueue& queue = test::device().queue;
    DynamicTransferOptions how;
    how.build = build;
    DynamicTransferSolver solver(test::programs(), queue, scene, device, how);
    DynamicTransferViewOptions options;
    options.picture.build = build;
    options.picture.width = size.width;
    options.picture.height = size.height;
    options.threshold = threshold;
    DynamicTransferView view(test::programs(), queue, device, solver, options);
    EXPECT_TRUE(solver.run());
    view.render(camera).wait();
    const auto pixels =
        static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const std::size_t stride = view.picture().stride();
    auto triangles = test::download<int>(view.picture().gbuffer().ids, GBUFFER_ID_PLANES * stride);
    triangles.erase(triangles.begin(), triangles.begin() + GBUFFER_TRIANGLE * int(stride));
    triangles.resize(pixels);
    for (int& t : triangles)
        if (t >= 0) t = static_cast<int>(device.triangle_order()[static_cast<std::size_t>(t)]);
    return {test::vectors(queue, view.picture().radiance(), stride, pixels), triangles,
            view.receiver_pixels(), view.picture().non_finite() + solver.status().non_finite};
}

// Radiance by direction.
void light_by_function(Scene& scene, const std::function<double(const glm::dvec3&)>& radiance) {
    constexpr double pi = 3.14159265358979323846;
    Environment sky;
    sky.width = 64;
    sky.height = 32;
    for (int row = 0; row < sky.height; ++row)
        for (int column = 0; column < sky.width; ++column) {
            const double down = pi * (row + 0.5) / sky.height;
            const double across = 2 * pi * (column + 0.5) / sky.width - pi;
            sky.texels.emplace_back(
                static_cast<float>(radiance({std::sin(down) * std::sin(across), std::cos(down),
                                             -std::sin(down) * std::cos(across)})));
        }
    scene.environment = std::move(sky);
}

// A bright quarter of a dim sky.
double patch(const glm::dvec3& s) { return s.y > 0 && s.x < 0 ? 20.0 : 1.0; }

void metal(Scene& scene, float roughness) {
    scene.materials[0].base_color = glm::vec4(1.0f);
    scene.materials[0].metallic = 1.0f;
    scene.materials[0].roughness = roughness;
}

// n x n squares around the origin that face +z.
void add_grid(Scene& scene, int n, double z = 0.0) {
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1, d = 2.0 / n;
            test::add_quad(scene,
                           {glm::dvec3(x, y, z), {x + d, y, z}, {x + d, y + d, z}, {x, y + d, z}});
        }
}

double relative(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& wanted) {
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(found[i]) - glm::dvec3(wanted[i]);
        apart += glm::dot(d, d);
        whole += glm::dot(glm::dvec3(wanted[i]), glm::dvec3(wanted[i]));
    }
    return std::sqrt(apart / whole);
}

// Half storage rounds normals, irradiance and albedo to 11 bits each.
TEST(DynamicTransferView, IsNearlyTheSameInHalfStorage) {
    Scene scene = test::heap_of_solids(11);
    metal(scene, 0.6f);
    test::light_by(scene, {0.8f, 1.0f, 1.3f});
    const ShownView full = picture_of(scene, scene.cameras[0], 0.1f),
                    half =
                        picture_of(scene, scene.cameras[0], 0.1f, {}, {.storage = Storage::half});
    EXPECT_EQ(half.non_finite, 0u);
    EXPECT_EQ(half.triangles, full.triangles);
    EXPECT_LT(relative(half.radiance, full.radiance), 3.0 / 2048.0);
    EXPECT_GT(relative(half.radiance, full.radiance), 0.0);
}

// They have no probes, so what they show is what vertices receive.
TEST(DynamicTransferView, ThatIsOnePixelWideShowsTheLightOfVertices) {
    Scene scene = test::heap_of_solids(11);
    metal(scene, 0.6f);
    test::light_by(scene, {0.8f, 1.0f, 1.3f});
    for (const Size size : {Size{1, 40}, Size{40, 1}, Size{1, 1}}) {
        const ShownView found = picture_of(scene, scene.cameras[0], 0.1f, size),
                        wanted = picture_of(scene, scene.cameras[0], vertices_alone, size);
        EXPECT_EQ(found.receivers, 0u);
        EXPECT_TRUE(test::same_bits(found.radiance, wanted.radiance));
        EXPECT_GT(glm::length(found.radiance[found.radiance.size() / 2]), 0.0f);
        EXPECT_EQ(picture_of(scene, scene.cameras[0], 0.0f, size).receivers,
                  static_cast<std::uint32_t>(size.width * size.height));
    }
}

// Gloss depends on where it is seen from, and that is a direction.
TEST(DynamicTransferView, OfAnOrthographicCameraDoesNotDependOnItsDistance) {
    Scene scene = test::plain_scene();
    metal(scene, 0.35f);
    add_grid(scene, 8);
    light_by_function(scene, patch);
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.2, 0.3, 1.0));
    for (const float threshold : {0.0f, 0.1f, vertices_alone}) {
        std::vector<glm::vec3> near;
        for (const double distance : {3.0, 30.0}) {
            Camera camera = test::camera_at(distance * towards, {0, 0, 0});
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = 0.8f;
            const ShownView shown = picture_of(scene, camera, threshold);
            if (near.empty()) near = shown.radiance;
            EXPECT_LT(relative(shown.radiance, near), 1e-4) << threshold;
        }
        // As from a point far away.
        const Camera far = test::camera_at(400.0 * towards, {0, 0, 0},
                                           static_cast<float>(2 * std::atan(0.8 / 400)));
        EXPECT_LT(relative(picture_of(scene, far, threshold).radiance, near), 0.01) << threshold;
    }
}

// Thin dark strips before a bright wall: probes see the wall, which misses light between its
// corners. What it misses is not that of the strips.
TEST(DynamicTransferView, MendsNoSurfaceByWhatAnotherMisses) {
    Scene scene = test::plain_scene();
    light_by_function(scene,
                      [](const glm::dvec3& s) { return 1000 * std::pow(1 + s.x, 4) / 16 + 1; });
    const double s = std::sqrt(0.5);
    const auto quad = [&](const glm::dvec3& c, const glm::dvec3& u, const glm::dvec3& v,
                          std::uint32_t material) {
        test::add_quad(scene, {c - u - v, c + u - v, c + u + v, c - u + v}, material);
    };
    Material both = scene.materials[0];
    both.double_sided = true;
    test::add_material(scene, both);
    quad({0, 0, 0}, {1.2 * s, 0, -1.2 * s}, {0, 1.2, 0}, 0);
    for (const double x : {-1.0, 1.0})  // they darken the corners
        for (const double y : {-1.0, 1.0})
            quad({x * 1.2 * s + 0.3, y * 1.2, -x * 1.2 * s + 0.3}, {0.09 * s, 0, -0.09 * s},
                 {0, 0.09, 0}, 1);
    for (int k = 0; k < 9; ++k)
        quad({-0.6 + 0.15 * k, 0, 1.4}, {0.008 * s, 0, 0.008 * s}, {0, 0.5, 0}, 0);
    const Camera camera = test::camera_at({0, 0, 4}, {0, 0, 0});
    const Size size{256, 192};
    const ShownView some = picture_of(scene, camera, 0.1f, size),
                    all = picture_of(scene, camera, 0.0f, size),
                    none = picture_of(scene, camera, vertices_alone, size);
    int strips = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < all.radiance.size(); ++i) {
        if (all.triangles[i] < 10) continue;  // the wall and what stands at its corners
        const double wanted = all.radiance[i].y;
        ++strips;
        worst = std::max(worst, std::abs(some.radiance[i].y / wanted - 1));
    }
    std::printf("strips: %d pixels of %u receivers, worst %.3f\n", strips, some.receivers, worst);
    EXPECT_GT(strips, 200);
    EXPECT_LT(worst, 0.17);  // the threshold's, and that of vertices
    EXPECT_LT(relative(some.radiance, all.radiance), relative(none.radiance, all.radiance) / 2);
}

// One square that shines: four corners do not tell what is reflected between them.
TEST(DynamicTransferView, FindsWhereVerticesAreTooFewForGloss) {
    Scene scene = test::plain_scene();
    metal(scene, 0.5f);
    test::add_quad(scene,
                   {glm::dvec3(-1.5, -1.5, 0), {1.5, -1.5, 0}, {1.5, 1.5, 0}, {-1.5, 1.5, 0}});
    light_by_function(scene, patch);
    const Camera camera = test::camera_at({0, 0, 1.5}, {0, 0, 0}, 1.2f);
    const ShownView none = picture_of(scene, camera, vertices_alone),
                    some = picture_of(scene, camera, 0.1f), all = picture_of(scene, camera, 0.0f);
    const double coarse = relative(none.radiance, all.radiance),
                 fair = relative(some.radiance, all.radiance);
    std::printf("gloss: %u pixels, error %.4f, of vertices alone %.4f\n", some.receivers, fair,
                coarse);
    EXPECT_GT(coarse, 0.3);
    EXPECT_LT(fair, 0.05);
    EXPECT_GT(some.receivers, 500u);
    EXPECT_EQ(some.non_finite, 0u);
    // Without a lobe four corners do.
    scene.materials[0].metallic = 0.0f;
    scene.materials[0].roughness = 1.0f;
    EXPECT_EQ(picture_of(scene, camera, 0.1f).receivers, 0u);
}

// Pixels that show nothing are receivers at the local frame's origin.
TEST(DynamicTransferView, WithACameraAtTheOriginLosesNothing) {
    Scene scene = test::plain_scene();
    metal(scene, 0.4f);
    add_grid(scene, 4, -1.0);
    const std::size_t first = scene.positions.size();
    add_grid(scene, 4, -1.0);
    for (std::size_t v = first; v < scene.positions.size(); ++v) {  // behind the camera
        scene.positions[v] = -scene.positions[v] * glm::dvec3(1, -1, 1);
        scene.normals[v] = -scene.normals[v];
    }
    test::light_by(scene, {1, 1, 1});
    const Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 1.9f);
    for (const float threshold : {0.1f, 0.0f}) {
        const ShownView shown = picture_of(scene, camera, threshold);
        EXPECT_EQ(shown.non_finite, 0u) << threshold;
        EXPECT_GT(shown.radiance[96 * 48 + 48].y, 0.0f);
    }
}

// A picture of a scene without lobes waits for the solver's light as well.
TEST(DynamicTransferView, OnAQueueOutOfOrderWaitsForLight) {
    const test::Device& on = test::device();
    if (!(on.device.getInfo<CL_DEVICE_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE))
        GTEST_SKIP() << "the device has no such queue";
    const cl::CommandQueue queue(on.context, on.device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    Scene scene = test::plain_scene();
    add_grid(scene, 4);
    light_by_function(scene, patch);
    const DeviceScene device = test::on_device(scene);
    DynamicTransferSolver solver(test::programs(), queue, scene, device);
    DynamicTransferViewOptions options;
    options.picture.width = options.picture.height = 32;
    options.threshold = vertices_alone;
    DynamicTransferView view(test::programs(), queue, device, solver, options);
    ASSERT_TRUE(solver.run());
    const Camera camera = test::camera_at({0, 0, 3}, {0, 0, 0});
    view.render(camera).wait();  // everything is built
    cl::UserEvent gate(on.context);
    solver.light({gate});
    const cl::Event done = view.render(camera);
    queue.flush();
    for (int i = 0; i < 20; ++i) {
        ASSERT_NE(done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE) << i;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    gate.setStatus(CL_COMPLETE);
    done.wait();
}

}  // namespace
}  // namespace clgi
