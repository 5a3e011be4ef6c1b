// Visible sets of a scene's vertices, of frames of its clip.              [Kautz04, section 3.2]
// SPDX-License-Identifier: MIT
#include <clgi/scene_mover.hpp>
#include <optional>

#include "lab/sweep_transfer.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {

// In a scene of its own on the device: the other stays in the pose that is measured. Both have the
// same order of triangles, as they are made of the same pose.
TransferLooks look_at_frames(const cl::CommandQueue& queue, const Programs& programs,
                             const Scene& scene, const TransferSweep& motion,
                             const DynamicTransferOptions& options, int frames,
                             const std::function<void()>& step) {
    DeviceScene device(queue.getInfo<CL_QUEUE_CONTEXT>(), queue.getInfo<CL_QUEUE_DEVICE>(), scene);
    DynamicTransferSolver solver(programs, queue, scene, device, options);
    solver.look().wait();  // builds the kernel
    solver.sets();
    std::optional<SceneMover> mover;
    if (motion.animated) mover.emplace(queue, device, options.build);
    TransferLooks out;
    for (int frame = 0; frame < frames; ++frame) {
        step();
        if (mover) {
            const Animation& animation = *motion.animated->animation;
            const double seconds = animation.clips.at(motion.clip).duration * frame / frames;
            const Scene now = posed(*motion.animated, pose_at(animation, motion.clip, seconds));
            mover->move(0, now.positions, now.normals).wait();
        }
        out.milliseconds += time_frame(queue, [&] { solver.look(); });
    }
    out.milliseconds += time_frame(queue, [&] { out.sets = solver.sets(); });
    return out;
}

}  // namespace clgi::lab
