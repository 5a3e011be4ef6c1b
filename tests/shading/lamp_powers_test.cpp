// Which parts of the power of lamps points stand for: by hand, and of the points that result.
// SPDX-License-Identifier: MIT
#include "shading/lights/lamp_powers.hpp"

#include <gtest/gtest.h>
#include <clgi/advanced/emitters.hpp>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// Lamps of two triangles each.
std::vector<EmissiveTriangle> pairs(std::uint32_t count) {
    std::vector<EmissiveTriangle> out(2 * count);
    for (std::uint32_t i = 0; i < 2 * count; ++i) out[i].lamp = i / 2;
    return out;
}

void expect_stretches(const std::vector<PowerStretch>& found,
                      const std::vector<std::pair<double, double>>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].begin, wanted[i].first, 1e-12) << i;
        EXPECT_NEAR(found[i].end, wanted[i].second, 1e-12) << i;
    }
}

TEST(LampPowers, AreCutWhereALampEnds) {
    const LampPowers lamps(pairs(3), {1.0, 2.0, 0.5, 0.5, 3.5, 0.5});
    EXPECT_EQ(lamps.total(), 8.0);
    expect_stretches(lamps.stretches(4, true), {{0, 2}, {2, 3}, {3, 4}, {4, 6}, {6, 8}});
    expect_stretches(lamps.stretches(4, false), {{0, 2}, {2, 4}, {4, 6}, {6, 8}});
    expect_stretches(lamps.stretches(2, true), {{0, 3}, {3, 4}, {4, 8}});
    expect_stretches(lamps.stretches(1, true), {{0, 8}});  // two lamps end before the last
    const std::size_t wanted[] = {0, 1, 1, 2, 4, 4, 4, 4};
    for (int k = 0; k < 8; ++k) EXPECT_EQ(lamps.at(k + 0.4), wanted[k]) << k;
    EXPECT_EQ(lamps.at(3.7), 3u);
    EXPECT_EQ(lamps.at(7.9), 5u);
    EXPECT_EQ(lamps.at(8.0), 5u);
}

TEST(LampPowers, HaveNoCutsOfDarkLamps) {
    const LampPowers lamps(pairs(3), {0.0, 0.0, 3.0, 1.0, 0.0, 0.0});
    expect_stretches(lamps.stretches(2, true), {{0, 2}, {2, 4}});
    EXPECT_EQ(lamps.at(0.0), 2u);
    EXPECT_EQ(LampPowers({}, {}).total(), 0.0);
}

// Five tilted panels of other colours: the points of a picture's first sample have the power of
// each.
TEST(LampPowers, AreThoseOfTheFirstPoints) {
    Scene scene = test::plain_scene();
    std::vector<double> wanted;
    for (int i = 0; i < 5; ++i) {
        Material glows;
        glows.emission = glm::vec3(1.0f + 0.7f * static_cast<float>(i), 2.0f, 0.3f);
        const double x = 3.0 * i, side = 1.0 + 0.3 * i;
        test::add_quad(scene, {{{x, 1, 0}, {x + side, 1.2, 0}, {x + side, 1.5, 1}, {x, 1.3, 1}}},
                       test::add_material(scene, glows));
        wanted.push_back(0.0);
    }
    const DeviceScene device = test::on_device(scene);
    const double scale = device.frame().scale;
    const auto lamp_at = [&](float x) {
        return static_cast<std::size_t>(
            std::lround((double{x} / scale + device.frame().origin.x - 0.9) / 3.0));
    };
    for (const EmissiveTriangle& t : device.emissive())
        wanted[lamp_at((t.corner[0].x + t.corner[1].x + t.corner[2].x) / 3.0f)] +=
            double{t.area} * double{t.radiance.y};
    for (const int points : {16, 5, 4}) {
        std::vector<double> found(5);
        const EmitterSet set = make_emitters(device, {.area_samples = points});
        for (const Emitter& one : set.emitters)
            found[lamp_at(one.position.x)] += double{one.intensity.y} / 3.14159265358979;
        EXPECT_LE(set.emitters.size(), static_cast<std::size_t>(points) + 4);
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_NEAR(found[i], wanted[i], 1e-5 * wanted[i]) << points << ", " << i;
    }
}

}  // namespace
}  // namespace clgi
