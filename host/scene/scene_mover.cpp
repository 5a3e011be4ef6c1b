// SPDX-License-Identifier: MIT
#include <clgi/scene_mover.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <cstring>
#include <string>

#include "core/opencl/error_text.hpp"
#include "scene/local_frame.hpp"

namespace clgi {
namespace {

constexpr double farthest_place = 1e18;  // metres, as validate() has it

// What OpenCL throws becomes a DeviceError that says what was being done.
template <typename Work>
auto on_device(const char* what, Work&& work) {
    try {
        return work();
    } catch (const cl::Error& error) {
        throw DeviceError("scene mover: " + std::string(what) + ": " + error_text(error.err()));
    }
}

cl::Context context_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_CONTEXT>(); }
cl::Device device_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_DEVICE>(); }

// A copy of `values` on the device, never empty.
cl::Buffer upload(const cl::CommandQueue& queue, std::vector<std::uint32_t> values) {
    if (values.empty()) values.resize(1);
    return on_device("no room for the order of vertices", [&] {
        return cl::Buffer(context_of(queue), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                          values.size() * sizeof(std::uint32_t), values.data());
    });
}

bool is_box(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.low[axis] <= box.high[axis]) || !(std::abs(box.low[axis]) <= farthest_place) ||
            !(std::abs(box.high[axis]) <= farthest_place))
            return false;
    return true;
}

}  // namespace

SceneMover::SceneMover(const cl::CommandQueue& queue, DeviceScene& scene,
                       const BuildOptions& options)
    : SceneMover(Programs(context_of(queue), device_of(queue)), queue, scene, options) {}

SceneMover::SceneMover(const Programs& programs, const cl::CommandQueue& queue, DeviceScene& scene,
                       const BuildOptions& options)
    : queue_(queue),
      scene_(scene),
      passes_(programs, options),
      vertex_order_(upload(queue, scene.vertex_order())),
      status_(upload(queue, std::vector<std::uint32_t>(MOVE_STATUS_WORDS))) {}

// Waiting for what has failed would fail again.
const WaitList& SceneMover::pending() {
    const auto failed = [](const cl::Event& event) {
        return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() < 0;
    };
    last_.erase(std::remove_if(last_.begin(), last_.end(), failed), last_.end());
    return last_;
}

void SceneMover::check(std::uint32_t first, std::size_t count,
                       const std::optional<Bounds>& refit) const {
    const std::size_t all = scene_.file_vertex_count();
    if (first > all || count > all - first)
        throw Error("scene mover: vertices " + std::to_string(first) + " to " +
                    std::to_string(first + count) + " were to move, there are " +
                    std::to_string(all));
    if (!refit) return;
    if (count != all)
        throw Error("scene mover: a refit with " + std::to_string(count) + " vertices, all " +
                    std::to_string(all) + " needed");
    if (!is_box(*refit))
        throw Error(
            "scene mover: the box to refit to has low above high, or corners that are not "
            "within 1e18 m");
}

cl::Event SceneMover::enqueue(const MoveParams& params, const cl::Buffer& positions,
                              const cl::Buffer& normals, const WaitList& wait) {
    WaitList before = pending();
    before.insert(before.end(), wait.begin(), wait.end());
    const cl::Event moved =
        passes_.move(queue_, params, scene_, {vertex_order_, positions, normals, status_}, before);
    last_.assign(1, moved);
    last_.assign(1, passes_.clusters(queue_, scene_, {moved}));
    for (std::size_t level = scene_.node_levels().size() - 1; level-- > 0;)
        last_.assign(1, passes_.nodes(queue_, scene_, level, last_));
    return last_.front();
}

// The exposure stays: it is in the materials, and changes no bit of a picture.
void SceneMover::refit(const Bounds& box) {
    const double exposure = scene_.frame_.exposure;
    if (scene_.info_.triangle_count > 0) scene_.frame_ = local_frame(box);
    scene_.frame_.exposure = exposure;
}

void SceneMover::read_emissive(std::uint32_t first, std::size_t count) {
    std::uint32_t low = scene_.info_.vertex_count, high = 0;
    for (const DeviceScene::Glowing& glowing : scene_.glowing_)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = glowing.vertex[k];
            const std::uint32_t place = scene_.vertex_order_[vertex];
            if (place < first || place - first >= count) continue;
            low = std::min(low, vertex);
            high = std::max(high, vertex);
        }
    if (low > high) return;
    std::vector<glm::vec4> positions(high - low + 1);
    on_device("emissive triangles cannot be read", [&] {
        queue_.enqueueReadBuffer(scene_.positions(), CL_TRUE, low * sizeof(glm::vec4),
                                 positions.size() * sizeof(glm::vec4), positions.data(), &last_);
    });
    for (DeviceScene::Glowing& glowing : scene_.glowing_)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = glowing.vertex[k];
            if (vertex >= low && vertex <= high)
                glowing.corner[k] = glm::vec3(positions[vertex - low]);
        }
    scene_.list_emissive();
}

cl::Event SceneMover::move(const MovedVertices& vertices, const WaitList& wait) {
    check(vertices.first, vertices.count, vertices.refit);
    const SceneFrame before = scene_.frame_;
    if (vertices.refit) refit(*vertices.refit);
    try {
        MoveParams params = move_params(scene_, vertices.first, vertices.count, vertices.origin);
        if (!vertices.normals()) params.flags &= ~std::uint32_t{MOVE_NORMALS};
        enqueue(params, vertices.positions, vertices.normals, wait);
    } catch (...) {
        scene_.frame_ = before;
        throw;
    }
    read_emissive(vertices.first, vertices.count);
    return last_.front();
}

cl::Event SceneMover::move(std::uint32_t first, const std::vector<glm::dvec3>& positions,
                           const std::vector<glm::vec3>& normals, bool refit_frame,
                           const WaitList& wait) {
    if (!normals.empty() && normals.size() != positions.size())
        throw Error("scene mover: there are " + std::to_string(normals.size()) + " normals, " +
                    std::to_string(positions.size()) + " or none needed");
    std::optional<Bounds> box;
    if (refit_frame && positions.size() == scene_.file_vertex_count() &&
        !scene_.vertex_order_.empty()) {
        const glm::dvec3& any = positions[scene_.vertex_order_[0]];
        box = Bounds{any, any};
        for (const std::uint32_t vertex : scene_.vertex_order_)
            for (int axis = 0; axis < 3; ++axis) {
                const double p = positions[vertex][axis];
                if (!std::isfinite(p))
                    throw InputError("scene mover: position " + std::to_string(vertex) +
                                     " is not finite, and the frame is to be refitted");
                box->low[axis] = std::min(box->low[axis], p);
                box->high[axis] = std::max(box->high[axis], p);
            }
    } else if (refit_frame) {
        box = Bounds{};
    }
    check(first, positions.size(), box);
    SceneFrame frame = scene_.frame_;
    if (box && scene_.info_.triangle_count > 0) frame = local_frame(*box);

    // In the local frame already; the kernel copies them.
    std::vector<glm::vec4> local, turned;
    for (const glm::dvec3& position : positions) local.emplace_back(frame.to_local(position), 0.0f);
    for (const glm::vec3& normal : normals) turned.emplace_back(normal, 0.0f);
    const auto stage = [&](cl::Buffer& buffer, const std::vector<glm::vec4>& values) {
        if (values.empty()) return;
        const std::size_t bytes = values.size() * sizeof(glm::vec4);
        if (!buffer() || buffer.getInfo<CL_MEM_SIZE>() < bytes)
            buffer = cl::Buffer(context_of(queue_), CL_MEM_READ_ONLY, bytes);
        queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, values.data(), &pending());
    };
    on_device("vertices cannot be written", [&] {
        stage(staged_positions_, local);
        stage(staged_normals_, turned);
    });
    MoveParams params = move_params(scene_, first, static_cast<std::uint32_t>(positions.size()));
    std::fill(params.frame_origin, params.frame_origin + 8, 0u);
    params.exponent = 0;
    params.low = glm::vec4(reached(frame).low, 0.0f);
    params.high = glm::vec4(reached(frame).high, 0.0f);
    if (normals.empty()) params.flags &= ~std::uint32_t{MOVE_NORMALS};
    enqueue(params, staged_positions_, staged_normals_, wait);
    if (box) refit(*box);
    read_emissive(first, positions.size());
    return last_.front();
}

MoveStatus SceneMover::status() {
    std::uint32_t words[MOVE_STATUS_WORDS] = {};
    on_device("the status cannot be read", [&] {
        queue_.enqueueReadBuffer(status_, CL_TRUE, 0, sizeof words, words, &pending());
        cl::Event cleared;
        queue_.enqueueFillBuffer(status_, std::uint32_t{0}, 0, sizeof words, &last_, &cleared);
        last_.assign(1, cleared);
    });
    float square = 0.0f;
    std::memcpy(&square, &words[MOVE_FARTHEST], sizeof square);
    MoveStatus out;
    out.not_finite = words[MOVE_NOT_FINITE];
    out.farthest = std::sqrt(double{square}) / scene_.frame_.scale;
    out.fits = words[MOVE_LEFT] == 0;
    return out;
}

}  // namespace clgi
