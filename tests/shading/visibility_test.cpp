// What is drawn before any attribute is looked up: projected corners, masks, and which words and
// planes are written at all.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "depth_words.hpp"
#include "patchwork.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;
using test::looking;
using test::Random;

class Visibility : public testing::TestWithParam<Looking> {};

INSTANTIATE_TEST_SUITE_P(Views, Visibility,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

double depth_of(const View& view, const glm::dvec3& position) {
    return glm::dot(position - glm::dvec3(view.eye), glm::dvec3(view.forward));
}

TEST_P(Visibility, ProjectsCornersToTheNearest256thOfAPixel) {
    const Scene scene = test::patchwork(90, 81, false);
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, looking(GetParam(), placed, 211, 157));
    const View& view = drawing.view;
    for (std::size_t t = 0; t < drawing.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = scene.triangles[drawing.order[t]].vertex[k];
            const glm::dvec3 at(placed.frame().to_local(scene.positions[vertex]));
            const glm::dvec3 away = at - glm::dvec3(view.eye);
            const double depth = depth_of(view, at);
            const double reach = view.eye.w == 0.0f ? depth : 1.0;
            const double x = (glm::dot(away, glm::dvec3(view.right)) / reach - view.window.x) /
                             double{view.right.w};
            const double y =
                (glm::dot(away, glm::dvec3(view.up)) / reach - view.window.y) / double{view.up.w};
            const test::ScreenVertex& found = drawing.vertices[drawing.triangles[t][k]];
            ASSERT_EQ(found.outside, 0u);
            // Half a step, and some roundings of a few hundred pixels.
            EXPECT_NEAR(found.x / 256.0, (0.5 + 0.5 * x) * 211, 0.5 / 256 + 2e-4);
            EXPECT_NEAR(found.y / 256.0, (0.5 - 0.5 * y) * 157, 0.5 / 256 + 2e-4);
            EXPECT_NEAR(found.closeness, test::closeness(view, depth),
                        8 * 0x1p-24 * test::closeness(view, depth) + 4e-7);
        }
}

// Before the near plane there is nothing, though it lies in front of the eye; what crosses the
// plane begins there.
TEST(Visibility, BeginsAtTheNearPlane) {
    for (const auto kind : {Camera::Kind::perspective, Camera::Kind::orthographic}) {
        Scene scene = test::plain_scene();
        scene.materials[0].double_sided = true;
        // All of it between eye and plane; behind it a sheet from 0.5 m to 8 m that rises.
        test::add_quad(scene,
                       {glm::dvec3(-3, -3, -0.6), {3, -3, -0.6}, {3, 3, -0.6}, {-3, 3, -0.6}});
        test::add_quad(scene,
                       {glm::dvec3(-3, -0.2, -0.5), {3, -0.2, -0.5}, {3, 2, -8}, {-3, 2, -8}});
        Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 1.2f);
        camera.kind = kind;
        camera.half_height = 1.0f;
        camera.near = 1.0f;
        const Drawing drawing = test::draw(scene, camera, 33, 64);
        std::size_t seen = 0, before = 0;
        for (std::size_t p = 0; p < drawing.pixels(); ++p) {
            const int triangle = drawing.triangle(p);
            EXPECT_TRUE(triangle < 0 || triangle >= 2) << p;
            seen += triangle >= 0;
            before += triangle >= 0 && drawing.depth(p) < drawing.view.forward.w * 0.99f;
        }
        EXPECT_GT(seen, 300u);
        EXPECT_EQ(before, 0u);
    }
}

// Of a triangle with one corner before the plane four edges are left, all of them in one tile.
TEST(Visibility, CutsSmallTrianglesAtTheNearPlane) {
    Random random(88);
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    for (int t = 0; t < 40; ++t) {
        const glm::dvec3 at(random(-0.4, 0.4), random(-0.4, 0.4), -1.0);
        glm::dvec3 corner[3];
        for (glm::dvec3& c : corner) c = at + glm::dvec3(test::random_vec3(random, -0.15, 0.15));
        test::add_triangle(scene, corner[0], corner[1], corner[2]);
    }
    Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 0.9f);
    camera.near = 1.0f;
    const DeviceScene placed = test::on_device(scene);
    const View view = make_view(camera, placed.frame(), 64, 64);
    const Drawing drawing = test::draw(placed, view);
    const RasterBuffers buffers = test::raster_buffers(placed, drawing.pixels());
    test::draw_visibility(test::gbuffer_passes(), placed, view, buffers, true);
    EXPECT_TRUE(test::download<std::uint64_t>(buffers.pixels, drawing.pixels()) ==
                drawing.visibility);

    const test::SurfaceReference reference(scene, placed);
    const double near = view.forward.w;
    std::size_t seen = 0, open = 0, wrong = 0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const double x = static_cast<double>(p % 64) + 0.5, y = static_cast<double>(p / 64) + 0.5;
        int wanted = -1;
        double nearest = std::numeric_limits<double>::infinity();
        bool clear = true;  // of edges, the plane and other triangles at this depth
        for (int t = 0; t < 40; ++t) {
            const test::SurfaceTruth hit = reference.at(view, t, x, y);
            const glm::dvec3& w = hit.weights;
            const double inside = glm::min(glm::min(w.x, w.y), w.z);
            if (inside < -0.03) continue;
            if (inside < 0.03 || std::abs(hit.depth - near) < 0.003 * near ||
                std::abs(hit.depth - nearest) < 0.003 * near)
                clear = false;
            if (hit.depth < near || hit.depth > nearest) continue;
            nearest = hit.depth;
            wanted = t;
        }
        if (!clear) continue;
        (wanted < 0 ? open : seen) += 1;
        wrong += drawing.triangle(p) != wanted;
    }
    EXPECT_GT(seen, 200u);
    EXPECT_GT(open, 500u);
    EXPECT_EQ(wrong, 0u);
}

// Far beyond the guard band in one direction alone.
TEST(Visibility, CutsWhatIsTallOrWide) {
    for (const bool tall : {false, true}) {
        Scene scene = test::plain_scene();
        const double w = tall ? 0.5 : 1e6, h = tall ? 1e6 : 0.5;
        test::add_quad(scene, {glm::dvec3(-w, -h, -5), {w, -h, -5}, {w, h, -5}, {-w, h, -5}});
        Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 1.0f);
        camera.near = 0.1f;
        const Drawing drawing = test::draw(scene, camera, 64, 64);
        const double edge = 0.5 / 5 / std::tan(0.5) * 32;  // pixels from the middle
        for (int i = 0; i < 64; ++i) {
            const double away = std::abs(i + 0.5 - 32);
            if (std::abs(away - edge) < 0.1) continue;
            for (const int j : {0, 20, 63})
                EXPECT_EQ(drawing.triangle(tall ? 64 * j + i : 64 * i + j) >= 0, away < edge)
                    << i << ", " << j << (tall ? " tall" : " wide");
        }
    }
}

// A sheet of few large or many small triangles with a mask; alpha is factor times vertex alpha.
Scene masked_sheet(int cells) {
    Scene scene = test::plain_scene();
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].alpha_cutoff = 0.5f;
    const double side = 48.0 / cells;
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const double l = x * side, b = y * side;
            test::add_quad(
                scene,
                {glm::dvec3(l, b, 0), {l + side, b, 0}, {l + side, b + side, 0}, {l, b + side, 0}});
        }
    for (const glm::dvec3& position : scene.positions)
        scene.colors.emplace_back(1.0f, 1.0f, 1.0f, position.x / 48.0);
    return scene;
}

TEST(Visibility, IsCutOutOfSmallTrianglesToo) {
    for (const int cells : {1, 2, 16, 24}) {
        const Drawing drawing = test::draw(masked_sheet(cells), test::pixel_camera(48, 48), 48, 48);
        for (int x = 0; x < 48; ++x)
            EXPECT_EQ(drawing.triangle(48 * 20 + x) >= 0, x >= 24) << cells << ": " << x;
    }
}

TEST(Visibility, ShowsWhatHasExactlyTheCutoffsAlpha) {
    Scene scene = masked_sheet(1);
    for (glm::vec4& color : scene.colors) color.w = 1.0f;
    scene.materials[0].base_color.w = 0.5f;
    const Drawing same = test::draw(scene, test::pixel_camera(48, 48), 48, 48);
    EXPECT_GE(same.triangle(48 * 20 + 7), 0);
    scene.materials[0].base_color.w = std::nextafter(0.5f, 0.0f);
    const Drawing less = test::draw(scene, test::pixel_camera(48, 48), 48, 48);
    EXPECT_EQ(less.triangle(48 * 20 + 7), -1);
}

// Buffers may serve one view after the other: nothing of the first is left in the second.
TEST(Visibility, ForgetsTheViewBefore) {
    const Scene scene = test::patchwork(30, 83, false);
    const DeviceScene placed = test::on_device(scene);
    View view = looking(Looking::perspective, placed, 97, 61);
    const Drawing wanted = test::draw(placed, view);
    const RasterBuffers buffers = test::raster_buffers(placed, wanted.pixels());
    test::draw_visibility(test::gbuffer_passes(), placed, looking(Looking::aside, placed, 97, 61),
                          buffers);
    test::draw_visibility(test::gbuffer_passes(), placed, view, buffers);
    EXPECT_TRUE(test::download<std::uint64_t>(buffers.pixels, wanted.pixels()) ==
                wanted.visibility);
}

// Two stages, and tiles and packets that end anywhere: all draw the same words.
TEST(Visibility, IsTheSameInTwoStagesAndAtEveryWidth) {
    const Scene scene = test::patchwork(60, 84);
    const DeviceScene placed = test::on_device(scene);
    for (const auto& [width, height] : {std::pair(97, 61), {33, 65}, {5, 3}}) {
        const View view = looking(Looking::perspective, placed, width, height);
        const Drawing usual = test::draw(placed, view);
        for (const auto& [lanes, atomics64] :
             {std::pair(1, true), {1, false}, {4, true}, {8, false}, {16, true}}) {
            const GBufferPasses passes(test::programs(),
                                       {.packet_width = lanes, .atomics64 = atomics64});
            EXPECT_TRUE(test::draw(placed, view, passes).visibility == usual.visibility)
                << lanes << (atomics64 ? "" : ", two stages");
        }
    }
}

// Planes that are not asked for are left alone; past the last pixel planes are zeros up to a whole
// packet, whatever lies behind the view in its buffer.
TEST(Resolve, WritesWhatIsAskedForAndZerosBehindTheLastPixel) {
    const Scene scene = test::patchwork(90, 85);
    const DeviceScene placed = test::on_device(scene);
    View view = looking(Looking::perspective, placed, 29, 21);
    view.first_pixel = 13;
    const Drawing whole = test::draw(placed, view);
    const std::size_t pixels = whole.pixels(), stride = whole.stride;
    ASSERT_NE(pixels % 16, 0u);
    std::vector<std::uint64_t> words(13, 0);
    words.insert(words.end(), whole.visibility.begin(), whole.visibility.end());
    words.insert(words.end(), 64, 0);  // triangle 0, right before the eye
    const cl::Buffer visibility = test::upload(words);
    const struct {
        int bit, plane, count;
    } groups[] = {{RESOLVE_GEOMETRIC, GBUFFER_GEOMETRIC, 3},
                  {RESOLVE_EMISSION, GBUFFER_EMISSION, 3},
                  {RESOLVE_DEPTH, GBUFFER_DEPTH, 1}};
    const GBufferPasses& passes = test::gbuffer_passes();
    for (const std::uint32_t write :
         {0, 1, 2, 4, 8, int{RESOLVE_ALL}, RESOLVE_ALL & ~RESOLVE_GEOMETRIC}) {
        const cl::Buffer planes = test::upload(std::vector<float>(GBUFFER_PLANES * stride, 9.0f));
        const cl::Buffer ids = test::upload(std::vector<cl_int>(GBUFFER_ID_PLANES * stride, 9));
        passes.resolve(test::device().queue, view, placed,
                       {static_cast<std::uint32_t>(stride), write, 0, 0}, visibility, planes, ids);
        const auto found = test::download<float>(planes, GBUFFER_PLANES * stride);
        const auto labels = test::download<cl_int>(ids, GBUFFER_ID_PLANES * stride);
        for (int plane = 0; plane < GBUFFER_PLANES; ++plane) {
            bool asked = true;
            for (const auto& group : groups)
                if (plane >= group.plane && plane < group.plane + group.count)
                    asked = (write & static_cast<std::uint32_t>(group.bit)) != 0;
            const std::size_t lanes = static_cast<std::size_t>(passes.packet_width());
            for (std::size_t p = 0; p < stride; ++p) {
                const std::size_t written = (pixels + lanes - 1) / lanes * lanes;
                const float wanted = !asked || p >= written ? 9.0f
                                     : p < pixels           ? whole.planes[plane * stride + p]
                                                            : 0.0f;
                ASSERT_EQ(found[plane * stride + p], wanted) << plane << ", " << p;
            }
        }
        for (std::size_t p = 0; p < pixels; ++p) {
            ASSERT_EQ(labels[p], whole.ids[p]);
            ASSERT_EQ(labels[stride + p], write & RESOLVE_TRIANGLE ? whole.ids[stride + p] : 9);
        }
    }
}

}  // namespace
}  // namespace clgi
