// clgi plan SCENE: what a picture of it calls for, before anything is rendered.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/clgi.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "program/commands.hpp"
#include "program/duration.hpp"
#include "program/percent.hpp"
#include "program/picture.hpp"
#include "program/plan_request.hpp"
#include "program/plan_text.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"

namespace clgi::program {
namespace {

struct PlanCommand {
    DeviceFlags device;
    PlanFlags plan;
    SceneFlags scene;
    std::string size, method = "auto", target_error, time_budget, frame_time;
    bool animated = false, json = false;
};

PlanRequest request_of(const PlanCommand& flags) {
    PlanRequest out = request_of("plan", flags.plan);
    parse_size("plan", flags.size, 16384, out.width, out.height);
    if (!flags.target_error.empty())
        out.error = parse_percent("plan", "--target-error", flags.target_error);
    if (!flags.time_budget.empty())
        out.seconds = 1e-3 * parse_milliseconds("plan", "--time-budget", flags.time_budget);
    if (flags.animated && !flags.time_budget.empty())
        throw Error("plan: --time-budget is of one picture; with --animated --frame-time needed");
    if (!flags.frame_time.empty() && !flags.animated)
        throw Error("plan: --frame-time goes only with --animated");
    if (!flags.frame_time.empty())
        out.seconds = 1e-3 * parse_milliseconds("plan", "--frame-time", flags.frame_time);
    out.animated = flags.animated;
    out.refined = !flags.animated;
    out.build = build_of(flags.device);
    out.method = method_of(flags.method);
    return out;
}

void run_plan(const PlanCommand& flags) {
    const PlanRequest request = request_of(flags);
    Scene scene = open_scene(flags.scene, flags.device.quiet, true);
    arrange_scene("plan", flags.scene, scene);
    DeviceFlags device = flags.device;
    device.quiet = device.quiet || flags.json;
    const Session session = open_session(device);
    const Programs programs = programs_of(session);
    const Plan plan =
        make_plan(session.queue, programs, scene, camera_of(flags.scene, scene), request);
    if (flags.json)
        fmt::print("{}\n", plan_json(plan).dump(2));
    else
        fmt::print("{}", plan_text(plan));
}

}  // namespace

void add_plan(CLI::App& app) {
    CLI::App* command = app.add_subcommand("plan", "Say what a picture of a scene calls for");
    const auto flags = std::make_shared<PlanCommand>();
    add_scene_flags(*command, flags->scene);
    command->add_option("--size", flags->size, "Of the picture")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", PlanRequest().width, PlanRequest().height));
    add_camera_flags(*command, flags->scene);
    command->add_option("--method", flags->method, "auto: the plan chooses")
        ->type_name("METHOD")
        ->check(CLI::IsMember(
            {"auto", "second-order", "atlas", "transfer", "antiradiance", "cache", "direct"}));
    add_plan_flags(*command, flags->plan);
    command
        ->add_option("--target-error", flags->target_error,
                     "Error against all light that the picture may have: 5% or 0.05")
        ->type_name("E")
        ->default_str("none");
    command
        ->add_option("--time-budget", flags->time_budget,
                     "What a picture may take, with all that is done before it: 100ms or 1s")
        ->type_name("T")
        ->default_str("none");
    command
        ->add_option("--frame-time", flags->frame_time,
                     "With --animated: what a frame may take: 33ms")
        ->type_name("T")
        ->default_str("none");
    command->add_flag("--animated", flags->animated, "Plan for pictures between which things move");
    command->add_flag("--json", flags->json, "Print JSON, with all facts");
    add_device_flags(*command, flags->device);
    command->callback([flags] { run_plan(*flags); });
}

}  // namespace clgi::program
