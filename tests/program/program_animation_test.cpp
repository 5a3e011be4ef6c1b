// Animation in the program: --time, --animation and --fps.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cmath>

#include "moving_box.hpp"
#include "posing.hpp"
#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::GltfDraft;
using clgi::test::Outcome;
using clgi::test::Program;

class AnimationProgram : public Program {
protected:
    std::string keep(const GltfDraft& draft) const {
        std::ofstream(file("strip.gltf"), std::ios::binary) << draft.text();
        return file("strip.gltf").string();
    }
    std::string out(const std::string& name) const { return " -o " + file(name).string() + " "; }
    clgi::io::Image image(const std::string& name) const {
        return clgi::io::load_image(file(name));
    }
};

// Mean difference of two pictures, of the first one's mean.
double difference(const clgi::io::Image& a, const clgi::io::Image& b) {
    const auto values = [](const clgi::io::Image& image, const char* name) {
        for (const auto& channel : image.channels)
            if (channel.name == name) return channel.values;
        return std::vector<float>();
    };
    double sum = 0.0, whole = 0.0;
    for (const char* name : {"R", "G", "B"}) {
        const std::vector<float> of_a = values(a, name), of_b = values(b, name);
        EXPECT_EQ(of_a.size(), of_b.size());
        for (std::size_t p = 0; p < std::min(of_a.size(), of_b.size()); ++p) {
            sum += std::abs(of_a[p] - of_b[p]);
            whole += std::abs(of_a[p]);
        }
    }
    return sum / whole;
}

TEST_F(AnimationProgram, PlaysWhatTimePoses) {
    const std::string render =
        "render " + keep(clgi::test::strip_draft()) + " --size 96x72 --method direct ";
    ASSERT_EQ(run(render + out("rest.exr")).code, 0) << read("err");
    ASSERT_EQ(run(render + "--time 0" + out("a.exr")).code, 0) << read("err");
    ASSERT_EQ(run(render + "--time 1.0 --animation 0" + out("b.exr")).code, 0) << read("err");
    ASSERT_EQ(run(render + "--frames 3 --fps 2" + out("play.exr")).code, 0) << read("err");
    EXPECT_FALSE(fs::exists(file("play.exr")));
    EXPECT_FALSE(fs::exists(file("play.0003.exr")));
    // Roundings at edges; a directional light with another shadow map.
    EXPECT_LT(difference(image("rest.exr"), image("a.exr")), 0.02);
    EXPECT_LT(difference(image("play.0000.exr"), image("a.exr")), 0.05);
    EXPECT_LT(difference(image("play.0002.exr"), image("b.exr")), 0.05);
    EXPECT_GT(difference(image("a.exr"), image("b.exr")), 0.2);
    EXPECT_GT(difference(image("play.0001.exr"), image("b.exr")), 0.1);
    ASSERT_EQ(run(render + "--time 1 --fps 1" + out("late.exr")).code, 0) << read("err");
    EXPECT_EQ(difference(image("late.0000.exr"), image("play.0002.exr")), 0.0);
}

// The atlas of what stands still, with the light that goes through it, is about that of each pose.
TEST_F(AnimationProgram, PlaysThroughABake) {
    clgi::io::save_glb(clgi::test::moving_box_room(), file("box.glb"));
    const std::string render = "render " + file("box.glb").string() +
                               " --quiet --size 96x72 --method atlas --vpls 400 --atlas-size 96 ";
    ASSERT_EQ(run(render + "--fps 1 --frames 2" + out("play.exr")).code, 0) << read("err");
    for (const std::string time : {"0", "1"}) {
        ASSERT_EQ(run(render + "--time " + time + out("posed.exr")).code, 0) << read("err");
        EXPECT_LT(difference(image("posed.exr"), image("play.000" + time + ".exr")), 0.02) << time;
    }
    EXPECT_GT(difference(image("play.0000.exr"), image("play.0001.exr")), 0.03);
    // Lights that turn are those of the bake, too.
    ASSERT_EQ(run(render + "--fps 1 --frames 2 --spin-light" + out("turn.exr")).code, 0);
    ASSERT_EQ(run(render + "--time 1 --frames 2 --spin-light" + out("turned.exr")).code, 0);
    EXPECT_LT(difference(image("turned.exr"), image("turn.0001.exr")), 0.02);
    EXPECT_GT(difference(image("turn.0001.exr"), image("play.0001.exr")), 0.1);
}

TEST_F(AnimationProgram, PosesForTheReferenceAndForABake) {
    const std::string scene = keep(clgi::test::strip_draft());
    const std::string size = " --size 48x36 ";
    ASSERT_EQ(
        run("reference " + scene + size + "--spp 16 --effects direct --time 1" + out("r.exr")).code,
        0);
    ASSERT_EQ(run("render " + scene + size + "--method direct --time 1" + out("d.exr")).code, 0);
    EXPECT_LT(difference(image("r.exr"), image("d.exr")), 0.15);  // soft edges of pixels
    const std::string bake =
        "bake " + scene + " --vpls 20 --atlas-size 16 --hemicube-size 32 --direct ";
    ASSERT_EQ(run(bake + out("rest.exr")).code, 0) << read("err");
    ASSERT_EQ(run(bake + "--time 1" + out("bent.exr")).code, 0) << read("err");
    EXPECT_GT(difference(image("rest.exr"), image("bent.exr")), 0.01);
    EXPECT_EQ(run("render " + scene + size +
                  "--method atlas --vpls 20 --atlas-size 16 "
                  "--hemicube-size 32 --time 1" +
                  out("atlas.exr"))
                  .code,
              0)
        << read("err");
}

TEST_F(AnimationProgram, RefusesWhatItCannotPlay) {
    const std::string scene = keep(clgi::test::strip_draft());
    const std::string o = out("x.exr");
    expect_one_error_line(run("render " + make("cornell") + " --quiet --time 1" + o), 1);
    expect_one_error_line(run("render " + scene + " --quiet --animation run" + o), 1);
    expect_one_error_line(run("render " + scene + " --quiet --time nan" + o), 1);
    // Nothing of it stands still.
    expect_one_error_line(run("render " + scene + " --quiet --fps 24 --method atlas" + o), 2);
    expect_one_error_line(run("render " + scene + " --quiet --fps 24 --gbuffer gl" + o), 1);
    expect_one_error_line(run("render " + scene + " --quiet --fps 24 --replicates 2" + o), 1);
    for (const char* fps : {"0", "-1", "1e-308", "0.0009", "1000001", "inf", "nan"})
        expect_one_error_line(run("render " + scene + " --quiet --frames 2 --fps " + fps + o), 1);
}

TEST_F(AnimationProgram, AStepsCostIsTold) {
    const std::string strip = keep(clgi::test::strip_draft());
    const Outcome outcome = run("bench animation --repeats 3 --json --quiet --scene " + strip);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].at("scene"), "strip");
    EXPECT_EQ(rows[0].at("vertices"), 6);
    EXPECT_GT(rows[0].at("step_us"), 0.0);
    EXPECT_EQ(run("bench animation --quiet").err, "clgi: error: bench: animation needs --scene\n");
    const std::string still = make("box");
    EXPECT_EQ(run("bench animation --quiet --scene " + still).code, 1);
}

}  // namespace
