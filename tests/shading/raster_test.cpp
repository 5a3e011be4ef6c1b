// Which pixels a triangle covers, against exact integers: a pixel belongs to the triangle that its
// centre lies in, moved right and down by nothing at all where it lies on an edge.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <array>
#include <clgi/procedural.hpp>
#include <cstring>
#include <map>
#include <numbers>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
using test::Drawing;
using test::Random;

struct Corner {
    std::int64_t x, y;  // 24.8 fixed point, y down
};

std::int64_t edge(const Corner& from, const Corner& to, const Corner& at) {
    return (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x);
}

bool covers(Corner a, Corner b, Corner c, int pixel_x, int pixel_y) {
    const std::int64_t area = edge(a, b, c);
    if (area == 0) return false;
    if (area < 0) std::swap(b, c);
    const Corner centre{256 * std::int64_t{pixel_x} + 128, 256 * std::int64_t{pixel_y} + 128};
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        std::int64_t side = edge(from, to, centre);
        if (side == 0) side = from.y - to.y;  // an infinitesimal step to the right
        if (side == 0) side = to.x - from.x;  // and a far smaller one down
        if (side < 0) return false;
    }
    return true;
}

// What the visibility buffer must hold, for triangles parallel to the image.
std::vector<std::uint64_t> expected(const Drawing& drawing) {
    std::vector<std::uint64_t> words(drawing.pixels(), ~std::uint64_t{0});
    for (std::size_t t = 0; t < drawing.triangles.size(); ++t) {
        const glm::uvec4& triangle = drawing.triangles[t];
        Corner corner[3];
        std::uint32_t closeness = 0;
        for (int k = 0; k < 3; ++k) {
            const test::ScreenVertex& vertex = drawing.vertices[triangle[k]];
            corner[k] = {vertex.x, vertex.y};
            std::memcpy(&closeness, &vertex.closeness, sizeof closeness);
        }
        const bool back = edge(corner[0], corner[1], corner[2]) > 0;
        if (back && !(triangle.w & static_cast<std::uint32_t>(TRIANGLE_DOUBLE_SIDED))) continue;
        for (std::size_t pixel = 0; pixel < words.size(); ++pixel) {
            const int x = static_cast<int>(pixel % drawing.view.width);
            const int y = static_cast<int>(pixel / drawing.view.width);
            if (covers(corner[0], corner[1], corner[2], x, y))
                words[pixel] = std::min(words[pixel], std::uint64_t{~closeness} << 32 | t);
        }
    }
    return words;
}

// Triangles of all sizes, each at its own depth of a few, around an image of this size.
Scene random_triangles(int count, int width, int height, std::uint64_t seed) {
    Random random(seed);
    Scene scene = test::plain_scene();
    Material two_sided;
    two_sided.double_sided = true;
    test::add_material(scene, two_sided);
    for (int t = 0; t < count; ++t) {
        const double size = std::exp2(random(-2.0, 8.0));
        const double z = random.integer(0, 40);
        const glm::dvec2 at(random(-8.0, width + 8.0), random(-8.0, height + 8.0));
        glm::dvec3 corner[3];
        for (glm::dvec3& c : corner) {
            // On quarters of a pixel, so that many edges run through pixel centres.
            const glm::dvec2 p = at + glm::dvec2(random(-size, size), random(-size, size));
            c = glm::dvec3(glm::round(p * 4.0) / 4.0, z);
        }
        test::add_triangle(scene, corner[0], corner[1], corner[2],
                           static_cast<std::uint32_t>(random.integer(0, 1)));
    }
    return scene;
}

// Stacked up from the first to the last triangle, each pixel shows the last that covers it, and
// stacked down the first: the same one where it is covered once.
void expect_each_covered_once(const Scene& flat, int width, int height) {
    constexpr double step = 1.0 / 16.0;
    std::vector<int> seen[2];
    for (const double direction : {1.0, -1.0}) {
        Scene stacked = flat;
        for (std::size_t t = 0; t < flat.triangles.size(); ++t)
            for (const std::uint32_t vertex : flat.triangles[t].vertex)
                stacked.positions[vertex].z = direction * step * static_cast<double>(t);
        const Drawing drawing =
            test::draw(stacked, test::pixel_camera(width, height, 8192.0), width, height);
        for (std::size_t p = 0; p < drawing.pixels(); ++p)
            seen[direction > 0].push_back(drawing.triangle(p));
    }
    int holes = 0, doubles = 0;
    for (std::size_t p = 0; p < seen[0].size(); ++p) {
        holes += seen[0][p] < 0;
        doubles += seen[0][p] != seen[1][p];
    }
    EXPECT_EQ(holes, 0);
    EXPECT_EQ(doubles, 0);
}

class RasterSize : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(RasterSize, CoversWhatExactIntegersSay) {
    const auto [width, height] = GetParam();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Scene scene = random_triangles(500, width, height, seed);
        const Drawing drawing = test::draw(scene, test::pixel_camera(width, height), width, height);
        const auto words = expected(drawing);
        int wrong = 0;
        for (std::size_t p = 0; p < words.size(); ++p) wrong += drawing.visibility[p] != words[p];
        EXPECT_EQ(wrong, 0) << "pixels, seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RasterSize,
                         testing::Values(std::pair(1, 1), std::pair(3, 5), std::pair(64, 64),
                                         std::pair(37, 23), std::pair(131, 70)));

TEST(Raster, CoversAFanOnce) {
    Scene scene = test::plain_scene();
    const int spokes = 61;
    for (int k = 0; k < spokes; ++k) {
        const double from = 2 * pi * k / spokes, to = 2 * pi * ((k + 1) % spokes) / spokes;
        test::add_triangle(scene, {31.3, 29.7, 0},
                           {31.3 + 80 * cos(from), 29.7 + 80 * sin(from), 0},
                           {31.3 + 80 * cos(to), 29.7 + 80 * sin(to), 0});
    }
    expect_each_covered_once(scene, 64, 64);
}

// A grid over a square image whose inner corners are moved about, by less than the quarter of a
// cell at which a triangle could turn over.
Scene random_mesh(int cells, int pixels) {
    Random random(static_cast<std::uint64_t>(cells));
    const double cell = static_cast<double>(pixels) / cells;
    std::vector<glm::dvec3> grid;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const bool inner = x > 0 && y > 0 && x < cells && y < cells;
            const double most = inner ? 0.24 * cell : 0.0;
            grid.emplace_back(x * cell + random(-most, most), y * cell + random(-most, most), 0);
        }
    Scene scene = test::plain_scene();
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int a = y * (cells + 1) + x, b = a + cells + 1;
            test::add_triangle(scene, grid[a], grid[a + 1], grid[b + 1]);
            test::add_triangle(scene, grid[a], grid[b + 1], grid[b]);
        }
    return scene;
}

TEST(Raster, CoversARandomMeshOnce) {
    for (const int cells : {2, 9, 48, 160})  // from many pixels a triangle to a fraction of one
        expect_each_covered_once(random_mesh(cells, 96), 96, 96);
}

TEST(Raster, CoversAMillionPixelsOfARandomMeshOnce) {
    expect_each_covered_once(random_mesh(160, 1024), 1024, 1024);
}

// A dented sphere seen from inside, far from the origin: each ray leaves it through a face that
// looks inward, so each pixel of every view must show one.
TEST(Raster, LeavesNoHoleInAClosedMesh) {
    FurnaceOptions options;
    options.subdivisions = 4;
    Scene scene = furnace(options);
    Random random(77);
    const glm::dvec3 far(148376.1, 1234.7, -223423.3);
    std::map<std::array<double, 3>, double> dents;  // corners that meet stay together
    for (glm::dvec3& position : scene.positions) {
        const auto [at, added] = dents.try_emplace({position.x, position.y, position.z});
        if (added) at->second = random(0.7, 1.0);
        position = position * at->second + far;
    }
    const DeviceScene placed = test::on_device(scene);
    std::size_t holes = 0;
    for (int view = 0; view < 16; ++view) {
        const glm::dvec3 eye =
            far + glm::dvec3(random(-0.4, 0.4), random(-0.4, 0.4), random(-0.4, 0.4));
        const glm::dvec3 ahead(random(-1, 1), random(-1, 1), random(-1, 1));
        const Camera camera = test::camera_at(eye, eye + ahead, 2.0f);
        const Drawing drawing = test::draw(placed, make_view(camera, placed.frame(), 256, 256));
        for (std::size_t p = 0; p < drawing.pixels(); ++p) holes += drawing.triangle(p) < 0;
    }
    EXPECT_EQ(holes, 0u);
}

TEST(Raster, GivesEdgesThroughCentresToTheTopLeft) {
    Scene scene = test::plain_scene();
    // Corners on pixel centres of an image 8 pixels high: rows 1 to 3 from the top.
    test::add_quad(scene, {glm::dvec3(2.5, 3.5, 0), {6.5, 3.5, 0}, {6.5, 6.5, 0}, {2.5, 6.5, 0}});
    const Drawing drawing = test::draw(scene, test::pixel_camera(8, 8), 8, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            EXPECT_EQ(drawing.triangle(8 * y + x) >= 0, x >= 2 && x < 6 && y >= 1 && y < 4)
                << x << ", " << y;
    // And of large triangles: rows 4 to 43.
    Scene large = test::plain_scene();
    test::add_quad(large,
                   {glm::dvec3(2.5, 4.5, 0), {44.5, 4.5, 0}, {44.5, 43.5, 0}, {2.5, 43.5, 0}});
    const Drawing other = test::draw(large, test::pixel_camera(48, 48), 48, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
            EXPECT_EQ(other.triangle(48 * y + x) >= 0, x >= 2 && x < 44 && y >= 4 && y < 43)
                << x << ", " << y;
}

TEST(Raster, DrawsNothingOfNoArea) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {1, 1, 0}, {30, 30, 0}, {9, 9, 0});
    test::add_triangle(scene, {4.5, 4.5, 0}, {4.5, 4.5, 0}, {4.5, 4.5, 0});
    test::add_triangle(scene, {0, 8.5, 0}, {32, 8.5, 0}, {0, 8.5, 0});
    test::add_triangle(scene, {8.5, 0, 0}, {8.5, 32, 20}, {8.5, 3, 40});  // seen from its edge
    for (Material& material : scene.materials) material.double_sided = true;
    const Drawing drawing = test::draw(scene, test::pixel_camera(32, 32), 32, 32);
    for (std::size_t p = 0; p < drawing.pixels(); ++p) EXPECT_EQ(drawing.triangle(p), -1);
}

TEST(Raster, GivesTiesToTheSmallerIndex) {
    for (const double size : {5.0, 60.0}) {  // drawn at once, and as polygons
        Scene scene = test::plain_scene();
        for (int k = 0; k < 9; ++k)
            test::add_triangle(scene, {1, 1, 3}, {1 + size, 1, 3}, {1, 1 + size, 3});
        const Drawing drawing = test::draw(scene, test::pixel_camera(64, 64), 64, 64);
        int seen = 0;
        for (std::size_t p = 0; p < drawing.pixels(); ++p) {
            if (drawing.triangle(p) < 0) continue;
            EXPECT_EQ(drawing.triangle(p), 0);
            ++seen;
        }
        EXPECT_GT(seen, 8);
    }
}

TEST(Raster, ShowsBackFacesWhereTheyAreNotCulled) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {1, 1, 3}, {1, 9, 3}, {9, 1, 3});
    test::add_triangle(scene, {1, 21, 3}, {1, 61, 3}, {41, 21, 3});
    const DeviceScene placed = test::on_device(scene);
    View view = make_view(test::pixel_camera(64, 64), placed.frame(), 64, 64);
    const Drawing culled = test::draw(placed, view);
    view.flags = 0;
    const Drawing drawn = test::draw(placed, view);
    int seen[2] = {0, 0};
    for (std::size_t p = 0; p < drawn.pixels(); ++p) {
        EXPECT_EQ(culled.triangle(p), -1);
        if (drawn.triangle(p) >= 0) ++seen[drawn.triangle(p)];
    }
    EXPECT_GT(seen[0], 20);
    EXPECT_GT(seen[1], 600);
}

TEST(Raster, DrawsNothingOfAnEmptyScene) {
    const Drawing drawing = test::draw(test::plain_scene(), test::pixel_camera(5, 3), 5, 3);
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        EXPECT_EQ(drawing.triangle(p), -1);
        EXPECT_EQ(drawing.ids[GBUFFER_MATERIAL * drawing.stride + p], -1);
    }
    for (const float value : drawing.planes) EXPECT_EQ(value, 0.0f);
}

// A view further back in a buffer of several leaves the others alone.
TEST(Raster, StaysInsideItsView) {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {glm::dvec3(-9, -9, 0), {40, -9, 0}, {40, 40, 0}, {-9, 40, 0}});
    for (int k = 0; k < 99; ++k)
        test::add_triangle(scene, {k * 0.3, 1, 2}, {k * 0.3 + 4, 1, 2}, {k * 0.3, 9, 2});
    const DeviceScene placed = test::on_device(scene);
    View view = make_view(test::pixel_camera(21, 17), placed.frame(), 21, 17);
    view.first_pixel = 19;
    const std::size_t pixels = 21 * 17, all = 19 + pixels + 33;
    const RasterBuffers buffers = test::raster_buffers(placed, all);
    const std::uint64_t canary = ~std::uint64_t{15};  // loses against all that is drawn
    test::device().queue.enqueueFillBuffer(buffers.pixels, canary, 0, all * sizeof canary);
    test::draw_visibility(test::gbuffer_passes(), placed, view, buffers);
    const auto words = test::download<std::uint64_t>(buffers.pixels, all);
    for (std::size_t p = 0; p < all; ++p)
        EXPECT_EQ(words[p] == canary, p < 19 || p >= 19 + pixels) << p;
    view.first_pixel = 0;
    const Drawing first = test::draw(placed, view);
    for (std::size_t p = 0; p < pixels; ++p) EXPECT_EQ(words[19 + p], first.visibility[p]) << p;
}

}  // namespace
}  // namespace clgi
