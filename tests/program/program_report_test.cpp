// The commands that judge pictures: reference, sweep, replicates.
// SPDX-License-Identifier: MIT
#include <clgi/io/image.hpp>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using clgi::test::Outcome;
using Program = clgi::test::Program;

TEST_F(Program, ReferenceIsAPictureThatKnowsItsError) {
    const std::string scene = make("cornell");
    const Outcome outcome =
        run("reference " + scene + " -o " + file("r.exr").string() + " --png " +
            file("r.png").string() + " --size 32x24 --spp 400 --error 20% --stats " +
            file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto picture = clgi::io::load_image(file("r.exr"));
    EXPECT_EQ(picture.width, 32);
    EXPECT_EQ(picture.attributes.at("clgi:effects"), "all");
    EXPECT_NE(picture.find("error.Y"), nullptr);
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats.at("method"), "reference");
    EXPECT_LE(stats.at("relative_error"), 0.2);
    EXPECT_LT(stats.at("samples"), 400);
    EXPECT_EQ(stats.at("converged"), true);
    EXPECT_EQ(stats.at("non_finite"), 0);
    EXPECT_TRUE(fs::exists(file("r.png")));
}

TEST_F(Program, RefusesReferencesOfNothing) {
    const std::string scene = make("cornell");
    const std::string out = " -o " + file("r.exr").string() + " --quiet ";
    for (const char* flags : {"--effects sunshine", "--effects direct,,", "--spp 0", "--error 0%",
                              "--error x", "--size 0x1", "--threads -1", "--camera 9"})
        expect_one_error_line(run("reference " + scene + out + flags), 1);
    expect_one_error_line(run("reference " + scene), 1);
    expect_one_error_line(run("reference " + file("absent.glb").string() + out), 2);
    expect_one_error_line(run("reference " + scene + " --quiet --spp 1 --size 4x4 -o " +
                              file("no/folder/r.exr").string()),
                          2);
    EXPECT_FALSE(fs::exists(file("r.exr")));
}

TEST_F(Program, SweepsASceneIntoAFolder) {
    const std::string scene = make("cornell --light spot");
    const fs::path folder = file("sweep");
    const Outcome outcome = run("sweep " + scene + " -o " + folder.string() +
                                " --quick --size 40x30 --spp 16 --sheet-time 0.2s");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* name :
         {"index.html", "sweep.csv", "sweep.json", "reference-full.exr", "methods.png"})
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    const auto json = nlohmann::json::parse(read("sweep/sweep.json"));
    EXPECT_GT(json.at("points").size(), 20u);
    EXPECT_GE(json.at("summary").size(), 5u);
    EXPECT_NE(json.at("command").get<std::string>().find("--sheet-time 0.2s"), std::string::npos);
    for (const auto& line : json.at("summary"))
        EXPECT_NE(outcome.out.find(line.get<std::string>()), std::string::npos) << line;
    expect_one_error_line(run("sweep " + scene + " -o " + folder.string() + " --method vpl"), 1);
    for (const char* flags : {"--method antiradiance --sheet-time 1s", "--sheet-time 5",
                              "--method atlas --sheet-time 1s", "--convergence --sheet-time 1s"})
        expect_one_error_line(
            run("sweep " + scene + " --quiet -o " + folder.string() + " " + flags), 1);
    expect_one_error_line(run("sweep " + scene), 1);
    std::ofstream(file("taken")) << "a file";
    expect_one_error_line(run("sweep " + scene + " --quiet -o " + file("taken").string()), 2);
}

TEST_F(Program, SweepsALightAtlas) {
    const std::string scene = make("cornell --light spot");
    const std::string sweep = "sweep " + scene + " --quick -o " + file("sweep").string();
    const Outcome outcome = run(sweep + " --method atlas --atlas-size 32 --spp 16 --rounds 1");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* name : {"index.html", "sweep.csv", "sweep.json", "reference-atlas.exr"})
        EXPECT_TRUE(fs::exists(file("sweep") / name)) << name;
    const auto json = nlohmann::json::parse(read("sweep/sweep.json"));
    EXPECT_EQ(json.at("size"), (std::vector<int>{32, 32}));
    EXPECT_NE(json.at("command").get<std::string>().find(
                  "--method atlas --quick --atlas-size 32 --spp 16 --rounds 1"),
              std::string::npos);
    for (const auto& line : json.at("summary"))
        EXPECT_NE(outcome.out.find(line.get<std::string>()), std::string::npos) << line;
    const std::string reference = (file("sweep") / "reference-atlas.exr").string();
    for (const std::string& flags : std::vector<std::string>{
             "--method atlas --size 32x32", "--method atlas --camera 0", "--atlas-size 32",
             "--reference " + reference, "--method atlas --atlas-size 0"})
        expect_one_error_line(run(sweep + " --quiet " + flags), 1);
    for (const std::string& flags :
         std::vector<std::string>{"--atlas-size 33 --reference " + reference,
                                  "--reference " + file("absent.exr").string(), "--atlas-size 1"})
        expect_one_error_line(run(sweep + " --quiet --method atlas " + flags), 2);
}

TEST_F(Program, RendersReplicatesWithTheirStandardError) {
    const std::string scene = make("cornell --light spot");
    const Outcome outcome =
        run("render " + scene + " -o " + file("m.exr").string() +
            " --size 32x24 --replicates 4 --vpls 50 --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(clgi::io::load_image(file("m.exr")).find("error.Y"), nullptr);
    const auto stats = nlohmann::json::parse(read("s.json")).at("replicates");
    EXPECT_EQ(stats.at("count"), 4);
    EXPECT_GT(stats.at("error"), 0.0);
    EXPECT_NEAR(stats.at("single_error"), 2.0 * stats.at("error").get<double>(), 1e-9);
    expect_one_error_line(
        run("render " + scene + " -o " + file("n.exr").string() + " --replicates 1"), 1);
}

}  // namespace
