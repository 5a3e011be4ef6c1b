// The dynamic transfer solver: closed forms, the path tracer at the same vertices, what moves, and
// what may be left out.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include "math_modes.hpp"
#include "posing.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const glm::vec3 colour(0.9f, 2.0f, 3.5f);

CLGI_IN_BOTH_MATHS(DynamicTransfer);

struct Lit {
    explicit Lit(const Scene& file, DynamicTransferOptions options = {})
        : device(test::on_device(file)),
          solver(test::programs(), test::device().queue, file, device, options) {
        EXPECT_TRUE(solver.run());
        irradiance = test::irradiance_of(solver, device);
        const TransferStatus status = solver.status();
        EXPECT_EQ(
            status.bad_receivers + status.bad_blockers + status.bad_texels + status.non_finite, 0u);
    }
    DeviceScene device;
    DynamicTransferSolver solver;
    std::vector<glm::dvec3> irradiance;
};

DynamicTransferOptions with(Math math) {
    DynamicTransferOptions out;
    out.build.math = math;
    return out;
}

void expect_near(const glm::dvec3& found, const glm::dvec3& wanted, double tolerance,
                 const std::string& what) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] / wanted[c], 1.0, tolerance) << what << ", channel " << c;
}

// A convex solid never blocks its own view, and every solid is black inside.
TEST_P(DynamicTransfer, OfASphereUnderOneColourIsThatOfASky) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {3, -2, 5}, 0.7, 3);
    test::light_by(scene, colour);
    const Lit outside(scene, with(GetParam()));
    ASSERT_EQ(outside.irradiance.size(), 642u);
    for (const glm::dvec3& e : outside.irradiance)
        expect_near(e, pi * glm::dvec3(colour), 2e-5, "outside");
    for (glm::vec3& normal : scene.normals) normal = -normal;
    for (SceneTriangle& triangle : scene.triangles)
        std::swap(triangle.vertex[1], triangle.vertex[2]);
    for (const glm::dvec3& e : Lit(scene, with(GetParam())).irradiance)
        // What lies between the horizon of a vertex and the triangles around it stays open.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c] / (pi * colour[c]), 0.0, 0.01);
}

// L = 1 + s . a gives E(n) = pi + (2 pi / 3) n . a (STABILITY 1.5), on both sides of a tilted
// sheet.
TEST_P(DynamicTransfer, OfASheetHasTwoSides) {
    for (const bool double_sided : {false, true}) {
        Scene scene = test::plain_scene();
        scene.materials[0].double_sided = double_sided;
        const glm::dvec3 u = glm::normalize(glm::dvec3(1, 0.4, -0.2));
        const glm::dvec3 n = glm::normalize(glm::cross(u, glm::dvec3(0.1, 0.2, 1)));
        const glm::dvec3 v = glm::cross(n, u);
        test::add_quad(scene, {-u - v, u - v, u + v, v - u});
        const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
        test::light_by_gradient(scene, colour, axis);
        const Lit lit(scene, with(GetParam()));
        ASSERT_EQ(lit.irradiance.size(), double_sided ? 8u : 4u);
        for (std::size_t i = 0; i < lit.irradiance.size(); ++i) {
            const double side = i < 4 ? 1 : -1;
            // The picture has 128 texels a turn: a thousandth.
            expect_near(lit.irradiance[i],
                        glm::dvec3(colour) * (pi + 2 * pi / 3 * side * glm::dot(n, axis)), 1e-3,
                        "receiver " + std::to_string(i));
        }
    }
}

// A turn of the environment is a turn of the axis.
TEST_P(DynamicTransfer, FollowsATurnOfTheEnvironment) {
    Scene scene = test::plain_scene();
    const glm::dvec3 n = glm::normalize(glm::dvec3(1, 0.5, 0.3));
    const glm::dvec3 u = glm::normalize(glm::cross(n, glm::dvec3(0, 1, 0))), v = glm::cross(n, u);
    test::add_quad(scene, {-u - v, u - v, u + v, v - u});
    test::light_by_gradient(scene, colour, {1, 0, 0});
    scene.environment->rotation = 0.4f;
    Lit lit(scene, with(GetParam()));
    for (const double angle : {0.0, 0.7, -2.0}) {
        lit.solver.turn_environment(angle);
        lit.solver.light().wait();
        const glm::dvec3 axis(std::cos(0.4 + angle), 0, -std::sin(0.4 + angle));
        for (const glm::dvec3& e : test::irradiance_of(lit.solver, lit.device))
            expect_near(e, glm::dvec3(colour) * (pi + 2 * pi / 3 * glm::dot(n, axis)), 1e-3,
                        std::to_string(angle));
    }
}

// Directional lights as part of the environment: irradiance cut at five bands (STABILITY 1.5).
TEST_P(DynamicTransfer, TakesInDirectionalLights) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    scene.lights = {test::directional_light({0, -1, 0}, 2.0f)};
    scene.lights[0].intensity = {2.0f, 3.0f, 0.5f};
    DynamicTransferOptions options = with(GetParam());
    options.directional = true;
    Lit lit(scene, options);
    for (const glm::dvec3& e : lit.irradiance)
        expect_near(e, 0.96875 * glm::dvec3(2, 3, 0.5), 1e-5, "above");
    Light low = scene.lights[0];
    low.direction = glm::vec3(-std::sin(pi / 3), -std::cos(pi / 3), 0);  // 60 degrees
    lit.device.set_light(0, low);
    lit.solver.lights_changed();
    lit.solver.light().wait();
    // sum of (2 l + 1) / (4 pi) A_l P_l(1/2)
    const double cut = 0.25 + 0.5 * 0.5 + 5.0 / 16 * -0.125 - 3.0 / 32 * -0.2890625;
    for (const glm::dvec3& e : test::irradiance_of(lit.solver, lit.device))
        expect_near(e, cut * glm::dvec3(2, 3, 0.5), 1e-5, "low");
    options.directional = false;
    for (const glm::dvec3& e : Lit(scene, options).irradiance)
        EXPECT_EQ(glm::length(e), 0.0);  // no environment is a black one
}

// Hann's window lessens degree 1 by half of 1 + cos(pi / 5), whatever the light.
TEST_P(DynamicTransfer, HasAWindow) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::light_by_gradient(scene, colour, {0, 1, 0});
    DynamicTransferOptions options = with(GetParam());
    options.window = sh::Window::hann;
    const double first = (1 + std::cos(pi / 5)) / 2;
    for (const glm::dvec3& e : Lit(scene, options).irradiance)
        expect_near(e, glm::dvec3(colour) * (pi + 2 * pi / 3 * first), 1e-3, "hann");
}

double relative(const std::vector<glm::dvec3>& found, const std::vector<glm::vec3>& wanted) {
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const glm::dvec3 w(wanted[i]), d = found[i] - w;
        apart += glm::dot(d, d);
        whole += glm::dot(w, w);
    }
    return std::sqrt(apart / whole);
}

// Rays of the path tracer from the same vertices.
TEST_P(DynamicTransfer, AgreesWithThePathTracerAtVertices) {
    Scene scene = test::heap_of_solids(4);
    test::light_by_gradient(scene, colour, glm::normalize(glm::dvec3(0.4, 0.5, -0.7)));
    const Lit lit(scene, with(GetParam()));
    // Where a box stands on the ground, rounding decides on which side of it a corner is.
    std::vector<reference::Place> places;
    std::vector<glm::dvec3> found;
    for (std::size_t i = 0; i < lit.irradiance.size(); ++i) {
        const std::uint32_t v = lit.device.vertex_order()[i];
        if (std::abs(scene.positions[v].y) < 1e-6 && scene.normals[v].y < 0.999f) continue;
        places.push_back({scene.positions[v], scene.normals[v]});
        found.push_back(lit.irradiance[i]);
    }
    EXPECT_GT(places.size(), 2600u);
    reference::Options options;
    options.samples = 1024;
    options.effects = reference::parse_effects("emission,direct");
    const auto truth = reference::PathTracer(scene).irradiance(places, options);
    const double error = relative(found, truth.values);
    RecordProperty("percent", std::to_string(100 * error));
    EXPECT_LT(truth.relative_error, 0.03);
    EXPECT_LT(error, 0.04);
    glm::dvec3 sum(0.0), wanted(0.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        sum += found[i];
        wanted += glm::dvec3(truth.values[i]);
    }
    expect_near(sum, wanted, 0.01, "sum");
}

// ---- what moves
// ----------------------------------------------------------------------------------

TEST_P(DynamicTransfer, FollowsAnAnimation) {
    Scene scene = test::bent_strip();
    scene.materials[0].double_sided = true;
    test::light_by_gradient(scene, colour, {0.6, 0.8, 0});
    scene.moving_bounds = motion_bounds(scene, 0);
    Lit lit(scene, with(GetParam()));
    SceneAnimator animator(test::programs(), test::device().queue, scene, lit.device);
    for (const double time : {0.3, 1.0, 0.0}) {
        const Animated moved = animator.animate(0, time);
        lit.solver.transfer({moved.done});
        lit.solver.light().wait();
        const auto found = test::irradiance_of(lit.solver, lit.device);
        const Scene still = test::posed_at(scene, time);
        const Lit again(still, with(GetParam()));
        ASSERT_EQ(found.size(), again.irradiance.size());
        for (std::size_t i = 0; i < 6; ++i) {
            const std::uint32_t vertex = lit.device.vertex_order()[i];
            const auto& order = again.device.vertex_order();
            const auto at = static_cast<std::size_t>(std::find(order.begin(), order.end(), vertex) -
                                                     order.begin());
            for (const std::size_t side : {0u, 6u})
                expect_near(found[i + side], again.irradiance[at + side], 0.01,
                            "vertex " + std::to_string(vertex));
        }
    }
}

// ---- what may be left out
// --------------------------------------------------------------------------

std::vector<cl_uint> masks_of(const DynamicTransferSolver& solver) {
    const std::size_t stride = solver.receivers().stride;
    auto words = test::download<cl_uint>(solver.receivers().masks, 32 * stride);
    std::vector<cl_uint> out;
    for (std::size_t w = 0; w < 32; ++w)
        out.insert(
            out.end(), words.begin() + static_cast<std::ptrdiff_t>(w * stride),
            words.begin() + static_cast<std::ptrdiff_t>(w * stride + solver.receivers().count));
    return out;
}

std::vector<glm::uvec3> triangles_of(const Scene& scene) {
    std::vector<glm::uvec3> out;
    for (const SceneTriangle& t : scene.triangles)
        out.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    return out;
}

// A mesh that is no coarser has the same masks, whatever lies near.
TEST_P(DynamicTransfer, WithTwoLevelsOfTheSameMeshIsThatOfOne) {
    Scene scene = test::heap_of_solids(7);
    scene.materials[3].double_sided = true;
    test::light_by(scene, colour);
    const Lit one(scene, with(GetParam()));
    const auto wanted = masks_of(one.solver);
    EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), [](cl_uint w) { return w != 0; }), 10000);
    EXPECT_GE(one.solver.triangles_per_receiver(), scene.triangles.size());
    for (const int rings : {0, 2}) {
        DynamicTransferOptions options = with(GetParam());
        options.coarse = triangles_of(scene);
        options.rings = rings;
        const Lit two(scene, options);
        EXPECT_TRUE(masks_of(two.solver) == wanted) << rings;
    }
}

// In the frames that were looked at, masks from visible sets are those of all triangles.
TEST_P(DynamicTransfer, WithVisibleSetsIsThatOfAllTriangles) {
    Scene scene = test::heap_of_solids(5);
    test::light_by(scene, colour);
    Lit lit(scene, with(GetParam()));
    const auto first = masks_of(lit.solver);
    EXPECT_THROW(lit.solver.sets(), Error);
    lit.solver.look();
    // Another frame: one of the spheres is elsewhere.
    SceneMover mover(test::programs(), test::device().queue, lit.device);
    const std::vector<glm::dvec3> rest(scene.positions.begin() + 4, scene.positions.begin() + 646);
    std::vector<glm::dvec3> moved = rest;
    for (glm::dvec3& position : moved) position += glm::dvec3(0.5, 0.2, 0);
    mover.move(4, moved, {});
    lit.solver.look();
    const VisibleSets sets = lit.solver.sets();
    lit.solver.transfer().wait();
    const auto second = masks_of(lit.solver);
    EXPECT_FALSE(first == second);
    const double before = lit.solver.triangles_per_receiver();
    lit.solver.restrict(sets);
    EXPECT_LT(lit.solver.triangles_per_receiver(), 0.2 * before);
    lit.solver.transfer().wait();
    EXPECT_TRUE(masks_of(lit.solver) == second);
    mover.move(4, rest, {});
    lit.solver.transfer().wait();
    EXPECT_TRUE(masks_of(lit.solver) == first);
    // A search sees everything again; the last one's sets are gone.
    lit.solver.look();
    const VisibleSets now = lit.solver.sets();
    EXPECT_LT(now.near.size(), sets.near.size());
    lit.solver.restrict(now);
    lit.solver.transfer().wait();
    EXPECT_TRUE(masks_of(lit.solver) == first);
    EXPECT_THROW(lit.solver.restrict(VisibleSets{{0, 0}, {}}), Error);
    VisibleSets wrong = now;
    wrong.near[3] = 1u << 30;
    EXPECT_THROW(lit.solver.restrict(wrong), Error);
}

// ---- bad input
// -------------------------------------------------------------------------------------

TEST(DynamicTransferSolver, RefusesWhatItCannotDo) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    const DeviceScene device = test::on_device(scene);
    const auto make = [&](const DynamicTransferOptions& options) {
        DynamicTransferSolver(test::programs(), test::device().queue, scene, device, options);
    };
    DynamicTransferOptions options;
    options.memory_budget = 1000;
    EXPECT_THROW(make(options), DeviceError);
    options = {};
    options.masks.size = 33;
    EXPECT_THROW(make(options), Error);
    options = {};
    options.masks.bands = 10;
    EXPECT_THROW(make(options), Error);
    options = {};
    options.coarse = {{0, 1, 9}};
    EXPECT_THROW(make(options), Error);
    for (const int interreflections : {-1, 2}) {
        options = {};
        options.interreflections = interreflections;
        EXPECT_THROW(make(options), Error);
    }
    Scene other = scene;
    test::add_floor(other, 2.0);
    EXPECT_THROW(DynamicTransferSolver(test::programs(), test::device().queue, other, device),
                 Error);
}

// Nothing to light is no error.
TEST(DynamicTransferSolver, OfAnEmptySceneHasNoReceivers) {
    Scene scene = test::plain_scene();
    test::light_by(scene, colour);
    const Lit lit(scene);
    EXPECT_TRUE(lit.irradiance.empty());
}

}  // namespace
}  // namespace clgi
