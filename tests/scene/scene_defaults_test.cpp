// validate, bounds, has_emission and the default camera and light.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/scene.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace clgi::test {
namespace {

// An axis-parallel box; its fronts outside, or inside for a room.
Scene box_scene(glm::dvec3 size, bool room) {
    Scene scene;
    scene.materials.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            glm::vec3 normal(0.0f);
            normal[axis] = (side == 1) != room ? 1.0f : -1.0f;
            const auto first = static_cast<std::uint32_t>(scene.positions.size());
            for (int i = 0; i < 4; ++i) {
                glm::dvec3 p(0.0);
                p[axis] = side * size[axis];
                p[u] = (i == 1 || i == 2) * size[u];
                p[v] = (i >= 2) * size[v];
                scene.positions.push_back(p);
                scene.normals.push_back(normal);
            }
            const bool forward = normal[axis] > 0.0f;
            const std::uint32_t b = first + (forward ? 1 : 3);
            const std::uint32_t d = first + (forward ? 3 : 1);
            scene.triangles.push_back({{first, b, first + 2}, 0});
            scene.triangles.push_back({{first, first + 2, d}, 0});
        }
    }
    return scene;
}

std::string complaint(const std::function<void(Scene&)>& damage) {
    Scene scene = box_scene({1, 2, 3}, false);
    scene.lights.emplace_back();
    scene.cameras.emplace_back();
    EXPECT_NO_THROW(validate(scene));
    damage(scene);
    try {
        validate(scene);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

TEST(Validate, NamesArrayIndexAndValue) {
    EXPECT_EQ(complaint([](Scene& s) { s.triangles[11].vertex[1] = 99; }),
              "scene: triangle 11 names vertex 99, there are 24");
    EXPECT_EQ(complaint([](Scene& s) { s.triangles[2].material = 1; }),
              "scene: triangle 2 names material 1, there are 1");
    EXPECT_EQ(complaint([](Scene& s) { s.normals.pop_back(); }),
              "scene: there are 23 normals, but 24 positions");
}

TEST(Validate, RefusesEveryBrokenPromise) {
    const std::function<void(Scene&)> damages[] = {
        [](Scene& s) { s.positions[5].y = NAN; },
        [](Scene& s) { s.positions[5].y = 1e19; },
        [](Scene& s) { s.normals[3] *= 1.1f; },
        [](Scene& s) { s.normals[3].x = NAN; },
        [](Scene& s) { s.uvs.resize(3); },
        [](Scene& s) { s.uvs.resize(24, glm::vec4(NAN)); },
        [](Scene& s) { s.colors.resize(24, glm::vec4(2.0f)); },
        [](Scene& s) { s.materials[0].base_color.g = -0.1f; },
        [](Scene& s) { s.materials[0].emission.b = INFINITY; },
        [](Scene& s) { s.materials[0].metallic = 1.5f; },
        [](Scene& s) { s.materials[0].roughness = NAN; },
        [](Scene& s) { s.materials[0].specular = 1.5f; },
        [](Scene& s) { s.materials[0].ior = 0.9f; },
        [](Scene& s) { s.materials[0].ior = NAN; },
        [](Scene& s) { s.materials[0].alpha_cutoff = -1.0f; },
        [](Scene& s) { s.materials[0].base_texture.texture = 0; },
        [](Scene& s) {
            s.textures.push_back({"", 2, 2, {1, 2, 3}});
        },
        [](Scene& s) {
            s.parts.push_back({"", 10, 3});
        },
        [](Scene& s) { s.lights[0].intensity.r = -1.0f; },
        [](Scene& s) { s.lights[0].range = NAN; },
        [](Scene& s) { s.lights[0].position.x = INFINITY; },
        [](Scene& s) { s.lights[0].kind = Light::Kind::spot, s.lights[0].outer_angle = 2.0f; },
        [](Scene& s) { s.lights[0].kind = Light::Kind::spot, s.lights[0].inner_angle = 1.0f; },
        [](Scene& s) { s.lights[0].kind = Light::Kind::directional, s.lights[0].direction.z = 2; },
        [](Scene& s) { s.cameras[0].up = glm::vec3(0, 2, 0); },
        [](Scene& s) { s.cameras[0].up = s.cameras[0].right; },
        [](Scene& s) { s.cameras[0].right = -s.cameras[0].right; },
        [](Scene& s) { s.cameras[0].vertical_fov = 3.2f; },
        [](Scene& s) { s.cameras[0].near = -1.0f; }};
    for (std::size_t i = 0; i < std::size(damages); ++i) {
        EXPECT_EQ(complaint(damages[i]).find("scene: "), 0u) << "damage " << i;
    }
}

TEST(Bounds, LeaveOutVerticesThatNoTriangleUses) {
    Scene scene = box_scene({1, 2, 3}, false);
    scene.positions.emplace_back(50.0);
    EXPECT_EQ(bounds(scene).high, glm::dvec3(1, 2, 3));
    EXPECT_EQ(bounds(Scene()).high, glm::dvec3(0.0));
}

TEST(HasEmission, AsksTheMaterialsInUse) {
    Scene scene = box_scene({1, 1, 1}, false);
    scene.materials.emplace_back().emission = glm::vec3(1.0f);
    EXPECT_FALSE(has_emission(scene));
    scene.triangles[0].material = 1;
    EXPECT_TRUE(has_emission(scene));
}

// Whether a point is inside the picture of a square format.
bool is_in_view(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 to = point - camera.position;
    const double depth = glm::dot(to, glm::dvec3(camera.forward));
    const double edge = depth * std::tan(camera.vertical_fov / 2.0);
    return depth > 0.0 && std::abs(glm::dot(to, glm::dvec3(camera.right))) <= edge &&
           std::abs(glm::dot(to, glm::dvec3(camera.up))) <= edge;
}

TEST(DefaultCamera, ShowsAllOfAnObjectAtAnyScale) {
    for (const double scale : {1e-6, 1.0, 1e9}) {
        Scene scene = box_scene(glm::dvec3(1, 2, 3) * scale, false);
        const Camera camera = default_camera(scene);
        for (const glm::dvec3& p : scene.positions) EXPECT_TRUE(is_in_view(camera, p)) << scale;
        scene.cameras.push_back(camera);
        EXPECT_NO_THROW(validate(scene));
    }
}

TEST(DefaultCamera, StandsInARoomAndLooksAlongIt) {
    for (const double scale : {1e-6, 1.0, 1e9}) {
        const Camera camera = default_camera(box_scene(glm::dvec3(8, 3, 4) * scale, true));
        EXPECT_GT(std::abs(camera.forward.x), 0.99f);
        EXPECT_NEAR(camera.position.y / scale, 1.2, 1e-9);
        EXPECT_TRUE(camera.position.x > 0.0 && camera.position.x < 8.0 * scale);
    }
}

TEST(DefaultCamera, StandsOutsideOfWhatIsOpenAboveAndAhead) {
    Scene stage = box_scene({8, 3, 4}, true);
    stage.triangles.erase(stage.triangles.begin() + 6, stage.triangles.begin() + 8);  // y = 3
    stage.triangles.erase(stage.triangles.begin() + 2, stage.triangles.begin() + 4);  // x = 8
    const Camera camera = default_camera(stage);
    for (const glm::dvec3& p : stage.positions) EXPECT_TRUE(is_in_view(camera, p));
}

TEST(DefaultCamera, StandsFirmForEmptyAndFlatScenes) {
    for (Scene scene : {Scene(), box_scene({1, 0, 1}, false), box_scene({0, 0, 0}, true)}) {
        scene.cameras.push_back(default_camera(scene));
        scene.lights.push_back(default_light(scene));
        EXPECT_NO_THROW(validate(scene));
    }
}

TEST(DefaultLight, ComesFromAboveWithPiLux) {
    const Light light = default_light(box_scene({1, 1, 1}, false));
    EXPECT_EQ(light.kind, Light::Kind::directional);
    EXPECT_LT(light.direction.y, -0.8f);
    EXPECT_FLOAT_EQ(light.intensity.g, std::numbers::pi_v<float>);
}

TEST(DefaultLight, FallsSteeplyIntoARooflessRoom) {
    Scene room = box_scene({8, 3, 4}, true);
    room.triangles.erase(room.triangles.begin() + 6, room.triangles.begin() + 8);  // y = 3
    EXPECT_LT(default_light(room).direction.y, -0.95f);
}

}  // namespace
}  // namespace clgi::test
