// A room with things that move, to be lit while they do.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/moving_elements.hpp>
#include <clgi/scene_mover.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "rooms.hpp"

namespace clgi::test {

struct MovingRoom {
    Scene scene;
    std::uint32_t first = 0;  // vertex of what moves; all that come after it do

    // A closed room with boxes, a box that flies through it and turns, and a cloth of 4 x 4 squares
    // whose middle swings. At 0.5 the box passes through one that stands.
    explicit MovingRoom(std::uint64_t seed = 5) : scene(furnished_room(seed)) {
        first = static_cast<std::uint32_t>(scene.positions.size());
        Material red;
        red.base_color = {0.8f, 0.2f, 0.1f, 1.0f};
        const std::uint32_t material = add_material(scene, red);
        add_box(scene, {0.3, 1.5, 0.3}, {0.9, 1.9, 0.8}, 1, material);
        box_end_ = static_cast<std::uint32_t>(scene.positions.size());
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const glm::dvec3 at(2.6 + 0.2 * x, 1.9, 0.6 + 0.2 * y);
                add_quad(scene,
                         {at, at + glm::dvec3(0, 0, 0.2), at + glm::dvec3(0.2, 0, 0.2),
                          at + glm::dvec3(0.2, 0, 0)},
                         material);
            }
        rest_ = scene.positions;
        scene = posed(0.0);
    }

    // [vertices] at a time from 0 to 1.
    std::vector<glm::dvec3> at(double time) const {
        std::vector<glm::dvec3> out = rest_;
        const glm::dvec3 middle(0.6, 1.7, 0.55);
        const glm::dmat4 turn =
            glm::rotate(glm::dmat4(1.0), 1.2 * time, glm::normalize(glm::dvec3(1, 2, 0.5)));
        for (std::uint32_t v = first; v < out.size(); ++v) {
            glm::dvec3& p = out[v];
            if (v < box_end_) {
                p = middle + glm::dvec3(turn * glm::dvec4(p - middle, 0.0)) +
                    time * glm::dvec3(2.2, -0.9, 1.3);
            } else {
                const double x = p.x - 2.6, z = p.z - 0.6;
                p.y += 2.0 * std::sin(7.0 * time) * x * (0.8 - x) * z * (0.8 - z) / 0.16;
            }
        }
        return out;
    }
    VertexPoses poses(int count) const {
        VertexPoses out;
        for (int k = 0; k < count; ++k) out.push_back(at(k / double(count - 1)));
        return out;
    }
    Scene posed(double time) const {
        Scene out = scene;
        out.positions = at(time);
        for (const SceneTriangle& triangle : out.triangles) {
            if (triangle.vertex[0] < first) continue;
            const glm::dvec3& a = out.positions[triangle.vertex[0]];
            const glm::vec3 normal(glm::normalize(glm::cross(
                out.positions[triangle.vertex[1]] - a, out.positions[triangle.vertex[2]] - a)));
            for (const std::uint32_t vertex : triangle.vertex) out.normals[vertex] = normal;
        }
        return out;
    }
    // Brings the scene on the device there.
    cl::Event move(SceneMover& mover, double time) const {
        const Scene to = posed(time);
        return mover.move(first, {to.positions.begin() + first, to.positions.end()},
                          {to.normals.begin() + first, to.normals.end()});
    }

private:
    std::uint32_t box_end_ = 0;
    std::vector<glm::dvec3> rest_;
};

}  // namespace clgi::test
