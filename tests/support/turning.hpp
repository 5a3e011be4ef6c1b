// A bunny that turns in a box, and its vertices as a caller's kernel would leave them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/procedural.hpp>
#include <clgi/scene_mover.hpp>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "device.hpp"
#include "lab/scenes/rooms.hpp"

namespace clgi::test {

// Vertices of a range that turns inside a scene that stands still.
struct Turning {
    Scene rest;
    std::uint32_t first = 0, count = 0;
    glm::dvec3 centre = glm::dvec3(0.0);

    // The scene with its range turned about the centre and a slanted axis.
    Scene turned(double angle) const {
        const glm::dmat3 turn(
            glm::rotate(glm::dmat4(1.0), angle, glm::normalize(glm::dvec3(0.2, 1.0, -0.3))));
        Scene out = rest;
        for (std::uint32_t v = first; v < first + count; ++v) {
            out.positions[v] = centre + turn * (rest.positions[v] - centre);
            out.normals[v] = glm::vec3(turn * glm::dvec3(rest.normals[v]));
        }
        return out;
    }
};

// The bumpy mesh in its box; it stays inside the box however it turns.
inline Turning bunny(const glm::dvec3& away = glm::dvec3(0.0)) {
    Turning out;
    out.rest = box(BoxOptions{.mesh_height = 0.4});
    for (glm::dvec3& position : out.rest.positions) position += away;
    out.rest.lights[0].position += away;
    out.rest.cameras[0].position += away;
    const Part& mesh = out.rest.parts[1];
    out.first = out.rest.triangles[mesh.first_triangle].vertex[0];
    for (std::uint32_t t = 0; t < mesh.triangle_count; ++t)
        for (const std::uint32_t v : out.rest.triangles[mesh.first_triangle + t].vertex)
            out.first = std::min(out.first, v);
    out.count = static_cast<std::uint32_t>(out.rest.positions.size()) - out.first;
    out.centre = glm::dvec3(0.0, 1.0, 0.0) + away;
    return out;
}

// Positions as a caller's kernel leaves them: floats from an origin of its own. The scene is given
// the same places.
inline MovedVertices buffers_of(Scene& scene, std::uint32_t first, std::uint32_t count,
                                const glm::dvec3& origin = glm::dvec3(0.0)) {
    std::vector<glm::vec4> positions, normals;
    for (std::uint32_t v = first; v < first + count; ++v) {
        const glm::vec3 place(scene.positions[v] - origin);
        for (int axis = 0; axis < 3; ++axis)
            scene.positions[v][axis] =
                origin[axis] == 0.0 ? double{place[axis]} : origin[axis] + double{place[axis]};
        positions.emplace_back(place, 99.0f);
        normals.emplace_back(scene.normals[v], 99.0f);
    }
    return {first, count, upload(positions), upload(normals), origin, {}};
}

// Positions and normals in the order of the file, as bits.
inline std::vector<std::uint32_t> vertex_bits(const DeviceScene& scene) {
    const std::size_t count = scene.info().vertex_count;
    const auto positions = download<glm::uvec4>(scene.positions(), count);
    const auto normals = download<glm::uvec4>(scene.normals(), count);
    std::vector<std::uint32_t> out(8 * scene.file_vertex_count());
    for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(&out[8 * scene.vertex_order()[i]], &positions[i], 16);
        std::memcpy(&out[8 * scene.vertex_order()[i] + 4], &normals[i], 16);
    }
    return out;
}

}  // namespace clgi::test
