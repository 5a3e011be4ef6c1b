// --eye, --look-at and --light: the same scene for every command.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/io/image.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using clgi::io::Image;
using clgi::test::Outcome;

class SceneFlags : public clgi::test::Program {
protected:
    Image picture(const std::string& scene, const std::string& flags) const {
        const std::string exr = file("picture.exr").string();
        const Outcome outcome =
            run("render " + scene + " --method direct --size 64x48 --quiet -o " + exr + " --full " +
                flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return clgi::io::load_image(exr);
    }
};

double sum(const Image& picture, const char* channel) {
    double out = 0.0;
    for (const float value : picture.find(channel)->values) out += double{value};
    return out;
}

TEST_F(SceneFlags, SetTheIntensityOfALight) {
    const std::string scene = make("cornell --light spot");
    const Image before = picture(scene, ""),
                after = picture(scene, "--light 0:intensity=3,1.35,0.575");  // of 1.5, 1.35, 1.15
    ASSERT_GT(sum(before, "B"), 0.0);
    EXPECT_NEAR(sum(after, "R") / sum(before, "R"), 2.0, 1e-4);
    EXPECT_NEAR(sum(after, "G") / sum(before, "G"), 1.0, 1e-4);
    EXPECT_NEAR(sum(after, "B") / sum(before, "B"), 0.5, 1e-4);
}

// Seen from elsewhere under a light that was moved and turned: the path tracer finds the same.
TEST_F(SceneFlags, AreTheSameInEveryCommand) {
    const std::string scene = make("cornell --light spot");
    const std::string flags =
        "--eye 0.1,0.4,-0.7 --look-at 0.35,0.2,0.3 --light 0:position=0.2,0.5,0.2 "
        "--light 0:direction=0.2,-2,0.4 ";
    const Image other = picture(scene, ""), found = picture(scene, flags);
    EXPECT_NE(found.find("R")->values, other.find("R")->values);
    for (const char* given : {"", flags.c_str()}) {
        const Outcome outcome =
            run("verify " + file("picture.exr").string() + " " + scene +
                " --effects emission,direct --limit 300ms --json --quiet " + given);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const double error = nlohmann::json::parse(outcome.out)["value"];
        if (*given)
            EXPECT_LT(error, 0.1);  // edges of shadows
        else
            EXPECT_GT(error, 0.5);
    }
}

TEST_F(SceneFlags, AreRefusedInOneLine) {
    const std::string scene = make("cornell --light spot");
    const auto refused = [&](const std::string& flags, const std::string& says) {
        const Outcome outcome =
            run("render " + scene + " -o " + file("none.exr").string() + " " + flags);
        expect_one_error_line(outcome, 1);
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    };
    refused("--eye 1,2", "X,Y,Z in metres needed");
    refused("--look-at 1,2,nan", "X,Y,Z in metres needed");
    refused("--eye 1,2,3 --look-at 1,2,3", "the same place");
    refused("--light 1:position=1,2,3", "the scene has 1 lights");
    refused("--light position=1,2,3", "N:position=X,Y,Z needed");
    refused("--light 0:position", "N:position=X,Y,Z needed");
    refused("--light 0:position=1,2", "three numbers needed");
    refused("--light 0:colour=1,2,3", "position, direction or intensity needed");
    refused("--light 0:direction=0,0,0", "a direction needed");
    refused("--light 0:intensity=1,-1,1", "at least 0 needed");
    refused("--camera 1", "--camera is 1, the scene has 1");
    EXPECT_FALSE(std::filesystem::exists(file("none.exr")));
}

}  // namespace
