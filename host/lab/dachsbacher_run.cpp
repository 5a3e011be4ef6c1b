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
constexpr int paper_width = 640, paper_height = 480;

RendererOptions options_of(const DachsbacherSetup& setup, const DachsbacherScene& scene) {
    RendererOptions out;
    out.method = Method::antiradiance;
    out.picture.width = paper_width;
    out.picture.height = paper_height;
    out.picture.build = setup.build;
    out.antiradiance = scene.options();
    return out;
}

}  // namespace

DachsbacherRun::DachsbacherRun(const DachsbacherSetup& setup, const Programs& programs,
                               const DachsbacherScene& scene)
    : lights_(scene.scene.lights),
      camera_(scene.scene.cameras.at(0)),
      device_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(), setup.queue.getInfo<CL_QUEUE_DEVICE>(),
              scene.scene),
      renderer_(programs, setup.queue, scene.scene, device_, options_of(setup, scene)) {
    renderer_.build();
    if (solver().moving_elements() == 0) return;
    animator_.emplace(setup.queue, scene.scene, device_, setup.build);
    duration_ = scene.scene.animation->clips.at(0).duration;
}

void DachsbacherRun::move(double share) {
    const double angle = most_turn * std::sin(2.0 * glm::pi<double>() * share);
    const glm::dquat turn = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
    if (animator_) renderer_.geometry_changed({animator_->animate(0, share * duration_).done});
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        Light light = lights_[i];
        light.direction = glm::normalize(glm::vec3(turn * glm::dvec3(light.direction)));
        device_.set_light(i, light);
    }
    renderer_.lights_changed();
}

DachsbacherRun::Frame DachsbacherRun::frame(double share) {
    Frame out;
    const auto begin = Clock::now();
    move(share);
    renderer_.prepare();
    const auto lit = Clock::now();
    renderer_.render(camera_).wait();
    out.light_ms = milliseconds(lit - begin);
    out.picture_ms = milliseconds(Clock::now() - lit);
    out.passes = solver().events();
    return out;
}

io::Image DachsbacherRun::picture(int across, int down, bool direct) {
    PictureOptions picture = renderer_.options().picture;
    picture.width = across;
    picture.height = down;
    picture.direct = direct;
    renderer_.reconfigure(picture);
    renderer_.render(camera_);
    return radiance_picture(renderer_);
}

}  // namespace clgi::lab
