// Renders by a plan, whatever its method.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/plan.hpp>
#include <clgi/programs.hpp>
#include <memory>

namespace clgi {

// Pictures of geometry that stands still, and with PlanRequest::animated of what moves on the
// device (SceneAnimator), where the method needs nothing for it: direct, second order and the
// atlas, whose bake is then of what stands still. For other methods what moves is for their own
// solvers, with the settings of the plan. Owns its buffers, works on the given queue, never
// finishes it. The device scene must outlive this object. One thread at a time.
class CLGI_API PlannedRenderer {
public:
    // Builds kernels and allocates, for what the plan has and nothing else. scene: planned_scene(),
    // from which `device_scene` was made; it is not needed afterwards. Throws what the solvers do.
    PlannedRenderer(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
                    const DeviceScene& device_scene, const Plan& plan);
    ~PlannedRenderer();
    PlannedRenderer(const PlannedRenderer&) = delete;
    PlannedRenderer& operator=(const PlannedRenderer&) = delete;

    // What is done before the first picture: a bake, an exchange, transfer vectors. Waits. False if
    // progress cancelled.
    bool prepare(const Progress& progress = nullptr);

    // Second order in a plan with a time: tunes its settings to that time (plan/tuning.hpp), in
    // place of those that were predicted to take it, and plan() then has them with the time that
    // was measured; its error stays that of the predicted settings. Does nothing for other plans.
    // Waits. False if progress cancelled.
    bool tune(const Camera& camera, const Progress& progress = nullptr);

    // Reads the scene's lights again, after DeviceScene::set_light; prepare() follows.
    void lights_changed();

    // Enqueues a picture that begins after `wait`; its event completes when all of it has.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // Waits for the last picture: numbers that were not finite and were replaced.
    std::uint32_t non_finite() const;

    std::vector<PassEvent> events() const;  // of what was done before and the last picture
    std::size_t bytes() const;              // allocated
    std::uint32_t stride() const;           // floats between planes
    const cl::Buffer& radiance() const;     // [RADIANCE_PLANES][stride] cd/m^2
    const Plan& plan() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
