// SPDX-License-Identifier: MIT
#include "program/render_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/duration.hpp"
#include "program/percent.hpp"
#include "program/plan_text.hpp"
#include "program/render_attempt.hpp"

namespace clgi::program {
namespace {

// checked, timed: pictures will be, so that what is expected of them does not matter.
std::string unmet(const Plan& plan, bool checked, bool timed) {
    std::string out;
    if (!timed && !plan.meets_time)
        out = fmt::format(
            "the least that a picture takes is {:.3g} ms, more than the {:.3g} ms of {}",
            plan.request.animated ? plan.cost.frame_ms : plan.cost.total_ms(),
            1e3 * *plan.request.seconds, plan.request.animated ? "--frame-time" : "--time-budget");
    const auto add = [&](const std::string& more) { out += (out.empty() ? "" : "; ") + more; };
    if (!checked && !plan.meets_error && plan.error)
        add(fmt::format("no method is known to reach the error of {:.3g} % in such scenes",
                        100.0 * *plan.request.error));
    else if (!checked && !plan.meets_error)
        add("the error of the method in such scenes is not known");
    for (const Effect effect : plan.unavoidable)
        add(fmt::format("no method that suits can leave out {}: it is rendered", name_of(effect)));
    return out;
}

// The error that pictures are checked for; none where the last picture is not that of the flags.
std::optional<double> checked_target(const RenderFlags& flags, const Plan& plan) {
    return is_still(flags) ? plan.request.error : std::nullopt;
}

// Plans once more where an error is above the target, and may be brought down in the time.
std::optional<Planned> go_on(const cl::Device& device, const Planned& planned,
                             const reference::Estimate& error, double target, double took,
                             double spent) {
    constexpr double nearly = 0.8;   // of the target: a better picture would not be told from it
    constexpr std::size_t most = 4;  // attempts
    const Plan& plan = planned.plan;
    if (error.value < nearly * target || plan.checks.size() + 1 >= most) return std::nullopt;
    std::optional<double> left = plan.request.seconds;
    if (left) *left = std::max(0.0, *left - spent);
    const std::optional<Plan> next =
        next_plan(device, plan, {error.value, 1e3 * took, std::nullopt}, left);
    if (!next) return std::nullopt;
    return Planned{*next, planned.milliseconds};
}

// Where a time is asked for all of a picture, a first one that takes a part of it shows how long
// things take on this machine.
std::optional<double> time_budget(const RenderFlags& flags, const PlanRequest& request) {
    return renders_once(flags) && !request.error ? request.seconds : std::nullopt;
}

// The trial or, where that would leave too little, the only picture, which leaves time for samples.
// left: seconds of the budget behind the plan.
Plan begun(const cl::Device& device, const Plan& plan, double budget, double left) {
    constexpr double share = 0.06;               // of the budget
    constexpr double most = 0.14, alone = 0.35;  // of what is left
    const Plan trial = trial_plan(device, plan, share * budget);
    if (trial.cost.total_ms() <= 1e3 * most * left) return trial;
    return trial_plan(device, plan, alone * left);
}

// Plans for what is left of it: for all of it, or for the part that leaves the least error together
// with samples in the rest.
std::optional<Planned> use_rest(const cl::Device& device, const Planned& planned,
                                const PlanOutcome& found, double left,
                                const std::optional<Sampling>& sampling) {
    constexpr double margin = 0.9, slower = 1.25;  // predictions from one picture to the next
    const Plan& plan = planned.plan;
    const auto next_within = [&](double share) {
        return next_plan(device, plan, found, std::max(0.0, margin * share * left));
    };
    std::optional<Plan> best;
    const std::optional<double> error = error_of(plan, found);
    if (!sampling || !error) {
        best = next_within(1.0);
    } else {
        // Settings err by more in some scenes than where that was measured; samples, as they do
        // here. So finer settings are taken where they are expected to err about as little, unless
        // what they err by is known of this scene.
        const double about = found.doubt && plan.indirect_error ? 1.0 : 1.25;
        double least = error_with_samples(*error, *sampling, left);
        for (const double share : {0.2, 0.35, 0.5, 0.75, 1.0}) {
            const std::optional<Plan> next = next_within(share);
            if (!next || !next->error) continue;
            const double expected = error_with_samples(
                *next->error, *sampling, left - slower * 1e-3 * next->cost.total_ms());
            least = std::min(least, expected);
            if (expected <= about * least) best = next;
        }
    }
    if (!best) return std::nullopt;
    return Planned{*best, planned.milliseconds};
}

bool is_better(const reference::Verification& found,
               const std::optional<reference::Verification>& than) {
    return !than || found.error.value < than->error.value;
}

// The rest of a budget, or half as much as what came before; for an error that is asked for, what
// it takes, within limits, and what costs next to nothing. left: of the time that was asked for.
void refine(RenderAttempt& attempt, std::optional<double> left, std::optional<double> target) {
    constexpr double fine = 2e-3, share = 0.4;  // relative errors; of the target
    // Of the picture's time, all samples together. What samples with the same shadow maps have in
    // common is in no error that they know of.
    constexpr double little = 0.15;
    if (target) {
        const auto within = [&](double seconds) {
            return std::min(seconds, left.value_or(seconds));
        };
        attempt.refine(within(std::max(2.0, 2.0 * attempt.seconds())), 4, share * *target);
        attempt.refine(within(little * attempt.seconds()), 4, 0.0);
    } else if (left)
        attempt.refine(*left, 1, fine);
    else
        attempt.refine(0.5 * attempt.seconds(), 4, fine);
}

std::string missed(double target, const std::optional<reference::Verification>& found) {
    std::string out = fmt::format("the target error of {:.3g} % is not reached", 100.0 * target);
    if (!found) return out + ": the picture was not checked";
    if (found->error.low <= target)
        return out + " for sure: the check, whose paths seldom meet the light, allows for more";
    return out + ": no settings are known that would err less in the time";
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
    out.refined = is_still(flags) && !is_given(flags, "samples");
    for (const OptionRow* row : flags.given) {
        if (row->name == "shadow-size") out.shadow_size = picture.emitters.shadow_size;
        if (row->name == "face-size") out.face_size = picture.emitters.face_size;
        if (row->name == "area-samples") out.area_samples = picture.emitters.area_samples;
    }
    out.build = picture.build;
    return out;
}

void render_planned(const RenderFlags& flags, const Session& session, const Programs& programs,
                    const Scene& scene) {
    const PlanRequest request = plan_request(flags);
    const std::optional<double> budget = time_budget(flags, request);
    Planned first;
    first.plan = make_plan(session.queue, programs, scene, camera_of(flags.scene, scene), request);
    const std::optional<double> target = checked_target(flags, first.plan);
    const std::string warning = unmet(first.plan, target.has_value(), budget.has_value());
    first.milliseconds = first.plan.analysis.milliseconds;
    if (first.plan.reach) first.milliseconds += first.plan.reach->milliseconds;
    if (first.plan.probe) first.milliseconds += first.plan.probe->milliseconds;
    double spent = budget ? 1e-3 * first.milliseconds : 0.0;  // of a budget, with the plan
    constexpr double least = 0.01;                            // of a budget, whatever the plan took
    if (budget)
        first.plan =
            begun(session.device, first.plan, *budget, std::max(*budget - spent, least * *budget));
    if (!warning.empty()) notice(false, "warning: " + warning);
    catch_interrupts();

    std::vector<RenderedAttempt> attempts;
    std::unique_ptr<RenderAttempt> best;
    std::optional<Planned> next = first;
    bool found = false;
    double each = 0.0;  // seconds of a sample of the same method, where one is known
    while (next) {
        const auto planned = std::make_shared<const Planned>(*next);
        const Plan& plan = planned->plan;
        next.reset();
        notice(flags.device.quiet, "plan: " + plan_line(plan));
        RendererOptions options = plan;
        options.animated = flags.options.animated;
        options.clip = flags.options.clip;
        options.transfer.coarse = flags.options.transfer.coarse;
        options.samples = flags.options.samples;
        std::unique_ptr<RenderAttempt> attempt;
        try {
            attempt = std::make_unique<RenderAttempt>(flags, session, programs, nullptr,
                                                      planned_scene(scene, plan), options, planned);
            attempt->expect_samples(each);
            attempt->draw();
        } catch (const Interrupted&) {
            if (!best) throw;
            break;
        } catch (const DeviceError& error) {
            if (!best) throw;
            notice(false, fmt::format("warning: another picture failed: {}", error.what()));
            break;
        }
        spent += attempt->seconds();
        if (budget) {
            constexpr double looking = 0.1;      // of the budget, at what samples bring
            constexpr std::uint32_t enough = 6;  // of them
            if (attempt->seconds() <= *budget - spent)
                attempt->refine(looking * *budget, 2, 0.0, enough);
            next = use_rest(session.device, *planned, attempt->outcome(),
                            *budget - spent - attempt->refining(), attempt->sampling());
            if (next) spent += attempt->refining();
            const auto sampling = attempt->sampling();
            const bool alike = next && sampling && next->plan.method == plan.method;
            each = alike ? sampling->seconds : 0.0;
        }
        if (!next) {
            refine(*attempt,
                   budget || (target && request.seconds)
                       ? std::optional<double>(*request.seconds - spent)
                       : std::nullopt,
                   target);
            spent += attempt->refining();
        }
        if (target || (flags.verify.on && !next)) attempt->check(scene, target.value_or(0.0));
        const auto& verified = attempt->record().verified;
        attempts.push_back({plan_settings(plan), error_of(plan, attempt->outcome()), verified,
                            attempt->seconds(), attempt->record().refine_ms});
        found = target && verified && verified->error.high <= *target;
        if (target && verified && !found && !interrupted())
            next = go_on(session.device, *planned, verified->error, *target, attempt->seconds(),
                         spent);
        if (!best || budget || found || (verified && is_better(*verified, best->record().verified)))
            best = std::move(attempt);
    }
    // What is known to miss the target is told as exactly as what meets it.
    if (target && !found && !interrupted()) {
        best->check_fully(scene);
        const auto& verified = best->record().verified;
        found = verified && verified->error.high <= *target;
    }
    if (!target && !budget) attempts.clear();
    if (target && !found) notice(false, "warning: " + missed(*target, best->record().verified));
    if (budget && spent > *budget)
        notice(false, fmt::format("warning: {:.3g} s of the {:.3g} s of --time-budget were used",
                                  spent, *budget));
    best->finish(attempts, found || !target, budget ? std::optional<double>(spent) : std::nullopt);
    if ((target || budget || flags.verify.on) && interrupted()) throw Interrupted();
}

}  // namespace clgi::program
