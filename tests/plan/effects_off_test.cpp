// What a scene does not call for costs nothing in second-order illumination: kernels are not built,
// passes not enqueued, buffers not allocated; and the picture is the same where an effect is
// nothing.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/kernel_source.hpp>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/error.hpp>
#include <numbers>
#include <set>

#include "effect_cost.hpp"
#include "frames.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr int off_width = 64, off_height = 48;
constexpr std::size_t off_pixels = std::size_t{off_width} * off_height;

const cl::CommandQueue& off_queue() { return test::device().queue; }

// Unshadowed radiance of the floor, cd/m^2.
glm::dvec3 open_floor(const Scene& scene, const glm::dvec3& at) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(scene.normals[0]));
    glm::dvec3 sum(0.0);
    for (const Light& light : scene.lights) {
        if (light.kind == Light::Kind::directional) {
            const double cosine = -glm::dot(n, glm::normalize(glm::dvec3(light.direction)));
            sum += glm::dvec3(light.intensity) * std::max(0.0, cosine);
            continue;
        }
        const glm::dvec3 to = light.position - at;
        const double distance = glm::length(to);
        const double off = std::acos(std::clamp(
            -glm::dot(to, glm::normalize(glm::dvec3(light.direction))) / distance, -1.0, 1.0));
        if (light.kind == Light::Kind::spot && off > double{light.outer_angle}) continue;
        sum += glm::dvec3(light.intensity) * std::max(0.0, glm::dot(n, to)) / std::pow(distance, 3);
    }
    return glm::dvec3(scene.materials[0].base_color) / pi * sum;
}

struct Direct {
    test::Cost cost;
    EmitterCapacity capacity;
    std::vector<glm::vec3> radiance;
    std::vector<glm::dvec3> places;
};

SecondOrderOptions direct_options(bool shadows) {
    SecondOrderOptions out;
    out.width = off_width;
    out.height = off_height;
    out.indirect = false;
    out.emitters = test::small_maps(shadows);
    return out;
}

Direct second_order(const Scene& scene, const SecondOrderOptions& options) {
    const Programs own = test::own_programs();
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(own, off_queue(), device, options);
    solver.render(scene.cameras.at(0)).wait();
    const test::Frame frame = test::read_frame(off_queue(), device, solver);
    Direct out;
    out.cost.kernels = own.built_kernels();
    EXPECT_EQ(out.cost.kernels.size(), own.built());
    out.cost.add(solver.events());
    out.cost.bytes = solver.bytes();
    EXPECT_EQ(estimate(test::device().device, device, options).bytes, solver.bytes());
    out.capacity = solver.emitters().capacity;
    out.radiance = frame.radiance;
    for (std::size_t i = 0; i < off_pixels && frame.launches > 0; ++i)
        out.places.push_back(frame.world(i));
    return out;
}

// ---- shadow maps -------------------------------------------------------------------------------

TEST(WithoutShadows, AConvexRoomLooksTheSameAndDrawsNoMap) {
    const Scene scene = test::convex_room();
    const Direct on = second_order(scene, direct_options(true));
    const Direct off = second_order(scene, direct_options(false));
    test::expect_no_less(on.radiance, off.radiance, 0.01);
    int compared = 0;
    for (std::size_t i = 0; i < off_pixels; ++i) {
        if (off.radiance[i] == glm::vec3(0.0f)) continue;  // through the open wall
        if (test::near_an_edge(scene, off.places[i], 0.2)) continue;
        ++compared;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(on.radiance[i][c], off.radiance[i][c], 1e-6f * off.radiance[i][c]) << i;
    }
    EXPECT_GT(compared, 1000);
    EXPECT_EQ(off.capacity.views + off.capacity.pixels, 0u);
    EXPECT_EQ(on.capacity.views, 6u + 1u + 6u + 1u + 6u * 5u);
    EXPECT_EQ(on.capacity.emitters, off.capacity.emitters);
    // The camera's view alone is left.
    EXPECT_EQ(off.cost.enqueued("gbuffer.raster_large"), 1u);
    EXPECT_GT(on.cost.passes.size(), off.cost.passes.size());
    EXPECT_EQ(off.cost.enqueued("gbuffer.raster_views"), 0u);
    EXPECT_GT(on.cost.enqueued("gbuffer.raster_views") + on.cost.enqueued("gbuffer.raster_large"),
              1u);
    // No buffer has less than 16 bytes.
    EXPECT_EQ(on.cost.bytes - off.cost.bytes,
              on.capacity.views * sizeof(View) + on.capacity.pixels * sizeof(std::uint64_t) - 32);
}

TEST(WithoutShadows, WhatLiesUnderAPlateIsLit) {
    const Scene scene = test::shaded_floor();
    const Direct on = second_order(scene, direct_options(true));
    const Direct off = second_order(scene, direct_options(false));
    const glm::dvec3 n = glm::normalize(glm::dvec3(scene.normals[0]));
    int floor = 0, shaded = 0;
    for (std::size_t i = 0; i < off_pixels; ++i) {
        if (off.radiance[i] == glm::vec3(0.0f)) continue;
        if (std::abs(glm::dot(n, off.places[i])) > 1e-4) continue;  // the plate
        const glm::dvec3 wanted = open_floor(scene, off.places[i]);
        // The edge of the spot's cone is hard.
        const glm::dvec3 to = off.places[i] - scene.lights[1].position;
        const double off_axis =
            std::acos(glm::dot(glm::normalize(to), glm::dvec3(scene.lights[1].direction)));
        if (std::abs(off_axis - double{scene.lights[1].outer_angle}) < 1e-4) continue;
        ++floor;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(off.radiance[i][c] / wanted[c], 1.0, 2e-5) << i;
        shaded += double{on.radiance[i].y} < 0.7 * wanted.y;
    }
    EXPECT_GT(floor, 1000);
    EXPECT_GT(shaded, 200);
}

// Set anew, lights that were dark are lit as well, and nothing is allocated.
TEST(WithoutShadows, LightsMayChange) {
    Scene scene = test::shaded_floor();
    scene.lights[0].intensity = glm::vec3(0.0f);
    DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), off_queue(), device, direct_options(false));
    const std::size_t before = solver.bytes();
    scene.lights[0].intensity = {1.0f, 2.0f, 3.0f};
    device.set_light(0, scene.lights[0]);
    solver.lights_changed();
    solver.render(scene.cameras[0]).wait();
    EXPECT_EQ(test::read_frame(off_queue(), device, solver).radiance,
              second_order(scene, direct_options(false)).radiance);
    EXPECT_EQ(solver.bytes(), before);
}

// VPLs are placed through views, which are not there.
TEST(WithoutShadows, IndirectLightIsRefused) {
    const DeviceScene device = test::on_device(test::shaded_floor());
    SecondOrderOptions options = direct_options(false);
    options.indirect = true;
    EXPECT_THROW(SecondOrderSolver(test::programs(), off_queue(), device, options), Error);
    try {
        estimate(test::device().device, device, options);
        ADD_FAILURE() << "it was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("emitters.shadows"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("indirect"), std::string::npos);
    }
    options.emitters.vpls = 0;
    SecondOrderSolver without_vpls(test::programs(), off_queue(), device, options);
    EXPECT_EQ(make_emitters(device, {.shadows = false}).vpl_count, 0u);
}

// ---- what was there before ----------------------------------------------------------------

SecondOrderOptions indirect_options() {
    SecondOrderOptions out = direct_options(true);
    out.indirect = true;
    out.emitters.vpls = 60;
    out.negative_vpls = 20;
    return out;
}

TEST(WithoutEnvironment, NoneIsShown) {
    Scene scene = test::shaded_floor();
    const Direct off = second_order(scene, direct_options(true));
    test::light_by(scene, {1, 2, 3});
    const Direct on = second_order(scene, direct_options(true));
    EXPECT_EQ(off.cost.built("environment") + off.cost.enqueued("environment"), 0u);
    EXPECT_EQ(on.cost.built("image/environment"), 1u);
    EXPECT_EQ(on.cost.enqueued("image.environment"), 1u);
    EXPECT_LT(off.cost.bytes, on.cost.bytes);  // 16 shadow maps
}

TEST(WithoutTextures, KernelsAreBuiltWithout) {
    const Direct off = second_order(test::shaded_floor(), indirect_options());
    std::size_t could_read = 0;  // kernels whose text has lookups of textures
    for (const std::string& kernel : off.cost.kernels) {
        const std::string source = kernel_source(kernel.substr(0, kernel.find(' ')));
        could_read += source.find("CLGI_NO_TEXTURES") != std::string::npos;
    }
    EXPECT_EQ(off.cost.built("-DCLGI_NO_TEXTURES"), could_read);
    EXPECT_GT(could_read, 2u);
}

TEST(WithoutNegativeVpls, NoneIsPlaced) {
    SecondOrderOptions options = indirect_options();
    const Direct on = second_order(test::shaded_floor(), options);
    options.negative_vpls = 0;
    const Direct off = second_order(test::shaded_floor(), options);
    EXPECT_EQ(off.cost.built("lights/negative") + off.cost.enqueued("lights.negative"), 0u);
    EXPECT_EQ(on.cost.built("lights/negative"), 1u);
    EXPECT_EQ(on.cost.enqueued("lights.negative"), 1u);
    EXPECT_EQ(on.cost.bytes - off.cost.bytes, 20 * sizeof(Vpl) - 16);
}

TEST(WithoutSpots, NoCandidateIsTried) {
    Scene scene = test::shaded_floor();
    const Direct on = second_order(scene, indirect_options());
    scene.lights.erase(scene.lights.begin() + 1);
    const Direct off = second_order(scene, indirect_options());
    EXPECT_EQ(off.cost.built("lights/accept") + off.cost.enqueued("lights.accept"), 0u);
    EXPECT_EQ(on.cost.built("lights/accept"), 2u);
    EXPECT_EQ(on.cost.enqueued("lights.accept"), 2u);
}

// A light that is dark at first is drawn and places VPLs without a kernel being built in a frame.
TEST(DarkLights, AreLitLaterWithoutTheCompiler) {
    const Scene lit = test::shaded_floor();
    for (const bool all : {false, true}) {
        Scene scene = lit;
        for (std::size_t i = 0; i < scene.lights.size(); ++i)
            if (all || i == 1) scene.lights[i].intensity = glm::vec3(0.0f);
        const Programs own = test::own_programs();
        DeviceScene device = test::on_device(scene);
        SecondOrderOptions options = indirect_options();
        options.low_resolution_step = 4;
        SecondOrderSolver solver(own, off_queue(), device, options);
        const std::vector<std::string> kernels = own.built_kernels();
        for (std::size_t i = 0; i < scene.lights.size(); ++i) device.set_light(i, lit.lights[i]);
        solver.lights_changed();
        solver.render(scene.cameras[0]).wait();
        EXPECT_EQ(own.built_kernels(), kernels) << all;
        test::Cost cost;
        cost.add(solver.events());
        EXPECT_EQ(cost.enqueued("lights.accept"), 2u);
    }
}

// Builds, then draws the shadow maps of the scene's lights; then of each light alone.
void expect_maps_built_ahead(Scene scene, Pixels kind, std::size_t least, std::size_t most) {
    const Programs own = test::own_programs();
    const GBufferPasses gbuffer(own);
    DeviceScene device = test::on_device(scene);
    Emitters emitters(device, test::small_maps(true), kind);
    RasterBuffers lists;
    BufferTable table("maps");
    emitters.add_to(table);
    add_raster_lists(table, lists, device);
    Recorder record(off_queue(), "maps");
    table.allocate(record);
    emitters.build(gbuffer);
    const std::vector<std::string> built = own.built_kernels();
    std::set<std::string> drawn;
    const auto draw = [&] {
        record.begin({});
        emitters.write(record);
        emitters.draw(record, gbuffer, lists);
        record.wait();
        for (const PassEvent& pass : record.events()) drawn.insert(pass.name);
        EXPECT_EQ(own.built_kernels(), built);
    };
    draw();
    for (std::size_t one = 0; one < scene.lights.size(); ++one) {
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            Light light = scene.lights[i];
            if (i != one) light.intensity = glm::vec3(0.0f);
            device.set_light(i, light);
        }
        ASSERT_TRUE(emitters.update(test::small_maps(true)));
        draw();
    }
    EXPECT_EQ(drawn.size(), built.size());
    EXPECT_GE(built.size(), least);
    EXPECT_LE(built.size(), most);
}

TEST(ShadowMaps, KernelsAreBuiltAheadAndNoOthers) {
    Scene fine = test::plain_scene();
    for (const double x : {-1.8, -0.6, 0.6, 1.8}) test::add_sphere(fine, {x, 0, 0}, 0.5, 6);
    ASSERT_GT(fine.triangles.size(), 262144u);  // more than a list holds
    Scene coarse = test::plain_scene();
    test::add_sphere(coarse, {0, 0, 0}, 0.5, 1);
    const unsigned cores = test::device().device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    for (const Pixels kind : {Pixels::visibility, Pixels::depth}) {
        // One view takes lists; in a scene of many triangles they may be too short.
        for (Scene* scene : {&coarse, &fine}) {
            scene->lights = {test::spot_light({0, 2, 0}, {0.1f, -1.0f, 0.0f}, 0.5)};
            const std::size_t wanted = scene == &fine ? 4 : 3;
            expect_maps_built_ahead(*scene, kind, wanted, wanted);
        }
        // Enough of them are drawn one a core, and one alone by lists.
        coarse.lights.assign(2 * cores, coarse.lights[0]);
        expect_maps_built_ahead(coarse, kind, 3, 4);
    }
}

TEST(WithoutIndirectLight, NoVplIsPlacedOrGathered) {
    SecondOrderOptions options = indirect_options();
    const Direct on = second_order(test::shaded_floor(), options);
    for (const bool asked : {false, true}) {
        options.indirect = asked;
        options.emitters.vpls = 0;
        const Direct off = second_order(test::shaded_floor(), options);
        for (const char* name : {"lights.", "image.gather", "image.upsample"}) {
            EXPECT_EQ(off.cost.enqueued(name), 0u) << name;
            EXPECT_GT(on.cost.enqueued(name), 0u) << name;
        }
        EXPECT_EQ(off.cost.built("lights/") + off.cost.built("image/gather"), 0u);
        EXPECT_LT(off.cost.bytes, on.cost.bytes);
    }
}

TEST(WithoutLights, NothingIsEnqueued) {
    Scene scene = test::shaded_floor();
    scene.lights.clear();
    const Direct dark = second_order(scene, indirect_options());
    EXPECT_EQ(dark.cost.passes.size(), 0u);
    EXPECT_EQ(dark.cost.built("lights/"), 0u);
    for (const glm::vec3& value : dark.radiance) EXPECT_EQ(value, glm::vec3(0.0f));
}

}  // namespace
}  // namespace clgi
