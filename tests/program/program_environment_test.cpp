// The program with --environment, and --atlas: flags, exit codes, files.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "program.hpp"
#include "scenes.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;
using Program = clgi::test::Program;
using clgi::io::Image;
using clgi::io::load_image;

// Two halves, each of one colour: red, green and blue are these multiples.
constexpr float tint[3] = {0.5f, 1.0f, 2.25f};

Image sky_picture(float left, float right) {
    Image sky;
    sky.width = 4;
    sky.height = 2;
    for (int c = 0; c < 3; ++c) {
        const float l = tint[c] * left, r = tint[2 - c] * right;
        sky.channels.push_back({std::string(1, "RGB"[c]), {l, l, r, r, l, l, r, r}});
    }
    return sky;
}

// A floor in the open without any lamp, its lightmap in the given UV set.
clgi::Scene floor_scene(int uv_set) {
    clgi::Scene scene = clgi::test::plain_scene(glm::vec3(1.0f));
    clgi::test::add_floor(scene, 1.0);
    for (const glm::vec2 uv : {glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)})
        scene.uvs.emplace_back(uv_set == 0 ? glm::vec4(uv, 0, 0) : glm::vec4(0, 0, uv));
    scene.cameras = {clgi::test::camera_at({0, 2, 3}, {0, 0, 0})};
    return scene;
}

TEST_F(Program, RendersUnderAnEnvironmentAsTheReferenceDoes) {
    const std::string scene = file("floor.glb").string();
    clgi::io::save_glb(floor_scene(1), scene);
    const std::string sky = file("sky.exr").string();
    clgi::io::save_exr(sky_picture(1.0f, 3.0f), sky, clgi::io::PixelType::full);
    const std::string flags = " --size 32x24 --full --environment " + sky +
                              " --environment-rotation 90 --environment-scale 2 -o ";
    const Outcome rendered = run("render " + scene + flags + file("a.exr").string() +
                                 " --environment-lights 64 --stats " + file("s.json").string());
    ASSERT_EQ(rendered.code, 0) << rendered.err;
    EXPECT_EQ(rendered.err.find("pi lux"), std::string::npos) << rendered.err;
    const auto effects = nlohmann::json::parse(read("s.json")).at("effects").dump();
    EXPECT_NE(effects.find("environment"), std::string::npos) << effects;
    ASSERT_EQ(run("reference " + scene + flags + file("b.exr").string() + " --spp 64").code, 0);
    const Image a = load_image(file("a.exr")), b = load_image(file("b.exr"));
    for (int c = 0; c < 3; ++c) {
        const std::string channel(1, "RGB"[c]);
        const auto& found = a.find(channel)->values;
        const auto& wanted = b.find(channel)->values;
        // A quarter turn to the left takes the left half behind the camera: ahead both meet.
        EXPECT_EQ(found[0], wanted[0]);
        EXPECT_EQ(found[31], wanted[31]);
        EXPECT_EQ(found[0], 2.0f * tint[2 - c] * 3.0f);
        // The floor has albedo 1 and sees half of either half, wherever it is.
        const double left = 2.0 * tint[c] * 1.0, right = 2.0 * tint[2 - c] * 3.0;
        const double even = 0.5 * (left + right);
        double mean = 0.0, traced = 0.0, noise = 0.0;
        int floor = 0;
        for (std::size_t p = 0; p < found.size(); ++p) {
            if (found[p] == found[0]) continue;
            ++floor;
            mean += found[p];
            traced += wanted[p];
            noise += std::pow(double{b.find("error.Y")->values[p]}, 2);
        }
        ASSERT_GT(floor, 100);
        // Each of 64 lights has the light of 4 pi / 64 sr in one direction, where it falls more
        // steeply than over 0.44 rad: by 1 - 0.44^2 / 12, and by more where a region is long.
        EXPECT_NEAR(mean / floor / even, 1.02, 0.025) << channel;
        // Four standard errors: stated for luminance, in proportion for one channel.
        const double luminance = 0.2126 * (6 * tint[2] - 2 * tint[0]) + 0.7152 * 4 +
                                 0.0722 * (6 * tint[0] - 2 * tint[2]);
        EXPECT_NEAR(traced / floor, even,
                    4 * std::sqrt(noise) / floor * std::abs(right - left) / luminance)
            << channel;
    }
}

TEST_F(Program, TakesAColourForAnEnvironment) {
    const std::string scene = file("floor.glb").string();
    clgi::io::save_glb(floor_scene(1), scene);
    const std::string out = file("a.exr").string();
    ASSERT_EQ(run("reference " + scene +
                  " --size 8x8 --spp 4 --full --quiet --environment 1,2.5,3 -o " + out)
                  .code,
              0);
    const Image image = load_image(out);
    for (const float value : image.find("G")->values) EXPECT_NEAR(value, 2.5f, 1e-5f);
}

TEST_F(Program, RefusesWhatIsNoEnvironment) {
    const std::string scene = make("cornell");
    const std::string common = " --quiet --size 8x8 -o " + file("x.exr").string();
    std::ofstream(file("text.exr")) << "not a picture";
    Image grey = sky_picture(1, 1);
    grey.channels.resize(1);
    clgi::io::save_exr(grey, file("grey.exr"), clgi::io::PixelType::full);
    for (const std::string command : {"render ", "reference "}) {
        const auto with = [&](const std::string& flags) {
            return run(command + scene + common + " " + flags);
        };
        expect_one_error_line(with("--environment " + file("none.hdr").string()), 2);
        expect_one_error_line(with("--environment " + file("text.exr").string()), 2);
        expect_one_error_line(with("--environment " + file("grey.exr").string()), 2);
        expect_one_error_line(with("--environment 1,2"), 2);  // a file of that name
        expect_one_error_line(with("--environment=-1,2,3"), 1);
        expect_one_error_line(with("--environment 1,2,3 --environment-scale=-1"), 1);
        expect_one_error_line(with("--environment-rotation 90"), 1);
        EXPECT_FALSE(fs::exists(file("x.exr")));
    }
    expect_one_error_line(run("render " + scene + common + " --environment-lights 5000"), 1);
}

TEST_F(Program, WarnsOfWhatIsOddInAnEnvironment) {
    const std::string scene = make("cornell");
    Image odd = sky_picture(1, 2);
    odd.channels[1].values[3] = -4.0f;
    clgi::io::save_exr(odd, file("odd.exr"), clgi::io::PixelType::full);
    const Outcome outcome = run("reference " + scene + " --size 8x8 --spp 1 --environment " +
                                file("odd.exr").string() + " -o " + file("x.exr").string());
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("1 samples were negative"), std::string::npos) << outcome.err;

    // A sun beyond the numbers of its file is as bright as the brightest sample beside it.
    Image sun = sky_picture(1, 2);
    for (Image::Channel& channel : sun.channels) channel.values[5] = INFINITY;
    sun.channels[0].values[1] = NAN;
    clgi::io::save_exr(sun, file("sun.exr"), clgi::io::PixelType::full);
    clgi::io::save_glb(floor_scene(1), file("floor.glb"));
    const Outcome sunny = run("reference " + file("floor.glb").string() +
                              " --size 64x64 --spp 1 --effects emission --full --environment " +
                              file("sun.exr").string() + " -o " + file("s.exr").string());
    ASSERT_EQ(sunny.code, 0) << sunny.err;
    EXPECT_NE(sunny.err.find("4 samples were negative"), std::string::npos) << sunny.err;
    float brightest = 0.0f;
    for (const float value : load_image(file("s.exr")).find("G")->values)
        brightest = std::max(brightest, value);
    EXPECT_EQ(brightest, 2.0f * tint[2]);
}

TEST_F(Program, LightsTheTexelsOfALightmap) {
    for (const int set : {0, 1}) {
        const std::string scene = file("floor.glb").string();
        clgi::io::save_glb(floor_scene(set), scene);
        const Outcome outcome = run("reference " + scene + " --atlas 16 --spp 16 --full -o " +
                                    file("a.exr").string() + " --png " + file("a.png").string() +
                                    " --environment 1,2,3 --stats " + file("s.json").string());
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("256 texels of uv set " + std::to_string(set)),
                  std::string::npos)
            << outcome.out;
        const Image atlas = load_image(file("a.exr"));
        EXPECT_EQ(atlas.width, 16);
        EXPECT_EQ(atlas.attributes.at("clgi:quantity"), "irradiance");
        EXPECT_EQ(atlas.attributes.at("clgi:unit"), "lux");
        for (const float value : atlas.find("G")->values)
            EXPECT_NEAR(value, 2 * std::numbers::pi_v<float>, 1e-4f);
        for (const float alpha : atlas.find("A")->values) EXPECT_EQ(alpha, 1.0f);
        EXPECT_NE(atlas.find("error.Y"), nullptr);
        EXPECT_EQ(nlohmann::json::parse(read("s.json")).at("texels"), 256);
        EXPECT_TRUE(fs::exists(file("a.png")));
    }
}

TEST_F(Program, RefusesAnAtlasWithoutALightmap) {
    const std::string bare = make("cornell");
    const std::string out = " -o " + file("x.exr").string() + " --quiet";
    expect_one_error_line(run("reference " + bare + " --atlas 16" + out), 2);
    clgi::Scene overlapping = floor_scene(1);
    clgi::test::add_floor(overlapping, 1.0, 1.0);
    for (std::size_t i = 0; i < 4; ++i) overlapping.uvs.push_back(overlapping.uvs[i]);
    clgi::io::save_glb(overlapping, file("o.glb"));
    expect_one_error_line(run("reference " + file("o.glb").string() + " --atlas 16" + out), 2);
    clgi::io::save_glb(floor_scene(1), file("f.glb"));
    const std::string fine = "reference " + file("f.glb").string() + out;
    expect_one_error_line(run(fine + " --atlas 16 --uv-set 0"), 2);
    expect_one_error_line(run(fine + " --atlas 0"), 1);
    expect_one_error_line(run(fine + " --atlas 16 --size 8x8"), 1);
    expect_one_error_line(run(fine + " --atlas 16 --camera 0"), 1);
    expect_one_error_line(run(fine + " --uv-set 0"), 1);
    EXPECT_FALSE(fs::exists(file("x.exr")));
}

}  // namespace
