// The solver as a whole: direct light in the leaves, closed rooms, the sky.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <numbers>

#include "device.hpp"
#include "math_modes.hpp"
#include "rooms.hpp"
#include "solved_antiradiance.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_ALL_MODES(AntiradianceLight);
CLGI_IN_ALL_MODES(AntiradianceEffects);

using test::options_of;
using test::power;
using test::Solved;

// Each leaf reflects the mean direct light of its four sample points, from the side that it is on.
// fronts, backs: what is reflected by each triangle of the scene.
void expect_direct_light(const Scene& scene, const test::Build& build,
                         const std::vector<glm::dvec3>& fronts,
                         const std::vector<glm::dvec3>& backs) {
    const Solved solved(scene, options_of(build, 32, 60));
    const ElementTree& tree = solved.solver.elements();
    int lit = 0, dark = 0;
    for (std::size_t row = 0; row < solved.count(); ++row) {
        const std::uint32_t i = solved.element(row);
        const glm::dvec3 albedo = (tree.backs[i] ? backs : fronts)[tree.triangles[i]];
        const auto& [a, b, c] = tree.corners[i];
        glm::dvec3 wanted(0.0);
        for (const glm::dvec3& at : {(a + b + c) / 3.0, (4.0 * a + b + c) / 6.0,
                                     (a + 4.0 * b + c) / 6.0, (a + b + 4.0 * c) / 6.0})
            for (const Light& light : scene.lights) {
                const glm::dvec3 to = light.position - at;
                const double cosine = glm::dot(tree.normals[i], glm::normalize(to));
                if (cosine > 0.0)
                    wanted += 0.25 / pi * albedo * glm::dvec3(light.intensity) * cosine /
                              glm::dot(to, to);
            }
        const glm::dvec3 found = solved.exposure() * glm::dvec3(solved.sources()[row]);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(found[k], wanted[k], 1e-4 * wanted[k] + 1e-6) << row;
            EXPECT_NEAR(solved.reflectances()[row][k], albedo[k], 1e-6);
        }
        ++(wanted.x > 0.0 ? lit : dark);
    }
    EXPECT_GT(lit, 20);
    EXPECT_EQ(dark > 10, backs.size() > 1);
}

TEST_P(AntiradianceLight, ReflectsDirectLight) {
    const glm::dvec3 both(0.7, 0.5, 0.2), one(0.3, 0.4, 0.9), metal(0.8, 0.6, 0.5), none(0.0);
    Scene scene = test::plain_scene(glm::vec3(both));
    scene.materials[0].double_sided = true;
    const glm::dvec3 across(1.0, 0.3, 0.0), along(-0.2, 0.1, 1.1);
    test::add_triangle(scene, {0, 0, 0}, along, across);
    const glm::dvec3 above(0.3, 0.9, 0.4), below(0.4, -0.8, 0.6);
    scene.lights = {test::point_light(above), test::point_light(below)};
    scene.lights[0].intensity = {5.0f, 7.0f, 11.0f};
    // Its last sample point is one of a back that reflects.
    expect_direct_light(scene, GetParam(), {both}, {both});

    Material one_sided;
    one_sided.base_color = glm::vec4(glm::vec3(one), 1.0f);
    Material rough_metal;  // a part of what a metal reflects is diffuse
    rough_metal.base_color = glm::vec4(glm::vec3(metal), 1.0f);
    rough_metal.metallic = 1.0f;
    rough_metal.roughness = 0.5f;
    for (const Material& material : {one_sided, rough_metal}) {
        const glm::dvec3 at(4.5 * static_cast<double>(scene.triangles.size()), 0.0, 0.0);
        test::add_triangle(scene, at, at + along, at + across, test::add_material(scene, material));
    }
    scene.lights[1].position.x = 9.2;
    expect_direct_light(scene, GetParam(),
                        {both, one, double{reflectance(rough_metal).diffuse} * metal},
                        {both, none, none});
}

// In a closed room the light that arrives over links is rho / (1 - rho) of the direct light, all
// leaves together, whatever stands in it.
TEST_P(AntiradianceLight, KeepsTheEnergyOfClosedRooms) {
    for (const double albedo : {0.3, 0.7}) {
        if (GetParam().storage == Storage::half && albedo < 0.5) continue;  // one shows it
        Scene scene = test::plain_scene(glm::vec3(static_cast<float>(albedo)));
        test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
        scene.lights = {test::point_light({0.5, 0.6, 0.4})};
        scene.lights[0].intensity = {1.0f, 2.0f, 3.0f};
        const Solved solved(scene, options_of(GetParam(), 512, 3000));
        const AntiradianceStatus status = solved.solver.status();
        EXPECT_TRUE(status.converged);
        EXPECT_FALSE(status.diverged);
        EXPECT_EQ(status.non_finite, 0u);
        const glm::dvec3 found = power(solved);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], 4.0 * pi * (c + 1) * albedo / (1.0 - albedo),
                        0.02 * 4.0 * pi * (c + 1) * albedo / (1.0 - albedo))
                << albedo;
    }
}

// Where nothing can lie between, nothing lets light through: no link reads a row, so there is none.
// With a box in the room, its sides and what stands for them send to what lies behind.
TEST_P(AntiradianceEffects, KeepsNoRowsOfWhatHasNothingBehindIt) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    scene.lights = {test::point_light({0.5, 0.6, 0.4})};
    const Solved empty(scene, options_of(GetParam(), 128, 2000));
    EXPECT_EQ(empty.solver.links().row_count, 0u);
    test::add_box(scene, {0.3, 0.0, 0.3}, {0.7, 0.4, 0.8}, 1);
    const Solved furnished(scene, options_of(GetParam(), 128, 2000));
    const std::uint32_t rows = furnished.solver.links().row_count;
    std::uint32_t of_box = 0;
    const ElementTree& tree = furnished.solver.elements();
    for (std::size_t i = 0; i < tree.count(); ++i)
        of_box += tree.is_leaf(i) && tree.triangles[i] >= 12;
    EXPECT_GE(rows, of_box);
    EXPECT_LT(rows, tree.count());
}

// Nothing stands in the sky's way: a surface of any tilt, and its back, receive pi L of a sky of
// one colour, and of a sky that is bright above what the cosine makes of it.
TEST_P(AntiradianceLight, ReceivesTheSky) {
    Scene scene = test::plain_scene(glm::vec3(0.0f));
    scene.materials[0].double_sided = true;
    test::add_triangle(scene, {0, 0, 0}, {0.2, 0.4, 1.0}, {1.0, 0.3, 0.1});
    scene.environment = Environment();
    scene.environment->factor = {2.0f, 3.0f, 5.0f};
    const Solved even(scene, options_of(GetParam(), 128, 8));
    for (const glm::vec4& e : even.irradiances())
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(even.exposure() * e[c], pi * scene.environment->factor[c], 1e-4);

    scene.environment->width = 1;
    scene.environment->height = 2;  // the upper half is green, the lower one blue
    scene.environment->texels = {{0, 1, 0}, {0, 0, 1}};
    const Solved halves(scene, options_of(GetParam(), 2048, 8));
    for (std::size_t row = 0; row < halves.count(); ++row) {
        const double up = halves.solver.elements().normals[halves.element(row)].y;
        const glm::dvec3 e = halves.exposure() * glm::dvec3(halves.irradiances()[row]);
        EXPECT_NEAR(e.x, 0.0, 1e-6);
        EXPECT_NEAR(e.y, 3.0 * pi * 0.5 * (1.0 + up), 0.03);
        EXPECT_NEAR(e.z, 5.0 * pi * 0.5 * (1.0 - up), 0.05);
    }
}

TEST(AntiradianceSolver, FollowsItsLights) {
    Scene scene = test::furnished_room(5);
    AntiradianceOptions options = options_of(Math::strict, 32, 600);
    options.steps = 12;
    Solved solved(scene, options);
    const auto before = solved.irradiances();
    Light light = scene.lights[0];
    light.intensity *= 2.0f;
    solved.scene.set_light(0, light);
    solved.solver.lights_changed();
    EXPECT_TRUE(solved.solver.run());
    const auto after = solved.irradiances();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], 2.0f * before[i]);
    EXPECT_EQ(solved.solver.status().residuals.size(), 12u);
}

TEST(AntiradianceSolver, GivesTheSameBitsInEveryGroupAndAFewInHalf) {
    const Scene scene = test::furnished_room(5);
    AntiradianceOptions options = options_of(Math::strict, 64, 800);
    options.steps = 10;
    const auto wanted = Solved(scene, options).irradiances();
    for (const std::size_t size : {std::size_t{1}, std::size_t{7}}) {
        options.build.local_size = size;
        EXPECT_EQ(Solved(scene, options).irradiances(), wanted) << size;
    }
    options.build.storage = Storage::half;
    const auto half = Solved(scene, options).irradiances();
    double most = 0.0;
    for (const glm::vec4& e : wanted) most = std::max(most, double(e.x));
    for (std::size_t i = 0; i < half.size(); ++i) EXPECT_NEAR(half[i].x, wanted[i].x, 5e-3 * most);
}

// Models of millimetres and of a kilometre, in half storage too: a power of two changes no bit.
TEST(AntiradianceSolver, GivesTheSameBitsAtEveryScale) {
    AntiradianceOptions options = options_of(Math::strict, 64, 500);
    options.steps = 10;
    options.build.storage = Storage::half;
    const auto wanted = Solved(test::furnished_room(5), options).irradiances();
    EXPECT_GT(wanted[0].x, 0.0f);
    for (const double scale : {0x1p-8, 0x1p8}) {
        Scene scene = test::furnished_room(5);
        for (glm::dvec3& position : scene.positions) position *= scale;
        scene.lights[0].position *= scale;
        scene.lights[0].intensity *= static_cast<float>(scale * scale);
        EXPECT_EQ(Solved(scene, options).irradiances(), wanted) << scale;
    }
}

// One triangle that is one element, and nothing that could light it.
TEST_P(AntiradianceEffects, LightsASingleElement) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    scene.environment = Environment();
    AntiradianceOptions options = options_of(GetParam(), 64, 1);
    options.elements.backs = false;
    options.elements.max_area = 10.0;
    const Solved solved(scene, options);
    ASSERT_EQ(solved.count(), 1u);
    EXPECT_NEAR(solved.exposure() * solved.irradiances()[0].x, pi, 1e-5);
}

TEST(AntiradianceSolver, RefusesWhatItCannotDo) {
    const Scene scene = test::furnished_room(5);
    const auto refused = [&](auto&& change) {
        AntiradianceOptions options = options_of(Math::strict, 32, 300);
        change(options);
        EXPECT_THROW(Solved(scene, options, false), Error);
    };
    refused([](AntiradianceOptions& o) { o.bins = 31; });
    refused([](AntiradianceOptions& o) { o.steps = -1; });
    refused([](AntiradianceOptions& o) { o.most_steps = 0; });
    refused([](AntiradianceOptions& o) { o.through_steps = -1; });
    refused([](AntiradianceOptions& o) { o.through_steps = 1001; });
    refused([](AntiradianceOptions& o) { o.residual = std::nan(""); });
    for (const double least : {-0.1, 1.1, std::nan("")})
        refused([&](AntiradianceOptions& o) { o.least_gloss = least; });
    refused([](AntiradianceOptions& o) { o.links.bin_share = 0.0; });
    refused([](AntiradianceOptions& o) { o.elements.requested = 0; });
    AntiradianceOptions small = options_of(Math::strict, 32, 300);
    small.memory_budget = 1000;
    EXPECT_THROW(Solved(scene, small, false), DeviceError);
    Scene empty = test::plain_scene();
    EXPECT_THROW(Solved(empty, options_of(Math::strict, 32, 300), false), Error);
}

}  // namespace
}  // namespace clgi
