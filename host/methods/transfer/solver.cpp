// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/opencl/variants.hpp"
#include "methods/transfer/solver_state.hpp"

namespace clgi {
namespace {

MaskWeights windowed(MaskWeights weights, sh::Window kind) {
    if (kind == sh::Window::none) return weights;
    const std::vector<double> factor = sh::window(kind, weights.bands);
    const auto terms = static_cast<std::size_t>(sh::terms(weights.bands));
    for (std::size_t i = 0; i < weights.values.size(); ++i)
        weights.values[i] *= static_cast<float>(
            factor[static_cast<std::size_t>(sh::degree(static_cast<int>(i % terms)))]);
    return weights;
}

}  // namespace

DynamicTransferSolver::State::State(const Programs& programs, const cl::CommandQueue& on,
                                    const Scene& file, const DeviceScene& of,
                                    const DynamicTransferOptions& wanted)
    : TransferBuffers(file, of, wanted),
      queue(on),
      masks(programs, wanted.masks, wanted.build),
      sides(programs, wanted.build),
      projection(programs, full(wanted.build), wanted.masks.bands),
      record(queue, transfer_owner),
      cells(integrates() ? windowed(mask_weights(wanted.masks.size, wanted.masks.block,
                                                 wanted.masks.bands, wanted.cells),
                                    wanted.window)
                         : MaskWeights()) {
    const BufferTable rows = table();
    rows.check(queue.getInfo<CL_QUEUE_DEVICE>(), options.memory_budget, scene.bytes());
    rows.allocate(record);
    bytes = rows.bytes();
    blockers = both;
    fine.corners = both.corners;
    fine.boxes = both.boxes;
    fine.triangle_count = both.triangle_count;
    fine.stride = both.stride;
    build();
    write(file);
}

void DynamicTransferSolver::State::build() const {
    masks.build({"receivers"});
    projection.build({"project_rows", "project_columns", "project_environment"});
    if (!vertices.fronts.empty()) sides.build({"other_sides"});
    if (integrates()) masks.build({"shade"});
    if (!occludes(options.occlusion)) {
        projection.build({"open"});
        if (glossy) masks.build({"integrate_open_gloss"});
        return;
    }
    masks.build({"blockers", "mask", "integrate"});
    if (!levels.near.empty()) masks.build({"mask_near"});
    if (options.masks.planes == EdgePlanes::table) masks.build({"planes"});
    if (glossy) masks.build({"integrate_gloss"});
    if (options.interreflections > 0)
        masks.build({"exitance", levels.near.empty() ? "bounce" : "bounce_near"});
}

void DynamicTransferSolver::State::write(const Scene& file) {
    record.fill(status, 0);
    put(other_side, vertices.other_side);
    put(fronts, vertices.fronts);
    if (glossy) put(exponents, vertices.exponents);
    put(weights, cells.values);
    put(directions, cells.directions);
    sky.write(record);
    if (occludes(options.occlusion)) write_shadows(file);
}

void DynamicTransferSolver::State::write_shadows(const Scene& file) {
    put(triangles, levels.triangles);
    put(both.lists, levels.lists);
    put(both.ranges, levels.ranges);
    put(both.near_lists, levels.near_lists);
    put(both.near, levels.near);
    const std::uint32_t fine_clusters = blocker_stride(levels.fine_count) / BLOCKER_CLUSTER;
    put(fine.lists, std::vector<std::uint32_t>{0, 1});
    put(fine.ranges, std::vector<std::uint32_t>{0, fine_clusters});
    const std::vector<float> z = pixel_heights(options.masks.size);
    if (options.interreflections > 0) {
        put(reflectance, vertices.reflectances(file, scene, receivers.stride));
        put(heights, z);
    }
    if (options.masks.planes == EdgePlanes::exact) {
        put(drawn, z);
        return;
    }
    const cl::Buffer on_device(queue.getInfo<CL_QUEUE_CONTEXT>(), CL_MEM_READ_ONLY,
                               z.size() * sizeof(float));
    put(on_device, z);
    record("transfer.planes", z.size(),
           [&](const WaitList& wait) { return masks.planes(queue, on_device, drawn, wait); });
}

// Planes of receivers, corners and boxes of blockers.
void DynamicTransferSolver::State::place_receivers() {
    const std::size_t vertex_count = scene.info().vertex_count;
    record("transfer.receivers", vertex_count, [&](const WaitList& wait) {
        ReceiverBuffers front = receivers;
        front.count = static_cast<std::uint32_t>(vertex_count);
        return masks.receivers(queue, scene.positions(), scene.normals(), front, status, wait);
    });
    if (!vertices.fronts.empty())
        record("transfer.other_sides", vertices.fronts.size(), [&](const WaitList& wait) {
            return sides.other_sides(
                queue,
                {static_cast<std::uint32_t>(vertex_count),
                 static_cast<std::uint32_t>(vertices.fronts.size()), receivers.stride, 0},
                fronts, receivers, wait);
        });
    if (!occludes(options.occlusion)) return;
    record("transfer.blockers", both.triangle_count, [&](const WaitList& wait) {
        return masks.blockers(queue, triangles, scene.positions(), both, status, wait);
    });
}

void DynamicTransferSolver::State::transfer() {
    place_receivers();
    if (!occludes(options.occlusion)) return;
    record("transfer.mask", receivers.count, [&](const WaitList& wait) {
        return masks.mask(queue, receivers, blockers, drawn, wait);
    });
    record("transfer.integrate", receivers.count, [&](const WaitList& wait) {
        return masks.integrate(queue, receivers, weights, directions, wait);
    });
}

void DynamicTransferSolver::State::shade(const cl::Buffer& vectors, const cl::Buffer& out) {
    record("transfer.shade", receivers.count, [&](const WaitList& wait) {
        return masks.shade(queue, receivers, vectors, sky.light(), SHADE_CLAMP, out, bad, wait);
    });
}

void DynamicTransferSolver::State::light() {
    sky.project(record, projection);
    if (!occludes(options.occlusion)) return light_openly();
    shade(receivers.transfer, irradiance);
    if (options.interreflections > 0) bounce();
}

void DynamicTransferSolver::State::light_openly() {
    const OpenParams params = open_params(options.masks.bands, options.window, RECEIVER_NORMAL,
                                          receivers.count, receivers.stride);
    record("transfer.open", receivers.count, [&](const WaitList& wait) {
        return projection.open(queue, params, receivers.planes, sky.light(), irradiance, bad, wait);
    });
}

void DynamicTransferSolver::State::bounce() {
    const BounceParams params{both.triangle_count, receivers.stride, 0.0f, 0};
    record("transfer.exitance", both.triangle_count, [&](const WaitList& wait) {
        return masks.exitance(queue, params, triangles, other_side, reflectance, irradiance,
                              exitance, wait);
    });
    record("transfer.bounce", receivers.count, [&](const WaitList& wait) {
        return masks.bounce(queue, receivers, blockers, heights, exitance, irradiance, bad, wait);
    });
}

void DynamicTransferSolver::State::reflect(const glm::vec4& eye) {
    if (!glossy) return;
    record("transfer.integrate_gloss", receivers.count, [&](const WaitList& wait) {
        return masks.integrate_gloss(queue, receivers, weights, directions, exponents, eye, lobes,
                                     wait);
    });
    shade(lobes, gloss);
}

DynamicTransferSolver::DynamicTransferSolver(const Programs& programs,
                                             const cl::CommandQueue& queue, const Scene& scene,
                                             const DeviceScene& device,
                                             const DynamicTransferOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, device, options)) {}

DynamicTransferSolver::~DynamicTransferSolver() = default;

void DynamicTransferSolver::lights_changed() {
    state_->sky.update();
    state_->record.forget_failed();
}

void DynamicTransferSolver::turn_environment(double angle) { state_->sky.turn(angle); }
double DynamicTransferSolver::environment_turn() const { return state_->sky.projected_turn(); }

cl::Event DynamicTransferSolver::look(const WaitList& wait) { return state_->look(wait); }
VisibleSets DynamicTransferSolver::sets() { return state_->sets(); }
void DynamicTransferSolver::restrict(const VisibleSets& sets) { state_->restrict(sets); }

cl::Event DynamicTransferSolver::transfer(const WaitList& wait) {
    state_->record.begin(wait);
    state_->transfer();
    return state_->record.last();
}

cl::Event DynamicTransferSolver::light(const WaitList& wait) {
    state_->record.begin(wait);
    state_->light();
    return state_->record.last();
}

cl::Event DynamicTransferSolver::reflect(const glm::vec3& eye, const WaitList& wait) {
    return reflect(glm::vec4(eye, 0.0f), wait);
}

cl::Event DynamicTransferSolver::reflect(const glm::vec4& eye, const WaitList& wait) {
    state_->record.begin(wait);
    state_->reflect(eye);
    return state_->record.last();
}

cl::Event DynamicTransferSolver::last() const { return state_->record.last(); }

bool DynamicTransferSolver::run(const Progress& progress) {
    State& s = *state_;
    s.record.begin({}, progress);
    s.transfer();
    s.record.report(0.9);
    if (!s.record.cancelled()) s.light();
    s.record.report(1.0);
    return !s.record.cancelled();
}

TransferStatus DynamicTransferSolver::status() const {
    const State& s = *state_;
    s.record.wait();
    TransferStatus out;
    std::uint32_t words[MASK_STATUS_WORDS];
    s.queue.enqueueReadBuffer(s.status, CL_TRUE, 0, sizeof(words), words);
    out.bad_receivers = words[MASK_BAD_RECEIVERS];
    out.bad_blockers = words[MASK_BAD_BLOCKERS];
    out.bad_texels = s.record.read_word(s.sky.counter());
    out.non_finite = s.record.read_word(s.bad);
    return out;
}

const std::vector<PassEvent>& DynamicTransferSolver::events() const {
    return state_->record.events();
}
Interval DynamicTransferSolver::interval() const { return state_->record.interval(); }
const DynamicTransferOptions& DynamicTransferSolver::options() const { return state_->options; }
bool DynamicTransferSolver::glossy() const { return state_->glossy; }
std::size_t DynamicTransferSolver::bytes() const { return state_->bytes; }
const ReceiverBuffers& DynamicTransferSolver::receivers() const { return state_->receivers; }
const cl::Buffer& DynamicTransferSolver::irradiance() const { return state_->irradiance; }
const cl::Buffer& DynamicTransferSolver::gloss() const { return state_->gloss; }
const cl::Buffer& DynamicTransferSolver::other_side() const { return state_->other_side; }
const cl::Buffer& DynamicTransferSolver::environment() const { return state_->sky.light(); }
const MaskPasses& DynamicTransferSolver::passes() const { return state_->masks; }
const BlockerBuffers& DynamicTransferSolver::blockers() const { return state_->fine; }
double DynamicTransferSolver::triangles_per_receiver() const {
    const double all = static_cast<double>(state_->listed_triangles);
    return all / std::max<std::uint32_t>(state_->receivers.count, 1);
}
const cl::Buffer& DynamicTransferSolver::drawn() const { return state_->drawn; }
const cl::Buffer& DynamicTransferSolver::heights() const { return state_->heights; }
const cl::Buffer& DynamicTransferSolver::exitance() const { return state_->exitance; }
const cl::Buffer& DynamicTransferSolver::weights() const { return state_->weights; }
const cl::Buffer& DynamicTransferSolver::directions() const { return state_->directions; }
const cl::Buffer& DynamicTransferSolver::counter() const { return state_->bad; }

}  // namespace clgi
