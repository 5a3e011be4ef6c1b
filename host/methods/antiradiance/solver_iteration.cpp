// Direct light into the leaves, and the two iterations. [Dachsbacher07, sections 2.2 and 3.3]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "methods/antiradiance/solver_state.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t symmetric_step = LOCAL_RECEIVE | LOCAL_REFLECT | LOCAL_GO_THROUGH;

// Of the symmetric iteration, which another one can follow, a rule of thumb: growth in so many
// steps, to so many times the least residual, is divergence.
constexpr int growing_steps = 3;
constexpr double growth = 4.0;

// What counts as divergence of the asymmetric iteration, behind which there is no other. Light that
// is let through may grow at first and yet converge: where it passes n surfaces, step k changes at
// most C(n - 1, k) times what the first one brought, and steps from n on change nothing
// [derived: powers of a strictly triangular matrix of ones]. So many surfaces are allowed for.
constexpr int most_surfaces = 64;
constexpr double most_growth = 0x1p60;  // C(63, 31) is less

// Once light has been let through, each reflection adds at most what arrived in the first step, in
// which nothing was in the way of the sources' light: albedos are at most 1. So after k reflections
// at most k + 1 times that arrives. Bins may err, but not by a factor of two.
constexpr double most_gain = 2.0;

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
void AntiradianceSolver::State::darken() {
    record.fill(leaves.irradiances, 0);
    record.fill(leaves.radiances, 0);
    step(LOCAL_REFLECT | LOCAL_GO_THROUGH);
}

void AntiradianceSolver::State::start() {
    record.fill(leaves.non_finite, 0);
    steps_done = 0;
    darken();
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
    arrived = all.w;
    if (steps_done == 1) first_arrived = arrived;
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
        report(progress);  // before what diverged is taken away
        growing = now > before ? growing + 1 : 0;
        least = std::min(least, now);
        if (growing >= growing_steps && now >= growth * least) return false;
        if (!std::isfinite(now)) return false;
        before = now;
    }
    return true;
}

bool AntiradianceSolver::State::asymmetric(const Progress& progress) {
    found.iteration = Iteration::asymmetric;
    found.converged = false;
    start();
    double last = 1.0, brought = 1.0;  // by the last step; by the reflection, once it shows
    int through = 0;                   // steps since the last reflection
    int reflections = 0;
    bool grows = false;
    // False where that was the last step.
    const auto make = [&](std::uint32_t flags) {
        step(flags);
        last = residual();
        // Changes below the residual may be those of rounding.
        grows = !(last <= most_growth) ||
                (through >= most_surfaces && last > std::max(brought, options.residual));
        report(progress);
        return steps_done < limit() && !record.cancelled() && !grows;
    };
    while (steps_done < limit() && !record.cancelled()) {
        // What is not yet taken away need not be less than what the next reflection changes.
        const double enough = std::max(0.1 * last, 0.5 * options.residual);
        const int wanted = options.through_steps;
        for (bool more = wanted == 0 || through < wanted; more; ++through) {
            if (!make(LOCAL_RECEIVE | LOCAL_GO_THROUGH)) return !grows;
            more = wanted == 0 ? !(last < enough) : through + 1 < wanted;
        }
        // With a number of steps that was set light may not yet be taken away behind all surfaces.
        const bool settled = wanted == 0 || steps_done >= most_surfaces;
        if (settled && arrived > most_gain * (reflections + 1) * first_arrived) return false;
        if (!make(LOCAL_RECEIVE | LOCAL_REFLECT)) return !grows;
        ++reflections;
        const bool taken = done(last);
        // A step that lets through shows what the reflection changed.
        through = 0;
        const bool more = make(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
        through = 1;
        brought = last;
        found.converged = taken && done(last) && !record.cancelled();
        if (!more || (options.steps == 0 && found.converged)) return !grows;
    }
    return true;
}

bool AntiradianceSolver::State::iterate(const Progress& progress) {
    found.lets_through = links.row_count > 0;
    const bool may_switch = options.iteration == Iteration::automatic && found.lets_through;
    const bool symmetric_first = options.iteration != Iteration::asymmetric || !found.lets_through;
    if (symmetric_first) {
        found.diverged = !symmetric(progress);
        if (record.cancelled()) return true;
        // One that neither diverges nor comes to rest is given up as well.
        const bool stuck = options.steps == 0 && !found.converged;
        if (!may_switch || !(found.diverged || stuck)) return !found.diverged;
    }
    return asymmetric(progress);
}

bool AntiradianceSolver::State::run(const Progress& progress) {
    record.begin(std::exchange(moves, {}), progress);
    found = {{false}};
    if (moved) follow_geometry();
    light_leaves();
    found.given_up = !iterate(progress) && !record.cancelled();
    if (found.given_up) darken();
    record("antiradiance.vertices", surface.vertex_count,
           [&](const WaitList& wait) { return passes.vertices(queue, surface, leaves, wait); });
    keep_gloss();
    record.wait();
    moved = moved && record.cancelled();  // after a failure all of it is done again
    record.report(1.0);
    return !record.cancelled();
}

}  // namespace clgi
