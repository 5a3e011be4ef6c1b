// A mesh floating in a closed coloured box lit by one lamp: the test scene of [Cochran07], whose
// walls are two triangles each and whose mesh is the Stanford bunny.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <glm/common.hpp>

#include "lab/scenes/rooms.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace {

void check(const BoxOptions& options) {
    if (options.light == LightSource::area) throw Error("box: lamp is area, needs spot or point");
    for (int axis = 0; axis < 3; ++axis) {
        generated::check_range("box", "size", options.size[axis], 1e-6, 1e9);
    }
    generated::check_range("box", "mesh_height", options.mesh_height, 1e-3, 0.9);
    generated::check_range("box", "cone_angle", options.cone_angle, 1e-3, 1.57);
    generated::check_color("box", "left", options.left, 1.0);
    generated::check_color("box", "right", options.right, 1.0);
    generated::check_color("box", "walls", options.walls, 1.0);
    generated::check_color("box", "mesh", options.mesh, 1.0);
    generated::check_color("box", "intensity", options.intensity, 1e20);
}

// Floor at y = 0, the other sides symmetric about the origin; all faces look inward.
void add_room(Scene& scene, const BoxOptions& options) {
    const auto plain = generated::add_material(scene, "walls", options.walls);
    const auto left = generated::add_material(scene, "left", options.left);
    const auto right = generated::add_material(scene, "right", options.right);
    const std::vector<double> x = {-0.5 * options.size.x, 0.5 * options.size.x};
    const std::vector<double> y = {0.0, options.size.y};
    const std::vector<double> z = {-0.5 * options.size.z, 0.5 * options.size.z};
    generated::add_panel(scene, {0, x[0], +1, y, z}, left);
    generated::add_panel(scene, {0, x[1], -1, y, z}, right);
    generated::add_panel(scene, {1, y[0], +1, z, x}, plain);
    generated::add_panel(scene, {1, y[1], -1, z, x}, plain);
    generated::add_panel(scene, {2, z[0], +1, x, y}, plain);
    generated::add_panel(scene, {2, z[1], -1, x, y}, plain);
    generated::end_part(scene, "room");
}

// Scaled to the wanted height, or less where that would come too near to a wall.
double fitting_scale(const glm::dvec3& extent, const BoxOptions& options) {
    const glm::dvec3 allowed =
        options.size * glm::dvec3(0.75, options.mesh_height, options.mesh_height);
    double scale = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(extent[axis] > 0.0)) continue;
        const double here = allowed[axis] / extent[axis];
        scale = scale > 0.0 ? glm::min(scale, here) : here;
    }
    return scale;
}

void add_mesh(Scene& scene, const Scene& mesh, const BoxOptions& options) {
    const Bounds around = bounds(mesh);
    const double scale = fitting_scale(around.high - around.low, options);
    if (!(scale > 0.0)) throw InputError("box: the mesh has no extent");
    const glm::dvec3 from = 0.5 * (around.low + around.high);
    const glm::dvec3 to(0.0, 0.5 * options.size.y, 0.0);

    const auto material = generated::add_material(scene, "mesh", options.mesh);
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::dvec3& position : mesh.positions) {
        scene.positions.push_back((position - from) * scale + to);
    }
    scene.normals.insert(scene.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const SceneTriangle& triangle : mesh.triangles) {
        const auto& [a, b, c] = triangle.vertex;
        scene.triangles.push_back({{base + a, base + b, base + c}, material});
    }
    generated::end_part(scene, "mesh");
}

}  // namespace

Scene box(const Scene& mesh, const BoxOptions& options) {
    check(options);
    validate(mesh);
    if (mesh.triangles.empty()) throw InputError("box: the mesh has no triangles");

    Scene scene;
    scene.name = "box";
    add_room(scene, options);
    add_mesh(scene, mesh, options);

    // From the upper right front over the mesh to the left wall: the mesh throws its shadow on
    // what is behind it and takes the red of the wall beside it.
    const glm::dvec3 half = 0.5 * options.size;
    const glm::dvec3 lamp(0.45 * half.x, 0.94 * options.size.y, 0.62 * half.z);
    const glm::dvec3 aim(-0.22 * half.x, 0.44 * options.size.y, -0.05 * half.z);
    const auto share = static_cast<float>(options.size.y * options.size.y / 4.0);
    if (options.light == LightSource::spot) {
        scene.lights.push_back(
            generated::spot("spot", lamp, aim, options.intensity * share, options.cone_angle));
    } else {
        scene.lights.push_back(generated::point("point", lamp, options.intensity * share));
    }
    scene.cameras.push_back(
        generated::look_at("camera", {0.0, half.y, 0.96 * half.z}, {0.0, half.y, 0.0}, 0.9f));
    return scene;
}

Scene box(const BoxOptions& options) { return box(bumpy_mesh(), options); }

}  // namespace clgi
