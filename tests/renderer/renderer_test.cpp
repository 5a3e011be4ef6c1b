// One class for all methods: it shows what solver and view show, follows changes, and says what it
// did.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <numbers>

#include "lab/scenes/interiors.hpp"
#include "moving_box.hpp"
#include "planned_pictures.hpp"
#include "skies.hpp"
#include "slanted_room.hpp"

namespace clgi {
namespace {

using test::Radiances;

constexpr Method all_methods[] = {Method::direct,           Method::second_order,
                                  Method::light_atlas,      Method::antiradiance,
                                  Method::dynamic_transfer, Method::irradiance_cache};

// A floor with a box on it, and a leaning wall, under a lamp and a coloured sky that is no two
// alike in any direction.
Scene open_scene() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_floor(scene, 2.0);
    test::add_box(scene, {-0.4, 0.0, -0.3}, {0.2, 0.5, 0.3}, 1);
    test::add_quad(scene,
                   {{{-1.2, 0.0, -0.8}, {0.9, 0.0, -1.1}, {0.8, 1.4, -1.5}, {-1.3, 1.2, -1.2}}});
    scene.lights = {test::point_light({0.6, 1.3, 0.7}, 1.0f)};
    scene.lights[0].intensity = {3.0f, 1.0f, 0.5f};
    Environment sky = test::picture_sky(16, 8, [](int row, int column) {
        return row < 5 ? 0.2f + 0.05f * static_cast<float>(row * column % 7) : 0.0f;
    });
    sky.factor = {0.4f, 0.6f, 1.1f};
    scene.environment = sky;
    return scene;
}

Camera eye() { return test::camera_at({1.4, 1.2, 1.6}, {0.0, 0.3, -0.2}); }

RendererOptions quick(Method method) {
    RendererOptions out;
    out.method = method;
    out.picture.width = test::plan_width;
    out.picture.height = test::plan_height;
    out.picture.emitters.shadow_size = out.picture.emitters.face_size = 128;
    out.picture.build = test::usual_build();
    out.light_atlas.emitters.shadow_size = 256;
    out.vpls.count = 60;
    out.layout.size = 64;
    out.least_change = 0.0;
    out.antiradiance.bins = 32;
    out.antiradiance.elements.requested = 200;
    out.transfer.masks.size = 16;
    out.cache.seen = out.cache.met = 60;
    out.cache.refined = 20;
    out.cache.face = 16;
    return out;
}

Radiances picture_of(Renderer& renderer, const Camera& camera = eye()) {
    renderer.render(camera);
    const auto planes = renderer.read_radiance();
    Radiances out;
    for (std::size_t i = 0; i < planes[0].size(); ++i)
        out.emplace_back(planes[0][i], planes[1][i], planes[2][i]);
    return out;
}

Radiances fresh(const Scene& scene, Method method) {
    Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
    return picture_of(renderer);
}

double change(const Radiances& a, const Radiances& b) {
    return test::distance(a, b) / test::mean(b);
}

// Each method put together by hand, bit for bit.
TEST(Renderer, ShowsWhatSolverAndViewShow) {
    const Scene scene = open_scene();
    const DeviceScene device = test::on_device(scene);
    const cl::CommandQueue& queue = test::device().queue;
    const Programs& programs = test::programs();
    const auto shown = [&](const auto& picture) {
        return test::vectors(queue, picture.radiance(), picture.stride(),
                             std::size_t{test::plan_width} * test::plan_height);
    };
    {
        SecondOrderOptions options;
        options.width = test::plan_width;
        options.height = test::plan_height;
        options.emitters.shadow_size = options.emitters.face_size = 128;
        options.build = test::usual_build();
        SecondOrderSolver solver(programs, queue, device, options);
        solver.render(eye()).wait();
        EXPECT_EQ(fresh(scene, Method::second_order), shown(solver));
        options.indirect = false;
        solver.reconfigure(options);
        solver.render(eye()).wait();
        EXPECT_EQ(fresh(scene, Method::direct), shown(solver));
    }
    {
        const RendererOptions o = quick(Method::light_atlas);
        const BakeLayout layout = make_bake_layout(scene, o.vpls, o.layout);
        LightAtlasOptions baked = o.light_atlas;
        baked.build = o.picture.build;
        LightAtlasSolver solver(programs, queue, device, layout.vpls, layout.atlas, baked);
        LightAtlasView view(programs, queue, device, layout.atlas, o.picture);
        solver.run();
        view.render(eye(), solver.irradiance_planes(), solver.stride()).wait();
        EXPECT_EQ(fresh(scene, Method::light_atlas), shown(view.picture()));
    }
    {
        const RendererOptions o = quick(Method::antiradiance);
        AntiradianceOptions options = o.antiradiance;
        options.emitters = o.picture.emitters;
        options.build = o.picture.build;
        AntiradianceSolver solver(programs, queue, scene, device, options);
        AntiradianceView view(programs, queue, device, solver, o.picture);
        solver.run();
        view.render(eye()).wait();
        EXPECT_EQ(fresh(scene, Method::antiradiance), shown(view.picture()));
    }
    {
        const RendererOptions o = quick(Method::dynamic_transfer);
        DynamicTransferOptions options = o.transfer;
        options.build = o.picture.build;
        DynamicTransferSolver solver(programs, queue, scene, device, options);
        DynamicTransferViewOptions seen = o.transfer_view;
        seen.picture = o.picture;
        DynamicTransferView view(programs, queue, device, solver, seen);
        solver.run();
        view.render(eye()).wait();
        EXPECT_EQ(fresh(scene, Method::dynamic_transfer), shown(view.picture()));
    }
}

// What changes is as if the scene had been loaded so: sums of differences alone are rounded anew.
TEST(Renderer, FollowsLights) {
    const Scene scene = open_scene();
    Scene changed = scene;
    changed.lights[0].position = {-0.7, 0.9, 0.6};
    changed.lights[0].intensity = {0.5f, 2.0f, 3.0f};
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        const Radiances before = picture_of(renderer);
        renderer.scene().set_light(0, changed.lights[0]);
        renderer.lights_changed();
        const Radiances after = picture_of(renderer), wanted = fresh(changed, method);
        EXPECT_LT(change(after, wanted), 1e-4);
        EXPECT_GT(change(before, wanted), 0.05);
    }
}

// A spot wider than 60 degrees needs the six views of a cube, and a lamp may become a sun: buffers
// grow, whatever the method.
TEST(Renderer, FollowsLightsThatOutgrowTheirBuffers) {
    Scene scene = open_scene();
    scene.lights = {test::spot_light({0.4, 1.5, 0.6}, {-0.2, -1.0, -0.3}, 0.5, 4.0f),
                    test::spot_light({-0.8, 1.0, 0.5}, {0.4, -1.0, -0.2}, 0.6, 1.0f)};
    scene.lights[0].intensity = {4.0f, 2.0f, 1.0f};
    Scene changed = scene;
    changed.lights[0].outer_angle = changed.lights[0].inner_angle = 1.3f;
    changed.lights[1] = test::directional_light({0.3f, -1.0f, -0.4f}, 0.7f);
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        RendererOptions options = quick(method);
        options.picture.emitters.shadow_size = 32;  // fewer pixels than a cube
        options.light_atlas.emitters.shadow_size = 32;
        Renderer renderer(test::programs(), test::device().queue, scene, options);
        picture_of(renderer);
        const std::size_t before = renderer.bytes();
        for (std::size_t i = 0; i < 2; ++i) renderer.scene().set_light(i, changed.lights[i]);
        renderer.lights_changed();
        const Radiances after = picture_of(renderer);
        Renderer wanted(test::programs(), test::device().queue, changed, options);
        EXPECT_LT(change(after, picture_of(wanted)), 1e-4);
        EXPECT_GT(renderer.bytes(), before);
        EXPECT_EQ(renderer.status().non_finite, 0u);
    }
}

TEST(Renderer, FollowsATurnedSky) {
    const Scene scene = open_scene();
    Scene turned = scene;
    turned.environment->rotation = 1.3f;
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        const Radiances before = picture_of(renderer);
        renderer.scene().turn_environment(1.3);
        renderer.environment_changed();
        const Radiances after = picture_of(renderer), wanted = fresh(turned, method);
        EXPECT_LT(change(after, wanted), 1e-4);
        EXPECT_GT(change(before, wanted), 0.01);
        // Angles count from what was uploaded.
        renderer.scene().turn_environment(0.0);
        renderer.environment_changed();
        EXPECT_LT(change(picture_of(renderer), before), 1e-4);
    }
}

TEST(Renderer, RefusesSkiesThatAreNotThere) {
    Scene scene = test::slanted_room();
    Renderer renderer(test::programs(), test::device().queue, scene, quick(Method::direct));
    EXPECT_THROW(renderer.scene().turn_environment(1.0), Error);
    scene.environment = test::even_sky({1.0f, 2.0f, 3.0f});
    Renderer under_a_sky(test::device().queue, scene, quick(Method::direct));
    EXPECT_THROW(under_a_sky.scene().turn_environment(std::numeric_limits<double>::infinity()),
                 Error);
}

// The box moves through the room: links follow it, masks are made anew, a bake has a volume for it.
TEST(Renderer, FollowsGeometry) {
    Scene scene = test::moving_box_room();
    scene.moving_bounds = motion_bounds(scene, 0);
    const cl::CommandQueue& queue = test::device().queue;
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        DeviceScene device = test::on_device(scene);
        RendererOptions options = quick(method);
        options.animated = true;
        Renderer renderer(test::programs(), queue, scene, device, options);
        SceneAnimator animator(test::programs(), queue, scene, device);
        const auto at = [&](double time) {
            const Animated step = animator.animate(0, time);
            if (step.lights) renderer.lights_changed();
            renderer.geometry_changed({step.done});
            return picture_of(renderer, scene.cameras[0]);
        };
        const Radiances first = at(0.0), last = at(1.0), again = at(0.0);
        EXPECT_GT(change(last, first), 0.02);
        EXPECT_LT(change(again, first), 1e-5);
        EXPECT_EQ(renderer.status().non_finite, 0u);
    }
}

TEST(Renderer, BakesWhatStandsStillAlone) {
    const Scene scene = test::slanted_room();
    Renderer renderer(test::programs(), test::device().queue, scene, quick(Method::light_atlas));
    renderer.build();
    EXPECT_THROW(renderer.geometry_changed(), Error);
}

// With one bin for each leaf the light of the office grows at each reflection: there is no result.
TEST(Renderer, SaysThatAnIterationWasGivenUp) {
    const Scene scene = office();
    RendererOptions options = quick(Method::antiradiance);
    options.antiradiance.bins = 128;
    options.antiradiance.elements.requested = 4000;
    options.antiradiance.links.spread = Spread::none;
    Renderer renderer(test::programs(), test::device().queue, scene, options);
    EXPECT_FALSE(renderer.prepare());
    EXPECT_TRUE(renderer.status().given_up);
    EXPECT_FALSE(renderer.status().converged);
    // A picture has direct light, and the exchange is not tried again for it.
    const std::size_t before = renderer.times().size();
    picture_of(renderer, scene.cameras[0]);
    EXPECT_GT(renderer.times().size(), before);
}

TEST(Renderer, PreparesWhereThatWasForgotten) {
    const Scene scene = open_scene();
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer prepared(test::programs(), test::device().queue, scene, quick(method));
        EXPECT_TRUE(prepared.prepare([](double) { return true; }));
        EXPECT_EQ(picture_of(prepared), fresh(scene, method));
    }
}

TEST(Renderer, EndsWhereItIsCancelled) {
    const Scene scene = open_scene();
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        EXPECT_FALSE(renderer.prepare([](double) { return false; }));
        EXPECT_FALSE(renderer.run(eye(), [](double) { return false; }));
        EXPECT_EQ(picture_of(renderer), fresh(scene, method));
    }
}

TEST(Renderer, HasTheTimesOfWhatWasDoneForThePicture) {
    const Scene scene = open_scene();
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        picture_of(renderer);
        const std::size_t first = renderer.times().size();
        picture_of(renderer);
        const std::size_t second = renderer.times().size();
        EXPECT_GT(second, 0u);
        if (method == Method::direct || method == Method::second_order ||
            method == Method::irradiance_cache) {
            EXPECT_EQ(first, second);
        } else {
            EXPECT_LT(second, first);  // nothing is prepared for the second
        }
    }
}

TEST(Renderer, EstimatesBeforeItAllocates) {
    const Scene scene = open_scene();
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        const Estimate estimate = renderer.estimate();
        EXPECT_GT(estimate.milliseconds, 0.0);
        EXPECT_THROW(renderer.bytes(), Error);
        renderer.build();
        EXPECT_THROW(renderer.estimate(), Error);
        // Views have a picture of their own, and a bake's texels are only guessed.
        EXPECT_GT(renderer.bytes(), estimate.bytes / 8);
        if (method == Method::direct || method == Method::second_order) {
            EXPECT_EQ(renderer.bytes(), estimate.bytes);
        }
    }
}

TEST(Renderer, LightsAGivenGBufferBySecondOrderAlone) {
    const Scene scene = open_scene();
    for (const Method method : all_methods) {
        SCOPED_TRACE(name_of(method));
        Renderer renderer(test::programs(), test::device().queue, scene, quick(method));
        const Radiances drawn = picture_of(renderer);
        if (SecondOrderSolver* solver = renderer.second_order()) {
            renderer.render(eye(), solver->gbuffer());
            const auto planes = renderer.read_radiance();
            for (std::size_t i = 0; i < drawn.size(); ++i)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(planes[static_cast<std::size_t>(c)][i], drawn[i][c]) << i;
        } else {
            EXPECT_THROW(renderer.render(eye(), GBuffer()), Error);
        }
    }
}

TEST(Renderer, RefusesOptionsOutOfRange) {
    RendererOptions options = quick(Method::light_atlas);
    options.least_change = -1.0;
    EXPECT_THROW(Renderer(test::programs(), test::device().queue, open_scene(), options), Error);
    options = quick(Method::light_atlas);
    options.vpls.count = 1u << 31;
    Renderer renderer(test::programs(), test::device().queue, open_scene(), options);
    EXPECT_THROW(renderer.estimate(), DeviceError);
    EXPECT_THROW(renderer.build(), DeviceError);
}

TEST(Methods, HaveTheNamesOfTheProgram) {
    for (const Method method : all_methods) EXPECT_EQ(method_of(name_of(method)), method);
    EXPECT_FALSE(method_of("auto"));
}

}  // namespace
}  // namespace clgi
