// SPDX-License-Identifier: MIT
#include "lab/leaf_difference.hpp"

#include <clgi/error.hpp>
#include <cmath>

#include "scene/luminance.hpp"

namespace clgi::lab {
namespace {

double luminance(const glm::vec4& color) {
    double out = 0.0;
    for (int c = 0; c < 3; ++c)
        out += luminance_weights[static_cast<std::size_t>(c)] * double{color[c]};
    return out;
}

}  // namespace

double leaf_difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                       const std::vector<double>& areas) {
    if (a.size() != areas.size() || b.size() != areas.size())
        throw Error("leaf_difference: " + std::to_string(a.size()) + " and " +
                    std::to_string(b.size()) + " leaves, " + std::to_string(areas.size()) +
                    " areas; as many of each needed");
    double square = 0.0, mean = 0.0, area = 0.0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const double wanted = luminance(b[i]), difference = luminance(a[i]) - wanted;
        square += areas[i] * difference * difference;
        mean += areas[i] * wanted;
        area += areas[i];
    }
    return mean == 0.0 ? 0.0 : std::sqrt(square * area) / mean;
}

std::vector<glm::vec4> leaf_irradiances(const cl::CommandQueue& queue,
                                        const AntiradianceSolver& solver) {
    std::vector<glm::vec4> out(solver.leaf_elements().size());
    queue.enqueueReadBuffer(solver.leaves().irradiances, CL_TRUE, 0, out.size() * sizeof(out[0]),
                            out.data());
    return out;
}

std::vector<double> leaf_areas(const AntiradianceSolver& solver) {
    std::vector<double> out;
    for (const std::uint32_t element : solver.leaf_elements())
        out.push_back(solver.elements().areas[element]);
    return out;
}

}  // namespace clgi::lab
