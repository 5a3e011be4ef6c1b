// The sheet of pictures that a sweep of all systems writes: which picture stands for a method,
// where it stands, and what stands below it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "lab/contact_sheet.hpp"
#include "lab/preview.hpp"

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
    ASSERT_EQ(sheet.panels.size(), 4u);
    EXPECT_EQ(sheet.panels[0].caption,
              (Lines{"ground truth, by path tracing", "standard error 1.2 %"}));
    EXPECT_EQ(sheet.panels[1].caption, (Lines{"one: error 20.0 %", "60 ms a frame, 1.23 s once"}));
    EXPECT_EQ(sheet.panels[2].caption, (Lines{"two: error 7.0 %", "1.3 s a frame"}));
    EXPECT_EQ(sheet.panels[3].caption,
              (Lines{"path tracer: error 100.0 %", "50 ms a frame, 4 samples a pixel"}));
}

// Every panel is the picture of its point, all with one exposure, and no two overlap.
TEST(ContactSheet, PanelsAreThePicturesOfTheirPoints) {
    const Sweep sweep = two_methods();
    const Sheet sheet = contact_sheet(sweep, 100.0);
    Raster drawn = draw_sheet(sheet);
    ASSERT_EQ(drawn.width, sheet.width);
    ASSERT_EQ(drawn.height, sheet.height);
    const std::vector<const io::Image*> pictures = {
        &sweep.truths[0].picture, &sweep.points[1].picture, &sweep.points[6].picture,
        &sweep.points[7].picture};
    const float exposure = preview_exposure(sweep.truths[0].picture);
    ASSERT_EQ(sheet.panels.size(), pictures.size());
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const SheetPanel& panel = sheet.panels[k];
        EXPECT_EQ(panel.picture, pictures[k]) << k;
        const std::vector<std::uint8_t> expected = preview(*pictures[k], exposure);
        for (int y = 0; y < height; ++y)
            ASSERT_TRUE(std::equal(expected.begin() + 4 * width * y,
                                   expected.begin() + 4 * width * (y + 1),
                                   drawn.at(panel.left, panel.top + y)))
                << k << ", row " << y;
    }
    EXPECT_EQ(sheet.panels[1].top, sheet.panels[0].top);
    EXPECT_GT(sheet.panels[1].left, sheet.panels[0].left + width);
    EXPECT_EQ(sheet.panels[3].left, sheet.panels[0].left) << "three in a row";
    EXPECT_GT(sheet.panels[3].top, sheet.panels[0].top + height);
    // Captions are there, and the last pixels of the sheet are paper.
    const auto ink = [&](int left, int top, int right, int bottom) {
        int dark = 0;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) dark += drawn.at(x, y)[0] < 128;
        return dark;
    };
    for (const SheetPanel& panel : sheet.panels)
        EXPECT_GT(ink(panel.left, panel.top + height + 1, panel.left + 4 * width,
                      panel.top + height + 30),
                  100);
    EXPECT_EQ(ink(sheet.width - 4, 0, sheet.width, sheet.height), 0);
    EXPECT_EQ(ink(0, sheet.height - 4, sheet.width, sheet.height), 0);
}

TEST(ContactSheet, IsOfPicturesAlone) {
    Sweep sweep = two_methods();
    sweep.of = SweepOf::atlas;
    EXPECT_THROW(contact_sheet(sweep, 100.0), Error);
    sweep.of = SweepOf::pictures;
    sweep.points.clear();
    const Sheet sheet = contact_sheet(sweep, 100.0);
    EXPECT_EQ(sheet.panels.size(), 1u) << "the truth alone";
    EXPECT_EQ(draw_sheet(sheet).width, sheet.width);
}

}  // namespace
}  // namespace clgi::lab
