// The two-level hierarchy of blockers: which triangles it lists, in which order, and that masks
// drawn with it are the unions of both levels.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/blocker_levels.hpp>
#include <set>

#include "mask_tools.hpp"
#include "math_modes.hpp"
#include "methods/transfer/nearest_coarse.hpp"

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

// Fine triangles that a vertex lists.
std::vector<std::uint32_t> near_of(const BlockerLevels& levels, std::size_t vertex) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = levels.near_lists[vertex]; i < levels.near_lists[vertex + 1]; ++i)
        if (levels.near[i] < levels.fine_count) out.push_back(levels.near[i]);
    return out;
}

// Coarse triangles that a vertex lists, in clusters and as singles, by their places.
std::multiset<std::uint32_t> far_of(const BlockerLevels& levels, std::size_t vertex) {
    std::multiset<std::uint32_t> out;
    for (std::uint32_t i = levels.near_lists[vertex]; i < levels.near_lists[vertex + 1]; ++i)
        if (levels.near[i] >= levels.fine_count) out.insert(levels.near[i]);
    for (std::uint32_t i = levels.lists[vertex]; i < levels.lists[vertex + 1]; ++i)
        for (std::uint32_t t = 64 * levels.ranges[2 * i];
             t < 64 * (levels.ranges[2 * i] + levels.ranges[2 * i + 1]); ++t)
            if (t < levels.triangles.size()) out.insert(t);
    return out;
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
        EXPECT_EQ(levels.receivers_per_list, coarse ? 1u : ~0u);
        if (!coarse) {
            EXPECT_EQ(levels.lists, (std::vector<std::uint32_t>{0, 1}));
            EXPECT_EQ(levels.ranges, (std::vector<std::uint32_t>{0, 2}));
        }
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
        // With a coarse triangle for every fine one, these are the surroundings alone.
        const BlockerLevels levels = blocker_levels(scene, on_device, all_triangles(scene), rings);
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
    for (const int rings : {0, 1, 2}) {
        const BlockerLevels levels = blocker_levels(scene, on_device, all_triangles(scene), rings);
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
    blockers.receivers_per_list = levels.receivers_per_list;
    blockers.near_lists = levels.near_lists;
    blockers.near = levels.near;
    Eyes eyes{blockers.positions, {}};
    for (const std::uint32_t v : on_device.vertex_order())
        eyes.normals.emplace_back(scene.normals[v], 0.0f);
    return test::draw_masks(blockers, eyes);
}

CLGI_IN_BOTH_MATHS(CoarseBlockers);

// With the scene's own triangles as the coarse mesh nothing changes.
TEST_P(CoarseBlockers, GiveTheMasksOfTheSceneWhereTheCoarseMeshIsTheScene) {
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

// Every part of the surface is there once: as itself, or as the coarse triangle that stands for it.
// Those at the vertex itself are in no list.
TEST(BlockerLevels, ListEveryPartOnce) {
    Scene scene = sheet(24);
    for (const SceneTriangle& t : sheet(24).triangles)  // another one above it, which faces down
        test::add_triangle(scene, scene.positions[t.vertex[2]] + glm::dvec3(0, 0, 0.05),
                           scene.positions[t.vertex[1]] + glm::dvec3(0, 0, 0.05),
                           scene.positions[t.vertex[0]] + glm::dvec3(0, 0, 0.05));
    const DeviceScene on_device = test::on_device(scene);
    std::vector<glm::uvec3> coarse, fine;
    for (std::size_t t = 0; t < scene.triangles.size(); t += 5) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        coarse.emplace_back(v[0], v[1], v[2]);
    }
    for (const std::uint32_t t : on_device.triangle_order()) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        fine.emplace_back(v[0], v[1], v[2]);
    }
    std::vector<std::uint32_t> pieces(scene.positions.size(), 0);
    for (std::size_t v = pieces.size() / 2; v < pieces.size(); ++v) pieces[v] = 1;
    for (const int rings : {0, 2}) {
        const BlockerLevels levels = blocker_levels(scene, on_device, coarse, rings);
        std::vector<glm::uvec3> ordered;
        const std::uint32_t first = 2304;
        for (std::size_t t = first; t < levels.triangles.size(); ++t) {
            glm::uvec3 v;
            for (int k = 0; k < 3; ++k) v[k] = on_device.vertex_order()[levels.triangles[t][k]];
            ordered.push_back(v);
        }
        const auto stands = nearest_coarse(scene.positions, pieces, fine, ordered);
        std::size_t clusters = 0, parts = 0;
        for (std::size_t i = 0; i < on_device.vertex_order().size(); i += 41) {
            const glm::dvec3 p = scene.positions[on_device.vertex_order()[i]];
            const auto list = near_of(levels, i);
            const std::set<std::uint32_t> near(list.begin(), list.end());
            const auto far = far_of(levels, i);
            ASSERT_EQ(near.size(), list.size());
            for (const std::uint32_t t : far) ASSERT_EQ(far.count(t), 1u);
            for (std::uint32_t t = 0; t < fine.size(); ++t) {
                const bool touches = scene.positions[fine[t].x] == p ||
                                     scene.positions[fine[t].y] == p ||
                                     scene.positions[fine[t].z] == p;
                ASSERT_LT(stands[t], ordered.size());
                const std::size_t coarse_ones = far.count(first + stands[t]);
                if (touches) {
                    EXPECT_EQ(near.count(t) + coarse_ones, 0u);
                } else {
                    EXPECT_GE(near.count(t) + coarse_ones, 1u) << t << " of " << i;
                    parts += near.count(t) + coarse_ones;
                }
            }
            clusters += levels.lists[i + 1] - levels.lists[i];
        }
        EXPECT_GT(clusters, 100u);
        EXPECT_GT(parts, 100000u);
    }
}

// A trough whose coarse mesh is a lid: the lid would hide all of the sky from its bottom.
TEST_P(CoarseBlockers, DoNotCoverAReceiverWithItsOwnCoarseTriangles) {
    Scene scene = test::plain_scene();
    const auto at = [](int i, int j) {
        return glm::dvec3(i / 8.0, j / 8.0, std::abs(i - 4) / 8.0);
    };
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            test::add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            test::add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    const DeviceScene on_device = test::on_device(scene);
    const auto corner = [&](int i, int j) {
        for (std::uint32_t v = 0; v < scene.positions.size(); ++v)
            if (scene.positions[v] == at(i, j)) return v;
        return 0u;
    };
    const std::uint32_t a = corner(0, 0), b = corner(8, 0), c = corner(8, 8), d = corner(0, 8);
    const std::vector<glm::uvec3> lid{{a, b, c}, {a, c, d}};
    const Drawn whole = draw(scene, on_device, blocker_levels(scene, on_device, {}, 0)),
                levels = draw(scene, on_device, blocker_levels(scene, on_device, lid, 2));
    int covered = 0;
    for (std::uint32_t i = 0; i < whole.receivers.count; ++i) covered += levels.count(i) > 700;
    EXPECT_EQ(covered, 0);
    EXPECT_GT(whole.count(0) + whole.count(100), 10);
}

// Within 5 %; without the rule above it is 45 %.
TEST(BlockerLevels, GiveVectorsNearThoseOfTheScene) {
    const Scene scene = sheet(24);
    const DeviceScene on_device = test::on_device(scene);
    std::vector<glm::uvec3> coarse;
    std::map<std::pair<int, int>, std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < scene.positions.size(); ++v)
        vertices[{std::lround(24 * scene.positions[v].x), std::lround(24 * scene.positions[v].y)}] =
            v;
    for (int j = 0; j < 24; j += 3)
        for (int i = 0; i < 24; i += 3) {
            coarse.emplace_back(vertices[{i, j}], vertices[{i + 3, j}], vertices[{i + 3, j + 3}]);
            coarse.emplace_back(vertices[{i, j}], vertices[{i + 3, j + 3}], vertices[{i, j + 3}]);
        }
    const auto wanted =
        test::transfer_vectors(draw(scene, on_device, blocker_levels(scene, on_device, {}, 0)));
    const auto error = [&](int rings) {
        const auto found = test::transfer_vectors(
            draw(scene, on_device, blocker_levels(scene, on_device, coarse, rings)));
        double sum = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            sum += test::relative_l2(found[i], wanted[i]);
        return sum / static_cast<double>(found.size());
    };
    EXPECT_LT(error(2), 0.05);
    EXPECT_LT(error(2), error(0));
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
