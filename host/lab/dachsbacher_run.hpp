// Antiradiance in a scene whose light moves, frame by frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <clgi/renderer.hpp>
#include <clgi/scene_animator.hpp>
#include <optional>

#include "lab/bench_dachsbacher.hpp"

namespace clgi::lab {

class DachsbacherRun {
public:
    DachsbacherRun(const DachsbacherSetup& setup, const Programs& programs,
                   const DachsbacherScene& scene);

    struct Frame {
        double light_ms = 0.0;          // the light moves, until the light of all leaves is there
        double picture_ms = 0.0;        // after that
        std::vector<PassEvent> passes;  // of the light
    };
    // One frame, waited for, on the host's clock. share: of the way of the light, which ends where
    // it begins; at 0 it is the scene's own.
    Frame frame(double share);

    // A picture of the light of the last frame, without or with direct light. Later frames are like
    // it.
    io::Image picture(int width, int height, bool direct);

    const AntiradianceSolver& solver() const { return *renderer_.antiradiance(); }

private:
    // What changes from frame to frame: lights, and geometry where the scene has a clip.
    void move(double share);

    std::vector<Light> lights_;
    Camera camera_;
    DeviceScene device_;
    Renderer renderer_;
    std::optional<SceneAnimator> animator_;  // where geometry moves
    double duration_ = 0.0;                  // seconds, of its clip
};

}  // namespace clgi::lab
