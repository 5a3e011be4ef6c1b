// SPDX-License-Identifier: MIT
#include "reference/sampled_light.hpp"

#include <algorithm>

namespace clgi::reference {
namespace {

bool inside(const Hit& hit) { return hit.b1 >= 0.0f && hit.b2 >= 0.0f && hit.b1 + hit.b2 <= 1.0f; }

}  // namespace

// Where textures are read for a sample of a pixel whose centre meets `seen`: anywhere in the pixel,
// on the same triangle or on what else the pixel shows of its material. A small triangle's plane
// would go on into parts of the texture that belong to something else.
Hit PixelLight::texture_place(float x, float y, const Hit& seen, Random& random) const {
    constexpr int tries = 4;
    const std::uint32_t material = geometry_.triangles[seen.triangle].material;
    for (int k = 0; k < tries; ++k) {
        const float right = random(), down = random();
        Ray ray = rays_.through(x + right, y + down);
        ray.chance = chance(geometry_, random);
        const Hit beside = on_plane(geometry_, seen.triangle, ray);
        if (inside(beside)) return beside;
        const std::optional<Hit> other = tracer_.first(ray, true);
        if (other && geometry_.triangles[other->triangle].material == material) return *other;
    }
    return seen;
}

glm::vec3 PixelLight::operator()(std::size_t pixel, Random& random, std::vector<Met>* met) const {
    const auto x = static_cast<float>(pixel % width_);
    const auto y = static_cast<float>(pixel / width_);
    const bool whole = filter_ == Filter::box;
    const float right = whole ? random() : 0.5f, down = whole ? random() : 0.5f;
    Ray ray = rays_.through(x + right, y + down);
    ray.chance = chance(geometry_, random);
    const std::optional<Hit> hit = tracer_.first(ray, true);
    const glm::vec3 direction = glm::normalize(ray.direction);
    if (!hit) return paths_.background(direction);
    const Hit place = whole ? *hit : texture_place(x, y, *hit, random);
    return paths_.sample(surface_at(geometry_, *hit, direction, place), direction, random, met);
}

glm::vec3 light_at(const Place& place, const Geometry& geometry, const Paths& paths, Random& random,
                   std::vector<Met>* met) {
    // Reflects all, evenly, pi times over: radiance is irradiance.
    Surface surface{};
    surface.position = geometry.to_local(place.position);
    // The triangle is not known: as the largest of the scene.
    const glm::vec3 size = glm::abs(surface.position);
    surface.lift = rounding * std::max({size.x, size.y, size.z, 1.0f});
    surface.normal = place.normal;
    surface.geometric = place.geometric == glm::vec3(0.0f) ? place.normal : place.geometric;
    surface.albedo = surface.base = glm::vec3(pi);
    surface.alpha = 1.0;
    surface.reflects = true;
    return paths.sample(surface, -surface.normal, random, met);
}

}  // namespace clgi::reference
