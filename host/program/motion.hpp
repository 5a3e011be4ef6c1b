// What moves over the frames of a render: the camera around the scene, the lights about the
// vertical, and whatever the scene's animation moves.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene_animator.hpp>
#include <memory>
#include <string>

#include "program/render_flags.hpp"

namespace clgi::program {

// Poses the scene, or with --fps gives it bounds that suit the whole motion.
void prepare_motion(const RenderFlags& flags, Scene& scene);

class Motion {
public:
    // scene: what `device` was made from.
    Motion(const RenderFlags& flags, const Programs& programs, const cl::CommandQueue& queue,
           const Scene& scene, DeviceScene& device);

    // What a frame is to be drawn with; its pose is enqueued on the queue, which is in order.
    struct Step {
        Camera camera;
        bool lights = false;  // solvers need lights_changed()
    };
    Step at(int frame);

    // Prints a warning if vertices left the bounds or were not finite.
    void report();

    std::size_t bytes() const { return animator_ ? animator_->bytes() : 0; }

private:
    void spin_lights(double angle);

    const RenderFlags& flags_;
    DeviceScene& device_;
    std::vector<Light> lights_;
    Camera camera_;
    glm::dvec3 centre_;
    std::size_t clip_ = 0;
    std::unique_ptr<SceneAnimator> animator_;  // with --fps
};

// The files of one frame: out.exr becomes out.0007.exr.
PictureFlags numbered(const PictureFlags& flags, int frame);

}  // namespace clgi::program
