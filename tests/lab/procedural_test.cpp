// Generated scenes: exact counts and sizes, closed surfaces, lamps and cameras in their place.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "geometry.hpp"
#include "lab/scenes/rooms.hpp"

namespace {

using namespace geometry;
using clgi::LightSource;
using clgi::Scene;

using std::numbers::pi;

struct Named {
    std::string name;
    Scene scene;
};

std::vector<Named> all_scenes() {
    clgi::CornellOptions cornell_spot, cornell_point;
    cornell_spot.light = LightSource::spot;
    cornell_point.light = LightSource::point;
    clgi::FurnaceOptions furnace_area, furnace_point;
    furnace_area.light = LightSource::area;
    furnace_point.light = LightSource::point;
    clgi::BoxOptions box_point;
    box_point.light = LightSource::point;
    return {{"cornell", clgi::cornell()},
            {"cornell spot", clgi::cornell(cornell_spot)},
            {"cornell point", clgi::cornell(cornell_point)},
            {"box", clgi::box()},
            {"box point", clgi::box(box_point)},
            {"furnace", clgi::furnace()},
            {"furnace area", clgi::furnace(furnace_area)},
            {"furnace point", clgi::furnace(furnace_point)},
            {"corridor", clgi::corridor()},
            {"bumpy mesh", clgi::bumpy_mesh()}};
}

TEST(Procedural, EverySceneIsValid) {
    for (const Named& named : all_scenes()) {
        EXPECT_NO_THROW(clgi::validate(named.scene)) << named.name;
        EXPECT_EQ(named.scene.warnings.size(), 0u) << named.name;
    }
}

TEST(Procedural, EverySceneHasACameraAndALight) {
    for (const Named& named : all_scenes()) {
        if (named.name == "bumpy mesh") continue;
        EXPECT_EQ(named.scene.cameras.size(), 1u) << named.name;
        EXPECT_TRUE(!named.scene.lights.empty() || clgi::has_emission(named.scene)) << named.name;
    }
}

TEST(Procedural, EverySurfaceIsDiffuse) {
    for (const Named& named : all_scenes()) {
        for (const clgi::Material& material : named.scene.materials) {
            EXPECT_EQ(material.metallic, 0.0f) << named.name;
            EXPECT_EQ(material.roughness, 1.0f) << named.name;
        }
    }
}

TEST(Procedural, PartsCoverAllTrianglesOnce) {
    for (const Named& named : all_scenes()) {
        std::uint32_t next = 0;
        for (const clgi::Part& part : named.scene.parts) {
            EXPECT_EQ(part.first_triangle, next) << named.name;
            EXPECT_GT(part.triangle_count, 0u) << named.name;
            next += part.triangle_count;
        }
        EXPECT_EQ(next, named.scene.triangles.size()) << named.name;
    }
}

TEST(Procedural, NoTriangleIsDegenerateOrTurnedAgainstItsNormals) {
    for (const Named& named : all_scenes()) {
        for (std::size_t t = 0; t < named.scene.triangles.size(); ++t) {
            const glm::dvec3 face = doubled_area(named.scene, t);
            ASSERT_GT(glm::length(face), 0.0) << named.name << " triangle " << t;
            for (const std::uint32_t vertex : named.scene.triangles[t].vertex) {
                ASSERT_GT(glm::dot(face, glm::dvec3(named.scene.normals[vertex])), 0.0)
                    << named.name << " triangle " << t;
            }
        }
    }
}

// A spot of I candela gives I / d^2 lux where its axis meets a surface head on.
TEST(Procedural, SpotsGiveBetweenOneAndTenTimesPiLux) {
    for (const Named& named : all_scenes()) {
        if (named.name.rfind("furnace", 0) == 0) continue;  // there the numbers are round
        for (const clgi::Light& light : named.scene.lights) {
            if (light.kind != clgi::Light::Kind::spot) continue;
            const glm::dvec3 direction(light.direction);
            const double distance = first_hit(named.scene, light.position, direction);
            const double lux = light.intensity.y / (distance * distance);
            EXPECT_GT(lux, 1.0) << named.name;
            EXPECT_LT(lux, 10.0 * pi) << named.name;
        }
    }
}

TEST(Procedural, SameOptionsGiveTheSameScene) {
    const Scene first = clgi::box(), second = clgi::box();
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.normals, second.normals);
}

TEST(Cornell, HasThePublishedSize) {
    const clgi::Bounds room = clgi::bounds(clgi::cornell());
    EXPECT_EQ(room.low, glm::dvec3(0.0));
    EXPECT_NEAR(room.high.x, 0.556, 1e-12);
    EXPECT_NEAR(room.high.y, 0.5488, 1e-12);
    EXPECT_NEAR(room.high.z, 0.5592, 1e-12);
}

TEST(Cornell, LampHasThePublishedSizeAndHangsOverNoCeiling) {
    const Scene scene = clgi::cornell();
    const clgi::Part lamp = scene.parts.back();
    ASSERT_EQ(lamp.name, "lamp");
    double lamp_area = 0.0, ceiling_area = 0.0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::dvec3 face = 0.5 * doubled_area(scene, t);
        const bool in_ceiling = corner(scene, t, 0).y > 0.54 && std::abs(face.y) > 0.0 &&
                                std::abs(face.x) + std::abs(face.z) < 1e-12;
        if (!in_ceiling) continue;
        EXPECT_LT(face.y, 0.0);  // both look down
        (t >= lamp.first_triangle ? lamp_area : ceiling_area) += glm::length(face);
    }
    EXPECT_NEAR(lamp_area, 0.130 * 0.105, 1e-12);
    EXPECT_NEAR(lamp_area + ceiling_area, 0.556 * 0.5592, 1e-12);
}

TEST(Cornell, RedIsOnTheLeftOfThePicture) {
    const Scene scene = clgi::cornell();
    const clgi::Camera& camera = scene.cameras[0];
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const std::string& name = scene.materials[scene.triangles[t].material].name;
        const glm::dvec3 seen = corner(scene, t, 0) - camera.position;
        const double to_the_right = glm::dot(seen, glm::dvec3(camera.right));
        if (name == "red") {
            EXPECT_LT(to_the_right, 0.0);
        }
        if (name == "green") {
            EXPECT_GT(to_the_right, 0.0);
        }
    }
}

TEST(Box, HasTwelveTrianglesOfWallAndThePapersMesh) {
    const Scene scene = clgi::box();
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].triangle_count, 12u);
    EXPECT_EQ(scene.parts[1].triangle_count, 69451u);
}

TEST(Box, WallsCloseAndLookInward) {
    const Scene scene = clgi::box();
    EXPECT_TRUE(open_edges(scene, [](const clgi::Part& p) { return p.name == "room"; }).empty());
    EXPECT_NEAR(volume(scene, 0, 12), -2.0 * 2.0 * 3.0, 1e-12);
}

TEST(Box, MeshFloatsInTheMiddleAtItsShareOfTheHeight) {
    Scene mesh;  // a tall tetrahedron far from the origin
    mesh.positions = {{100, 0, 0}, {101, 0, 0}, {100, 0, 1}, {100, 4, 0}};
    mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
    mesh.triangles = {{{0, 1, 2}, 0}, {{0, 3, 1}, 0}, {{1, 3, 2}, 0}, {{2, 3, 0}, 0}};
    mesh.materials.resize(1);
    const Scene scene = clgi::box(mesh);
    glm::dvec3 low(1e9), high(-1e9);
    for (std::size_t t = 12; t < scene.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, corner(scene, t, k));
            high = glm::max(high, corner(scene, t, k));
        }
    }
    EXPECT_NEAR(high.y - low.y, 0.45 * 2.0, 1e-12);
    EXPECT_NEAR(glm::length(0.5 * (low + high) - glm::dvec3(0.0, 1.0, 0.0)), 0.0, 1e-12);
}

TEST(Box, CameraAndLampAreInsideAndOutsideTheMesh) {
    const Scene scene = clgi::box();
    const clgi::Bounds room = clgi::bounds(scene);
    for (const glm::dvec3& at : {scene.cameras[0].position, scene.lights[0].position}) {
        EXPECT_TRUE(glm::all(glm::greaterThan(at, room.low)));
        EXPECT_TRUE(glm::all(glm::lessThan(at, room.high)));
        EXPECT_GT(glm::length(at - glm::dvec3(0.0, 1.0, 0.0)), 0.7);
    }
}

TEST(Box, RefusesAMeshWithoutTrianglesOrExtent) {
    EXPECT_THROW(clgi::box(Scene{}), clgi::InputError);
    Scene point;
    point.positions.assign(3, {1.0, 2.0, 3.0});
    point.normals.assign(3, {0.0f, 1.0f, 0.0f});
    point.triangles = {{{0, 1, 2}, 0}};
    point.materials.resize(1);
    EXPECT_THROW(clgi::box(point), clgi::InputError);
}

TEST(BumpyMesh, HasAsManyTrianglesAsTheStanfordBunny) {
    EXPECT_EQ(clgi::bumpy_mesh().triangles.size(), 69451u);
}

// The one edge with a vertex on its middle: from one side it is whole, from the other two halves.
TEST(BumpyMesh, IsClosedButForOneCutEdgeWhoseMiddleLiesOnIt) {
    const std::vector<Edge> open = open_edges(clgi::bumpy_mesh(), any_part);
    ASSERT_EQ(open.size(), 3u);
    glm::dvec3 sum(0.0);
    double longest = 0.0, whole = 0.0;
    for (const auto& [from, to] : open) {
        const glm::dvec3 along(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
        sum += along;
        longest = std::max(longest, glm::length(along));
        whole += glm::length(along);
    }
    EXPECT_NEAR(glm::length(sum), 0.0, 1e-9 * whole);
    EXPECT_NEAR(whole, 2.0 * longest, 1e-6 * whole);  // the two halves lie on the whole
}

TEST(BumpyMesh, IsStarShapedWithFacesOutward) {
    const Scene mesh = clgi::bumpy_mesh();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        ASSERT_GT(glm::dot(corner(mesh, t, 0), doubled_area(mesh, t)), 0.0) << t;
    }
    for (const glm::dvec3& p : mesh.positions) {
        ASSERT_GT(glm::length(p), 0.69);
        ASSERT_LT(glm::length(p), 1.31);
    }
}

TEST(Furnace, IsAClosedSphereLookingInward) {
    for (int subdivisions = 0; subdivisions <= 5; ++subdivisions) {
        clgi::FurnaceOptions options;
        options.subdivisions = subdivisions;
        const Scene scene = clgi::furnace(options);
        const std::size_t count = std::size_t{20} << (2 * subdivisions);
        EXPECT_EQ(scene.triangles.size(), count);
        EXPECT_EQ(scene.positions.size(), count / 2 + 2);  // Euler
        EXPECT_TRUE(open_edges(scene, any_part).empty());
        EXPECT_LT(volume(scene, 0, count), 0.0);
    }
}

TEST(Furnace, AreaComesNearerToFourPiWithEverySubdivision) {
    double previous = 4.0 * pi;
    for (int subdivisions = 0; subdivisions <= 5; ++subdivisions) {
        clgi::FurnaceOptions options;
        options.subdivisions = subdivisions;
        const double missing = 4.0 * pi - area(clgi::furnace(options));
        EXPECT_GT(missing, 0.0);
        EXPECT_LT(missing, previous / (subdivisions < 2 ? 2.0 : 3.5));  // second order
        previous = missing;
    }
}

TEST(Furnace, EveryVertexIsOnTheSphereWithItsNormalToTheCentre) {
    clgi::FurnaceOptions options;
    options.radius = 2.5;
    const Scene scene = clgi::furnace(options);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        ASSERT_NEAR(glm::length(scene.positions[v]), 2.5, 1e-14);
        const glm::dvec3 inward = -scene.positions[v] / 2.5;
        ASSERT_NEAR(glm::length(glm::dvec3(scene.normals[v]) - inward), 0.0, 1e-7);
    }
}

TEST(Furnace, LampIsWhatWasAskedFor) {
    clgi::FurnaceOptions options;
    const clgi::Light spot = clgi::furnace(options).lights.at(0);
    EXPECT_EQ(spot.kind, clgi::Light::Kind::spot);
    EXPECT_LT(spot.inner_angle, spot.outer_angle);
    EXPECT_NEAR(spot.inner_angle, pi / 6.0, 1e-6);
    EXPECT_EQ(spot.position, glm::dvec3(0.0));
    options.light = LightSource::point;
    EXPECT_EQ(clgi::furnace(options).lights.at(0).kind, clgi::Light::Kind::point);
    options.light = LightSource::area;
    EXPECT_TRUE(clgi::furnace(options).lights.empty());
    EXPECT_TRUE(clgi::has_emission(clgi::furnace(options)));
}

TEST(Corridor, IsClosedWhateverItsNumberOfRooms) {
    for (const int rooms : {1, 3, 7}) {
        clgi::CorridorOptions options;
        options.rooms = rooms;
        options.room_length = 3.0 + 0.1 * rooms;
        const Scene scene = clgi::corridor(options);
        EXPECT_TRUE(open_edges(scene, any_part).empty()) << rooms;  // doors are solids, closed too
    }
}

// However far its doors are open, a corridor has the same walls, and none stands before a doorway.
TEST(Corridor, HasTheSameSurfaceForEveryAngleOfItsDoors) {
    for (const double length : {3.0, 4.0, 9.0}) {
        clgi::CorridorOptions options;
        options.room_length = length;
        const double wanted = area(clgi::corridor(options));
        for (const float angle : {0.1f, 1.5f, 2.59f, 2.61f, 2.96f}) {
            options.door_angle = angle;
            const Scene scene = clgi::corridor(options);
            EXPECT_NEAR(area(scene), wanted, 1e-7 * wanted) << length << " " << angle;
            EXPECT_TRUE(open_edges(scene, any_part).empty()) << length << " " << angle;
        }
    }
}

TEST(Corridor, HoldsTheAirOfItsRooms) {
    const Scene scene = clgi::corridor();
    double air = 0.0;
    for (const clgi::Part& part : scene.parts) {
        if (part.name != "door") air -= volume(scene, part.first_triangle, part.triangle_count);
    }
    const double corridor = 2.0 * 2.5 * 12.0, room = 3.0 * 2.5 * (4.0 - 0.12);
    const double doorway = 0.12 * 0.9 * 2.05;
    EXPECT_NEAR(air, corridor + 6.0 * (room + doorway), 1e-9);
}

TEST(Corridor, LightReachesARoomOnlyThroughItsDoor) {
    clgi::CorridorOptions options;
    options.door_angle = 0.0f;
    const Scene closed = clgi::corridor(options);
    const glm::dvec3 in_corridor(0.0, 1.0, -1.2), in_room(2.5, 1.0, -1.2);
    EXPECT_LT(first_hit(closed, in_corridor, glm::normalize(in_room - in_corridor)), 2.5);
    const glm::dvec3 left_room(-2.5, 1.0, -1.2);  // through the first door on the left
    EXPECT_LT(first_hit(closed, in_corridor, {-1.0, 0.0, 0.0}), 1.5);
    options.door_angle = 1.5f;
    EXPECT_GT(first_hit(clgi::corridor(options), in_corridor, {-1.0, 0.0, 0.0}),
              glm::length(left_room - in_corridor));
}

TEST(Procedural, OptionsOutOfRangeAreRefusedByName) {
    const auto refused = [](const std::function<void()>& make, const std::string& option) {
        try {
            make();
            ADD_FAILURE() << option << " was taken";
        } catch (const clgi::Error& error) {
            EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
        }
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    refused([] { clgi::furnace({.albedo = 1.0f}); }, "albedo");
    refused([] { clgi::furnace({.albedo = nan}); }, "albedo");
    refused([] { clgi::furnace({.albedo = -0.1f}); }, "albedo");
    refused([] { clgi::furnace({.subdivisions = 9}); }, "subdivisions");
    refused([] { clgi::furnace({.subdivisions = -1}); }, "subdivisions");
    refused([] { clgi::furnace({.radius = 0.0}); }, "radius");
    refused([] { clgi::cornell({.cone_angle = 0.0f}); }, "cone_angle");
    refused([] { clgi::cornell({.radiance = glm::vec3(-1.0f)}); }, "radiance");
    refused([] { clgi::box({.light = LightSource::area}); }, "lamp");
    refused([] { clgi::box({.mesh_height = 1.5}); }, "mesh_height");
    refused([] { clgi::box({.left = glm::vec3(2.0f)}); }, "left");
    refused([] { clgi::corridor({.rooms = 0}); }, "rooms");
    refused([] { clgi::corridor({.door_angle = 3.0f}); }, "door_angle");
}

}  // namespace
