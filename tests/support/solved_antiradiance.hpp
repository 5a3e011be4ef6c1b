// Solvers of antiradiance that have run, and what their leaves receive.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/antiradiance.hpp>
#include <vector>

#include "device.hpp"

namespace clgi::test {

// A solver and the scene that it lights.
struct Solved {
    DeviceScene scene;
    AntiradianceSolver solver;
    explicit Solved(const Scene& of, const AntiradianceOptions& options = {}, bool run = true)
        : scene(on_device(of)), solver(programs(), device().queue, of, scene, options) {
        if (run) solver.run();
    }
    double exposure() const { return scene.frame().exposure; }
    std::size_t count() const { return solver.elements().leaves; }
    std::vector<glm::vec4> irradiances() const {
        return download<glm::vec4>(solver.leaves().irradiances, count());
    }
    std::vector<glm::vec4> sources() const {
        return download<glm::vec4>(solver.leaves().sources, count());
    }
    std::vector<glm::vec4> reflectances() const {
        return download<glm::vec4>(solver.leaves().reflectances, count());
    }
    std::uint32_t element(std::size_t row) const { return solver.leaf_elements()[row]; }
};

inline AntiradianceOptions options_of(const Build& build, int bins, std::size_t leaves) {
    AntiradianceOptions out;
    out.bins = bins;
    out.elements.requested = leaves;
    out.build = build;
    return out;
}

// What all leaves receive, times their areas.
inline glm::dvec3 power(const Solved& solved) {
    glm::dvec3 sum(0.0);
    const std::vector<glm::vec4> e = solved.irradiances();
    for (std::size_t row = 0; row < e.size(); ++row)
        sum += solved.solver.elements().areas[solved.element(row)] * glm::dvec3(e[row]);
    return solved.exposure() * sum;
}

}  // namespace clgi::test
