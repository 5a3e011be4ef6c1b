// SPDX-License-Identifier: MIT
#include "reference/camera_rays.hpp"

#include <cmath>

namespace clgi::reference {

CameraRays::CameraRays(const Camera& camera, const Geometry& geometry, int width, int height)
    : camera_(camera),
      eye_(geometry.to_local(camera.position)),
      near_(static_cast<float>(double{camera.near} * geometry.scale)),
      width_(static_cast<float>(width)),
      height_(static_cast<float>(height)) {
    // Not given: a thousandth of the scene's radius, which is 1 here.
    if (camera.kind == Camera::Kind::perspective && !(near_ > 0.0f)) near_ = 1e-3f;
    half_height_ = camera.kind == Camera::Kind::perspective
                       ? std::tan(0.5f * camera.vertical_fov)
                       : static_cast<float>(double{camera.half_height} * geometry.scale);
    half_width_ = half_height_ * width_ / height_;
}

Ray CameraRays::through(float x, float y) const {
    const glm::vec3 aside = camera_.right * ((2.0f * x / width_ - 1.0f) * half_width_) +
                            camera_.up * ((1.0f - 2.0f * y / height_) * half_height_);
    Ray ray;
    ray.nearest = near_;
    if (camera_.kind == Camera::Kind::perspective) {
        ray.origin = eye_;
        ray.direction = camera_.forward + aside;
    } else {
        ray.origin = eye_ + aside;
        ray.direction = camera_.forward;
    }
    return ray;
}

Hit on_plane(const Geometry& geometry, std::uint32_t index, const Ray& ray) {
    const SceneTriangle& triangle = geometry.triangles[index];
    const glm::vec3 corner = geometry.positions[triangle.vertex[0]];
    const glm::vec3 e1 = geometry.positions[triangle.vertex[1]] - corner;
    const glm::vec3 e2 = geometry.positions[triangle.vertex[2]] - corner;
    const glm::vec3 normal = glm::cross(e1, e2);
    const float determinant = -glm::dot(ray.direction, normal);
    if (!(std::abs(determinant) > 1e-30f)) return {index, 0.0f, 0.0f};
    const glm::vec3 moment = glm::cross(ray.origin - corner, ray.direction);
    return {index, glm::dot(e2, moment) / determinant, -glm::dot(e1, moment) / determinant};
}

}  // namespace clgi::reference
