// Welded vertices, edges, neighbours and pieces of meshes whose numbers are known.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// Every triangle with vertices of its own, as attributes split them at every seam; `off` moves each
// coordinate.
template <typename Off>
Scene exploded(const Scene& scene, Off&& off) {
    Scene out = scene;
    out.positions.clear();
    out.normals.clear();
    for (SceneTriangle& triangle : out.triangles)
        for (std::uint32_t& vertex : triangle.vertex) {
            glm::dvec3 p = scene.positions[vertex];
            for (int axis = 0; axis < 3; ++axis) p[axis] = off(p[axis]);
            out.normals.push_back(scene.normals[vertex]);
            vertex = static_cast<std::uint32_t>(out.positions.size());
            out.positions.push_back(p);
        }
    return out;
}

// What must hold for any mesh.
void expect_consistent(const Adjacency& a, const std::vector<SceneTriangle>& triangles) {
    std::size_t uses = 0;
    for (const MeshEdge& edge : a.edges) {
        EXPECT_LT(edge.vertex[0], edge.vertex[1]);
        EXPECT_EQ(edge.first_use, uses);
        uses += edge.use_count;
        for (std::uint32_t u = edge.first_use; u < uses; ++u) {
            const EdgeUse& use = a.uses[u];
            const auto& vertex = triangles[use.triangle].vertex;
            const std::uint32_t from = a.welded[vertex[use.side]];
            const std::uint32_t to = a.welded[vertex[(use.side + 1) % 3]];
            EXPECT_EQ(from, edge.vertex[use.forward ? 0 : 1]);
            EXPECT_EQ(to, edge.vertex[use.forward ? 1 : 0]);
            EXPECT_EQ(a.pieces[use.triangle], a.pieces[a.uses[edge.first_use].triangle]);
        }
    }
    EXPECT_EQ(uses, a.uses.size());
    EXPECT_EQ(uses, 3 * (triangles.size() - a.degenerate));
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t e = a.triangle_edges[t][k];
            if (e == no_index) {
                EXPECT_EQ(a.pieces[t], no_index);
                EXPECT_EQ(a.neighbours[t][k], no_index);
                continue;
            }
            const bool two = a.edges[e].use_count == 2;
            EXPECT_EQ(a.neighbours[t][k] != no_index, two);
            if (!two) continue;
            const auto& back = a.neighbours[a.neighbours[t][k]];
            EXPECT_NE(std::find(back.begin(), back.end(), t), back.end());
        }
}

TEST(Adjacency, OfAClosedMeshIsClosed) {
    const Scene scene = furnace({.subdivisions = 3});
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_TRUE(a.closed());
    EXPECT_EQ(a.piece_count, 1u);
    EXPECT_EQ(a.degenerate, 0u);
    EXPECT_EQ(a.welded_count, 642u);
    EXPECT_EQ(a.edges.size(), 1920u);
}

// The bumpy mesh has an odd number of triangles: one was cut in two, its neighbour was not.
TEST(Adjacency, FindsTheOneTJunctionOfTheBumpyMesh) {
    const Scene scene = bumpy_mesh();
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_EQ(a.welded_count, scene.positions.size());
    EXPECT_EQ(a.count(EdgeKind::border), 3u);
    EXPECT_EQ(a.count(EdgeKind::manifold), a.edges.size() - 3);
    EXPECT_EQ(a.welded_count + scene.triangles.size(), a.edges.size() + 1);  // Euler: a disc
    EXPECT_EQ(a.piece_count, 1u);
}

// A seam at every edge changes nothing, nor does the last bit of a float at every corner, wherever
// the mesh lies and however large it is.
TEST(Adjacency, WeldsSeamsAndTheLastBitOfFloats) {
    const Scene mesh = furnace({.subdivisions = 4});
    const Adjacency whole = adjacency(mesh);
    for (const double size : {1.0, 1e-4, 3e5})
        for (const double place : {0.0, 7e6}) {
            test::Random random(5);
            // To the next float up or down: two spacings at most from corner to corner.
            const auto off = [&](double x) {
                const auto f = static_cast<float>(size * x);
                const int step = random.integer(-1, 1);
                return double{step == 0 ? f : std::nextafter(f, step * 1e30f)} + size * place;
            };
            const Scene split = exploded(mesh, off);
            const Adjacency a = adjacency(split);
            expect_consistent(a, split.triangles);
            EXPECT_TRUE(a.closed()) << size << " at " << place;
            EXPECT_EQ(a.welded_count, whole.welded_count);
            EXPECT_EQ(a.edges.size(), whole.edges.size());
            EXPECT_EQ(a.piece_count, 1u);
            // The same corners are welded as were shared.
            std::map<std::uint32_t, std::uint32_t> from;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t was = mesh.triangles[t].vertex[k];
                    const std::uint32_t is = a.welded[split.triangles[t].vertex[k]];
                    EXPECT_EQ(from.try_emplace(was, is).first->second, is);
                }
        }
}

TEST(Adjacency, KeepsVerticesThatAreFartherApart) {
    Scene scene;
    for (const double gap : {1.0, 3.0}) {
        scene = test::plain_scene();
        test::add_triangle(scene, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0});
        const double step = gap * 0x1p-23;  // spacings of floats from 1 on
        test::add_triangle(scene, {1, -1 + step, 0}, {1, 1, 0}, {-1 + step, 1, 0});
        const Adjacency a = adjacency(scene);
        expect_consistent(a, scene.triangles);
        EXPECT_EQ(a.welded_count, gap < 2.0 ? 4u : 6u);
        EXPECT_EQ(a.piece_count, gap < 2.0 ? 1u : 2u);
        EXPECT_EQ(a.count(EdgeKind::border), gap < 2.0 ? 4u : 6u);
        EXPECT_EQ(a.count(EdgeKind::manifold), gap < 2.0 ? 1u : 0u);
    }
    // Fine detail near the middle of a large scene is not the scene's size to be welded by.
    scene = test::plain_scene();
    test::add_floor(scene, 1000.0);
    for (int i = 0; i < 20; ++i) {
        const double x = 2e-5 * i;
        test::add_triangle(scene, {x, 0, 0}, {x + 1e-5, 0, 0}, {x, 0, 1e-5});
    }
    EXPECT_EQ(adjacency(scene).welded_count, 4u + 3u * 20u);
}

// Chains of near vertices become one, in whatever order they come.
TEST(Adjacency, WeldsChains) {
    for (const std::array<int, 5>& order :
         {std::array<int, 5>{0, 1, 2, 3, 4}, {4, 0, 2, 1, 3}, {0, 4, 3, 1, 2}}) {
        std::vector<glm::dvec3> positions;
        for (const int i : order) positions.emplace_back(1.25 + 1.5 * i * 0x1p-23, 0, 0);
        positions.emplace_back(-1.25, 0, 0);
        const Adjacency a = adjacency(positions, {});
        EXPECT_EQ(a.welded_count, 2u);
        EXPECT_EQ(a.welded, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1}));
    }
}

TEST(Adjacency, LeavesTJunctionsOpen) {
    // Two triangles on one side of an edge of the other side's one.
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    test::add_triangle(scene, {-1, 0, 0}, {0, -1, 0}, {0, 0, 0});
    test::add_triangle(scene, {0, 0, 0}, {0, -1, 0}, {1, 0, 0});
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_EQ(a.welded_count, 5u);
    EXPECT_EQ(a.edges.size(), 8u);
    EXPECT_EQ(a.count(EdgeKind::border), 7u);  // the long one and its two halves among them
    EXPECT_EQ(a.count(EdgeKind::manifold), 1u);
    EXPECT_EQ(a.pieces, (std::vector<std::uint32_t>{0, 1, 1}));
}

TEST(Adjacency, TellsEdgesOfThreeTriangles) {
    // Three wings at one edge, one of them wound the other way.
    Scene scene = test::plain_scene();
    const glm::dvec3 low(0, 0, 0), high(0, 1, 0);
    test::add_triangle(scene, low, high, {1, 0, 0});
    test::add_triangle(scene, low, high, {-1, 0, 1});
    test::add_triangle(scene, high, low, {-1, 0, -1});
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_EQ(a.count(EdgeKind::non_manifold), 1u);
    EXPECT_EQ(a.count(EdgeKind::border), 6u);
    EXPECT_EQ(a.piece_count, 1u);
    EXPECT_FALSE(a.closed());
    const MeshEdge& edge = a.edges[a.triangle_edges[0][0]];
    ASSERT_EQ(edge.kind, EdgeKind::non_manifold);
    ASSERT_EQ(edge.use_count, 3u);
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(a.uses[edge.first_use + i].triangle, i);
        EXPECT_EQ(a.uses[edge.first_use + i].forward, i < 2);
    }
}

TEST(Adjacency, TellsWindingsApart) {
    Scene scene = furnace({.subdivisions = 2});
    const Adjacency whole = adjacency(scene);
    std::set<std::uint32_t> turned;
    for (std::uint32_t t = 0; t < scene.triangles.size(); t += 3) {
        std::swap(scene.triangles[t].vertex[1], scene.triangles[t].vertex[2]);
        turned.insert(t);
    }
    std::size_t between = 0;  // turned and unturned triangles
    for (const MeshEdge& edge : whole.edges)
        between += turned.count(whole.uses[edge.first_use].triangle) !=
                   turned.count(whole.uses[edge.first_use + 1].triangle);
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_GT(between, 0u);
    EXPECT_EQ(a.count(EdgeKind::opposite), between);
    EXPECT_EQ(a.count(EdgeKind::manifold), whole.edges.size() - between);
    EXPECT_EQ(a.piece_count, 1u);
    // All of them turned: closed again.
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        if (turned.count(t) == 0)
            std::swap(scene.triangles[t].vertex[1], scene.triangles[t].vertex[2]);
    EXPECT_TRUE(adjacency(scene).closed());
}

TEST(Adjacency, CountsPieces) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    test::add_box(scene, {0.1, 0.1, 0.1}, {0.5, 0.5, 0.5}, 1);
    test::add_box(scene, {0.5, 0.5, 0.5}, {0.7, 0.7, 0.7}, 1);  // a corner in common is no edge
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_TRUE(a.closed());
    EXPECT_EQ(a.welded_count, 23u);
    EXPECT_EQ(a.piece_count, 3u);
    for (std::size_t t = 0; t < 36; ++t) EXPECT_EQ(a.pieces[t], t / 12);
    EXPECT_EQ(adjacency(box()).piece_count, 2u);
}

TEST(Adjacency, PassesOverDegenerateTriangles) {
    // A square of two triangles with a needle of no width between them, and a point.
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    test::add_triangle(scene, {1, 0, 0}, {1 + 0x1p-24, 0, 0}, {0, 1, 0});
    test::add_triangle(scene, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    test::add_triangle(scene, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    const Adjacency a = adjacency(scene);
    expect_consistent(a, scene.triangles);
    EXPECT_EQ(a.degenerate, 2u);
    EXPECT_EQ(a.count(EdgeKind::manifold), 1u);
    EXPECT_EQ(a.count(EdgeKind::border), 4u);
    EXPECT_EQ(a.pieces, (std::vector<std::uint32_t>{0, no_index, 0, no_index}));
    EXPECT_EQ(a.neighbours[0][1], 2u);
}

TEST(Adjacency, OfNothingIsEmpty) {
    const Adjacency none = adjacency(Scene());
    EXPECT_EQ(none.welded_count, 0u);
    EXPECT_TRUE(none.edges.empty());
    EXPECT_TRUE(none.closed());
    EXPECT_EQ(none.piece_count, 0u);
}

TEST(Adjacency, RefusesBrokenMeshes) {
    EXPECT_THROW(adjacency({{0, 0, 0}}, {{{0, 0, 1}, 0}}), InputError);
    EXPECT_THROW(adjacency({{0, std::numeric_limits<double>::quiet_NaN(), 0}}, {}), InputError);
    EXPECT_THROW(adjacency({{0, 0, std::numeric_limits<double>::infinity()}}, {}), InputError);
}

// Very many vertices at one place, and a floor of them in one plane.
TEST(Adjacency, TakesNoTimeForManyAtOnePlace) {
    std::vector<glm::dvec3> positions(300000, glm::dvec3(1, 2, 3));
    for (int i = 0; i < 500; ++i)
        for (int j = 0; j < 500; ++j) positions.emplace_back(0.01 * i, 0.0, 0.01 * j);
    EXPECT_EQ(adjacency(positions, {}).welded_count, 250001u);
}

}  // namespace
}  // namespace clgi
