// Every letter is a few polylines on a grid on which a digit is 4 wide and 6 high, y down.
// SPDX-License-Identifier: MIT
#include "lab/lettering.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace clgi::lab {
namespace {

struct Point {
    double x;
    double y;
};
using Stroke = std::vector<Point>;

constexpr double digit_height = 6.0;
constexpr double spacing = 1.5;
constexpr double half_stroke = 0.42;

// In tenths: x y x y ..., a slash between strokes.
struct Drawing {
    char letter;
    double width;
    const char* strokes;
};
// clang-format off
constexpr Drawing drawings[] = {
    {'0', 40, "20 0 30 4 37 14 40 30 37 46 30 56 20 60 10 56 3 46 0 30 3 14 10 4 20 0"},
    {'1', 40, "7 13 23 0 23 60"},
    {'2', 40, "2 16 6 6 15 0 25 0 34 6 37 16 33 26 1 60 39 60"},
    {'3', 40, "3 0 36 0 18 23 26 24 34 29 38 39 35 51 27 58 17 60 8 57 1 49"},
    {'4', 40, "30 60 30 0 0 42 40 42"},
    {'5', 40, "35 0 7 0 4 27 12 22 21 21 31 26 38 38 35 51 27 58 17 60 8 57 1 49"},
    {'6', 40, "34 5 26 1 18 1 9 8 3 22 1 39 4 52 12 59 22 60 32 55 38 43 35 31 27 24 17 24 "
              "7 30 2 40"},
    {'7', 40, "1 0 39 0 15 60"},
    {'8', 40, "20 0 29 2 35 8 35 19 29 25 20 27 11 25 5 19 5 8 11 2 20 0 / "
              "20 27 31 31 38 39 38 49 31 57 20 60 9 57 2 49 2 39 9 31 20 27"},
    {'9', 40, "6 55 14 59 22 59 31 52 37 38 39 21 36 8 28 1 18 0 8 5 2 17 5 29 13 36 23 36 "
              "33 30 38 20"},
    {'-', 34, "2 32 32 32"},
    {'+', 36, "1 32 35 32 / 18 15 18 49"},
    {'.', 6, "3 58 3 59"},
    {'e', 36, "2 40 35 40 34 30 27 22 18 20 9 23 2 31 1 43 5 54 13 60 23 60 32 55"},
    {'A', 44, "0 60 22 0 44 60 / 8 40 36 40"},
    {'B', 40, "2 29 24 29 31 24 34 15 31 5 22 0 2 0 2 60 24 60 34 56 38 45 34 33 24 29"},
    {'F', 36, "2 60 2 0 36 0 / 2 29 29 29"},
    {'L', 34, "2 0 2 60 34 60"},
    {'I', 6, "3 0 3 60"},
    {'P', 38, "2 60 2 0 23 0 33 4 37 16 33 28 23 32 2 32"},
    {'|', 6, "3 -6 3 68"},
    {'a', 36, "34 20 34 60 / 34 31 28 23 20 20 11 22 4 29 1 40 4 51 11 58 20 60 28 57 34 49"},
    {'b', 36, "2 0 2 60 / 2 31 8 23 16 20 25 22 32 29 35 40 32 51 25 58 16 60 8 57 2 49"},
    {'c', 34, "33 28 27 22 19 20 10 22 3 29 1 40 3 51 10 58 19 60 27 58 33 52"},
    {'d', 36, "34 0 34 60 / 34 31 28 23 20 20 11 22 4 29 1 40 4 51 11 58 20 60 28 57 34 49"},
    {'f', 22, "22 1 16 0 11 3 9 10 9 60 / 1 20 20 20"},
    {'g', 36, "34 20 34 64 31 73 25 78 17 79 10 77 5 73 / 34 31 28 23 20 20 11 22 4 29 1 40 4 "
              "51 11 58 20 60 28 57 34 49"},
    {'h', 34, "2 0 2 60 / 2 32 9 23 18 20 27 22 32 30 32 60"},
    {'i', 6, "3 20 3 60 / 3 5 3 6"},
    {'j', 12, "9 20 9 68 6 76 0 78 / 9 5 9 6"},
    {'k', 32, "2 0 2 60 / 28 20 2 46 / 12 36 31 60"},
    {'l', 6, "3 0 3 60"},
    {'m', 56, "2 20 2 60 / 2 32 8 23 16 20 24 22 28 30 28 60 / 28 32 34 23 42 20 50 22 54 30 54 "
              "60"},
    {'n', 34, "2 20 2 60 / 2 32 9 23 18 20 27 22 32 30 32 60"},
    {'o', 38, "19 20 28 22 35 29 37 40 35 51 28 58 19 60 10 58 3 51 1 40 3 29 10 22 19 20"},
    {'p', 36, "2 20 2 78 / 2 31 8 23 16 20 25 22 32 29 35 40 32 51 25 58 16 60 8 57 2 49"},
    {'q', 36, "34 20 34 78 / 34 31 28 23 20 20 11 22 4 29 1 40 4 51 11 58 20 60 28 57 34 49"},
    {'r', 22, "2 20 2 60 / 2 36 6 27 13 21 21 20"},
    {'s', 32, "30 27 25 22 16 20 7 22 3 29 6 36 16 39 26 42 30 49 26 57 16 60 7 58 2 52"},
    {'t', 22, "9 4 9 52 12 58 18 60 22 59 / 1 20 20 20"},
    {'u', 34, "2 20 2 49 6 57 14 60 24 57 32 48 / 32 20 32 60"},
    {'v', 32, "1 20 16 60 31 20"},
    {'w', 48, "1 20 12 60 24 20 36 60 47 20"},
    {'x', 32, "2 20 30 60 / 30 20 2 60"},
    {'y', 32, "1 20 17 60 / 31 20 17 60 11 73 5 78 0 78"},
    {'z', 32, "2 20 30 20 2 60 31 60"},
    {'%', 57, "46 0 12 60 / 11 0 18 4 20 14 18 24 11 28 5 24 2 14 5 4 11 0 / 46 32 52 36 55 46 "
              "52 56 46 60 40 56 37 46 40 36 46 32"},
    {',', 8, "5 57 5 61 1 71"},
    {':', 6, "3 26 3 27 / 3 58 3 59"},
};
// clang-format on

struct Glyph {
    char letter;
    double width;
    std::vector<Stroke> strokes;
};

Glyph traced(const Drawing& drawing) {
    Glyph glyph{drawing.letter, 0.1 * drawing.width, {{}}};
    std::istringstream numbers(drawing.strokes);
    for (std::string x, y; numbers >> x;) {
        if (x == "/") {
            glyph.strokes.emplace_back();
        } else if (numbers >> y) {
            glyph.strokes.back().push_back({0.1 * std::stoi(x), 0.1 * std::stoi(y)});
        }
    }
    return glyph;
}

const std::vector<Glyph>& glyphs() {
    static const std::vector<Glyph> all = [] {
        std::vector<Glyph> result;
        for (const Drawing& drawing : drawings) result.push_back(traced(drawing));
        return result;
    }();
    return all;
}

const Glyph& glyph_of(char letter) {
    static const Glyph gap{' ', 1.0, {}};
    const auto& all = glyphs();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Glyph& glyph) { return glyph.letter == letter; });
    return found == all.end() ? gap : *found;
}

double distance(const Point& p, const Point& from, const Point& to) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double along = ((p.x - from.x) * dx + (p.y - from.y) * dy) / (dx * dx + dy * dy);
    const double t = std::clamp(along, 0.0, 1.0);
    return std::hypot(p.x - from.x - t * dx, p.y - from.y - t * dy);
}

double distance(const Point& p, const Glyph& glyph) {
    double nearest = 1e9;
    for (const Stroke& stroke : glyph.strokes) {
        for (std::size_t i = 1; i < stroke.size(); ++i) {
            nearest = std::min(nearest, distance(p, stroke[i - 1], stroke[i]));
        }
    }
    return nearest;
}

void draw(Raster& raster, const Glyph& glyph, double left, double top, double unit,
          const Color& color) {
    const auto pixel = [](double v) { return static_cast<int>(std::floor(v)); };
    for (int y = pixel(top - 2.0 * unit); y <= pixel(top + (digit_height + 2.0) * unit); ++y) {
        for (int x = pixel(left - unit); x <= pixel(left + (glyph.width + 1.0) * unit); ++x) {
            const Point p{(x + 0.5 - left) / unit, (y + 0.5 - top) / unit};
            // A stroke's edge is one pixel soft.
            const double inside = (half_stroke - distance(p, glyph)) * unit + 0.5;
            if (inside > 0.0) raster.paint(x, y, color, std::min(inside, 1.0));
        }
    }
}

}  // namespace

double text_width(std::string_view text, double height) {
    double width = 0.0;
    for (const char letter : text) width += glyph_of(letter).width + spacing;
    return text.empty() ? 0.0 : (width - spacing) * height / digit_height;
}

void draw_text(Raster& raster, std::string_view text, double left, double top, double height,
               const Color& color) {
    const double unit = height / digit_height;
    for (const char letter : text) {
        const Glyph& glyph = glyph_of(letter);
        draw(raster, glyph, left, top, unit, color);
        left += (glyph.width + spacing) * unit;
    }
}

}  // namespace clgi::lab
