// Randomised replicates, and solvers that change their options.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <clgi/renderer.hpp>
#include <cmath>

#include "frames.hpp"
#include "lab/replicates.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

SecondOrderOptions options_for(int lights, int negative) {
    SecondOrderOptions options;
    options.width = 48;
    options.height = 36;
    options.emitters.vpls = lights;
    options.emitters.shadow_size = 128;
    options.emitters.face_size = 64;
    options.emitters.area_samples = 4;
    options.negative_vpls = negative;
    return options;
}

RendererOptions of_renderer(const SecondOrderOptions& options) {
    RendererOptions out;
    out.picture.width = options.width;
    out.picture.height = options.height;
    out.picture.emitters = options.emitters;
    out.second_order = options;
    return out;
}

using Radiances = std::vector<glm::vec3>;

Radiances picture(SecondOrderSolver& solver, const Camera& camera) {
    solver.render(camera);
    return test::vectors(test::device().queue, solver.radiance(), solver.stride(),
                         static_cast<std::size_t>(solver.options().width) *
                             static_cast<std::size_t>(solver.options().height));
}

TEST(Replicate, ZeroIsTheSequenceItselfAndOthersAreNot) {
    for (const LightSource lamp : {LightSource::spot, LightSource::point, LightSource::area}) {
        const Scene scene = cornell({.light = lamp});
        const DeviceScene device = test::on_device(scene);
        SecondOrderSolver solver(test::programs(), test::device().queue, device,
                                 options_for(200, 40));
        const Radiances plain = picture(solver, scene.cameras[0]);
        solver.set_replicate(7);
        const Radiances seven = picture(solver, scene.cameras[0]);
        solver.set_replicate(8);
        const Radiances eight = picture(solver, scene.cameras[0]);
        EXPECT_FALSE(test::same_bits(plain, seven));
        EXPECT_FALSE(test::same_bits(seven, eight));
        solver.set_replicate(7);
        EXPECT_TRUE(test::same_bits(seven, picture(solver, scene.cameras[0])));
        solver.set_replicate(0);
        EXPECT_TRUE(test::same_bits(plain, picture(solver, scene.cameras[0])));
    }
}

TEST(Replicate, AcceptsAsManyLightsAsTheSequenceDoes) {
    const Scene scene = cornell({.light = LightSource::spot});
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, options_for(300, 0));
    int before = 0;
    for (std::uint32_t replicate = 0; replicate < 20; ++replicate) {
        solver.set_replicate(replicate);
        solver.render(scene.cameras[0]);
        test::device().queue.finish();
        int lit = 0;
        for (const Vpl& light : test::download<Vpl>(solver.vpls(), 300)) lit += light.flux.w > 0.0f;
        // Part of the cone leaves by the open side: which lights do depends on the shift.
        EXPECT_GT(lit, 270) << replicate;
        if (replicate > 0) {
            EXPECT_LE(std::abs(lit - before), 6) << replicate;
        }
        before = lit;
    }
}

TEST(Replicate, ReportsTheStandardErrorOfItsMean) {
    const Scene scene = cornell({.light = LightSource::spot});
    DeviceScene device = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, device,
                      of_renderer(options_for(50, 0)));
    renderer.build();
    SecondOrderSolver& solver = *renderer.second_order();
    constexpr int count = 5;
    const lab::Replicates found = lab::replicate(renderer, scene.cameras[0], count).value();
    EXPECT_EQ(solver.options().emitters.replicate, 0u);
    std::vector<Radiances> each;
    for (int k = 1; k <= count; ++k) {
        solver.set_replicate(static_cast<std::uint32_t>(k));
        each.push_back(picture(solver, scene.cameras[0]));
    }
    double whole = 0.0, spread = 0.0;
    const std::size_t pixels = each[0].size();
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto luminance = [&](int k) {
            const glm::vec3& rgb = each[k][i];
            return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
        };
        double mean = 0.0, square = 0.0;
        for (int k = 0; k < count; ++k) mean += luminance(k) / count;
        for (int k = 0; k < count; ++k) square += std::pow(luminance(k) - mean, 2);
        const double error = std::sqrt(square / (count - 1) / count);
        EXPECT_NEAR(found.mean.find("error.Y")->values[i], error, 1e-5 * mean + 1e-9);
        whole += mean;
        spread += square / (count - 1);
    }
    const double wanted = std::sqrt(spread / pixels) / (whole / pixels);
    EXPECT_NEAR(found.single_error, wanted, 1e-4 * wanted);
    EXPECT_NEAR(found.error, wanted / std::sqrt(count), 1e-4 * wanted);
}

TEST(Replicate, IsCancelledBetweenTwoAndLeavesTheSolverAsItWas) {
    const Scene scene = cornell({.light = LightSource::spot});
    DeviceScene device = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, device,
                      of_renderer(options_for(50, 0)));
    renderer.build();
    SecondOrderSolver& solver = *renderer.second_order();
    solver.set_replicate(9);
    int asked = 0;
    EXPECT_FALSE(
        lab::replicate(renderer, scene.cameras[0], 100, [&](double) { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(solver.options().emitters.replicate, 9u);
}

// Lights close to what they light spoil the low-discrepancy rate pixel by pixel: about N^-1/2
// stays.
TEST(Replicate, ErrsLessThanHalfWithSixteenTimesTheLights) {
    const Scene scene = cornell({.light = LightSource::spot});
    DeviceScene device = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, device,
                      of_renderer(options_for(100, 0)));
    renderer.build();
    SecondOrderSolver& solver = *renderer.second_order();
    const auto error = [&](int lights) {
        solver.reconfigure(options_for(lights, 0));
        return lab::replicate(renderer, scene.cameras[0], 12)->single_error;
    };
    const double few = error(100), more = error(1600);
    EXPECT_LT(more, 0.5 * few);
}

TEST(Reconfigure, IsAsGoodAsANewSolver) {
    const Scene scene = cornell({.light = LightSource::spot});
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, options_for(60, 10));
    std::vector<SecondOrderOptions> others(5, options_for(90, 20));
    others[1].low_resolution_step = 1;
    others[2].low_resolution_step = 2;
    others[2].discontinuity_threshold = std::numeric_limits<float>::infinity();
    others[3].width = 131;
    others[3].direct = false;
    others[4].indirect = false;
    for (const SecondOrderOptions& options : others) {
        solver.reconfigure(options);
        SecondOrderSolver fresh(test::programs(), test::device().queue, device, options);
        EXPECT_TRUE(
            test::same_bits(picture(solver, scene.cameras[0]), picture(fresh, scene.cameras[0])));
        EXPECT_EQ(solver.bytes(), fresh.bytes());
    }
    SecondOrderOptions fast = options_for(60, 10);
    fast.build.math = Math::fast;
    EXPECT_THROW(solver.reconfigure(fast), Error);
    fast = options_for(60, -1);
    EXPECT_THROW(solver.reconfigure(fast), Error);
}

TEST(Reconfigure, OfARendererIsAsGoodAsANewRenderer) {
    const Scene scene = cornell({.light = LightSource::spot});
    DeviceScene device = test::on_device(scene);
    RendererOptions options = of_renderer(options_for(60, 10));
    options.vpls.count = 50;
    options.layout.size = 64;
    options.antiradiance.elements.requested = 200;
    options.antiradiance.bins = 32;
    options.transfer.masks.size = 8;
    PictureOptions other = options.picture;
    other.width = 131;
    other.direct = false;
    for (const Method method : {Method::direct, Method::second_order, Method::light_atlas,
                                Method::antiradiance, Method::dynamic_transfer}) {
        const auto made = [&](const PictureOptions& picture) {
            options.method = method;
            options.picture = picture;
            return std::make_unique<Renderer>(test::programs(), test::device().queue, scene, device,
                                              options);
        };
        const auto changed = made(options.picture), fresh = made(other);
        changed->render(scene.cameras[0]);
        changed->reconfigure(other);
        changed->render(scene.cameras[0]);
        fresh->render(scene.cameras[0]);
        EXPECT_EQ(changed->read_radiance(), fresh->read_radiance()) << name_of(method);
        options.picture = of_renderer(options_for(60, 10)).picture;
        PictureOptions fast = other;
        fast.build.math = Math::fast;
        EXPECT_THROW(changed->reconfigure(fast), Error) << name_of(method);
        EXPECT_EQ(changed->options().picture.build.math, other.build.math);
    }
}

}  // namespace
}  // namespace clgi
