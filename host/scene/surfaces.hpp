// What the generated scenes are put together from: flat faces, panels, lamps, cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <functional>
#include <string>
#include <vector>

namespace clgi::generated {

// Throws Error "scene: option is got, needs low to high"; NaN is never in range.
void check_range(const char* scene, const char* option, double got, double low, double high);
void check_color(const char* scene, const char* option, const glm::vec3& got, double high);

std::uint32_t add_material(Scene& scene, const std::string& name, const glm::vec3& reflectance);

// Corners counter-clockwise seen from the front, in one plane.
void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, std::uint32_t material);

// A rectangle in the plane where coordinate axis equals offset, cut into a grid at the rising
// coordinates first (along the next axis) and second (along the one after). Neighbours that
// share their cuts share every vertex position exactly, so nothing can leak between them.
// facing is +1 or -1 along axis; cells whose centre is in the opening are left out.
struct Panel {
    int axis = 1;
    double offset = 0.0;
    int facing = 1;
    std::vector<double> first;
    std::vector<double> second;
};
using Opening = std::function<bool(const glm::dvec3& cell_center)>;
void add_panel(Scene& scene, const Panel& panel, std::uint32_t material,
               const Opening& opening = {});

// A solid with six faces outward: origin plus the box spanned by three edges of either handedness.
void add_solid(Scene& scene, const glm::dvec3& origin, const std::array<glm::dvec3, 3>& edges,
               std::uint32_t material);

// Makes a part of all triangles that belong to none yet.
void end_part(Scene& scene, const std::string& name);

// Unit vertex normals: the mean of the adjoining faces weighted by area.
void smooth_normals(Scene& scene);

Light spot(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
           const glm::vec3& intensity, float outer_angle);
Light point(const std::string& name, const glm::dvec3& position, const glm::vec3& intensity);
Camera look_at(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
               float vertical_fov);

}  // namespace clgi::generated
