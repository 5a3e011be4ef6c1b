// SPDX-License-Identifier: MIT
#include "methods/light_atlas/surroundings.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi {
namespace {

constexpr int directions = 64;    // that tell solid matter from open space
constexpr double solid = 0.5;     // share of what they meet that is backs
constexpr double clear = 0.2;     // of the reach: how far a point moves beyond a surface
constexpr int rays_per_side = 2;  // of a texel

// Even on the sphere: a spiral whose turns are the golden angle apart.
glm::dvec3 spiral(int i) {
    const double z = 1.0 - (2.0 * i + 1.0) / directions, around = std::sqrt(1.0 - z * z);
    const double angle = i * glm::pi<double>() * (3.0 - std::sqrt(5.0));
    return {around * std::cos(angle), around * std::sin(angle), z};
}

// The direction at a place of the map, [-1, 1]^2.
glm::dvec3 unfolded(double u, double v) {
    glm::dvec3 out(u, v, 1.0 - std::abs(u) - std::abs(v));
    if (out.z < 0.0) {
        out.x = std::copysign(1.0 - std::abs(v), u);
        out.y = std::copysign(1.0 - std::abs(u), v);
    }
    return glm::normalize(out);
}

}  // namespace

Surroundings::Surroundings(const Scene& scene) : scene_(scene), walls_(scene) {
    const Bounds all = bounds(scene);
    middle_ = 0.5 * (all.low + all.high);
    radius_ = 0.5 * glm::length(all.high - all.low);
}

Walls::Met Surroundings::ray(const glm::dvec3& point, const glm::dvec3& way) const {
    return walls_.nearest(point, point + way, [&](std::uint32_t triangle) {
        return scene_.materials[scene_.triangles[triangle].material].alpha_mode ==
               AlphaMode::opaque;
    });
}

Surroundings::Backs Surroundings::backs_around(const glm::dvec3& point) const {
    const double far = radius_ + glm::length(point - middle_);  // no surface is farther
    Backs out;
    int surfaces = 0, backs = 0;
    for (int i = 0; i < directions; ++i) {
        const Walls::Met met = ray(point, far * spiral(i));
        if (met.triangle == no_index) continue;
        ++surfaces;
        if (!met.back || scene_.materials[scene_.triangles[met.triangle].material].double_sided)
            continue;
        if (backs++ == 0 || met.share * far < glm::length(out.nearest))
            out.nearest = met.share * far * spiral(i);
    }
    out.solid = backs > 0 && backs >= solid * surfaces;
    return out;
}

bool Surroundings::in_the_open(glm::dvec3& point, double reach) const {
    const Backs inside = backs_around(point);
    if (!inside.solid) return true;
    const double to = glm::length(inside.nearest), way = to + clear * reach;
    if (!(to > 0.0 && way <= reach)) return false;
    const glm::dvec3 out = point + way / to * inside.nearest;
    if (backs_around(out).solid) return false;
    point = out;
    return true;
}

void Surroundings::distances(const glm::dvec3& point, double unit, glm::vec2* out) const {
    constexpr int across = VOLUME_SIDE * rays_per_side;
    const double range = double{VOLUME_RANGE} * unit;
    const auto texel = [&](int u, int v) -> glm::vec2& {
        return out[(v + 1) * VOLUME_ROW + u + 1];
    };
    for (int v = 0; v < VOLUME_SIDE; ++v)
        for (int u = 0; u < VOLUME_SIDE; ++u) {
            glm::dvec2 sum(0.0);
            for (int k = 0; k < rays_per_side * rays_per_side; ++k) {
                const int x = rays_per_side * u + k % rays_per_side;
                const int y = rays_per_side * v + k / rays_per_side;
                const glm::dvec3 to =
                    unfolded((2.0 * x + 1.0) / across - 1.0, (2.0 * y + 1.0) / across - 1.0);
                const double r = double{VOLUME_RANGE} * ray(point, range * to).share;
                sum += glm::dvec2(r, r * r);
            }
            texel(u, v) = sum / double{rays_per_side * rays_per_side};
        }
    // Over the half of a side the map goes on where the other half is.
    constexpr int last = VOLUME_SIDE - 1;
    for (int i = 0; i < VOLUME_SIDE; ++i) {
        texel(i, -1) = texel(last - i, 0);
        texel(i, VOLUME_SIDE) = texel(last - i, last);
        texel(-1, i) = texel(0, last - i);
        texel(VOLUME_SIDE, i) = texel(last, last - i);
    }
    texel(-1, -1) = texel(last, last);
    texel(VOLUME_SIDE, VOLUME_SIDE) = texel(0, 0);
    texel(-1, VOLUME_SIDE) = texel(last, 0);
    texel(VOLUME_SIDE, -1) = texel(0, last);
}

}  // namespace clgi
