// How mouse and keys move a camera.
// SPDX-License-Identifier: MIT
#include "view/viewpoint.hpp"

#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <limits>

namespace clgi {
namespace {

using view::Viewpoint;

constexpr double near = 1e-12;

Viewpoint slanted() { return {{1.0, 2.5, -3.0}, {0.4, 1.0, 0.7}}; }

void expect_places(const glm::dvec3& found, const glm::dvec3& wanted, double error = near) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], error) << c;
}

TEST(Viewpoint, OrbitsAroundItsTarget) {
    Viewpoint moved = slanted();
    const glm::dvec3 before = moved.eye - moved.target;
    view::orbit(moved, 0.3, 0.2);
    const glm::dvec3 after = moved.eye - moved.target;
    EXPECT_EQ(moved.target, slanted().target);
    EXPECT_NEAR(glm::length(after), glm::length(before), near);
    const auto elevation = [](const glm::dvec3& v) { return std::asin(v.y / glm::length(v)); };
    EXPECT_NEAR(elevation(after) - elevation(before), 0.2, near);
    // The scene follows the mouse to the right, so the eye goes clockwise as seen from above.
    EXPECT_NEAR(std::atan2(after.x, after.z) - std::atan2(before.x, before.z), -0.3, near);
    view::orbit(moved, -0.3, -0.2);
    expect_places(moved.eye, slanted().eye);
}

TEST(Viewpoint, LooksAroundFromItsEye) {
    Viewpoint moved = slanted();
    view::look(moved, 0.5, -0.1);
    EXPECT_EQ(moved.eye, slanted().eye);
    EXPECT_NEAR(glm::length(moved.target - moved.eye),
                glm::length(slanted().target - slanted().eye), near);
    const glm::dvec3 before = slanted().target - slanted().eye, after = moved.target - moved.eye;
    const Camera camera = look_at({}, slanted().eye, slanted().target);
    EXPECT_GT(glm::dot(after, glm::dvec3(camera.right)), 0.1);  // to the right
    EXPECT_LT(after.y, before.y);
}

TEST(Viewpoint, StopsShortOfTheVertical) {
    for (const double up : {10.0, -10.0}) {
        Viewpoint moved = slanted();
        view::orbit(moved, 0.0, up);
        const glm::dvec3 way = glm::normalize(moved.eye - moved.target);
        EXPECT_NEAR(std::abs(way.y), std::sin(89.0 * std::acos(-1.0) / 180.0), near);
        EXPECT_GT(way.y * up, 0.0);
    }
}

TEST(Viewpoint, WalksAlongItsAxes) {
    Viewpoint moved = slanted();
    view::walk(moved, {0.5, 2.0, -1.5});
    const Camera camera = look_at({}, slanted().eye, slanted().target);
    const glm::dvec3 step = 0.5 * glm::dvec3(camera.right) + glm::dvec3(0.0, 2.0, 0.0) -
                            1.5 * glm::dvec3(camera.forward);
    expect_places(moved.eye, slanted().eye + step, 1e-6);  // axes of a camera are floats
    expect_places(moved.target, slanted().target + step, 1e-6);
    view::approach(moved, 0.5, 1.0);
    EXPECT_NEAR(glm::length(moved.eye - moved.target),
                0.5 * glm::length(slanted().eye - slanted().target), near);
}

TEST(Viewpoint, StaysOneWhateverIsDone) {
    Viewpoint down{{1.0, 5.0, 2.0}, {1.0, 0.0, 2.0}};
    view::walk(down, {0.5, 0.0, 1.0});
    expect_places(down.eye, {1.5, 4.0, 2.0});
    view::orbit(down, 0.1, 0.1);
    EXPECT_TRUE(std::isfinite(glm::length(down.eye)));
    for (int i = 0; i < 1000; ++i) view::approach(down, 0.5, 3.0);
    EXPECT_NEAR(glm::length(down.eye - down.target), 3e-4, 1e-9);
    for (int i = 0; i < 1000; ++i) view::approach(down, 2.0, 3.0);
    EXPECT_NEAR(glm::length(down.eye - down.target), 3e4, 1e-3);
    EXPECT_NO_THROW(look_at({}, down.eye, down.target));
}

TEST(Viewpoint, OfACameraLooksAtTheMiddle) {
    Camera camera;
    camera.position = {1.0, 2.0, 9.0};  // looks along -z
    const Viewpoint found = view::viewpoint_of(camera, {{-1.0, 0.0, -1.0}, {1.0, 2.0, 3.0}});
    EXPECT_EQ(found.eye, camera.position);
    expect_places(found.target, {1.0, 2.0, 1.0});
    camera.forward = {0.0f, 0.0f, 1.0f};  // away from it: a point in front all the same
    EXPECT_GT(view::viewpoint_of(camera, {{-1.0, 0.0, -1.0}, {1.0, 2.0, 3.0}}).target.z, 9.1);
}

TEST(LookAt, HasAxesOfUnitLength) {
    Camera before;
    before.name = "kept";
    before.vertical_fov = 0.5f;
    before.right = {0.0f, 0.0f, 1.0f};
    for (const glm::dvec3& target : {glm::dvec3(3.0, -1.0, 2.0), glm::dvec3(1.0, 7.0, 2.0),
                                     glm::dvec3(1.0, -7.0, 2.0), glm::dvec3(1e5, 2.5, 2.0)}) {
        const Camera found = look_at(before, {1.0, 2.0, 2.0}, target);
        EXPECT_EQ(found.name, "kept");
        EXPECT_EQ(found.vertical_fov, 0.5f);
        EXPECT_EQ(found.position, glm::dvec3(1.0, 2.0, 2.0));
        const glm::mat3 axes(found.right, found.up, -found.forward);
        EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-6);  // right-handed
        EXPECT_NEAR(glm::dot(found.right, found.forward), 0.0, 1e-6);
        EXPECT_NEAR(glm::dot(found.up, found.forward), 0.0, 1e-6);
        EXPECT_NEAR(found.right.y, 0.0, 1e-6);
        EXPECT_GE(found.up.y, -1e-6);
        EXPECT_NEAR(
            glm::dot(glm::dvec3(found.forward), glm::normalize(target - glm::dvec3(1.0, 2.0, 2.0))),
            1.0, 1e-6);
    }
    EXPECT_EQ(look_at(before, {1.0, 2.0, 2.0}, {1.0, 7.0, 2.0}).right, glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST(LookAt, RefusesPlacesThatAreNone) {
    EXPECT_THROW(look_at({}, glm::dvec3(1.0), glm::dvec3(1.0)), Error);
    EXPECT_THROW(look_at({}, glm::dvec3(1.0), {0.0, std::numeric_limits<double>::infinity(), 0.0}),
                 Error);
    EXPECT_THROW(look_at({}, {std::nan(""), 0.0, 0.0}, glm::dvec3(1.0)), Error);
}

}  // namespace
}  // namespace clgi
