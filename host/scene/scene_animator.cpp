// SPDX-License-Identifier: MIT
#include <clgi/scene_animator.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <deque>
#include <string>

#include "core/opencl/error_text.hpp"
#include "scene/carried.hpp"
#include "scene/pose_buffers.hpp"
#include "scene/range_matrices.hpp"

namespace clgi {
namespace {

// Rows of the map to metres from an origin.
PoseMatrix relative(const glm::dmat4& matrix, const glm::dvec3& origin) {
    PoseMatrix out;
    for (int row = 0; row < 3; ++row)
        out.row[row] = glm::vec4(glm::dvec4(matrix[0][row], matrix[1][row], matrix[2][row],
                                            matrix[3][row] - origin[row]));
    return out;
}

bool emits(const Scene& scene, const PosedRange& range) {
    const Part& part = scene.parts[range.part];
    for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
        const SceneTriangle& triangle = scene.triangles[part.first_triangle + t];
        if (scene.materials[triangle.material].emission != glm::vec3(0.0f)) return true;
    }
    return false;
}

bool emits(const Scene& scene) {
    const std::vector<PosedRange>& ranges = scene.animation->ranges;
    return std::any_of(ranges.begin(), ranges.end(),
                       [&](const PosedRange& range) { return emits(scene, range); });
}

const Scene& with_animation(const Scene& scene, const DeviceScene& device) {
    if (!scene.animation) throw Error("scene animator: the scene has no animation");
    if (scene.positions.size() != device.file_vertex_count() ||
        scene.lights.size() != device.lights().size())
        throw Error("scene animator: the scene on the device is another one");
    return scene;
}

}  // namespace

struct SceneAnimator::State {
    // Numbers on their way to the device, until it has them.
    struct Staged {
        std::vector<PoseMatrix> matrices;
        std::vector<float> weights;
        cl::Event written;
    };

    State(const Programs& programs, const cl::CommandQueue& q, const Scene& scene,
          DeviceScene& target, const BuildOptions& options)
        : queue(q),
          device(target),
          mover(programs, q, target, options),
          passes(programs, options),
          data(upload_poses(q, scene, target.frame().origin)),
          animation(small_parts(*scene.animation)),
          lights(scene.lights),
          cameras(scene.cameras),
          emission_moves(emits(scene)) {}

    // What the host needs from frame to frame.
    static Animation small_parts(const Animation& all) {
        Animation out;
        out.nodes = all.nodes;
        out.weights = all.weights;
        out.clips = all.clips;
        out.skins = all.skins;
        out.ranges = all.ranges;
        out.lights = all.lights;
        out.cameras = all.cameras;
        return out;
    }

    void stage(const Pose& pose);
    cl::Event move(const Pose& pose, const WaitList& wait);

    cl::CommandQueue queue;
    DeviceScene& device;
    SceneMover mover;
    ScenePasses passes;
    PoseData data;
    Animation animation;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    bool emission_moves = false;
    std::deque<Staged> staged;
    WaitList last;  // the end of the last step
};

// Writes matrices and weights without waiting for them.
void SceneAnimator::State::stage(const Pose& pose) {
    const auto status = [](const cl::Event& event) {
        return event() ? event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() : CL_COMPLETE;
    };
    while (!staged.empty() && status(staged.front().written) <= CL_COMPLETE) staged.pop_front();
    Staged& next = staged.emplace_back();
    for (const PosedRange& range : animation.ranges)
        for (const glm::dmat4& matrix : range_matrices(animation, range, pose))
            next.matrices.push_back(relative(matrix, data.origin));
    next.weights.assign(pose.weights.begin(), pose.weights.end());
    // Waiting for what has failed would fail again.
    last.erase(std::remove_if(last.begin(), last.end(),
                              [&](const cl::Event& event) { return status(event) < 0; }),
               last.end());
    const auto write = [&](const cl::Buffer& to, const auto& values) {
        if (values.empty()) return;
        queue.enqueueWriteBuffer(to, CL_FALSE, 0, values.size() * sizeof(values[0]), values.data(),
                                 &last, &next.written);
        last.assign(1, next.written);
    };
    write(data.buffers.weights, next.weights);
    write(data.buffers.matrices, next.matrices);
}

// What fails on the way does not matter to the next step: it waits for all that was enqueued.
cl::Event SceneAnimator::State::move(const Pose& pose, const WaitList& wait) {
    stage(pose);
    last.assign(1, passes.pose(queue, data.params, data.buffers, last));
    if (data.params.triangle_count > 0)
        last.assign(1, passes.flatten(queue, data.params, data.buffers, last));
    WaitList before = wait;
    before.insert(before.end(), last.begin(), last.end());
    MovedVertices moved;
    moved.first = data.first;
    moved.count = data.params.given_count;
    moved.positions = data.buffers.positions;
    moved.normals = data.buffers.normals;
    moved.origin = data.origin;
    try {
        last.assign(1, mover.move(moved, before));
    } catch (...) {
        // A part of it may read the positions already. Without a marker, the first error counts.
        cl::Event all;
        if (clEnqueueMarkerWithWaitList(queue(), 0, nullptr, &all()) == CL_SUCCESS)
            last.assign(1, all);
        throw;
    }
    return last.front();
}

SceneAnimator::SceneAnimator(const cl::CommandQueue& queue, const Scene& scene, DeviceScene& device,
                             const BuildOptions& options)
    : SceneAnimator(Programs(queue.getInfo<CL_QUEUE_CONTEXT>(), queue.getInfo<CL_QUEUE_DEVICE>()),
                    queue, scene, device, options) {}

SceneAnimator::SceneAnimator(const Programs& programs, const cl::CommandQueue& queue,
                             const Scene& scene, DeviceScene& device, const BuildOptions& options)
    : state_(std::make_unique<State>(programs, queue, with_animation(scene, device), device,
                                     options)) {}

// The driver may still read what was staged.
SceneAnimator::~SceneAnimator() {
    for (const State::Staged& staged : state_->staged) {
        try {
            if (staged.written()) staged.written.wait();
        } catch (const cl::Error&) {  // a failed write reads no more
        }
    }
}

Animated SceneAnimator::animate(std::size_t clip, double seconds, const WaitList& wait) {
    return show(pose_at(state_->animation, clip, seconds), wait);
}

Animated SceneAnimator::show(const Pose& pose, const WaitList& wait) {
    State& state = *state_;
    const Animation& animation = state.animation;
    if (pose.matrices.size() != animation.nodes.size() ||
        pose.weights.size() != animation.weights.size())
        throw Error("scene animator: the pose has " + std::to_string(pose.matrices.size()) +
                    " matrices and " + std::to_string(pose.weights.size()) + " weights, " +
                    std::to_string(animation.nodes.size()) + " and " +
                    std::to_string(animation.weights.size()) + " needed");
    Animated out;
    try {
        if (animation.ranges.empty()) {
            state.queue.enqueueMarkerWithWaitList(&wait, &out.done);
        } else {
            out.done = state.move(pose, wait);
            out.lights = state.emission_moves;
        }
    } catch (const cl::Error& error) {
        throw DeviceError("scene animator: a pose cannot be shown: " + error_text(error.err()));
    }
    for (const Carried& light : animation.lights) {
        Light& moved = state.lights[light.index];
        carry(pose.matrices[light.node], moved);
        state.device.set_light(light.index, moved);
        out.lights = true;
    }
    for (const Carried& camera : animation.cameras)
        carry(pose.matrices[camera.node], state.cameras[camera.index]);
    return out;
}

const Animation& SceneAnimator::animation() const { return state_->animation; }
const std::vector<Camera>& SceneAnimator::cameras() const { return state_->cameras; }
MoveStatus SceneAnimator::status() { return state_->mover.status(); }
std::size_t SceneAnimator::bytes() const { return state_->data.bytes; }

}  // namespace clgi
