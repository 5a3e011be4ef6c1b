// SPDX-License-Identifier: MIT
#include <clgi/advanced/antiradiance_view.hpp>
#include <clgi/advanced/light_atlas_view.hpp>
#include <clgi/advanced/static_bake.hpp>
#include <clgi/advanced/tuning.hpp>
#include <clgi/renderer.hpp>

#include "plan/static_part.hpp"

namespace clgi {
namespace {

struct Atlas {
    Atlas(const Programs& programs, const cl::CommandQueue& queue, const BakeLayout& layout,
          const DeviceScene& device, const Plan& plan)
        : solver(programs, queue, device, layout.vpls, layout.atlas, plan.light_atlas),
          view(programs, queue, device, layout.atlas, plan.picture) {}

    // still: what stands still of the scene, on the device.
    Atlas(const Programs& programs, const cl::CommandQueue& queue, const StaticBake& bake,
          std::unique_ptr<DeviceScene> static_scene, const DeviceScene& device, const Plan& plan)
        : apart(std::move(static_scene)),
          solver(programs, queue, *apart, bake.layout.vpls, bake.layout.atlas, plan.light_atlas,
                 points_of(bake.volume)),
          view(programs, queue, device, bake.whole, plan.picture, bake.volume) {}

    void lights_changed(const DeviceScene& device) {
        if (apart) apart->set_lights(device.lights());
    }

    std::unique_ptr<DeviceScene> apart;  // none: the scene itself is baked
    LightAtlasSolver solver;
    LightAtlasView view;
};

std::unique_ptr<Atlas> make_atlas_of(const Programs& programs, const cl::CommandQueue& queue,
                                     const Scene& scene, const DeviceScene& device,
                                     const Plan& plan) {
    if (!bakes_static_part(plan))
        return std::make_unique<Atlas>(
            programs, queue, make_bake_layout(scene, plan.vpls, plan.layout), device, plan);
    const StaticBake bake = make_static_bake(scene, plan.vpls, plan.layout);
    return std::make_unique<Atlas>(
        programs, queue, bake,
        std::make_unique<DeviceScene>(queue.getInfo<CL_QUEUE_CONTEXT>(),
                                      queue.getInfo<CL_QUEUE_DEVICE>(), bake.static_scene.scene),
        device, plan);
}

// A solver, and what shows its light.
template <typename Solver, typename View>
struct Shown {
    template <typename SolverOptions, typename ViewOptions>
    Shown(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
          const DeviceScene& device, const SolverOptions& options, const ViewOptions& shown)
        : solver(programs, queue, scene, device, options),
          view(programs, queue, device, solver, shown) {}

    Solver solver;
    View view;
};
using Elements = Shown<AntiradianceSolver, AntiradianceView>;
using Transfer = Shown<DynamicTransferSolver, DynamicTransferView>;

}  // namespace

// Of the method of the plan; the others are empty.
struct PlannedRenderer::State {
    cl::CommandQueue queue;
    const DeviceScene& scene;
    Plan plan;
    std::unique_ptr<SecondOrderSolver> second_order;
    std::unique_ptr<Atlas> atlas;
    std::unique_ptr<Elements> elements;
    std::unique_ptr<Transfer> transfer;

    const Picture& picture() const {
        if (atlas) return atlas->view.picture();
        if (elements) return elements->view.picture();
        return transfer->view.picture();
    }
};

PlannedRenderer::PlannedRenderer(const Programs& programs, const cl::CommandQueue& queue,
                                 const Scene& scene, const DeviceScene& device_scene,
                                 const Plan& plan)
    : state_(new State{queue, device_scene, plan, nullptr, nullptr, nullptr, nullptr}) {
    State& s = *state_;
    switch (plan.method) {
        case Method::direct:
        case Method::second_order:
            s.second_order = std::make_unique<SecondOrderSolver>(programs, queue, device_scene,
                                                                 plan.second_order);
            break;
        case Method::light_atlas:
            s.atlas = make_atlas_of(programs, queue, scene, device_scene, plan);
            break;
        case Method::antiradiance:
            s.elements = std::make_unique<Elements>(programs, queue, scene, device_scene,
                                                    plan.antiradiance, plan.picture);
            break;
        case Method::dynamic_transfer:
            s.transfer = std::make_unique<Transfer>(programs, queue, scene, device_scene,
                                                    plan.transfer, plan.transfer_view);
            break;
    }
}

PlannedRenderer::~PlannedRenderer() = default;

bool PlannedRenderer::prepare(const Progress& progress) {
    State& s = *state_;
    if (s.atlas) return s.atlas->solver.run(progress);
    if (s.elements) return s.elements->solver.run(progress);
    if (s.transfer) return s.transfer->solver.run(progress);
    return !progress || progress(1.0);
}

bool PlannedRenderer::tune(const Camera& camera, const Progress& progress) {
    State& s = *state_;
    if (s.plan.method != Method::second_order || !s.plan.second_order.indirect ||
        !s.plan.request.seconds)
        return !progress || progress(1.0);
    TuningTarget request;
    request.frame_ms = 1e3 * *s.plan.request.seconds;
    const auto found =
        tune_second_order(s.queue, s.scene, *s.second_order, camera, request, progress);
    if (!found) return false;
    s.plan.second_order = s.second_order->options();
    s.plan.cost.frame_ms = found->frame_ms;
    s.plan.meets_time = found->meets_time;
    return true;
}

void PlannedRenderer::lights_changed() {
    State& s = *state_;
    if (s.second_order) s.second_order->lights_changed();
    if (s.atlas) s.atlas->lights_changed(s.scene);
    const auto tell = [](auto& shown) {
        if (!shown) return;
        shown->solver.lights_changed();
        shown->view.lights_changed();
    };
    tell(s.atlas);
    tell(s.elements);
    tell(s.transfer);
}

cl::Event PlannedRenderer::render(const Camera& camera, const WaitList& wait) {
    State& s = *state_;
    if (s.second_order) return s.second_order->render(camera, wait);
    if (s.atlas)
        return s.atlas->view.render(camera, s.atlas->solver.irradiance_planes(),
                                    s.atlas->solver.stride(), wait);
    if (s.elements) return s.elements->view.render(camera, wait);
    return s.transfer->view.render(camera, wait);
}

std::uint32_t PlannedRenderer::non_finite() const {
    const State& s = *state_;
    if (s.second_order) return s.second_order->status().non_finite;
    std::uint32_t before = 0;
    if (s.atlas) before = s.atlas->solver.status().non_finite;
    if (s.elements) before = s.elements->solver.status().non_finite;
    if (s.transfer) before = s.transfer->solver.status().non_finite;
    return before + s.picture().non_finite();
}

std::vector<PassEvent> PlannedRenderer::events() const {
    const State& s = *state_;
    if (s.second_order) return s.second_order->events();
    std::vector<PassEvent> out;
    const auto add = [&](const std::vector<PassEvent>& events) {
        out.insert(out.end(), events.begin(), events.end());
    };
    if (s.atlas) add(s.atlas->solver.events());
    if (s.elements) add(s.elements->solver.events());
    if (s.transfer) add(s.transfer->solver.events());
    add(s.picture().events());
    return out;
}

std::size_t PlannedRenderer::bytes() const {
    const State& s = *state_;
    if (s.second_order) return s.second_order->bytes();
    if (s.atlas)
        return s.atlas->solver.bytes() + s.atlas->view.picture().bytes() +
               (s.atlas->apart ? s.atlas->apart->bytes() : 0);
    if (s.elements) return s.elements->solver.bytes() + s.elements->view.bytes();
    return s.transfer->solver.bytes() + s.transfer->view.bytes();
}

std::uint32_t PlannedRenderer::stride() const {
    return state_->second_order ? state_->second_order->stride() : state_->picture().stride();
}

const cl::Buffer& PlannedRenderer::radiance() const {
    return state_->second_order ? state_->second_order->radiance() : state_->picture().radiance();
}

const Plan& PlannedRenderer::plan() const { return state_->plan; }

}  // namespace clgi
