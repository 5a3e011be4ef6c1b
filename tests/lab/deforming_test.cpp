// Generated scenes that deform: counts of [Kautz04, table 1], closed surfaces, motion that repeats.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include "lab/scenes/deforming.hpp"

#include "geometry.hpp"
#include "gltf_draft.hpp"

namespace clgi::test {
namespace {

struct Model {
    std::string name;
    Scene scene;
    std::size_t vertices, triangles;
    std::size_t border;  // edges of one triangle: of floors, tiles, cloth, nails and a belt's end
    std::size_t closed;  // surfaces without such an edge
};

// Made once: the hand takes a second or two.
const std::vector<Model>& models() {
    static const std::vector<Model> all = {
        {"cloth", cloth(), 1378, 2560, 4 * 32 + 4 * 16, 0},
        {"chess", chess(), 1897, 3704, 4 * 16, 6},
        {"fight-like", fight_like(), 2978, 4806, 81 * 12 + 10, 2},
        {"hand-like", hand_like(), 8636, 15854, 96 * 12 + 5 * 12, 1},
    };
    return all;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// How many triangles run along each edge, in its direction.
std::map<Edge, int> directed_edges(const Scene& scene) {
    std::map<Edge, int> edges;
    for (const SceneTriangle& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k) ++edges[{triangle.vertex[k], triangle.vertex[(k + 1) % 3]}];
    return edges;
}

// The surface that each triangle belongs to: all that its edges reach.
std::vector<std::uint32_t> surfaces(const Scene& scene) {
    std::vector<std::uint32_t> root(scene.positions.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const SceneTriangle& triangle : scene.triangles)
        for (int k = 1; k < 3; ++k) root[find(triangle.vertex[k])] = find(triangle.vertex[0]);
    std::vector<std::uint32_t> of_triangles;
    for (const SceneTriangle& triangle : scene.triangles)
        of_triangles.push_back(find(triangle.vertex[0]));
    return of_triangles;
}

std::set<std::uint32_t> closed_surfaces(const Scene& scene) {
    const std::map<Edge, int> edges = directed_edges(scene);
    const std::vector<std::uint32_t> surface = surfaces(scene);
    std::set<std::uint32_t> closed(surface.begin(), surface.end());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto& vertex = scene.triangles[t].vertex;
            if (!edges.count({vertex[(k + 1) % 3], vertex[k]})) closed.erase(surface[t]);
        }
    return closed;
}

Scene at(const Scene& scene, double time) {
    return posed(scene, pose_at(*scene.animation, 0, time));
}

double size_of(const Scene& scene) {
    double size = 0.0;
    const PosedRange& range = scene.animation->ranges[0];
    for (std::uint32_t v = 0; v < range.vertex_count; ++v)
        size = std::max(size, glm::length(scene.positions[range.first_vertex + v] -
                                          scene.positions[range.first_vertex]));
    return size;
}

TEST(Deforming, HasAsManyVerticesAndTrianglesAsThePaper) {
    for (const Model& model : models()) {
        EXPECT_EQ(model.scene.positions.size(), model.vertices) << model.name;
        EXPECT_EQ(model.scene.triangles.size(), model.triangles) << model.name;
        std::set<std::uint32_t> used;
        for (const SceneTriangle& triangle : model.scene.triangles)
            used.insert(std::begin(triangle.vertex), std::end(triangle.vertex));
        EXPECT_EQ(used.size(), model.vertices) << model.name;
    }
}

// Also in the file, and at all times.
TEST(Deforming, SurvivesItsFile) {
    for (const Model& model : models()) {
        const TempFolder folder;
        io::save_glb(model.scene, folder.path() / "scene.glb");
        const Scene after = io::load_gltf(folder.path() / "scene.glb");
        EXPECT_EQ(after.positions.size(), model.vertices) << model.name;
        EXPECT_EQ(after.triangles.size(), model.triangles) << model.name;
        EXPECT_TRUE(after.warnings.empty()) << model.name;
        ASSERT_TRUE(after.animation) << model.name;
        EXPECT_EQ(after.animation->clips[0].name, model.scene.animation->clips[0].name);
        const double time = 0.4 * after.animation->clips[0].duration;
        const Scene a = at(model.scene, time), b = at(after, time);
        double worst = 0.0;
        for (std::size_t v = 0; v < model.vertices; ++v)
            worst = std::max(worst, glm::length(a.positions[v] - b.positions[v]));
        // Inverse bind matrices and rest positions are rounded to float.
        EXPECT_LE(worst, 4 * 0x1p-24 * 4.0) << model.name;
    }
}

TEST(Deforming, EdgesHaveTwoTrianglesOfOppositeSense) {
    for (const Model& model : models()) {
        std::size_t border = 0;
        const std::map<Edge, int> edges = directed_edges(model.scene);
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1) << model.name << " " << edge.first << " " << edge.second;
            border += edges.count({edge.second, edge.first}) == 0;
        }
        EXPECT_EQ(border, model.border) << model.name;
        EXPECT_EQ(closed_surfaces(model.scene).size(), model.closed) << model.name;
    }
}

TEST(Deforming, ClosedSurfacesLieAroundTheirInside) {
    for (const Model& model : models()) {
        const std::vector<std::uint32_t> surface = surfaces(model.scene);
        for (const std::uint32_t one : closed_surfaces(model.scene)) {
            double volume = 0.0;
            for (std::size_t t = 0; t < surface.size(); ++t) {
                if (surface[t] != one) continue;
                const auto& [a, b, c] = model.scene.triangles[t].vertex;
                const auto& p = model.scene.positions;
                volume += glm::dot(p[a], glm::cross(p[b], p[c])) / 6.0;
            }
            EXPECT_GT(volume, 0.0) << model.name;
        }
    }
}

TEST(Deforming, NormalsAreUnitAndOnTheFrontOfTheirTriangles) {
    for (const Model& model : models()) {
        const Scene& scene = model.scene;
        std::size_t against = 0;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            const glm::dvec3 face = geometry::doubled_area(scene, t);
            ASSERT_GT(glm::length(face), 0.0) << model.name << " triangle " << t;
            for (const std::uint32_t vertex : scene.triangles[t].vertex) {
                const glm::dvec3 normal(scene.normals[vertex]);
                ASSERT_NEAR(glm::length(normal), 1.0, 1e-6) << model.name;
                against += glm::dot(face, normal) <= 0.0;
            }
        }
        // A fold of the cloth may be sharper than a right angle.
        EXPECT_LE(against, model.name == "cloth" ? scene.triangles.size() / 100 : 0u) << model.name;
    }
}

// Whether a segment passes through a triangle, by the signs of volumes.
bool pierces(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b,
             const glm::dvec3& c) {
    const auto volume = [](const glm::dvec3& o, const glm::dvec3& u, const glm::dvec3& v,
                           const glm::dvec3& w) {
        return glm::dot(u - o, glm::cross(v - o, w - o));
    };
    if (volume(p, a, b, c) * volume(q, a, b, c) >= 0.0) return false;
    const double x = volume(p, q, a, b), y = volume(p, q, b, c), z = volume(p, q, c, a);
    return (x > 0.0 && y > 0.0 && z > 0.0) || (x < 0.0 && y < 0.0 && z < 0.0);
}

TEST(Deforming, ClosedSurfacesDoNotPassThroughThemselvesAtRest) {
    for (const Model& model : models()) {
        const std::set<std::uint32_t> closed = closed_surfaces(model.scene);
        const std::vector<std::uint32_t> surface = surfaces(model.scene);
        const auto& p = model.scene.positions;
        std::vector<std::size_t> list;
        for (std::size_t t = 0; t < surface.size(); ++t)
            if (closed.count(surface[t])) list.push_back(t);
        // By their least x, so that only a few have to be compared.
        const auto reach = [&](std::size_t t) {
            const auto& [a, b, c] = model.scene.triangles[t].vertex;
            return std::minmax({p[a].x, p[b].x, p[c].x});
        };
        std::sort(list.begin(), list.end(),
                  [&](std::size_t a, std::size_t b) { return reach(a).first < reach(b).first; });
        double widest = 0.0;
        for (const std::size_t t : list)
            widest = std::max(widest, reach(t).second - reach(t).first);
        std::size_t crossings = 0;
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t k = i + 1; k < list.size(); ++k) {
                if (reach(list[k]).first > reach(list[i]).second + widest) break;
                const auto& one = model.scene.triangles[list[i]].vertex;
                const auto& two = model.scene.triangles[list[k]].vertex;
                bool shared = false, apart = false;
                for (const std::uint32_t a : one)
                    for (const std::uint32_t b : two) shared |= a == b;
                for (int axis = 0; axis < 3; ++axis) {
                    const auto [low, high] =
                        std::minmax({p[one[0]][axis], p[one[1]][axis], p[one[2]][axis]});
                    const auto [from, to] =
                        std::minmax({p[two[0]][axis], p[two[1]][axis], p[two[2]][axis]});
                    apart |= low > to || from > high;
                }
                if (shared || apart) continue;
                for (int edge = 0; edge < 3; ++edge) {
                    crossings += pierces(p[one[edge]], p[one[(edge + 1) % 3]], p[two[0]], p[two[1]],
                                         p[two[2]]);
                    crossings += pierces(p[two[edge]], p[two[(edge + 1) % 3]], p[one[0]], p[one[1]],
                                         p[one[2]]);
                }
            }
        EXPECT_EQ(crossings, 0u) << model.name;
    }
}

TEST(Deforming, EveryPoseIsFiniteAndAboveTheFloor) {
    for (const Model& model : models()) {
        const double duration = model.scene.animation->clips[0].duration;
        for (int i = 0; i <= 40; ++i) {
            const Scene now = at(model.scene, duration * i / 40);
            double lowest = 0.0;
            for (std::size_t v = 0; v < now.positions.size(); ++v) {
                ASSERT_LT(glm::length(now.positions[v]), 10.0) << model.name;
                ASSERT_NEAR(glm::length(now.normals[v]), 1.0f, 1e-5f) << model.name;
                lowest = std::min(lowest, now.positions[v].y);
            }
            // Cloth between its states, and the sole of a foot that rolls.
            EXPECT_GE(lowest, -0.012 * size_of(model.scene)) << model.name << " " << i;
        }
    }
}

TEST(Deforming, MovesByAGoodShareOfItsSize) {
    for (const Model& model : models()) {
        const Scene start = at(model.scene, 0.0);
        const double duration = model.scene.animation->clips[0].duration;
        EXPECT_GE(duration, 2.0) << model.name;
        EXPECT_LE(duration, 4.0) << model.name;
        double most = 0.0;
        for (int i = 1; i < 20; ++i) {
            const Scene now = at(model.scene, duration * i / 20);
            for (std::size_t v = 0; v < now.positions.size(); ++v)
                most = std::max(most, glm::length(now.positions[v] - start.positions[v]));
        }
        EXPECT_GT(most, 0.2 * size_of(model.scene)) << model.name;
    }
}

TEST(Deforming, EndsAsItBegins) {
    for (const Model& model : models()) {
        const Scene first = at(model.scene, 0.0);
        const Scene last = at(model.scene, model.scene.animation->clips[0].duration);
        for (std::size_t v = 0; v < first.positions.size(); ++v) {
            // Keys are floats.
            ASSERT_LE(glm::length(first.positions[v] - last.positions[v]), 1e-6) << model.name;
            ASSERT_LE(glm::length(first.normals[v] - last.normals[v]), 1e-5f) << model.name;
        }
    }
}

// No jump at the place where it is repeated: steps before and after it are alike.
TEST(Deforming, RepeatsWithoutAJerk) {
    for (const Model& model : models()) {
        const double duration = model.scene.animation->clips[0].duration, step = 0.01;
        const Scene before = at(model.scene, duration - step), here = at(model.scene, 0.0),
                    after = at(model.scene, step);
        double worst = 0.0;
        for (std::size_t v = 0; v < here.positions.size(); ++v)
            worst = std::max(worst, glm::length(before.positions[v] - 2.0 * here.positions[v] +
                                                after.positions[v]));
        // 100 m/s^2 are ten times what falls; scenes in metres.
        EXPECT_LE(worst, 100.0 * step * step) << model.name;
    }
}

std::uint32_t node_of(const Scene& scene, const std::string& name) {
    const auto& nodes = scene.animation->nodes;
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&](const AnimatedNode& node) { return node.name == name; });
    EXPECT_NE(found, nodes.end()) << name;
    return static_cast<std::uint32_t>(found - nodes.begin());
}

TEST(FightLike, JabsCrossesAndKicks) {
    const Scene& scene = models()[2].scene;
    EXPECT_EQ(scene.animation->nodes.size(), 16u);
    const auto place = [&](const char* name, double time) {
        return glm::dvec3(pose_at(*scene.animation, 0, time).matrices[node_of(scene, name)][3]);
    };
    EXPECT_GT(place("left hand", 0.4).z, place("left hand", 0.0).z + 0.25);
    EXPECT_GT(place("right hand", 0.9).z, place("right hand", 0.0).z + 0.3);
    EXPECT_GT(place("right foot", 2.0).y, 0.9);
    // The other foot stands.
    for (int i = 0; i <= 32; ++i)
        EXPECT_LE(glm::length(place("left foot", 0.1 * i) - place("left foot", 0.0)), 0.01) << i;
}

TEST(HandLike, FingersCloseToThePalm) {
    const Scene& scene = models()[3].scene;
    EXPECT_EQ(scene.animation->nodes.size(), 17u);
    const Pose open = pose_at(*scene.animation, 0, 0.0), fist = pose_at(*scene.animation, 0, 2.0);
    for (const char* finger : {"index 3", "middle 3", "ring 3", "little 3"}) {
        const std::uint32_t node = node_of(scene, finger);
        const glm::dvec3 knuckle(fist.matrices[node - 2][3]);
        // The last joint is below the knuckle and before the palm.
        EXPECT_LT(fist.matrices[node][3].y, knuckle.y) << finger;
        EXPECT_GT(fist.matrices[node][3].z, knuckle.z + 0.01) << finger;
        EXPECT_GT(open.matrices[node][3].y, open.matrices[node - 2][3].y + 0.04) << finger;
    }
}

TEST(HandLike, HasGlossOnlyIfAsked) {
    for (const Material& material : models()[3].scene.materials)
        EXPECT_EQ(material.roughness, 1.0f) << material.name;
    HandOptions options;
    options.roughness = 0.3f;
    std::size_t glossy = 0;
    for (const Material& material : hand_like(options).materials)
        glossy += material.roughness == 0.3f;
    EXPECT_EQ(glossy, 2u);  // skin and nails
}

TEST(Deforming, HasACameraALightAndASky) {
    for (const Model& model : models()) {
        EXPECT_EQ(model.scene.cameras.size(), 1u) << model.name;
        ASSERT_EQ(model.scene.lights.size(), 1u) << model.name;
        EXPECT_EQ(model.scene.lights[0].kind, Light::Kind::directional) << model.name;
        ASSERT_TRUE(model.scene.environment) << model.name;
        const std::vector<glm::vec3>& texels = model.scene.environment->texels;
        EXPECT_GT(texels.front().y, 2.0f * texels.back().y) << model.name;
        EXPECT_TRUE(model.scene.warnings.empty()) << model.name;
    }
}

TEST(Deforming, OptionsOutOfRangeAreRefused) {
    ClothOptions states;
    states.states = 3;
    EXPECT_THROW(cloth(states), Error);
    ChessOptions white;
    white.white.g = 1.5f;
    EXPECT_THROW(chess(white), Error);
    FightOptions gloves;
    gloves.gloves.b = -0.1f;
    EXPECT_THROW(fight_like(gloves), Error);
    HandOptions roughness;
    roughness.roughness = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(hand_like(roughness), Error);
}

TEST(Cloth, HasAsManyStatesAsAsked) {
    ClothOptions options;
    options.states = 8;
    const Scene scene = cloth(options);
    EXPECT_EQ(scene.animation->ranges[0].target_count, 7u);
    EXPECT_EQ(scene.positions.size(), 1378u);
}

}  // namespace
}  // namespace clgi::test
