// VPLs so small beside the others that a half would not hold what they send.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "light_baking.hpp"
#include "methods/light_atlas/row_unit.hpp"

namespace clgi {
namespace {

// The smallest power of two for which 2 A / A_i fits.
TEST(RowUnit, HoldsWhatASiteCanSend) {
    for (const double ratio : {1.0, 100.0, 6400.0, 32752.0, 32753.0, 65504.0, 65505.0, 1e6, 3e9}) {
        const std::uint32_t k = row_exponent(0.37, 0.37 * ratio);
        EXPECT_LE(2.0 * ratio * (1 - 1e-12), std::ldexp(65504.0, static_cast<int>(k))) << ratio;
        if (k > 0) {
            EXPECT_GT(2.0 * ratio * (1 + 1e-12), std::ldexp(65504.0, static_cast<int>(k) - 1));
        }
        EXPECT_EQ(k == 0, ratio < 32752.5) << ratio;
    }
    EXPECT_EQ(row_exponent(0.0, 1.0), std::uint32_t{SITE_ROW_MOST});
}

// Two plates 5 mm apart that light each other, alone or over a large floor that faces away: the
// floor takes part in nothing but the area of all VPLs.
struct Plates {
    static constexpr double side = 0.04, gap = 0.005;
    explicit Plates(double floor) {
        scene = test::plain_scene(glm::vec3(0.8f, 0.6f, 0.4f));
        const glm::dvec3 u(side, 0, 0), v(0, 0, side);
        const glm::dvec3 low(0, 0, 0), high(0, gap, 0);
        test::add_quad(scene, {low, low + v, low + u + v, low + u});      // faces up
        test::add_quad(scene, {high, high + u, high + u + v, high + v});  // faces down
        scene.lights = {test::point_light({0.4 * side, 0.6 * gap, 0.55 * side}, 1.0f)};
        scene.lights[0].intensity = {1.0f, 2.0f, 3.0f};
        plates = scene;
        if (floor > 0.0)
            test::add_quad(scene, {glm::dvec3(-floor, -0.5, -floor),
                                   {floor, -0.5, -floor},
                                   {floor, -0.5, floor},
                                   {-floor, -0.5, floor}});
    }
    Scene scene, plates;
};

std::vector<glm::vec3> plates_light(double floor) {
    const Plates of(floor);
    const Patches patches = make_patches(of.plates);
    VplLayout layout = place_vpls(of.plates, patches, VplOptions{.count = 64});
    const std::size_t count = layout.vpls.size();
    if (floor > 0.0) {
        const auto first = static_cast<std::uint32_t>(layout.samples.size());
        const float area = static_cast<float>(4 * floor * floor);
        layout.samples.push_back({4, 0.3f, 0.3f});
        layout.vpls.push_back({4, 0.3f, 0.3f, first, 1, layout.region_count, area, false});
    }
    LightAtlasOptions options = test::bake_options();
    options.bounces = 3;
    options.occlusion = Occlusion::none;
    const AtlasLayout atlas =
        make_atlas(of.scene, make_patches(of.scene).triangle_patch, AtlasOptions{.size = 32});
    const DeviceScene device = test::on_device(of.scene);
    LightAtlasSolver solver(test::programs(), test::device().queue, device, layout, atlas, options);
    EXPECT_TRUE(solver.run());
    EXPECT_TRUE(solver.status().transport_kept);
    std::vector<glm::vec3> out = solver.vpl_irradiance();
    out.resize(count);
    return out;
}

// The transport of these VPLs times the area of all is up to 1.6 10^5 with the floor.
TEST(SmallVpls, LightEachOtherAsThoseOfASmallSceneDo) {
    const auto alone = plates_light(0.0), over_a_floor = plates_light(2.0);
    ASSERT_EQ(alone.size(), over_a_floor.size());
    ASSERT_GE(alone.size(), 32u);
    for (std::size_t i = 0; i < alone.size(); ++i)
        for (int c = 0; c < 3; ++c)
            // Halves round each number of the transport by 2^-11. VPLs look from a point before
            // their surface, 2e-5 of the scene's radius of 2.9 m away: 1.2 % of the gap. Of that
            // share and less changes what they see.
            EXPECT_NEAR(over_a_floor[i][c], alone[i][c], 0.012 * alone[i][c]) << i;
}

}  // namespace
}  // namespace clgi
