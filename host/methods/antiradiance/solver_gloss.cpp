// What AntiradianceSolver does with leaves that have lobes. [Dachsbacher07, section 3.1, Eq. 18]
// SPDX-License-Identifier: MIT
#include "methods/antiradiance/solver_state.hpp"

namespace clgi {

void AntiradianceSolver::State::write_gloss() {
    if (gloss.count == 0) return;
    put(gloss.leaves, glossy.leaves);
    put(gloss.albedos, glossy.albedos);
    put(gloss.bins, direction_planes(direction_rows(bins)));
    put(gloss.rows, glossy.rows);
    put(gloss.first_leaves, glossy.first);
    put(gloss.vertex_leaves, glossy.vertex_leaves);
    // Past the last bin a row is never written.
    record.fill(gloss.arriving, 0);
    make_lobes();
}

// As the normals of leaves are.
void AntiradianceSolver::State::make_lobes() {
    record("antiradiance.lobes", gloss.count,
           [&](const WaitList& wait) { return gloss_passes->lobes(queue, links, gloss, wait); });
}

// What lobes reflect of direct light.
void AntiradianceSolver::State::light_gloss() {
    if (gloss.count == 0) return;
    const auto number = static_cast<std::uint32_t>(emitters.set().emitters.size());
    const GlossSourceParams params{gloss.count, leaf_samples, points.stride, number, 1.0f, 1, 0, 0};
    record("antiradiance.gloss_sources", gloss.count, [&](const WaitList& wait) {
        return gloss_passes->sources(queue, params, scene, points, emitters.buffers(), links, gloss,
                                     wait);
    });
}

void AntiradianceSolver::State::step_gloss(std::uint32_t flags) {
    if (gloss.count == 0) return;
    record("antiradiance.gloss", gloss.count, [&](const WaitList& wait) {
        return gloss_passes->gloss(queue, flags, links, rows, directions, leaves, gloss, wait);
    });
}

// What arrived, for pictures.
void AntiradianceSolver::State::keep_gloss() {
    if (gloss.count == 0) return;
    record("antiradiance.gloss_vertices", gloss.vertex_count,
           [&](const WaitList& wait) { return gloss_passes->vertices(queue, gloss, wait); });
}

}  // namespace clgi
