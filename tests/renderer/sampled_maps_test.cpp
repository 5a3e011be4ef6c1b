// Shadow maps that several samples of a picture share.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/kit/picture.hpp>
#include <clgi/clgi.hpp>
#include <clgi/second_order.hpp>

#include "device.hpp"
#include "frames.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr int size = 64;  // of maps, and of pictures

Scene sunlit() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_floor(scene, 2.0);
    test::add_quad(scene,
                   {{{-1.2, 0.0, -0.8}, {0.9, 0.0, -1.1}, {0.8, 1.4, -1.5}, {-1.3, 1.2, -1.2}}});
    scene.lights = {test::directional_light({-0.3f, -1.0f, -0.4f}, 2.0f),
                    test::spot_light({-1.0, 1.5, 1.0}, {0.6f, -1.0f, -0.7f}, 0.4, 3.0f)};
    scene.lights[0].intensity = {3.0f, 2.0f, 1.0f};
    return scene;
}

Camera from_aside() { return test::camera_at({1.4, 1.2, 1.6}, {0.0, 0.3, -0.2}); }

// maps: of how many pictures' pixels one has.
RendererOptions shared_maps(Method method, int maps) {
    RendererOptions out;
    out.method = method;
    out.picture.width = size;
    out.picture.height = size / maps;
    out.picture.emitters.shadow_size = size;
    out.picture.build = test::usual_build();
    out.second_order.emitters.vpls = 20;
    out.second_order.negative_vpls = 0;
    out.second_order.discontinuity_threshold = 0.0f;
    out.cache.seen = 20;
    out.cache.met = 30;
    out.cache.refined = 10;
    out.cache.face = 8;
    out.cache.spots = 0;
    return out;
}

// Views of the lights that were drawn for the last picture, beside those of the camera.
std::size_t maps_drawn(const Renderer& renderer, int samples) {
    std::size_t triangles = 0, of_all = 0;
    for (const PassEvent& pass : renderer.times()) {
        if (pass.name != "gbuffer.raster") continue;
        of_all += pass.items;
        triangles = triangles == 0 ? pass.items : std::min(triangles, pass.items);
    }
    return triangles == 0 ? 0 : of_all / triangles - static_cast<std::size_t>(samples);
}

TEST(SampledMaps, AreDrawnForSixteenSamplesOrForMoreOfSmallPictures) {
    constexpr int samples = 33;
    for (const Method method : {Method::direct, Method::second_order, Method::irradiance_cache}) {
        // Two maps for samples 0, 16 and 32.
        RendererOptions options = shared_maps(method, 1);
        options.samples = samples;
        Renderer usual(test::programs(), test::device().queue, sunlit(), options);
        usual.render(from_aside()).wait();
        EXPECT_EQ(maps_drawn(usual, samples), 6u) << name_of(method);
        // Maps with 2,048 times as many pixels as the picture serve 128 samples.
        options = shared_maps(method, size);
        options.picture.width = 4;
        options.samples = samples;
        Renderer small(test::programs(), test::device().queue, sunlit(), options);
        small.render(from_aside()).wait();
        EXPECT_EQ(maps_drawn(small, samples), 2u) << name_of(method);
    }
}

// A solver whose samples share maps has the picture of one that is made for that sample.
TEST(SampledMaps, AreThoseOfTheSample) {
    const Scene scene = sunlit();
    SecondOrderOptions options;
    options.width = options.height = size;
    options.emitters.vpls = 50;
    options.emitters.shadow_size = size;
    options.build = test::usual_build();
    DeviceScene placed = test::on_device(scene);
    const auto pictured = [&](SecondOrderSolver& solver) {
        solver.render(from_aside()).wait();
        return test::read_frame(test::device().queue, placed, solver);
    };
    const auto expect_fresh = [&](SecondOrderSolver& solver, std::uint32_t sample,
                                  std::uint32_t replicate) {
        SecondOrderOptions fresh = options;
        fresh.emitters.sample = sample / 16;
        fresh.emitters.vpl_sample = sample;
        fresh.emitters.replicate = replicate;
        SecondOrderSolver other(test::programs(), test::device().queue, placed, fresh);
        const test::Frame found = pictured(solver), wanted = pictured(other);
        EXPECT_TRUE(test::same_bits(found.radiance, wanted.radiance)) << sample;
        EXPECT_TRUE(test::same_bits(found.lights, wanted.lights)) << sample;
        return found;
    };
    SecondOrderSolver solver(test::programs(), test::device().queue, placed, options);
    const test::Frame first = expect_fresh(solver, 0, 0);
    for (const std::uint32_t sample : {1u, 2u, 17u, 18u, 15u}) {
        solver.set_sample(sample);
        const test::Frame later = expect_fresh(solver, sample, 0);
        EXPECT_FALSE(test::same_bits(first.lights, later.lights)) << sample;
    }
    // Maps of other points, or under other lights, are none of this sample's.
    solver.set_replicate(3);
    solver.set_sample(14);
    expect_fresh(solver, 14, 3);
    solver.set_sample(13);
    Light turned = scene.lights[0];
    turned.direction = glm::normalize(glm::vec3(0.5f, -1.0f, 0.2f));
    placed.set_light(0, turned);
    solver.lights_changed();
    expect_fresh(solver, 13, 3);
    // So do lights that the solver finds changed.
    solver.set_sample(11);
    expect_fresh(solver, 11, 3);
    turned.direction = glm::normalize(glm::vec3(-0.2f, -1.0f, 0.6f));
    placed.set_light(0, turned);
    solver.set_sample(10);
    expect_fresh(solver, 10, 3);
    // Nothing is kept of a picture that was cancelled.
    turned.direction = glm::normalize(glm::vec3(0.4f, -1.0f, 0.5f));
    placed.set_light(0, turned);
    solver.lights_changed();
    EXPECT_FALSE(solver.run(from_aside(), [](double) { return false; }));
    solver.set_sample(9);
    expect_fresh(solver, 9, 3);
    // A picture that is drawn again without another sample has maps of its own.
    SceneMover mover(test::programs(), test::device().queue, placed);
    solver.set_sample(12);
    expect_fresh(solver, 12, 3);
    solver.set_sample(11);
    expect_fresh(solver, 11, 3);
    mover.move(4, {{-1.2, 0.0, -0.2}, {0.9, 0.0, -0.5}, {0.8, 1.4, -0.9}, {-1.3, 1.2, -0.6}}, {})
        .wait();
    expect_fresh(solver, 11, 3);
    // Sample 0 begins a picture, of whatever has moved.
    mover.move(4, {{-1.2, 0.0, -0.5}, {0.9, 0.0, -0.8}, {0.8, 1.4, -1.2}, {-1.3, 1.2, -0.9}}, {})
        .wait();
    solver.set_sample(0);
    expect_fresh(solver, 0, 3);
    // And none of those that the options may name.
    options.emitters.sample = 5;
    SecondOrderSolver other(test::programs(), test::device().queue, placed, options);
    other.set_sample(0);
    expect_fresh(other, 0, 0);
}

// The same of what the other methods draw their pictures with.
TEST(SampledMaps, OfAPictureAreThoseOfTheSceneAsItIs) {
    const Scene scene = sunlit();
    DeviceScene placed = test::on_device(scene);
    PictureOptions options;
    options.width = options.height = size;
    options.emitters.shadow_size = size;
    options.build = test::usual_build();
    const cl::CommandQueue& queue = test::device().queue;
    const auto maps_of = [&](Picture& picture) {
        picture.begin(from_aside(), {});
        picture.record().wait();
        return test::download<std::uint32_t>(picture.emitter_buffers().visibility, 2 * size * size);
    };
    const auto fresh = [&] {
        Picture picture(test::programs(), queue, placed, options, "fresh");
        picture.allocate(picture.table());
        return maps_of(picture);
    };
    Picture picture(test::programs(), queue, placed, options, "test");
    picture.allocate(picture.table());
    EXPECT_EQ(maps_of(picture), fresh());
    picture.sample(1);
    const std::size_t all = picture.events().size();
    EXPECT_EQ(maps_of(picture), fresh());
    EXPECT_LT(picture.events().size(), all);  // no map was drawn
    EXPECT_EQ(maps_of(picture), fresh());
    EXPECT_EQ(picture.events().size(), all);
    // Other lights; other geometry with the same sample, and with the first one.
    picture.sample(2);
    Light turned = scene.lights[0];
    turned.direction = glm::normalize(glm::vec3(0.5f, -1.0f, 0.2f));
    placed.set_light(0, turned);
    picture.lights_changed();
    EXPECT_EQ(maps_of(picture), fresh());
    SceneMover mover(test::programs(), queue, placed);
    const auto move = [&](double z) {
        mover
            .move(4,
                  {{-1.2, 0.0, z}, {0.9, 0.0, z - 0.3}, {0.8, 1.4, z - 0.7}, {-1.3, 1.2, z - 0.4}},
                  {})
            .wait();
    };
    picture.sample(3);
    move(-0.2);
    picture.lights_changed();
    EXPECT_EQ(maps_of(picture), fresh());
    picture.sample(4);
    move(-0.5);
    picture.sample(0);
    EXPECT_EQ(maps_of(picture), fresh());
}

TEST(SampledMaps, RunWaitsForAllSamples) {
    RendererOptions options = shared_maps(Method::second_order, 1);
    options.samples = 5;
    Renderer renderer(test::programs(), test::device().queue, sunlit(), options);
    ASSERT_TRUE(renderer.run(from_aside(), nullptr));
    for (const PassEvent& pass : renderer.times())
        EXPECT_EQ(pass.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE)
            << pass.name;
}

}  // namespace
}  // namespace clgi
