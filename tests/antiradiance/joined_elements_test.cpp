// Joined leaves of neighbouring vertices: where a mesh is finer than leaves need to be.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "links_checks.hpp"
#include "methods/antiradiance/leaf_vertices.hpp"
#include "methods/antiradiance/refine.hpp"
#include "spheres.hpp"
#include "vertex_leaves.hpp"

namespace clgi {
namespace {

// Where vertices are more than leaves are requested: whole, small, round and facing one way.
TEST(JoinedElements, AreAsManyAsWished) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {1, 2, 3}, 0.5, 5, 1);
    for (const std::size_t requested : {100u, 700u, 5000u}) {
        const ElementTree tree = make_elements(scene, {.requested = requested});
        EXPECT_EQ(test::expect_consistent(tree, true), tree.leaves);
        EXPECT_GT(tree.leaves, requested * 2 / 3);
        EXPECT_LT(tree.leaves, requested * 3 / 2);
        EXPECT_EQ(tree.vertex_patches.size(), 3u * 20480u);
        EXPECT_NEAR(tree.areas[0], test::area_of(scene), 1e-12 * tree.areas[0]);
        const double mean = tree.areas[0] / static_cast<double>(tree.leaves);
        for (std::size_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i)) continue;
            EXPECT_LT(tree.areas[i], 4.0 * mean);
            EXPECT_LT(tree.radii[i], 3.0 * std::sqrt(mean));
            const glm::dvec3 out = tree.positions[i] - glm::dvec3(1, 2, 3);
            EXPECT_GT(glm::dot(glm::normalize(out), tree.normals[i]), 0.99);
        }
    }
}

// What pixels read: a vertex of a joined leaf has the light of the leaves around it, so that light
// that falls linearly over the sphere is smooth across leaves.
TEST(JoinedElements, ShareTheirLightWithThoseBeside) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 5, 1);
    const ElementTree tree = make_elements(scene, {.requested = 300});
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) rows.push_back(i);
    const LeafVertices shared = leaf_vertices(tree, rows);
    ASSERT_EQ(shared.of_vertex_patches.size(), tree.vertex_patches.size());
    EXPECT_EQ(shared.first.size(), 10242u + 1u);
    double mixed = 0.0, alone = 0.0;  // squares of differences from the height of the vertex
    for (std::uint32_t row = 0; row < rows.size(); ++row)
        for (std::uint32_t k = tree.first_patches[rows[row]]; k < tree.first_patches[rows[row] + 1];
             ++k) {
            const std::uint32_t v = shared.of_vertex_patches[k];
            double sum = 0.0, height = 0.0;
            bool own = false;
            for (std::uint32_t l = shared.first[v]; l < shared.first[v + 1]; ++l) {
                const auto& [leaf, share] = shared.leaves[l];
                EXPECT_GT(share, 0.0f);
                sum += double{share};
                height += double{share} * tree.positions[rows[leaf]].y;
                own |= leaf == row;
            }
            EXPECT_TRUE(own);
            EXPECT_NEAR(sum, 1.0, 1e-6);
            const double wanted = tree.vertex_patches[k].corners[0].y;
            mixed += std::pow(height - wanted, 2);
            alone += std::pow(tree.positions[rows[row]].y - wanted, 2);
        }
    EXPECT_LT(mixed, 0.3 * alone);
}

// Across a sharp crease, between materials and to another piece nothing is joined.
TEST(JoinedElements, EndAtCreasesAndMaterials) {
    Scene scene = test::plain_scene();
    Material other;
    const std::uint32_t material = test::add_material(scene, other);
    const int n = 24;
    const auto sheet = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                           std::uint32_t of) {
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto at = [&](int i, int j) {
                    return corner + (double(i) / n) * u + (double(j) / n) * v;
                };
                test::add_quad(scene, {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}, of);
            }
    };
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    sheet({0, 0, 0}, z, x, 0);         // a floor
    sheet({0, 0, 0}, x, y, 0);         // a wall on its edge
    sheet({1, 0, 0}, z, x, material);  // more floor
    sheet({0, 1e-2, 0}, z, x, 0);      // a board above it
    const ElementTree tree = make_elements(scene, {.requested = 400});
    EXPECT_EQ(test::expect_consistent(tree, true), tree.leaves);
    EXPECT_LT(tree.leaves, 700u);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const VertexPatch& first = tree.vertex_patches[tree.first_patches[i]];
        for (std::uint32_t t = tree.first_patches[i]; t < tree.first_patches[i + 1]; ++t)
            EXPECT_EQ(tree.vertex_patches[t].triangle / (2 * n * n), first.triangle / (2 * n * n))
                << i;
    }
}

// Area of the vertex patches of a leaf, with the way that they face.
glm::dvec3 vector_area_of(const ElementTree& tree, std::size_t leaf) {
    glm::dvec3 out(0.0);
    for (std::uint32_t t = tree.first_patches[leaf]; t < tree.first_patches[leaf + 1]; ++t) {
        const auto& [a, b, c] = tree.vertex_patches[t].corners;
        out += glm::cross(b - a, c - a) / 6.0;
    }
    return out;
}

// Of a sphere four leaves would be caps that face many ways.
TEST(JoinedElements, FaceAboutOneWay) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {1, 2, 3}, 0.5, 4, 1);
    const ElementTree tree = make_elements(scene, {.requested = 4});
    EXPECT_EQ(test::expect_consistent(tree, true), tree.leaves);
    EXPECT_GE(tree.leaves, 10u);  // a cap of a tenth of the sphere has 0.9 of its area
    EXPECT_LT(tree.leaves, 100u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_GE(glm::length(vector_area_of(tree, i)), 0.9 * tree.areas[i] * (1 - 1e-9));
        }
}

// Of a long strip they are no longer than round leaves that are as large as allowed could be.
TEST(JoinedElements, AreRound) {
    Scene scene = test::plain_scene();
    const int n = 1600;
    const double size = 1e-2;
    for (int k = 0; k < n; ++k)
        test::add_quad(scene,
                       {glm::dvec3(k * size, 0, 0), glm::dvec3(k * size, 0, size),
                        glm::dvec3((k + 1) * size, 0, size), glm::dvec3((k + 1) * size, 0, 0)});
    const ElementTree tree = make_elements(scene, {.requested = 8, .backs = false});
    EXPECT_EQ(test::expect_consistent(tree, true), tree.leaves);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        double low = std::numeric_limits<double>::max(), high = -low;
        for (std::uint32_t t = tree.first_patches[i]; t < tree.first_patches[i + 1]; ++t) {
            low = std::min(low, tree.vertex_patches[t].corners[0].x);
            high = std::max(high, tree.vertex_patches[t].corners[0].x);
        }
        EXPECT_GT(high, low);
        EXPECT_LE(high - low, std::sqrt(8.0 * tree.max_area));
    }
}

// The centroid of a leaf of a sphere lies below it, where its own triangles would hide it.
TEST(JoinedElements, LieOnWhatTheyAreOf) {
    for (const int facing : {1, -1}) {
        Scene scene = test::plain_scene();
        test::add_sphere(scene, {1, 2, 3}, 0.5, 5, facing);
        const ElementTree tree = make_elements(scene, {.requested = 100});
        ASSERT_EQ(test::expect_consistent(tree, true), tree.leaves);
        for (std::size_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i)) continue;
            // Seen from inside the centroid is in front of the surface.
            const double height = glm::length(tree.positions[i] - glm::dvec3(1, 2, 3));
            EXPECT_GT(height, facing > 0 ? 0.4995 : 0.45);
            EXPECT_LT(height, facing > 0 ? 0.5 : 0.4995);
        }
    }
}

// From far away a leaf is as large as its vertex patches, which turn away from each other, are
// together.
TEST(JoinedElements, AreFromAfarAsLargeAsTheirThirds) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 0.5, 4, 1);
    const auto plate = static_cast<std::uint32_t>(scene.triangles.size());
    test::add_triangle(scene, {2, -11, 1}, {2, -11, 1.001}, {2.001, -11, 1});
    const ElementTree tree = make_elements(scene, {.requested = 16});
    const DirectionBins bins = direction_bins(4096);
    const Links links = make_links(tree, bins);
    const double mean_bin = 4.0 * 3.14159265358979323846 / bins.count();
    int curved = 0;
    for (std::uint32_t i = 0; i < tree.count(); ++i) {
        if (tree.triangles[i] != plate || tree.backs[i]) continue;
        for (std::uint32_t k = links.first[i]; k < links.first[i + 1]; ++k) {
            const std::uint32_t s = links.senders[k];
            if (!tree.is_vertex(s)) continue;
            const auto bin = static_cast<std::size_t>(links.bins[k]);
            const double found = double{links.form_factors[k]} * tree.areas[s] *
                                 std::abs(test::bin_cosine(tree, bins, s, links.bins[k])) *
                                 bins.solid_angles[bin];
            const glm::dvec3 way = tree.positions[i] - tree.positions[s];
            // Those that are larger than half a bin are cut into their vertex patches.
            if (tree.areas[s] > 0.5 * mean_bin * glm::dot(way, way)) continue;
            const double wanted =
                std::abs(glm::dot(vector_area_of(tree, s), way)) / std::pow(glm::length(way), 3);
            EXPECT_NEAR(found, wanted, 1e-5 * wanted) << s;
            curved += glm::length(vector_area_of(tree, s)) < 0.97 * tree.areas[s];
        }
    }
    EXPECT_GT(curved, 4);
}

// At the edge of a sphere parts of a leaf face away: no light comes from them.
TEST(JoinedElements, SendFromWhatFacesTheReceiverAlone) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 0.5, 5, 1);
    const auto plates = static_cast<std::uint32_t>(scene.triangles.size());
    test::Random random(3);
    for (int k = 0; k < 40; ++k) {
        const glm::dvec3 out =
            glm::normalize(glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)));
        const glm::dvec3 u = 1e-3 * glm::normalize(glm::cross(out, glm::dvec3(0.3, 0.5, 0.8)));
        const glm::dvec3 v = glm::cross(out, u), at = 1.1 * out;
        test::add_triangle(scene, at, at + v, at + u);
    }
    const ElementTree tree = make_elements(scene, {.requested = 60});
    const DirectionBins bins = direction_bins(4096);
    const Links links = make_links(tree, bins);
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i) || tree.triangles[i] < plates) continue;
        found += links.first[i + 1] - links.first[i];
        for (std::uint32_t k = links.first[i]; k < links.first[i + 1]; ++k)
            EXPECT_GT(links.form_factors[k], 0.0f) << k;
    }
    EXPECT_GT(found, 40u * 40u);
}

// A leaf that rises above a receiver's plane with a part is not hidden, wherever its middle is.
TEST(JoinedElements, AreHiddenWhereNoPartIsAboveThePlane) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 4, 1);
    test::add_sphere(scene, {1.5, 0.4, 0.2}, 0.7, 4, 1);
    const ElementTree tree = make_elements(scene, {.requested = 150});
    ASSERT_EQ(test::expect_consistent(tree, true), tree.leaves);
    const PatchGroups groups(tree);
    const Refine refine(tree, groups, 1.0);
    int hidden = 0, rises = 0;
    for (std::size_t sender = 0; sender < tree.count(); ++sender)
        for (std::size_t receiver = 0; receiver < tree.count(); ++receiver) {
            if (sender == receiver || !tree.is_leaf(sender) || !tree.is_leaf(receiver)) continue;
            const glm::dvec3 &n = tree.normals[receiver], &at = tree.positions[receiver];
            const glm::dvec3 way = tree.positions[sender] - at;
            double top = -std::numeric_limits<double>::infinity();
            for (std::uint32_t t = tree.first_patches[sender]; t < tree.first_patches[sender + 1];
                 ++t) {
                const auto& [a, b, c] = tree.vertex_patches[t].corners;
                for (const glm::dvec3& corner :
                     {a, 0.5 * (a + b), 0.5 * (a + c), (a + b + c) / 3.0})
                    top = std::max(top, glm::dot(n, corner - at));
            }
            const bool wanted = top <= least_rise * glm::length(way);
            EXPECT_EQ(refine.hidden(sender, receiver), wanted) << sender << " " << receiver;
            hidden += wanted;
            rises += !wanted && glm::dot(n, way) < 0.0;
        }
    EXPECT_GT(hidden, 1000);
    EXPECT_GT(rises, 100);
}

// Groups hold each vertex patch once, are as large as all of it and the same for any number of
// threads.
TEST(JoinedElements, HaveTheSameGroupsForAnyThreads) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 4, 1);
    test::add_sheet(scene, 12, [](double x, double z) { return 2.0 + 0.1 * std::sin(3 * x + z); });
    for (const std::size_t requested : {10u, 200u, 2900u}) {
        const ElementTree tree = make_elements(scene, {.requested = requested});
        ASSERT_GT(test::expect_consistent(tree, true), 0u);
        const PatchGroups one(tree, 1);
        std::vector<std::uint32_t> vertex_patches = one.vertex_patches();
        std::sort(vertex_patches.begin(), vertex_patches.end());
        for (std::size_t k = 0; k < tree.vertex_patches.size(); ++k)
            ASSERT_EQ(vertex_patches[k], k);
        const Links links = make_links(tree, direction_bins(64), {.threads = 1});
        for (const int threads : {2, 3, 7, 64}) {
            const PatchGroups other(tree, threads);
            EXPECT_EQ(one.vertex_patches(), other.vertex_patches());
            for (std::size_t i = 0; i < tree.count(); ++i) {
                ASSERT_EQ(one.of(i).size(), other.of(i).size()) << i;
                EXPECT_EQ(one.flatness(i), other.flatness(i)) << i;
                for (std::size_t g = 0; g < one.of(i).size(); ++g) {
                    const PatchGroup &a = one.of(i)[g], &b = other.of(i)[g];
                    EXPECT_TRUE(a.middle == b.middle && a.vector_area == b.vector_area &&
                                a.square_radius == b.square_radius && a.next == b.next &&
                                a.first == b.first && a.end == b.end);
                    for (std::uint32_t k = a.first; k < a.end; ++k) {
                        const auto& [p, q, r] =
                            tree.vertex_patches[one.vertex_patches()[k]].corners;
                        EXPECT_LE(glm::length((p + q + r) / 3.0 - a.middle),
                                  std::sqrt(a.square_radius) * (1 + 1e-12));
                    }
                }
            }
            const Links same = make_links(tree, direction_bins(64), {.threads = threads});
            EXPECT_EQ(links.senders, same.senders);
            EXPECT_EQ(links.bins, same.bins);
            EXPECT_EQ(links.form_factors, same.form_factors);
        }
    }
}

}  // namespace
}  // namespace clgi
