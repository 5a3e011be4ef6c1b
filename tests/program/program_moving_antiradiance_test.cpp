// clgi render --method antiradiance --fps: what moves is lit where it is.
// SPDX-License-Identifier: MIT
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include "lab/scenes/deforming.hpp"

#include "program.hpp"

namespace {

using namespace clgi;
using nlohmann::json;

class MovingAntiradianceProgram : public test::Program {
protected:
    test::Outcome render(const std::string& flags, int elements = 1500) const {
        const std::string path = file("chess.glb").string();
        if (!std::filesystem::exists(path)) io::save_glb(chess(), path);
        return run("render " + path + " --method antiradiance --size 64x48 --elements " +
                   std::to_string(elements) + " --bins 64 --environment 1,1,1 -o " +
                   file("out.exr").string() + " " + flags);
    }
    std::vector<float> green(const std::string& name) const {
        return io::load_image(file(name).string()).find("G")->values;
    }
    static double apart(const std::vector<float>& a, const std::vector<float>& b) {
        double off = 0.0, all = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            off += std::pow(double(a[i]) - b[i], 2);
            all += std::pow(double(b[i]), 2);
        }
        return std::sqrt(off / all);
    }
};

TEST_F(MovingAntiradianceProgram, PlaysTheAnimation) {
    const test::Outcome outcome =
        render("--fps 1 --frames 2 --poses 4 --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("of them moving"), std::string::npos);
    const json stats = json::parse(read("s.json"));
    const json& found = stats.at("antiradiance");
    EXPECT_GT(found.at("moving_links"), 1000);
    EXPECT_GE(found.at("links"), found.at("moving_links"));
    int follow = 0;
    for (const json& pass : stats.at("passes"))
        for (const char* name : {"refit", "refit_clusters", "relink"})
            follow += pass.at("name") == std::string("antiradiance.") + name;
    EXPECT_EQ(follow, 3);
    const auto first = green("out.0000.exr"), second = green("out.0001.exr");
    EXPECT_GT(apart(first, second), 0.05);

    // The frame of a second is that of the scene posed there, with as many leaves: where nothing
    // moves, fewer would do.
    ASSERT_EQ(render("--time 1", found.at("leaves")).code, 0);
    EXPECT_LT(apart(second, green("out.exr")), 0.03);
    EXPECT_LT(apart(second, green("out.exr")), 0.3 * apart(first, second));
}

TEST_F(MovingAntiradianceProgram, RefusesInOneLine) {
    const test::Outcome outcome = render("--fps 1 --poses 0");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("--poses"), std::string::npos) << outcome.err;
}

}  // namespace
