// What a view of dynamic transfer shows of light that changes: directional lights of the
// environment or beside it, another light after lights_changed(), a sky that turns.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/dynamic_transfer_view.hpp>
#include <cmath>
#include <numbers>

#include "frames.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr int side = 33;

struct Stage {
    Stage(const Scene& scene, bool directional, float threshold = 0.1f)
        : device(test::on_device(scene)),
          solver(test::programs(), test::device().queue, scene, device,
                 solver_options(directional)),
          view(test::programs(), test::device().queue, device, solver, view_options(threshold)) {
        EXPECT_TRUE(solver.run());
    }
    static DynamicTransferOptions solver_options(bool directional) {
        DynamicTransferOptions out;
        out.directional = directional;
        return out;
    }
    static DynamicTransferViewOptions view_options(float threshold) {
        DynamicTransferViewOptions out;
        out.picture.width = out.picture.height = side;
        out.threshold = threshold;
        return out;
    }
    std::vector<glm::vec3> radiance(const Camera& camera) {
        view.render(camera).wait();
        return test::vectors(test::device().queue, view.picture().radiance(),
                             view.picture().stride(), std::size_t{side} * side);
    }
    glm::dvec3 middle(const Camera& camera) { return radiance(camera)[side * side / 2]; }

    DeviceScene device;
    DynamicTransferSolver solver;
    DynamicTransferView view;
};

const glm::vec3 albedo(0.5f, 0.3f, 0.7f);
const glm::vec3 lux(2.0f, 3.0f, 0.5f);

// Paper under a light from the zenith.
Scene lit_floor() {
    Scene scene = test::plain_scene(albedo);
    scene.materials[0].roughness = 1.0f;
    test::add_floor(scene, 1.0);
    scene.lights = {test::directional_light({0, -1, 0})};
    scene.lights[0].intensity = lux;
    return scene;
}

Camera above() { return test::camera_at({0.3, 2.0, 1.5}, {0.1, 0, 0.1}); }

// Radiance of a diffuse surface: albedo E / pi. In the environment E is cut at five bands, 0.96875
// of what comes from the normal's direction; beside it E is exact. Counted twice it would be nearly
// the double. Rounding of some fifty additions, and what the exact cells of masks leave.
TEST(DynamicTransferViewLight, CountsADirectionalLightOnce) {
    for (const bool inside : {true, false})
        for (const float threshold : {0.0f, 0.1f}) {
            Stage stage(lit_floor(), inside, threshold);
            const glm::dvec3 found = stage.middle(above());
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c] * pi / (albedo[c] * lux[c]), inside ? 0.96875 : 1.0, 2e-5)
                    << inside << ", channel " << c;
        }
}

// Point lights stay beside an environment that takes in the directional ones: I cos / d^2.
TEST(DynamicTransferViewLight, KeepsPointLightsBesideDirectionalOnesInTheEnvironment) {
    Scene scene = lit_floor();
    scene.lights.push_back(test::point_light({0.1, 1.5, 0.1}));
    scene.lights[1].intensity = {4.0f, 1.0f, 9.0f};
    Stage stage(scene, true);
    Camera camera = above();
    const glm::dvec3 found = stage.middle(camera);
    // The middle pixel looks at the target, right under the lamp: its centre is the view's.
    for (int c = 0; c < 3; ++c) {
        const double wanted = 0.96875 * lux[c] + scene.lights[1].intensity[c] / (1.5 * 1.5);
        EXPECT_NEAR(found[c] * pi / (albedo[c] * wanted), 1.0, 2e-5) << "channel " << c;
    }
}

// E = 3 lux for 2 at the start: the cosine of a light from 60 degrees, other channels each.
TEST(DynamicTransferViewLight, ShowsALightThatChanged) {
    Stage stage(lit_floor(), false);
    stage.radiance(above());
    Light low = stage.device.lights()[0];
    low.direction = glm::vec3(-std::sin(pi / 3), -std::cos(pi / 3), 0);
    low.intensity = {1.0f, 8.0f, 3.0f};
    stage.device.set_light(0, low);
    stage.view.lights_changed();
    const glm::dvec3 found = stage.middle(above());
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] * pi / (albedo[c] * low.intensity[c] * 0.5), 1.0, 2e-5)
            << "channel " << c;
}

// A light inside the environment that changes: the solver reads it, and the view still has none.
TEST(DynamicTransferViewLight, LeavesALightThatChangedToTheEnvironment) {
    Stage stage(lit_floor(), true);
    stage.radiance(above());
    Light other = stage.device.lights()[0];
    other.intensity = {1.0f, 8.0f, 3.0f};
    stage.device.set_light(0, other);
    stage.solver.lights_changed();
    stage.view.lights_changed();
    stage.solver.light().wait();
    const glm::dvec3 found = stage.middle(above());
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] * pi / (albedo[c] * other.intensity[c]), 0.96875, 2e-5)
            << "channel " << c;
}

// A sky of coloured columns, seen past a small sheet: a turn of a quarter brings what lay on +x to
// -z, and a turn that is not asked for by light() yet is not shown.
TEST(DynamicTransferViewLight, TurnsTheSkyWithItsLight) {
    Scene scene = test::plain_scene(albedo);
    test::add_quad(
        scene,
        {glm::dvec3(-0.01, -9, -0.01), {0.01, -9, -0.01}, {0.01, -9, 0.01}, {-0.01, -9, 0.01}});
    Environment sky;
    sky.width = 64;
    sky.height = 1;
    for (int column = 0; column < sky.width; ++column)
        sky.texels.emplace_back(static_cast<float>(column + 1), static_cast<float>(2 * column + 3),
                                static_cast<float>(100 - column));
    sky.rotation = 0.3f;
    scene.environment = sky;
    Stage stage(scene, false);
    Camera camera = test::camera_at({0, 0, 0}, {0, 0, -1});
    camera.footprint = 1e-9f;               // a point of the pixel
    const auto texel = [&](double angle) {  // of the view's middle: x = 0, z = -1
        double u = 0.5 + (0.3 + angle) / (2 * pi);
        u -= std::floor(u);
        return sky.texels[static_cast<std::size_t>(u * sky.width)];
    };
    // Away from the edges of columns by a tenth of one at least.
    for (const double angle : {0.0, 0.7, -2.0, 9.0}) {
        stage.solver.turn_environment(angle + 1.0);
        stage.solver.turn_environment(angle);
        stage.solver.light().wait();
        stage.solver.turn_environment(angle + 2.0);  // for another light()
        const glm::dvec3 found = stage.middle(camera);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c] / texel(angle)[c], 1.0, 1e-6) << angle << ", channel " << c;
    }
}

}  // namespace
}  // namespace clgi
