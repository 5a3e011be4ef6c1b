// What a picture reaches of a scene: rooms beside rooms, and what they are lit by.
// SPDX-License-Identifier: MIT
#include "plan/reach.hpp"

#include <gtest/gtest.h>
#include <clgi/device_scene.hpp>
#include <clgi/plan.hpp>

#include "device.hpp"
#include "frames.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// What the scene's first camera reaches.
Reach reached(const Scene& scene) {
    return reach_of(scene, LocalScene(scene), scene.cameras.at(0), 160, 120);
}

// A closed box of 4 x 3 x 5 m, a lamp of half a square metre in it.
void add_room(Scene& scene, const glm::dvec3& low, std::uint32_t glows) {
    test::add_box(scene, low, low + glm::dvec3(4, 3, 5), -1);
    const glm::dvec3 a = low + glm::dvec3(1.5, 2.9, 2.0);
    test::add_quad(
        scene, {a, a + glm::dvec3(1, 0, 0), a + glm::dvec3(1, 0, 0.5), a + glm::dvec3(0, 0, 0.5)},
        glows);
}

Scene rooms(int count) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    Material lamp;
    lamp.emission = {5.0f, 4.0f, 3.0f};
    const std::uint32_t glows = test::add_material(scene, lamp);
    for (int k = 0; k < count; ++k) add_room(scene, {10.0 * k, 0, 0}, glows);
    scene.cameras = {test::camera_at({0.5, 1.5, 4.5}, {2, 1.2, 0}, 1.0f)};
    return scene;
}

TEST(Reach, IsTheWholeOfARoom) {
    const Scene scene = rooms(1);
    const Reach found = reached(scene);
    EXPECT_GT(found.points, 100u);
    EXPECT_NEAR(found.area, 1.0, 0.1);
    EXPECT_DOUBLE_EQ(found.power, 1.0);
    EXPECT_NEAR(found.emissive_area, 0.5, 1e-5);
    EXPECT_LT(found.hidden, 0.1);
    EXPECT_GT(found.size, 0.5);
    const glm::dvec3 middle(2.0, 1.5, 2.5);
    EXPECT_LT(glm::distance(found.sphere.centre, middle), 1.0);
    EXPECT_GT(found.sphere.radius, 1.5);
    EXPECT_LT(found.sphere.radius, 4.0);
}

// A wall in front of the camera, and one through which a ramp leads away: a quarter of the depths
// of what is shown lies below the first quartile.
TEST(Reach, KnowsWhatAPixelCovers) {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {{{-9, -9, -3}, {9, -9, -3}, {9, 9, -3}, {-9, 9, -3}}});
    test::add_quad(scene, {{{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}}});  // behind
    Camera camera = test::camera_at({0.2, 0.1, 1.0}, {0.2, 0.1, 0.0}, 0.8f);
    scene.cameras = {camera};
    EXPECT_NEAR(reached(scene).pixel, 2.0 * std::tan(0.4) * 4.0 / 120, 1e-5);
    scene.cameras[0].kind = Camera::Kind::orthographic;
    scene.cameras[0].half_height = 1.5f;
    EXPECT_NEAR(reached(scene).pixel, 3.0 / 120, 1e-6);
    // Depth grows across the picture from 2 to 4: a quarter is less than 2.5.
    scene.cameras = {camera};
    scene.positions.clear();
    scene.normals.clear();
    scene.triangles.clear();
    const double half = std::tan(0.4) * 4.0 / 3.0;  // of the window, at depth 1
    test::add_quad(scene, {{{0.2 - 2 * half, -9, -1},
                            {0.2 + 4 * half, -9, -3},
                            {0.2 + 4 * half, 9, -3},
                            {0.2 - 2 * half, 9, -1}}});
    EXPECT_NEAR(reached(scene).pixel, 2.0 * std::tan(0.4) * 2.29 / 120, 4e-4);
}

// Half of a wall is glossy, and all that lies behind the camera.
TEST(Reach, KnowsHowGlossyWhatIsShownIs) {
    Scene scene = test::plain_scene({0.5f, 0.25f, 0.75f});
    Material metal;
    metal.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
    metal.metallic = 0.7f;
    metal.roughness = 0.4f;
    const std::uint32_t shiny = test::add_material(scene, metal);
    test::add_quad(scene, {{{-9, -9, -3}, {0, -9, -3}, {0, 9, -3}, {-9, 9, -3}}}, shiny);
    test::add_quad(scene, {{{0, -9, -3}, {9, -9, -3}, {9, 9, -3}, {0, 9, -3}}});
    test::add_quad(scene, {{{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}}}, shiny);
    scene.cameras = {test::camera_at({0, 0, 0}, {0, 0, -1}, 0.8f)};
    const Reflectance shares = reflectance(metal);
    const double base = 0.2126 * 0.9 + 0.7152 * 0.6 + 0.0722 * 0.3;
    const double gloss = base * double{shares.lobe} + double{shares.coat};
    const double wanted = gloss / (gloss + base * double{shares.diffuse});
    EXPECT_NEAR(reached(scene).gloss, wanted * std::sqrt(0.5), 0.02 * wanted);
    for (SceneTriangle& triangle : scene.triangles) triangle.material = 0;
    EXPECT_EQ(reached(scene).gloss, 0.0);
}

// The cone of the widest spot that shines, where the picture is.
TEST(Reach, KnowsWhatSpotsCover) {
    Scene scene = rooms(1);
    EXPECT_EQ(reached(scene).cone, 0.0);
    const glm::dvec3 centre = reached(scene).sphere.centre;
    scene.lights = {test::spot_light(centre + glm::dvec3(0, 1.2, 0), {0, -1, 0}, 0.5, 3.0f),
                    test::spot_light(centre + glm::dvec3(0, 0, 2), {0, 0, -1}, 0.4, 3.0f),
                    test::spot_light(centre + glm::dvec3(0, 0, 2), {0, 0, -1}, 1.0, 0.0f),
                    test::point_light(centre + glm::dvec3(1, 0, 0), 5.0f)};
    EXPECT_NEAR(reached(scene).cone, 2.0 * 2.0 * std::tan(0.4), 1e-4);
    scene.lights[0].outer_angle = 1.5f;  // nearly a half-space
    EXPECT_NEAR(reached(scene).cone, 2.0 * 1.2 * std::tan(1.3), 1e-4);
}

// Walls with outer sides are closed from within, wherever the room stands. Where two large walls
// meet, half of what each sees is the other.
TEST(Reach, KnowsHowOpenItIs) {
    Scene room = rooms(1);
    test::add_box(room, glm::dvec3(-0.1), glm::dvec3(4.1, 3.1, 5.1), 1);
    EXPECT_GT(scene_analysis(room).openness, 0.3);
    EXPECT_EQ(reached(room).open, 0.0);
    test::add_quad(room, {{{-50, -1, 50}, {50, -1, 50}, {50, -1, -50}, {-50, -1, -50}}});
    EXPECT_EQ(reached(room).open, 0.0);

    Scene corner = test::plain_scene({0.5f, 0.5f, 0.5f});
    test::add_quad(corner, {{{-900, 0, 0}, {-900, 0, 900}, {900, 0, 900}, {900, 0, 0}}});
    test::add_quad(corner, {{{-900, 0, 0}, {900, 0, 0}, {900, 900, 0}, {-900, 900, 0}}});
    corner.cameras = {test::camera_at({0, 1, 1}, {0, 0, 0}, 0.5f)};
    EXPECT_NEAR(reached(corner).open, 0.5, 0.06);
    corner.triangles.resize(2);  // the floor alone
    corner.cameras = {test::camera_at({0, 1, 1}, {0, 0, 1.5}, 0.5f)};
    EXPECT_EQ(reached(corner).open, 1.0);
}

// Of twenty equal rooms, one: a twentieth of area and power; the sphere is that of the room alone.
TEST(Reach, IsOneRoomOfMany) {
    const Scene one = rooms(1), many = rooms(20);
    const Reach alone = reached(one);
    const Reach found = reached(many);
    EXPECT_NEAR(found.area, 0.05, 0.03);
    EXPECT_NEAR(found.power, 0.05, 1e-3);
    EXPECT_NEAR(found.emissive_area, 0.5, 1e-5);
    EXPECT_NEAR(found.sphere.radius, alone.sphere.radius, 1e-3);
    EXPECT_LT(glm::distance(found.sphere.centre, alone.sphere.centre), 1e-3);
    EXPECT_LT(found.size, 0.1);
    EXPECT_FALSE(focus_of(one, one.cameras[0], 160, 120));
    const std::optional<Focus> focus = focus_of(many, many.cameras[0], 160, 120);
    ASSERT_TRUE(focus);
    EXPECT_NEAR(focus->radius, 2.0 * alone.sphere.radius, 2e-3);
    EXPECT_LT(glm::distance(focus->centre, alone.sphere.centre), 1e-3);
}

TEST(Reach, SaysWhichLampsNothingSees) {
    Scene scene = rooms(1);
    // A second lamp of the same size in a closed case within the room.
    test::add_box(scene, {3.0, 0.1, 0.5}, {3.9, 0.6, 1.3}, 1);
    const glm::dvec3 a(3.1, 0.3, 0.6);
    test::add_quad(scene,
                   {a, a + glm::dvec3(0.7, 0, 0), a + glm::dvec3(0.7, 0, 0.5 / 0.7),
                    a + glm::dvec3(0, 0, 0.5 / 0.7)},
                   1);
    const Reach found = reached(scene);
    EXPECT_NEAR(found.hidden, 0.5, 0.1);
    EXPECT_NEAR(found.emissive_area, 1.0, 1e-4);
}

// A lamp far above a floor of which a small part is seen is no lamp of another place.
TEST(Reach, HasLampsThatItsPlacesSee) {
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(scene, 1.0);
    Material lamp;
    lamp.emission = {5.0f, 10.0f, 20.0f};
    test::add_quad(
        scene, {glm::dvec3(-0.1, 1.6, -0.1), {0.1, 1.6, -0.1}, {0.1, 1.6, 0.1}, {-0.1, 1.6, 0.1}},
        test::add_material(scene, lamp));
    scene.cameras = {test::camera_at({0.1, 1.0, 0.6}, {0, 0, 0}, 0.6f)};
    const auto power = [&] { return reached(scene).power; };
    EXPECT_NEAR(power(), 1.0, 1e-6);
    // Neither is a point light there; behind a plate it is.
    scene.lights = {test::point_light({0.0, 30.0, 0.0}, 1e3f)};
    EXPECT_NEAR(power(), 1.0, 1e-6);
    test::add_floor(scene, 0.3, 29.9);
    EXPECT_LT(power(), 0.01);
}

TEST(Reach, OfNothingIsNotKnown) {
    Scene scene = rooms(1);
    scene.cameras = {test::camera_at({100, 100, 100}, {200, 200, 200}, 1.0f)};
    const Reach found = reached(scene);
    EXPECT_EQ(found.points, 0u);
    EXPECT_EQ(found.size, 1.0);
    Plan plan;
    plan.reach = found;
    EXPECT_FALSE(sees_little(plan));
    plan.reach.reset();
    EXPECT_FALSE(sees_little(plan));
}

// A part of a scene is little by its size, its area or the power of its lamps.
TEST(Reach, IsLittleByAnyOfThree) {
    const auto little = [](double size, double area, double power) {
        Plan plan;
        plan.reach = Reach();
        plan.reach->size = size;
        plan.reach->area = area;
        plan.reach->power = power;
        return sees_little(plan);
    };
    EXPECT_FALSE(little(0.5, 0.9, 0.9));
    EXPECT_TRUE(little(0.1, 0.9, 0.9));
    EXPECT_TRUE(little(0.5, 0.05, 0.9));
    EXPECT_TRUE(little(0.5, 0.9, 0.4));
}

// The local frame lies around the focus, whatever is around that: distances that are shares of it
// stay what they are in the room alone.
TEST(Focus, MakesTheFrameOfARoomThatOfTheRoomAlone) {
    Scene room = rooms(1);
    room.focus = Focus{{2.0, 1.5, 2.5}, 3.0};
    Scene far = room;
    test::add_floor(far, 20000.0, -1.0);
    const SceneFrame alone = test::on_device(room).frame(), within = test::on_device(far).frame();
    EXPECT_EQ(within.origin, glm::dvec3(2.0, 1.5, 2.5));
    EXPECT_EQ(within.scale, alone.scale);
    EXPECT_EQ(within.detail, alone.detail);
    EXPECT_FLOAT_EQ(within.detail, static_cast<float>(3.0 * within.scale));
    EXPECT_GT(within.radius, 5000.0f * within.detail);
    // Everything lies in the sphere of the radius.
    for (const glm::dvec3& p : far.positions)
        EXPECT_LE(glm::length(within.to_local(p)), within.radius * 1.0001f);
    // A focus that holds all of it is none.
    room.focus = Focus{{2.0, 1.5, 2.5}, 100.0};
    const SceneFrame all = test::on_device(room).frame();
    EXPECT_EQ(all.detail, all.radius);
}

// The same bits of a room with a lamp, alone and in plains of 1 to 100 km.
TEST(Focus, GivesTheSamePictureInAnyPlain) {
    Scene room = rooms(1);
    room.lights = {test::point_light({2.0, 2.0, 2.0}, 9.0f)};
    room.focus = Focus{{2.0, 1.5, 2.5}, 3.0};
    SecondOrderOptions options;
    options.width = 64;
    options.height = 48;
    options.indirect = false;
    options.emitters.focused = true;
    const auto alone = test::render(room, room.cameras[0], options).radiance;
    for (const double half : {1e3, 1e4, 1e5}) {
        Scene far = room;
        test::add_floor(far, half, -1.0);
        EXPECT_TRUE(test::render(far, far.cameras[0], options).radiance == alone) << half;
    }
}

TEST(Focus, IsChecked) {
    Scene scene = rooms(1);
    scene.focus = Focus{{0, 0, 0}, 0.0};
    EXPECT_THROW(test::on_device(scene), InputError);
    scene.focus = Focus{{1e30, 0, 0}, 1.0};
    EXPECT_THROW(test::on_device(scene), InputError);
}

}  // namespace
}  // namespace clgi
