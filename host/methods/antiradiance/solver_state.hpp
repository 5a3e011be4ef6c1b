// What AntiradianceSolver consists of.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/antiradiance_gloss.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/passes/parallel.hpp>
#include <memory>
#include <optional>

#include "methods/antiradiance/device_links.hpp"
#include "methods/antiradiance/solver_buffers.hpp"
#include "methods/antiradiance/solver_motion.hpp"

namespace clgi {

struct AntiradianceSolver::State : AntiradianceBuffers {
    State(const Programs& all, const cl::CommandQueue& on, const Scene& file, const DeviceScene& of,
          const AntiradianceOptions& wanted);

    void build() const;
    void write(const Scene& file, const DeviceLinks& between);

    template <typename T>
    void put(const cl::Buffer& buffer, const std::vector<T>& values) {
        if (!values.empty()) record.write(buffer, values.data(), values.size() * sizeof(T));
    }

    void write_sky(const std::optional<Environment>& environment);

    // Of glossy leaves; nothing where there are none.
    void write_gloss();
    void make_lobes();
    void light_gloss();
    void step_gloss(std::uint32_t flags);
    void keep_gloss();

    // Sample points of leaves where the scene's vertices are.
    void place_points();
    // The same for elements and links.
    void follow_geometry();
    void light_leaves();
    void darken();
    void start();
    void step(std::uint32_t flags);
    double residual();
    bool done(double change) const { return change < options.residual; }

    // Steps until they are done, the residual is small, or they diverge: false.
    bool symmetric(const Progress& progress);
    bool asymmetric(const Progress& progress);
    bool iterate(const Progress& progress);  // one of them, or one after the other
    int limit() const { return options.steps > 0 ? options.steps : options.most_steps; }
    void report(const Progress& progress);
    bool run(const Progress& progress);

    Programs programs;
    cl::CommandQueue queue;
    AntiradiancePasses passes;
    std::optional<AntiradianceGlossPasses> gloss_passes;  // none without glossy leaves
    GBufferPasses gbuffer;
    LightPasses lights;
    ParallelPasses parallel;
    mutable Recorder record;
    AntiradianceStatus found{{false}};
    std::unique_ptr<AntiradianceMotion> motion;  // null: nothing moves
    bool moved = false;                          // since the last run
    WaitList moves;                              // that the next run waits for
    std::size_t link_total = 0, pair_total = 0, bytes = 0;
    int steps_done = 0;          // of this run
    double first_arrived = 0.0;  // lumens, in the first step
    double arrived = 0.0;        // in the last one
};

}  // namespace clgi
