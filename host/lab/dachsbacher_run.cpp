// SPDX-License-Identifier: MIT
#include "lab/dachsbacher_run.hpp"

#include <chrono>
#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "lab/preview.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr double most_turn = 0.08;  // radians, of the light to either side
constexpr int width = 640, height = 480;

AntiradianceOptions with_build(AntiradianceOptions options, const BuildOptions& build) {
    options.build = build;
    return options;
}

}  // namespace

DachsbacherRun::DachsbacherRun(const DachsbacherSetup& setup, const Programs& programs,
                               const DachsbacherScene& scene)
    : setup_(setup),
      programs_(programs),
      lights_(scene.scene.lights),
      camera_(scene.scene.cameras.at(0)),
      device_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(), setup.queue.getInfo<CL_QUEUE_DEVICE>(),
              scene.scene),
      solver_(programs, setup.queue, scene.scene, device_,
              with_build(scene.options(), setup.build)),
      view_(programs, setup.queue, device_, solver_, picture_options(width, height, true)) {
    if (solver_.moving_elements() == 0) return;
    animator_.emplace(setup.queue, scene.scene, device_, setup.build);
    duration_ = scene.scene.animation->clips.at(0).duration;
}

PictureOptions DachsbacherRun::picture_options(int across, int down, bool direct) const {
    PictureOptions out;
    out.width = across;
    out.height = down;
    out.direct = direct;
    out.build = setup_.build;
    return out;
}

void DachsbacherRun::move(double share) {
    const double angle = most_turn * std::sin(2.0 * glm::pi<double>() * share);
    const glm::dquat turn = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
    if (animator_) solver_.geometry_changed({animator_->animate(0, share * duration_).done});
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        Light light = lights_[i];
        light.direction = glm::normalize(glm::vec3(turn * glm::dvec3(light.direction)));
        device_.set_light(i, light);
    }
    solver_.lights_changed();
    view_.lights_changed();
}

DachsbacherRun::Frame DachsbacherRun::frame(double share) {
    Frame out;
    const auto begin = Clock::now();
    move(share);
    solver_.run();
    const auto lit = Clock::now();
    view_.render(camera_).wait();
    out.light_ms = milliseconds(lit - begin);
    out.picture_ms = milliseconds(Clock::now() - lit);
    out.passes = solver_.events();
    return out;
}

io::Image DachsbacherRun::picture(int across, int down, bool direct) {
    AntiradianceView view(programs_, setup_.queue, device_, solver_,
                          picture_options(across, down, direct));
    view.render(camera_).wait();
    return radiance_picture(setup_.queue, view.picture());
}

}  // namespace clgi::lab
