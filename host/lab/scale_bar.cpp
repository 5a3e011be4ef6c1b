// SPDX-License-Identifier: MIT
#include "lab/scale_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "lab/lettering.hpp"

namespace clgi::lab {
namespace {

// Every length in the text's height, which follows the picture, but more slowly.
struct Layout {
    explicit Layout(int picture_width) {
        text = std::max(9.0, 10.0 * std::sqrt(picture_width / 640.0));
        width = std::max(picture_width, lengths(26.0));
        line = std::max(1, lengths(0.08));
        bar = lengths(1.1);
        below = lengths(4.6);
    }
    int lengths(double n) const { return static_cast<int>(std::lround(n * text)); }

    double text = 0.0;
    int width = 0;  // of picture and paper
    int line = 0;   // thickness
    int bar = 0;    // height
    int below = 0;  // all that is added below the picture
};

double at(const Scale& scale, double share) { return scale.from + (scale.to - scale.from) * share; }

// Where ticks stand, 0 to 1: as many as leave their labels apart. A scale of one number has it in
// its middle.
std::vector<double> ticks(const Scale& scale, double text, int length) {
    if (scale.from == scale.to) return {0.5};
    for (const int steps : {4, 2}) {
        std::vector<double> shares;
        double widest = 0.0;
        for (int i = 0; i <= steps; ++i) {
            shares.push_back(static_cast<double>(i) / steps);
            widest = std::max(widest, text_width(tick_label(at(scale, shares.back())), text));
        }
        if (steps * (widest + text) <= length) return shares;
    }
    return {0.0, 1.0};
}

}  // namespace

std::string tick_label(double value) {
    std::string text = fmt::format("{:.4g}", value == 0.0 ? 0.0 : value);
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return text;
    return text.substr(0, e + 1) + std::to_string(std::atoi(text.c_str() + e + 1));
}

double round_up(double value) {
    if (!(value > 0.0)) return 0.0;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        // A quotient of decimal fractions may miss its own step by its last bits.
        if (value <= step * power * (1.0 + 1e-12)) return step * power;
    }
    return 10.0 * power;
}

Raster with_scale_bar(const Raster& picture, const Scale& scale) {
    const Layout layout(picture.width);
    Raster canvas(layout.width, picture.height + layout.below, paper);
    canvas.put(picture, (layout.width - picture.width) / 2, 0);

    // The caption, then the bar with room for half a label at both ends.
    const double widest = std::max(text_width(tick_label(scale.from), layout.text),
                                   text_width(tick_label(scale.to), layout.text));
    const int margin = layout.lengths(1.0), half_label = static_cast<int>(0.5 * widest);
    const int caption = static_cast<int>(text_width(scale.caption, layout.text));
    const int top = picture.height + margin, left = 2 * margin + caption + half_label;
    const int length = layout.width - left - half_label - margin;
    draw_text(canvas, scale.caption, margin, top + 0.5 * (layout.bar - layout.text), layout.text,
              ink);
    canvas.fill(left - layout.line, top - layout.line, length + 2 * layout.line,
                layout.bar + 2 * layout.line, ink);
    for (int x = 0; x < length; ++x) {
        canvas.fill(left + x, top, 1, layout.bar,
                    scale.color(static_cast<double>(x) / (length - 1)));
    }

    const int foot = top + layout.bar;
    const std::vector<double> shares = ticks(scale, layout.text, length);
    for (const double share : shares) {
        const int x = left + static_cast<int>(std::lround(share * length));
        const std::string label = tick_label(at(scale, share));
        canvas.fill(x - (layout.line + 1) / 2, foot, layout.line, layout.lengths(0.5), ink);
        draw_text(canvas, label, x - 0.5 * text_width(label, layout.text),
                  foot + layout.lengths(0.85), layout.text, ink);
    }
    return canvas;
}

}  // namespace clgi::lab
