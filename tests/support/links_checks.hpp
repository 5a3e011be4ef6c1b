// What links carry, summed up in doubles as the passes do on the device.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/links.hpp>
#include <cmath>
#include <vector>

namespace clgi::test {

// Cosine of a bin at a patch, scaled so that a hemisphere of radiance 1 gives pi.
inline double bin_cosine(const ElementTree& tree, const DirectionBins& bins, std::size_t element,
                         int bin) {
    return bins.hemisphere_scale(tree.normals[element]) *
           glm::dot(tree.normals[element], bins.directions[static_cast<std::size_t>(bin)]);
}

struct Arrived {
    std::vector<double> solid_angle;  // [elements] sr: sum of solid angle * radiance, bins in front
    std::vector<double> irradiance;
    double farthest_solid_angle = 0.0, farthest_irradiance = 0.0;  // from 2 pi and pi, relative
    double mean_irradiance = 0.0;                                  // weighted by area
};

// Every leaf sends radiance 1 from its front and nothing from its back.
inline Arrived send_one(const ElementTree& tree, const DirectionBins& bins, const Links& links) {
    constexpr double pi = 3.14159265358979323846;
    const auto m = static_cast<std::size_t>(bins.count());
    std::vector<double> intensity(tree.count() * m, 0.0), incident(tree.count() * m, 0.0);
    std::vector<double> cosine(tree.count() * m, 0.0);
    for (std::size_t i = tree.count(); i-- > 0;) {
        if (tree.is_leaf(i)) {
            const double scale = bins.hemisphere_scale(tree.normals[i]);
            for (std::size_t j = 0; j < m; ++j) {
                cosine[i * m + j] = scale * glm::dot(tree.normals[i], bins.directions[j]);
                intensity[i * m + j] = tree.areas[i] * std::max(0.0, cosine[i * m + j]);
            }
        }
        if (tree.parents[i] != no_index)  // pull
            for (std::size_t j = 0; j < m; ++j)
                intensity[tree.parents[i] * m + j] += intensity[i * m + j];
    }
    Arrived out;
    out.solid_angle.assign(tree.count(), 0.0);
    out.irradiance.assign(tree.count(), 0.0);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (tree.parents[i] != no_index)  // push
            for (std::size_t j = 0; j < m; ++j)
                incident[i * m + j] = incident[tree.parents[i] * m + j];
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            incident[i * m + links.bins[k]] += static_cast<double>(links.form_factors[k]) *
                                               intensity[links.senders[k] * m + links.bins[k]];
        if (!tree.is_leaf(i)) continue;
        for (std::size_t j = 0; j < m; ++j) {
            const double radiance = incident[i * m + j], c = -cosine[i * m + j];
            if (c <= 0.0) continue;
            out.solid_angle[i] += bins.solid_angles[j] * radiance;
            out.irradiance[i] += bins.solid_angles[j] * radiance * c;
        }
        out.farthest_solid_angle =
            std::max(out.farthest_solid_angle, std::abs(out.solid_angle[i] / (2.0 * pi) - 1.0));
        out.farthest_irradiance =
            std::max(out.farthest_irradiance, std::abs(out.irradiance[i] / pi - 1.0));
        out.mean_irradiance += tree.areas[i] / tree.areas[0] * out.irradiance[i];
    }
    return out;
}

}  // namespace clgi::test
