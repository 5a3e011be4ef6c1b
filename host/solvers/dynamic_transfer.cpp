// SPDX-License-Identifier: MIT
#include <clgi/kit/environment_light.hpp>
#include <clgi/passes/receivers.hpp>
#include <clgi/planes.hpp>
#include <clgi/solvers/dynamic_transfer.hpp>

namespace clgi {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr const char* owner = "dynamic-transfer";

// What the vertices of the device belong to.
struct Vertices {
    Vertices(const Scene& scene, const DeviceScene& device)
        : other_side(device.info().vertex_count, RECEIVER_NONE),
          exponents(device.info().vertex_count, 0.0f) {
        if (scene.positions.size() != device.file_vertex_count())
            throw Error("dynamic-transfer: the scene has " +
                        std::to_string(scene.positions.size()) + " vertices, the device's had " +
                        std::to_string(device.file_vertex_count()));
        std::vector<std::uint32_t> of_file(scene.positions.size(), 0);
        for (std::uint32_t v = 0; v < device.info().vertex_count; ++v)
            of_file[device.vertex_order()[v]] = v;
        std::vector<bool> double_sided(other_side.size(), false);
        for (const SceneTriangle& triangle : scene.triangles) {
            const Material& material = scene.materials[triangle.material];
            const float exponent = reflectance(material.metallic, material.roughness).exponent;
            for (const std::uint32_t corner : triangle.vertex) {
                exponents[of_file[corner]] = exponent;
                if (material.double_sided) double_sided[of_file[corner]] = true;
            }
        }
        for (std::uint32_t v = 0; v < other_side.size(); ++v)
            if (double_sided[v]) {
                other_side[v] = static_cast<std::uint32_t>(exponents.size());
                fronts.push_back(v);
                exponents.push_back(exponents[v]);
            }
    }
    std::vector<std::uint32_t> other_side;  // [vertices] receiver or RECEIVER_NONE
    std::vector<std::uint32_t> fronts;      // [other sides] vertex
    std::vector<float> exponents;           // [receivers] of the lobes
};

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

struct DynamicTransferSolver::State {
    State(const Programs& programs, const cl::CommandQueue& on, const Scene& file,
          const DeviceScene& of, const DynamicTransferOptions& wanted)
        : queue(on),
          scene(of),
          options(wanted),
          glossy(wanted.gloss && of.has_lobes()),
          vertices(file, of),
          masks(programs, wanted.masks, wanted.build),
          sides(programs, wanted.build),
          projection(programs, wanted.build, wanted.masks.bands),
          sky(scene, wanted.masks.bands, wanted.directional),
          record(queue, owner),
          cells(windowed(
              mask_weights(wanted.masks.size, wanted.masks.block, wanted.masks.bands, wanted.cells),
              wanted.window)) {
        receivers.count = static_cast<std::uint32_t>(vertices.exponents.size());
        receivers.stride = plane_stride(receivers.count);
        blockers.triangle_count = scene.info().triangle_count;
        blockers.stride = blocker_stride(blockers.triangle_count);
        const BufferTable all = table();
        all.check(queue.getInfo<CL_QUEUE_DEVICE>(), options.memory_budget, scene.bytes());
        all.allocate(record);
        bytes = all.bytes();
        build();
        write();
    }

    void build() const {
        masks.build({"receivers", "blockers", "mask", "integrate", "shade"});
        projection.build({"project_rows", "project_columns", "project_environment"});
        if (!vertices.fronts.empty()) sides.build({"other_sides"});
        if (options.masks.planes == EdgePlanes::table) masks.build({"planes"});
        if (glossy) masks.build({"integrate_gloss"});
    }

    BufferTable table() {
        const char* vertex = "the scene's vertices";
        const char* triangle = "the scene's triangles";
        const std::size_t stride = receivers.stride;
        const auto terms = static_cast<std::size_t>(sh::terms(options.masks.bands));
        BufferTable t(owner);
        t.add(receivers.planes, "receivers", vertex, RECEIVER_PLANES * stride * word);
        t.add(receivers.masks, "masks", "mask size",
              static_cast<std::size_t>(MASK_WORDS(options.masks.size)) * stride * word);
        t.add(receivers.transfer, "transfer vectors", "bands", terms * stride * word);
        t.add(irradiance, "irradiance", vertex, 3 * stride * word);
        t.add(other_side, "other sides", vertex, vertices.other_side.size() * word);
        t.add(fronts, "other sides", vertex, vertices.fronts.size() * word);
        if (glossy) {
            t.add(lobes, "transfer vectors of lobes", "bands", terms * stride * word);
            t.add(gloss, "gloss", vertex, 3 * stride * word);
            t.add(exponents, "exponents of lobes", vertex, stride * word);
        }
        t.add(blockers.corners, "blockers", triangle, BLOCKER_PLANES * word * blockers.stride);
        t.add(blockers.boxes, "boxes of blockers", triangle,
              blockers.stride / BLOCKER_CLUSTER * sizeof(BlockerBox));
        t.add(blockers.lists, "lists of blockers", triangle, 2 * word);
        t.add(blockers.ranges, "lists of blockers", triangle, 2 * word);
        t.add(drawn, "the table of planes", "table size", mask_table_bytes(options.masks));
        t.add(weights, "weights of cells", "bands", cells.values.size() * word);
        t.add(directions, "directions of cells", "mask size",
              cells.directions.size() * sizeof(glm::vec4));
        t.add(status, "counters", "nothing", MASK_STATUS_WORDS * word);
        t.add_word(bad, "counters", 0);
        sky.add_to(t);
        return t;
    }

    void write() {
        const auto put = [&](const cl::Buffer& buffer, const auto& values) {
            if (!values.empty())
                record.write(buffer, values.data(), values.size() * sizeof(values[0]));
        };
        record.fill(status, 0);
        put(other_side, vertices.other_side);
        put(fronts, vertices.fronts);
        if (glossy) put(exponents, vertices.exponents);
        put(blockers.lists, std::vector<std::uint32_t>{0, 1});
        put(blockers.ranges, std::vector<std::uint32_t>{0, blockers.stride / BLOCKER_CLUSTER});
        put(weights, cells.values);
        put(directions, cells.directions);
        sky.write(record);
        const std::vector<float> heights = pixel_heights(options.masks.size);
        if (options.masks.planes == EdgePlanes::exact) {
            put(drawn, heights);
            return;
        }
        const cl::Buffer on_device(queue.getInfo<CL_QUEUE_CONTEXT>(), CL_MEM_READ_ONLY,
                                   heights.size() * sizeof(float));
        put(on_device, heights);
        record("transfer.planes", heights.size(),
               [&](const WaitList& wait) { return masks.planes(queue, on_device, drawn, wait); });
    }

    void transfer() {
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
        record("transfer.blockers", blockers.triangle_count, [&](const WaitList& wait) {
            return masks.blockers(queue, scene.triangles(), scene.positions(), blockers, status,
                                  wait);
        });
        record("transfer.mask", receivers.count, [&](const WaitList& wait) {
            return masks.mask(queue, receivers, blockers, drawn, wait);
        });
        record("transfer.integrate", receivers.count, [&](const WaitList& wait) {
            return masks.integrate(queue, receivers, weights, directions, wait);
        });
    }

    void shade(const cl::Buffer& vectors, const cl::Buffer& out) {
        record("transfer.shade", receivers.count, [&](const WaitList& wait) {
            return masks.shade(queue, receivers, vectors, sky.light(), SHADE_CLAMP, out, bad, wait);
        });
    }

    void light() {
        sky.project(record, projection);
        shade(receivers.transfer, irradiance);
    }

    void reflect(const glm::vec3& eye) {
        if (!glossy) return;
        record("transfer.integrate_gloss", receivers.count, [&](const WaitList& wait) {
            return masks.integrate_gloss(queue, receivers, weights, directions, exponents, eye,
                                         lobes, wait);
        });
        shade(lobes, gloss);
    }

    cl::CommandQueue queue;
    const DeviceScene& scene;
    DynamicTransferOptions options;
    bool glossy;
    Vertices vertices;
    MaskPasses masks;
    ReceiverPasses sides;
    TransferPasses projection;
    EnvironmentLight sky;
    mutable Recorder record;
    MaskWeights cells;
    ReceiverBuffers receivers;
    BlockerBuffers blockers;
    cl::Buffer irradiance, gloss, lobes, exponents, other_side, fronts, drawn, weights, directions,
        status, bad;
    std::size_t bytes = 0;
};

DynamicTransferSolver::DynamicTransferSolver(const Programs& programs,
                                             const cl::CommandQueue& queue, const Scene& scene,
                                             const DeviceScene& device,
                                             const DynamicTransferOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, device, options)) {}

DynamicTransferSolver::~DynamicTransferSolver() = default;

void DynamicTransferSolver::lights_changed() {
    if (!state_->sky.update())
        throw Error("dynamic-transfer: more directional lights than before; make another solver");
    state_->record.forget_failed();
}

void DynamicTransferSolver::turn_environment(double angle) { state_->sky.turn(angle); }

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
    state_->record.begin(wait);
    state_->reflect(eye);
    return state_->record.last();
}

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
const BlockerBuffers& DynamicTransferSolver::blockers() const { return state_->blockers; }
const cl::Buffer& DynamicTransferSolver::drawn() const { return state_->drawn; }
const cl::Buffer& DynamicTransferSolver::weights() const { return state_->weights; }
const cl::Buffer& DynamicTransferSolver::directions() const { return state_->directions; }
const cl::Buffer& DynamicTransferSolver::counter() const { return state_->bad; }

}  // namespace clgi
