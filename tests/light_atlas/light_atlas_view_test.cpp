// Pictures of a scene with a baked atlas, against the path tracer and the other solver.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "frames.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr int view_width = 80, view_height = 60;

// A closed room with a block in it, walls of four colours, lit by a spot from under the ceiling.
Scene viewed_room() {
    Scene scene = test::plain_scene({0.7f, 0.65f, 0.6f});
    for (const glm::vec3 colour : {glm::vec3(0.75f, 0.2f, 0.1f), glm::vec3(0.2f, 0.6f, 0.3f)}) {
        Material material;
        material.base_color = glm::vec4(colour, 1.0f);
        test::add_material(scene, material);
    }
    test::add_box(scene, {-2.0, 0.0, -1.5}, {2.0, 2.4, 1.5}, -1);
    test::add_box(scene, {0.3, 0.001, -0.9}, {1.2, 1.1, 0.1}, 1, 2);
    scene.triangles[0].material = scene.triangles[1].material = 1;  // the wall at -x
    scene.lights = {test::spot_light({-0.4, 2.2, 0.3}, {-0.3f, -1.0f, -0.2f}, 0.6, 40.0f)};
    scene.cameras = {test::camera_at({1.7, 1.5, 1.3}, {-0.8, 0.8, -0.6}, 1.1f)};
    return scene;
}

// A baked atlas and whatever it needs.
struct ViewedBake {
    explicit ViewedBake(const Scene& scene, std::uint32_t bounces, std::uint32_t vpls = 700)
        : world(scene), on_device(test::on_device(world)) {
        const Patches patches = make_patches(world);
        VplOptions vpl_options;
        vpl_options.count = vpls;
        AtlasOptions atlas_options;
        atlas_options.size = 160;
        layout = make_atlas(world, patches.triangle_patch, atlas_options);
        LightAtlasOptions options;
        options.bounces = bounces;
        options.hemicube_size = 128;
        solver = std::make_unique<LightAtlasSolver>(
            test::programs(), test::device().queue, on_device,
            place_vpls(world, patches, vpl_options), layout, options);
        EXPECT_TRUE(solver->run());
    }

    std::vector<glm::vec3> picture(const LightAtlasViewOptions& options, const Camera& camera) {
        LightAtlasView view(test::programs(), test::device().queue, on_device, layout, options);
        view.render(camera, solver->irradiance_planes(), solver->stride()).wait();
        EXPECT_EQ(view.picture().non_finite(), 0u);
        return test::vectors(test::device().queue, view.picture().radiance(),
                             view.picture().stride(),
                             std::size_t(options.width) * std::size_t(options.height));
    }

    Scene world;
    DeviceScene on_device;
    AtlasLayout layout;
    std::unique_ptr<LightAtlasSolver> solver;
};

LightAtlasViewOptions small(bool direct) {
    LightAtlasViewOptions out;
    out.width = view_width;
    out.height = view_height;
    out.direct = direct;
    return out;
}

glm::dvec3 mean_of_picture(const std::vector<glm::vec3>& values) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& value : values) sum += glm::dvec3(value);
    return sum / static_cast<double>(values.size());
}

TEST(LightAtlasView, ShowsTheIndirectLightOfThePathTracer) {
    const Scene scene = viewed_room();
    ViewedBake baked(scene, 3);
    const auto found = baked.picture(small(false), scene.cameras[0]);
    reference::Options options;
    options.width = view_width;
    options.height = view_height;
    options.samples = 256;
    options.effects = reference::parse_effects("indirect");
    options.effects.last_bounce = 3;
    const reference::Picture truth = reference::PathTracer(scene).render(scene.cameras[0], options);
    const double noise = truth.relative_error / std::sqrt(double{view_width} * view_height);
    EXPECT_LT(noise, 0.005);
    const glm::dvec3 got = mean_of_picture(found), wanted = mean_of_picture(truth.radiance);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c] / wanted[c], 1.0, 0.03 + 4.5 * noise) << "channel " << c;
    // Light is where it belongs: blocks of 10 x 10 pixels, in which the noise is a tenth.
    double squares = 0.0;
    int blocks = 0;
    for (int y = 0; y < view_height; y += 10)
        for (int x = 0; x < view_width; x += 10) {
            glm::dvec3 a(0.0), b(0.0);
            for (int i = 0; i < 100; ++i) {
                const auto pixel = static_cast<std::size_t>((y + i / 10) * view_width + x + i % 10);
                a += glm::dvec3(found[pixel]);
                b += glm::dvec3(truth.radiance[pixel]);
            }
            const glm::dvec3 error = (a - b) / b;
            squares += glm::dot(error, error) / 3.0;
            ++blocks;
        }
    EXPECT_LT(std::sqrt(squares / blocks), 0.08);
}

// The same passes: what direct light adds is the second-order solver's picture without VPLs.
TEST(LightAtlasView, HasTheDirectLightOfTheOtherSolver) {
    Scene scene = viewed_room();
    scene.materials[2].roughness = 0.4f;  // gloss too
    scene.materials[2].specular = 1.0f;
    scene.materials[1].emission = {0.2f, 0.1f, 0.3f};
    scene.environment.emplace();
    scene.environment->factor = {0.3f, 0.4f, 0.5f};
    scene.triangles.erase(scene.triangles.begin() + 6, scene.triangles.begin() + 8);  // the ceiling
    ViewedBake baked(scene, 1, 100);
    const auto with = baked.picture(small(true), scene.cameras[0]);
    const auto without = baked.picture(small(false), scene.cameras[0]);
    SecondOrderOptions options;
    options.width = view_width;
    options.height = view_height;
    options.indirect = false;
    SecondOrderSolver direct(test::programs(), test::device().queue, baked.on_device, options);
    direct.render(scene.cameras[0]).wait();
    const auto wanted =
        test::vectors(test::device().queue, direct.radiance(), direct.stride(), with.size());
    ASSERT_GT(mean_of_picture(without).x, 0.0);
    for (std::size_t i = 0; i < with.size(); ++i)
        for (int c = 0; c < 3; ++c)  // one more rounding of each part than of the whole
            ASSERT_NEAR(with[i][c], without[i][c] + wanted[i][c], 4e-6f * (with[i][c] + 1e-3f))
                << i;
}

TEST(LightAtlasView, ShowsTheSameLightFromEverywhere) {
    const Scene scene = viewed_room();
    ViewedBake baked(scene, 1, 100);
    // Straight down from 2.3 m and from 2.2 m: the middle of the picture is the same place.
    Camera camera = test::camera_at({-1.0, 2.3, 0.7}, {-1.0, 0.0, 0.7}, 0.02f);
    const glm::dvec3 high = mean_of_picture(baked.picture(small(false), camera));
    camera.position.y = 1.7;
    camera.vertical_fov = 0.02f * 2.3f / 1.7f;
    const glm::dvec3 low = mean_of_picture(baked.picture(small(false), camera));
    EXPECT_GT(high.x, 0.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(low[c] / high[c], 1.0, 1e-3);
}

TEST(LightAtlasView, IsNearlyTheSameInHalfStorage) {
    const Scene scene = viewed_room();
    ViewedBake baked(scene, 1, 100);
    LightAtlasViewOptions options = small(true);
    const glm::dvec3 full = mean_of_picture(baked.picture(options, scene.cameras[0]));
    options.build.storage = Storage::half;
    const glm::dvec3 half = mean_of_picture(baked.picture(options, scene.cameras[0]));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(half[c] / full[c], 1.0, 1e-3);
}

TEST(LightAtlasView, SaysWhatItCannotDo) {
    const Scene scene = viewed_room();
    const DeviceScene on_device = test::on_device(scene);
    AtlasOptions atlas_options;
    atlas_options.size = 32;
    const AtlasLayout layout = make_atlas(scene, make_patches(scene).triangle_patch, atlas_options);
    const auto make = [&](const AtlasLayout& atlas, const LightAtlasViewOptions& options) {
        LightAtlasView(test::programs(), test::device().queue, on_device, atlas, options);
    };
    LightAtlasViewOptions wide = small(true);
    wide.width = 0;
    EXPECT_THROW(make(layout, wide), Error);
    AtlasLayout other = layout;
    other.triangle_page.pop_back();
    EXPECT_THROW(make(other, small(true)), Error);
    other = layout;
    other.texels.back().texel = 32 * 32;
    EXPECT_THROW(make(other, small(true)), Error);
    LightAtlasViewOptions poor = small(true);
    poor.memory_budget = 1000;
    EXPECT_THROW(make(layout, poor), DeviceError);
}

}  // namespace
}  // namespace clgi
