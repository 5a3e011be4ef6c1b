// Sweeps: fronts, errors with the truth's noise taken out, references kept, files that stand alone.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "device.hpp"
#include "gltf_draft.hpp"
#include "lab/metrics.hpp"
#include "lab/reference_picture.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_run.hpp"
#include "lab/sweep_summary.hpp"
#include "scenes.hpp"

namespace clgi::lab {
namespace {

TEST(Pareto, KeepsWhatNothingBeats) {
    const std::vector<Cost> points = {{3, 5}, {1, 9}, {2, 9}, {4, 5}, {5, 1}, {1, 9}, {6, 2}};
    EXPECT_EQ(pareto_front(points), (std::vector<std::size_t>{1, 0, 4}));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Pareto, IsAgreedOnByAllPairs) {
    test::Random random(3);
    std::vector<Cost> points;
    for (int i = 0; i < 300; ++i) points.push_back({random(1, 9), random(1, 9)});
    const auto front = pareto_front(points);
    const std::set<std::size_t> kept(front.begin(), front.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool beaten = false;
        for (const Cost& other : points)
            beaten |= other.milliseconds < points[i].milliseconds && other.error < points[i].error;
        EXPECT_EQ(kept.count(i), beaten ? 0u : 1u) << i;
    }
}

TEST(Pareto, FindsTheTimeOfAnErrorAlongPowerLaws) {
    std::vector<Cost> curve;
    for (double t = 1; t < 2000; t *= 3) curve.push_back({t, 0.8 / std::sqrt(t)});
    for (const double error : {2.0, 0.8, 0.5, 0.1, 0.03, 0.002})
        EXPECT_NEAR(*time_to_reach(curve, error), std::pow(0.8 / error, 2),
                    1e-9 * std::pow(0.8 / error, 2))
            << error;
    EXPECT_FALSE(time_to_reach({}, 0.1).has_value());
}

io::Image grey(int width, int height, float value) {
    io::Image out;
    out.width = width;
    out.height = height;
    for (const char* name : {"R", "G", "B"})
        out.channels.push_back(
            {name, std::vector<float>(static_cast<std::size_t>(width) * height, value)});
    return out;
}

TEST(RelativeError, IsThatOfLuminanceOverTheMean) {
    EXPECT_NEAR(relative_error(grey(5, 3, 1.1f), grey(5, 3, 1.0f)), 0.1, 1e-6);
    EXPECT_EQ(relative_error(grey(5, 3, 2.0f), grey(5, 3, 2.0f)), 0.0);
    io::Image green = grey(4, 4, 1.0f);
    for (float& value : green.channels[1].values) value = 2.0f;
    EXPECT_NEAR(relative_error(green, grey(4, 4, 1.0f)), 0.7152, 1e-6);
    EXPECT_THROW(relative_error(grey(4, 4, 1), grey(4, 5, 1)), InputError);
}

// A truth that is itself noisy and says how noisy: what it says is taken out.
TEST(RelativeError, TakesTheNoiseOfTheTruthOut) {
    test::Random random(9);
    const int side = 400;
    io::Image truth = grey(side, side, 0.0f), picture = grey(side, side, 1.05f);
    std::vector<float> stated;
    for (std::size_t i = 0; i < truth.channels[0].values.size(); ++i) {
        const double width = random(0.0, 0.6);  // even noise of this width
        const auto value = static_cast<float>(1.0 + width * (random(0, 1) - 0.5));
        for (auto& channel : truth.channels) channel.values[i] = value;
        stated.push_back(static_cast<float>(width / std::sqrt(12.0)));
    }
    EXPECT_GT(relative_error(picture, truth), 0.1);
    truth.channels.push_back({"error.Y", stated});
    // 160,000 squares of about 0.01 with a spread as large: 0.01 / 400 = 2.5e-5; 5 of those.
    EXPECT_NEAR(std::pow(relative_error(picture, truth), 2), 0.0025, 1.3e-4);
}

TEST(SweepSettings, TurnEachKnobAloneAndAreNoTwoAlike) {
    for (const bool quick : {true, false}) {
        std::map<std::string, std::set<std::string>> seen;
        for (const PictureSetting& setting : second_order_settings(quick)) {
            std::string text;
            for (const auto& [name, value] : setting.knobs) text += name + value + " ";
            EXPECT_TRUE(seen[setting.series].insert(text).second) << setting.series << text;
        }
        for (const char* series : {"vpls", "negative-vpls", "low-res", "shadow-size"}) {
            EXPECT_GE(seen[series].size(), 2u) << series;
        }
        for (const char* knob : {"vpls", "negative-vpls", "low-res", "shadow-size"}) {
            std::map<std::string, std::set<std::string>> values;
            for (const PictureSetting& setting : second_order_settings(quick))
                if (setting.series == knob)
                    for (const auto& [name, value] : setting.knobs) values[name].insert(value);
            for (const auto& [name, different] : values)
                if (name != knob) {
                    EXPECT_EQ(different.size(), 1u) << knob << " turns " << name;
                }
        }
    }
}

TEST(SweepSettings, HaveThoseOfTheFrontThatTuningUses) {
    const SecondOrderFront& front = second_order_front(MainLight::point);
    std::vector<PictureSetting> found;
    for (const PictureSetting& setting : second_order_settings(false, {}, &front))
        if (setting.series == "front") found.push_back(setting);
    ASSERT_EQ(found.size(), front.refinements.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const SecondOrderOptions& options = found[i].options.second_order;
        const Refinement& refinement = front.refinements[i];
        EXPECT_EQ(options.emitters.vpls, refinement.from_vpls);
        EXPECT_EQ(options.negative_vpls, std::min(refinement.from_vpls, 4096));  // a share of 1
        EXPECT_EQ(options.low_resolution_step, refinement.step);
        EXPECT_EQ(options.discontinuity_threshold, refinement.threshold);
    }
}

class SmallSweep : public testing::Test {
protected:
    static const Sweep& made() {
        static const Sweep sweep = make(scene(), folder().path());
        return sweep;
    }
    static const Scene& scene() {
        static const Scene scene = cornell({.light = LightSource::spot});
        return scene;
    }
    static const test::TempFolder& folder() {
        static const test::TempFolder folder;
        return folder;
    }
    static Sweep make(const Scene& scene, const std::filesystem::path& folder) {
        SweepSetup setup{test::device().queue, scene};
        setup.quick = true;
        setup.rounds = 1;
        setup.reference_samples = 1024;
        setup.folder = folder;
        return sweep_pictures(setup, {0, 40, 30});
    }
    static std::string text(const std::filesystem::path& file) {
        std::ostringstream out;
        out << std::ifstream(file).rdbuf();
        return out.str();
    }
};

TEST_F(SmallSweep, MarksFrontsThatFallWithTime) {
    for (std::size_t t = 0; t < picture_truths; ++t) {
        std::map<double, double> front;
        for (const SweepPoint& point : made().points) {
            EXPECT_GT(point.milliseconds, 0.0);
            EXPECT_GE(point.error[t], 0.0);
            EXPECT_LT(point.error[t], 10.0);
            if (point.front[t] && point.method == "second-order")
                front[point.milliseconds] = point.error[t];
        }
        EXPECT_FALSE(front.empty());
        double before = 1e9;
        for (const auto& [milliseconds, error] : front) {
            EXPECT_LT(error, before);
            before = error;
        }
    }
    // More light paths are nearer to the truth that they sample.
    double few = 0.0, many = 0.0;
    for (const SweepPoint& point : made().points)
        if (point.series == "full") (few == 0.0 ? few : many) = point.error[all_light];
    EXPECT_LT(many, 0.6 * few);
    // 3,000 lights are 7 % off, most of it at the walls beside them. The noise of the truth, 9 %,
    // is taken out of the square of the error; what is left of it has this standard deviation.
    const io::Image& truth = made().truths[unshadowed_bounce].picture;
    const auto& noise = truth.find("error.Y")->values;
    double fourth = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        fourth += std::pow(double{noise[i]}, 4);
        mean += 0.2126 * truth.find("R")->values[i] + 0.7152 * truth.find("G")->values[i] +
                0.0722 * truth.find("B")->values[i];
    }
    const double deviation =
        std::sqrt(2.0 * fourth) * static_cast<double>(noise.size()) / (mean * mean);
    const double error = floor_of(made(), "vpls, unshadowed", "vpls", unshadowed_bounce).error;
    EXPECT_LT(deviation, 1e-3);
    EXPECT_LT(error * error, 0.07 * 0.07 + 4.0 * deviation);
}

TEST_F(SmallSweep, WritesFilesThatStandAlone) {
    const test::TempFolder out;
    const std::string why = save_sweep(made(), {"clgi sweep <me>", "1.2.3"}, out.path());
    const std::string csv = text(out.path() / "sweep.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
              made().points.size() + 1);
    const auto json = nlohmann::json::parse(text(out.path() / "sweep.json"));
    EXPECT_EQ(json.at("points").size(), made().points.size());
    EXPECT_EQ(json.at("speedups").size(), static_cast<std::size_t>(picture_truths));
    if (!why.empty()) {
        EXPECT_NE(text(out.path() / "index.html").find(why), std::string::npos);
        GTEST_SKIP() << why;
    }
    const std::string page = text(out.path() / "index.html");
    EXPECT_NE(page.find("clgi sweep &lt;me&gt;"), std::string::npos);
    for (const char* outside : {"src=\"http", "href=\"http", "src=\"/", "<link", "<script"})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
    EXPECT_NE(page.find("<svg"), std::string::npos);
}

// How often a text has another one in it.
std::size_t count_of(const std::string& what, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++count;
    return count;
}

TEST_F(SmallSweep, PlotsErrorAgainstTime) {
    const test::TempFolder out;
    const auto plot_of = [&](const Sweep& sweep) {
        const std::string why = save_sweep(sweep, {"clgi sweep", "1.2.3"}, out.path());
        return why.empty() ? text(out.path() / "error-full.svg") : std::string();
    };
    const std::string plot = plot_of(made());
    if (plot.empty()) GTEST_SKIP() << "nothing can be drawn";
    for (const char* words :
         {"milliseconds a frame", "relative error, %", "second-order, all settings",
          "second-order, front", "path tracer", "Error against the full reference<", "</svg>"})
        EXPECT_NE(plot.find(words), std::string::npos) << words;
    // A marker for each point, between the name of this group and the next.
    const std::size_t from = plot.find("<g id=\"second-order, all settings\"");
    ASSERT_NE(from, std::string::npos);
    const std::size_t to = plot.find("<g id=", from + 1);
    EXPECT_EQ(count_of("<use ", plot.substr(from, to - from)),
              static_cast<std::size_t>(
                  std::count_if(made().points.begin(), made().points.end(), [](const auto& point) {
                      return point.method == second_order_method && point.error[all_light] > 0.0;
                  })));
    // A setting that diverged does not press the others to the floor.
    Sweep diverged = made();
    diverged.points.back().error[all_light] = 1e36;
    const std::string beside = plot_of(diverged);
    EXPECT_NE(beside.find("(1 above 1000 % left out)"), std::string::npos);
    EXPECT_EQ(beside.find("10000000"), std::string::npos);
    // Each reason is counted for itself.
    ASSERT_GE(diverged.points.size(), 8u);
    const auto last = [&](std::size_t k) -> SweepPoint& {
        return diverged.points[diverged.points.size() - k];
    };
    last(2).error[all_light] = std::nan("");
    last(3).error[all_light] = std::numeric_limits<double>::infinity();
    last(4).error[all_light] = 0.0;
    last(5).given_up = true;
    EXPECT_NE(plot_of(diverged).find(
                  "(1 diverged, 2 not finite, 1 above 1000 %, 1 within noise left out)"),
              std::string::npos);
}

// What was given up shows direct light in little time: it would be the front.
TEST(SweepFronts, HaveNoPointThatWasGivenUp) {
    Sweep sweep;
    sweep.methods = {"one"};
    sweep.truths = {{"full", "all", grey(2, 2, 1.0f), 0.0}};
    sweep.knobs = {"n"};
    for (const double error : {0.1, 0.2, 0.3}) {
        SweepPoint point;
        point.method = "one";
        point.series = "n";
        point.knobs = {{"n", "4"}};
        point.milliseconds = 1.0 / error;
        point.error = {error};
        point.front = {false};
        sweep.points.push_back(point);
    }
    sweep.points[1].given_up = true;
    mark_fronts(sweep);
    EXPECT_TRUE(sweep.points[0].front[0]);
    EXPECT_FALSE(sweep.points[1].front[0]);
    EXPECT_TRUE(sweep.points[2].front[0]);
    EXPECT_NE(sweep_csv(sweep).find("energy ratio,given_up\n"), std::string::npos);
    const auto json = nlohmann::json::parse(sweep_json(sweep, {"clgi sweep", "1.2.3"}));
    EXPECT_FALSE(json.at("points")[0].contains("given_up"));
    EXPECT_EQ(json.at("points")[1].at("given_up"), true);
    std::vector<std::string> lines;
    add_series(sweep, "n", {0}, "", lines);
    EXPECT_NE(lines.at(0).find("error 10.00, diverged, 30.00 %"), std::string::npos) << lines[0];
}

TEST_F(SmallSweep, ComparesMathAndStorage) {
    const std::vector<MathMode> modes = math_modes(made());
    ASSERT_EQ(modes.size(), 4u);
    EXPECT_EQ(modes[0].math + modes[0].storage, "strictfull");
    EXPECT_EQ(modes[3].math + modes[3].storage, "fasthalf");
    EXPECT_EQ(modes[0].difference, 0.0);
    for (const MathMode& mode : modes) {
        EXPECT_GT(mode.speed, 0.0);
        if (mode.storage == "half") {
            EXPECT_GT(mode.difference, 0.0);
        }
        EXPECT_LT(mode.difference, 0.005);
        EXPECT_NEAR(mode.error, modes[0].error, 0.005);
    }
}

TEST_F(SmallSweep, KeepsItsReferences) {
    made();
    const auto file = folder().path() / "reference-full.exr";
    const auto written = std::filesystem::last_write_time(file);
    const Sweep again = make(scene(), folder().path());
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    EXPECT_EQ(again.truths[all_light].picture.find("R")->values,
              made().truths[all_light].picture.find("R")->values);
    for (std::size_t i = 0; i < again.points.size(); ++i)
        if (again.points[i].method == "second-order") {
            EXPECT_NEAR(again.points[i].energy, made().points[i].energy, 1e-9) << i;
        }

    Scene other = scene();
    other.lights[0].intensity *= 2.0f;
    EXPECT_NE(scene_key(other), scene_key(scene()));
    const test::TempFolder copy;
    std::filesystem::copy(file, copy.path() / "reference-full.exr");
    const reference::PathTracer tracer(other);
    reference::Options options;
    options.width = 40;
    options.height = 30;
    options.samples = 64;
    const io::Image made_anew =
        cached_reference(tracer, other.cameras[0], options, "all",
                         copy.path() / "reference-full.exr", scene_key(other), nullptr);
    EXPECT_NE(made_anew.find("R")->values, made().truths[all_light].picture.find("R")->values);
}

TEST_F(SmallSweep, CanBeCancelled) {
    SweepSetup setup{test::device().queue, scene()};
    setup.quick = true;
    const test::TempFolder out;
    setup.folder = out.path();
    setup.progress = [](double done) { return done < 0.2; };
    EXPECT_THROW(sweep_pictures(setup, {0, 16, 16}), Error);
    // What was finished is whole; what was not is not there.
    for (const auto& entry : std::filesystem::directory_iterator(out.path()))
        EXPECT_NO_THROW(io::load_image(entry.path()));
}

}  // namespace
}  // namespace clgi::lab
