// What lights light of small places, by VPLs.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>

#include "cache_pictures.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

const glm::dvec3 lux(1e5, 0.8e5, 0.6e5);
const glm::dvec3 hall_albedo(0.7, 0.5, 0.3);  // of floor and roof
// A hall and the place of a hole in its roof, along x and z.
struct Hall {
    Scene scene;
    std::uint32_t coloured = 0;
    double width, length, height, low, high;
};

// Without its roof; a camera that sees neither hole nor spot.
Hall hall(double size, double hole) {
    Hall out{test::plain_scene({0.4f, 0.6f, 0.7f}),
             0,
             12 * size,
             14 * size,
             6 * size,
             5 * size,
             5 * size + hole};
    const double x = out.width, y = out.height, z = out.length;
    Material material;
    material.base_color = glm::vec4(glm::vec3(hall_albedo), 1.0f);
    material.double_sided = true;
    out.coloured = test::add_material(out.scene, material);
    test::add_quad(out.scene, {{{0, 0, z}, {x, 0, z}, {x, 0, 0}, {0, 0, 0}}}, out.coloured);
    test::add_box(out.scene, {-0.5, -0.5, -0.5}, {x + 0.5, y, 0}, 1);
    test::add_box(out.scene, {-0.5, -0.5, z}, {x + 0.5, y, z + 0.5}, 1);
    test::add_box(out.scene, {-0.5, -0.5, 0}, {0, y, z}, 1);
    test::add_box(out.scene, {x, -0.5, 0}, {x + 0.5, y, z}, 1);
    out.scene.cameras = {
        test::camera_at(size * glm::dvec3(1.0, 4.5, 13.0), size * glm::dvec3(3.5, 4.9, 2.0), 0.8f)};
    return out;
}

// Around the hole; thick: metres, 0 for a sheet.
void add_roof(Hall& of, double thick) {
    const auto add = [&](double x0, double x1, double z0, double z1) {
        const double y = of.height;
        if (thick > 0.0)
            test::add_box(of.scene, {x0, y, z0}, {x1, y + thick, z1}, 1, of.coloured);
        else
            test::add_quad(of.scene, {{{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}}},
                           of.coloured);
    };
    add(-0.5, of.low, -0.5, of.length + 0.5);
    add(of.high, of.width + 0.5, -0.5, of.length + 0.5);
    add(of.low, of.high, -0.5, of.low);
    add(of.low, of.high, of.high, of.length + 0.5);
}

Light sun(const glm::dvec3& direction) {
    Light out = test::directional_light(glm::vec3(glm::normalize(direction)));
    out.intensity = glm::vec3(lux);
    return out;
}

// What the sun lights as a lamp of its own: the same light, by another way through the path tracer.
void add_lit(Scene& scene, const std::array<glm::dvec3, 4>& corners, double cosine) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(hall_albedo), 1.0f);
    material.emission = glm::vec3(hall_albedo * lux * cosine / glm::pi<double>());
    test::add_quad(scene, corners, test::add_material(scene, material));
}

glm::dvec3 traced(const Scene& lamps, int samples) {
    reference::Options options;
    options.width = cache_width;
    options.height = cache_height;
    options.samples = samples;
    return mean_radiance(reference::PathTracer(lamps).render(lamps.cameras[0], options).radiance);
}

void expect_light(const CachePicture& found, const glm::dvec3& wanted, double within) {
    const glm::dvec3 got = mean_radiance(found.radiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / wanted[c], 1.0, within) << c;
}

struct Opening {
    double left, right, near, far;  // along x and z
};

// 42 holes of 20 cm, 1.8 m apart, and a large one; all in a roof without thickness.
std::vector<Opening> add_sieve(Hall& of) {
    constexpr double hole = 0.2, apart = 1.8, edge = 0.5;
    const double y = of.height;
    const auto add = [&](double x0, double x1, double z0, double z1) {
        test::add_quad(of.scene, {{{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}}},
                       of.coloured);
    };
    std::vector<std::vector<Opening>> rows;
    for (int row = 0; row < 7; ++row) {
        rows.emplace_back();
        for (int k = 0; k < 6; ++k)
            rows.back().push_back({1.0 + apart * k, 1.0 + apart * k + hole, 1.0 + apart * row,
                                   1.0 + apart * row + hole});
    }
    rows.push_back({{3.0, 8.0, 12.4, 13.8}});
    std::vector<Opening> out;
    double z = -edge;
    for (const std::vector<Opening>& row : rows) {
        add(-edge, of.width + edge, z, row[0].near);
        double x = -edge;
        for (const Opening& one : row) {
            add(x, one.left, one.near, one.far);
            x = one.right;
            out.push_back(one);
        }
        add(x, of.width + edge, row[0].near, row[0].far);
        z = row[0].far;
    }
    add(-edge, of.width + edge, z, of.length + edge);
    return out;
}

CLGI_IN_BOTH_MATHS(Spots);

// Through a hole of 10 cm in a thin roof, onto the floor.
TEST_P(Spots, OfAHoleLightAHall) {
    Hall of = hall(1.0, 0.1);
    add_roof(of, 0.0);
    Scene lamps = of.scene;
    const glm::dvec3 way(0.6, -1.0, 0.35);
    of.scene.lights = {sun(way)};
    const double x = of.height * way.x, z = of.height * way.z, y = 1e-3;
    add_lit(lamps,
            {{{of.low + x, y, of.high + z},
              {of.high + x, y, of.high + z},
              {of.high + x, y, of.low + z},
              {of.low + x, y, of.low + z}}},
            1.0 / glm::length(way));
    const CachePicture found = pictured(of.scene, cache_options(150, 200));
    EXPECT_GT(found.status.spots, 40u);
    static const glm::dvec3 truth = traced(lamps, 256);  // of both kinds of math
    expect_light(found, truth, 0.06);
}

// The roof is thicker than the hole is wide: no light comes through that is not reflected in it.
TEST_P(Spots, InAHoleLightAHall) {
    constexpr double hole = 0.15, thick = 0.3;
    Hall of = hall(0.5, hole);
    add_roof(of, thick);
    Scene lamps = of.scene;
    of.scene.lights = {sun({1.0, -1.0, 0.0})};
    const double x = of.high - 5e-4, above = of.height + thick, below = above - hole;
    add_lit(lamps,
            {{{x, below, of.low}, {x, below, of.high}, {x, above, of.high}, {x, above, of.low}}},
            glm::one_over_root_two<double>());
    IrradianceCacheOptions options = cache_options(150, 200);
    options.spots = 512;
    const CachePicture found = pictured(of.scene, options);
    EXPECT_GT(found.status.spots, 600u);                 // with those that others light
    static const glm::dvec3 truth = traced(lamps, 768);  // few paths enter the hole
    expect_light(found, truth, 0.15);
}

// More small places than are drawn closely, beside a large one that records resolve; another sun
// lights the outside alone.
TEST_P(Spots, OfManyHolesLightAHall) {
    Hall of = hall(1.0, 0.2);
    const std::vector<Opening> openings = add_sieve(of);
    Scene lamps = of.scene;
    const glm::dvec3 way(0.1, -1.0, -0.05);
    of.scene.lights = {sun({1.0, 0.0, 0.2}), sun(way)};
    const double x = of.height * way.x, z = of.height * way.z, y = 1e-3;
    for (const Opening& one : openings)
        add_lit(lamps,
                {{{one.left + x, y, one.far + z},
                  {one.right + x, y, one.far + z},
                  {one.right + x, y, one.near + z},
                  {one.left + x, y, one.near + z}}},
                1.0 / glm::length(way));
    const CachePicture found = pictured(of.scene, cache_options(150, 300));
    EXPECT_GE(found.status.spots, 80u);   // two for each
    EXPECT_LT(found.status.spots, 128u);  // small places have a fifth of the light
    static const glm::dvec3 truth = traced(lamps, 256);
    expect_light(found, truth, 0.06);
}

// Fewer records than VPLs that others light; and a picture without any record after it.
TEST_P(Spots, GoWithFewRecords) {
    Hall of = hall(0.5, 0.15);
    add_roof(of, 0.3);
    of.scene.lights = {sun({1.0, -1.0, 0.0})};
    IrradianceCacheOptions options = cache_options(1, 0);
    options.refined = 0;
    options.spots = 16;
    const DeviceScene device = test::on_device(of.scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    cache.render(of.scene.cameras[0]).wait();
    EXPECT_GT(cache.status().spots, 80u);
    Camera away = of.scene.cameras[0];
    away.position = {0.0, 500.0, 0.0};
    away.forward = {0, 1, 0};
    away.right = {1, 0, 0};
    away.up = {0, 0, 1};
    cache.render(away).wait();
    EXPECT_EQ(cache.status().seen, 0u);
    EXPECT_EQ(cache.status().spots, 0u);
}

}  // namespace
}  // namespace clgi
