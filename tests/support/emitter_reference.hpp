// Samples of sources in double precision, after the comment of kernels/lights/sample.clh, and what
// a ray meets first.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/lights.h>
#include <clgi/scene.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "shading.hpp"

namespace clgi::test {

// Phi_b(index) with a shift round the circle.
inline double halton(std::uint32_t index, std::uint32_t base, double shift) {
    double value = 0.0, digit = 1.0;
    for (; index != 0; index /= base) value += (digit /= base) * (index % base);
    value += shift;
    return value < 1.0 ? value : value - 1.0;
}

// Uniform over the sphere by height and longitude.
inline glm::dvec3 on_sphere(double u, double v) {
    const double z = 2.0 * v - 1.0, ring = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * std::numbers::pi * u;
    return {std::sin(phi) * ring, std::cos(phi) * ring, z};
}

struct SampleTruth {
    glm::dvec3 origin, direction;
    glm::dvec3 flux;     // lumen carried, before any fall-off with distance
    double spread;       // steradians of the share, or area across the direction
    double along = 1.0;  // cosine with the source's axis
};

inline SampleTruth sample_truth(const Emitter& e, std::uint32_t index) {
    constexpr double pi = std::numbers::pi;
    const double u = halton(index, 2, double{e.shift.x}), v = halton(index, 3, double{e.shift.y});
    const glm::dvec3 axis(e.axis), right(e.right), up = glm::cross(right, axis);
    const auto around = [&](double turn) {
        return right * std::cos(2 * pi * turn) + up * std::sin(2 * pi * turn);
    };
    const double each = double{e.measure} / e.vpl_count;
    SampleTruth out{glm::dvec3(e.position), axis, glm::dvec3(e.intensity) * each, each};
    switch (e.kind & EMITTER_KIND) {
        case EMITTER_DIRECTIONAL:
            out.origin += around(v) * std::sqrt(u * double{e.measure} / pi);
            out.spread = double{e.area};
            return out;
        case EMITTER_AREA: {
            const double ring2 = halton(index, 5, double{e.shift.z});
            const double height = std::sqrt(1.0 - ring2);
            out.direction =
                around(halton(index, 7, double{e.shift.w})) * std::sqrt(ring2) + axis * height;
            out.flux = glm::dvec3(e.intensity) / double(e.vpl_count);
            out.spread = each / height;
            return out;
        }
        default:
            break;
    }
    out.direction = on_sphere(u, v);
    if (e.kind & EMITTER_MAPPED) {  // uniform in the cap's height
        const double height = 1.0 - double{e.measure} / (2 * pi) * v;
        out.direction = axis * height + around(u) * std::sqrt(1.0 - height * height);
    }
    out.along = glm::dot(out.direction, axis);
    if ((e.kind & EMITTER_KIND) == EMITTER_SPOT)
        out.flux *= spot_share(out.along, double{e.axis.w}, double{e.right.w});
    return out;
}

struct Hit {
    int triangle = -1;
    double distance = std::numeric_limits<double>::infinity();
    glm::dvec3 weights{0};  // barycentric
    bool front = false;
};

// Corners in the local frame.
class RayReference {
public:
    RayReference(const Scene& scene, const SceneFrame& frame) : scene_(scene) {
        for (const glm::dvec3& p : scene.positions)
            corners_.push_back((p - frame.origin) * frame.scale);
    }

    Hit first_hit(const glm::dvec3& origin, const glm::dvec3& direction, double near) const {
        Hit out;
        for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
            const std::uint32_t* vertex = scene_.triangles[i].vertex;
            const glm::dvec3 a = corners_[vertex[0]], ab = corners_[vertex[1]] - a,
                             ac = corners_[vertex[2]] - a, across = glm::cross(ab, ac);
            const double slope = glm::dot(across, direction);
            const double distance = glm::dot(across, a - origin) / slope;
            if (!(distance > near && distance < out.distance)) continue;
            const glm::dvec3 q = origin + distance * direction - a;
            const double area = glm::dot(across, across);
            const double b = glm::dot(glm::cross(q, ac), across) / area;
            const double c = glm::dot(glm::cross(ab, q), across) / area;
            if (b < 0.0 || c < 0.0 || b + c > 1.0) continue;
            out = {static_cast<int>(i), distance, {1.0 - b - c, b, c}, slope < 0.0};
        }
        return out;
    }

private:
    const Scene& scene_;
    std::vector<glm::dvec3> corners_;
};

}  // namespace clgi::test
