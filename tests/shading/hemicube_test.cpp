// What a VPL's hemicube says is seen, against geometry. Through atlas.see.
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

// Directions about a hemicube: at random, and on and beside the edges of its faces.
std::vector<glm::dvec3> directions(const Eye& eye, Random& random) {
    std::vector<glm::dvec3> out;
    for (int i = 0; i < 400; ++i) {
        const double z = random(0.02, 1.0), angle = random(0, 2 * test::pi);
        const double across = std::sqrt(1.0 - z * z);
        out.push_back(eye.along(across * std::cos(angle), across * std::sin(angle), z));
    }
    for (const double off : {0.0, 1e-6, -1e-6, 1e-4, -1e-4, 0.02, -0.02})
        for (int i = 0; i < 12; ++i) {
            const double t = random(-1, 1), up = random(0.05, 1.0);
            for (const double s : {-1.0, 1.0}) {
                out.push_back(eye.along(s * (1 + off), t, 1));  // between the top and the sides
                out.push_back(eye.along(t, s * (1 + off), 1));
                out.push_back(eye.along(s * (1 + off), 1, up));  // between two sides
                out.push_back(eye.along(s * (1 + off), -1, up));
            }
        }
    return out;
}

CLGI_IN_BOTH_MATHS(Hemicube);

// A plane hides no part of itself: from 1e-4 to 0.9 of a scene's size, up to 89 degrees from
// straight ahead, whichever way eye and plane are turned.
TEST_P(Hemicube, SeesAPlaneAtEveryDistanceAndAngle) {
    Random random(11);
    int seen = 0, missed = 0, steep = 0, sides = 0;
    for (const double distance : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.9})
        for (int turn = 0; turn < 8; ++turn) {
            const glm::dvec3 normal(test::direction(random));
            // Ahead, and then leaning over until it stands across the horizon.
            glm::dvec3 facing = -normal;
            if (turn > 0)
                facing = glm::normalize(facing + 0.25 * turn * glm::dvec3(test::direction(random)));
            if (glm::dot(facing, normal) > -0.1) continue;
            const glm::dvec3 eye_at = 0.05 * glm::dvec3(test::direction(random));
            Scene world = islands(facing);
            add_square(world, eye_at - distance * facing, facing, 40.0 * distance);
            const DeviceScene scene = test::on_device(world);
            const Eye eye(scene, scene.frame().to_local(eye_at), glm::vec3(normal),
                          turn % 2 ? 64 : 128);
            std::vector<SurfacePlace> points;
            std::vector<glm::dvec3> ways = directions(eye, random), used;
            for (const glm::dvec3& way : ways) {
                const double towards = -glm::dot(way, facing);
                // Within the square, below 89 degrees.
                if (towards < std::cos(89.0 / 180.0 * test::pi) || towards < 0.026) continue;
                points.push_back(place(scene, eye_at + way * (distance / towards), facing));
                used.push_back(way);
                steep += towards < 0.1;
                sides += glm::dot(way, eye.c) < 0.5;
            }
            const auto found = eye.sees(points, test::atlas_passes(GetParam()));
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double towards = -glm::dot(used[i], facing);
                EXPECT_TRUE(found[i] || towards < 0.09)
                    << "distance " << distance << ", cosine " << towards << ", elevation "
                    << glm::dot(used[i], eye.c);
                seen += found[i];
                missed += !found[i];
            }
        }
    // Beyond 85 degrees a few: the rasteriser's plane of closeness is exact to a few units in the
    // last place of what it is 32000 pixels aside, 1000 / h, against 1 / d of the pixel.
    EXPECT_LT(missed, seen / 5000);
    EXPECT_GT(seen, 15000);
    EXPECT_GT(steep, 300);
    EXPECT_GT(sides, 3000);
}

// A wall in front of it by twice what the look-up allows for: the receiver's slope over half a
// pixel each way, and a quarter of a pixel.
TEST_P(Hemicube, DoesNotSeeBehindAWallOfTwiceTheBias) {
    Random random(12);
    const double pixel = 2.0 / 128.0;
    int checked = 0;
    for (const double distance : {1e-3, 1e-2, 0.1, 0.5})
        for (const double thick : {0.04, 0.1, 0.25}) {
            const glm::dvec3 normal(test::direction(random));
            const glm::dvec3 facing =
                glm::normalize(-normal + 0.5 * glm::dvec3(test::direction(random)));
            Scene world = islands(facing);
            add_square(world, glm::dvec3(0) - distance * facing, facing, 40.0 * distance);
            add_square(world, glm::dvec3(0) - distance / (1.0 + thick) * facing, facing,
                       40.0 * distance);
            const DeviceScene scene = test::on_device(world);
            const Eye eye(scene, scene.frame().to_local(glm::dvec3(0)), glm::vec3(normal));
            std::vector<SurfacePlace> points;
            for (const glm::dvec3& way : directions(eye, random)) {
                const double towards = -glm::dot(way, facing);
                if (towards < 0.03 || glm::dot(way, eye.c) < 0.05) continue;
                // How far the plane's closeness changes within half a pixel of the face.
                const double along =
                    std::max({std::abs(glm::dot(way, eye.a)), std::abs(glm::dot(way, eye.b)),
                              glm::dot(way, eye.c)});
                const double slope = std::sqrt(0.5) * pixel * along / towards;
                if (thick < 2.0 * (slope + 0.25 * pixel)) continue;
                points.push_back(place(scene, way * (distance / towards), facing));
            }
            for (const bool seen : eye.sees(points, test::atlas_passes(GetParam()))) {
                EXPECT_FALSE(seen) << "distance " << distance << ", wall " << thick;
                ++checked;
            }
        }
    EXPECT_GT(checked, 3000);
}

// ---- a furnished box against rays ---------------------------------------------------------------

struct Block {
    glm::dvec3 center, normal;
    double half;
};

bool blocked(const std::vector<Block>& blocks, const glm::dvec3& from, const glm::dvec3& to) {
    for (const Block& block : blocks) {
        const double a = glm::dot(from - block.center, block.normal);
        const double b = glm::dot(to - block.center, block.normal);
        if (a * b >= 0.0) continue;
        const glm::dvec3 at = from + (to - from) * (a / (a - b)) - block.center;
        const glm::dvec3 helper =
            std::abs(block.normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(helper, block.normal));
        const glm::dvec3 v = glm::cross(block.normal, u);
        if (std::abs(glm::dot(at, u)) < block.half && std::abs(glm::dot(at, v)) < block.half)
            return true;
    }
    return false;
}

TEST_P(Hemicube, SeesWhatRaysSee) {
    Random random(13);
    int lit = 0, dark = 0;
    for (int turn = 0; turn < 12; ++turn) {
        Scene world = test::plain_scene();
        test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
        std::vector<Block> blocks;
        for (int k = 0; k < 6; ++k) {
            blocks.push_back({0.6 * glm::dvec3(test::direction(random)),
                              glm::dvec3(test::direction(random)), random(0.1, 0.3)});
            add_square(world, blocks.back().center, blocks.back().normal, blocks.back().half);
        }
        const DeviceScene scene = test::on_device(world);
        const glm::dvec3 at = 0.1 * glm::dvec3(test::direction(random));
        const Eye eye(scene, scene.frame().to_local(at), test::direction(random), 256);
        std::vector<SurfacePlace> points;
        std::vector<bool> wanted;
        for (int i = 0; i < 2000; ++i) {
            const int axis = random.integer(0, 2);
            glm::dvec3 p(random(-1, 1), random(-1, 1), random(-1, 1)), normal(0);
            p[axis] = random.integer(0, 1) ? 1.0 : -1.0;
            normal[axis] = -p[axis];
            const glm::dvec3 d = p - at;
            if (glm::dot(d, eye.c) < 0.02) continue;
            // Not within two pixels of a shadow's border.
            const bool hidden = blocked(blocks, at, p);
            bool same = true;
            for (int k = 0; k < 8; ++k) {
                const double angle = k * test::pi / 4.0, off = 2.0 * 2.0 / 256.0 * glm::length(d);
                const glm::dvec3 u = glm::normalize(glm::cross(d, glm::dvec3(0.3, 0.5, 0.7)));
                const glm::dvec3 v = glm::cross(glm::normalize(d), u);
                const glm::dvec3 way = d + off * (std::cos(angle) * u + std::sin(angle) * v);
                same &= blocked(blocks, at, at + way) == hidden;
                // Nor of the wall's own end.
                const glm::dvec3 on_wall = at + way * (d[axis] / way[axis]);
                for (int c = 0; c < 3; ++c) same &= c == axis || std::abs(on_wall[c]) < 1.0;
            }
            if (!same) continue;
            points.push_back(place(scene, p, normal));
            wanted.push_back(!hidden);
            (hidden ? dark : lit)++;
        }
        const auto found = eye.sees(points, test::atlas_passes(GetParam()));
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_EQ(found[i], wanted[i]) << "turn " << turn << ", point " << i;
    }
    EXPECT_GT(lit, 3000);
    EXPECT_GT(dark, 800);
}

// On the horizon and below, behind the plane of the receiver: never, whatever is drawn.
TEST_P(Hemicube, SeesNothingBelowItsHorizonNorFromBehind) {
    const DeviceScene scene = test::on_device(islands({0, 1, 0}));
    const Eye eye(scene, {0.01f, 0.02f, -0.03f}, glm::vec3(0, 0, 1));
    std::vector<SurfacePlace> points;
    std::vector<bool> wanted;
    for (const float height : {-0.5f, -1e-3f, -1e-6f, 0.0f, 1e-6f, 1e-3f, 0.5f})
        for (int k = 0; k < 16; ++k) {
            const float x = std::cos(0.4f * k), y = std::sin(0.4f * k);
            const glm::vec3 p =
                glm::vec3(0.01f, 0.02f, -0.03f) + glm::vec3(0.5f * x, 0.5f * y, height);
            for (const float side : {1.0f, -1.0f}) {
                const glm::vec3 normal = glm::normalize(side * glm::vec3(-x, -y, -1.0f));
                points.push_back({p, normal, normal});
                wanted.push_back(p.z > -0.03f && side > 0.0f);
            }
        }
    EXPECT_EQ(eye.sees(points, test::atlas_passes(GetParam())), wanted);
}

}  // namespace
}  // namespace clgi
