// Sweeps of dynamic transfer: settings, the smooth environment, errors against the path tracer.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <clgi/error.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "gltf_draft.hpp"
#include "lab/coarse_mesh.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_summary.hpp"
#include "lab/sweep_transfer.hpp"
#include "sky_projection.hpp"
#include "transfer_scenes.hpp"

namespace clgi::lab {
namespace {

TEST(TransferSweepSettings, VaryEachKnobAloneAndAreNoTwoAlike) {
    for (const bool quick : {true, false}) {
        std::map<std::string, std::map<std::string, std::set<std::string>>> values;
        std::set<std::string> seen;
        for (const TransferSettings& one : transfer_settings(quick, 16000, true, true)) {
            std::string text = one.series;
            for (const auto& [name, value] : one.knobs) {
                text += " " + name + " " + value;
                values[one.series][name].insert(value);
            }
            EXPECT_TRUE(seen.insert(text).second) << text;
            EXPECT_EQ(one.method, one.looks > 0    ? transfer_sets
                                  : one.coarse > 0 ? transfer_levels
                                                   : transfer_fine);
            EXPECT_EQ(one.knobs.count("looks"), one.looks > 0 ? 1u : 0u);
            EXPECT_EQ(one.knobs.at("mask"), std::to_string(one.options.masks.size));
            EXPECT_EQ(one.knobs.at("sh-order"), std::to_string(one.options.masks.bands - 1));
            EXPECT_EQ(one.knobs.at("cells") == "exact", one.options.cells == CellIntegral::exact);
            EXPECT_EQ(one.knobs.at("cells") == "monte-carlo",
                      one.options.cells == CellIntegral::monte_carlo);
            EXPECT_EQ(one.knobs.at("table") == "off",
                      one.options.masks.planes == EdgePlanes::exact);
        }
        values.erase("grid");
        std::set<std::string> varied;
        for (const auto& [series, knobs] : values) {
            varied.insert(series);
            for (const auto& [name, different] : knobs)
                if (name == series)
                    EXPECT_GE(different.size(), 2u) << series;
                else
                    EXPECT_EQ(different.size(), 1u) << series << " varies " << name;
        }
        EXPECT_EQ(varied, (std::set<std::string>{"mask", "mask-block", "cells", "table", "sh-order",
                                                 "coarse", "rings", "looks"}));
    }
}

// Too few triangles, or a build without clgi::mesh: one level alone.
TEST(TransferSweepSettings, DoWithoutTwoLevels) {
    for (const auto& list :
         {transfer_settings(false, 12, true, true), transfer_settings(false, 16000, false, true)})
        for (const TransferSettings& one : list) {
            EXPECT_EQ(one.coarse, 0u);
            EXPECT_NE(one.method, transfer_levels);
        }
}

// What stands still is looked at once.
TEST(TransferSweepSettings, LookOnceAtWhatStandsStill) {
    for (const bool quick : {true, false}) {
        int with_sets = 0;
        for (const TransferSettings& one : transfer_settings(quick, 16000, true, false)) {
            EXPECT_LE(one.looks, 1);
            with_sets += one.looks;
        }
        EXPECT_GT(with_sets, 0);
    }
}

// A sun rings below 0 in five bands; smoothed it does not, and its mean stays.
TEST(SmoothedLight, IsNowhereBelowZeroAndKeepsItsMean) {
    std::vector<glm::dvec3> sun;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.5, -0.8));
    for (const double y : sh::evaluate(axis, 5)) sun.push_back(glm::dvec3(2.0, 1.0, 0.5) * y);
    const std::vector<glm::dvec3> smooth = smoothed_light(sun);
    EXPECT_EQ(smooth[0], sun[0]);
    EXPECT_GT(glm::length(smooth[6]), 0.0);
    const Environment sky = picture_of_light(smooth, 256);
    for (const glm::vec3& texel : sky.texels)
        for (int c = 0; c < 3; ++c) ASSERT_GE(texel[c], 0.0f);
    // As the library reads it: which way the picture lies. 1e-3: texels of a 256th of a turn.
    const auto found = test::SkyProjector()(sky).light;
    EXPECT_LT(test::relative_difference(found, smooth), 1e-3);
}

// What is left is compared with the open sky at the same normal: pi times one colour.
TEST(SeesSky, TellsWhatLiesInsideOfSomething) {
    const std::vector<glm::dvec3> one_colour = {glm::dvec3(2.0, 1.0, 0.5) * std::sqrt(4 * M_PI)};
    const glm::dvec3 open = glm::dvec3(2.0, 1.0, 0.5) * M_PI;
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.2f));
    EXPECT_TRUE(sees_sky(0.0101 * open, one_colour, normal));
    EXPECT_FALSE(sees_sky(0.0099 * open, one_colour, normal));
    EXPECT_FALSE(sees_sky(glm::dvec3(0.0), one_colour, normal));
}

// A sphere above a floor.
Scene small_scene() {
    Scene scene = test::plain_scene();
    scene.name = "sphere";
    // Cut into squares, so that vertices lie in the shadow.
    for (int i = -4; i < 4; ++i)
        for (int k = -4; k < 4; ++k) {
            const double x = 0.5 * i, z = 0.5 * k;
            test::add_quad(
                scene,
                {glm::dvec3(x, 0, z + 0.5), {x + 0.5, 0, z + 0.5}, {x + 0.5, 0, z}, {x, 0, z}});
        }
    test::add_sphere(scene, {0.1, 0.8, -0.1}, 0.7, 3);
    test::light_by_gradient(scene, {0.9f, 2.0f, 3.5f}, glm::normalize(glm::dvec3(0.4, 0.8, -0.3)));
    scene.lights = {test::directional_light({0, -1, 0}, 20.0f)};  // that does not count
    return scene;
}

// The sphere rolls without turning, from left to right in a second.
Scene moving_scene() {
    Scene scene = small_scene();
    constexpr std::uint32_t first = 256;  // vertices of the floor
    Animation animation;
    animation.nodes.emplace_back();
    PosedRange range;
    range.first_vertex = first;
    range.vertex_count = static_cast<std::uint32_t>(scene.positions.size()) - first;
    for (std::size_t v = first; v < scene.positions.size(); ++v) {
        animation.rest_positions.emplace_back(scene.positions[v]);
        animation.rest_normals.push_back(scene.normals[v]);
    }
    animation.ranges = {range};
    AnimationClip clip;
    clip.duration = 1.0;
    Curve curve;
    curve.times = {0.0f, 1.0f};
    curve.values = {-0.8f, 0.0f, 0.0f, 0.8f, 0.0f, 0.0f};
    clip.curves = {curve};
    clip.channels = {Channel{}};
    animation.clips = {clip};
    scene.animation = animation;
    return scene;
}

class TransferSweep : public testing::Test {
protected:
    static SweepSetup setup(const Scene& scene, const std::filesystem::path& folder) {
        SweepSetup out{test::device().queue, scene};
        out.quick = true;
        out.rounds = 1;
        out.reference_samples = 1024;
        out.folder = folder;
        return out;
    }
    static const test::TempFolder& folder() {
        static const test::TempFolder folder;
        return folder;
    }
    static const Sweep& made() {
        static const Scene scene = small_scene();
        static const Sweep sweep = sweep_transfer(setup(scene, folder().path()));
        return sweep;
    }
    static std::string text(const std::filesystem::path& file) {
        std::ostringstream out;
        out << std::ifstream(file).rdbuf();
        return out.str();
    }
};

// Light of one band loses nothing in five: against both truths the error is that of 32 pixels,
// about a percent, and four times that of 8.
TEST_F(TransferSweep, FindsTheErrorOfMasks) {
    const auto masks = points_of(made(), "mask");
    ASSERT_EQ(masks.size(), 2u);
    for (const std::size_t truth : {full_environment, smooth_environment}) {
        EXPECT_LT(masks[1]->error[truth], 0.015);
        EXPECT_GT(masks[0]->error[truth], 1.5 * masks[1]->error[truth]);
        EXPECT_LT(masks[0]->error[truth], 0.1);
    }
    EXPECT_NEAR(masks[1]->energy, 1.0, 0.01);
    EXPECT_EQ(made().non_finite, 0u);
}

// 812 random directions err by about a thirtieth, integrals over cells by a hundredth.
TEST_F(TransferSweep, TellsRandomDirectionsFromIntegrals) {
    const auto cells = points_of(made(), "cells");
    ASSERT_EQ(cells.size(), 3u);
    for (const std::size_t truth : {full_environment, smooth_environment}) {
        EXPECT_GT(cells[0]->error[truth], 1.5 * cells[2]->error[truth]);
        EXPECT_LT(cells[0]->error[truth], 0.05);
        EXPECT_LT(cells[1]->error[truth], 0.015);
    }
}

TEST_F(TransferSweep, MeasuresBothMethodsAndThePathTracer) {
    std::map<std::string, int> count, front;
    std::map<std::string, std::vector<double>> traced;
    for (const SweepPoint& point : made().points) {
        ++count[point.method];
        EXPECT_GT(point.milliseconds, 0.0);
        ASSERT_EQ(point.error.size(), 2u);
        for (const bool on : point.front) front[point.method] += on;
        if (point.method == path_tracer_name)
            traced[point.series].push_back(point.error[point.series == "full" ? 0 : 1]);
    }
    for (const char* truth : {"full", "smooth"}) {
        ASSERT_EQ(traced[truth].size(), 3u) << truth;
        // Of random paths the error halves with four times as many.
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(traced[truth][k + 1] / traced[truth][k], 0.5, 0.15) << truth;
    }
    for (const char* method : {transfer_fine, transfer_levels, transfer_sets, path_tracer_name}) {
        if (method == transfer_levels && !can_simplify()) continue;
        EXPECT_GT(count[method], 0) << method;
        EXPECT_GT(front[method], 0) << method;
    }
}

TEST_F(TransferSweep, WritesFilesThatStandAlone) {
    const test::TempFolder out;
    const std::string why = save_sweep(made(), {"clgi sweep <me>", "1.2.3"}, out.path());
    const std::string csv = text(out.path() / "sweep.csv");
    EXPECT_EQ(csv.rfind("method,series,sh-order,mask,mask-block,cells,table,coarse,rings,looks,spp,"
                        "ms,once ms,error full,front full,error smooth,front smooth,energy ratio\n",
                        0),
              0u)
        << csv.substr(0, 200);
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        bool quoted = false;
        int columns = 1;
        for (const char c : line) {
            if (c == '"') quoted = !quoted;
            columns += c == ',' && !quoted;
        }
        EXPECT_EQ(columns, 18) << line;
    }
    const auto json = nlohmann::json::parse(text(out.path() / "sweep.json"));
    EXPECT_EQ(json.at("points").size(), made().points.size());
    EXPECT_EQ(json.at("references").size(), 2u);
    for (const auto& point : json.at("points")) {
        EXPECT_EQ(point.contains("once_ms"), point.at("method") == transfer_sets);
        EXPECT_GT(point.value("once_ms", 1.0), 0.0);
    }
    if (!why.empty()) GTEST_SKIP() << why;
    const std::string page = text(out.path() / "index.html");
    EXPECT_NE(page.find("<h2>Visible sets</h2>"), std::string::npos);
    EXPECT_NE(page.find("places of vertices"), std::string::npos);
    EXPECT_EQ(page.find("<img"), std::string::npos) << "vertices are no picture";
    for (const char* name : {"error-full.svg", "error-smooth.svg"}) {
        const std::string plot = text(out.path() / name);
        for (const char* words :
             {"milliseconds for all vertices", "transfer, front", "two-level transfer, front",
              "transfer with visible sets, front", "path tracer"})
            EXPECT_NE(plot.find(words), std::string::npos) << words;
    }
}

// Receivers that look at what they see alone have the same masks, so the same error.
TEST_F(TransferSweep, LooksAtTheSceneAsItIs) {
    const auto sets = points_of(made(), "looks");
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ(sets[0]->knobs.at("looks"), "1");
    EXPECT_EQ(sets[0]->error, points_of(made(), "mask")[1]->error);
    EXPECT_GT(sets[0]->once_milliseconds.value_or(0.0), 0.0);
}

// Frames that were looked at lose nothing, and others the more, the farther they are from one.
TEST_F(TransferSweep, LooksAtFramesOfTheClip) {
    const Scene animated = moving_scene();
    const auto errors = [&](double seconds) {
        const Scene scene = posed(animated, pose_at(*animated.animation, 0, seconds));
        const test::TempFolder out;
        SweepSetup how = setup(scene, out.path());
        how.path_tracer = false;
        how.reference_samples = 256;
        const Sweep sweep = sweep_transfer(how, {&animated, 0});
        const auto looks = points_of(sweep, "looks");
        EXPECT_EQ(looks.size(), 2u);
        EXPECT_EQ(looks[0]->knobs.at("looks"), "2");
        EXPECT_EQ(looks[1]->knobs.at("looks"), "8");
        EXPECT_GT(*looks[1]->once_milliseconds, *looks[0]->once_milliseconds);
        return std::array{looks[0]->error, looks[1]->error, points_of(sweep, "mask")[1]->error};
    };
    const auto [two, eight, all] = errors(0.5);
    EXPECT_EQ(two, all);
    EXPECT_EQ(eight, all);
    const auto [few, more, every] = errors(1.0);  // the clip's end is none of them
    for (const std::size_t truth : {full_environment, smooth_environment}) {
        EXPECT_GT(few[truth], 2.0 * more[truth]);
        EXPECT_GT(more[truth], every[truth]);
    }
}

TEST_F(TransferSweep, KeepsItsReferences) {
    made();
    const auto file = folder().path() / "reference-smooth.exr";
    const auto written = std::filesystem::last_write_time(file);
    const Scene scene = small_scene();
    SweepSetup again = setup(scene, folder().path());
    again.solver = again.path_tracer = false;
    const Sweep second = sweep_transfer(again);
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    EXPECT_EQ(second.truths[1].picture.find("R")->values,
              made().truths[1].picture.find("R")->values);
}

TEST_F(TransferSweep, RefusesScenesWithoutEnvironment) {
    Scene scene = small_scene();
    const test::TempFolder out;
    scene.environment->factor = glm::vec3(0.0f);
    EXPECT_THROW(sweep_transfer(setup(scene, out.path())), InputError) << "black";
    scene.environment.reset();
    EXPECT_THROW(sweep_transfer(setup(scene, out.path())), InputError);
}

}  // namespace
}  // namespace clgi::lab
