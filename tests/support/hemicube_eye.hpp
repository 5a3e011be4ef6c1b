// A VPL's eye with its hemicube, and what it says is seen: a texel that atlas.gather fills.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi::test {

// A VPL with its five faces.
struct Eye {
    Eye(const DeviceScene& scene, const glm::vec3& position, const glm::vec3& normal,
        std::uint32_t size = 128)
        : site({{position, normal, 1e-9f, glm::vec3(1.0f), {{position, normal, normal}}}}),
          cubes(hemicubes(site, &scene, {0, 1, size})) {
        for (const View& view : download<View>(cubes.views, 5)) faces.push_back(view);
        at = glm::dvec3(position);
        a = glm::dvec3(glm::vec3(faces[0].right));
        b = glm::dvec3(glm::vec3(faces[0].up));
        c = glm::dvec3(glm::vec3(faces[0].forward));
    }
    // Whether each point is seen. Normals are the geometric ones.
    std::vector<bool> sees(const std::vector<SurfacePlace>& points,
                           const AtlasPasses& passes = atlas_passes()) const {
        const auto count = static_cast<std::uint32_t>(points.size());
        const std::uint32_t stride = padded(count);
        const cl::Buffer seen = upload(std::vector<cl_uchar>(stride));
        see(cubes, count, upload_points(points, stride, GBUFFER_GEOMETRIC + 3), seen, 0, passes);
        std::vector<bool> out;
        for (const cl_uchar byte : download<cl_uchar>(seen, count)) {
            EXPECT_LE(byte, 1);  // one VPL, one bit
            out.push_back(byte == 1);
        }
        return out;
    }
    glm::dvec3 along(double x, double y, double z) const {
        return glm::normalize(x * a + y * b + z * c);
    }
    Sites site;
    Hemicubes cubes;
    std::vector<View> faces;
    glm::dvec3 at, a, b, c;
};

// A square of side 2 * half about a point.
inline void add_square(Scene& world, const glm::dvec3& center, const glm::dvec3& normal,
                       double half) {
    const glm::dvec3 helper = std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = half * glm::normalize(glm::cross(helper, normal));
    const glm::dvec3 v = glm::cross(normal, u);
    add_quad(world, {center - u - v, center + u - v, center + u + v, center - u + v});
}

// Something far behind every plane that faces this way, so that a scene's size is about 1.
inline Scene islands(const glm::dvec3& facing) {
    Scene world = plain_scene();
    const glm::dvec3 at = -1.2 * facing;
    for (const double s : {-0.3, 0.3})
        add_triangle(world, at + glm::dvec3(s), at + glm::dvec3(s, s, 0.99 * s),
                     at + glm::dvec3(s, 0.99 * s, s));
    return world;
}

inline SurfacePlace place(const DeviceScene& scene, const glm::dvec3& world,
                          const glm::dvec3& normal) {
    return {scene.frame().to_local(world), glm::vec3(normal), glm::vec3(normal)};
}

}  // namespace clgi::test
