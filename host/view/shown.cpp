// SPDX-License-Identifier: MIT
#include "view/shown.hpp"

#include <fmt/format.h>

#include <clgi/advanced/animation.hpp>
#include <clgi/options.hpp>
#include <clgi/plan.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi::view {
namespace {

std::string text_of(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }
std::string text_of(const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

std::string flags_of(std::size_t index, const Light& light) {
    std::string out;
    const auto add = [&](const char* what, const std::string& value) {
        out += fmt::format(" --light {}:{}={}", index, what, value);
    };
    if (light.kind != Light::Kind::directional) add("position", text_of(light.position));
    if (light.kind != Light::Kind::point) add("direction", text_of(light.direction));
    add("intensity", text_of(light.intensity));
    return out;
}

}  // namespace

Camera camera_of(const Subject& subject, const Shown& shown) {
    const Camera& camera = subject.scene.cameras[subject.camera];
    if (shown.viewpoint) return look_at(camera, shown.viewpoint->eye, shown.viewpoint->target);
    return camera;
}

Scene scene_of(const Subject& subject, const Shown& shown, int width, int height) {
    Scene out =
        shown.seconds
            ? posed(subject.scene, pose_at(*subject.scene.animation, subject.clip, *shown.seconds))
            : subject.scene;
    for (const auto& [index, light] : shown.lights) out.lights[index] = light;
    if (out.environment)
        out.environment->rotation =
            static_cast<float>(glm::radians(std::remainder(subject.turned + shown.turn, 360.0)));
    if (shown.viewpoint)
        out.cameras[subject.camera] =
            look_at(out.cameras[subject.camera], shown.viewpoint->eye, shown.viewpoint->target);
    out.focus = focus_of(out, out.cameras[subject.camera], width, height);
    return out;
}

RendererOptions as_flags(const RendererOptions& options) {
    RendererOptions out;
    out.method = options.method;
    out.picture.width = options.picture.width;
    out.picture.height = options.picture.height;
    const RendererOptions usual = out;
    for (const OptionRow& row : option_table())
        if (row.of(methods_of(out.method)) && row.get(options) != row.get(usual))
            row.set(out, row.get(options));
    return out;
}

std::string command_of(const Subject& subject, const Drawn& drawn) {
    const Shown& shown = drawn.shown;
    const PictureOptions& picture = drawn.options.picture;
    std::string out = "clgi render " + subject.flags;
    if (subject.scene.environment && subject.turned + shown.turn != 0.0)
        out += fmt::format(" --environment-rotation {}", subject.turned + shown.turn);
    if (shown.seconds)
        out += fmt::format(" --animation {} --time {}", subject.clip, *shown.seconds);
    if (shown.viewpoint)
        out += fmt::format(" --eye {} --look-at {}", text_of(shown.viewpoint->eye),
                           text_of(shown.viewpoint->target));
    for (const auto& [index, light] : shown.lights) out += flags_of(index, light);
    out += fmt::format(" --size {}x{} --method {}", picture.width, picture.height,
                       name_of(drawn.options.method));
    RendererOptions usual;
    usual.method = drawn.options.method;
    for (const OptionRow& row : option_table()) {
        if (!row.of(methods_of(usual.method)) || row.get(drawn.options) == row.get(usual)) continue;
        out += " --" + row.name;
        if (row.kind != OptionRow::Kind::toggle) out += " " + row.get(drawn.options);
    }
    return out;
}

}  // namespace clgi::view
