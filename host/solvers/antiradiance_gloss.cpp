// What AntiradianceSolver does with leaves that have lobes. [Dachsbacher07, section 3.1, Eq. 18]
// SPDX-License-Identifier: MIT
#include "solvers/antiradiance_state.hpp"

namespace clgi {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);

}  // namespace

void AntiradianceSolver::State::add_gloss(BufferTable& t) {
    gloss.count = glossy.count();
    gloss.vertex_count = glossy.vertices();
    if (gloss.count == 0) return;
    gloss_passes.emplace(programs, options.bins, options.build);
    const char* size = "elements.wished";
    const char* bin = "bins";
    const auto m = static_cast<std::size_t>(options.bins);
    const std::size_t row = gloss_passes->row_bytes();
    t.add(gloss.leaves, "glossy leaves", size, gloss.count * sizeof(GlossyLeaf));
    t.add(gloss.albedos, "glossy leaves", size, glossy.albedos.size() * sizeof(float));
    t.add(gloss.bins, "directions", bin, row / 3 * 4);
    t.add(gloss.factors, "factors of lobes", bin, gloss.count * m * sizeof(float));
    t.add(gloss.colors, "glossy leaves", size, gloss.count * sizeof(glm::vec4));
    t.add(gloss.sources, "light of glossy leaves", bin, gloss.count * row);
    t.add(gloss.arriving, "light of glossy leaves", bin, gloss.count * row);
    t.add(gloss.rows, "glossy vertices", size, glossy.rows.size() * word);
    t.add(gloss.first_leaves, "glossy vertices", size, glossy.first.size() * word);
    t.add(gloss.vertex_leaves, "glossy vertices", size, glossy.vertex_leaves.size() * 2 * word);
    t.add(gloss.light, "light of glossy vertices", bin, gloss.vertex_count * row);
}

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
