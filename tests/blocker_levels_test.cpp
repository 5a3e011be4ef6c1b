// The two-level hierarchy of blockers: which triangles it lists, in which order, and that masks
// drawn with it are the unions of both levels.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/blocker_levels.hpp>
#include <set>

#include "mask_tools.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Drawn;
using test::Eyes;

double wave(double x, double y) { return 0.2 * std::sin(7 * x + 2 * y) + 0.1 * std::cos(9 * y); }

// n x n squares of two triangles each, every triangle with vertices of its own.
Scene sheet(int n, double height = 1.0) {
    Scene scene = test::plain_scene();
    const auto at = [&](int i, int j) {
        const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
        return glm::dvec3(x, y, height * wave(x, y));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            test::add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            test::add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return scene;
}

std::vector<glm::uvec3> all_triangles(const Scene& scene) {
    std::vector<glm::uvec3> out;
    for (const SceneTriangle& t : scene.triangles)
        out.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    return out;
}

std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> t) {
    std::sort(t.begin(), t.end());
    return t;
}

std::vector<std::uint32_t> near_of(const BlockerLevels& levels, std::size_t vertex) {
    return {levels.near.begin() + levels.near_lists[vertex],
            levels.near.begin() + levels.near_lists[vertex + 1]};
}

TEST(BlockerLevels, BeginWithTheTrianglesOfTheDevice) {
    const Scene scene = sheet(7);
    const DeviceScene on_device = test::on_device(scene);
    const auto device = test::download<glm::uvec4>(on_device.triangles(), 98);
    for (const bool coarse : {false, true}) {
        const BlockerLevels levels = blocker_levels(
            scene, on_device, coarse ? all_triangles(sheet(3)) : std::vector<glm::uvec3>(), 2);
        ASSERT_EQ(levels.fine_count, 98u);
        ASSERT_EQ(levels.triangles.size(), coarse ? 128u + 18u : 98u);
        for (std::size_t t = 0; t < 98; ++t)
            EXPECT_EQ(glm::uvec3(levels.triangles[t]), glm::uvec3(device[t]));
        EXPECT_EQ(levels.lists, (std::vector<std::uint32_t>{0, 1}));
        EXPECT_EQ(levels.ranges,
                  coarse ? (std::vector<std::uint32_t>{2, 1}) : (std::vector<std::uint32_t>{0, 2}));
        EXPECT_EQ(levels.near.empty(), !coarse);
    }
}

// Behind the fine triangles come points, and then every coarse triangle once.
TEST(BlockerLevels, HoldEveryCoarseTriangleOnce) {
    const Scene scene = sheet(7);
    const DeviceScene on_device = test::on_device(scene);
    test::Random random(4);
    std::vector<glm::uvec3> coarse;
    std::multiset<std::array<std::uint32_t, 3>> wanted, found;
    for (int i = 0; i < 1000; ++i) {
        coarse.emplace_back(random.integer(0, 293), random.integer(0, 293), random.integer(0, 293));
        wanted.insert(sorted({coarse[i].x, coarse[i].y, coarse[i].z}));
    }
    const BlockerLevels levels = blocker_levels(scene, on_device, coarse, 0);
    for (std::size_t t = 98; t < 128; ++t) {
        EXPECT_EQ(levels.triangles[t].x, levels.triangles[t].y);
        EXPECT_EQ(levels.triangles[t].x, levels.triangles[t].z);
    }
    const auto& order = on_device.vertex_order();
    for (std::size_t t = 128; t < levels.triangles.size(); ++t) {
        const glm::uvec4 v = levels.triangles[t];
        found.insert(sorted({order[v.x], order[v.y], order[v.z]}));
    }
    EXPECT_EQ(found, wanted);
    EXPECT_EQ(levels.ranges, (std::vector<std::uint32_t>{2, 16}));
}

// Pieces that are far apart share no cluster where the numbers allow it.
TEST(BlockerLevels, HaveCoarseClustersThatAreSmallInSpace) {
    Scene scene = sheet(8);
    const std::size_t half = scene.positions.size();
    Scene other = sheet(8);
    for (std::size_t t = 0; t < other.triangles.size(); ++t) {
        const std::uint32_t* v = other.triangles[t].vertex;
        const glm::dvec3 away(3.0, 0.0, 0.0);
        test::add_triangle(scene, other.positions[v[0]] + away, other.positions[v[1]] + away,
                           other.positions[v[2]] + away);
    }
    std::vector<glm::uvec3> coarse = all_triangles(scene), mixed;
    for (std::size_t t = 0; t < coarse.size(); ++t)
        mixed.push_back(coarse[t * 101 % coarse.size()]);
    const DeviceScene on_device = test::on_device(scene);
    const BlockerLevels levels = blocker_levels(scene, on_device, mixed, 0);
    ASSERT_EQ(levels.triangles.size(), 512u);
    for (std::size_t first = 256; first < 512; first += BLOCKER_CLUSTER) {
        glm::dvec3 low(1e9), high(-1e9);
        for (std::size_t t = first; t < first + BLOCKER_CLUSTER; ++t)
            for (int k = 0; k < 3; ++k) {
                const auto v = on_device.vertex_order()[levels.triangles[t][k]];
                low = glm::min(low, scene.positions[v]);
                high = glm::max(high, scene.positions[v]);
            }
        EXPECT_LT(high.x - low.x, 1.01);
        // Half of a sheet each, and no triangle is wider than an eighth.
        EXPECT_LT((high.x - low.x) * (high.y - low.y), 0.5 + 0.126) << first;
    }
    EXPECT_EQ(half, 384u);
}

// Six triangles touch an inner vertex of a regular sheet, 24 touch its neighbours, 54 theirs.
TEST(BlockerLevels, HaveTheRingsOfARegularSheet) {
    const Scene scene = sheet(11);
    const DeviceScene on_device = test::on_device(scene);
    const std::size_t counts[] = {0, 18, 48};
    for (const int rings : {0, 1, 2}) {
        const BlockerLevels levels =
            blocker_levels(scene, on_device, all_triangles(sheet(2)), rings);
        if (rings == 0) {
            EXPECT_TRUE(levels.near_lists.empty() && levels.near.empty());
            continue;
        }
        ASSERT_EQ(levels.near_lists.size(), on_device.vertex_order().size() + 1);
        int inner = 0;
        for (std::size_t i = 0; i < on_device.vertex_order().size(); ++i) {
            const glm::dvec3 p = scene.positions[on_device.vertex_order()[i]];
            const double from_border = std::min({p.x, p.y, 1 - p.x, 1 - p.y}) * 11;
            if (from_border < rings + 0.9) continue;
            EXPECT_EQ(near_of(levels, i).size(), counts[rings]);
            ++inner;
        }
        EXPECT_GT(inner, 6 * 20);
    }
}

// The same by the definition, looked up by positions alone, borders included.
TEST(BlockerLevels, HaveTheTrianglesAFewEdgesAway) {
    const Scene scene = sheet(6);
    const DeviceScene on_device = test::on_device(scene);
    const auto& triangles = on_device.triangle_order();
    const auto& vertices = on_device.vertex_order();
    const auto place = [&](std::uint32_t v) {
        return static_cast<int>(std::lround(scene.positions[v].x * 6) +
                                7 * std::lround(scene.positions[v].y * 6));
    };
    for (const int rings : {1, 2}) {
        const BlockerLevels levels =
            blocker_levels(scene, on_device, all_triangles(sheet(2)), rings);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            std::set<int> reached{place(vertices[i])};
            const auto touches = [&](std::uint32_t t) {
                const std::uint32_t* v = scene.triangles[t].vertex;
                return reached.count(place(v[0])) + reached.count(place(v[1])) +
                           reached.count(place(v[2])) >
                       0;
            };
            std::set<std::uint32_t> own;
            for (std::uint32_t t = 0; t < triangles.size(); ++t)
                if (touches(triangles[t])) own.insert(t);
            for (int ring = 0; ring < rings; ++ring) {
                std::set<int> next = reached;
                for (const std::uint32_t t : triangles)
                    if (touches(t))
                        for (const std::uint32_t v : scene.triangles[t].vertex)
                            next.insert(place(v));
                reached = next;
            }
            std::vector<std::uint32_t> wanted;
            for (std::uint32_t t = 0; t < triangles.size(); ++t)
                if (touches(triangles[t]) && !own.count(t)) wanted.push_back(t);
            EXPECT_EQ(near_of(levels, i), wanted) << i;
        }
    }
}

Drawn draw(const Scene& scene, const DeviceScene& on_device, const BlockerLevels& levels) {
    const std::size_t count = on_device.vertex_order().size();
    Blockers blockers;
    blockers.positions = test::download<glm::vec4>(on_device.positions(), count);
    blockers.triangles = levels.triangles;
    blockers.lists = levels.lists;
    blockers.ranges = levels.ranges;
    blockers.near_lists = levels.near_lists;
    blockers.near = levels.near;
    Eyes eyes{blockers.positions, {}};
    for (const std::uint32_t v : on_device.vertex_order())
        eyes.normals.emplace_back(scene.normals[v], 0.0f);
    return test::draw_masks(blockers, eyes);
}

// With the scene's own triangles as the coarse mesh nothing changes.
TEST(BlockerLevels, GiveTheMasksOfTheSceneWhereTheCoarseMeshIsTheScene) {
    const Scene scene = sheet(9);
    const DeviceScene on_device = test::on_device(scene);
    const Drawn whole = draw(scene, on_device, blocker_levels(scene, on_device, {}, 2));
    int blocked = 0;
    for (std::uint32_t i = 0; i < whole.receivers.count; ++i) blocked += whole.count(i);
    EXPECT_GT(blocked, 10000);
    for (const int rings : {0, 2})
        test::expect_same_masks(
            draw(scene, on_device, blocker_levels(scene, on_device, all_triangles(scene), rings)),
            whole, "levels");
}

// With one coarse triangle, a mask is the union of what it and the rings block.
TEST(BlockerLevels, GiveUnionsOfBothLevels) {
    const Scene scene = sheet(9);
    const DeviceScene on_device = test::on_device(scene);
    const std::vector<glm::uvec3> one{{0, 200, 100}};
    const Drawn far = draw(scene, on_device, blocker_levels(scene, on_device, one, 0)),
                both = draw(scene, on_device, blocker_levels(scene, on_device, one, 1));
    BlockerLevels rings = blocker_levels(scene, on_device, one, 1);
    rings.ranges = {0, 0};
    const Drawn near = draw(scene, on_device, rings);
    int more = 0;
    for (std::uint32_t i = 0; i < both.receivers.count; ++i) {
        std::vector<cl_uint> either = far.mask(i);
        for (std::size_t w = 0; w < either.size(); ++w) either[w] |= near.mask(i)[w];
        ASSERT_EQ(both.mask(i), either) << i;
        more += both.count(i) > far.count(i);
    }
    EXPECT_GT(more, 50);
}

TEST(BlockerLevels, OfNothingAreEmpty) {
    const Scene scene = test::plain_scene();
    const BlockerLevels levels = blocker_levels(scene, test::on_device(scene), {}, 2);
    EXPECT_TRUE(levels.triangles.empty() && levels.near.empty() && levels.near_lists.empty());
    EXPECT_EQ(levels.fine_count, 0u);
    EXPECT_EQ(levels.ranges, (std::vector<std::uint32_t>{0, 0}));
}

TEST(BlockerLevels, RefuseWhatIsNotOnTheDevice) {
    Scene scene = sheet(2);
    scene.positions.emplace_back(0.5, 0.5, 0.5);  // vertex 24, of no triangle
    scene.normals.emplace_back(0, 0, 1);
    const DeviceScene on_device = test::on_device(scene);
    const auto text = [&](const Scene& s, const std::vector<glm::uvec3>& coarse, int rings) {
        try {
            blocker_levels(s, on_device, coarse, rings);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(text(scene, {{0, 1, 23}}, 2), "");
    EXPECT_EQ(text(scene, {{0, 1, 2}, {0, 24, 2}}, 2),
              "blocker_levels: coarse triangle 1 names vertex 24, which is on no triangle of the "
              "scene and so not on the device");
    EXPECT_EQ(text(scene, {{0, 1, 25}}, 2),
              "blocker_levels: coarse triangle 0 names vertex 25, the scene has 25");
    EXPECT_EQ(text(scene, {}, 3), "blocker_levels: rings is 3, 0 to 2 needed");
    EXPECT_EQ(text(scene, {}, -1), "blocker_levels: rings is -1, 0 to 2 needed");
    EXPECT_EQ(text(sheet(2), {}, 1),
              "blocker_levels: the scene has 8 triangles and 24 vertices, the one on the device 8 "
              "and 25");
}

}  // namespace
}  // namespace clgi
