// Plans of random scenes: every method gives finite light or refuses in one line, and what a plan
// leaves out changes the true picture by no more than it says.
//
// CLGI_GATES=1000 in the environment takes as many scenes, CLGI_GATES=57-57 those of these numbers.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <random>
#include <string>

#include "fuzz/random_scene.hpp"
#include "planned_pictures.hpp"

namespace clgi {
namespace {

using test::distance;
using test::mean;
using test::Radiances;

std::vector<int> scene_numbers() {
    const char* wanted = std::getenv("CLGI_GATES");
    // Scenes 57, 153 and 277 have a bright lamp that lights nothing beside a dim one; 636 has no
    // triangle thicker than rounding; in 782 none of those that emit has an area; of 2517's lamp
    // one direction of fifty meets a wall within its range.
    if (!wanted) {
        std::vector<int> out(40);
        std::iota(out.begin(), out.end(), 0);
        out.insert(out.end(), {57, 153, 277, 636, 782, 2517});
        return out;
    }
    const std::string text = wanted;
    const std::size_t dash = text.find('-');
    const int first = dash == std::string::npos ? 0 : std::stoi(text);
    const int end =
        dash == std::string::npos ? std::stoi(text) : std::stoi(text.substr(dash + 1)) + 1;
    std::vector<int> out(static_cast<std::size_t>(std::max(end - first, 0)));
    std::iota(out.begin(), out.end(), first);
    return out;
}

struct Given {
    Scene scene;
    Camera camera;
};

// Of every three scenes one is a box or a room alone, of which something can be proven, and of
// every four one is dark, so that a probe may tell.
Given given(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(600);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    fuzz::Choices choices(bytes.data(), bytes.size());
    Given out;
    out.scene = fuzz::random_scene(choices);
    if (seed % 3 == 0 && out.scene.triangles.size() > 12) out.scene.triangles.resize(12);
    if (seed % 4 == 1)
        for (Material& material : out.scene.materials)
            material.base_color *= glm::vec4(0.2f, 0.2f, 0.2f, 1.0f);
    out.camera = fuzz::random_camera(choices, out.scene);
    return out;
}

// Nothing where the method refuses the scene; `refused` then says why.
std::optional<Radiances> picture(const Given& of, const PlanRequest& request,
                                 std::string& refused) {
    try {
        const Plan plan = test::plan_of(of.scene, of.camera, request);
        const Scene left = planned_scene(of.scene, plan);
        DeviceScene uploaded = test::on_device(left);
        Renderer renderer(test::programs(), test::device().queue, left, uploaded, plan);
        EXPECT_TRUE(renderer.prepare());
        renderer.render(of.camera).wait();
        EXPECT_EQ(renderer.status().non_finite, 0u);
        return test::shown_by(renderer);
    } catch (const Error& error) {
        refused = error.what();
        EXPECT_FALSE(refused.empty());
        EXPECT_EQ(refused.find('\n'), std::string::npos) << refused;
        return std::nullopt;
    }
}

void expect_light(const Radiances& picture) {
    for (const glm::vec3& pixel : picture)
        for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0.0f) << pixel[c];
}

// Without textures, which the path tracer filters otherwise than the library.
Given untextured(Given of) {
    for (Material& material : of.scene.materials)
        material.base_texture.texture = material.emission_texture.texture = -1;
    return of;
}

// Pixels that differ by more than a hundredth.
int unlike(const Radiances& a, const Radiances& b) {
    int out = 0;
    for (std::size_t p = 0; p < a.size(); ++p) {
        const double one = test::luminance_of(a[p]), other = test::luminance_of(b[p]);
        out += std::abs(one - other) > 0.01 * std::max(one, other);
    }
    return out;
}

TEST(Gates, OfRandomScenesGiveFiniteLightOrRefuseInOneLine) {
    constexpr Method methods[] = {Method::direct, Method::second_order, Method::light_atlas,
                                  Method::antiradiance, Method::dynamic_transfer};
    int taken = 0, refused = 0;
    for (const int seed : scene_numbers()) {
        SCOPED_TRACE("scene " + std::to_string(seed));
        const Given of = given(static_cast<unsigned>(seed));
        std::string why;
        PlanRequest request = test::quick();
        request.seconds = 0.03;
        // Without a request the plan takes a method that can do it.
        const auto own = picture(of, request, why);
        if (own) expect_light(*own);
        EXPECT_TRUE(own || of.scene.triangles.empty()) << why;
        request.method = methods[seed % 5];
        const auto other = picture(of, request, why);
        if (other) expect_light(*other);
        ++(other ? taken : refused);
    }
    EXPECT_GT(taken, 10 * refused);
    RecordProperty("refused", refused);
}

// Against the path tracer, which knows of no plan.
TEST(Gates, LeaveOutNoMoreThanTheySay) {
    int shadows = 0, bounces = 0, measured = 0;
    double worst = 0.0;
    for (const int seed : scene_numbers()) {
        SCOPED_TRACE("scene " + std::to_string(seed));
        const Given of = given(static_cast<unsigned>(seed));
        std::string why;
        PlanRequest tolerant = test::quick();
        tolerant.tolerance = 0.1;
        const Plan plan = test::plan_of(of.scene, of.camera, tolerant);
        const auto off = [&](Effect effect, Evidence evidence) {
            const EffectChoice& choice = plan.effects[static_cast<std::size_t>(effect)];
            return !choice.on && choice.evidence == evidence;
        };
        reference::Effects direct;
        direct.last_bounce = 0;
        const LightAnalysis& lights = plan.analysis.lights;
        // Those with an extent are sampled, and their noise would hide what differs.
        if (lights.environment || lights.emissive_triangles > 0) continue;
        if (off(Effect::direct_shadows, Evidence::proven)) {
            PlanRequest request = test::quick({}, {Effect::first_bounce});
            request.method = Method::direct;
            const Given plain = untextured(of);
            const auto lean = picture(plain, request, why);
            const Radiances truth = test::traced(plain.scene, plain.camera, 1, direct);
            ASSERT_TRUE(lean) << why;
            // Single pixels at the edges of surfaces and cones.
            const double apart = distance(*lean, truth);
            EXPECT_LE(apart, 2e-2 * mean(truth)) << unlike(*lean, truth) << " pixels differ";
            if (mean(truth) > 0.0) worst = std::max(worst, apart / mean(truth));
            ++shadows;
        }
        const bool proven = off(Effect::first_bounce, Evidence::proven);
        if (proven || off(Effect::first_bounce, Evidence::measured)) {
            const Radiances all = test::traced(of.scene, of.camera, 64);
            const Radiances once = test::traced(of.scene, of.camera, 64, direct);
            EXPECT_LE(distance(all, once), (plan.bound + 1e-6) * mean(all))
                << (proven ? "proven" : "measured") << ", bound " << plan.bound << ", of the mean "
                << distance(all, once) / mean(all) << ", pixels " << unlike(all, once)
                << ", lights " << lights.points << " " << lights.spots << " " << lights.directional
                << ", largest albedo " << plan.analysis.surfaces.largest_albedo;
            ++(proven ? bounces : measured);
        }
    }
    EXPECT_GT(shadows, 0);
    EXPECT_GT(bounces, 0);
    RecordProperty("shadows", shadows);
    RecordProperty("bounces", bounces);
    RecordProperty("measured", measured);
    RecordProperty("worst", std::to_string(worst));
}

}  // namespace
}  // namespace clgi
