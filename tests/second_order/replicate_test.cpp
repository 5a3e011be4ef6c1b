// Randomised replicates, and solvers that change their options.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <cmath>

#include "frames.hpp"
#include "lab/preview.hpp"
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

io::Image picture(SecondOrderSolver& solver, const Camera& camera) {
    solver.render(camera);
    return lab::radiance_picture(test::device().queue, solver);
}

bool equal(const io::Image& a, const io::Image& b) {
    for (int c = 0; c < 3; ++c)
        if (!test::same_bits(a.channels[c].values, b.channels[c].values)) return false;
    return true;
}

TEST(Replicate, ZeroIsTheSequenceItselfAndOthersAreNot) {
    for (const LightSource lamp : {LightSource::spot, LightSource::point, LightSource::area}) {
        const Scene scene = cornell({.light = lamp});
        const DeviceScene device = test::on_device(scene);
        SecondOrderSolver solver(test::programs(), test::device().queue, device,
                                 options_for(200, 40));
        const io::Image plain = picture(solver, scene.cameras[0]);
        solver.set_replicate(7);
        const io::Image seven = picture(solver, scene.cameras[0]);
        solver.set_replicate(8);
        const io::Image eight = picture(solver, scene.cameras[0]);
        EXPECT_FALSE(equal(plain, seven));
        EXPECT_FALSE(equal(seven, eight));
        solver.set_replicate(7);
        EXPECT_TRUE(equal(seven, picture(solver, scene.cameras[0])));
        solver.set_replicate(0);
        EXPECT_TRUE(equal(plain, picture(solver, scene.cameras[0])));
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
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, options_for(50, 0));
    constexpr int count = 5;
    const lab::Replicates found =
        lab::replicate(test::device().queue, solver, scene.cameras[0], count).value();
    EXPECT_EQ(solver.options().emitters.replicate, 0u);
    std::vector<io::Image> each;
    for (int k = 1; k <= count; ++k) {
        solver.set_replicate(static_cast<std::uint32_t>(k));
        each.push_back(picture(solver, scene.cameras[0]));
    }
    double whole = 0.0, spread = 0.0;
    const std::size_t pixels = each[0].channels[0].values.size();
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto luminance = [&](int k) {
            return 0.2126 * each[k].channels[0].values[i] + 0.7152 * each[k].channels[1].values[i] +
                   0.0722 * each[k].channels[2].values[i];
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
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, options_for(50, 0));
    solver.set_replicate(9);
    int asked = 0;
    EXPECT_FALSE(lab::replicate(test::device().queue, solver, scene.cameras[0], 100,
                                [&](double) { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(solver.options().emitters.replicate, 9u);
}

// Lights close to what they light spoil the low-discrepancy rate pixel by pixel: about N^-1/2
// stays.
TEST(Replicate, ErrsLessThanHalfWithSixteenTimesTheLights) {
    const Scene scene = cornell({.light = LightSource::spot});
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, options_for(100, 0));
    const auto error = [&](int lights) {
        solver.reconfigure(options_for(lights, 0));
        return lab::replicate(test::device().queue, solver, scene.cameras[0], 12)->single_error;
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
        EXPECT_TRUE(equal(picture(solver, scene.cameras[0]), picture(fresh, scene.cameras[0])));
        EXPECT_EQ(solver.bytes(), fresh.bytes());
    }
    SecondOrderOptions fast = options_for(60, 10);
    fast.build.math = Math::fast;
    EXPECT_THROW(solver.reconfigure(fast), Error);
    fast = options_for(60, -1);
    EXPECT_THROW(solver.reconfigure(fast), Error);
}

}  // namespace
}  // namespace clgi
