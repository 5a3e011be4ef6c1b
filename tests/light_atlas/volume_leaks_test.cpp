// What irradiance volumes know of the walls around their points, and that no light passes through
// walls to what moves.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/static_bake.hpp>
#include <clgi/procedural.hpp>
#include <clgi/scene_animator.hpp>
#include <cmath>

#include "math_modes.hpp"
#include "methods/light_atlas/surroundings.hpp"
#include "moving_box.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// The direction of the middle of a texel, found anew: corners of an octahedron unfold to corners
// of the square.
glm::dvec3 texel_direction(int u, int v) {
    const glm::dvec2 at = (glm::dvec2(u, v) + 0.5) * (2.0 / double{VOLUME_SIDE}) - 1.0;
    const double z = 1.0 - std::abs(at.x) - std::abs(at.y);
    const glm::dvec2 in(std::max(-z, 0.0));  // towards the axes by what is below the equator
    return glm::normalize(glm::dvec3(std::copysign(std::abs(at.x) - in.x, at.x),
                                     std::copysign(std::abs(at.y) - in.y, at.y), z));
}

std::vector<glm::vec2> distances_from(const Scene& scene, const glm::dvec3& point, double unit) {
    std::vector<glm::vec2> out(VOLUME_TEXELS, glm::vec2(-1.0f));
    Surroundings(scene).distances(point, unit, out.data());
    return out;
}

glm::vec2 texel(const std::vector<glm::vec2>& map, int u, int v) {
    return map[static_cast<std::size_t>((v + 1) * VOLUME_ROW + u + 1)];
}

// From the middle of a sphere all surfaces are as far, and no part of the map is left out.
TEST(VolumeDistances, AreTheRadiusOfASphere) {
    const Scene sphere = furnace({.light = LightSource::point});
    const double radius = bounds(sphere).high.y;
    const std::vector<glm::vec2> map = distances_from(sphere, glm::dvec3(0.0), 0.8 * radius);
    for (const glm::vec2& found : map) {
        EXPECT_NEAR(found.x, 1.25, 0.01);  // facets lie within the sphere
        EXPECT_NEAR(found.y, 1.25 * 1.25, 0.025);
    }
    for (const glm::vec2& found : distances_from(sphere, glm::dvec3(0.0), 0.4 * radius))
        EXPECT_EQ(found, glm::vec2(VOLUME_RANGE, VOLUME_RANGE * VOLUME_RANGE));
    for (const glm::vec2& found : distances_from(test::plain_scene(), glm::dvec3(0.0), 1.0))
        EXPECT_EQ(found, glm::vec2(VOLUME_RANGE, VOLUME_RANGE * VOLUME_RANGE));
}

// A tilted plane at the distance h is h / cos away. A texel's mean differs from its middle by
// second-order terms, and its rays lie less than a tenth of a radian from that.
TEST(VolumeDistances, AreThoseOfATiltedWall) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.4, -0.7, 0.5));
    const glm::dvec3 x = glm::normalize(glm::cross(n, glm::dvec3(0, 0, 1))), y = glm::cross(n, x);
    const glm::dvec3 from(3.0, -2.0, 1.0), at = from - 0.6 * n;
    Scene scene = test::plain_scene();
    test::add_quad(scene, {at - 90.0 * (x + y), at + 90.0 * (x - y), at + 90.0 * (x + y),
                           at + 90.0 * (y - x)});
    const std::vector<glm::vec2> map = distances_from(scene, from, 1.0);
    int walls = 0;
    for (int v = 0; v < VOLUME_SIDE; ++v)
        for (int u = 0; u < VOLUME_SIDE; ++u) {
            const double cosine = -glm::dot(n, texel_direction(u, v));
            const glm::vec2 found = texel(map, u, v);
            if (cosine < -0.2) {
                EXPECT_EQ(found.x, VOLUME_RANGE) << u << " " << v;
            }
            if (cosine < 0.6) continue;
            ++walls;
            EXPECT_NEAR(found.x, 0.6 / cosine, 0.02) << u << " " << v;
            EXPECT_GE(found.y, found.x * found.x - 1e-6f);
            const double slope = 0.6 * std::sqrt(1.0 - cosine * cosine) / (cosine * cosine);
            EXPECT_LT(std::sqrt(std::max(found.y - found.x * found.x, 0.0f)), 0.1 * slope + 0.005);
        }
    EXPECT_GT(walls, 40);
}

// The border repeats texels of the other half of a side, where directions go on.
TEST(VolumeDistances, GoOnBeyondTheSidesOfTheMap) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-0.5, -0.7, -0.9}, {1.1, 1.0, 0.6}, -1);
    for (glm::dvec3& p : scene.positions)
        p += glm::dvec3(0.3 * p.y - 0.2 * p.z, 0.25 * p.z, 0.15 * p.y);
    const std::vector<glm::vec2> map = distances_from(scene, {0.1, 0.2, -0.1}, 1.0);
    for (int i = 0; i < VOLUME_SIDE; ++i) {
        const int other = VOLUME_SIDE - 1 - i;
        EXPECT_EQ(texel(map, i, -1), texel(map, other, 0));
        EXPECT_EQ(texel(map, i, VOLUME_SIDE), texel(map, other, VOLUME_SIDE - 1));
        EXPECT_EQ(texel(map, -1, i), texel(map, 0, other));
        EXPECT_EQ(texel(map, VOLUME_SIDE, i), texel(map, VOLUME_SIDE - 1, other));
        // Which are as near as neighbours within the map are.
        EXPECT_GT(glm::dot(texel_direction(i, 0), texel_direction(other, 0)), 0.0);
    }
    for (const int u : {-1, int{VOLUME_SIDE}})
        for (const int v : {-1, int{VOLUME_SIDE}})
            EXPECT_EQ(texel(map, u, v),
                      texel(map, u < 0 ? VOLUME_SIDE - 1 : 0, v < 0 ? VOLUME_SIDE - 1 : 0));
}

// Masked surfaces let light through.
TEST(VolumeDistances, PassMasks) {
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(distances_from(scene, glm::dvec3(0.1), 1.0)[20].x, VOLUME_RANGE);
}

TEST(VolumePoints, InSolidMatterHaveNoLight) {
    // A thick slab through the middle of the box, from wall to wall.
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-2.0), glm::dvec3(2.0), -1);
    test::add_box(scene, {-1.5, -2.0, -2.0}, {1.5, 2.0, 2.0}, 1);
    const Bounds box{glm::dvec3(-2.0), glm::dvec3(2.0)};
    const IrradianceVolume open = make_irradiance_volume(box, 64);
    EXPECT_EQ(open.open_count, 64u);
    const IrradianceVolume v = make_irradiance_volume(box, 64, scene);
    EXPECT_LE(v.open_count, 64u);
    EXPECT_LT(v.spacing, open.spacing);  // half of the cubes cost nothing
    std::uint32_t number = 0, solid = 0;
    for (const glm::vec4& place : v.places) {
        const glm::dvec3 at = v.first + v.spacing * glm::dvec3(place);
        if (place.w < 0.0f) {
            ++solid;
            EXPECT_LT(std::abs(at.x), 1.5);
            continue;
        }
        EXPECT_EQ(place.w, static_cast<float>(number++));
        EXPECT_GT(std::abs(at.x), 1.5);
        EXPECT_LT(std::abs(at.x), 2.0);
    }
    EXPECT_EQ(number, v.open_count);
    EXPECT_GT(solid, 20u);
    EXPECT_EQ(points_of(v).size(), std::size_t{number} * VOLUME_DIRECTIONS);
    EXPECT_EQ(v.distances.size(), std::size_t{number} * VOLUME_TEXELS);
    // Nothing of it is left in a block as large as the box.
    Scene rock = test::plain_scene();
    test::add_box(rock, glm::dvec3(-9.0), glm::dvec3(9.0), 1);
    EXPECT_EQ(make_irradiance_volume(box, 64, rock).open_count, 0u);
    EXPECT_TRUE(points_of(make_irradiance_volume(box, 64, rock)).empty());
    // Both sides of double-sided surfaces are seen.
    rock.materials[0].double_sided = true;
    EXPECT_EQ(make_irradiance_volume(box, 64, rock).open_count, 64u);
}

// A corridor through rock, narrower than the cubes and between their middles, has points.
TEST(VolumePoints, MoveIntoCorridors) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-0.1, -0.15, -3.0}, {0.3, 0.25, 3.0}, -1);
    const IrradianceVolume v = make_irradiance_volume(
        {glm::dvec3(-1.5, -1.5, -3.0), glm::dvec3(1.5, 1.5, 3.0)}, 24, scene);
    EXPECT_GE(v.open_count, 4u);
    EXPECT_LE(v.open_count, 24u);
    for (const BakePoint& point : points_of(v)) {
        EXPECT_GT(point.position.x, -0.1);
        EXPECT_LT(point.position.x, 0.3);
        EXPECT_GT(point.position.y, -0.15);
        EXPECT_LT(point.position.y, 0.25);
    }
    for (std::size_t i = 0; i < v.places.size(); ++i) {
        const glm::ivec3 cube(i % v.count.x, i / v.count.x % v.count.y,
                              i / (v.count.x * v.count.y));
        EXPECT_LE(glm::length(glm::vec3(v.places[i]) - glm::vec3(cube)), 0.5f + 1e-5f);
    }
}

// Two rooms, one of them without a lamp, and a tilted wall between. A clip carries a figure, which
// is slanted and coloured, from the lit one into the dark one: triangles 0 to 11.
Scene lit_and_dark_room() {
    Scene scene = test::plain_scene({0.8f, 0.6f, 0.4f});
    Material skin;
    skin.base_color = {0.5f, 0.7f, 0.9f, 1.0f};
    const std::uint32_t of_figure = test::add_material(scene, skin);
    test::add_box(scene, {-1.7, 0.7, -0.2}, {-1.4, 1.2, 0.1}, 1, of_figure);
    const std::size_t figure = scene.positions.size();
    const glm::dvec3 middle(-1.55, 0.95, -0.05);
    const auto turned = [](const glm::dvec3& p) {
        return glm::dvec3(0.36 * p.x + 0.48 * p.y - 0.8 * p.z, -0.8 * p.x + 0.6 * p.y,
                          0.48 * p.x + 0.64 * p.y + 0.6 * p.z);
    };
    for (std::size_t v = 0; v < figure; ++v) {
        scene.positions[v] = middle + turned(scene.positions[v] - middle);
        scene.normals[v] = turned(glm::dvec3(scene.normals[v]));
    }
    test::add_box(scene, {-5, 0, -4}, {5, 3, 4}, -1);
    const std::size_t wall = scene.positions.size();
    test::add_box(scene, {-0.08, 0, -4}, {0.08, 3, 4}, 1);
    for (std::size_t v = wall; v < scene.positions.size(); ++v)
        scene.positions[v].x += 0.15 * scene.positions[v].z + 0.1 * (scene.positions[v].y - 1.0);
    for (std::size_t t = scene.triangles.size() - 12; t < scene.triangles.size(); ++t) {
        const auto& k = scene.triangles[t].vertex;
        const glm::vec3 n(
            glm::normalize(glm::cross(scene.positions[k[1]] - scene.positions[k[0]],
                                      scene.positions[k[2]] - scene.positions[k[0]])));
        for (const std::uint32_t vertex : k) scene.normals[vertex] = n;
    }
    scene.parts = {{"figure", 0, 12}, {"rooms", 12, 24}};

    test::slide(scene, 0, static_cast<std::uint32_t>(figure), 0, {3.6f, 0.0f, 0.0f});
    // Cubes of 0.875 m, middles of which lie 0.11 m in front of the wall and 0.61 m behind it.
    scene.moving_bounds = Bounds{{-5, 0, -4}, {5.5, 3, 4}};
    scene.lights = {test::point_light({-1.9, 1.9, 0.6}, 40.0f)};
    scene.lights[0].intensity *= glm::vec3(0.6f, 0.8f, 1.0f);
    scene.cameras = {test::camera_at({-2.3, 1.2, 0.9}, {-1.55, 0.95, -0.05}, 0.8f),
                     test::camera_at({1.3, 1.2, 1.4}, {1.1, 0.95, -0.05}, 1.1f)};
    return scene;
}

CLGI_IN_BOTH_MATHS(VolumeLeaks);

// Wherever it stands in the dark room it has a fiftieth at most of the indirect light that it has
// in the lit one, in each channel.
TEST_P(VolumeLeaks, LightNoFigureInADarkRoom) {
    const Scene scene = lit_and_dark_room();
    PlanRequest request = test::quick();
    request.animated = true;
    request.method = Method::light_atlas;
    request.build = test::usual_build();
    Plan plan = test::plan_of(scene, scene.cameras[0], request);
    plan.vpls.count = 600;
    plan.layout.size = 128;
    plan.picture.direct = false;
    const Scene planned = planned_scene(scene, plan);
    DeviceScene uploaded = test::on_device(planned);
    const cl::CommandQueue& queue = test::device().queue;
    Renderer renderer(test::programs(), queue, planned, uploaded, plan);
    SceneAnimator animator(queue, planned, uploaded);
    ASSERT_TRUE(renderer.prepare());
    // The mean of those pixels that show the figure.
    const auto light = [&](int camera, double seconds) {
        const Animated step = animator.animate(0, seconds);
        renderer.render(scene.cameras[static_cast<std::size_t>(camera)], {step.done}).wait();
        EXPECT_EQ(renderer.status().non_finite, 0u);
        const test::Radiances shown = test::shown_by(renderer);
        Scene posed_scene = posed(scene, pose_at(*scene.animation, 0, seconds));
        const std::vector<bool> figure =
            test::seen_of(posed_scene, scene.cameras[static_cast<std::size_t>(camera)], 0);
        glm::dvec3 sum(0.0);
        int pixels = 0;
        for (std::size_t i = 0; i < shown.size(); ++i)
            if (figure[i]) {
                sum += glm::dvec3(shown[i]);
                ++pixels;
            }
        EXPECT_GT(pixels, 20) << seconds;
        return sum / double(pixels);
    };
    const glm::dvec3 lit = light(0, 0.0);
    for (int c = 0; c < 3; ++c) EXPECT_GT(lit[c], 0.0);
    for (const double seconds : {0.55, 0.58, 0.65, 0.75, 0.85, 1.0}) {
        const glm::dvec3 dark = light(1, seconds);
        for (int c = 0; c < 3; ++c) EXPECT_LT(dark[c], 0.02 * lit[c]) << seconds << " " << c;
    }
}

}  // namespace
}  // namespace clgi
