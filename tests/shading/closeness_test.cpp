// The closeness that the words of visibility hold, against planes in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "depth_words.hpp"
#include "patchwork.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;

class ClosenessOf : public testing::TestWithParam<Looking> {};

INSTANTIATE_TEST_SUITE_P(Views, ClosenessOf,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

// A plane's closeness at the centre, off by what corners moved by half a 256th of a pixel each way
// change of it, and never beyond its corners'.
TEST_P(ClosenessOf, PixelCentres) {
    Scene scene = test::patchwork(90, 82, false);
    test::Random random(86);
    for (int t = 0; t < 4000; ++t) {  // a few pixels each: these are drawn at once
        const glm::dvec3 at(test::random_vec3(random, -0.8, 0.8));
        glm::dvec3 corner[3];
        for (glm::dvec3& c : corner) c = at + glm::dvec3(test::random_vec3(random, -0.03, 0.03));
        test::add_triangle(scene, corner[0], corner[1], corner[2], random.integer(0, 11));
    }
    scene.colors.clear();
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, test::looking(GetParam(), placed, 211, 157));
    const View& view = drawing.view;
    const test::SurfaceReference reference(scene, placed);
    std::size_t checked = 0;
    double worst = 0.0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int triangle = drawing.triangle(p);
        if (triangle < 0) continue;
        const double x = static_cast<double>(p % 211) + 0.5, y = static_cast<double>(p / 211) + 0.5;
        const auto at = [&](double column, double row) {
            return reference.at(view, triangle, column, row);
        };
        const test::SurfaceTruth truth = at(x, y);
        if (glm::min(glm::min(truth.weights.x, truth.weights.y), truth.weights.z) < 1e-3 ||
            truth.slant < 0.05)
            continue;
        const double wanted = test::closeness(view, truth.depth);
        const double across = test::closeness(view, at(x + 0.01, y).depth) - wanted;
        const double down = test::closeness(view, at(x, y + 0.01).depth) - wanted;
        const double bound =
            (std::abs(across) + std::abs(down)) * 100 / 512 * 1.05 + 64 * 0x1p-24 * wanted;
        worst = std::max(worst, std::abs(test::seen_closeness(drawing, p) - wanted) / bound);
        ++checked;
    }
    EXPECT_GT(checked, 5000u);
    EXPECT_LT(worst, 1.0);
}

// Walls that pass the eye: of one that begins 1 cm ahead, a corner lies tens of thousands of pixels
// away and is hundreds of times as close as what the picture shows of it.
TEST(Closeness, OfWallsBesideTheEyeIsTrue) {
    constexpr int width = 211, height = 157;
    double worst = 0.0;
    std::size_t checked = 0;
    for (int wall = 0; wall < 28; ++wall) {
        const double angle = 2.0 * M_PI * wall / 7.0 + 0.1;
        const glm::dvec3 out(std::cos(angle), std::sin(angle), 0.0);
        const glm::dvec3 along(-out.y, out.x, 0.0), at = 1.5 * out;
        const glm::dvec3 corner[4] = {
            at - 2.0 * along - glm::dvec3(0, 0, 0.01), at + 2.0 * along - glm::dvec3(0, 0, 0.01),
            at + 1.0 * along - glm::dvec3(0, 0, 6), at - 2.5 * along - glm::dvec3(0, 0, 5)};
        Scene scene = test::plain_scene();
        scene.materials[0].double_sided = true;
        const int turn = wall / 7;  // whichever corner comes first
        test::add_quad(scene, {corner[turn], corner[(turn + 1) % 4], corner[(turn + 2) % 4],
                               corner[(turn + 3) % 4]});
        Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1}, 1.2f);
        camera.near = 0.005f;
        const DeviceScene placed = test::on_device(scene);
        const Drawing drawing =
            test::draw(placed, make_view(camera, placed.frame(), width, height));
        const View& view = drawing.view;
        const test::SurfaceReference reference(scene, placed);
        for (std::size_t p = 0; p < drawing.pixels(); ++p) {
            const int triangle = drawing.triangle(p);
            if (triangle < 0) continue;
            const double x = static_cast<double>(p % width) + 0.5;
            const double y = static_cast<double>(p / width) + 0.5;
            const double wanted = test::closeness(view, reference.at(view, triangle, x, y).depth);
            const double aside =
                std::abs(test::closeness(view, reference.at(view, triangle, x + 1, y).depth) -
                         wanted) +
                std::abs(test::closeness(view, reference.at(view, triangle, x, y + 1).depth) -
                         wanted);
            const double bound = aside / 512 + 64 * 0x1p-24 * wanted;
            worst = std::max(worst, std::abs(test::seen_closeness(drawing, p) - wanted) / bound);
            ++checked;
        }
    }
    EXPECT_GT(checked, 50000u);
    EXPECT_LT(worst, 1.0);
}

// Rounding puts nothing in front of a triangle's closest corner or behind its farthest, not even on
// an edge between two of these that runs through pixel centres.
TEST(Closeness, LiesBetweenThatOfCorners) {
    test::Random random(87);
    std::size_t checked = 0, before = 0, behind = 0;
    for (int frame = 0; frame < 30; ++frame) {  // of few triangles: what is behind is seen as well
        Scene scene = test::plain_scene();
        scene.materials[0].double_sided = true;
        for (int t = 0; t < 30; ++t) {
            const glm::dvec3 from(random.integer(0, 130) + 0.5, random.integer(0, 130) + 0.5,
                                  random(0, 40));
            const double steps = random.integer(5, 20);
            const glm::dvec3 to =
                from + steps * glm::dvec3(random.integer(-6, 6), random.integer(-6, 6), 0);
            glm::dvec3 corner[3] = {from, to, {random(0, 131), random(0, 131), random(0, 40)}};
            std::swap(corner[2], corner[random.integer(0, 2)]);
            test::add_triangle(scene, corner[0], corner[1], corner[2]);
        }
        const Drawing drawing = test::draw(scene, test::pixel_camera(131, 131), 131, 131);
        for (std::size_t p = 0; p < drawing.pixels(); ++p) {
            if (drawing.triangle(p) < 0) continue;
            const glm::uvec4& corners = drawing.triangles[drawing.visibility[p] & 0xffffffffu];
            const float found = test::seen_closeness(drawing, p);
            float farthest = drawing.vertices[corners[0]].closeness, closest = farthest;
            for (int k = 1; k < 3; ++k) {
                farthest = std::min(farthest, drawing.vertices[corners[k]].closeness);
                closest = std::max(closest, drawing.vertices[corners[k]].closeness);
            }
            ++checked;
            before += !(found <= closest);
            behind += !(found >= farthest);
        }
    }
    EXPECT_GT(checked, 100000u);
    EXPECT_EQ(before, 0u);
    EXPECT_EQ(behind, 0u);
}

}  // namespace
}  // namespace clgi
