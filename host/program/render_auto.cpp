// clgi render --method auto: plans, and hands the settings to the method of the plan.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "program/bake_common.hpp"
#include "program/duration.hpp"
#include "program/motion.hpp"
#include "program/percent.hpp"
#include "program/plan_text.hpp"
#include "program/render_flags.hpp"

namespace clgi::program {
namespace {

PlanRequest request_of(const RenderFlags& flags) {
    PlanRequest out = request_of("render", flags.plan);
    out.width = flags.options.width;
    out.height = flags.options.height;
    if (!flags.ask.target_error.empty())
        out.error = parse_percent("render", "--target-error", flags.ask.target_error);
    if (!flags.ask.time_budget.empty())
        out.seconds = 1e-3 * parse_milliseconds("render", "--time-budget", flags.ask.time_budget);
    out.animated = flags.fps.has_value();
    out.lights_change = flags.spin_light;
    out.camera_moves = flags.orbit;
    const EmitterOptions& emitters = flags.options.emitters;
    if (flags.shadow_size_given) out.shadow_size = emitters.shadow_size;
    if (flags.face_size_given) out.face_size = emitters.face_size;
    if (flags.area_samples_given) out.area_samples = emitters.area_samples;
    out.build = build_of(flags.device);
    return out;
}

void take_settings(RenderFlags& flags, const Plan& plan) {
    flags.method = name_of(plan.method);
    EmitterOptions& emitters = flags.options.emitters;
    emitters.shadows = plan.picture.emitters.shadows;
    emitters.shadow_size = plan.picture.emitters.shadow_size;
    emitters.face_size = plan.picture.emitters.face_size;
    emitters.area_samples = plan.picture.emitters.area_samples;
    EmitterOptions& baked = flags.atlas.bake.emitters;
    baked.shadows = plan.light_atlas.emitters.shadows;
    baked.shadow_size = plan.light_atlas.emitters.shadow_size;
    baked.face_size = plan.light_atlas.emitters.face_size;
    baked.area_samples = plan.light_atlas.emitters.area_samples;
    switch (plan.method) {
        case Method::direct:
            break;
        case Method::second_order:
            emitters.shadows = plan.second_order.emitters.shadows;
            emitters.vpls = plan.second_order.emitters.vpls;
            flags.options.negative_vpls = plan.second_order.negative_vpls;
            break;
        case Method::light_atlas:
            flags.atlas.vpls = plan.vpls;
            flags.atlas.layout = plan.layout;
            flags.atlas.bake.bounces = plan.light_atlas.bounces;
            flags.atlas.bake.occlusion = plan.light_atlas.occlusion;
            break;
        case Method::antiradiance: {
            AntiradianceOptions& to = flags.antiradiance.solver;
            to.bins = plan.antiradiance.bins;
            to.steps = plan.antiradiance.steps;
            to.least_gloss = plan.antiradiance.least_gloss;
            to.occlusion = plan.antiradiance.occlusion;
            flags.antiradiance.elements = static_cast<int>(plan.antiradiance.elements.requested);
            break;
        }
        case Method::dynamic_transfer:
            flags.transfer.solver.shadowed = plan.transfer.shadowed;
            flags.transfer.solver.gloss = plan.transfer.gloss;
            flags.transfer.solver.bounces = plan.transfer.bounces;
            break;
    }
}

std::string unmet(const Plan& plan) {
    std::string out;
    if (!plan.meets_time)
        out = fmt::format(
            "the least that a picture takes is {:.3g} ms, more than the {:.3g} ms of "
            "--time-budget",
            plan.request.animated ? plan.cost.frame_ms : plan.cost.total_ms(),
            1e3 * *plan.request.seconds);
    const auto add = [&](const std::string& more) { out += (out.empty() ? "" : "; ") + more; };
    if (!plan.meets_error && plan.error)
        add(fmt::format("no method is known to reach the error of {:.3g} % in such scenes",
                        100.0 * *plan.request.error));
    else if (!plan.meets_error)
        add("the error of the method in such scenes is not known");
    for (const Effect effect : plan.unavoidable)
        add(fmt::format("no method that suits can leave out {}: it is rendered", name_of(effect)));
    return out;
}

}  // namespace

Scene scene_of(const RenderFlags& flags, bool lightmaps) {
    if (flags.planned) return std::move(flags.planned->scene);
    return open_scene(flags.scene, flags.scene_index, flags.environment, flags.device.quiet,
                      lightmaps);
}

Session session_of(const RenderFlags& flags) {
    return flags.planned ? flags.planned->session : open_session(flags.device);
}

void plan_render(RenderFlags& flags) {
    check_picture("render", flags.picture, flags.options.width, flags.options.height);
    const PlanRequest request = request_of(flags);
    flags.ask = AskFlags();
    const bool quiet = flags.device.quiet;
    Scene scene = open_scene(flags.scene, flags.scene_index, flags.environment, quiet, true);
    check_camera("render", flags.camera, scene);
    prepare_motion(flags, scene);
    if (!flags.fps) flags.animation = AnimationFlags();  // the scene is in its pose

    flags.planned = std::make_shared<Planned>();
    Planned& planned = *flags.planned;
    planned.session = open_session(flags.device);
    planned.plan =
        make_plan(planned.session.queue, Programs(planned.session.context, planned.session.device),
                  scene, scene.cameras[static_cast<std::size_t>(flags.camera)], request);
    planned.milliseconds = planned.plan.analysis.milliseconds;
    if (planned.plan.probe) planned.milliseconds += planned.plan.probe->milliseconds;
    planned.scene = planned_scene(scene, planned.plan);
    take_settings(flags, planned.plan);
    notice(quiet, "plan: " + plan_line(planned.plan));
    const std::string warning = unmet(planned.plan);
    if (!warning.empty()) notice(false, "warning: " + warning);
}

}  // namespace clgi::program
