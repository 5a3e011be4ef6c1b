// Curves, nodes and poses against closed forms, and what validate() says of broken animation.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/animation.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "gltf_draft.hpp"
#include "posing.hpp"

namespace clgi {
namespace {

const double half = std::sqrt(0.5);
constexpr double exact = 1e-14;  // roundings of doubles
constexpr double of_floats = 1e-7;

Curve curve(Interpolation interpolation, std::uint32_t components, std::vector<float> times,
            std::vector<float> values) {
    return {interpolation, components, std::move(times), std::move(values)};
}

glm::dvec4 turn_at(const Curve& curve, double time) {
    const std::vector<double> q = value_at(curve, time, true);
    return {q[0], q[1], q[2], q[3]};
}

TEST(Curves, HoldTheirFirstAndLastValues) {
    for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
        const Curve c = curve(kind, 1, {1, 3}, {5, 9});
        for (const double time : {-1e9, 0.0, 1.0}) EXPECT_EQ(value_at(c, time)[0], 5.0) << time;
        for (const double time : {3.0, 3.5, 1e9}) EXPECT_EQ(value_at(c, time)[0], 9.0) << time;
    }
    const Curve cubic = curve(Interpolation::cubic, 1, {1, 3}, {7, 5, 7, 7, 9, 7});
    EXPECT_EQ(value_at(cubic, 0.0)[0], 5.0);
    EXPECT_EQ(value_at(cubic, 1.0)[0], 5.0);
    EXPECT_EQ(value_at(cubic, 3.0)[0], 9.0);
    EXPECT_EQ(value_at(cubic, 4.0)[0], 9.0);
    EXPECT_EQ(value_at(curve(Interpolation::linear, 1, {2}, {6}), 1.0)[0], 6.0);
    EXPECT_EQ(value_at(curve(Interpolation::linear, 1, {2}, {6}), 3.0)[0], 6.0);
}

TEST(Curves, StepsAtTheKeyItself) {
    const Curve c = curve(Interpolation::step, 1, {0, 1, 2}, {5, 6, 7});
    EXPECT_EQ(value_at(c, std::nextafter(1.0, 0.0))[0], 5.0);
    EXPECT_EQ(value_at(c, 1.0)[0], 6.0);
    EXPECT_EQ(value_at(c, 1.999)[0], 6.0);
    EXPECT_EQ(value_at(c, 2.0)[0], 7.0);
}

TEST(Curves, InterpolateLinearly) {
    const Curve c = curve(Interpolation::linear, 2, {0, 2, 3}, {1, 10, 5, 20, 7, 0});
    EXPECT_NEAR(value_at(c, 0.5)[0], 2.0, exact);
    EXPECT_NEAR(value_at(c, 0.5)[1], 12.5, exact);
    EXPECT_NEAR(value_at(c, 2.25)[0], 5.5, exact);
    EXPECT_NEAR(value_at(c, 2.25)[1], 15.0, exact);
}

// t^3 from 1 to 3 has the tangents 3 and 27, and is its own cubic.
TEST(Curves, CubicOnesAreHermite) {
    const Curve c = curve(Interpolation::cubic, 1, {1, 3}, {-50, 1, 3, 27, 27, -50});
    for (const double time : {1.25, 2.0, 2.9})
        EXPECT_NEAR(value_at(c, time)[0], time * time * time, 1e-13);
}

TEST(Curves, CubicRotationsAreMadeUnit) {
    const Curve c = curve(Interpolation::cubic, 4, {0, 1},
                          {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0});
    EXPECT_VEC_NEAR(turn_at(c, 0.5), glm::dvec4(half, 0, 0, half), exact);
}

TEST(Curves, RotationsTakeTheShortWayAtEvenSpeed) {
    const double eighth = 0.125 * M_PI;
    for (const float sign : {1.0f, -1.0f}) {
        const auto h = static_cast<float>(half) * sign;
        // A quarter turn about z; negated it is the same turn, the long way around.
        const Curve c = curve(Interpolation::linear, 4, {0, 1}, {0, 0, 0, 1, 0, 0, h, h});
        const glm::dvec4 q = turn_at(c, 0.5);
        EXPECT_NEAR(std::abs(q.z), std::sin(eighth), of_floats);
        EXPECT_NEAR(std::abs(q.w), std::cos(eighth), of_floats);
        EXPECT_GT(q.z * q.w, 0.0);
        const glm::dvec4 third = turn_at(c, 1.0 / 3.0);
        EXPECT_NEAR(std::abs(third.z), std::sin(eighth * 2.0 / 3.0), of_floats);
    }
    // Nearly equal and opposite ones stay rotations.
    for (const float w : {1.0f, -1.0f}) {
        const glm::dvec4 q =
            turn_at(curve(Interpolation::linear, 4, {0, 1}, {0, 0, 0, 1, 0, 1e-9f, 0, w}), 0.3);
        EXPECT_NEAR(glm::length(q), 1.0, exact);
        EXPECT_NEAR(std::abs(q.w), 1.0, exact);
    }
    const glm::dvec4 none =
        turn_at(curve(Interpolation::linear, 4, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 0}), 0.3);
    EXPECT_EQ(none, glm::dvec4(0, 0, 0, 1));
}

TEST(Poses, ChannelsReplaceWhatTheyDriveAndParentsCarryChildren) {
    Animation a;
    a.nodes.resize(2);
    a.nodes[0].translation = {1, 2, 3};
    a.nodes[0].scale = {2, 2, 2};
    a.nodes[1].parent = 0;
    a.nodes[1].translation = {1, 0, 0};
    a.weights = {0.25};
    a.nodes[1].weight_count = 1;
    a.clips.resize(1);
    a.clips[0].curves = {curve(Interpolation::linear, 3, {0, 1}, {0, 0, 0, 10, 0, 0}),
                         curve(Interpolation::linear, 1, {0, 1}, {0, 1}),
                         curve(Interpolation::step, 4, {0}, {0, 0, 1, 0})};
    a.clips[0].channels = {{ChannelTarget::translation, 1, 0},
                           {ChannelTarget::weights, 1, 1},
                           {ChannelTarget::rotation, 0, 2}};
    EXPECT_EQ(glm::dvec3(rest_pose(a).matrices[1][3]), glm::dvec3(3, 2, 3));
    EXPECT_EQ(rest_pose(a).weights[0], 0.25);
    const Pose pose = pose_at(a, 0, 0.3);
    // Half a turn about z, then doubled and moved: 3 becomes -6.
    EXPECT_VEC_NEAR(pose.matrices[1][3], glm::dvec4(-5, 2, 3, 1), 1e-13);
    EXPECT_NEAR(pose.weights[0], 0.3, exact);
    EXPECT_THROW(pose_at(a, 1, 0.0), Error);
    EXPECT_THROW(pose_at(a, 0, NAN), Error);
}

TEST(Poses, ClipsAreFoundByNameBeforeIndex) {
    Animation a;
    EXPECT_THROW(find_clip(a, ""), Error);
    a.clips.resize(3);
    a.clips[0].name = "walk";
    a.clips[1].name = "0";
    a.clips[2].name = "walk";
    EXPECT_EQ(find_clip(a, ""), 0u);
    EXPECT_EQ(find_clip(a, "walk"), 0u);
    EXPECT_EQ(find_clip(a, "0"), 1u);
    EXPECT_EQ(find_clip(a, "2"), 2u);
    for (const char* none : {"3", "-1", "run", "1x", "99999999999999999999"}) {
        try {
            find_clip(a, none);
            ADD_FAILURE() << none;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()), "animation: '" + std::string(none) +
                                                     "' was asked for, there are 0 'walk', 1 '0', "
                                                     "2 'walk'");
        }
    }
}

TEST(Poses, AreRefusedForOtherScenes) {
    const Scene scene = test::bent_strip();
    EXPECT_THROW(posed(Scene(), Pose()), Error);
    EXPECT_THROW(posed(scene, Pose()), Error);
    Pose far = rest_pose(*scene.animation);
    far.matrices[1] *= 1e30;
    EXPECT_THROW(posed(scene, far), InputError);
}

std::string said(const Scene& scene) {
    try {
        validate(scene);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

TEST(ValidateAnimation, NamesWhatIsWrong) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Scene sound = test::bent_strip();
    EXPECT_EQ(said(sound), "");
    const std::vector<std::pair<std::string, std::function<void(Animation&)>>> cases = {
        {"node 1 has parent 1", [](Animation& a) { a.nodes[1].parent = 1; }},
        {"node 0 has parent -2", [](Animation& a) { a.nodes[0].parent = -2; }},
        {"node 1 has a transform", [](Animation& a) { a.nodes[1].scale.y = NAN; }},
        {"node 1 has a transform", [](Animation& a) { a.nodes[1].rotation.w = INFINITY; }},
        {"node 1 reads 9 weights", [](Animation& a) { a.nodes[1].weight_count = 9; }},
        {"weight 0 is not finite", [](Animation& a) { a.weights[0] = NAN; }},
        {"has no keys", [](Animation& a) { a.clips[0].curves[0].times.clear(); }},
        {"numbers, ", [](Animation& a) { a.clips[0].curves[0].values.pop_back(); }},
        {"do not rise at key 1", [](Animation& a) { a.clips[0].curves[0].times[1] = 0.0f; }},
        {"do not rise at key 0", [&](Animation& a) { a.clips[0].curves[0].times[0] = nan; }},
        {"values that are not finite", [&](Animation& a) { a.clips[0].curves[0].values[2] = nan; }},
        {"names node 99", [](Animation& a) { a.clips[0].channels[0].node = 99; }},
        {"names curve 99", [](Animation& a) { a.clips[0].channels[0].curve = 99; }},
        {"4 components, 3 needed",
         [](Animation& a) { a.clips[0].channels[0].target = ChannelTarget::scale; }},
        {"1 inverse bind matrices for 2",
         [](Animation& a) { a.skins[0].inverse_binds.pop_back(); }},
        {"skin 0 names node 99", [](Animation& a) { a.skins[0].joints[1] = 99; }},
        {"inverse bind matrix that", [](Animation& a) { a.skins[0].inverse_binds[1][2][1] = NAN; }},
        {"names skin 7", [](Animation& a) { a.ranges[0].skin = 7; }},
        {"influences, but no skin", [](Animation& a) { a.ranges[0].skin = -1; }},
        {"names joint 3", [](Animation& a) { a.influences[0].joint = 3; }},
        {"a weight below 0", [](Animation& a) { a.influences[0].weight = -0.5f; }},
        {"that sum to 1.5", [](Animation& a) { a.influences[0].weight += 0.5f; }},
        {"vertices from", [](Animation& a) { a.ranges[0].vertex_count = 100; }},
        {"rest positions from", [](Animation& a) { a.ranges[0].first_rest = 1; }},
        {"rest normals from", [](Animation& a) { a.rest_normals.pop_back(); }},
        {"names part 5", [](Animation& a) { a.ranges[0].part = 5; }},
        {"does not have all vertices",
         [](Animation& a) {
             a.ranges[0].first_vertex = 1;
             a.ranges[0].vertex_count = 4;
         }},
        {"range 0 is flat, and two corners use vertex 1",
         [](Animation& a) { a.ranges[0].flat = true; }},
        {"2 morph targets, its node 1", [](Animation& a) { a.ranges[0].target_count = 2; }},
        {"differences from", [](Animation& a) { a.differences.pop_back(); }},
        {"centre that is not finite", [](Animation& a) { a.ranges[0].centre.x = NAN; }},
        {"rest position 2 is", [&](Animation& a) { a.rest_positions[2].y = nan; }},
        {"rest normal 2 is", [&](Animation& a) { a.rest_normals[2].y = nan; }},
        {"difference 2 is", [&](Animation& a) { a.differences[2].y = nan; }},
        {"begins before", [](Animation& a) { a.ranges.push_back(a.ranges[0]); }},
        {"names light 0",
         [](Animation& a) {
             a.lights.push_back({0, 0});
         }},
        {"names camera 0",
         [](Animation& a) {
             a.cameras.push_back({0, 0});
         }},
        {"names node 9", [](Animation& a) { a.ranges[0].node = 9; }}};
    for (const auto& [words, spoil] : cases) {
        Scene scene = sound;
        spoil(*scene.animation);
        EXPECT_NE(said(scene).find(words), std::string::npos) << words << ": " << said(scene);
        EXPECT_EQ(said(scene).find("animation: "), 0u) << said(scene);
        EXPECT_EQ(said(scene).find('\n'), std::string::npos);
    }
    Scene scene = sound;
    scene.moving_bounds = Bounds{glm::dvec3(1), glm::dvec3(0)};
    EXPECT_NE(said(scene), "");
    scene.moving_bounds = Bounds{glm::dvec3(0), glm::dvec3(NAN)};
    EXPECT_NE(said(scene), "");
}

}  // namespace
}  // namespace clgi
