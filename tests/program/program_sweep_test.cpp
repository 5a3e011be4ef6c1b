// clgi sweep --method antiradiance, --method all and --convergence: files, what they say, refusals.
// SPDX-License-Identifier: MIT
#include <clgi/io/gltf.hpp>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "rooms.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;

class SweepProgram : public clgi::test::Program {
protected:
    std::string room() const {
        clgi::Scene scene = clgi::test::furnished_room(7);
        scene.cameras = {clgi::test::camera_at({0.15, 2.2, 2.85}, {2.4, 0.8, 1.2}, 1.1f)};
        const std::string path = file("room.glb").string();
        clgi::io::save_glb(scene, path);
        return path;
    }
    void expect_said(const Outcome& outcome, const nlohmann::json& json) const {
        EXPECT_GE(json.at("summary").size(), 4u);
        for (const auto& line : json.at("summary"))
            EXPECT_NE(outcome.out.find(line.get<std::string>()), std::string::npos) << line;
    }
};

TEST_F(SweepProgram, SweepsAntiradiance) {
    const Outcome outcome = run("sweep " + room() + " -o " + file("sweep").string() +
                                " --method antiradiance --quick --size 24x18 --spp 16 --rounds 1");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* name :
         {"index.html", "sweep.csv", "sweep.json", "reference-full.exr", "reference-indirect.exr"})
        EXPECT_TRUE(fs::exists(file("sweep") / name)) << name;
    const auto json = nlohmann::json::parse(read("sweep/sweep.json"));
    expect_said(outcome, json);
    EXPECT_EQ(json.at("size"), (std::vector<int>{24, 18}));
    EXPECT_EQ(json.at("command"),
              "clgi sweep room.glb -o sweep --method antiradiance --quick --size 24x18 --spp 16 "
              "--rounds 1");
    int points = 0;
    for (const auto& point : json.at("points"))
        if (point.at("method") == "antiradiance") {
            ++points;
            EXPECT_GT(point.at("once_ms"), 0.0);
            EXPECT_GT(point.at("ms"), 0.0);
            EXPECT_GT(point.at("estimated_error").at("full"), 0.0);
        }
    EXPECT_GE(points, 15);
}

TEST_F(SweepProgram, ShowsHowItConverges) {
    const std::string sweep = "sweep " + room() + " -o " + file("steps").string() + " ";
    const Outcome outcome = run(sweep + "--convergence --bins 32 --elements 500 --iterations 30");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(read("steps/convergence.json"));
    expect_said(outcome, json);
    EXPECT_EQ(json.at("command"),
              "clgi sweep room.glb -o steps --convergence --bins 32 "
              "--elements 500 --iterations 30");
    EXPECT_EQ(json.at("bins"), 32);
    ASSERT_EQ(json.at("curves").size(), 3u);
    for (const auto& curve : json.at("curves")) {
        ASSERT_EQ(curve.at("residuals").size(), 30u);
        EXPECT_LT(curve.at("errors").back(), curve.at("errors").front());
    }
    EXPECT_TRUE(fs::exists(file("steps") / "convergence.csv"));
    EXPECT_FALSE(fs::exists(file("steps") / "index.html"));
    for (const char* flags :
         {"--convergence --method antiradiance", "--convergence --size 8x8",
          "--convergence --spp 4", "--convergence --camera 0", "--convergence --bins 33",
          "--convergence --bins 8", "--convergence --iterations 0", "--bins 64", "--elements 100",
          "--iterations 9"})
        expect_one_error_line(run(sweep + "--quiet " + flags), 1);
    std::ofstream(file("taken")) << "a file";
    expect_one_error_line(
        run("sweep " + room() + " --convergence --quick --quiet -o " + file("taken").string()), 2);
}

}  // namespace
