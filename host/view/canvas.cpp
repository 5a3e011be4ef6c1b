// SPDX-License-Identifier: MIT
#include "view/canvas.hpp"

#include <chrono>
#include <clgi/plan.hpp>
#include <glm/gtc/constants.hpp>

#include "lab/preview.hpp"

namespace clgi::view {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

Scene canvas_scene(const Subject& subject, const Shown& shown, const RendererOptions& options,
                   bool moves) {
    Shown as_made = shown;
    if (moves) as_made.seconds.reset();
    Scene out = scene_of(subject, as_made);
    if (moves && out.animation)
        out.moving_bounds = motion_bounds(out, subject.clip);
    else if (!moves)
        out.focus = focus_of(out, out.cameras[subject.camera], options.picture.width,
                             options.picture.height);
    return out;
}

}  // namespace

Canvas::Canvas(const Programs& programs, const cl::CommandQueue& queue, const Subject& subject,
               const Shown& shown, const RendererOptions& options, bool moves)
    : shown_(shown),
      clip_(subject.clip),
      camera_index_(subject.camera),
      uploaded_turn_(shown.turn),
      queue_(queue),
      scene_(canvas_scene(subject, shown, options, moves)),
      camera_(scene_.cameras[subject.camera]),
      focus_(scene_.focus),
      device_scene_(programs.context(), programs.device(), scene_),
      renderer_(programs, queue_, scene_, device_scene_, options) {
    if (moves && scene_.animation) {
        animator_ = std::make_unique<SceneAnimator>(programs, queue_, scene_, device_scene_);
        if (shown.seconds) pose(shown);
    }
    renderer_.build();
    scene_ = Scene();  // it is on the device
}

bool Canvas::can_follow(const Shown& shown) const {
    return animator_ || (shown.posed == shown_.posed && shown.set == shown_.set);
}

void Canvas::follow(const Shown& shown) {
    if (animator_ && shown.seconds != shown_.seconds) pose(shown);
    if (shown.lit != shown_.lit) {
        for (const auto& [index, light] : shown.lights) device_scene_.set_light(index, light);
        renderer_.lights_changed();
    }
    if (shown.turn != shown_.turn) {
        device_scene_.turn_environment(glm::radians(shown.turn - uploaded_turn_));
        renderer_.environment_changed();
    }
    shown_ = shown;
}

// Lights that were moved by hand stay where they are.
void Canvas::pose(const Shown& shown) {
    const Animated step = animator_->animate(clip_, shown.seconds.value_or(0.0));
    camera_ = animator_->cameras()[camera_index_];
    renderer_.geometry_changed({step.done});
    if (!step.lights) return;
    for (const auto& [index, light] : shown.lights) device_scene_.set_light(index, light);
    renderer_.lights_changed();
}

bool Canvas::suits(const std::optional<Focus>& focus) const {
    if (focus.has_value() != focus_.has_value()) return false;
    if (!focus) return true;
    const double ratio = focus->radius / focus_->radius;
    return ratio < 1.5 && ratio > 1.0 / 1.5 &&
           glm::length(focus->centre - focus_->centre) < 0.25 * focus_->radius;
}

bool Canvas::prepare(const Progress& progress) {
    const Clock::time_point begin = Clock::now();
    const bool done = renderer_.prepare(progress);
    prepared_ms_ = since(begin);
    return done || renderer_.status().given_up;
}

void Canvas::draw() {
    drawn_from_ = camera_;
    if (shown_.viewpoint)
        drawn_from_ = look_at(camera_, shown_.viewpoint->eye, shown_.viewpoint->target);
    const bool first = frame_ms_ == 0.0;
    time_frame();
    // A first frame builds kernels: how long it takes says nothing of those to come.
    if (first && serves_cameras() && !is_quick()) time_frame();
}

void Canvas::time_frame() {
    const Clock::time_point begin = Clock::now();
    renderer_.render(drawn_from_).wait();
    frame_ms_ = since(begin);
}

void Canvas::refine() { renderer_.refine().wait(); }

Drawn Canvas::drawn() const {
    Drawn out;
    out.shown = shown_;
    out.options = renderer_.options();
    out.options.samples = static_cast<int>(renderer_.samples());
    out.picture = lab::radiance_picture(renderer_);
    out.camera = drawn_from_;
    out.lights = device_scene_.lights();
    out.prepared_ms = prepared_ms_;
    out.frame_ms = frame_ms_;
    out.warnings = renderer_.status().warnings;
    return out;
}

}  // namespace clgi::view
