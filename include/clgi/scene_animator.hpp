// Plays the animation of a scene on the device: nodes, skins and morph targets at a time become
// positions and normals, and a SceneMover brings them into the scene.
//
// The host samples the curves and multiplies matrices, some microseconds; vertices never leave the
// device. Scene::moving_bounds (motion_bounds) gives the local frame that suits the whole motion.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/animation.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/scene_mover.hpp>
#include <memory>

namespace clgi {

// What a step changed.
struct Animated {
    cl::Event done;       // whatever draws the scene must wait for it
    bool lights = false;  // lights or emissive triangles moved: solvers need lights_changed()
};

// Scene and animator are used by one thread at a time; the device scene must outlive it.
class CLGI_API SceneAnimator {
public:
    // scene: what `device` was made from, with animation; it is not needed afterwards.
    // Throws Error for a scene without animation, DeviceError if the device has no room.
    SceneAnimator(const cl::CommandQueue& queue, const Scene& scene, DeviceScene& device,
                  const BuildOptions& options = {});

    // With kernels that others share.
    SceneAnimator(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
                  DeviceScene& device, const BuildOptions& options = {});
    ~SceneAnimator();

    SceneAnimator(const SceneAnimator&) = delete;
    SceneAnimator& operator=(const SceneAnimator&) = delete;

    // Enqueues the pose of a clip `seconds` after its start (see pose_at) and sets the lights that
    // nodes carry. `wait` must cover whatever still reads the scene: the event of the last frame.
    // Waits for nothing, but for emissive triangles, whose corners are read back. The host may be
    // any number of steps ahead: the matrices and weights of each stay in memory until the device
    // has read them. Throws DeviceError if a step cannot be enqueued.
    Animated animate(std::size_t clip, double seconds, const WaitList& wait = {});

    // The same for any pose, of an engine's own mixer for example.
    Animated show(const Pose& pose, const WaitList& wait = {});

    // Nodes, clips, lights and cameras of the animation; its vertices are on the device alone.
    const Animation& animation() const;

    // All cameras of the scene, where the last pose puts them.
    const std::vector<Camera>& cameras() const;

    // Whether vertices left the local frame, or had numbers that are not finite and stayed.
    MoveStatus status();

    std::size_t bytes() const;  // on the device

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
