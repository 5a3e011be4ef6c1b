// SPDX-License-Identifier: MIT
#include "reference/path.hpp"

#include <algorithm>

namespace clgi::reference {
namespace {

// Up to so many lamps are all asked; of more, one at random.
constexpr std::size_t few_lamps = 8;

float greatest(const glm::vec3& c) { return std::max(c.x, std::max(c.y, c.z)); }

// Share of the first of two ways to draw a direction. [Veach95, the power heuristic]
float power_heuristic(float density, float other) {
    const float ratio = other / density;  // squares could overflow
    return 1.0f / (1.0f + ratio * ratio);
}

// Share of a direction that was drawn in `way`, where the other way could have given it too.
float share_of(Sampling way, Sampling ways, float density, float other) {
    if (ways == Sampling::both) return power_heuristic(density, other);
    return way == ways ? 1.0f : 0.0f;
}

bool above(const Surface& surface, const glm::vec3& direction) {
    return glm::dot(surface.normal, direction) > 0.0f &&
           glm::dot(surface.geometric, direction) > 0.0f;
}

glm::vec3 reflected(const Bsdf& bsdf, bool glossy, const glm::vec3& light) {
    return glossy ? bsdf.reflected(light) : bsdf.diffuse();
}

// A direction that a path took.
struct Step {
    glm::vec3 place, direction;
    float weight;  // luminance of the path for unit radiance from there, times the density
    float before;  // luminance of the path until then
};

void learn(const std::vector<Step>& steps, const glm::vec3& sum, std::vector<Met>& met) {
    for (const Step& step : steps)
        if (step.weight > 0.0f)
            met.push_back(
                {step.place, step.direction, (luminance(sum) - step.before) / step.weight});
}

}  // namespace

glm::vec3 Paths::Scatter::sample(Random& random) const {
    if (learnt && random() < 0.5f) return learnt->sample(random);
    return bsdf.sample(random, glossy);
}

float Paths::Scatter::density(const glm::vec3& direction) const {
    const float own = bsdf.density(direction, glossy);
    return learnt ? 0.5f * (own + learnt->density(direction)) : own;
}

bool Paths::counts(int bounces) const {
    if (bounces == 0) return effects_.direct;
    return bounces >= effects_.first_bounce && bounces <= effects_.last_bounce;
}

bool Paths::glossy(int bounces) const {
    return bounces == 0 ? effects_.direct_gloss : effects_.indirect_gloss;
}

// What a surface reflects of light that nothing may stand in the way of.
glm::vec3 Paths::sent_on(const std::optional<Arrival>& light, float share, const Surface& surface,
                         const Bsdf& bsdf, bool glossy, Random& random) const {
    if (!light || !above(surface, light->direction)) return glm::vec3(0.0f);
    if (tracer_.blocked(off_surface(surface), light->from, chance(geometry_, random)))
        return glm::vec3(0.0f);
    return share * reflected(bsdf, glossy, light->direction) * light->irradiance *
           glm::dot(surface.normal, light->direction);
}

std::optional<Arrival> Paths::from_sky(const glm::vec3& point, Random& random) const {
    Arrival out;
    out.direction = sky_.sample(random);
    out.from = beyond(point, out.direction);
    out.density = sky_.density(out.direction);
    if (!(out.density > 0.0f)) return std::nullopt;
    out.irradiance = sky_.radiance(out.direction) / out.density;
    return out;
}

// Direct light. also: directions are drawn by it as well, which meet emissive surfaces and sky.
glm::vec3 Paths::lit(const Surface& surface, const Bsdf& bsdf, bool glossy, const Scatter* also,
                     Random& random) const {
    glm::vec3 sum(0.0f);
    const std::size_t lamps = lights_.lamp_count();
    if (lamps <= few_lamps) {
        for (std::size_t lamp = 0; lamp < lamps; ++lamp)
            sum += sent_on(lights_.from_lamp(lamp, surface.position), 1.0f, surface, bsdf, glossy,
                           random);
    } else {
        const auto lamp =
            std::min(static_cast<std::size_t>(random() * static_cast<float>(lamps)), lamps - 1);
        sum += sent_on(lights_.from_lamp(lamp, surface.position), static_cast<float>(lamps),
                       surface, bsdf, glossy, random);
    }
    const auto add = [&](Sampling ways, const std::optional<Arrival>& light) {
        if (!light) return;
        const float share =
            also ? share_of(Sampling::lights, ways, light->density, also->density(light->direction))
                 : 1.0f;
        sum += sent_on(light, share, surface, bsdf, glossy, random);
    };
    const auto drawn = [&](Sampling ways) { return !also || ways != Sampling::lobes; };
    if (lights_.has_surfaces() && drawn(sampling_))
        add(sampling_, lights_.from_surface(surface.position, random));
    if (sky_.shines() && drawn(sky_sampling_))
        add(sky_sampling_, from_sky(surface.position, random));
    return sum;
}

// Reflections 0 to last, shadowed.
glm::vec3 Paths::walk(Surface surface, glm::vec3 direction, int last, Random& random,
                      std::vector<Met>* met) const {
    glm::vec3 sum(0.0f);
    glm::vec3 weight(1.0f);
    float kept = 1.0f;  // weight, about, of paths that roulette leaves
    thread_local std::vector<Step> steps;
    steps.clear();
    const bool lobe_drawn = effects_.direct_gloss || effects_.indirect_gloss;
    for (int k = 0; k <= last && surface.reflects; ++k) {
        const Bsdf bsdf(surface, -direction);
        const Scatter scatter{bsdf, lobe_drawn, guide_ ? guide_->at(surface.position) : nullptr};
        const bool counted = counts(k);
        if (counted) sum += weight * lit(surface, bsdf, glossy(k), &scatter, random);
        if (k == last && !(counted && (lights_.has_surfaces() || sky_.shines()))) break;

        const glm::vec3 onward = scatter.sample(random);
        const float density = scatter.density(onward);
        if (!above(surface, onward) || !(density > 0.0f)) break;
        const float cosine = glm::dot(surface.normal, onward);
        if (met)
            steps.push_back(
                {surface.position, onward,
                 luminance(weight * reflected(bsdf, effects_.indirect_gloss, onward)) * cosine,
                 luminance(sum)});
        Ray ray{off_surface(surface), onward};
        ray.chance = chance(geometry_, random);
        const std::optional<Hit> hit = tracer_.first(ray);
        if (!hit) {
            if (counted && sky_.shines())
                sum += weight * reflected(bsdf, glossy(k), onward) * sky_.radiance(onward) *
                       (cosine / density *
                        share_of(Sampling::lobes, sky_sampling_, density, sky_.density(onward)));
            break;
        }
        Surface next = surface_at(geometry_, *hit, onward);
        if (counted && greatest(next.emission) > 0.0f) {
            const float other = lights_.density(*hit, surface.position);
            sum += weight * reflected(bsdf, glossy(k), onward) * next.emission *
                   (cosine / density * share_of(Sampling::lobes, sampling_, density, other));
        }
        weight *= reflected(bsdf, effects_.indirect_gloss, onward) * (cosine / density);
        if (k >= roulette_depth_) {
            const float survival = std::min(greatest(weight) / kept, 0.95f);
            if (!(random() < survival)) break;
            weight /= survival;
        } else if (k + 1 == roulette_depth_) {
            kept = greatest(weight);
        }
        if (!(greatest(weight) > 0.0f)) break;
        surface = next;
        direction = onward;
    }
    if (met) learn(steps, sum, *met);
    return sum;
}

// One bounce off every surface in a direction, near or far, hidden or not: integrated over the
// hemisphere that is the integral over all surfaces with visibility 1. [Cochran07, section 3.2]
glm::vec3 Paths::unshadowed(const Surface& surface, const glm::vec3& direction,
                            Random& random) const {
    glm::vec3 sum(0.0f);
    if (!surface.reflects) return sum;
    const Bsdf bsdf(surface, -direction);
    const glm::vec3 onward = bsdf.sample(random, effects_.indirect_gloss);
    const float density = bsdf.density(onward, effects_.indirect_gloss);
    if (!above(surface, onward) || !(density > 0.0f)) return sum;
    thread_local std::vector<Hit> hits;
    Ray ray{off_surface(surface), onward};
    ray.chance = chance(geometry_, random);
    tracer_.all(ray, hits);
    // Embree finds them in any order, and sums depend on it.
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return a.triangle < b.triangle; });
    for (const Hit& hit : hits) {
        const Surface other = surface_at(geometry_, hit, onward);
        if (other.reflects)
            sum += lit(other, Bsdf(other, -onward), effects_.indirect_gloss, nullptr, random);
    }
    return sum * reflected(bsdf, effects_.indirect_gloss, onward) *
           (glm::dot(surface.normal, onward) / density);
}

glm::vec3 Paths::sample(const Surface& seen, const glm::vec3& direction, Random& random,
                        std::vector<Met>* met) const {
    glm::vec3 sum = effects_.emission ? seen.emission : glm::vec3(0.0f);
    if (effects_.shadowed) return sum + walk(seen, direction, effects_.last_bounce, random, met);
    if (effects_.direct) sum += walk(seen, direction, 0, random, met);
    return sum + unshadowed(seen, direction, random);
}

}  // namespace clgi::reference
