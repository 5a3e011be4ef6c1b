// The surface behind each pixel, against rays and planes in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <functional>

#include "drawing.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Drawing;

// A closed box around a heap of random triangles, seen from its middle.
Scene heap(int count, std::uint64_t seed) {
    test::Random random(seed);
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-1), glm::dvec3(1), -1);
    for (int t = 0; t < count; ++t) {
        glm::dvec3 corner[3];
        const glm::dvec3 at(random(-0.9, 0.9), random(-0.9, 0.9), random(-0.9, 0.9));
        for (glm::dvec3& c : corner)
            c = at + glm::dvec3(random(-0.2, 0.2), random(-0.2, 0.2), random(-0.2, 0.2));
        test::add_triangle(scene, corner[0], corner[1], corner[2]);
        test::add_triangle(scene, corner[0], corner[2], corner[1]);  // its back
    }
    return scene;
}

struct Ray {
    glm::dvec3 origin, direction;  // direction with component 1 along the view's axis
};

Ray pixel_ray(const View& view, std::size_t pixel) {
    const double x = (static_cast<double>(pixel % view.width) + 0.5) * 2.0 / view.width - 1.0;
    const double y = 1.0 - (static_cast<double>(pixel / view.width) + 0.5) * 2.0 / view.height;
    const glm::dvec3 aside =
        glm::dvec3(view.right) * (x * double{view.right.w} + double{view.window.x}) +
        glm::dvec3(view.up) * (y * double{view.up.w} + double{view.window.y});
    const glm::dvec3 eye(view.eye), forward(view.forward);
    return view.eye.w == 0.0f ? Ray{eye, forward + aside} : Ray{eye + aside, forward};
}

// Nearest front face within `slack` of the ray, and the pixel's own triangle, in double.
struct Hit {
    double depth = 1e30;
    int triangle = -1;
};

Hit meet(const Ray& ray, const glm::dvec3 corner[3], double near) {
    const glm::dvec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
    const glm::dvec3 p = glm::cross(ray.direction, v);
    const double determinant = glm::dot(u, p);
    if (determinant <= 0.0) return {};
    const glm::dvec3 away = ray.origin - corner[0], q = glm::cross(away, u);
    const double s = glm::dot(away, p) / determinant, t = glm::dot(ray.direction, q) / determinant;
    const double depth = glm::dot(v, q) / determinant;
    return s < 0 || t < 0 || s + t > 1 || depth < near ? Hit{} : Hit{depth, 0};
}

// Most pixels must show the very triangle that the ray meets first, and its plane exactly there.
void expect_matches_rays(const Scene& scene, const std::function<View(const DeviceScene&)>& look) {
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, look(placed));
    const View& view = drawing.view;
    std::vector<glm::dvec3> corners;
    for (const SceneTriangle& triangle : scene.triangles)
        for (const std::uint32_t vertex : triangle.vertex)
            corners.emplace_back(placed.frame().to_local(scene.positions[vertex]));
    std::size_t other = 0;
    double worst = 0.0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const Ray ray = pixel_ray(view, p);
        Hit first;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            const Hit hit = meet(ray, &corners[3 * t], view.forward.w);
            if (hit.depth < first.depth) first = {hit.depth, static_cast<int>(t)};
        }
        if (drawing.triangle(p) != first.triangle) {
            ++other;
            continue;
        }
        if (first.triangle < 0) continue;
        const glm::dvec3 at = ray.origin + ray.direction * first.depth;
        worst = std::max(worst, glm::length(glm::dvec3(drawing.at(GBUFFER_POSITION, p)) - at));
        worst = std::max(worst, std::abs(drawing.depth(p) - first.depth));
    }
    // Corners are rounded to 1/256 pixel: only pixels that an edge passes that closely may differ.
    EXPECT_LT(static_cast<double>(other), 0.01 * static_cast<double>(drawing.pixels()));
    // A few hundred float spacings of a scene of size 1, where a sliver's barycentrics are worst.
    EXPECT_LT(worst, 3e-5);
}

View looking(const DeviceScene& scene, glm::vec3 right, glm::vec3 up, float extent_x,
             float extent_y, int width, int height) {
    View view{};
    view.right = glm::vec4(right, extent_x);
    view.up = glm::vec4(up, extent_y);
    view.forward = glm::vec4(glm::cross(up, right), 0.02f * scene.frame().radius);
    view.width = static_cast<std::uint32_t>(width);
    view.height = static_cast<std::uint32_t>(height);
    view.flags = VIEW_CULL_BACK_FACES;
    return view;
}

TEST(GBuffer, ShowsWhatPerspectiveRaysMeet) {
    expect_matches_rays(heap(60, 1), [](const DeviceScene& scene) {
        return make_view(test::camera_at({0.1, 0.2, 0.9}, {-0.3, -0.2, -0.6}, 1.1f), scene.frame(),
                         121, 77);
    });
}

TEST(GBuffer, ShowsWhatOrthographicRaysMeet) {
    expect_matches_rays(heap(60, 2), [](const DeviceScene& scene) {
        Camera camera = test::camera_at({0.4, 0.5, 0.9}, {-0.3, -0.2, -0.6});
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = 0.7f;
        return make_view(camera, scene.frame(), 97, 64);
    });
}

TEST(GBuffer, ShowsWhatEveryCubeFaceMeets) {
    const Scene scene = heap(50, 3);
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int face = 0; face < 6; ++face) {
        const glm::vec3 up = axes[(face / 2 + 1) % 3];
        const glm::vec3 right = axes[(face / 2 + 2) % 3] * (face % 2 == 0 ? 1.0f : -1.0f);
        expect_matches_rays(scene, [&](const DeviceScene& placed) {
            return looking(placed, right, up, 1, 1, 48, 48);
        });
    }
}

TEST(GBuffer, ShowsWhatAHemicubesHalfFaceMeets) {
    expect_matches_rays(heap(50, 4), [](const DeviceScene& scene) {
        View view = looking(scene, {0, 0, 1}, {0, 1, 0}, 1, 0.5f, 64, 32);
        view.window.y = 0.5f;
        return view;
    });
}

CLGI_IN_ALL_MODES(GBufferOfAFloor);

// A floor that runs from behind the eye to the horizon and far beyond the image's sides.
TEST_P(GBufferOfAFloor, CutsTrianglesAtTheEyeAndFarOutside) {
    for (const double half : {10.0, 1e3, 1e6}) {
        Scene scene = test::plain_scene();
        test::add_floor(scene, half);
        const Camera camera = test::camera_at({0.1, 1.0, 0.2}, {0.1, 0.6, -1.0}, 1.0f);
        const Drawing drawing = test::draw(scene, camera, 90, 60);
        const DeviceScene placed = test::on_device(scene);
        const double height = placed.frame().scale;  // of the eye, in local units
        for (std::size_t p = 0; p < drawing.pixels(); ++p) {
            const Ray ray = pixel_ray(drawing.view, p);
            const double depth = -height / ray.direction.y;
            const double reach =
                depth * std::max(std::abs(ray.direction.x), std::abs(ray.direction.z));
            // The near plane of this camera cuts the floor below the image.
            const bool hit = ray.direction.y < -1e-9 && reach < 0.98 * half * placed.frame().scale;
            const bool missed = ray.direction.y > 0.0 || reach > 1.02 * half * placed.frame().scale;
            if (depth < 1.001 * drawing.view.forward.w || !(hit || missed)) continue;
            EXPECT_EQ(drawing.triangle(p) >= 0, hit) << half << ": " << p % 90 << ", " << p / 90;
        }
    }
}

TEST(GBuffer, CoversTheNearPlanesCutExactlyUpToIt) {
    // A wall seen end on: it starts behind the eye; what is nearer than `near` must be cut away.
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    test::add_quad(scene,
                   {glm::dvec3(0.5, -0.2, 3), {0.5, -0.2, -9}, {0.5, 0.2, -9}, {0.5, 0.2, 3}});
    Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 2.0f);
    camera.near = 1.0f;
    const Drawing drawing = test::draw(scene, camera, 128, 128);
    const double extent = std::tan(1.0);
    for (int x = 0; x < 128; ++x) {
        const double tangent = ((x + 0.5) / 64.0 - 1.0) * extent;
        const double depth = 0.5 / tangent;
        if (std::abs(depth - 1.0) < 0.02 || std::abs(depth - 9.0) < 3.0) continue;
        EXPECT_EQ(drawing.triangle(64 * 128 + x) >= 0, depth > 1.0 && depth < 9.0) << x;
    }
}

TEST(GBuffer, HasUnitNormalsTowardsTheViewer) {
    Scene scene = heap(60, 5);
    scene.materials[0].double_sided = true;
    test::Random random(5);
    for (glm::vec3& normal : scene.normals)  // shading normals far off the faces
        normal = glm::normalize(normal +
                                glm::vec3(random(-0.5, 0.5), random(-0.5, 0.5), random(-0.5, 0.5)));
    const Drawing drawing =
        test::draw(scene, test::camera_at({0.1, 0.2, 0.9}, {-0.3, 0, -0.6}, 1.2f), 99, 75);
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        ASSERT_GE(drawing.triangle(p), 0) << "the box is closed";
        const glm::vec3 towards =
            glm::normalize(glm::vec3(drawing.view.eye) - drawing.at(GBUFFER_POSITION, p));
        for (const int plane : {int{GBUFFER_NORMAL}, int{GBUFFER_GEOMETRIC}}) {
            const glm::vec3 normal = drawing.at(plane, p);
            EXPECT_NEAR(glm::length(normal), 1.0f, 4e-7f);  // a root and a division
            EXPECT_GT(glm::dot(normal, towards), -1e-5f);   // a face seen from its edge
        }
    }
}

TEST(GBuffer, IsTheSameForEveryWorkGroupAndPacket) {
    Scene scene = heap(400, 6);
    for (int t = 0; t < 1500; ++t) {  // and dust, a pixel or less each
        test::Random random(static_cast<std::uint64_t>(t));
        const glm::dvec3 at(random(-0.9, 0.9), random(-0.9, 0.9), random(-0.9, 0.2));
        const auto aside = [&] {
            return glm::dvec3(random(-0.02, 0.02), random(-0.02, 0.02), random(-0.02, 0.02));
        };
        test::add_triangle(scene, at + aside(), at + aside(), at + aside());
    }
    const DeviceScene placed = test::on_device(scene);
    const View view =
        make_view(test::camera_at({0.1, 0.2, 0.9}, {-0.3, 0, -0.6}, 1.2f), placed.frame(), 133, 67);
    const Drawing usual = test::draw(placed, view);
    std::vector<BuildOptions> builds = {{.packet_width = 1, .local_size = 7},
                                        {.packet_width = 4, .local_size = 256},
                                        {.packet_width = 1, .local_size = 7, .atomics64 = false}};
    for (BuildOptions& options : builds) {
        options.textures = false;  // there are none: built in half the time, to the same bits
        const Drawing other = test::draw(placed, view, GBufferPasses(test::programs(), options));
        const std::string label = "width " + std::to_string(options.packet_width) + ", group " +
                                  std::to_string(options.local_size);
        EXPECT_TRUE(other.visibility == usual.visibility) << label;
        EXPECT_TRUE(other.planes == usual.planes) << label;
        for (std::size_t p = 0; p < usual.pixels(); ++p)  // what pads the planes may differ
            ASSERT_EQ(other.ids[p], usual.ids[p]) << label << ", pixel " << p;
    }
}

// Every step-th point of every step-th row, to the bit.
void expect_picked(std::uint32_t width, std::uint32_t height, std::uint32_t step) {
    const std::uint32_t stride = test::padded(width * height);
    const std::uint32_t low_width = (width + step - 1) / step;
    const std::uint32_t low_height = (height + step - 1) / step;
    const std::uint32_t low_stride = test::padded(low_width * low_height);
    std::vector<float> planes(POINT_PLANES * stride);
    for (std::size_t i = 0; i < planes.size(); ++i) planes[i] = static_cast<float>(i);
    const cl::Buffer points = test::empty<float>(POINT_PLANES * low_stride);
    test::gbuffer_passes().downsample(test::device().queue,
                                      {width, height, stride, low_stride, step, 0, 0, 0},
                                      test::upload(planes), points);
    const auto low = test::download<float>(points, POINT_PLANES * low_stride);
    for (std::uint32_t plane = 0; plane < POINT_PLANES; ++plane)
        for (std::uint32_t y = 0; y < low_height; ++y)
            for (std::uint32_t x = 0; x < low_width; ++x)
                EXPECT_EQ(low[plane * low_stride + y * low_width + x],
                          planes[plane * stride + step * (y * width + x)]);
}

TEST(GBuffer, PicksTheFirstPointOfEveryCell) {
    for (const std::uint32_t step : {2u, 4u})
        for (const auto& [width, height] :
             {std::pair(1u, 1u), {2u, 1u}, {3u, 5u}, {33u, 18u}, {64u, 6u}})
            expect_picked(width, height, step);
}

}  // namespace
}  // namespace clgi
