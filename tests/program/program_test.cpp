// The program as its users meet it: commands, exit codes, one line on stderr, files whole or
// absent.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;
using Program = clgi::test::Program;

TEST_F(Program, ListsTheDeviceThatItWouldTake) {
    const Outcome outcome = run("devices");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("* "), std::string::npos) << outcome.out;
}

TEST_F(Program, RendersEveryProceduralSceneToAFinitePicture) {
    for (const std::string name :
         {"box", "cornell", "furnace", "corridor", "cloth", "chess", "fight-like", "hand-like",
          "maze", "office", "character", "oriental-like", "glossy-box", "glossy-bust-like"}) {
        const std::string scene = make(name);
        const fs::path exr = file(name + ".exr");
        const Outcome outcome =
            run("render " + scene + " -o " + exr.string() + " --png " +
                file(name + ".png").string() + " --time-budget 0.1s --size 64x48 --quiet");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        clgi::io::LoadReport report;
        const clgi::io::Image image = clgi::io::load_image(exr, &report);
        EXPECT_EQ(report.non_finite, 0u) << name;
        double sum = 0.0;
        for (const float value : image.find("G")->values) sum += value;
        EXPECT_GT(sum, 0.0) << name << " is black";
        EXPECT_EQ(image.attributes.at("clgi:unit"), "cd/m^2");
        EXPECT_GT(fs::file_size(file(name + ".png")), 100u);
    }
}

TEST_F(Program, TwoRunsGiveTheSameBytes) {
    const std::string scene = make("box");
    for (const char* name : {"a.exr", "b.exr"})
        ASSERT_EQ(run("render " + scene + " --size 65x47 --full --samples 4 --quiet -o " +
                      file(name).string())
                      .code,
                  0);
    EXPECT_EQ(read("a.exr"), read("b.exr"));
}

TEST_F(Program, StatsSayWhatWasDone) {
    const std::string scene = make("cornell --light spot");
    ASSERT_EQ(run("render " + scene + " --png " + file("p.png").string() +
                  " --method second-order --size 64x48 --frames 3 --orbit --stats " +
                  file("s.json").string())
                  .code,
              0);
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats.at("method"), "second-order");
    EXPECT_EQ(stats.at("frames"), 3);
    EXPECT_EQ(stats.at("scene").at("triangles"), 30);
    EXPECT_EQ(stats.at("non_finite"), 0);
    EXPECT_FALSE(stats.at("passes").empty());
    for (const char* key : {"clgi", "device", "effects", "memory_mb", "build_ms", "warnings"})
        EXPECT_TRUE(stats.contains(key)) << key;
}

TEST_F(Program, NoDirectAndDirectAddUpToTheWhole) {
    const std::string scene = make("box");
    const std::string common = "render " + scene + " --size 64x48 --full --quiet -o ";
    ASSERT_EQ(run(common + file("all.exr").string() + " --low-res off").code, 0);
    ASSERT_EQ(run(common + file("direct.exr").string() + " --method direct").code, 0);
    ASSERT_EQ(run(common + file("indirect.exr").string() + " --low-res off --no-direct").code, 0);
    const auto all = clgi::io::load_image(file("all.exr"));
    const auto direct = clgi::io::load_image(file("direct.exr"));
    const auto indirect = clgi::io::load_image(file("indirect.exr"));
    const auto& a = all.find("R")->values;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float sum = direct.find("R")->values[i] + indirect.find("R")->values[i];
        // One more rounding of each part than of the whole.
        EXPECT_NEAR(a[i], sum, 4e-6f * (std::abs(sum) + 1e-6f)) << i;
    }
}

TEST_F(Program, ComparesAPictureWithItself) {
    const std::string scene = make("cornell");
    const std::string exr = file("a.exr").string();
    ASSERT_EQ(run("render " + scene + " --size 32x32 --quiet -o " + exr).code, 0);
    const Outcome outcome = run("compare " + exr + " " + exr + " --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report.at("rmse"), 0.0);
    EXPECT_EQ(report.at("energy_ratio"), 1.0);
    EXPECT_EQ(report.at("nonfinite_a"), 0.0);
}

TEST_F(Program, WrongUseEndsWithOne) {
    expect_one_error_line(run("paint"), 1);
    expect_one_error_line(run("render"), 1);
    expect_one_error_line(run("scene nowhere -o " + file("x.glb").string()), 1);
    const std::string scene = make("cornell");
    expect_one_error_line(run("render " + scene + " --quiet"), 1);
    for (const char* flags : {"--size 0x4", "--size 4", "--low-res -1", "--low-res nan",
                              "--vpls -3", "--math slow", "--frames 0", "--camera 7"}) {
        SCOPED_TRACE(flags);
        expect_one_error_line(
            run("render " + scene + " --quiet -o " + file("x.exr").string() + " " + flags), 1);
        EXPECT_FALSE(fs::exists(file("x.exr")));
    }
}

// Times are the machine's own affair: only that they are told, and that more buys more.
TEST_F(Program, AFrameTimeIsAnsweredWithSettings) {
    const std::string scene = make("cornell --light spot");
    const auto ask = [&](const std::string& budget) {
        const Outcome outcome = run("render " + scene + " --png " + file("p.png").string() +
                                    " --method second-order --size 64x48 --frame-time " + budget +
                                    " --stats " + file("s.json").string());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("promised"), std::string::npos) << outcome.out;
        return nlohmann::json::parse(read("s.json")).at("ask");
    };
    const auto little = ask("15ms"), much = ask("0.12s");
    EXPECT_EQ(little.at("asked").at("frame_time_ms"), 15.0);
    EXPECT_EQ(much.at("asked").at("frame_time_ms"), 120.0);
    for (const auto& answer : {little, much}) {
        EXPECT_GT(answer.at("promised_ms"), 0.0);
        EXPECT_GT(answer.at("delivered_ms"), 0.0);
        EXPECT_GT(answer.at("probe_ms"), 0.0);
    }
    EXPECT_LT(little.at("settings").at("vpls"), much.at("settings").at("vpls"));
}

TEST_F(Program, ATargetOutOfReachIsAWarning) {
    const std::string scene = make("cornell --light spot");
    const Outcome outcome =
        run("render " + scene + " --png " + file("p.png").string() +
            " --method second-order --size 32x24 --target-error 1% --frame-time 1ms --stats " +
            file("s.json").string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("not reached within the frame time"), std::string::npos)
        << outcome.err;
    const auto ask = nlohmann::json::parse(read("s.json")).at("ask");
    EXPECT_EQ(ask.at("target_met"), false);
    EXPECT_TRUE(ask.at("promised_error").is_null());
    EXPECT_GT(ask.at("estimated_error"), 0.01);
}

TEST_F(Program, AResultIsAskedForInsteadOfSettings) {
    const std::string scene = make("box");
    const std::string render = "render " + scene + " --png " + file("p.png").string() + " ";
    for (const char* wrong :
         {"--target-error 0", "--target-error=-2%", "--target-error good", "--time-budget 0ms",
          "--time-budget=-3ms", "--time-budget soon", "--time-budget 33",
          "--target-error 2% --vpls 100", "--time-budget 33ms --negative-vpls 10",
          "--time-budget 33ms --low-res off", "--target-error 2% --low-res-step 2",
          "--target-error 2% --method direct", "--target-error 2% --method atlas",
          "--frame-time 33ms --vpls 10", "--frame-time soon", "--frame-time 33ms --time-budget 1s",
          "--frame-time 33ms --method direct", "--time-budget 1s --method atlas --bounces 3"})
        expect_one_error_line(run(render + wrong), 1);
    EXPECT_FALSE(fs::exists(file("p.png")));
}

TEST_F(Program, BadInputEndsWithTwoAndLeavesNoFile) {
    std::ofstream(file("broken.gltf")) << "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{}]}";
    const std::string out = " --quiet -o " + file("x.exr").string();
    expect_one_error_line(run("render " + file("broken.gltf").string() + out), 2);
    expect_one_error_line(run("render " + file("absent.glb").string() + out), 2);
    EXPECT_FALSE(fs::exists(file("x.exr")));
    const std::string scene = make("cornell");
    expect_one_error_line(
        run("render " + scene + " --size 16x16 --quiet -o " + file("no/such/folder.exr").string()),
        2);
}

TEST_F(Program, AMissingDeviceEndsWithThree) {
    const std::string scene = make("cornell");
    const std::string out = "render " + scene + " --quiet -o " + file("x.exr").string();
    const Outcome none = run(out, "OCL_ICD_VENDORS=" + file("empty").string() + "/");
    expect_one_error_line(none, 3);
    EXPECT_NE(none.err.find("pocl-opencl-icd"), std::string::npos) << none.err;
    expect_one_error_line(run(out + " --device nobody::"), 3);
    EXPECT_FALSE(fs::exists(file("x.exr")));
}

TEST_F(Program, AFailingCompilerOrTooLittleMemoryEndsWithThree) {
    const std::string scene = make("cornell");
    const std::string out = "render " + scene + " --quiet -o " + file("x.exr").string();
    const Outcome huge =
        run(out + " --method second-order --size 16384x16384", "POCL_MEMORY_LIMIT=1");
    if (huge.code == 0)  // a device of 30 GB can
        fs::remove(file("x.exr"));
    else
        expect_one_error_line(huge, 3);
    // Drivers other than PoCL do not know the variables.
    if (run("devices").out.find("* Portable Computing Language: ") != std::string::npos) {
        EXPECT_NE(huge.err.find("lower width and height"), std::string::npos) << huge.err;
        const Outcome refused =
            run(out + " --size 16x16 --vpls 4",
                "POCL_KERNEL_CACHE=0 POCL_EXTRA_BUILD_FLAGS=-Dkernel=no_such_word");
        EXPECT_EQ(refused.code, 3) << refused.err;
        EXPECT_EQ(own_lines(refused.err), 1) << refused.err;  // PoCL's clang writes some as well
        EXPECT_NE(refused.err.find("clgi: error: program: gbuffer/"), std::string::npos)
            << refused.err;
        EXPECT_NE(refused.err.find(".cl does not build on"), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find("no_such_word"), std::string::npos) << refused.err;  // the log
    }
    expect_one_error_line(run(out, "CLGI_DEVICE=nobody::"), 3);
    expect_one_error_line(run(out, "CLGI_DEVICE=:TPU:"), 1);
    EXPECT_FALSE(fs::exists(file("x.exr")));
}

// oclgrind as a second OpenCL beside the first. Its options are those of tests/support/oclgrind.sh,
// and it compiles with no other driver in the process for the reason given there.
TEST_F(Program, ASecondPlatformIsListedAndCanBeChosen) {
    const char* driver = "/usr/lib/oclgrind/liboclgrind-rt-icd.so";
    if (!fs::exists(driver)) GTEST_SKIP() << "oclgrind's driver is not at " << driver;
    for (const char* folder : {"both", "second"}) {
        fs::create_directories(file(folder));
        std::ofstream(file(folder) / "second.icd") << driver << '\n';
    }
    for (const auto& entry : fs::directory_iterator("/etc/OpenCL/vendors"))
        fs::copy_file(entry.path(), file("both") / entry.path().filename());
    const Outcome list =
        run("devices --device oclgrind", "OCL_ICD_VENDORS=" + file("both").string() + "/");
    ASSERT_EQ(list.code, 0) << list.err;
    EXPECT_NE(list.out.find("* Oclgrind"), std::string::npos) << list.out;
    EXPECT_NE(list.out.find("\n  "), std::string::npos) << list.out;  // and others, not taken

    const std::string render = "render " + make("cornell") +
                               " --size 16x12 --vpls 4 --negative-vpls 2 --face-size 8 "
                               "--area-samples 1 --full --quiet -o ";
    const Outcome there = run(render + file("there.exr").string() + " --device oclgrind",
                              "OCL_ICD_VENDORS=" + file("second").string() +
                                  "/ OCLGRIND_BUILD_OPTIONS='-cl-opt-disable "
                                  "-Dalways_inline=noinline -DCLGI_ATOMICS_ONLY'");
    ASSERT_EQ(there.code, 0) << there.err;
    ASSERT_EQ(run(render + file("here.exr").string()).code, 0);
    const auto report =
        nlohmann::json::parse(run("compare --no-flip --json " + file("there.exr").string() + " " +
                                  file("here.exr").string())
                                  .out);
    EXPECT_EQ(report.at("nonfinite_a"), 0.0);
    // Roots and quotients may round otherwise there: a unit in the last place of floats.
    EXPECT_LT(report.at("rel_rmse").get<double>(), 1e-6);
}

TEST_F(Program, TheLayersCostIsTold) {
    const Outcome outcome = run("bench layer --repeats 3 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    ASSERT_EQ(rows.size(), 5u);
    for (const auto& row : rows) {
        EXPECT_GT(row.at("by_hand_ms"), 0.0) << row;
        EXPECT_GT(row.at("library_ms"), 0.0) << row;
    }
}

TEST_F(Program, FastMathStaysCloseToStrict) {
    const std::string scene = make("box");
    const std::string common =
        "render " + scene + " --method second-order --size 96x72 --quiet -o ";
    ASSERT_EQ(run(common + file("s.exr").string()).code, 0);
    ASSERT_EQ(run(common + file("f.exr").string() + " --math fast").code, 0);
    const Outcome outcome =
        run("compare " + file("f.exr").string() + " " + file("s.exr").string() + " --json");
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report.at("nonfinite_a"), 0.0);
    // Rounding moves a few shadow edges by a texel; the picture as a whole stays.
    EXPECT_LT(report.at("rel_rmse").get<double>(), 0.01);
}

}  // namespace
