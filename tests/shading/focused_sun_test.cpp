// The sun's shadows in a scene thousands of times as large as what is looked at.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/renderer.hpp>
#include <cmath>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

const glm::dvec3 sunlight = glm::normalize(glm::dvec3(0.4, -1.0, 0.3));

// A plate of a quarter of a metre above a plain of 4 km, and one of 300 m far away.
Scene plain() {
    Scene scene = test::plain_scene({0.8f, 0.6f, 0.4f});
    scene.materials[0].double_sided = true;
    test::add_floor(scene, 4000.0);
    const auto add_plate = [&](const glm::dvec3& at, double half) {
        test::add_quad(scene, {at + glm::dvec3(-half, 0, half), at + glm::dvec3(half, 0, half),
                               at + glm::dvec3(half, 0, -half), at + glm::dvec3(-half, 0, -half)});
    };
    add_plate({0.1, 0.5, -0.2}, 0.125);
    add_plate({-1500.0, 100.0, 800.0}, 150.0);
    scene.focus = Focus{{0.0, 0.0, 0.0}, 2.0};
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = glm::vec3(sunlight);
    sun.intensity = {3.0f, 4.0f, 5.0f};
    scene.lights = {sun};
    return scene;
}

// How far outside the shadow of a plate a place on the floor lies; inside: negative. Metres.
double outside(const glm::dvec3& place, const glm::dvec3& plate, double half) {
    const glm::dvec3 cast = plate - sunlight * (plate.y / sunlight.y);
    return std::max(std::abs(place.x - cast.x), std::abs(place.z - cast.z)) - half;
}

constexpr int side = 96;  // pixels of pictures

RendererOptions direct_light(int shadow_size) {
    RendererOptions out;
    out.method = Method::direct;
    out.picture.width = out.picture.height = side;
    out.picture.emitters.shadow_size = shadow_size;
    out.picture.build = test::usual_build();
    return out;
}

struct Judged {
    int lit = 0, dark = 0, wrong = 0;
};

// Looks straight down on a square of the floor. least: distances to the shadow's edge that count.
Judged judge(Renderer& renderer, const glm::dvec3& middle, double across, const glm::dvec3& plate,
             double half, double least) {
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    camera.position = middle + glm::dvec3(0.0, 0.2 * plate.y, 0.0);  // below the plate
    camera.forward = {0, -1, 0};
    camera.right = {1, 0, 0};
    camera.up = {0, 0, -1};
    camera.half_height = static_cast<float>(0.5 * across);
    renderer.render(camera);
    const auto found = renderer.read_radiance();
    Judged out;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::dvec3 place =
                middle + across * glm::dvec3((x + 0.5) / side - 0.5, 0.0, (y + 0.5) / side - 0.5);
            const double away = outside(place, plate, half);
            if (std::abs(away) < least) continue;
            (away > 0.0 ? out.lit : out.dark) += 1;
            for (int c = 0; c < 3; ++c) {
                const double wanted = away < 0.0
                                          ? 0.0
                                          : std::array{0.8, 0.6, 0.4}[static_cast<std::size_t>(c)] /
                                                3.14159265 * (3.0 + c) * -sunlight.y;
                const float is =
                    found[static_cast<std::size_t>(c)][static_cast<std::size_t>(y * side + x)];
                if (std::abs(double{is} - wanted) > 1e-3 * (3.0 + c)) {
                    ++out.wrong;
                    break;
                }
            }
        }
    return out;
}

TEST(FocusedSun, HasSharpShadowsWhereThePictureLooksAndCoarseOnesElsewhere) {
    const RendererOptions options = direct_light(512);
    const Scene scene = plain();
    DeviceScene placed = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, placed, options);
    // Texels of 8 mm over 4 m.
    const glm::dvec3 small(0.1, 0.5, -0.2);
    const glm::dvec3 cast = small - sunlight * (small.y / sunlight.y);
    const Judged near = judge(renderer, cast, 0.6, small, 0.125, 0.02);
    EXPECT_GT(near.lit, 3000);
    EXPECT_GT(near.dark, 800);
    EXPECT_EQ(near.wrong, 0);
    // Of 22 m over 11 km.
    const glm::dvec3 large(-1500.0, 100.0, 800.0);
    const glm::dvec3 far = large - sunlight * (large.y / sunlight.y);
    const Judged coarse = judge(renderer, far, 700.0, large, 150.0, 60.0);
    EXPECT_GT(coarse.lit, 2000);
    EXPECT_GT(coarse.dark, 300);
    EXPECT_EQ(coarse.wrong, 0);
}

// Where the first map ends the other goes on, to all sides: shadows that lie across its edges.
TEST(FocusedSun, HasNoSeamBetweenItsMaps) {
    constexpr double half = 1.0, height = 1.5;
    const auto scene_of = [&](const glm::dvec3& cast) {
        Scene scene = plain();
        scene.positions.clear();
        scene.normals.clear();
        scene.triangles.clear();
        test::add_floor(scene, 30.0);
        const glm::dvec3 at = cast + sunlight * (height / sunlight.y);
        test::add_quad(scene, {at + glm::dvec3(-half, 0, half), at + glm::dvec3(half, 0, half),
                               at + glm::dvec3(half, 0, -half), at + glm::dvec3(-half, 0, -half)});
        return scene;
    };
    const EmitterSet set = make_emitters(test::on_device(scene_of(glm::dvec3(0.0))), {});
    ASSERT_EQ(set.views.size(), 2u);
    const glm::dvec3 right(set.views[0].right), up(set.views[0].up);
    const glm::dmat2 on_map(right.x, up.x, right.z, up.z);  // of x and z of the floor
    for (const glm::dvec2& place :
         {glm::dvec2(2.1, 0.0), {-2.1, 0.0}, {0.0, 2.1}, {0.0, -2.1}, {0.0, 0.0}}) {
        const glm::dvec2 floor = glm::inverse(on_map) * place;
        const glm::dvec3 cast(floor.x, 0.0, floor.y);
        const Scene scene = scene_of(cast);
        DeviceScene placed = test::on_device(scene);
        Renderer renderer(test::programs(), test::device().queue, scene, placed, direct_light(512));
        const glm::dvec3 plate = cast + sunlight * (height / sunlight.y);
        const Judged seen = judge(renderer, cast, 5.0, plate, half, 0.45);  // texels of 17 cm
        EXPECT_GT(seen.lit, 3000) << place.x << ", " << place.y;
        EXPECT_GT(seen.dark, 300) << place.x << ", " << place.y;
        EXPECT_EQ(seen.wrong, 0) << place.x << ", " << place.y;
    }
}

TEST(FocusedSun, HasOneMapWhereTheFocusIsMostOfTheScene) {
    Scene scene = plain();
    const EmitterOptions options{.shadow_size = 32};
    EXPECT_EQ(make_emitters(test::on_device(scene), options).views.size(), 2u);
    scene.focus->radius = 5000.0;
    EXPECT_EQ(make_emitters(test::on_device(scene), options).views.size(), 1u);
    scene.focus.reset();
    EXPECT_EQ(make_emitters(test::on_device(scene), options).views.size(), 1u);
}

}  // namespace
}  // namespace clgi
