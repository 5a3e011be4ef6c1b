// SPDX-License-Identifier: MIT
#include "program/render_attempt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clgi/advanced/static_scene.hpp>
#include <cmath>
#include <span>
#include <utility>

#include "core/kit/pass_timing.hpp"
#include "lab/preview.hpp"
#include "lab/replicates.hpp"
#include "lab/timing.hpp"
#include "program/duration.hpp"
#include "program/percent.hpp"

namespace clgi::program {
namespace {

// With more in its first line.
std::string with_check(std::string text, const RenderRecord& record) {
    std::string more;
    if (record.samples > 1) more = fmt::format(", {} samples", record.samples);
    if (record.refine_ms > 0.0) more += fmt::format(" in {:.3g} ms more", record.refine_ms);
    if (record.verified)
        more += ", " + verify_line(*record.verified);
    else if (record.expected_error)
        more += fmt::format(", error about {} %", about_percent(*record.expected_error));
    return text.insert(std::min(text.find('\n'), text.size()), more);
}

bool go_on(double) { return !interrupted(); }

}  // namespace

bool renders_once(const RenderFlags& flags) {
    const bool asks = !flags.ask.time_budget.empty() ||
                      (flags.method == "auto" && !flags.ask.target_error.empty());
    return asks && flags.frames == 1 && !flags.fps;
}

bool is_still(const RenderFlags& flags) {
    return flags.frames == 1 && !flags.fps && !flags.orbit && !flags.spin_light &&
           flags.replicates < 2 && flags.gbuffer == "cl";
}

RenderAttempt::RenderAttempt(const RenderFlags& flags, const Session& session,
                             const Programs& programs, GlFrames* gl, Scene scene,
                             const RendererOptions& options, std::shared_ptr<const Planned> planned)
    : flags_(flags),
      session_(session),
      gl_(gl),
      options_(options),
      scene_(std::move(scene)),
      device_scene_(session.context, session.device, scene_),
      renderer_(programs, session.queue, scene_, device_scene_, options_),
      motion_(flags, programs, session.queue, scene_, device_scene_),
      camera_(camera_of(flags.scene, scene_)),
      last_camera_(camera_),
      moves_(flags.fps && moves(scene_)) {
    record_.planned = std::move(planned);
    renderer_.build(is_still(flags_));
    if (gl_) gl_->open(session_.queue, renderer_);
    record_.build_ms = 1e3 * watch_.seconds();
    for (const std::string& warning : renderer_.status().warnings)
        notice(flags_.device.quiet, "warning: " + warning);
}

void RenderAttempt::draw() {
    const bool planned = record_.planned != nullptr;
    const TuningTarget target = planned ? TuningTarget() : request_of("render", flags_.ask);
    warm_up();
    if (target.frame_ms || target.error) tune(target);
    for (int frame = 0; frame < flags_.frames; ++frame) render(frame);
    const IrradianceCache* cache = renderer_.irradiance_cache();
    if (planned && cache && !flags_.fps) doubt_ = cache->doubt();
    if (flags_.replicates > 1) {
        record_.replicates = lab::replicate(renderer_, camera_, flags_.replicates, go_on);
        if (!record_.replicates) throw Interrupted();
        picture_ = record_.replicates->mean;
    } else if (!flags_.fps) {
        picture_ = lab::radiance_picture(renderer_);
    }
}

// The first picture is not timed: some drivers compile on the first launch.
void RenderAttempt::warm_up() {
    if (flags_.fps) follow(motion_.at(0), true);  // builds its kernels; links are made for poses
    const Stopwatch watch;
    const auto bar = progress_bar(options_.method == Method::light_atlas ? "bake" : "render",
                                  flags_.device.quiet);
    if (gl_) {
        gl_->render(renderer_, camera_).wait();
        if (!bar(1.0)) throw Interrupted();
        return;
    }
    prepare(bar);
    record_.prepare_ms = 1e3 * watch.seconds();
    if (renders_once(flags_)) return;
    if (!renderer_.run(camera_, bar) && !gave_up()) throw Interrupted();
}

void RenderAttempt::prepare(const Progress& progress) {
    if (!renderer_.prepare(progress) && !gave_up()) throw Interrupted();
}

void RenderAttempt::follow(const Motion::Step& step, bool vectors) {
    if (step.lights) renderer_.lights_changed();
    if (moves_ || (vectors && options_.method == Method::dynamic_transfer))
        renderer_.geometry_changed();
}

void RenderAttempt::refine(double seconds, std::uint32_t least, double error, std::uint32_t most) {
    if (!is_still(flags_) || is_given(flags_, "samples")) return;
    const double limit = 1e3 * seconds;
    double& spent = record_.refine_ms;
    constexpr double unknown = 0.25;  // of the picture, before the first
    std::uint32_t looked = 2;         // at the error
    while (renderer_.samples() < most && !interrupted()) {
        const double next = spent > 0.0
                                ? next_sample({back(1), back(2), back(4)}, refined_, 1e3 * known_)
                                : 1e3 * unknown * this->seconds();
        if (renderer_.samples() >= least && spent + next >= limit) break;
        if (error > 0.0 && renderer_.samples() >= std::max(least, 2 * looked)) {
            looked = renderer_.samples();
            if (renderer_.sampling_error() <= error) break;
        }
        const double taken = time_apart([&] { renderer_.refine(); });
        refine_ms_[turn_] = taken;
        turn_ = (turn_ + 1) % 4;
        ++refined_;
        spent += taken;
    }
    picture_ = lab::radiance_picture(renderer_);
}

double RenderAttempt::time_apart(const std::function<void()>& draw) {
    const std::size_t before = renderer_.times().size();
    const double all = lab::time_frame(session_.queue, draw);
    const std::span<const PassEvent> passes = renderer_.times();  // some are of what came before
    const double out = timing::without_compiling(session_.queue, all,
                                                 passes.subspan(std::min(before, passes.size())));
    record_.build_ms += all - out;
    return out;
}

PlanOutcome RenderAttempt::outcome() const {
    PlanOutcome out;
    out.took_ms = 1e3 * seconds();
    out.doubt = doubt_;
    return out;
}

// Of the plan, and of samples that are too few for edges, textures and lobes.
std::optional<double> RenderAttempt::expected_error() const {
    if (!record_.planned || flags_.fps) return std::nullopt;
    Plan plan = record_.planned->plan;
    plan.request.refined = renderer_.samples() > 1;
    const std::optional<double> out = error_of(plan, outcome());
    if (!out || renderer_.samples() < 2) return out;
    return std::hypot(*out, renderer_.sampling_error());
}

std::optional<Sampling> RenderAttempt::sampling() const {
    if (!(record_.refine_ms > 0.0)) return std::nullopt;
    return Sampling{renderer_.sampling_error(), static_cast<double>(renderer_.samples()),
                    1e-3 * time_each({back(1), back(2), back(3), back(4)}, refined_)};
}

// A frame's time has all in it that follows from the lights and the pose: of a bake, only what has
// changed.
void RenderAttempt::render(int frame) {
    const bool always = options_.method != Method::light_atlas && !renders_once(flags_);
    const auto draw = [&] {
        const Motion::Step step = motion_.at(frame);
        last_camera_ = step.camera;
        if (!renders_once(flags_)) follow(step, flags_.fps || frame == 0);
        if (always || step.lights) prepare(go_on);
        if (gl_)
            gl_->render(renderer_, step.camera);
        else
            renderer_.render(step.camera);
    };
    record_.frame_ms.push_back(renders_once(flags_) ? time_apart(draw)
                                                    : lab::time_frame(session_.queue, draw));
    if (AntiradianceSolver* solver = renderer_.antiradiance())
        exchanges_.add(frame, solver->status(), solver->options());
    record_.passes.push_back(lab::pass_times(renderer_.times()));
    if (flags_.fps) save_picture(lab::radiance_picture(renderer_), numbered(flags_.picture, frame));
    if (interrupted()) throw Interrupted();
}

void RenderAttempt::tune(const TuningTarget& target) {
    SecondOrderSolver& solver = *renderer_.second_order();
    const auto found =
        tune_second_order(session_.queue, renderer_.scene(), solver, camera_, target, go_on);
    if (!found || !solver.run(camera_, nullptr)) throw Interrupted();
    record_.ask = AskRecord{target, *found};
}

double RenderAttempt::seconds() const {
    return 1e-3 * (record_.prepare_ms + lab::spread(record_.frame_ms).median);
}

double RenderAttempt::check_limit() const {
    constexpr double least = 4.0, share = 2.0;  // seconds, and of the picture's
    return flags_.verify.time.empty()
               ? std::max(least, share * seconds())
               : 1e-3 * parse_milliseconds("render", "--verify", flags_.verify.time);
}

void RenderAttempt::check_fully(const Scene& truth) {
    constexpr double nearly = 0.7;
    const auto before = record_.verified;
    if (!before || traced_ > nearly * check_limit()) return;
    check(truth, 0.0, flags_.verify.time.empty() ? std::optional(check_limit()) : std::nullopt);
    if (!record_.verified) record_.verified = before;
}

void RenderAttempt::check(const Scene& truth, double decide, std::optional<double> seconds) {
    const double spent = 1e-3 * record_.build_ms + this->seconds();
    if (decide > 0.0 && flags_.verify.time.empty()) seconds = check_limit();
    record_.verified =
        verify(truth, flags_.verify, spent,
               [&](const reference::PathTracer& tracer, reference::VerifyOptions options) {
                   options.decide = decide;
                   options.filter =
                       renderer_.samples() > 1 ? reference::Filter::box : reference::Filter::center;
                   if (seconds) options.seconds = *seconds;
                   const reference::Verification found = tracer.verify(
                       last_camera_, picture_.width, picture_.height, lab::radiance_of(picture_),
                       options, progress_bar("verify", flags_.device.quiet));
                   traced_ = found.seconds;
                   return found;
               });
}

void RenderAttempt::finish(const std::vector<RenderedAttempt>& attempts, bool meets_target,
                           std::optional<double> used) {
    if (record_.verified) add_verified(picture_, *record_.verified);
    picture_.attributes["clgi:samples"] = std::to_string(renderer_.samples());
    picture_.attributes["clgi:filter"] = renderer_.samples() > 1 ? "box" : "center";
    if (!flags_.fps) save_picture(picture_, flags_.picture);
    motion_.report();
    record_.attempts = attempts;
    record_.meets_target = meets_target;
    record_.budget_used = used;
    tell();
}

// What is wrong with the picture, besides what the scene's warnings say.
void RenderAttempt::warn() {
    record_.expected_error = expected_error();
    if (record_.verified && record_.planned) {
        const std::string less = expected_less(record_.expected_error, *record_.verified);
        if (!less.empty()) {
            record_.warnings.push_back(less);
            notice(false, "warning: " + less);
        }
    }
    fill(record_, renderer_, scene_);
    for (const std::string& warning : troubles(renderer_, exchanges_))
        notice(false, "warning: " + warning);
    if (!gl_) return;
    notice(flags_.device.quiet, fmt::format("OpenGL {}; {}", gl_->renderer(), gl_->path()));
    if (renderer_.scene().info().flags & SCENE_HAS_DETAIL)
        notice(false, "warning: OpenGL's view is without normal and metallic-roughness textures");
    if (const std::uint32_t texels = gl_->non_finite())
        notice(false, fmt::format("warning: {} texels of the G-buffer were not finite and became "
                                  "background",
                                  texels));
}

void RenderAttempt::tell() {
    record_.device = session_.device;
    record_.bytes = renderer_.bytes_with_scene() + motion_.bytes();
    record_.gbuffer = flags_.gbuffer;
    record_.exchanges = exchanges_;
    record_.warnings = scene_.warnings;
    if (gl_) {
        record_.gl_renderer = gl_->renderer();
        record_.gl_path = gl_->path();
    }
    warn();
    if (record_.ask) {
        const std::string warning = ask_warning(*record_.ask);
        if (!warning.empty()) notice(false, warning);
    }
    if (!flags_.device.quiet)
        fmt::print("{}: {}\n", names_of(flags_.picture),
                   with_check(summary(record_, renderer_), record_));
    if (!flags_.stats.empty()) save_stats(record_, flags_.stats);
}

}  // namespace clgi::program
