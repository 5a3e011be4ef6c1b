// A light is replaced by one that could have been loaded, or not at all.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <functional>
#include <limits>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

Scene lamps() {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    scene.lights = {test::point_light({0, 1, 0}), test::spot_light({0, 2, 0}, {0, -1, 0}, 0.5)};
    return scene;
}

TEST(SetLight, ReplacesALight) {
    DeviceScene scene = test::on_device(lamps());
    Light light = test::spot_light({0.5, 3, 0}, {1, -1, 0}, 1.2, 7.0f);
    light.inner_angle = 0.3f;
    light.range = 9.0f;
    scene.set_light(0, light);
    EXPECT_EQ(scene.lights()[0].position, light.position);
    EXPECT_EQ(scene.lights()[0].kind, Light::Kind::spot);
    EXPECT_EQ(scene.lights()[0].range, 9.0f);
    EXPECT_THROW(scene.set_light(2, light), Error);
}

struct Field {
    const char* word;  // of the text
    std::function<void(Light&, float)> set;
};

const Field fields[] = {
    {"position", [](Light& l, float v) { l.position.x = double{v}; }},
    {"position", [](Light& l, float v) { l.position.y = double{v}; }},
    {"position", [](Light& l, float v) { l.position.z = double{v}; }},
    {"direction", [](Light& l, float v) { l.direction.x = v; }},
    {"direction", [](Light& l, float v) { l.direction.y = v; }},
    {"direction", [](Light& l, float v) { l.direction.z = v; }},
    {"intensity", [](Light& l, float v) { l.intensity.x = v; }},
    {"intensity", [](Light& l, float v) { l.intensity.y = v; }},
    {"intensity", [](Light& l, float v) { l.intensity.z = v; }},
    {"range", [](Light& l, float v) { l.range = v; }},
    {"inner cone angle", [](Light& l, float v) { l.inner_angle = v; }},
    {"outer cone angle", [](Light& l, float v) { l.outer_angle = v; }},
};

void expect_refused(const Field& field, float value, const Light& good) {
    DeviceScene scene = test::on_device(lamps());
    Light light = good;
    field.set(light, value);
    try {
        scene.set_light(1, light);
        ADD_FAILURE() << field.word << " of " << double{value} << " was taken";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("light 1"), std::string::npos) << text;
        EXPECT_NE(text.find(field.word), std::string::npos) << text;
    }
    EXPECT_EQ(scene.lights()[1].position, lamps().lights[1].position);
    EXPECT_EQ(scene.lights()[1].intensity, lamps().lights[1].intensity);
    // Nor would it have been loaded.
    Scene world = lamps();
    world.lights[1] = light;
    EXPECT_THROW(validate(world), InputError);
}

TEST(SetLight, RefusesWhatIsNotFinite) {
    Light good = test::spot_light({1, 1, 1}, {0, -1, 0}, 0.7, 3.0f);
    for (const Field& field : fields)
        for (const float value :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
              -std::numeric_limits<float>::infinity()})
            expect_refused(field, value, good);
}

TEST(SetLight, RefusesWhatIsOutOfRange) {
    const Light good = test::spot_light({1, 1, 1}, {0, -1, 0}, 0.7, 3.0f);
    expect_refused(fields[3], 1.0f, good);    // a direction of length 1.4
    expect_refused(fields[7], -1.0f, good);   // intensity
    expect_refused(fields[9], -1.0f, good);   // range
    expect_refused(fields[10], 0.71f, good);  // inner beyond outer
    expect_refused(fields[11], 1.6f, good);   // beyond a right angle
    expect_refused(fields[11], 0.0f, good);
}

// All lights at once, or none of them.
TEST(SetLight, ReplacesAllLights) {
    const Scene scene = lamps();
    DeviceScene device = test::on_device(scene);
    std::vector<Light> lights = scene.lights;
    lights[0].intensity = {3.0f, 1.0f, 2.0f};
    lights[1].position.y = 0.25;
    device.set_lights(lights);
    EXPECT_EQ(device.lights()[0].intensity, lights[0].intensity);
    EXPECT_EQ(device.lights()[1].position, lights[1].position);
    lights[0].intensity.x = 9.0f;
    lights[1].intensity.y = -1.0f;
    EXPECT_THROW(device.set_lights(lights), InputError);
    lights.pop_back();
    EXPECT_THROW(device.set_lights(lights), Error);
    EXPECT_EQ(device.lights()[0].intensity.x, 3.0f);
}

}  // namespace
}  // namespace clgi
