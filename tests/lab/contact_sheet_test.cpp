// The sheet of pictures that a sweep of all systems writes: which picture stands for a method,
// where it stands, and what stands below it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "lab/preview.hpp"
#include "lab/sweep_files.hpp"

namespace clgi::lab {
namespace {

constexpr int width = 40, height = 30;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Different everywhere, and of different colours for different seeds.
io::Image pattern(int seed) {
    io::Image out;
    out.width = width;
    out.height = height;
    for (int c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (int i = 0; i < width * height; ++i)
            values.push_back(0.001f * static_cast<float>((i * (7 + 2 * c) + 131 * seed) % 997));
        out.channels.push_back({std::string(1, "RGB"[c]), values});
    }
    return out;
}

SweepPoint point(const std::string& method, double milliseconds, double error, int seed) {
    SweepPoint out;
    out.method = method;
    out.milliseconds = milliseconds;
    out.error = {error, 9.0};
    out.picture = pattern(seed);
    return out;
}

Sweep two_methods() {
    Sweep out;
    out.width = width;
    out.height = height;
    out.methods = {"one", "two", "none"};
    out.truths = {{"full", "all", pattern(0), 0.0123}, {"other", "direct", pattern(1), 0.5}};
    out.points = {point("one", 10.0, 0.3, 2),   point("one", 60.0, 0.2, 3),
                  point("one", 90.0, 0.25, 4),  point("one", 110.0, 0.1, 5),
                  point("one", 20.0, nan, 6),   point("two", 1500.0, 0.02, 7),
                  point("two", 1300.0, 0.07, 8)};
    out.points[1].once_milliseconds = 1234.0;
    for (const auto& [series, time, seed] :
         {std::tuple{"full", 50.0, 9}, {"other", 40.0, 10}, {"full", 200.0, 11}}) {
        out.points.push_back(point(path_tracer_name, time, 50.0 / time, seed));
        out.points.back().series = series;
        out.points.back().knobs = {{"spp", "4"}};
    }
    out.points[8].error[0] = 0.0;  // that of another truth
    return out;
}

TEST(ContactSheet, ShowsTheLeastErrorWithinTheTimeElseTheFastest) {
    const Sweep sweep = two_methods();
    const auto shown = [&](const std::string& method, double time) {
        return shown_point(sweep, method, time);
    };
    EXPECT_EQ(shown("one", 100.0), &sweep.points[1]);
    EXPECT_EQ(shown("one", 110.0), &sweep.points[3]) << "at most the bound";
    EXPECT_EQ(shown("one", 15.0), &sweep.points[0]);
    EXPECT_EQ(shown("one", 25.0), &sweep.points[0]) << "an error that is not a number is the worst";
    EXPECT_EQ(shown("one", 1.0), &sweep.points[0]);
    EXPECT_EQ(shown("two", 100.0), &sweep.points[6]);
    EXPECT_EQ(shown("two", 1e9), &sweep.points[5]);
    EXPECT_EQ(shown(path_tracer_name, 100.0), &sweep.points[7]) << "all light alone";
    EXPECT_EQ(shown("none", 100.0), nullptr);
    Sweep given_up = sweep;
    for (const std::size_t k : {1u, 5u, 6u}) given_up.points[k].given_up = true;
    EXPECT_EQ(shown_point(given_up, "one", 100.0), &given_up.points[2]);
    EXPECT_EQ(shown_point(given_up, "two", 1e9), nullptr);
}

TEST(ContactSheet, SaysWhatEachPictureTookAndErrs) {
    const Sweep sweep = two_methods();
    const Sheet sheet = contact_sheet(sweep, 100.0);
    using Lines = std::array<std::string, 2>;
    ASSERT_EQ(sheet.size(), 4u);
    EXPECT_EQ(sheet[0].caption, (Lines{"ground truth, by path tracing", "standard error 1.2 %"}));
    EXPECT_EQ(sheet[1].caption, (Lines{"one: error 20.0 %", "60 ms a frame, 1.23 s once"}));
    EXPECT_EQ(sheet[2].caption, (Lines{"two: error 7.0 %", "1.3 s a frame"}));
    EXPECT_EQ(sheet[3].caption,
              (Lines{"path tracer: error 100.0 %", "50 ms a frame, 4 samples a pixel"}));
}

// Where a picture is in a sheet, pixel for pixel; -1, -1: nowhere.
std::array<int, 2> place_of(const std::vector<std::uint8_t>& picture, const Raster& sheet) {
    const auto is_at = [&](int left, int top) {
        for (int y = 0; y < height; ++y)
            if (!std::equal(picture.begin() + 4 * width * y, picture.begin() + 4 * width * (y + 1),
                            sheet.rgba.begin() + 4 * (sheet.width * (top + y) + left)))
                return false;
        return true;
    };
    for (int top = 0; top + height <= sheet.height; ++top)
        for (int left = 0; left + width <= sheet.width; ++left)
            if (is_at(left, top)) return {left, top};
    return {-1, -1};
}

// Every panel is the picture of its point, all with one exposure, and no two overlap.
TEST(ContactSheet, PanelsAreThePicturesOfTheirPoints) {
    const Sweep sweep = two_methods();
    const Sheet sheet = contact_sheet(sweep, 100.0);
    const Raster drawn = draw_sheet(sheet);
    const std::vector<const io::Image*> pictures = {
        &sweep.truths[0].picture, &sweep.points[1].picture, &sweep.points[6].picture,
        &sweep.points[7].picture};
    const float exposure = preview_exposure(sweep.truths[0].picture);
    ASSERT_EQ(sheet.size(), pictures.size());
    std::vector<std::array<int, 2>> places;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        EXPECT_EQ(sheet[k].picture, pictures[k]) << k;
        places.push_back(place_of(preview(*pictures[k], exposure), drawn));
        ASSERT_GE(places.back()[0], 0) << k;
    }
    if (drawn.width == width) GTEST_SKIP() << "no sheet can be drawn";
    EXPECT_EQ(places[1][1], places[0][1]);
    EXPECT_GT(places[1][0], places[0][0] + width);
    EXPECT_EQ(places[3][0], places[0][0]) << "three in a row";
    EXPECT_GT(places[3][1], places[0][1] + height);
    // Captions are there, and the last pixels of the sheet are paper.
    const auto ink = [&](int left, int top, int right, int bottom) {
        int dark = 0;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) dark += drawn.rgba[4 * (y * drawn.width + x)] < 128;
        return dark;
    };
    for (const auto& [left, top] : places)
        EXPECT_GT(ink(left, top + height + 1, left + 4 * width, top + height + 30), 100);
    EXPECT_EQ(ink(drawn.width - 4, 0, drawn.width, drawn.height), 0);
    EXPECT_EQ(ink(0, drawn.height - 4, drawn.width, drawn.height), 0);
}

TEST(ContactSheet, IsOfPicturesAlone) {
    Sweep sweep = two_methods();
    sweep.of = SweepOf::atlas;
    EXPECT_THROW(contact_sheet(sweep, 100.0), Error);
    sweep.of = SweepOf::pictures;
    sweep.points.clear();
    const Sheet sheet = contact_sheet(sweep, 100.0);
    EXPECT_EQ(sheet.size(), 1u) << "the truth alone";
    EXPECT_GE(draw_sheet(sheet).width, width);
}

}  // namespace
}  // namespace clgi::lab
