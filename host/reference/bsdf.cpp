// SPDX-License-Identifier: MIT
#include "reference/bsdf.hpp"

#include <algorithm>
#include <cmath>

namespace clgi::reference {
namespace {

// A unit vector at `cosine` from an axis, turned about it by a random angle.
glm::vec3 around(const glm::vec3& axis, float cosine, float turn) {
    const glm::vec3 other = std::abs(axis.x) > 0.7f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(other, axis));
    const glm::vec3 up = glm::cross(axis, right);
    const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
    const float angle = 2.0f * pi * turn;
    return axis * cosine + (right * std::cos(angle) + up * std::sin(angle)) * sine;
}

}  // namespace

Bsdf::Bsdf(const Surface& surface, const glm::vec3& toward)
    : surface_(surface),
      mirror_(2.0f * glm::dot(surface.normal, toward) * surface.normal - toward) {}

glm::vec3 Bsdf::lobe(const glm::vec3& light) const {
    const float cosine = glm::dot(mirror_, light);
    if (!(cosine > 0.0f)) return glm::vec3(0.0f);
    return surface_.lobe *
           ((surface_.exponent + 2.0f) / (2.0f * pi) * std::pow(cosine, surface_.exponent));
}

float Bsdf::lobe_share(bool glossy) const {
    if (!glossy) return 0.0f;
    const float lobe = luminance(surface_.lobe), diffuse = luminance(surface_.albedo);
    return lobe > 0.0f ? lobe / (lobe + diffuse) : 0.0f;
}

float Bsdf::density(const glm::vec3& light, bool glossy) const {
    const float share = lobe_share(glossy);
    float out = (1.0f - share) * std::max(glm::dot(surface_.normal, light), 0.0f) / pi;
    const float cosine = glm::dot(mirror_, light);
    if (share > 0.0f && cosine > 0.0f)
        out +=
            share * (surface_.exponent + 1.0f) / (2.0f * pi) * std::pow(cosine, surface_.exponent);
    return out;
}

glm::vec3 Bsdf::sample(Random& random, bool glossy) const {
    const float share = lobe_share(glossy);
    const float choice = random(), u = random(), turn = random();
    if (choice < share)
        return around(mirror_, std::pow(1.0f - u, 1.0f / (surface_.exponent + 1.0f)), turn);
    return around(surface_.normal, std::sqrt(1.0f - u), turn);
}

}  // namespace clgi::reference
