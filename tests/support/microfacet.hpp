// The reflectance of glTF 2.0 as its appendix B writes it, in double precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace clgi::test {

inline Material finished(float metallic, float roughness, float specular = 0.0f) {
    Material out;
    out.metallic = metallic;
    out.roughness = roughness;
    out.specular = specular;
    return out;
}

// What a normalised modified Phong lobe reflects of even light in the mean: kernels/lobe_mean.clh.
inline float lobe_mean(float exponent) { return 2.0f / 3.0f + 1.0f / (7.8f * exponent + 6.0f); }

struct GltfReflected {
    glm::dvec3 diffuse, gloss;  // radiance for unit irradiance; per steradian
    double steep;               // relative error of the gloss for one of a cosine, about
};

// normal, viewer, light: unit. colour: with textures.
inline GltfReflected gltf_reflected(const Material& material, const glm::dvec3& colour,
                                    const glm::dvec3& normal, const glm::dvec3& viewer,
                                    const glm::dvec3& light) {
    constexpr double pi = std::numbers::pi;
    const double roughness{material.roughness}, metallic{material.metallic};
    const double alpha = std::max(roughness * roughness, 0.01), square = alpha * alpha;
    const double nl = std::max(glm::dot(normal, light), 0.0),
                 nv = std::abs(glm::dot(normal, viewer));
    const glm::dvec3 half = glm::normalize(viewer + light);
    const double nh = glm::dot(normal, half), vh = glm::dot(viewer, half);
    const double d = square / (pi * std::pow(nh * nh * (square - 1.0) + 1.0, 2));
    const auto shadowing = [&](double cosine) {
        return 1.0 / (cosine + std::sqrt(square + (1.0 - square) * cosine * cosine));
    };
    const double specular = nh > 0.0 ? d * shadowing(nl) * shadowing(nv) : 0.0;
    const double index{material.ior}, weight{material.specular};
    const double f0 = weight * std::pow((1.0 - index) / (1.0 + index), 2);
    const double grazing = std::pow(1.0 - std::abs(vh), 5);
    const double fresnel = f0 + (weight - f0) * grazing;
    const glm::dvec3 metal = specular * (colour + (1.0 - colour) * grazing);
    GltfReflected out;
    out.diffuse = (1.0 - metallic) * (1.0 - fresnel) / pi * colour;
    out.gloss = metallic * metal + (1.0 - metallic) * fresnel * specular;
    const double across = glm::length(glm::cross(normal, half));
    out.steep = 1.0 + 4.0 * across / (square * nh * nh + across * across) + 1.0 / (alpha + nl) +
                1.0 / (alpha + nv);
    return out;
}

}  // namespace clgi::test
