// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <clgi/advanced/kit/draw.hpp>

#include "core/opencl/variants.hpp"
#include "methods/antiradiance/sky.hpp"
#include "methods/antiradiance/solver_state.hpp"

namespace clgi {
namespace {

std::size_t bytes_of(const std::vector<cl::Buffer>& buffers) {
    std::size_t sum = 0;
    for (const cl::Buffer& buffer : buffers) sum += buffer.getInfo<CL_MEM_SIZE>();
    return sum;
}

}  // namespace

AntiradianceSolver::State::State(const Programs& all, const cl::CommandQueue& on, const Scene& file,
                                 const DeviceScene& of, const AntiradianceOptions& wanted)
    : AntiradianceBuffers(file, of, wanted),
      programs(all),
      queue(on),
      passes(programs, wanted.bins, options.build),
      gbuffer(programs, full(options.build)),
      lights(programs, full(options.build)),
      parallel(programs, options.build),
      record(queue, antiradiance_owner) {
    const cl::Device device = queue.getInfo<CL_QUEUE_DEVICE>();
    // As far as is known before linking, which takes time.
    table(0, 0).check(device, options.memory_budget, scene.bytes());
    if (gloss.count > 0) gloss_passes.emplace(programs, options.bins, options.build);
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<ElementTree> poses = posed(file);
    options.poses = {};
    const Links all_links = make_links(tree, bins, options.links, poses);
    const DeviceLinks between =
        device_links(tree, bins, all_links, scene.frame().scale, glossy.leaves, made.elements,
                     options.occlusion == Occlusion::always);
    if (!poses.empty())
        motion = std::make_unique<AntiradianceMotion>(programs, options.build, tree, poses, bins,
                                                      file, scene, between, made.elements);
    moved = motion != nullptr;
    linking += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    link_total = between.senders.size();
    pair_total = all_links.pairs;
    BufferTable rows_of = table(link_total, between.rows);
    if (motion) motion->add_to(rows_of, tree);
    rows_of.check(device, options.memory_budget, scene.bytes());
    rows_of.allocate(record);
    bytes = rows_of.bytes();
    build();
    write(file, between);
}

void AntiradianceSolver::State::build() const {
    passes.build({"global", "local", "pull", "sources", "vertices"});
    if (made.first_back < made.leaves.size()) passes.build({"turn"});
    if (gloss_passes) gloss_passes->build({"lobes", "gloss_sources", "gloss", "gloss_vertices"});
    gbuffer.build({"surface"});
    lights.build({"direct"});
    parallel.build({"sum_tiles", "sum_merge"});
    if (motion) motion->build();
    emitters.build(gbuffer);
}

void AntiradianceSolver::State::write(const Scene& file, const DeviceLinks& between) {
    emitters.write(record);
    put(links.elements, made.elements);
    put(links.first_links, between.first);
    put(links.senders, between.senders);
    put(links.bins, between.bins);
    put(links.form_factors, between.form_factors);
    write_sky(file.environment);
    put(surface.roots, made.roots);
    put(surface.patches, made.patches);
    put(surface.first_leaves, made.first_leaves);
    put(surface.vertex_leaves, made.vertex_leaves);
    put(samples, made.samples);
    put(directions, direction_rows(bins));
    put(leaf_list, glossy.others);
    put(inner_list, made.inner);
    write_gloss();
    if (motion) motion->write(record, surface.patches);
    place_points();
}

void AntiradianceSolver::State::write_sky(const std::optional<Environment>& environment) {
    std::vector<glm::vec4> sky;
    const double exposure = scene.frame().exposure;
    for (const glm::dvec3& radiance : sky_row(environment, bins))
        sky.emplace_back(glm::vec3(radiance / exposure), 0.0f);
    put(rows.sky, sky);
}

void AntiradianceSolver::State::place_points() {
    const auto count = static_cast<std::uint32_t>(made.samples.size());
    record("gbuffer.surface", count, [&](const WaitList& wait) {
        return gbuffer.surface(queue, scene, {count, points.stride, 0, 0}, samples, points, {},
                               wait);
    });
    if (made.first_back < made.leaves.size())
        record("antiradiance.turn", count, [&](const WaitList& wait) {
            return passes.turn(queue, point_params, points.planes, wait);
        });
}

void AntiradianceSolver::State::follow_geometry() {
    motion->follow(record, scene, links, directions);
    const auto turns = [&](const GlossyLeaf& leaf) { return tree.moves(leaf.element); };
    if (std::any_of(glossy.leaves.begin(), glossy.leaves.end(), turns)) make_lobes();
    place_points();
}

AntiradianceSolver::AntiradianceSolver(const Programs& programs, const cl::CommandQueue& queue,
                                       const Scene& scene, const DeviceScene& device,
                                       const AntiradianceOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, device, options)) {}

AntiradianceSolver::~AntiradianceSolver() = default;

void AntiradianceSolver::lights_changed() {
    State& s = *state_;
    s.bytes += s.emitters.follow(s.options.emitters, s.record, s.gbuffer);
}

void AntiradianceSolver::environment_changed() {
    state_->record.forget_failed();
    state_->write_sky(state_->scene.environment());
}

void AntiradianceSolver::geometry_changed(const WaitList& wait) {
    State& s = *state_;
    if (!s.motion)
        throw Error("antiradiance: geometry_changed() needs a solver made with poses that move");
    const SceneFrame& now = s.scene.frame();
    if (now.origin != s.frame.origin || now.scale != s.frame.scale)
        throw Error("antiradiance: the scene has another local frame; make another solver");
    s.moved = true;
    s.moves.insert(s.moves.end(), wait.begin(), wait.end());
}

bool AntiradianceSolver::run(const Progress& progress) { return state_->run(progress); }

AntiradianceStatus AntiradianceSolver::status() const {
    AntiradianceStatus out = state_->found;
    out.non_finite = state_->record.read_word(state_->leaves.non_finite);
    return out;
}

cl::Event AntiradianceSolver::last() const { return state_->record.last(); }
const std::vector<PassEvent>& AntiradianceSolver::events() const { return state_->record.events(); }
Interval AntiradianceSolver::interval() const { return state_->record.interval(); }
const AntiradianceOptions& AntiradianceSolver::options() const { return state_->options; }
const ElementTree& AntiradianceSolver::elements() const { return state_->tree; }
const DirectionBins& AntiradianceSolver::bins() const { return state_->bins; }
std::size_t AntiradianceSolver::link_count() const { return state_->link_total; }
std::size_t AntiradianceSolver::link_pairs() const { return state_->pair_total; }
std::size_t AntiradianceSolver::moving_elements() const {
    return state_->motion ? state_->motion->element_count() : 0;
}
std::size_t AntiradianceSolver::moving_links() const {
    return state_->motion ? state_->motion->link_count() : 0;
}
std::size_t AntiradianceSolver::row_count() const { return state_->links.row_count; }
double AntiradianceSolver::linking_seconds() const { return state_->linking; }
std::size_t AntiradianceSolver::bytes() const { return state_->bytes; }
std::size_t AntiradianceSolver::table_bytes() const {
    const ElementRows& rows = state_->rows;
    return bytes_of(
        {rows.sky, rows.incident, rows.exitant, rows.next, rows.powers, rows.next_powers});
}
std::size_t AntiradianceSolver::link_bytes() const {
    const LinkBuffers& links = state_->links;
    return bytes_of({links.first_links, links.senders, links.bins, links.form_factors});
}
const LeafBuffers& AntiradianceSolver::leaves() const { return state_->leaves; }
const std::vector<std::uint32_t>& AntiradianceSolver::leaf_elements() const {
    return state_->made.leaves;
}
const LinkBuffers& AntiradianceSolver::links() const { return state_->links; }
const LeafSurface& AntiradianceSolver::surface() const { return state_->surface; }
const GlossBuffers& AntiradianceSolver::gloss() const { return state_->gloss; }
const AntiradiancePasses& AntiradianceSolver::passes() const { return state_->passes; }

}  // namespace clgi
