// Animated characters by dynamic transfer: at every time what rays from the same vertices find, and
// nothing that pops from one time to the next.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/io/gltf.hpp>
#include <filesystem>
#include <numbers>
#include "lab/scenes/deforming.hpp"

#include "posing.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// A scene that plays on the device, lit by a gradient of three colours.
struct Player {
    explicit Player(Scene file)
        : scene(lit(std::move(file))),
          device(test::on_device(scene)),
          solver(test::programs(), test::device().queue, scene, device),
          animator(test::device().queue, scene, device) {}

    static Scene lit(Scene file) {
        file.lights.clear();
        test::light_by_gradient(file, {0.8f, 1.0f, 1.4f},
                                glm::normalize(glm::dvec3(0.4, 0.7, -0.6)));
        file.moving_bounds = motion_bounds(file, 0);
        return file;
    }

    std::vector<glm::dvec3> at(double seconds) {
        const Animated moved = animator.animate(0, seconds);
        solver.transfer({moved.done});
        solver.light().wait();
        EXPECT_EQ(solver.status().non_finite, 0u);
        return test::irradiance_of(solver, device);
    }

    double duration() const { return scene.animation->clips[0].duration; }

    Scene scene;
    DeviceScene device;
    DynamicTransferSolver solver;
    SceneAnimator animator;
};

// Root of the mean squared difference from rays, of the root mean square; fronts alone.
double error_at(Player& player, double seconds, int samples) {
    const auto found = player.at(seconds);
    const Scene still = test::posed_at(player.scene, seconds);
    std::vector<reference::Place> places;
    for (const std::uint32_t v : player.device.vertex_order())
        places.push_back({still.positions[v], still.normals[v]});
    reference::Options options;
    options.samples = samples;
    options.effects = reference::parse_effects("emission,direct");
    const auto truth = reference::PathTracer(still).irradiance(places, options);
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3 w(truth.values[i]), d = found[i] - w;
        apart += glm::dot(d, d);
        whole += glm::dot(w, w);
    }
    return std::sqrt(apart / whole);
}

struct Steps {
    double mean = 0.0;   // change in a step, of an open sky's irradiance
    double jumps = 0.0;  // share of changes by more than a twentieth
};

Steps steps(Player& player, double from, double step, int count) {
    Steps out;
    auto before = player.at(from);
    for (int i = 1; i <= count; ++i) {
        const auto now = player.at(from + i * step);
        for (std::size_t v = 0; v < now.size(); ++v) {
            const double change = std::abs(now[v].y - before[v].y) / pi;
            const double all = count * static_cast<double>(now.size());
            out.mean += change / all;
            out.jumps += (change > 0.05) / all;
        }
        before = now;
    }
    return out;
}

void expect_smooth(Player& player, const std::string& name, double limit) {
    const double from = 0.3 * player.duration();
    for (const double time : {0.0, from, 0.8 * player.duration()}) {
        const double error = error_at(player, time, 256);
        std::printf("%s at %.2f s: %.2f %% from rays\n", name.c_str(), time, 100 * error);
        EXPECT_LT(error, limit) << name << ", " << time;
    }
    const Steps slow = steps(player, from, 1.0 / 240, 8), fast = steps(player, from, 1.0 / 30, 4);
    std::printf("%s: change in 1/240 s %.4f %%, %.3f %% of them jumps; in 1/30 s %.4f, %.3f\n",
                name.c_str(), 100 * slow.mean, 100 * slow.jumps, 100 * fast.mean, 100 * fast.jumps);
    EXPECT_GT(fast.mean, 1e-5) << name << " stands still";
    // An eighth of the time changes about an eighth, but for the size of pixels.
    EXPECT_LT(slow.mean, 0.25 * fast.mean + 2e-4) << name;
    // Only vertices that come out of another surface, such as a sole from the ground, jump.
    EXPECT_LT(slow.jumps, 1e-3) << name;
}

TEST(TransferAnimated, GeneratedCharactersMoveSmoothly) {
    Player player(fight_like());
    expect_smooth(player, "fight-like", 0.06);
}

TEST(TransferAnimated, CollectedCharactersMoveSmoothly) {
    const std::filesystem::path folder = std::filesystem::path(CLGI_SCENES_DIR);
    if (!std::filesystem::is_directory(folder / "animated"))
        GTEST_SKIP() << "no folder " << folder / "animated";
    for (const char* name :
         {"animated/CesiumMan.glb", "animated/Fox.glb", "animated/RiggedSimple/RiggedSimple.gltf",
          "animated/MorphStressTest.gltf"}) {
        Player player(io::load_gltf(folder / name));
        expect_smooth(player, name, 0.08);
    }
}

}  // namespace
}  // namespace clgi
