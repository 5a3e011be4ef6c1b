// Rays against triangles, through Embree 3 or 4.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "reference/geometry.hpp"

namespace clgi::reference {

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;  // of any length
    float nearest = 0.0f;
    float farthest = std::numeric_limits<float>::infinity();  // in lengths of direction
    std::uint64_t chance = 0;  // rays with other bits pass other blended surfaces
};

class Tracer {
public:
    explicit Tracer(const Geometry& geometry);
    ~Tracer();

    // The first surface on the ray. for_camera: one-sided surfaces are not there from behind.
    std::optional<Hit> first(const Ray& ray, bool for_camera = false) const;

    // Every surface on the ray, in no order.
    void all(const Ray& ray, std::vector<Hit>& hits) const;

    // Whether anything lies between two points, or on a ray.
    bool blocked(const glm::vec3& from, const glm::vec3& to, std::uint64_t chance) const;
    bool blocked(const Ray& ray) const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

// Where a ray from a vertex begins, in lengths of a unit direction: behind the triangles that touch
// the vertex, in a scene of radius 1, whatever the rounding of distances.
constexpr float at_surface = rounding;

}  // namespace clgi::reference
