// Direct light into the leaves, and the two iterations. [Dachsbacher07, sections 2.2 and 3.3]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/antiradiance_state.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t symmetric_step = LOCAL_RECEIVE | LOCAL_REFLECT | LOCAL_GO_THROUGH;

// Light that is let through may grow at first, up to a binomial coefficient of the number of
// surfaces behind each other, and yet converge. Growth in so many steps, to so many times the least
// residual, is divergence.
constexpr int growing_steps = 3;
constexpr double growth = 4.0;

}  // namespace

// Shadow-mapped direct light at the sample points, and what leaves reflect of it.
void AntiradianceSolver::State::light_leaves() {
    emitters.draw(record, gbuffer, lists);
    const auto count = static_cast<std::uint32_t>(made.samples.size());
    const auto number = static_cast<std::uint32_t>(emitters.set().emitters.size());
    const DirectParams params{points.stride, count, number, 1.0f, 1, 0, 0, 0};
    record("lights.direct", count, [&](const WaitList& wait) {
        return lights.direct(queue, params, emitters.buffers(), points.planes, irradiance,
                             bad_points, wait);
    });
    record("antiradiance.sources", links.leaf_count, [&](const WaitList& wait) {
        return passes.sources(queue, point_params, scene, points, irradiance, leaves, wait);
    });
    light_gloss();
}

// Nothing has arrived yet: leaves send their own light alone.
void AntiradianceSolver::State::start() {
    record.fill(leaves.non_finite, 0);
    record.fill(leaves.irradiances, 0);
    record.fill(leaves.radiances, 0);
    step(LOCAL_REFLECT | LOCAL_GO_THROUGH);
}

// One of the steps of Eq. 13 and 14, for all elements: down the tree, at the leaves, and up again.
void AntiradianceSolver::State::step(std::uint32_t flags) {
    const std::size_t levels = made.level_begins.size() - 1;
    const auto level = [&](std::size_t l) {
        return ElementParams{made.level_begins[l], made.level_begins[l + 1] - made.level_begins[l],
                             0, 0};
    };
    for (std::size_t l = 0; (flags & LOCAL_RECEIVE) && l < levels; ++l)
        record("antiradiance.global", level(l).count, [&](const WaitList& wait) {
            return passes.global(queue, level(l), inner_list, links, rows, wait);
        });
    const std::uint32_t diffuse = links.leaf_count - gloss.count;
    record("antiradiance.local", diffuse, [&](const WaitList& wait) {
        return passes.local(queue, {0, diffuse, flags, 0}, leaf_list, links, rows, directions,
                            leaves, wait);
    });
    step_gloss(flags);
    for (std::size_t l = levels; l-- > 0;)
        record("antiradiance.pull", level(l).count, [&](const WaitList& wait) {
            return passes.pull(queue, level(l), inner_list, links, rows, wait);
        });
    if (record.cancelled()) return;
    std::swap(rows.exitant, rows.next);
    std::swap(rows.powers, rows.next_powers);
}

// By how much what arrives at all leaves changed in the last step, of what arrived in the first: a
// measure that stays the same, so that light that grows without end is not taken for rest.
double AntiradianceSolver::State::residual() {
    record("parallel.sum", links.leaf_count, [&](const WaitList& wait) {
        return parallel.sum(queue, links.leaf_count, leaves.changes, sum, scratch, wait);
    });
    ++steps_done;
    record.wait();
    if (record.cancelled()) return 0.0;
    glm::vec4 all(0.0f);
    const WaitList pending = record.waits();
    queue.enqueueReadBuffer(sum, CL_TRUE, 0, sizeof(all), &all, &pending);
    const double changed = double{all.x} + all.y + all.z;
    if (steps_done == 1) first_arrived = all.w;
    const double out = changed == 0.0 ? 0.0 : changed / first_arrived;
    found.residuals.push_back(out);
    return out;
}

void AntiradianceSolver::State::report(const Progress& progress) {
    if (progress) record.report(std::min(1.0, static_cast<double>(steps_done) / limit()));
}

bool AntiradianceSolver::State::symmetric(const Progress& progress) {
    found.iteration = Iteration::symmetric;
    start();
    double least = std::numeric_limits<double>::infinity(), before = least;
    int growing = 0;
    while (steps_done < limit() && !record.cancelled()) {
        step(symmetric_step);
        const double now = residual();
        found.converged = done(now) && !record.cancelled();
        if (options.steps == 0 && found.converged) return true;
        growing = now > before ? growing + 1 : 0;
        least = std::min(least, now);
        if (growing >= growing_steps && now >= growth * least) return false;
        if (!std::isfinite(now)) return false;
        before = now;
        report(progress);
    }
    return true;
}

void AntiradianceSolver::State::asymmetric(const Progress& progress) {
    found.iteration = Iteration::asymmetric;
    found.converged = false;
    steps_done = 0;
    start();
    double last = 1.0;
    int through = 0;  // steps since the last reflection
    // False where that was the last step.
    const auto make = [&](std::uint32_t flags) {
        step(flags);
        last = residual();
        report(progress);
        return steps_done < limit() && !record.cancelled() && std::isfinite(last);
    };
    while (steps_done < limit() && !record.cancelled()) {
        // What is not yet taken away need not be less than what the next reflection changes.
        const double enough = std::max(0.1 * last, 0.5 * options.residual);
        const int wanted = options.through_steps;
        for (bool more = wanted == 0 || through < wanted; more; ++through) {
            if (!make(LOCAL_RECEIVE | LOCAL_GO_THROUGH)) return;
            more = wanted == 0 ? !(last < enough) : through + 1 < wanted;
        }
        if (!make(LOCAL_RECEIVE | LOCAL_REFLECT)) return;
        const bool taken = done(last);
        // A step that lets through shows what the reflection changed.
        const bool more = make(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
        through = 1;
        found.converged = taken && done(last) && !record.cancelled();
        if (!more || (options.steps == 0 && found.converged)) return;
    }
}

bool AntiradianceSolver::State::run(const Progress& progress) {
    record.begin(std::exchange(moves, {}), progress);
    found = {};
    steps_done = 0;
    if (moved) follow_geometry();
    light_leaves();
    // Without rows a step that lets light through would change nothing.
    const Iteration wanted = links.row_count > 0 ? options.iteration : Iteration::symmetric;
    const bool either = wanted == Iteration::automatic;
    if (wanted != Iteration::asymmetric) found.diverged = !symmetric(progress);
    // A symmetric iteration that neither diverges nor comes to rest is given up as well.
    const bool stuck = either && options.steps == 0 && !found.converged;
    if (wanted == Iteration::asymmetric || (either && found.diverged) || stuck)
        asymmetric(progress);
    record("antiradiance.vertices", surface.vertex_count,
           [&](const WaitList& wait) { return passes.vertices(queue, surface, leaves, wait); });
    keep_gloss();
    record.wait();
    moved = moved && record.cancelled();  // after a failure all of it is done again
    record.report(1.0);
    return !record.cancelled();
}

}  // namespace clgi
