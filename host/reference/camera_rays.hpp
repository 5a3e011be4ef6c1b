// Rays of a camera, in the local units of a Geometry.
// SPDX-License-Identifier: MIT
#pragma once

#include "reference/tracer.hpp"

namespace clgi::reference {

class CameraRays {
public:
    CameraRays(const Camera& camera, const Geometry& geometry, int width, int height);

    // x, y: in pixels, (0.5, 0.5) the centre of the first. The direction is not of unit length:
    // its part along the view's axis is 1.
    Ray through(float x, float y) const;

private:
    Camera camera_;
    glm::vec3 eye_;
    float near_;
    float half_width_, half_height_;  // tangents, or local lengths when orthographic
    float width_, height_;
};

// Where a ray meets the plane of a triangle, inside it or not: what lies beside a pixel's centre on
// the same surface. The triangle's first corner where it meets none.
Hit on_plane(const Geometry& geometry, std::uint32_t triangle, const Ray& ray);

}  // namespace clgi::reference
