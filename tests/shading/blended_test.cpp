// Blended surfaces: each view shows them at a share alpha of its pixels, others in each view.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/clgi.hpp>
#include <cmath>

#include "device.hpp"
#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr int side = 192;
constexpr double pixels = double{side} * side;

// Leaning sheets over the whole picture, the first one nearest, each of its own material. cells: of
// small triangles.
Scene sheets(const std::vector<float>& alphas, int cells = 1) {
    Scene scene;
    for (std::size_t k = 0; k < alphas.size(); ++k) {
        Material material;
        material.base_color = {0.5f, 0.5f, 0.5f, alphas[k]};
        material.alpha_mode = AlphaMode::blend;
        material.double_sided = true;
        const std::uint32_t index = test::add_material(scene, material);
        const double z = -10.0 * static_cast<double>(k), step = 2.0 * side / cells;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                const double l = x * step - 0.5 * side, b = y * step - 0.5 * side;
                const auto corner = [&](double right, double up) {
                    return glm::dvec3(l + right, b + up, z + 0.01 * (l + right) - 0.005 * (b + up));
                };
                test::add_quad(scene,
                               {corner(0, 0), corner(step, 0), corner(step, step), corner(0, step)},
                               index);
            }
    }
    return scene;
}

// [pixels] the material that is seen, -1: none.
std::vector<int> materials(const Scene& scene, const test::Drawing& drawing) {
    std::vector<int> out;
    for (std::size_t i = 0; i < drawing.pixels(); ++i) {
        const int triangle = drawing.triangle(i);
        out.push_back(triangle < 0 ? -1 : static_cast<int>(scene.triangles[triangle].material));
    }
    return out;
}

std::vector<int> seen(const Scene& scene, const Camera& camera = test::pixel_camera(side, side)) {
    return materials(scene, test::draw(scene, camera, side, side));
}

double share(const std::vector<int>& of, int material) {
    return static_cast<double>(std::count(of.begin(), of.end(), material)) / pixels;
}

// Pixels that show a material in one picture and, `away` further on, in another.
double both(const std::vector<int>& a, const std::vector<int>& b, int material, std::size_t away) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i + away < a.size(); ++i)
        sum += a[i] == material && b[i + away] == material;
    return static_cast<double>(sum) / static_cast<double>(a.size() - away);
}

// Five standard deviations of the share of independent pixels.
double bound(double p) { return 5.0 * std::sqrt(p * (1.0 - p) / pixels); }

TEST(Blended, CoversItsShareOfWhatLiesBehind) {
    for (const int cells : {1, 40}) {
        const std::vector<int> found = seen(sheets({0.3f, 0.6f, 1.0f}, cells));
        EXPECT_NEAR(share(found, 0), 0.3, bound(0.3)) << cells;
        EXPECT_NEAR(share(found, 1), 0.7 * 0.6, bound(0.42)) << cells;
        EXPECT_NEAR(share(found, 2), 0.7 * 0.4, bound(0.28)) << cells;
    }
    EXPECT_EQ(share(seen(sheets({0.0f, 1.0f})), 1), 1.0);
    // As much where a texture or the corners say so.
    Scene scene = sheets({0.8f});
    scene.colors.assign(scene.positions.size(), glm::vec4(1.0f, 1.0f, 1.0f, 0.25f));
    EXPECT_NEAR(share(seen(scene), 0), 0.2, bound(0.2));
}

TEST(Blended, DecidesForEachPixelAndViewAnew) {
    const Scene scene = sheets({0.3f});
    const Camera camera = test::pixel_camera(side, side);
    const std::vector<int> first = seen(scene);
    EXPECT_EQ(first, seen(scene));
    EXPECT_NEAR(both(first, first, 0, 1), 0.09, bound(0.09));
    EXPECT_NEAR(both(first, first, 0, side), 0.09, bound(0.09));
    const auto apart = [&](const Camera& other, const char* what) {
        EXPECT_NEAR(both(first, seen(scene, other), 0, 0), 0.09, bound(0.09)) << what;
    };
    for (int axis = 0; axis < 2; ++axis) {
        Camera aside = camera;
        aside.offset[axis] = 0.25f;
        apart(aside, "offset");
    }
    for (int axis = 0; axis < 3; ++axis) {
        Camera moved = camera;
        moved.position[axis] += 2.0;
        apart(moved, "position");
    }

    // Of one eye, looking elsewhere, and with another number.
    const DeviceScene placed = test::on_device(scene);
    const Camera from = test::camera_at({96, 96, 50}, {96, 96, 0}, 0.5f);
    const View view = make_view(from, placed.frame(), side, side);
    std::vector<std::vector<int>> looks;
    for (const glm::dvec3& at : {glm::dvec3(96, 96, 0), {110, 96, 0}, {96, 110, 0}})
        looks.push_back(seen(scene, test::camera_at({96, 96, 50}, at, 0.5f)));
    View other = view;
    other.flags |= 3u << VIEW_DITHER_SHIFT;
    looks.push_back(materials(scene, test::draw(placed, other)));
    for (std::size_t k = 1; k < looks.size(); ++k) {
        EXPECT_NEAR(share(looks[k], 0), 0.3, bound(0.3)) << k;
        EXPECT_NEAR(both(looks[0], looks[k], 0, 0), 0.09, bound(0.09)) << k;
    }
}

}  // namespace
}  // namespace clgi
