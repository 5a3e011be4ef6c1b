// SPDX-License-Identifier: MIT
#include "program/environment.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

#include "program/session.hpp"
#include "program/triple.hpp"

namespace clgi::program {
namespace {

// "R,G,B"; nothing where the text is anything else, such as a file's name.
std::optional<glm::vec3> parse_color(const std::string& text) {
    const auto triple = parse_triple(text);
    if (!triple) return std::nullopt;
    const glm::vec3 color(*triple);
    for (int c = 0; c < 3; ++c)
        if (!(color[c] >= 0.0f) || !std::isfinite(color[c]))
            throw Error(fmt::format("--environment is '{}', radiances of at least 0 needed", text));
    return color;
}

Environment load_environment(const std::string& path, bool quiet) {
    io::LoadReport report;
    const io::Image picture = io::load_image(path, &report);
    const io::Image::Channel* planes[3];
    for (int c = 0; c < 3; ++c) {
        planes[c] = picture.find(std::string(1, "RGB"[c]));
        if (!planes[c] || planes[c]->values.size() != planes[0]->values.size())
            throw InputError(path + ": has no channels R, G and B");
    }
    Environment out;
    out.width = picture.width;
    out.height = picture.height;
    // Infinity was read as the largest float, which would drown all else. What overflowed was at
    // least as bright as the brightest of the others.
    constexpr float overflown = std::numeric_limits<float>::max();
    float greatest = 0.0f;
    for (const io::Image::Channel* plane : planes)
        for (const float value : plane->values)
            if (value < overflown) greatest = std::max(greatest, value);
    std::size_t replaced = report.non_finite;
    for (std::size_t i = 0; i < planes[0]->values.size(); ++i) {
        glm::vec3 texel(planes[0]->values[i], planes[1]->values[i], planes[2]->values[i]);
        for (int c = 0; c < 3; ++c) {
            if (texel[c] == overflown) texel[c] = greatest;
            if (texel[c] >= 0.0f) continue;
            texel[c] = 0.0f;
            ++replaced;
        }
        out.texels.push_back(texel);
    }
    if (replaced > 0)
        notice(quiet, fmt::format("warning: {}: {} samples were negative or not finite and were "
                                  "replaced",
                                  path, replaced));
    if (picture.width != 2 * picture.height)
        notice(quiet, fmt::format("warning: {}: is {}x{}; a latitude-longitude picture is twice as "
                                  "wide as high",
                                  path, picture.width, picture.height));
    return out;
}

}  // namespace

void add_environment_flags(CLI::App& command, EnvironmentFlags& flags) {
    CLI::Option* source =
        command.add_option("--environment", flags.source,
                           "Light from all directions: a latitude-longitude picture or one colour");
    source->type_name("FILE|R,G,B")->default_str("none");
    command
        .add_option("--environment-rotation", flags.rotation,
                    "Degrees about +Y, counter-clockwise seen from above")
        ->type_name("D")
        ->check(CLI::Range(-1e6, 1e6))
        ->needs(source);
    command.add_option("--environment-scale", flags.scale, "Multiplies the environment")
        ->type_name("X")
        ->check(CLI::Range(0.0, 1e30))
        ->needs(source);
}

void add_environment(const EnvironmentFlags& flags, Scene& scene, bool quiet) {
    if (flags.source.empty()) return;
    const std::optional<glm::vec3> color = parse_color(flags.source);
    Environment environment = color ? Environment() : load_environment(flags.source, quiet);
    environment.factor = color.value_or(glm::vec3(1.0f)) * static_cast<float>(flags.scale);
    environment.rotation =
        static_cast<float>(std::remainder(flags.rotation, 360.0) * std::numbers::pi / 180.0);
    scene.environment = std::move(environment);
}

}  // namespace clgi::program
