// render --gbuffer gl: the picture of --gbuffer cl, and one clear line where there is no OpenGL.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/gl/context.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;

class GlProgram : public clgi::test::Program {
protected:
    // Why there is no OpenGL; empty where there is.
    static std::string missing() {
        try {
            const clgi::gl::HeadlessContext context;
            return "";
        } catch (const clgi::DeviceError& error) {
            return error.what();
        }
    }

    nlohmann::json compare(const std::string& a, const std::string& b) const {
        const Outcome outcome =
            run("compare " + file(a).string() + " " + file(b).string() + " --json");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    }
};

TEST_F(GlProgram, GivesThePictureOfTheOpenClRasteriser) {
    if (const std::string reason = missing(); !reason.empty()) GTEST_SKIP() << reason;
    for (const std::string name : {"box", "cornell", "corridor"}) {
        const std::string scene = make(name);
        for (const std::string by : {"cl", "gl"})
            ASSERT_EQ(run("render " + scene +
                          " --method second-order --size 160x120 --full --quiet --gbuffer " + by +
                          " -o " + file(by + ".exr").string())
                          .code,
                      0);
        const auto report = compare("gl.exr", "cl.exr");
        EXPECT_EQ(report.at("nonfinite_a"), 0.0);
        EXPECT_EQ(report.at("nonfinite_b"), 0.0);
        std::printf("%s: relative RMSE %.2g, largest difference %.2g of the mean\n", name.c_str(),
                    report.at("rel_rmse").get<double>(),
                    report.at("max_abs").get<double>() / report.at("mean_b").get<double>());
        // Positions that differ by rounding; a pixel on an edge may show the other surface, one in
        // a thousand, and a shadow's edge may fall on the other side of it.
        EXPECT_LT(report.at("rel_rmse").get<double>(), 0.005) << name;
        EXPECT_NEAR(report.at("energy_ratio").get<double>(), 1.0, 1e-4) << name;
    }
}

TEST_F(GlProgram, StoresHalvesAsTheOpenClRasteriserDoes) {
    if (const std::string reason = missing(); !reason.empty()) GTEST_SKIP() << reason;
    const std::string scene = make("cornell");
    for (const std::string by : {"cl", "gl"}) {
        const Outcome outcome =
            run("render " + scene +
                " --method second-order --size 160x120 --full --quiet --storage half --gbuffer " +
                by + " -o " + file(by + ".exr").string());
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    const auto report = compare("gl.exr", "cl.exr");
    EXPECT_EQ(report.at("nonfinite_a"), 0.0);
    EXPECT_LT(report.at("rel_rmse").get<double>(), 0.005);
    EXPECT_NEAR(report.at("energy_ratio").get<double>(), 1.0, 1e-4);
}

TEST_F(GlProgram, FollowsCameraAndLightsAndSaysWhatItUsed) {
    if (const std::string reason = missing(); !reason.empty()) GTEST_SKIP() << reason;
    const std::string scene = make("cornell --light spot");
    const auto turning = [&](const std::string& by) {
        const Outcome outcome =
            run("render " + scene +
                " --method second-order --size 64x48 --full --frames 3 --orbit --spin-light " +
                "--gbuffer " + by + " --stats " + file(by + ".json").string() + " -o " +
                file(by + ".exr").string());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.err;
    };
    turning("cl");
    const std::string said = turning("gl");
    EXPECT_LT(compare("gl.exr", "cl.exr").at("rel_rmse").get<double>(), 0.005);
    const auto cl = nlohmann::json::parse(read("cl.json"));
    const auto gl = nlohmann::json::parse(read("gl.json"));
    EXPECT_EQ(cl.at("gbuffer").at("by"), "cl");
    EXPECT_EQ(gl.at("gbuffer").at("by"), "gl");
    EXPECT_EQ(gl.at("frames"), 3);
    const std::string path = gl.at("gbuffer").at("path");
    EXPECT_TRUE(path.rfind("copied: ", 0) == 0 || path.rfind("zero copy: ", 0) == 0) << path;
    EXPECT_NE(said.find(path), std::string::npos) << said;
    EXPECT_NE(gl.at("gbuffer").at("renderer").get<std::string>().find("OpenGL"), std::string::npos);
}

TEST_F(GlProgram, RefusesWhatOnlyOpenClFramesCanDo) {
    const std::string scene = make("cornell");
    const std::string gl = "render " + scene + " --quiet --gbuffer gl -o " + file("x.exr").string();
    for (const char* flags : {" --replicates 2", " --target-error 2%", " --time-budget 20ms"})
        expect_one_error_line(run(gl + flags), 1);
    expect_one_error_line(run("render " + scene + " --gbuffer vulkan -o " + file("x.exr").string()),
                          1);
    EXPECT_FALSE(fs::exists(file("x.exr")));
}

// No driver is found where the loader of drivers is sent to an empty folder.
TEST_F(GlProgram, SaysWhatIsMissingWhereThereIsNoOpenGl) {
    const std::string scene = make("cornell");
    fs::create_directories(file("none"));
    const Outcome outcome =
        run("render " + scene + " --quiet --gbuffer gl -o " + file("x.exr").string(),
            "__EGL_VENDOR_LIBRARY_DIRS=" + file("none").string());
    expect_one_error_line(outcome, 3);
    EXPECT_NE(outcome.err.find("gl: no OpenGL context without a window: "), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("EGL does not list EGL_EXT_platform_base"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("libgl1-mesa-dri"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(file("x.exr")));
    // OpenCL frames need none of it.
    EXPECT_EQ(run("render " + scene + " --quiet --size 16x16 -o " + file("y.exr").string(),
                  "__EGL_VENDOR_LIBRARY_DIRS=" + file("none").string())
                  .code,
              0);
}

// Mesa can be told to claim an old version: the context is there and is not enough.
TEST_F(GlProgram, SaysWhatWasTriedWhereOpenGlIsTooOld) {
    if (const std::string reason = missing(); !reason.empty()) GTEST_SKIP() << reason;
    const std::string scene = make("cornell");
    const std::string gl =
        "render " + scene + " --quiet --size 16x16 --gbuffer gl -o " + file("x.exr").string();
    const Outcome outcome = run(gl, "MESA_GL_VERSION_OVERRIDE=2.1");
    if (outcome.code == 0) GTEST_SKIP() << "this OpenGL is not Mesa's";
    expect_one_error_line(outcome, 3);
    EXPECT_NE(outcome.err.find("surfaceless: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("; device"), std::string::npos) << outcome.err;
}

}  // namespace
