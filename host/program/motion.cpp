// SPDX-License-Identifier: MIT
#include "program/motion.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace clgi::program {
namespace {

glm::dmat4 about_the_vertical(double angle) {
    return glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0));
}

glm::vec3 turned(const glm::dmat4& turn, const glm::vec3& v) {
    return glm::vec3(turn * glm::dvec4(glm::dvec3(v), 0.0));
}

Camera orbited(const Camera& camera, const glm::dvec3& centre, double angle) {
    const glm::dmat4 turn = about_the_vertical(angle);
    Camera out = camera;
    out.position = centre + glm::dvec3(turn * glm::dvec4(camera.position - centre, 0.0));
    out.right = turned(turn, camera.right);
    out.up = turned(turn, camera.up);
    out.forward = turned(turn, camera.forward);
    return out;
}

}  // namespace

void prepare_motion(const RenderFlags& flags, Scene& scene) {
    if (!flags.fps) return arrange_scene("render", flags.scene, scene);
    // Frame times must be finite, and apart from each other.
    if (!(*flags.fps >= 1e-3 && *flags.fps <= 1e6))
        throw Error(fmt::format("render: --fps is {}, 0.001 to 1000000 needed", *flags.fps));
    if (flags.gbuffer != "cl")
        throw Error("render: --fps goes not with --gbuffer gl, which draws the scene as loaded");
    if (flags.replicates > 1) throw Error("render: --fps goes not with --replicates; --time does");
    if (flags.method == "second-order" && !flags.ask.target_error.empty())
        throw Error("render: --fps goes not with --target-error of second-order; --time does");
    if (flags.method == "second-order" && !flags.ask.frame_time.empty())
        throw Error("render: --fps goes with --frame-time of --method auto alone");
    if (!flags.scene.eye.empty() || !flags.scene.target.empty() || !flags.scene.lights.empty())
        throw Error("render: --eye, --look-at and --light go not with --fps");
    place_scene("render", flags.scene, scene);
    const std::size_t clip = clip_of("render", scene, flags.scene.animation);
    scene.moving_bounds = motion_bounds(scene, clip);
}

Motion::Motion(const RenderFlags& flags, const Programs& programs, const cl::CommandQueue& queue,
               const Scene& scene, DeviceScene& device)
    : flags_(flags),
      device_(device),
      lights_(scene.lights),
      camera_(camera_of(flags.scene, scene)) {
    const Bounds box = bounds(scene);
    centre_ = 0.5 * (box.low + box.high);
    if (!flags.fps) return;
    clip_ = clip_of("render", scene, flags.scene.animation);
    animator_ =
        std::make_unique<SceneAnimator>(programs, queue, scene, device, build_of(flags.device));
}

void Motion::spin_lights(double angle) {
    const glm::dmat4 turn = about_the_vertical(angle);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        Light light = lights_[i];
        light.direction = turned(turn, light.direction);
        device_.set_light(i, light);
    }
}

Motion::Step Motion::at(int frame) {
    const double angle = glm::two_pi<double>() * frame / flags_.frames;
    Step step;
    step.camera = camera_;
    if (animator_) {
        const double seconds = flags_.scene.animation.time.value_or(0.0) + frame / *flags_.fps;
        step.lights = animator_->animate(clip_, seconds).lights;
        step.camera = animator_->cameras()[static_cast<std::size_t>(flags_.scene.camera)];
        for (const Carried& light : animator_->animation().lights)
            lights_[light.index] = device_.lights()[light.index];
    }
    if (flags_.spin_light) {
        spin_lights(angle);
        step.lights = true;
    }
    if (flags_.orbit) step.camera = orbited(step.camera, centre_, angle);
    return step;
}

void Motion::report() {
    if (!animator_ || animator_->animation().ranges.empty()) return;
    const MoveStatus status = animator_->status();
    if (status.not_finite > 0)
        notice(false, fmt::format("warning: {} vertices stayed in place: their pose was not finite",
                                  status.not_finite));
    if (!status.fits)
        notice(false,
               "warning: vertices left the bounds of the animation; what is lit there by "
               "directional lights may be wrong");
}

PictureFlags numbered(const PictureFlags& flags, int frame) {
    const auto name = [&](const std::string& file) {
        if (file.empty()) return file;
        const std::filesystem::path path(file);
        std::filesystem::path out = path.parent_path() / path.stem();
        out += fmt::format(".{:04}", frame);
        out += path.extension();
        return out.string();
    };
    PictureFlags out = flags;
    out.exr = name(flags.exr);
    out.png = name(flags.png);
    return out;
}

}  // namespace clgi::program
