// Generated rooms like those of [Dachsbacher07]: counts of triangles, closed surfaces, and light
// that reaches what the camera sees by reflection alone.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <limits>
#include "lab/scenes/interiors.hpp"

#include "geometry.hpp"

namespace clgi::test {
namespace {

struct Room {
    std::string name;
    Scene scene;
    double triangles;  // [Dachsbacher07, table 1]; 0: the paper does not say
};

// Made once: bodies take a second or two.
const std::vector<Room>& rooms() {
    static const std::vector<Room> all = {{"maze", maze(), 0.0},
                                          {"office", office(), 5552.0},
                                          {"character", character(), 8072.0},
                                          {"oriental-like", oriental_like(), 11.9e3},
                                          {"glossy-box", glossy_box(), 3.5e3},
                                          {"glossy-bust-like", glossy_bust_like(), 13.4e3}};
    return all;
}

std::uint32_t triangles_of(const Scene& scene, const std::string& part) {
    std::uint32_t sum = 0;
    for (const Part& one : scene.parts)
        if (one.name == part) sum += one.triangle_count;
    return sum;
}

TEST(Interiors, AreValidWithACameraAndALight) {
    for (const Room& room : rooms()) {
        EXPECT_NO_THROW(validate(room.scene)) << room.name;
        EXPECT_TRUE(room.scene.warnings.empty()) << room.name;
        EXPECT_EQ(room.scene.name, room.name);
        EXPECT_EQ(room.scene.cameras.size(), 1u) << room.name;
        EXPECT_EQ(room.scene.lights.size(), 1u) << room.name;
    }
}

TEST(Interiors, HaveAboutAsManyTrianglesAsThePaper) {
    for (const Room& room : rooms()) {
        if (room.triangles == 0.0) continue;
        EXPECT_NEAR(static_cast<double>(room.scene.triangles.size()), room.triangles,
                    0.1 * room.triangles)
            << room.name;
    }
    EXPECT_EQ(triangles_of(glossy_box(), "cube"), 3072u);
    EXPECT_EQ(triangles_of(rooms()[5].scene, "bust"), 12940u);
    EXPECT_EQ(triangles_of(rooms()[2].scene, "figure"), 8072u - 5552u);
}

TEST(Interiors, PartsCoverAllTrianglesOnce) {
    for (const Room& room : rooms()) {
        std::uint32_t next = 0;
        for (const Part& part : room.scene.parts) {
            EXPECT_EQ(part.first_triangle, next) << room.name;
            EXPECT_GT(part.triangle_count, 0u) << room.name;
            next += part.triangle_count;
        }
        EXPECT_EQ(next, room.scene.triangles.size()) << room.name;
    }
}

// Light that knows no visibility is stopped by closed surfaces, welded as its elements are.
TEST(Interiors, EverySurfaceIsClosed) {
    for (const Room& room : rooms()) {
        const Adjacency mesh = adjacency(room.scene);
        std::size_t faults = 0;
        for (const MeshEdge& edge : mesh.edges) faults += edge.kind != EdgeKind::manifold;
        EXPECT_EQ(faults, 0u) << room.name;
    }
}

// Signed volumes of pieces: what stands in a room faces outward, and so do walls of a thickness;
// a room without an opening faces inward.
TEST(Interiors, SurfacesFaceTheAir) {
    for (const Room& room : rooms()) {
        const Adjacency mesh = adjacency(room.scene);
        std::vector<double> volumes(mesh.piece_count, 0.0);
        for (std::size_t t = 0; t < room.scene.triangles.size(); ++t) {
            ASSERT_NE(mesh.pieces[t], no_index) << room.name << " triangle " << t;
            volumes[mesh.pieces[t]] += geometry::volume(room.scene, t, 1);
        }
        const bool sealed = room.name.rfind("glossy", 0) == 0;
        std::size_t inward = 0;
        for (const double volume : volumes) inward += volume < 0.0;
        EXPECT_EQ(inward, sealed ? 1u : 0u) << room.name;
        EXPECT_EQ(volumes[mesh.pieces[0]] < 0.0, sealed) << room.name;
    }
}

// But where the skin of the figure folds at a joint.
TEST(Interiors, NoTriangleIsDegenerateOrTurnedAgainstItsNormals) {
    for (const Room& room : rooms()) {
        std::size_t against = 0;
        for (std::size_t t = 0; t < room.scene.triangles.size(); ++t) {
            const glm::dvec3 face = geometry::doubled_area(room.scene, t);
            ASSERT_GT(glm::length(face), 0.0) << room.name << " triangle " << t;
            for (const std::uint32_t vertex : room.scene.triangles[t].vertex) {
                const glm::dvec3 normal(room.scene.normals[vertex]);
                ASSERT_NEAR(glm::length(normal), 1.0, 1e-6) << room.name;
                against += glm::dot(face, normal) <= 0.0;
            }
        }
        EXPECT_LE(against, room.name == "character" ? 3u : 0u) << room.name;
    }
}

// Luminance of a small picture from the scene's camera, and how many of its pixels have light.
struct SeenLight {
    double mean = 0.0;
    double share = 0.0;
};

SeenLight seen(const Scene& scene, const std::string& effects) {
    const reference::PathTracer tracer(scene);
    reference::Options options;
    options.width = 48;
    options.height = 36;
    options.samples = 32;
    options.roulette_depth = 16;  // few samples that shall find whether there is light
    options.effects = reference::parse_effects(effects);
    const reference::Picture picture = tracer.render(scene.cameras[0], options);
    SeenLight out;
    for (const glm::vec3& radiance : picture.radiance) {
        const double y = 0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z;
        out.mean += y / static_cast<double>(picture.radiance.size());
        out.share += (y > 0.0) / static_cast<double>(picture.radiance.size());
    }
    return out;
}

TEST(Interiors, CamerasSeeLittleDirectLight) {
    const struct {
        int room;
        double most;  // share of the pixels
    } cases[] = {{0, 0.0}, {1, 0.10}, {2, 0.12}, {3, 0.25}, {4, 0.45}, {5, 0.15}};
    for (const auto& one : cases) {
        const Room& room = rooms()[static_cast<std::size_t>(one.room)];
        EXPECT_LE(seen(room.scene, "direct").share, one.most) << room.name;
        const SeenLight indirect = seen(room.scene, "indirect");
        EXPECT_GT(indirect.share, 0.9) << room.name;
        EXPECT_GT(indirect.mean, 0.0) << room.name;
    }
}

// Where the light meets a surface first, from far outside.
TEST(Interiors, LightEntersWhereItShould) {
    const auto lit = [](const Scene& scene, const glm::dvec3& through) {
        const glm::dvec3 way(scene.lights[0].direction);
        const glm::dvec3 from = through - 30.0 * way;
        return from + geometry::first_hit(scene, from, way) * way;
    };
    // Of the office's window, between the bars: the wall on the right, at x = 6.
    EXPECT_NEAR(lit(rooms()[1].scene, {0.0, 1.5, 1.7}).x, 6.0, 1e-6);
    // Of the maze's opening: the wall behind the passage, on its side away from the camera.
    const Scene& maze = rooms()[0].scene;
    const glm::dvec3 met = lit(maze, {2.2, 2.4, 0.85});
    EXPECT_NEAR(met.z, 1.4, 1e-6);
    EXPECT_LT(glm::dot(glm::dvec3(maze.lights[0].direction), met - maze.cameras[0].position), 0.0);
    // Beside the window: the wall's outer side.
    EXPECT_NEAR(lit(rooms()[1].scene, {0.0, 1.5, 0.5}).x, -0.25, 1e-6);
}

// The figure stays in the free circle, on the floor, and its clip begins as it ends.
TEST(Interiors, TheFigureWalksWhereThereIsRoom) {
    const Scene& scene = rooms()[2].scene;
    ASSERT_TRUE(scene.animation);
    const PosedRange& range = scene.animation->ranges.at(0);
    const double duration = scene.animation->clips[0].duration;
    EXPECT_NEAR(duration, 6.4, 1e-6);
    double highest = 0.0;
    for (int i = 0; i <= 32; ++i) {
        const Scene at = posed(scene, pose_at(*scene.animation, 0, duration * i / 32));
        double low = INFINITY;
        for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
            const glm::dvec3& p = at.positions[range.first_vertex + v];
            low = std::min(low, p.y);
            highest = std::max(highest, p.y);
            ASSERT_LT(std::hypot(p.x - 3.15, p.z - 2.35), 1.35) << i;
        }
        EXPECT_GT(low, -0.03) << i;
        EXPECT_LT(low, 0.06) << i;
    }
    EXPECT_GT(highest, 1.75);  // the hand that waves
    const Scene first = posed(scene, pose_at(*scene.animation, 0, 0.0));
    const Scene last = posed(scene, pose_at(*scene.animation, 0, duration));
    double apart = 0.0;
    for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
        const std::uint32_t vertex = range.first_vertex + v;
        apart = std::max(apart, glm::length(first.positions[vertex] - last.positions[vertex]));
        // The scene's own arrays hold the beginning of the clip.
        ASSERT_LT(glm::length(first.positions[vertex] - scene.positions[vertex]), 1e-5);
    }
    EXPECT_LT(apart, 1e-5);
}

TEST(Interiors, GlossIsWhatWasAskedFor) {
    GlossyOptions options;
    options.roughness = 0.25f;
    options.metallic = 0.5f;
    const Scene scene = glossy_box(options);
    std::size_t shining = 0;
    for (const Material& material : scene.materials) {
        if (material.name != "glossy") {
            EXPECT_EQ(material.roughness, 1.0f);
            continue;
        }
        ++shining;
        EXPECT_EQ(material.roughness, 0.25f);
        EXPECT_EQ(material.metallic, 0.5f);
    }
    EXPECT_EQ(shining, 1u);
}

TEST(Interiors, RefuseOptionsOutOfRange) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(maze({-1.0f}), Error);
    EXPECT_THROW(office({nan}), Error);
    EXPECT_THROW(character({nan}), Error);
    EXPECT_THROW(oriental_like({-1.0f}), Error);
    GlossyOptions rough;
    rough.roughness = 0.0f;
    EXPECT_THROW(glossy_box(rough), Error);
    rough.roughness = 0.5f;
    rough.metallic = 1.5f;
    EXPECT_THROW(glossy_bust_like(rough), Error);
}

}  // namespace
}  // namespace clgi::test
