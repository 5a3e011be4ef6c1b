// Sweeps of antiradiance: settings, errors that fall, estimates without a reference, files; and all
// systems in one sweep.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "device.hpp"
#include "gltf_draft.hpp"
#include "lab/metrics.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_summary.hpp"
#include "rooms.hpp"

namespace clgi::lab {
namespace {

TEST(AntiradianceSweepSettings, VaryEachKnobAloneAndAreNoTwoAlike) {
    for (const auto& [quick, alone] : std::vector<std::pair<bool, bool>>{
             {true, true}, {false, true}, {true, false}, {false, false}}) {
        std::map<std::string, std::map<std::string, std::set<std::string>>> values;
        std::set<std::string> seen;
        for (const PictureSetting& one : antiradiance_settings(quick, {}, alone)) {
            std::string text = one.series;
            for (const auto& [name, value] : one.knobs) {
                text += " " + name + " " + value;
                values[one.series][name].insert(value);
            }
            EXPECT_TRUE(seen.insert(text).second) << text;
            EXPECT_EQ(one.method, antiradiance_method);
            EXPECT_EQ(one.knobs.at("bins"), std::to_string(one.options.antiradiance.bins));
            EXPECT_EQ(one.knobs.at("elements"),
                      std::to_string(one.options.antiradiance.elements.requested));
            EXPECT_EQ(one.knobs.at("steps") == "converged", one.options.antiradiance.steps == 0);
            EXPECT_EQ(one.knobs.at("spread") == "none",
                      one.options.antiradiance.links.spread == Spread::none);
            EXPECT_EQ(one.knobs.at("storage") == "half",
                      one.options.picture.build.storage == Storage::half);
            EXPECT_EQ(one.knobs.at("iteration") == "symmetric",
                      one.options.antiradiance.iteration == Iteration::symmetric);
            EXPECT_EQ(std::stod(one.knobs.at("bin-share")),
                      one.options.antiradiance.links.bin_share);
        }
        values.erase("grid");
        std::set<std::string> varied;
        for (const auto& [series, knobs] : values) {
            varied.insert(series);
            for (const auto& [name, different] : knobs)
                if (name == series) {
                    EXPECT_GE(different.size(), 2u) << series;
                } else {
                    EXPECT_EQ(different.size(), 1u) << series << " varies " << name;
                }
        }
        EXPECT_EQ(varied, (std::set<std::string>{"bins", "elements", "iteration", "steps", "spread",
                                                 "bin-share", "storage"}));
    }
}

SweepSetup small_setup(const Scene& scene, const std::filesystem::path& folder, int samples) {
    SweepSetup out{test::device().queue, scene};
    out.quick = true;
    out.rounds = 1;
    out.reference_samples = samples;
    out.folder = folder;
    return out;
}

std::string text(const std::filesystem::path& file) {
    std::ostringstream out;
    out << std::ifstream(file).rdbuf();
    return out.str();
}

class AntiradianceSweep : public testing::Test {
protected:
    static const Sweep& made() {
        static const Scene scene = cornell({.light = LightSource::spot});
        static const test::TempFolder folder;
        static const Sweep sweep = sweep_pictures(small_setup(scene, folder.path(), 2048),
                                                  {0, 40, 30, {antiradiance_method}});
        return sweep;
    }
    static double mean(const io::Image& picture) {
        double sum = 0.0;
        for (const double value : luminance_of(picture)) sum += value;
        return sum;
    }
    static std::vector<double> errors(const std::string& series, std::size_t truth) {
        std::vector<double> out;
        for (const SweepPoint* point : points_of(made(), series))
            out.push_back(point->error[truth]);
        return out;
    }
};

// Against all light and against indirect light alone, with every knob that should matter.
TEST_F(AntiradianceSweep, ErrorsFallWithEachKnob) {
    ASSERT_EQ(made().truths.size(), 2u);
    EXPECT_EQ(made().truths[1].effects, "indirect");
    for (const std::size_t truth : {0u, 1u})
        for (const char* series : {"bins", "elements", "steps", "spread", "bin-share"}) {
            const std::vector<double> found = errors(series, truth);
            ASSERT_GE(found.size(), 2u);
            for (std::size_t k = 1; k < found.size(); ++k)
                EXPECT_LT(found[k], found[k - 1]) << series << " " << k;
        }
    for (const SweepPoint* point : points_of(made(), "bins")) {
        EXPECT_GT(point->error[1], 1.2 * point->error[0]) << "direct light has little error";
        EXPECT_NEAR(point->energy, 1.0, 0.05);
        EXPECT_GT(point->once_milliseconds.value_or(0.0), 0.0);
        EXPECT_GT(point->milliseconds, 0.0);
    }
    EXPECT_LT(errors("bins", 1).back(), 0.25);
    EXPECT_EQ(made().non_finite, 0u);
}

// Ways to the same light: half storage rounds it, and both iterations stop at a thousandth.
TEST_F(AntiradianceSweep, IterationsAndStorageChangeLittle) {
    for (const char* series : {"iteration", "storage"}) {
        const std::vector<double> found = errors(series, 1);
        for (const double error : found) EXPECT_NEAR(error, found.front(), 0.01) << series;
    }
}

// The estimate needs no reference. It sees bins, so it is below the error, to which elements add;
// and it falls as the error does.
TEST_F(AntiradianceSweep, EstimatesItsErrorFromTwiceAsManyBins) {
    for (const char* truth : {full_truth, indirect_truth}) {
        double before = 1.0;
        for (const SweepPoint* point : points_of(made(), "bins")) {
            const double estimate = point->estimated_error.at(truth);
            EXPECT_GT(estimate, 0.0);
            EXPECT_LT(estimate, before);
            before = estimate;
        }
    }
    // One difference over the means of two pictures.
    const double ratio = mean(made().truths[0].picture) / mean(made().truths[1].picture);
    EXPECT_GT(ratio, 1.3);
    for (const SweepPoint* point : points_of(made(), "bins"))
        EXPECT_NEAR(point->estimated_error.at(indirect_truth),
                    ratio * point->estimated_error.at(full_truth),
                    0.05 * point->estimated_error.at(indirect_truth));
    const EstimateQuality quality = estimate_quality(made(), 1);
    EXPECT_GT(quality.least, 0.1);
    EXPECT_LE(quality.least, quality.most);
    EXPECT_LT(quality.most, 1.5);
}

TEST_F(AntiradianceSweep, WritesFilesThatStandAlone) {
    const test::TempFolder out;
    const std::string why = save_sweep(made(), {"clgi sweep <me>", "1.2.3"}, out.path());
    const std::string csv = text(out.path() / "sweep.csv");
    EXPECT_EQ(csv.rfind("method,series,bins,elements,iteration,steps,spread,bin-share,storage,spp,"
                        "ms,once ms,error full,front full,estimated_error full,error indirect,"
                        "front indirect,estimated_error indirect,energy ratio\n",
                        0),
              0u)
        << csv.substr(0, 250);
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);)
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 18) << line;
    const auto json = nlohmann::json::parse(text(out.path() / "sweep.json"));
    EXPECT_EQ(json.at("points").size(), made().points.size());
    for (const auto& point : json.at("points")) {
        const bool traced = point.at("method") == path_tracer_name;
        EXPECT_EQ(point.contains("once_ms"), !traced);
        EXPECT_EQ(point.contains("estimated_error"), !traced);
    }
    if (!why.empty()) GTEST_SKIP() << why;
    const std::string page = text(out.path() / "index.html");
    for (const char* words : {"<h2>Done once</h2>", "<h2>Estimated errors</h2>", "<img"})
        EXPECT_NE(page.find(words), std::string::npos) << words;
    for (const char* name : {"error-full.svg", "error-indirect.svg"}) {
        const std::string plot = text(out.path() / name);
        for (const char* words : {"milliseconds a frame", "antiradiance, front", "path tracer"})
            EXPECT_NE(plot.find(words), std::string::npos) << words;
    }
}

TEST_F(AntiradianceSweep, CanBeCancelled) {
    const Scene scene = cornell({.light = LightSource::spot});
    for (const double from : {0.2, 0.6, 0.9}) {
        const test::TempFolder out;
        SweepSetup cut = small_setup(scene, out.path(), 4);
        cut.progress = [&](double done) { return done < from; };
        EXPECT_THROW(sweep_pictures(cut, {0, 16, 16, {antiradiance_method}}), Error) << from;
    }
}

// Between shelves the symmetric iteration diverges: what it shows is no result, and no error of it
// is estimated.
TEST(AntiradiancePictures, SayThatTheIterationWasGivenUp) {
    Scene scene = test::shelves(0.6f);
    scene.cameras = {test::camera_at({0.05, 0.5, 0.5}, {0.9, 0.5, 0.5}, 1.2f)};
    const test::TempFolder folder;
    const SweepSetup setup = small_setup(scene, folder.path(), 4);
    DeviceScene device = test::on_device(scene);
    io::Image grey;
    grey.width = 16;
    grey.height = 12;
    for (const char* name : {"R", "G", "B"})
        grey.channels.push_back({name, std::vector<float>(16 * 12, 1.0f)});
    const std::vector<SweepTruth> truths = {{full_truth, "all", grey, 0.0}};
    const PictureTask task{setup, scene.cameras[0], 16, 12, device, test::programs(), truths, true,
                           64};
    int given_up = 0, found = 0;
    for (const PictureSetting& one : picture_method(antiradiance_method, task).settings) {
        if (one.series != "iteration") continue;
        const std::string& iteration = one.knobs.at("iteration");
        SweepPoint point;
        measure_picture(task, one, true, &point, [](double) { return true; });
        EXPECT_EQ(point.given_up, iteration == "symmetric") << iteration;
        EXPECT_EQ(point.estimated_error.empty(), point.given_up) << iteration;
        ++(point.given_up ? given_up : found);
    }
    EXPECT_EQ(given_up, 1);
    EXPECT_EQ(found, 2);
}

// All systems that a scene admits: transfer with an environment alone. With one, what arrives from
// it is part of antiradiance's light and no indirect light of the path tracer.
TEST(SweepOfAllMethods, DrawsThoseThatTheSceneAdmits) {
    const std::vector<std::string> all = {second_order_method, antiradiance_method,
                                          light_atlas_method, dynamic_transfer_method};
    Scene scene = cornell({.light = LightSource::spot});
    {
        const test::TempFolder out;
        SweepSetup setup = small_setup(scene, out.path(), 4);
        setup.solver = setup.path_tracer = false;
        EXPECT_EQ(sweep_pictures(setup, {0, 8, 8, all}).methods,
                  (std::vector<std::string>(all.begin(), all.begin() + 3)));
        EXPECT_THROW(sweep_pictures(setup, {0, 8, 8, {dynamic_transfer_method}}), InputError);
        scene.environment = Environment();
        scene.environment->factor = glm::vec3(0.3f);
        EXPECT_EQ(sweep_pictures(setup, {0, 8, 8, {antiradiance_method}}).truths.size(), 1u);
    }
    const test::TempFolder out;
    const Sweep made = sweep_pictures(small_setup(scene, out.path(), 400), {0, 32, 24, all});
    EXPECT_EQ(made.methods, all);
    ASSERT_EQ(made.truths.size(), 3u);
    std::map<std::string, double> best;
    std::map<std::string, int> front, once;
    for (const SweepPoint& point : made.points) {
        const auto [at, first] = best.try_emplace(point.method, point.error[all_light]);
        at->second = std::min(at->second, point.error[all_light]);
        front[point.method] += point.front[all_light];
        once[point.method] += point.once_milliseconds.has_value();
        EXPECT_GT(point.milliseconds, 0.0) << point.method;
    }
    for (const std::string& method : all) {
        EXPECT_GT(front[method], 0) << method;
        EXPECT_EQ(once[method] > 0, method != second_order_method) << method;
    }
    // All bounces, against one. Transfer has one of the environment's light and none of the lamp's.
    EXPECT_LT(best[antiradiance_method], 0.5 * best[second_order_method]);
    EXPECT_LT(best[light_atlas_method], 0.5 * best[second_order_method]);
    const auto bounces = points_of(made, "interreflections, transfer");
    ASSERT_EQ(bounces.size(), 2u);
    EXPECT_LT(bounces[1]->error[all_light], bounces[0]->error[all_light]);
    // The sheet has one picture of each: at no bound that of the least error.
    const Sheet sheet = contact_sheet(made, 1e9);
    ASSERT_EQ(sheet.size(), all.size() + 2);
    for (std::size_t m = 0; m < all.size(); ++m) {
        const std::array<std::string, 2>& said = sheet[m + 1].caption;
        char error[32];
        std::snprintf(error, sizeof error, ": error %.1f %%", 100.0 * best[all[m]]);
        EXPECT_EQ(said[0], all[m] + error);
        EXPECT_EQ(said[1].find(" once") != std::string::npos, once[all[m]] > 0) << said[1];
    }
    const std::string why = save_sweep(made, {"clgi sweep", "1.2.3"}, out.path());
    if (!why.empty()) GTEST_SKIP() << why;
    const std::string plot = text(out.path() / "error-full.svg");
    for (const std::string& method : all)
        EXPECT_NE(plot.find(method + ", front"), std::string::npos) << method;
}

}  // namespace
}  // namespace clgi::lab
