// clgi render --method antiradiance: pictures, statistics and refusals.
// SPDX-License-Identifier: MIT
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "rooms.hpp"

namespace {

using namespace clgi;
using nlohmann::json;

class AntiradianceProgram : public test::Program {
protected:
    std::string room() const {
        Scene scene = test::furnished_room(7);
        scene.cameras = {test::camera_at({0.15, 2.2, 2.85}, {2.4, 0.8, 1.2}, 1.1f)};
        const std::string path = file("room.glb").string();
        io::save_glb(scene, path);
        return path;
    }
    test::Outcome render(const std::string& flags) const {
        return run("render " + room() + " --method antiradiance --size 64x48 --elements 1000 -o " +
                   file("out.exr").string() + " " + flags);
    }
    double mean() const {
        const io::Image image = io::load_image(file("out.exr").string());
        double sum = 0.0;
        for (const float value : image.find("G")->values) sum += value;
        return sum / (64.0 * 48.0);
    }
};

TEST_F(AntiradianceProgram, RendersAndSaysWhatItDid) {
    const test::Outcome outcome =
        render("--bins 64 --frames 2 --orbit --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("elements"), std::string::npos);
    const json stats = json::parse(read("s.json"));
    EXPECT_EQ(stats.at("method"), "antiradiance");
    const json& found = stats.at("antiradiance");
    EXPECT_NEAR(found.at("leaves").get<double>(), 1000.0, 300.0);
    EXPECT_EQ(found.at("bins"), 64);
    EXPECT_EQ(found.at("iteration"), "symmetric");
    EXPECT_EQ(found.at("converged"), true);
    EXPECT_EQ(found.at("diverged"), false);
    EXPECT_EQ(found.at("given_up"), false);
    EXPECT_EQ(found.at("lets_through"), true);
    EXPECT_EQ(stats.at("converged"), true);
    EXPECT_TRUE(stats.at("warnings").empty());
    EXPECT_LT(found.at("residual"), 1e-3);
    EXPECT_GT(found.at("links"), 1000);
    EXPECT_EQ(stats.at("frames"), 2);
    bool local = false;
    for (const json& pass : stats.at("passes")) local |= pass.at("name") == "antiradiance.local";
    EXPECT_TRUE(local);
}

// Direct light is part of the picture unless it is left out; what more steps add is light.
TEST_F(AntiradianceProgram, HasTheLightThatWasAskedFor) {
    ASSERT_EQ(render("--quiet").code, 0);
    const double all = mean();
    ASSERT_EQ(render("--quiet --no-direct").code, 0);
    const double indirect = mean();
    ASSERT_EQ(render("--quiet --no-direct --iterations 1").code, 0);
    const double first = mean();
    EXPECT_GT(all, 1.2 * indirect);
    EXPECT_GT(indirect, 0.0);
    // One step has the first reflection, and nothing blocks it.
    EXPECT_NE(first, indirect);
    ASSERT_EQ(render("--quiet --no-direct --iteration asymmetric").code, 0);
    EXPECT_NEAR(mean(), indirect, 0.01 * indirect);
}

// With one bin for each leaf the light of the office grows without end, whatever the iteration.
TEST_F(AntiradianceProgram, TellsThatLightDivergedAndShowsNoneOfIt) {
    const std::string scene = make("office");
    const auto rendered = [&](const std::string& flags) {
        return run("render " + scene + " --size 64x48 -o " + file("out.exr").string() + " " +
                   flags);
    };
    const test::Outcome outcome = rendered(
        "--method antiradiance --elements 4000 --spread none --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string told = "the asymmetric iteration diverged";
    EXPECT_NE(outcome.err.find("warning: " + told), std::string::npos) << outcome.err;
    const json stats = json::parse(read("s.json"));
    EXPECT_EQ(stats.at("converged"), false);
    EXPECT_EQ(stats.at("non_finite"), 0);
    ASSERT_EQ(stats.at("warnings").size(), 1u);
    EXPECT_EQ(stats.at("warnings")[0].get<std::string>().find(told), 0u);
    const json& found = stats.at("antiradiance");
    EXPECT_EQ(found.at("given_up"), true);
    EXPECT_EQ(found.at("diverged"), true);
    EXPECT_EQ(found.at("converged"), false);
    const double shown = mean();
    ASSERT_EQ(rendered("--method direct --quiet").code, 0);
    EXPECT_GT(shown, 0.0);
    EXPECT_NEAR(shown, mean(), 1e-4 * shown);
}

// The residual of one step is 1, give or take rounding: that is no growth.
TEST_F(AntiradianceProgram, HasNoWordForASingleStep) {
    const std::string scene = make("cornell");
    for (const int elements : {500, 1000}) {
        const test::Outcome outcome =
            run("render " + scene + " --method antiradiance --bins 64 --size 16x12 -o " +
                file("out.exr").string() + " --iterations 1 --elements " +
                std::to_string(elements) + " --stats " + file("s.json").string());
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
        const json stats = json::parse(read("s.json"));
        EXPECT_TRUE(stats.at("warnings").empty());
        EXPECT_NEAR(stats.at("antiradiance").at("residual").get<double>(), 1.0, 1e-6);
    }
}

// Between shelves the symmetric iteration diverges; a spotlight that turns away from them brings no
// light that could. Of three frames the first is one to be told.
TEST_F(AntiradianceProgram, TellsOfFramesBeforeTheLast) {
    Scene scene = test::plain_scene(glm::vec3(0.6f));
    scene.materials[0].double_sided = true;
    const glm::dvec3 a(0, 0, 0), b(0, 0, 1), c(1, 0, 1), d(1, 0, 0), up(0, 1, 0);
    for (const double y : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0})
        test::add_quad(scene, {a + y * up, b + y * up, c + y * up, d + y * up});
    test::add_quad(scene, {a, b, b + up, a + up});
    test::add_quad(scene, {a, d, d + up, a + up});
    test::add_quad(scene, {b, c, c + up, b + up});
    scene.lights = {test::spot_light({1.3, 0.9, 0.5}, {-1.0f, 0.0f, 0.0f}, 0.4)};
    scene.lights[0].intensity = {100.0f, 90.0f, 80.0f};
    scene.cameras = {test::camera_at({2.5, 0.7, 0.5}, {0.5, 0.5, 0.5}, 0.7f)};
    const std::string path = file("shelves.glb").string();
    io::save_glb(scene, path);
    const test::Outcome outcome =
        run("render " + path +
            " --method antiradiance --iteration symmetric --elements 2000 "
            "--size 32x24 --frames 3 --spin-light -o " +
            file("out.exr").string() + " --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("the symmetric iteration diverged in 1 of 3 frames, first in frame "
                               "0;"),
              std::string::npos)
        << outcome.err;
    const json stats = json::parse(read("s.json"));
    ASSERT_EQ(stats.at("warnings").size(), 1u);
    const json& found = stats.at("antiradiance");
    EXPECT_EQ(found.at("given_up"), true);
    EXPECT_EQ(found.at("given_up_frames"), 1);
    EXPECT_EQ(found.at("diverged"), true);
    EXPECT_EQ(found.at("converged"), false);
    EXPECT_EQ(stats.at("converged"), false);
    EXPECT_EQ(found.at("residual"), 0.0);  // of the last frame
}

TEST_F(AntiradianceProgram, RefusesInOneLine) {
    const auto refused = [&](const std::string& flags, const std::string& part) {
        const test::Outcome outcome = render(flags);
        EXPECT_EQ(outcome.code, 1) << flags;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    };
    refused("--vpls 3", "--vpls goes not with --method antiradiance");
    refused("--mask 32", "--mask goes only with --method transfer");
    refused("--bins 33", "bins is 33, a multiple of 4 from 32 to 4096 needed");
    refused("--bins 8", "--bins");
    refused("--gbuffer gl", "--gbuffer gl goes not with --method antiradiance");
    refused("--camera 7", "--camera is 7, the scene has 1");
    refused("--iteration both", "--iteration");
    const test::Outcome other =
        run("render " + room() + " --bins 64 -o " + file("out.exr").string());
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("--bins goes only with --method antiradiance"), std::string::npos);
}

}  // namespace
