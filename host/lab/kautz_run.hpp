// A solver on a scene that deforms, frame by frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene_animator.hpp>

#include "lab/bench_kautz.hpp"

namespace clgi::lab {

class KautzRun {
public:
    // looks: frames whose visible sets are taken, where the settings want sets.
    KautzRun(const KautzSetup& setup, const Programs& programs, const Scene& scene,
             std::size_t paper_coarse, const KautzSettings& settings, int looks = 24);

    // One frame, waited for: pose, blockers, masks, integration and the inner product with the
    // light. Milliseconds on the host's clock.
    double frame(double seconds);

    // The same in steps, waited for each: what the pose takes, and the device's passes.
    struct Steps {
        double pose_ms = 0.0;
        std::vector<PassEvent> passes;
    };
    Steps steps(double seconds, const std::optional<glm::dvec3>& eye = {});

    // The transfer vectors of some vertices of the scene after the last frame: [vertices][terms].
    std::vector<double> vectors(const std::vector<std::uint32_t>& vertices) const;

    double duration() const { return animator_.animation().clips[0].duration; }
    std::size_t coarse() const { return coarse_; }
    const DynamicTransferSolver& solver() const { return solver_; }

private:
    DynamicTransferOptions options(const KautzSetup& setup, const Scene& scene, std::size_t coarse,
                                   const KautzSettings& settings);

    cl::CommandQueue queue_;
    std::size_t coarse_ = 0;
    DeviceScene device_;
    SceneAnimator animator_;
    DynamicTransferSolver solver_;
};

}  // namespace clgi::lab
