// The inside of a sphere: any two of its points exchange the same share of light, 1 / (4 pi R^2),
// so light that has bounced once is the same everywhere and every order has a closed form.
// SPDX-License-Identifier: MIT
#include <clgi/procedural.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "scene/surfaces.hpp"

namespace clgi {
namespace {

constexpr float highest_albedo = 0.999f;  // a thousand times the light of the first bounce

// Vertices and faces of a regular icosahedron, faces counter-clockwise seen from outside.
struct Mesh {
    std::vector<glm::dvec3> directions;
    std::vector<std::array<std::uint32_t, 3>> faces;
};

Mesh icosahedron() {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    Mesh mesh;
    mesh.directions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                       {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (glm::dvec3& direction : mesh.directions) direction = glm::normalize(direction);
    mesh.faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    return mesh;
}

// Every face in four; the new vertices are shared and pushed out to the sphere.
Mesh subdivide(const Mesh& coarse) {
    Mesh fine;
    fine.directions = coarse.directions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, added] =
            middles.try_emplace(std::minmax(a, b), std::uint32_t(fine.directions.size()));
        if (added) {
            fine.directions.push_back(glm::normalize(fine.directions[a] + fine.directions[b]));
        }
        return entry->second;
    };
    for (const auto& [a, b, c] : coarse.faces) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return fine;
}

void add_lamp(Scene& scene, const FurnaceOptions& options) {
    const glm::vec3 intensity(options.intensity);
    if (options.light == LightSource::area) {
        scene.materials[0].emission = glm::vec3(options.radiance);
    } else if (options.light == LightSource::point) {
        scene.lights.push_back(generated::point("point", glm::dvec3(0.0), intensity));
    } else {
        Light light = generated::spot("spot", glm::dvec3(0.0), {0.0, -1.0, 0.0}, intensity,
                                      options.cone_angle);
        // The closed form is that of a cone without a soft edge; glTF wants inner below outer.
        light.inner_angle = std::nextafter(options.cone_angle, 0.0f);
        scene.lights.push_back(light);
    }
}

}  // namespace

Scene furnace(const FurnaceOptions& options) {
    generated::check_range("furnace", "albedo", options.albedo, 0.0f, highest_albedo);
    generated::check_range("furnace", "subdivisions", options.subdivisions, 0, 8);
    generated::check_range("furnace", "radius", options.radius, 1e-6, 1e9);
    generated::check_range("furnace", "cone_angle", options.cone_angle, 1e-3, 1.57);
    generated::check_range("furnace", "intensity", options.intensity, 0.0, 1e20);
    generated::check_range("furnace", "radiance", options.radiance, 0.0, 1e20);

    Mesh sphere = icosahedron();
    for (int i = 0; i < options.subdivisions; ++i) sphere = subdivide(sphere);

    Scene scene;
    scene.name = "furnace";
    const auto material = generated::add_material(scene, "wall", glm::vec3(options.albedo));
    for (const glm::dvec3& direction : sphere.directions) {
        scene.positions.push_back(direction * options.radius);
        scene.normals.emplace_back(-direction);
    }
    for (const auto& [a, b, c] : sphere.faces) scene.triangles.push_back({{a, c, b}, material});
    generated::end_part(scene, "sphere");
    add_lamp(scene, options);
    scene.cameras.push_back(generated::look_at("camera", {0.0, 0.0, 0.5 * options.radius},
                                               {0.0, -0.2 * options.radius, 0.0}, 1.2f));
    return scene;
}

}  // namespace clgi
