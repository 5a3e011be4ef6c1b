// SPDX-License-Identifier: MIT
#include "lab/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "lab/lettering.hpp"
#include "lab/preview.hpp"

namespace clgi::lab {
namespace {

constexpr int columns = 3;

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

// Lengths in pixels, most of them in the height of the text.
struct Layout {
    explicit Layout(const Sweep& sweep, const std::vector<SheetPanel>& panels)
        : text(std::max(9.0, sweep.width / 32.0)) {
        double widest = sweep.width;
        for (const SheetPanel& panel : panels)
            for (const std::string& line : panel.caption)
                widest = std::max(widest, text_width(line, text));
        gap = lengths(1.0);
        cell = static_cast<int>(std::ceil(widest));
        below = lengths(4.4);
    }
    int lengths(double n) const { return static_cast<int>(std::lround(n * text)); }

    double text;
    int gap = 0;    // around all cells
    int cell = 0;   // width
    int below = 0;  // what captions add to the height of a picture
};

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
    Sheet out;
    out.panels.push_back({&truth.picture,
                          {"ground truth, by path tracing",
                           fmt::format("standard error {:.1f} %", 100.0 * truth.noise)}});
    std::vector<std::string> methods = sweep.methods;
    methods.emplace_back(path_tracer_name);
    for (const std::string& method : methods)
        if (const SweepPoint* point = shown_point(sweep, method, milliseconds))
            out.panels.push_back({&point->picture, caption_of(*point)});

    const Layout layout(sweep, out.panels);
    out.text = layout.text;
    const int count = static_cast<int>(out.panels.size());
    const int across = std::min(count, columns), down = (count + columns - 1) / columns;
    for (int i = 0; i < count; ++i) {
        SheetPanel& panel = out.panels[static_cast<std::size_t>(i)];
        panel.left = layout.gap + i % columns * (layout.cell + layout.gap);
        panel.top = layout.gap + i / columns * (sweep.height + layout.below);
    }
    out.width = layout.gap + across * (layout.cell + layout.gap);
    out.height = layout.gap + down * (sweep.height + layout.below);
    return out;
}

Raster draw_sheet(const Sheet& sheet) {
    Raster out(sheet.width, sheet.height, paper);
    const float exposure = preview_exposure(*sheet.panels.front().picture);
    for (const SheetPanel& panel : sheet.panels) {
        Raster picture;
        picture.width = panel.picture->width;
        picture.height = panel.picture->height;
        picture.rgba = preview(*panel.picture, exposure);
        out.put(picture, panel.left, panel.top);
        double top = panel.top + picture.height + 0.7 * sheet.text;
        for (const std::string& line : panel.caption) {
            draw_text(out, line, panel.left, top, sheet.text, ink);
            top += 1.6 * sheet.text;
        }
    }
    return out;
}

}  // namespace clgi::lab
