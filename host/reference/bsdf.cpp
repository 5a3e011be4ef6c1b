// SPDX-License-Identifier: MIT
#include "reference/bsdf.hpp"

#include <algorithm>
#include <cmath>

namespace clgi::reference {
namespace {

constexpr double least_cosine = 1e-6;

// x, y: unit, at right angles to an axis and to each other.
void frame(const glm::dvec3& axis, glm::dvec3& x, glm::dvec3& y) {
    const glm::dvec3 other = std::abs(axis.x) > 0.7 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    x = glm::normalize(glm::cross(other, axis));
    y = glm::cross(axis, x);
}

// A unit vector at `cosine` from an axis, turned about it by a random angle.
glm::dvec3 around(const glm::dvec3& axis, double cosine, double turn) {
    glm::dvec3 right, up;
    frame(axis, right, up);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double angle = 2.0 * double{pi} * turn;
    return axis * cosine + (right * std::cos(angle) + up * std::sin(angle)) * sine;
}

double fifth(double x) { return x * x * x * x * x; }

// Share of microfacets that are seen at a cosine. [Walter07, equation 34]
double seen(double cosine, double alpha) {
    const double square = alpha * alpha;
    return 2.0 * cosine / (cosine + std::sqrt(square + (1.0 - square) * cosine * cosine));
}

// Density of microfacets' normals by projected area. [Walter07, equation 33]
double normals(const glm::dvec3& normal, const glm::dvec3& half, double alpha) {
    const double along = glm::dot(normal, half), square = alpha * alpha;
    if (!(along > 0.0)) return 0.0;
    const glm::dvec3 across = glm::cross(normal, half);
    const double spread = square * along * along + glm::dot(across, across);
    return square / (double{pi} * spread * spread);
}

double luminance_of(const glm::dvec3& color) { return double{luminance(glm::vec3(color))}; }

}  // namespace

Bsdf::Bsdf(const Surface& surface, const glm::vec3& toward)
    : surface_(surface),
      normal_(glm::normalize(glm::dvec3(surface.normal))),
      toward_(glm::normalize(glm::dvec3(toward))),
      cosine_(std::max(glm::dot(normal_, toward_), least_cosine)),
      has_lobe_(surface.metallic > 0.0 || surface.f90 > 0.0) {}

glm::vec3 Bsdf::reflected(const glm::vec3& to_light) const {
    if (!has_lobe_) return surface_.base / pi;
    const glm::dvec3 light = glm::normalize(glm::dvec3(to_light)), base(surface_.base);
    const glm::dvec3 sum = toward_ + light;
    const double length = glm::length(sum);
    const glm::dvec3 half = length > 0.0 ? sum / length : normal_;
    const double cosine = std::max(glm::dot(normal_, light), least_cosine);
    const double alpha = surface_.alpha, metal = surface_.metallic;
    const double lobe = normals(normal_, half, alpha) * seen(cosine_, alpha) * seen(cosine, alpha) /
                        (4.0 * cosine_ * cosine);
    const double grazing = fifth(std::max(1.0 - glm::dot(toward_, half), 0.0));
    const double f = surface_.f0 + (surface_.f90 - surface_.f0) * grazing;
    const glm::dvec3 other = base * ((1.0 - f) / double{pi}) + f * lobe;
    const glm::dvec3 of_metal = (base + (1.0 - base) * grazing) * lobe;
    return glm::vec3((1.0 - metal) * other + metal * of_metal);
}

// By what either reflects towards this viewer.
double Bsdf::lobe_share(bool glossy) const {
    if (!glossy || !has_lobe_) return 0.0;
    const double grazing = fifth(1.0 - std::min(cosine_, 1.0)), metal = surface_.metallic;
    const glm::dvec3 base(surface_.base);
    const double f = surface_.f0 + (surface_.f90 - surface_.f0) * grazing;
    const double lobe = luminance_of((1.0 - metal) * f + metal * (base + (1.0 - base) * grazing));
    const double diffuse = luminance_of((1.0 - metal) * (1.0 - f) * base);
    if (!(lobe > 0.0)) return 0.0;
    // At grazing angles F of the half vector is far from F of the viewer: neither is drawn rarely.
    return diffuse > 0.0 ? std::clamp(lobe / (lobe + diffuse), 0.1, 0.75) : 1.0;
}

float Bsdf::density(const glm::vec3& to_light, bool glossy) const {
    const glm::dvec3 light = glm::normalize(glm::dvec3(to_light));
    const double share = lobe_share(glossy);
    double out = (1.0 - share) * std::max(glm::dot(normal_, light), 0.0) / double{pi};
    if (share == 0.0) return static_cast<float>(out);
    const glm::dvec3 sum = toward_ + light;
    const double length = glm::length(sum);
    if (length > 0.0)
        out += share * seen(cosine_, surface_.alpha) *
               normals(normal_, sum / length, surface_.alpha) / (4.0 * cosine_);
    return static_cast<float>(out);
}

// A normal of the microfacets that the viewer sees. [Heitz18, listing 1]
glm::dvec3 Bsdf::microfacet(double u, double turn) const {
    glm::dvec3 x, y;
    frame(normal_, x, y);
    const double alpha = surface_.alpha;
    const glm::dvec3 stretched = glm::normalize(
        glm::dvec3(alpha * glm::dot(toward_, x), alpha * glm::dot(toward_, y), cosine_));
    // At right angles to the normal: half of the disc is seen whole.
    const glm::dvec3 across(-stretched.y, stretched.x, 0.0);
    const double length = glm::length(across);
    const glm::dvec3 side = length > 0.0 ? across / length : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 up = glm::cross(stretched, side);
    const double radius = std::sqrt(u), angle = 2.0 * double{pi} * turn;
    const double a = radius * std::cos(angle), lean = 0.5 * (1.0 + stretched.z);
    const double b =
        (1.0 - lean) * std::sqrt(std::max(1.0 - a * a, 0.0)) + lean * radius * std::sin(angle);
    const glm::dvec3 at =
        a * side + b * up + std::sqrt(std::max(1.0 - a * a - b * b, 0.0)) * stretched;
    const glm::dvec3 half =
        glm::normalize(glm::dvec3(alpha * at.x, alpha * at.y, std::max(at.z, 0.0)));
    return half.x * x + half.y * y + half.z * normal_;
}

glm::vec3 Bsdf::sample(Random& random, bool glossy) const {
    const double share = lobe_share(glossy);
    const double choice = double{random()}, u = double{random()}, turn = double{random()};
    if (!(choice < share)) return glm::vec3(around(normal_, std::sqrt(1.0 - u), turn));
    const glm::dvec3 half = microfacet(u, turn);
    return glm::vec3(2.0 * glm::dot(toward_, half) * half - toward_);
}

}  // namespace clgi::reference
