// SPDX-License-Identifier: MIT
#include "lab/contact_sheet.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "lab/preview.hpp"

namespace clgi::lab {
namespace {

std::string time_text(double milliseconds) {
    return milliseconds < 999.5 ? fmt::format("{:.3g} ms", milliseconds)
                                : fmt::format("{:.3g} s", 1e-3 * milliseconds);
}

std::array<std::string, 2> caption_of(const SweepPoint& point) {
    std::string cost = time_text(point.milliseconds) + " a frame";
    if (point.once_milliseconds) cost += ", " + time_text(*point.once_milliseconds) + " once";
    const auto samples = point.knobs.find("spp");
    if (samples != point.knobs.end()) cost += ", " + samples->second + " samples a pixel";
    return {fmt::format("{}: error {:.1f} %", point.method, 100.0 * point.error.front()), cost};
}

}  // namespace

const SweepPoint* shown_point(const Sweep& sweep, const std::string& method, double milliseconds) {
    const auto error = [](const SweepPoint& point) {
        const double value = point.error.front();
        return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    };
    const SweepPoint *best = nullptr, *fastest = nullptr;
    for (const SweepPoint& point : sweep.points) {
        if (point.method != method || point.given_up) continue;
        if (method == path_tracer_name && point.series != sweep.truths.front().name) continue;
        if (!fastest || point.milliseconds < fastest->milliseconds) fastest = &point;
        if (point.milliseconds <= milliseconds && (!best || error(point) < error(*best)))
            best = &point;
    }
    return best ? best : fastest;
}

Sheet contact_sheet(const Sweep& sweep, double milliseconds) {
    if (sweep.of != SweepOf::pictures)
        throw Error("contact_sheet: the sweep is of texels or vertices, one of pictures needed");
    const SweepTruth& truth = sweep.truths.front();
    Sheet out = {{&truth.picture,
                  {"ground truth, by path tracing",
                   fmt::format("standard error {:.1f} %", 100.0 * truth.noise)}}};
    std::vector<std::string> methods = sweep.methods;
    methods.emplace_back(path_tracer_name);
    for (const std::string& method : methods)
        if (const SweepPoint* point = shown_point(sweep, method, milliseconds))
            out.push_back({&point->picture, caption_of(*point)});
    return out;
}

Raster draw_sheet(const Sheet& sheet) {
    const Drawing drawing;
    const float exposure = preview_exposure(*sheet.front().picture);
    nlohmann::ordered_json panels;
    Raster out;
    for (const auto& [picture, caption] : sheet) {
        const Raster panel{picture->width, picture->height, preview(*picture, exposure)};
        const std::string name = fmt::format("{}.png", panels.size());
        drawing.add(name, panel);
        panels.push_back({{"picture", name}, {"lines", caption}});
        out.width = panel.width;
        out.height += panel.height;
        out.rgba.insert(out.rgba.end(), panel.rgba.begin(), panel.rgba.end());
    }
    return drawing.draw("sheet", panels).empty() ? drawing.picture("sheet.png") : out;
}

}  // namespace clgi::lab
