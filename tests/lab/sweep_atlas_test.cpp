// Sweeps of the light atlas: settings, errors in a sphere where every order of reflection is known,
// references that are given or kept, both fillings at equal error, files.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/patches.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "device.hpp"
#include "gltf_draft.hpp"
#include "lab/baked_atlas.hpp"
#include "lab/metrics.hpp"
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {
namespace {

TEST(AtlasSweepSettings, VaryEachKnobAloneAndAreNoTwoAlike) {
    for (const bool quick : {true, false}) {
        std::map<std::string, std::map<std::string, std::set<std::string>>> values;
        std::set<std::string> seen;
        for (const AtlasSettings& one : atlas_settings(quick)) {
            std::string text = one.series;
            for (const auto& [name, value] : one.knobs) {
                text += " " + name + " " + value;
                values[one.series][name].insert(value);
            }
            EXPECT_TRUE(seen.insert(text).second) << text;
            EXPECT_EQ(one.method,
                      one.bake.filling == Filling::project ? atlas_project : atlas_gather);
            EXPECT_EQ(one.knobs.count("mesh"), one.bake.filling == Filling::project ? 1u : 0u);
        }
        values.erase("grid");
        std::set<std::string> varied;
        for (const auto& [series, knobs] : values) {
            const std::string knob = series.substr(0, series.find(','));
            varied.insert(knob);
            for (const auto& [name, different] : knobs)
                if (name == knob) {
                    EXPECT_GE(different.size(), 2u) << series;
                } else {
                    EXPECT_EQ(different.size(), 1u) << series << " varies " << name;
                }
        }
        EXPECT_EQ(varied,
                  (std::set<std::string>{"vpls", "bounces", "samples-per-vpl", "exchange-samples",
                                         "hemicube-size", "mesh", "kernel"}));
    }
}

SweepPoint point(const char* method, double milliseconds, double error) {
    SweepPoint out;
    out.method = method;
    out.milliseconds = milliseconds;
    out.error = {error};
    out.front = {true};
    return out;
}

TEST(AtEqualError, TakesTheQuickestThatIsAtLeastAsAccurate) {
    Sweep sweep;
    sweep.truths.push_back({"full", "indirect", {}, 0.0});
    sweep.points = {point(atlas_project, 60, 0.05),  point(atlas_project, 30, 0.10),
                    point(atlas_gather, 5, 0.11),    point(atlas_gather, 20, 0.05),
                    point(atlas_gather, 12, 0.09),   point(atlas_gather, 10, 0.10),
                    point(path_tracer_name, 1, 0.0), point(atlas_project, 200, 0.01),
                    point(atlas_project, 90, 0.06)};
    sweep.points.back().front[0] = false;
    const std::vector<AtEqualError> pairs = at_equal_error(sweep, atlas_project, atlas_gather, 0);
    ASSERT_EQ(pairs.size(), 2u) << "no gathering reaches 1 %";
    EXPECT_EQ(pairs[0].slow->milliseconds, 30);
    EXPECT_EQ(pairs[0].quick->milliseconds, 10);
    EXPECT_EQ(pairs[0].factor, 3.0);
    EXPECT_EQ(pairs[1].quick->milliseconds, 20);
    EXPECT_EQ(pairs[1].factor, 3.0);
}

TEST(RelativeError, CountsThePixelsOfTheMaskAlone) {
    io::Image truth, picture;
    truth.width = picture.width = 4;
    truth.height = picture.height = 1;
    for (const char* name : {"R", "G", "B"}) {
        truth.channels.push_back({name, {2, 2, 0, 50}});
        picture.channels.push_back({name, {2.5, 1.5, 7, 0}});
    }
    const Mask mask{4, 1, {1, 1, 0, 0}, 2};
    EXPECT_NEAR(relative_error(picture, truth, &mask), 0.25, 1e-6);
    const Mask none{4, 1, {0, 0, 0, 0}, 0}, other{2, 2, {1, 1, 1, 1}, 4};
    EXPECT_THROW(relative_error(picture, truth, &none), InputError);
    EXPECT_THROW(relative_error(picture, truth, &other), InputError);
}

// A sphere of albedo 1/2 with a light in its middle: indirect irradiance is the direct one, 1 lux.
constexpr int side = 64;

class SphereSweep : public testing::Test {
protected:
    static const Scene& scene() {
        static const Scene scene = furnace({.light = LightSource::point, .albedo = 0.5f});
        return scene;
    }
    static AtlasLayout layout() {
        AtlasOptions options;
        options.size = side;
        return make_atlas(scene(), make_patches(scene()).triangle_patch, options);
    }
    // The truth as a file. What it says beside texels does not count.
    static void save_truth(const std::filesystem::path& file) {
        const AtlasLayout atlas = layout();
        io::Image truth = baked_image(
            atlas, std::vector<glm::vec3>(atlas.texels.size(), glm::vec3(1)), "indirect", false);
        for (std::size_t i = 0; i < truth.channels[3].values.size(); ++i)
            if (truth.channels[3].values[i] == 0.0f)
                for (std::size_t c = 0; c < 3; ++c) truth.channels[c].values[i] = 7.0f;
        io::save_exr(truth, file, io::PixelType::full);
    }
    static const test::TempFolder& folder() {
        static const test::TempFolder folder;
        return folder;
    }
    static SweepSetup setup(const std::filesystem::path& folder) {
        SweepSetup out{test::device().queue, scene()};
        out.quick = true;
        out.rounds = 1;
        out.reference_samples = 64;
        out.folder = folder;
        return out;
    }
    static AtlasSweep atlas(const std::filesystem::path& reference = {}) {
        AtlasSweep out;
        out.layout.size = side;
        out.reference = reference;
        return out;
    }
    static const Sweep& made() {
        static const Sweep sweep = [] {
            save_truth(folder().path() / "truth.exr");
            return sweep_atlas(setup(folder().path()), atlas(folder().path() / "truth.exr"));
        }();
        return sweep;
    }
    static std::string text(const std::filesystem::path& file) {
        std::ostringstream out;
        out << std::ifstream(file).rdbuf();
        return out.str();
    }
};

// k reflections leave 2^-k of the light. 1 %: facets and edges between charts, as in
// light_atlas_test.cpp.
TEST_F(SphereSweep, FindsTheErrorOfEveryNumberOfBounces) {
    const std::map<std::string, double> wanted = {{"1", 0.5}, {"2", 0.25}, {"all", 0.0}};
    const auto points = points_of(made(), "bounces");
    ASSERT_EQ(points.size(), wanted.size());
    for (const SweepPoint* point : points) {
        const double share = wanted.at(point->knobs.at("bounces"));
        EXPECT_NEAR(point->error[0], share, 0.01) << point->knobs.at("bounces");
        EXPECT_NEAR(point->energy, 1.0 - share, 0.01) << point->knobs.at("bounces");
    }
    EXPECT_EQ(made().non_finite, 0u);
}

TEST_F(SphereSweep, MeasuresTheSameSettingsOnce) {
    const SweepPoint *first = nullptr, *second = nullptr;
    for (const SweepPoint* point : points_of(made(), "vpls"))
        for (const SweepPoint* other : points_of(made(), "bounces"))
            if (point->knobs == other->knobs) first = point, second = other;
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->milliseconds, second->milliseconds);
}

// Of random light paths, the error falls with the root of their number: 1, 4, 16. Their tails are
// long: 0.15. Both fillings come as near as 50 or 100 VPLs can.
TEST(SweepOfTheCornellBox, MeasuresBothFillingsAndThePathTracer) {
    const test::TempFolder folder;
    const Scene scene = cornell({.light = LightSource::spot});
    SweepSetup setup{test::device().queue, scene};
    setup.quick = true;
    setup.rounds = 1;
    setup.reference_samples = 1024;
    setup.folder = folder.path();
    AtlasSweep atlas;
    atlas.layout.size = 40;
    const Sweep made = sweep_atlas(setup, atlas);
    std::map<std::string, int> count, front;
    std::vector<double> traced;
    for (const SweepPoint& point : made.points) {
        ++count[point.method];
        ASSERT_TRUE(point.front.size() == 1 && point.error.size() == 1);
        front[point.method] += point.front[0];
        EXPECT_GT(point.milliseconds, 0.0);
        if (point.method == path_tracer_name) traced.push_back(point.error[0]);
        if (point.method != path_tracer_name && point.knobs.at("bounces") == "all") {
            EXPECT_LT(point.error[0], point.knobs.at("vpls") == "50" ? 0.3 : 0.2) << point.series;
        }
    }
    EXPECT_GE(count[atlas_gather], 10);
    EXPECT_GE(count[atlas_project], 6);
    ASSERT_EQ(traced.size(), 3u);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(traced[k + 1] / traced[k], 0.5, 0.15);
    for (const char* method : {atlas_gather, atlas_project, path_tracer_name})
        EXPECT_GT(front[method], 0) << method;
    EXPECT_GT(speedup(made, atlas_gather, 0).best, 1.0);
}

TEST_F(SphereSweep, WritesFilesThatStandAlone) {
    const test::TempFolder out;
    const std::string why = save_sweep(made(), {"clgi sweep <me>", "1.2.3"}, out.path());
    const std::string csv = text(out.path() / "sweep.csv");
    EXPECT_EQ(csv.rfind("method,series,vpls,bounces,samples-per-vpl,exchange-samples,"
                        "filling,hemicube-size,mesh,kernel,spp,ms,error full,front full,energy "
                        "ratio\n",
                        0),
              0u)
        << csv.substr(0, 200);
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
              made().points.size() + 1);
    const auto json = nlohmann::json::parse(text(out.path() / "sweep.json"));
    EXPECT_EQ(json.at("points").size(), made().points.size());
    EXPECT_EQ(json.at("speedups").size(), 2u);
    EXPECT_EQ(json.at("references").at(0).at("effects"), "indirect");
    EXPECT_EQ(json.at("size"), (std::vector<int>{side, side}));
    const auto pairs = at_equal_error(made(), atlas_project, atlas_gather, 0);
    EXPECT_EQ(json.value("fillings", nlohmann::json::array()).size(), pairs.size());
    if (!why.empty()) GTEST_SKIP() << why;
    const std::string page = text(out.path() / "index.html");
    EXPECT_NE(page.find("clgi sweep &lt;me&gt;"), std::string::npos);
    EXPECT_NE(page.find("64\u00d764 texels"), std::string::npos);
    EXPECT_EQ(page.find("cd/m"), std::string::npos) << "irradiance is in lux";
    const std::string plot = text(out.path() / "error-full.svg");
    for (const char* words :
         {"milliseconds a bake", "atlas gather, front", "atlas project, front", "path tracer"})
        EXPECT_NE(plot.find(words), std::string::npos) << words;
}

TEST_F(SphereSweep, KeepsItsReference) {
    const test::TempFolder out;
    SweepSetup small = setup(out.path());
    small.path_tracer = false;
    small.solver = false;
    const auto file = out.path() / "reference-atlas.exr";
    const Sweep first = sweep_atlas(small, atlas());
    const auto written = std::filesystem::last_write_time(file);
    // Relative to 1 lux; the noise says how far it may be off.
    const io::Image& truth = first.truths[0].picture;
    const Mask texels = mask_of(truth);
    EXPECT_GT(texels.pixels, 200u);
    EXPECT_GT(first.truths[0].noise, 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < texels.counts.size(); ++i)
        if (texels[i]) sum += truth.find("G")->values[i];
    EXPECT_NEAR(sum / texels.pixels, 1.0,
                0.005 + 4.0 * first.truths[0].noise / std::sqrt(double(texels.pixels)));
    const Sweep again = sweep_atlas(small, atlas());
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    EXPECT_EQ(again.truths[0].picture.find("R")->values, truth.find("R")->values);
    small.reference_samples = 32;
    EXPECT_NE(sweep_atlas(small, atlas()).truths[0].picture.find("R")->values,
              truth.find("R")->values);
}

TEST_F(SphereSweep, RefusesReferencesOfAnotherLayout) {
    const test::TempFolder out;
    const auto file = out.path() / "given.exr";
    const auto refused = [&](const char* words) {
        try {
            sweep_atlas(setup(out.path()), atlas(file));
            ADD_FAILURE() << words;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    refused("no such file");
    save_truth(file);
    io::Image truth = io::load_image(file);
    io::Image half = truth;
    for (std::size_t i = 0; i < half.channels.size(); ++i)
        if (half.channels[i].name == "A")
            for (std::size_t k = 0; k < half.channels[i].values.size(); k += 2)
                half.channels[i].values[k] = 0.0f;
    io::save_exr(half, file, io::PixelType::full);
    refused("nine in ten");
    io::Image without = truth;
    std::erase_if(without.channels, [](const auto& channel) { return channel.name == "A"; });
    io::save_exr(without, file, io::PixelType::full);
    refused("channel A");
    for (auto& channel : truth.channels) channel.values.resize(std::size_t{side} * 2);
    truth.height = 2;
    io::save_exr(truth, file, io::PixelType::full);
    refused("64x2");
}

TEST_F(SphereSweep, CanBeCancelled) {
    for (const double from : {0.1, 0.4, 0.7}) {
        const test::TempFolder out;
        SweepSetup cut = setup(out.path());
        cut.progress = [&](double done) { return done < from; };
        EXPECT_THROW(sweep_atlas(cut, atlas()), Error) << from;
        for (const auto& entry : std::filesystem::directory_iterator(out.path()))
            EXPECT_NO_THROW(io::load_image(entry.path()));
    }
}

}  // namespace
}  // namespace clgi::lab
