// The light atlas in the program: bake, render --method atlas and bench schaerfig1.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "scenes.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;
using Program = clgi::test::Program;

const char* few = " --vpls 60 --atlas-size 32 --hemicube-size 32 ";

class AtlasProgram : public Program {
protected:
    std::string keep(const clgi::Scene& scene, const std::string& name) const {
        clgi::io::save_glb(scene, file(name));
        return file(name).string();
    }
    std::string out(const std::string& name) const { return " -o " + file(name).string() + " "; }
};

TEST_F(AtlasProgram, BakesToFilesThatAgree) {
    const std::string scene = make("cornell --light spot");
    const Outcome outcome =
        run("bake " + scene + few + out("a.exr") + "--png " + file("a.png").string() + " --gltf " +
            file("a.glb").string() + " --unwrapped " + file("b.glb").string() + " --stats " +
            file("a.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(own_lines(outcome.err), 1) << outcome.err;  // the device
    const clgi::io::Image atlas = clgi::io::load_image(file("a.exr"));
    EXPECT_EQ(atlas.width, 32);
    EXPECT_EQ(atlas.attributes.at("clgi:unit"), "lux");
    const auto stats = nlohmann::json::parse(read("a.json"));
    EXPECT_EQ(stats.at("method"), "atlas");
    EXPECT_EQ(stats.at("resumed_at"), 0);
    EXPECT_EQ(stats.at("non_finite"), 0);
    EXPECT_GE(stats.at("vpls"), 60);
    EXPECT_GT(stats.at("power").at("direct"), 0.0);
    for (const char* key : {"texels", "pages", "charts", "seconds", "passes", "memory_mb"})
        EXPECT_TRUE(stats.contains(key)) << key;
    int lit = 0;
    for (const float value : atlas.find("G")->values) lit += value > 0.0f;
    EXPECT_GT(lit, 200);
    // The preview is a PNG of the same size: its header says so, big end first.
    const std::string preview = read("a.png");
    ASSERT_GT(preview.size(), 100u);
    EXPECT_EQ(preview.substr(16, 8), std::string("\0\0\0\x20\0\0\0\x20", 8));
    EXPECT_EQ(stats.at("gltf").at("detail"), 1);
    for (const char* key : {"length", "difference", "worst"})
        EXPECT_GE(stats.at("seams").at(key), 0.0) << key;
    // The GLB has the atlas as UV set 1: baked again by it, it has the same texels.
    const Outcome again = run("bake " + file("b.glb").string() + few + "--uvs 1 --quiet" +
                              out("b.exr") + "--stats " + file("b.json").string());
    ASSERT_EQ(again.code, 0) << again.err;
    const auto other = nlohmann::json::parse(read("b.json"));
    EXPECT_NEAR(other.at("texels").get<double>(), stats.at("texels").get<double>(),
                0.01 * stats.at("texels").get<double>());
}

// Drafts come first; the last bake is the one without them.
TEST_F(AtlasProgram, SavesDraftsWithFewerVpls) {
    const std::string bake = "bake " + make("cornell --light spot") +
                             " --vpls 900 --atlas-size 48 --hemicube-size 32 -o ";
    ASSERT_EQ(run(bake + file("plain.exr").string() + " --quiet").code, 0);
    const Outcome outcome = run(bake + file("drafts.exr").string() + " --progressive");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("saved with 56 VPLs"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("saved with 225 VPLs"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("saved with 14 VPLs"), std::string::npos) << outcome.err;
    EXPECT_EQ(read("plain.exr"), read("drafts.exr"));
}

// A viewer of the GLB, here clgi itself, shows what the atlas shows: each pixel within the rounding
// of the texture's bytes, which is 4 % of dim light. On several pages too.
TEST_F(AtlasProgram, BakesAFileThatShowsTheLight) {
    const std::string scene = make("cornell --light spot");
    const std::string options = " --vpls 60 --atlas-size 64 --hemicube-size 32 ";
    ASSERT_EQ(run("bake " + scene + options + "--exposure 2 --quiet --pages 1 --gltf " +
                  file("lit.glb").string())
                  .code,
              0);
    ASSERT_EQ(run("render " + scene + options +
                  "--method atlas --no-direct --size 64x48 --full "
                  "--quiet" +
                  out("atlas.exr"))
                  .code,
              0);
    ASSERT_EQ(run("render " + file("lit.glb").string() +
                  " --method direct --area-samples 0 --size 64x48 --full --quiet" + out("lit.exr"))
                  .code,
              0);
    const clgi::io::Image atlas = clgi::io::load_image(file("atlas.exr")),
                          lit = clgi::io::load_image(file("lit.exr"));
    int compared = 0, apart = 0;
    for (const char* channel : {"R", "G", "B"}) {
        const auto &wanted = atlas.find(channel)->values, &found = lit.find(channel)->values;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const float value = 4.0f * wanted[i];
            if (value < 0.02f || value > 0.9f) continue;  // few bytes, and white
            ++compared;
            apart += std::abs(found[i] - value) > 0.04f * value;
        }
    }
    EXPECT_GT(compared, 1500);
    // At the edges of charts the viewer's filter reads texels around them as well.
    EXPECT_LT(apart, compared / 50);
}

TEST_F(AtlasProgram, WithoutLightEverythingIsZero) {
    clgi::Scene scene = clgi::test::plain_scene();
    clgi::test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    const std::string dark = keep(scene, "dark.glb");
    const Outcome outcome = run("bake " + dark + few + "--environment 0,0,0 --dilate --quiet" +
                                out("a.exr") + "--png " + file("a.png").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const clgi::io::Image atlas = clgi::io::load_image(file("a.exr"));
    for (const char* channel : {"R", "G", "B"})
        for (const float value : atlas.find(channel)->values) ASSERT_EQ(value, 0.0f);
}

TEST_F(AtlasProgram, BadInputEndsWithOneLineAndNoFile) {
    const std::string scene = make("cornell --light spot");
    const auto refused = [&](const std::string& arguments, int code) {
        SCOPED_TRACE(arguments);
        expect_one_error_line(run("bake " + arguments + out("x.exr") + "--quiet"), code);
        EXPECT_FALSE(fs::exists(file("x.exr")));
    };
    expect_one_error_line(run("bake " + scene + " --quiet"), 1);
    for (const char* command : {"bake ", "render ", "reference "})
        for (const char* wrong : {" --quiet -o wrong.png", " --quiet --png wrong.exr"})
            expect_one_error_line(run(command + scene + wrong), 1);
    expect_one_error_line(
        run("bake " + scene + " --quiet --progressive --unwrapped " + file("y.glb").string()), 1);
    for (const char* flags :
         {"--vpls 0", "--bounces -1", "--atlas-size 9000", "--atlas-size 0", "--hemicube-size 33",
          "--hemicube-size 2048", "--refine 3", "--threshold none", "--uvs 2", "--pages 0",
          "--padding 0", "--samples-per-vpl 0", "--texels-per-metre -1", "--size 64x64",
          "--gltf-lights", "--gltf-detail 2", "--direct --gltf-lights --gltf y.glb",
          "--gltf-detail 0 --gltf y.glb"})
        refused(scene + " " + flags, 1);
    refused(file("absent.glb").string(), 2);
    refused(scene + " --uvs 1", 2);                  // there is none
    refused(scene + " --texels-per-metre 1000", 2);  // does not fit
    clgi::Scene empty = clgi::test::plain_scene();
    empty.lights = {clgi::test::point_light({0, 1, 0})};
    refused(keep(empty, "empty.glb"), 2);
    // Refused before any of it is placed or allocated.
    refused(scene + " --vpls 1048576 --samples-per-vpl 4096", 3);
    expect_one_error_line(
        run("bake " + scene + few + "--quiet -o " + file("no/where/x.exr").string()), 2);
}

// A bake killed by Ctrl-C again and again, each time a little later, comes to the bits of one that
// was left alone, and no file is there before it is whole.
TEST_F(AtlasProgram, GoesOnAfterCtrlC) {
    const std::string scene = make("corridor");
    const std::string bake = "bake " + scene + " --vpls 900 --atlas-size 200 --bounces 1 ";
    ASSERT_EQ(run(bake + "--quiet" + out("whole.exr")).code, 0);
    const std::string file_name = file("state.bin").string();
    double wait = 0.4;
    int stopped = 0;
    for (int round = 0; round < 40; ++round, wait *= 1.25) {
        const std::string command = "timeout -s INT " + std::to_string(wait) + " " + CLGI_PROGRAM +
                                    " " + bake + "--resume " + file_name + out("parts.exr") +
                                    " 2>" + file("err").string() + " >/dev/null";
        const int status = std::system(
            ("sh -c '" + command + "; echo $? >" + file("code").string() + "'").c_str());
        ASSERT_EQ(status, 0);
        if (fs::exists(file("parts.exr"))) break;
        ++stopped;
        // timeout's own code; 130 before Ctrl-C was caught, and when it was.
        EXPECT_TRUE(read("code") == "124\n" || read("code") == "130\n") << read("code");
        for (const auto& entry : fs::directory_iterator(file("err").parent_path()))
            EXPECT_EQ(entry.path().filename().string().find("parts.exr"), std::string::npos);
    }
    EXPECT_GT(stopped, 0);
    EXPECT_EQ(read("parts.exr"), read("whole.exr"));
    EXPECT_FALSE(fs::exists(file_name)) << "a finished bake needs no state";
}

TEST_F(AtlasProgram, AStateOfAnotherBakeIsRefused) {
    const std::string scene = make("cornell --light spot");
    std::ofstream(file("state.bin")) << "nothing of the kind";
    const Outcome outcome = run("bake " + scene + few + "--quiet --resume " +
                                file("state.bin").string() + out("x.exr"));
    expect_one_error_line(outcome, 2);
    EXPECT_FALSE(fs::exists(file("x.exr")));
    EXPECT_EQ(read("state.bin"), "nothing of the kind");
}

TEST_F(AtlasProgram, RendersWithAnAtlas) {
    const std::string scene = make("cornell --light spot");
    const std::string render = "render " + scene + " --method atlas --size 40x30 --full ";
    const Outcome outcome = run(render + few + "--bounces 2 --frames 2 --orbit --spin-light" +
                                out("a.exr") + "--stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats.at("method"), "atlas");
    EXPECT_EQ(stats.at("frames"), 2);
    EXPECT_EQ(stats.at("non_finite"), 0);
    EXPECT_EQ(stats.at("effects"), nlohmann::json({"direct", "indirect"}));
    EXPECT_GE(stats.at("bake").at("vpls"), 60);
    for (const char* key : {"texels", "pages", "layout_ms", "bake_ms"})
        EXPECT_TRUE(stats.at("bake").contains(key)) << key;
    ASSERT_EQ(run(render + few + "--no-direct --quiet" + out("b.exr")).code, 0);
    double sum = 0.0;
    for (const float value : clgi::io::load_image(file("b.exr")).find("R")->values) sum += value;
    EXPECT_GT(sum, 0.0);
}

TEST_F(AtlasProgram, FlagsOfOneMethodAreNotTheOthers) {
    const std::string scene = make("cornell --light spot");
    const std::string render = "render " + scene + " --size 8x8 --quiet" + out("x.exr");
    for (const char* flags :
         {"--method atlas --negative-vpls 10", "--method atlas --low-res off",
          "--method atlas --low-res-step 2", "--method atlas --replicates 3",
          "--method atlas --frame-time 33ms", "--method atlas --target-error 2%",
          "--method atlas --gbuffer gl", "--method atlas --vpls 0", "--bounces 3",
          "--method direct --atlas-size 64", "--hemicube-size 64", "--refine 2"}) {
        SCOPED_TRACE(flags);
        expect_one_error_line(run(render + flags), 1);
        EXPECT_FALSE(fs::exists(file("x.exr")));
    }
}

TEST_F(AtlasProgram, RepeatsTheTableOfThePaper) {
    const Outcome outcome = run("bench schaerfig1 --most-vpls 100 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto table = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(table.at("table"), "schaerfig1");
    EXPECT_GT(table.at("peak_gflops"), 0.0);
    ASSERT_EQ(table.at("rows").size(), 4u);
    const double paper[] = {0.705, 0.705, 0.495, 0.495};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& row = table.at("rows")[i];
        EXPECT_EQ(row.at("paper"), paper[i]);
        EXPECT_EQ(row.at("filling"), i % 2 == 0 ? "gather" : "project");
        EXPECT_EQ(row.at("unit"), "s");
        EXPECT_TRUE(row.at("error").is_null());
        EXPECT_GT(row.at("clgi"), row.at("layout"));
        EXPECT_NEAR(row.at("ratio").get<double>(), paper[i] / row.at("clgi").get<double>(), 1e-9);
    }
    expect_one_error_line(run("bench schaerfig1 --most-vpls 99"), 1);
}

}  // namespace
