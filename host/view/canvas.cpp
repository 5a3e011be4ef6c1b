// SPDX-License-Identifier: MIT
#include "view/canvas.hpp"

#include <chrono>
#include <glm/gtc/constants.hpp>

#include "lab/preview.hpp"

namespace clgi::view {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

Scene subject_of(const Subject& subject, const Shown& shown, const RendererOptions& options,
                 bool moves) {
    Shown still = shown;
    if (moves) still.seconds.reset();
    Scene out = scene_of(subject, still, options.picture.width, options.picture.height);
    if (moves) {
        out.focus.reset();
        if (out.animation) out.moving_bounds = motion_bounds(out, subject.clip);
    }
    return out;
}

}  // namespace

Canvas::Canvas(const Programs& programs, const cl::CommandQueue& queue, const Subject& subject,
               const Shown& shown, const RendererOptions& options, bool moves)
    : shown_(shown),
      clip_(subject.clip),
      scene_(subject_of(subject, shown, options, moves)),
      queue_(queue),
      device_scene_(programs.context(), programs.device(), scene_),
      renderer_(programs, queue_, scene_, device_scene_, options) {
    if (moves && scene_.animation) {
        animator_ = std::make_unique<SceneAnimator>(queue_, scene_, device_scene_);
        if (shown_.seconds) pose();
    }
    renderer_.build();
    scene_ = Scene();  // it is on the device
}

bool Canvas::can_follow(const Shown& shown) const {
    return animator_ || (shown.posed == shown_.posed && shown.set == shown_.set);
}

void Canvas::follow(const Shown& shown) {
    const bool lit = shown.lit != shown_.lit, turned = shown.turn != shown_.turn,
               posed = shown.seconds != shown_.seconds;
    shown_ = shown;
    if (lit)
        for (const auto& [index, light] : shown.lights) device_scene_.set_light(index, light);
    if (turned) {
        device_scene_.turn_environment(glm::radians(shown.turn));
        renderer_.environment_changed();
    }
    if (posed && animator_) pose();
    if (lit) renderer_.lights_changed();
}

void Canvas::pose() {
    const Animated step = animator_->animate(clip_, shown_.seconds.value_or(0.0));
    renderer_.geometry_changed({step.done});
    if (step.lights) renderer_.lights_changed();
}

bool Canvas::prepare(const Progress& progress) {
    const Clock::time_point begin = Clock::now();
    const bool done = renderer_.prepare(progress);
    prepared_ms_ = since(begin);
    return done || renderer_.status().given_up;
}

void Canvas::draw(const Camera& camera) {
    const Clock::time_point begin = Clock::now();
    renderer_.render(camera).wait();
    frame_ms_ = since(begin);
}

void Canvas::refine() { renderer_.refine().wait(); }

Drawn Canvas::drawn() const {
    Drawn out;
    out.shown = shown_;
    out.options = renderer_.options();
    out.options.samples = static_cast<int>(renderer_.samples());
    out.picture = lab::radiance_picture(renderer_);
    out.prepared_ms = prepared_ms_;
    out.frame_ms = frame_ms_;
    out.warnings = renderer_.status().warnings;
    return out;
}

}  // namespace clgi::view
