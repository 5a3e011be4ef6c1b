// Transfer vectors by casting rays.
//
//   V_i = integral of V(s) Y_i(s) cos = (pi / N) sum over open s of Y_i(s),  s drawn by cosine / pi
//                                            [Kautz04, Eq. 3; derived: Monte Carlo, stratified]
//
// SPDX-License-Identifier: MIT
#include <tbb/parallel_for.h>

#include <clgi/advanced/sh.hpp>
#include <clgi/error.hpp>
#include <cmath>

#include "reference/world.hpp"

namespace clgi::reference {
namespace {

constexpr double turn = 6.283185307179586;

// A frame around a unit normal.
struct Axes {
    explicit Axes(const glm::dvec3& up) : normal(up) {
        const glm::dvec3 other = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        across = glm::normalize(glm::cross(other, up));
        along = glm::cross(up, across);
    }
    glm::dvec3 normal, across, along;
};

}  // namespace

std::vector<double> PathTracer::transfer(const std::vector<Place>& places, int bands, int strata,
                                         std::uint64_t seed) const {
    if (strata < 1 || strata > 4096)
        throw Error("reference: " + std::to_string(strata) + " strata a side, 1 to 4096 needed");
    if (bands < 1 || bands > sh::most_bands)
        throw Error("reference: " + std::to_string(bands) + " bands, 1 to " +
                    std::to_string(sh::most_bands) + " needed");
    const auto terms = static_cast<std::size_t>(sh::terms(bands));
    std::vector<double> out(places.size() * terms, 0.0);
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t item) {
        const Place& place = places[item];
        const Axes axes(glm::normalize(glm::dvec3(place.normal)));
        const glm::vec3 origin = world_->geometry.to_local(place.position);
        double* sum = out.data() + item * terms;
        std::vector<double> basis(terms);
        Random random(seed, item, 0);
        for (int row = 0; row < strata; ++row)
            for (int column = 0; column < strata; ++column) {
                const double square = (row + double{random()}) / strata;
                const double angle = turn * (column + double{random()}) / strata;
                const double radius = std::sqrt(square);
                const glm::dvec3 s = radius * std::cos(angle) * axes.across +
                                     radius * std::sin(angle) * axes.along +
                                     std::sqrt(1.0 - square) * axes.normal;
                Ray ray{origin, glm::vec3(s), at_surface};
                ray.chance = chance(world_->geometry, random);
                if (world_->tracer.blocked(ray)) continue;
                sh::evaluate(s, bands, basis.data());
                for (std::size_t i = 0; i < terms; ++i) sum[i] += basis[i];
            }
        const double weight = 0.5 * turn / (double(strata) * strata);
        for (std::size_t i = 0; i < terms; ++i) sum[i] *= weight;
    });
    return out;
}

}  // namespace clgi::reference
