// Edges that run through a pixel of a hemicube: a wall on a floor, outlines.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "hemicube_eye.hpp"

namespace clgi {
namespace {

using test::add_square;
using test::Eye;
using test::islands;
using test::place;
using test::Random;
using test::SurfacePlace;

CLGI_IN_BOTH_MATHS(HemicubeEdges);

// Where a direction falls on the image plane of its face, and how far that is from the face's end.
struct Image {
    double x, y, room;
    Image(const Eye& eye, const glm::dvec3& d) {
        const double a = glm::dot(d, eye.a), b = glm::dot(d, eye.b), c = glm::dot(d, eye.c);
        const bool top = c >= std::max(std::abs(a), std::abs(b)), by_a = std::abs(a) > std::abs(b);
        const double w = top ? c : std::max(std::abs(a), std::abs(b));
        x = (top || !by_a ? a : b) / w;
        y = (top ? b : c) / w;
        room = std::min(1.0 - std::abs(x), 1.0 - std::abs(y));
        if (!top) room = std::min(room, y);
    }
};

// A wall stands on a floor that goes on behind it. Points from a tenth of a pixel to one and a half
// from the line where it stands: nearly all are seen before it. Behind it a few within half a pixel
// are, for which the wall is as near as the plane of a bent surface may be, and none farther away.
TEST_P(HemicubeEdges, SeesNoFloorBehindTheWallThatStandsOnIt) {
    Random random(14);
    const double pixel = 2.0 / 128.0;
    int before = 0, close = 0, far = 0, seen_before = 0, seen_close = 0, seen_far = 0;
    for (int turn = 0; turn < 60; ++turn) {
        const glm::dvec3 up(test::direction(random));
        const glm::dvec3 along =
            glm::normalize(glm::cross(up, glm::dvec3(test::direction(random))));
        const glm::dvec3 ahead = glm::cross(along, up);
        const double height = random(0.1, 0.5), distance = random(0.15, 0.7);
        const glm::dvec3 foot = distance * ahead - height * up;
        Scene world = test::plain_scene();
        add_square(world, foot, up, 2.0);
        add_square(world, foot, -ahead, 2.0);
        const DeviceScene scene = test::on_device(world);
        const glm::dvec3 normal =
            glm::normalize(glm::normalize(foot) + 0.9 * glm::dvec3(test::direction(random)));
        const Eye eye(scene, scene.frame().to_local(glm::dvec3(0)), glm::vec3(normal), 128);
        std::vector<SurfacePlace> points;
        std::vector<double> behind;  // pixels
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 at = foot + random(-0.8, 0.8) * along;
            if (glm::dot(at, eye.c) < 0.02) continue;
            const Image here(eye, at), there(eye, at + 1e-6 * ahead);
            if (here.room < 4.0 * pixel) continue;
            const double off = random(0.1, 1.5) * (i % 2 ? -1.0 : 1.0);
            const double metres =
                off * pixel * 1e-6 / std::hypot(there.x - here.x, there.y - here.y);
            if (std::abs(metres) > 0.05) continue;
            behind.push_back(off);
            points.push_back(place(scene, at + metres * ahead, up));
        }
        const auto found = eye.sees(points, test::atlas_passes(GetParam()));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double off = behind[i];
            (off < 0.0 ? before : off < 0.55 ? close : far)++;
            (off < 0.0 ? seen_before : off < 0.55 ? seen_close : seen_far) += found[i];
        }
    }
    EXPECT_EQ(seen_far, 0);
    EXPECT_LT(seen_close, 0.06 * close);
    EXPECT_GT(seen_before, 0.993 * before);
    EXPECT_GT(far, 3000);
    EXPECT_GT(close, 3000);
    EXPECT_GT(before, 3000);
}

// Points in a closed box, within a pixel and a half of its outline, from outside: their walls face
// the eye, but the backs of others lie before them. As above, a few within half a pixel are seen.
TEST_P(HemicubeEdges, SeesNothingPastTheOutlineOfABox) {
    Random random(15);
    const double pixel = 2.0 / 128.0;
    int close = 0, far = 0, seen_close = 0, seen_far = 0;
    for (int turn = 0; turn < 60; ++turn) {
        Scene world = test::plain_scene();
        test::add_box(world, glm::dvec3(-0.3), glm::dvec3(0.3), -1);
        const DeviceScene scene = test::on_device(world);
        const glm::dvec3 at = random(0.7, 1.2) * glm::dvec3(test::direction(random));
        const glm::dvec3 normal =
            glm::normalize(-glm::normalize(at) + 0.5 * glm::dvec3(test::direction(random)));
        const Eye eye(scene, scene.frame().to_local(at), glm::vec3(normal));
        std::vector<SurfacePlace> points;
        std::vector<double> within;
        for (int i = 0; i < 300; ++i) {
            // On a wall beside one of its edges.
            const int axis = random.integer(0, 2), other = (axis + random.integer(1, 2)) % 3;
            glm::dvec3 p(random(-0.25, 0.25), random(-0.25, 0.25), random(-0.25, 0.25)), inwards(0);
            p[axis] = random.integer(0, 1) ? 0.3 : -0.3;
            inwards[axis] = -p[axis] / 0.3;
            const double end = random.integer(0, 1) ? 0.3 : -0.3;
            const double off = random(0.01, 1.5);  // pixels, or less where it is seen from aside
            p[other] = end * (1.0 - off * pixel * glm::length(p - at) / 0.3);
            if (glm::dot(at - p, inwards) < 0.05 || glm::dot(p - at, eye.c) < 0.05) continue;
            if (Image(eye, p - at).room < 4.0 * pixel) continue;
            points.push_back(place(scene, p, inwards));
            within.push_back(off);
        }
        const auto found = eye.sees(points, test::atlas_passes(GetParam()));
        for (std::size_t i = 0; i < points.size(); ++i) {
            (within[i] < 0.55 ? close : far)++;
            (within[i] < 0.55 ? seen_close : seen_far) += found[i];
        }
    }
    EXPECT_EQ(seen_far, 0);
    EXPECT_LT(seen_close, 0.05 * close);
    EXPECT_GT(far, 2000);
    EXPECT_GT(close, 1000);
}

// Past its own outline the eye sees the floor, and the surface all the same.
TEST_P(HemicubeEdges, SeesASurfaceUpToItsOutline) {
    Random random(16);
    int checked = 0;
    for (int turn = 0; turn < 40; ++turn) {
        const glm::dvec3 normal(test::direction(random));
        const glm::dvec3 facing =
            glm::normalize(-normal + 0.6 * glm::dvec3(test::direction(random)));
        const glm::dvec3 centre = 0.4 * normal;
        Scene world = islands(facing);
        add_square(world, centre, facing, 0.1);
        add_square(world, centre - 0.3 * facing, facing, 2.0);
        const DeviceScene scene = test::on_device(world);
        const Eye eye(scene, scene.frame().to_local(glm::dvec3(0)), glm::vec3(normal));
        const glm::dvec3 helper =
            std::abs(facing.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(helper, facing)), v = glm::cross(facing, u);
        std::vector<SurfacePlace> points;
        for (int i = 0; i < 200; ++i) {
            const double x = random(-0.1, 0.1), end = (i % 2 ? 0.1 : -0.1) * random(0.95, 0.9999);
            points.push_back(
                place(scene, centre + (i % 4 < 2 ? x * u + end * v : end * u + x * v), facing));
        }
        for (const bool seen : eye.sees(points, test::atlas_passes(GetParam()))) {
            EXPECT_TRUE(seen) << turn;
            ++checked;
        }
    }
    EXPECT_GT(checked, 3000);
}

}  // namespace
}  // namespace clgi
