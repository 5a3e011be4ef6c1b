// SPDX-License-Identifier: MIT
#include "view/shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <clgi/advanced/animation.hpp>
#include <clgi/options.hpp>
#include <cmath>
#include <cstring>
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

// Options of the method that are not at their defaults.
std::vector<const OptionRow*> unusual(const RendererOptions& options) {
    RendererOptions usual;
    usual.method = options.method;
    std::vector<const OptionRow*> out;
    for (const OptionRow& row : option_table()) {
        // --low-res off is a step of 1.
        if (row.name == "low-res-step" && options.second_order.low_resolution_step == 1) continue;
        if (row.of(methods_of(options.method)) && row.get(options) != row.get(usual))
            out.push_back(&row);
    }
    return out;
}

}  // namespace

Scene scene_of(const Subject& subject, const Shown& shown) {
    Scene out = subject.scene;
    if (shown.seconds && out.animation)
        out = posed(out, pose_at(*out.animation, subject.clip, *shown.seconds));
    for (const auto& [index, light] : shown.lights) out.lights[index] = light;
    if (out.environment)
        out.environment->rotation =
            static_cast<float>(glm::radians(std::remainder(subject.turned + shown.turn, 360.0)));
    Camera& camera = out.cameras[subject.camera];
    if (shown.viewpoint) camera = look_at(camera, shown.viewpoint->eye, shown.viewpoint->target);
    return out;
}

RendererOptions as_flags(const RendererOptions& options) {
    RendererOptions out;
    out.method = options.method;
    out.picture.width = options.picture.width;
    out.picture.height = options.picture.height;
    for (const OptionRow* row : unusual(options)) row->set(out, row->get(options));
    return out;
}

RendererOptions preview_options() {
    RendererOptions out;
    out.method = Method::second_order;
    for (const auto& [name, value] : {std::pair("vpls", "100"),
                                      {"negative-vpls", "30"},
                                      {"low-res", "0.05"},
                                      {"area-samples", "4"},
                                      {"environment-lights", "8"},
                                      {"shadow-size", "256"},
                                      {"face-size", "64"}})
        set_option(out, name, value);
    return out;
}

std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || std::strchr("_./:=,+@%-", c);
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
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
    for (const OptionRow* row : unusual(drawn.options)) {
        out += " --" + row->name;
        if (row->kind != OptionRow::Kind::toggle) out += " " + row->get(drawn.options);
    }
    return out;
}

}  // namespace clgi::view
