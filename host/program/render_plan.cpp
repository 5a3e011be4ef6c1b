// SPDX-License-Identifier: MIT
#include "program/render_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/duration.hpp"
#include "program/percent.hpp"
#include "program/plan_text.hpp"

namespace clgi::program {
namespace {

std::string unmet(const Plan& plan) {
    std::string out;
    if (!plan.meets_time)
        out = fmt::format(
            "the least that a picture takes is {:.3g} ms, more than the {:.3g} ms of {}",
            plan.request.animated ? plan.cost.frame_ms : plan.cost.total_ms(),
            1e3 * *plan.request.seconds, plan.request.animated ? "--frame-time" : "--time-budget");
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

PlanRequest plan_request(const RenderFlags& flags) {
    PlanRequest out = request_of("render", flags.plan);
    const PictureOptions& picture = flags.options.picture;
    out.width = picture.width;
    out.height = picture.height;
    if (!flags.ask.target_error.empty())
        out.error = parse_percent("render", "--target-error", flags.ask.target_error);
    if (!flags.ask.time_budget.empty())
        out.seconds = 1e-3 * parse_milliseconds("render", "--time-budget", flags.ask.time_budget);
    if (!flags.ask.frame_time.empty())
        out.seconds = 1e-3 * parse_milliseconds("render", "--frame-time", flags.ask.frame_time);
    out.method = method_of(flags.method);
    out.animated = flags.fps.has_value();
    out.lights_change = flags.spin_light;
    out.camera_moves = flags.orbit;
    for (const OptionRow* row : flags.given) {
        if (row->name == "shadow-size") out.shadow_size = picture.emitters.shadow_size;
        if (row->name == "face-size") out.face_size = picture.emitters.face_size;
        if (row->name == "area-samples") out.area_samples = picture.emitters.area_samples;
    }
    out.build = picture.build;
    return out;
}

std::shared_ptr<const Planned> make_render_plan(const RenderFlags& flags, const Session& session,
                                                const Programs& programs, Scene& scene) {
    auto planned = std::make_shared<Planned>();
    Plan& plan = planned->plan;
    plan = make_plan(session.queue, programs, scene,
                     scene.cameras[static_cast<std::size_t>(flags.camera)], plan_request(flags));
    planned->milliseconds = plan.analysis.milliseconds;
    if (plan.reach) planned->milliseconds += plan.reach->milliseconds;
    if (plan.probe) planned->milliseconds += plan.probe->milliseconds;
    scene = planned_scene(scene, plan);
    notice(flags.device.quiet, "plan: " + plan_line(plan));
    const std::string warning = unmet(plan);
    if (!warning.empty()) notice(false, "warning: " + warning);
    return planned;
}

}  // namespace clgi::program
