// How far values are from what the path tracer finds.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace clgi::test {

// Two estimates of one truth with different random numbers.
struct Twice {
    std::vector<glm::vec3> first, second;
};

struct Apart {
    double error = 0.0;  // root of the mean squared difference, of the mean; 0 where noise hides it
    double high = 0.0;   // the same with two standard errors of the square more
    double energy = 0.0;  // ratio of means
};

// In all channels. The product of the differences from both estimates is the squared difference
// from the truth without their noise. counts: which values do; empty: all.
inline Apart apart(const std::vector<glm::vec3>& found, const Twice& truth,
                   const std::vector<bool>& counts = {}) {
    double squares = 0.0, fourths = 0.0, sum = 0.0, wanted = 0.0, count = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!counts.empty() && !counts[i]) continue;
        const glm::dvec3 value(found[i]), a(truth.first[i]), b(truth.second[i]);
        const double square = glm::dot(value - a, value - b);
        squares += square;
        fourths += square * square;
        for (int c = 0; c < 3; ++c) {
            sum += value[c];
            wanted += 0.5 * (a[c] + b[c]);
        }
        count += 3.0;
    }
    if (squares < 0.0) squares = 0.0;  // what is no number stays so
    const double high = squares + 2.0 * std::sqrt(fourths), mean = wanted / count;
    return {std::sqrt(squares / count) / mean, std::sqrt(high / count) / mean, sum / wanted};
}

inline Twice render_twice(const Scene& scene, const Camera& camera, reference::Options options) {
    const reference::PathTracer tracer(scene);
    Twice out;
    out.first = tracer.render(camera, options).radiance;
    ++options.seed;
    out.second = tracer.render(camera, options).radiance;
    return out;
}

}  // namespace clgi::test
