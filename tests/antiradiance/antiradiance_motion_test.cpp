// A solver whose geometry moves, against one that is made anew where it is.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <clgi/error.hpp>
#include <cmath>
#include <future>
#include <map>
#include <thread>
#include <tuple>

#include "device.hpp"
#include "math_modes.hpp"
#include "moving_room.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(MovingAntiradiance);

AntiradianceOptions motion_options(const test::Build& build, std::size_t leaves, int bins = 128) {
    AntiradianceOptions out;
    out.bins = bins;
    out.elements.requested = leaves;
    out.build = build;
    return out;
}

struct MovingSolution {
    DeviceScene scene;
    AntiradianceSolver solver;
    SceneMover mover;
    MovingSolution(const Scene& of, const AntiradianceOptions& options)
        : scene(test::on_device(of)),
          solver(test::programs(), test::device().queue, of, scene, options),
          mover(test::device().queue, scene) {}
    std::vector<glm::vec4> irradiances() const {
        return test::download<glm::vec4>(solver.leaves().irradiances, solver.elements().leaves);
    }
    // Moves, and solves there.
    std::vector<glm::vec4> at(const test::MovingRoom& room, double time) {
        const cl::Event moved = room.move(mover, time);
        solver.geometry_changed({moved});
        EXPECT_TRUE(solver.run());
        EXPECT_EQ(solver.status().non_finite, 0u);
        return irradiances();
    }
};

// Leaves by triangle, side and number within it: clusters differ from solver to solver.
using Leaf = std::tuple<std::uint32_t, std::uint8_t, std::uint32_t>;
struct LeafLight {
    glm::dvec3 irradiance;
    double area;
    bool moves;
};
std::map<Leaf, LeafLight> by_leaf(const MovingSolution& of, const test::MovingRoom& room) {
    const ElementTree& tree = of.solver.elements();
    std::map<std::uint32_t, std::uint32_t> rows;
    for (std::uint32_t row = 0; row < of.solver.leaf_elements().size(); ++row)
        rows[of.solver.leaf_elements()[row]] = row;
    const std::vector<glm::vec4> light = of.irradiances();
    std::map<std::pair<std::uint32_t, std::uint8_t>, std::uint32_t> counts;
    std::map<Leaf, LeafLight> out;
    for (std::uint32_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const std::uint32_t triangle = tree.triangles[i];
        const std::uint32_t number = counts[{triangle, tree.backs[i]}]++;
        out[{triangle, tree.backs[i], number}] = {
            glm::dvec3(light[rows[i]]), tree.areas[i],
            room.scene.triangles[triangle].vertex[0] >= room.first};
    }
    return out;
}

// Root mean square difference over the root mean square.
double difference(const std::map<Leaf, LeafLight>& a, const std::map<Leaf, LeafLight>& b,
                  bool moving) {
    double off = 0.0, all = 0.0;
    for (const auto& [leaf, light] : b) {
        if (moving && !light.moves) continue;
        const auto found = a.find(leaf);
        if (found == a.end()) {
            ADD_FAILURE() << "leaves differ";
            continue;
        }
        const glm::dvec3 d = found->second.irradiance - light.irradiance;
        off += light.area * glm::dot(d, d);
        all += light.area * glm::dot(light.irradiance, light.irradiance);
    }
    return std::sqrt(off / all);
}

TEST_P(MovingAntiradiance, FindsTheLightOfASolverMadeAnew) {
    const test::MovingRoom room;
    AntiradianceOptions options = motion_options(GetParam(), 1500);
    options.poses = room.poses(9);
    MovingSolution moving(room.scene, options);
    options.poses = {};
    for (const double time : {0.0, 0.4, 0.9}) {
        moving.at(room, time);
        MovingSolution anew(room.posed(time), options);
        anew.solver.run();
        MovingSolution old(room.scene, options);
        room.move(old.mover, time);
        old.solver.run();
        const auto wanted = by_leaf(anew, room), found = by_leaf(moving, room);
        const auto stayed = by_leaf(old, room);
        // What the tree and the links of a motion are coarser and finer by: 1.7 % and 4.4 %.
        EXPECT_LT(difference(found, wanted, false), 0.025) << time;
        EXPECT_LT(difference(found, wanted, true), 0.06) << time;
        if (time == 0.0) continue;
        EXPECT_GT(difference(stayed, wanted, false), 0.08) << time;
        EXPECT_GT(difference(stayed, wanted, true), 0.25) << time;
    }
}

TEST(AntiradianceMotionBits, ComeBackWithTheGeometry) {
    const test::MovingRoom room;
    AntiradianceOptions options = motion_options(Math::strict, 600, 64);
    options.poses = room.poses(5);
    options.steps = 8;
    MovingSolution solved(room.scene, options);
    EXPECT_TRUE(solved.solver.run());
    const auto first = solved.irradiances();
    const auto there = solved.at(room, 0.63);
    EXPECT_NE(there, first);
    EXPECT_EQ(solved.at(room, 0.0), first);
    EXPECT_EQ(solved.at(room, 0.63), there);
    // A run without a move finds the same, and makes no links.
    EXPECT_TRUE(solved.solver.run());
    EXPECT_EQ(solved.irradiances(), there);
    for (const PassEvent& pass : solved.solver.events())
        EXPECT_NE(pass.name, "antiradiance.relink");
}

CLGI_IN_ALL_MODES(NothingMoves);

TEST_P(NothingMoves, AreThoseOfAStillSceneWhereNothingMoves) {
    const Scene scene = test::furnished_room(5);
    AntiradianceOptions options = motion_options(GetParam(), 600, 64);
    options.steps = 8;
    MovingSolution still(scene, options);
    EXPECT_TRUE(still.solver.run());
    options.poses = {scene.positions, scene.positions};
    MovingSolution posed(scene, options);
    EXPECT_TRUE(posed.solver.run());
    EXPECT_EQ(posed.irradiances(), still.irradiances());
    EXPECT_EQ(posed.solver.bytes(), still.solver.bytes());
    EXPECT_EQ(posed.solver.moving_elements(), 0u);
    EXPECT_EQ(posed.solver.moving_links(), 0u);
    EXPECT_THROW(posed.solver.geometry_changed(), Error);
    EXPECT_THROW(still.solver.geometry_changed(), Error);
}

// A closed room keeps its light wherever the things in it are.
TEST_P(MovingAntiradiance, KeepsTheEnergyOfClosedRooms) {
    constexpr double albedo = 0.5;
    Scene scene = test::plain_scene(glm::vec3(static_cast<float>(albedo)));
    test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    test::add_box(scene, {0.15, 0.1, 0.2}, {0.35, 0.4, 0.5}, 1);
    scene.lights = {test::point_light({0.6, 0.75, 0.5})};
    const auto at = [&](double time) {
        std::vector<glm::dvec3> out = scene.positions;
        for (std::uint32_t v = first; v < out.size(); ++v)
            out[v] += time * glm::dvec3(0.6, 0.05, 0.2);
        return out;
    };
    AntiradianceOptions options = motion_options(GetParam(), 2000, 512);
    options.poses = {at(0.0), at(0.5), at(1.0)};
    MovingSolution solved(scene, options);
    for (const double time : {0.0, 0.3, 1.0}) {
        solved.mover.move(0, at(time), scene.normals).wait();
        solved.solver.geometry_changed();
        ASSERT_TRUE(solved.solver.run());
        EXPECT_TRUE(solved.solver.status().converged);
        double power = 0.0;
        const auto light = solved.irradiances();
        for (std::size_t row = 0; row < light.size(); ++row)
            power += solved.solver.elements().areas[solved.solver.leaf_elements()[row]] *
                     light[row].x * solved.scene.frame().exposure;
        const double wanted = 4.0 * 3.14159265358979 * albedo / (1.0 - albedo);
        EXPECT_NEAR(power, wanted, 0.03 * wanted) << time;
    }
}

TEST(AntiradianceMotion, WaitsForTheMove) {
    const test::MovingRoom room;
    AntiradianceOptions options = motion_options(Math::strict, 200, 32);
    options.poses = room.poses(3);
    options.steps = 2;
    MovingSolution solved(room.scene, options);
    solved.solver.run();
    const cl::UserEvent gate(test::device().context);
    solved.solver.geometry_changed({gate});
    std::atomic<bool> open = false;
    auto opens = std::async(std::launch::async, [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        open = true;
        cl::UserEvent(gate).setStatus(CL_COMPLETE);
    });
    EXPECT_TRUE(solved.solver.run());
    EXPECT_TRUE(open);
    opens.get();
}

TEST(AntiradianceMotion, RefusesAnotherFrame) {
    const test::MovingRoom room;
    AntiradianceOptions options = motion_options(Math::strict, 200, 32);
    options.poses = room.poses(3);
    MovingSolution solved(room.scene, options);
    std::vector<glm::dvec3> far = room.scene.positions;
    for (glm::dvec3& p : far) p = 3.0 * p;
    solved.mover.move(0, far, room.scene.normals, true).wait();
    EXPECT_THROW(solved.solver.geometry_changed(), Error);
}

// Pictures show what moves where it is, in its light.
TEST(AntiradianceMotion, IsSeenInPictures) {
    const test::MovingRoom room;
    AntiradianceOptions options = motion_options(Math::strict, 1500);
    options.poses = room.poses(9);
    MovingSolution moving(room.scene, options);
    PictureOptions picture;
    picture.width = 64;
    picture.height = 48;
    const Camera camera = test::camera_at({0.15, 2.2, 2.85}, {2.4, 0.8, 1.2}, 1.1f);
    const auto picture_of = [&](const MovingSolution& of) {
        AntiradianceView view(test::programs(), test::device().queue, of.scene, of.solver, picture);
        view.render(camera).wait();
        std::vector<float> out;  // planes without what lies between them
        for (std::size_t c = 0; c < 3; ++c) {
            const auto plane = test::download<float>(
                view.picture().radiance(), view.picture().pixels(), c * view.picture().stride());
            out.insert(out.end(), plane.begin(), plane.end());
        }
        return out;
    };
    moving.at(room, 0.4);
    const auto found = picture_of(moving);
    options.poses = {};
    MovingSolution anew(room.posed(0.4), options), before(room.scene, options);
    anew.solver.run();
    before.solver.run();
    const auto wanted = picture_of(anew), old = picture_of(before);
    const auto apart = [&](const std::vector<float>& a) {
        double off = 0.0, all = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            off += std::pow(double(a[i]) - wanted[i], 2);
            all += std::pow(double(wanted[i]), 2);
        }
        return std::sqrt(off / all);
    };
    EXPECT_LT(apart(found), 0.02);
    EXPECT_GT(apart(old), 0.1);
}

}  // namespace
}  // namespace clgi
