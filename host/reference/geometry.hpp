// The scene as rays meet it: a copy in floats around its centre, scaled to unit radius.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/luminance.hpp"

namespace clgi::reference {

constexpr float pi = 3.14159265358979f;

// By how much of its largest coordinate a point that is computed on a triangle may be off, with a
// margin.
constexpr float rounding = 64.0f * 0x1p-24f;

struct Geometry {
    explicit Geometry(const Scene& scene);

    glm::vec3 to_local(const glm::dvec3& world) const {
        return glm::vec3((world - origin) * scale);
    }

    glm::dvec3 origin;
    double scale;  // local units per metre
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> uvs;     // may be empty
    std::vector<glm::vec4> colors;  // may be empty
    std::vector<SceneTriangle> triangles;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    bool blended = false;  // some triangle's material is
};

// A point of a triangle: corner weights 1 - b1 - b2, b1, b2.
struct Hit {
    std::uint32_t triangle = 0;
    float b1 = 0.0f;
    float b2 = 0.0f;
};

using clgi::luminance;

}  // namespace clgi::reference
