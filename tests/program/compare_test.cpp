// clgi compare as its users meet it: JSON, masks, difference pictures, refusals in one line.
// SPDX-License-Identifier: MIT
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "pictures.hpp"
#include "rgb_pictures.hpp"

namespace {

using rgb_pictures::drawn;
using rgb_pictures::grey;
using rgb_pictures::Image;

class Compare : public pictures::ImageIo {
protected:
    struct Outcome {
        int code;
        std::string out, err;
    };

    Outcome run(const std::string& arguments) const {
        const std::string command = CLGI_PROGRAM " compare " + arguments + " >" +
                                    at("out").string() + " 2>" + at("err").string();
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, pictures::bytes_of(at("out")),
                pictures::bytes_of(at("err"))};
    }

    std::string save(const std::string& name, const Image& image) const {
        clgi::io::save_exr(image, at(name), clgi::io::PixelType::full);
        return at(name).string();
    }

    nlohmann::json json(const std::string& arguments) const {
        const Outcome outcome = run(arguments + " --json");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    }

    void expect_refusal(const std::string& arguments, int code, const std::string& because) const {
        SCOPED_TRACE(arguments);
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, code);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err.rfind("clgi: error: ", 0), 0u) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(because), std::string::npos) << outcome.err;
    }

    // A pair that differs in the left half alone: 3 against 2, elsewhere 2.
    std::string pair() const {
        const Image a = drawn(8, 4, [](int x, int, int) { return x < 4 ? 3.0f : 2.0f; });
        return save("a.exr", a) + " " + save("b.exr", grey(8, 4, 2.0f));
    }
};

TEST_F(Compare, JsonHasEveryKey) {
    std::set<std::string> keys;
    const auto report = json(pair());
    for (const auto& [key, value] : report.items()) keys.insert(key);
    EXPECT_EQ(keys,
              (std::set<std::string>{"rmse", "rel_rmse", "luminance_error", "luminance_energy",
                                     "rel_mse", "psnr", "smape", "flip", "p999_abs", "max_abs",
                                     "max_at", "mean_a", "mean_b", "energy_ratio", "nonfinite_a",
                                     "nonfinite_b", "width", "height", "pixels"}));
    EXPECT_EQ(report.at("mean_a"), 2.5);
    EXPECT_DOUBLE_EQ(report.at("smape").get<double>(), 0.1);
    EXPECT_EQ(report.at("pixels"), 32);
    EXPECT_GT(report.at("flip"), 0.0);
    EXPECT_NEAR(report.at("luminance_error").get<double>(), 0.5 * std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(report.at("luminance_energy").get<double>(), 1.25, 1e-6);
}

TEST_F(Compare, EqualPicturesHaveNullForTheirPsnr) {
    const std::string a = save("a.exr", grey(1, 1, 0.0f));
    const auto report = json(a + " " + a);
    EXPECT_TRUE(report.at("psnr").is_null());
    EXPECT_EQ(report.at("flip"), 0.0);
    EXPECT_EQ(report.at("energy_ratio"), 1.0);
}

TEST_F(Compare, NoFlipLeavesItOut) {
    EXPECT_TRUE(json(pair() + " --no-flip").at("flip").is_null());
    EXPECT_EQ(run(pair() + " --no-flip").out.find("flip"), std::string::npos);
}

TEST_F(Compare, CountsOnlyTheRegion) {
    const auto left = json(pair() + " --region 0,0,4,4"),
               right = json(pair() + " --region 4,1,4,2");
    EXPECT_EQ(left.at("rmse"), 1.0);
    EXPECT_EQ(left.at("pixels"), 16);
    EXPECT_EQ(right.at("rmse"), 0.0);
    EXPECT_EQ(right.at("pixels"), 8);
}

TEST_F(Compare, TakesAMaskFromExrOrPng) {
    const Image mask = drawn(8, 4, [](int x, int y, int) { return x < 2 && y > 0 ? 1.0f : 0.0f; });
    std::vector<std::uint8_t> rgba;
    for (std::size_t i = 0; i < 32; ++i) {
        const std::uint8_t byte = mask.channels[0].values[i] != 0.0f ? 1 : 0;
        rgba.insert(rgba.end(), {byte, 0, 0, 255});
    }
    clgi::io::save_png(8, 4, rgba, at("m.png"));
    for (const std::string& file : {save("m.exr", mask), at("m.png").string()}) {
        const auto report = json(pair() + " --mask " + file);
        EXPECT_EQ(report.at("pixels"), 6) << file;
        EXPECT_EQ(report.at("rmse"), 1.0) << file;
        // Both at once: what lies in both.
        EXPECT_EQ(json(pair() + " --region 1,0,7,2 --mask " + file).at("pixels"), 1) << file;
    }
}

TEST_F(Compare, WritesADifferencePictureOfEveryKind) {
    for (const std::string show : {"difference", "size", "flip"}) {
        const std::string png = at(show + ".png").string();
        const auto outcome = run(pair() + " --diff " + png + " --show " + show);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Image picture = clgi::io::read_png(png);
        EXPECT_GE(picture.width, 8);
        EXPECT_GT(picture.height, 4);
    }
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
    const std::string a = save("wide.exr", grey(9, 4, 1.0f)),
                      b = save("high.exr", grey(4, 9, 1.0f));
    expect_refusal(a + " " + b, 2, "9x4");
    expect_refusal(a + " " + at("absent.exr").string(), 2, "no such file");
    Image two = grey(9, 4, 1.0f);
    two.channels.pop_back();
    expect_refusal(a + " " + save("two.exr", two), 2, "no channel B");
}

TEST_F(Compare, RefusesMasksThatSelectNothingOrDoNotFit) {
    expect_refusal(pair() + " --mask " + save("none.exr", grey(8, 4, 0.0f)), 2, "no pixel");
    expect_refusal(pair() + " --mask " + save("turned.exr", grey(4, 8, 1.0f)), 2, "4x8");
    expect_refusal(pair() + " --mask " + write("broken.png", "\x89PNG\r\n\x1a\n").string(), 2,
                   "PNG");
    expect_refusal(pair() + " --region 6,0,3,1", 2, "does not lie in");
    expect_refusal(pair() + " --region 0,0,0,4", 2, "does not lie in");
    const Image right = drawn(8, 4, [](int x, int, int) { return x < 4 ? 0.0f : 1.0f; });
    expect_refusal(pair() + " --region 0,0,4,4 --mask " + save("right.exr", right), 2, "no pixel");
    EXPECT_FALSE(std::filesystem::exists(at("d.png")));
}

TEST_F(Compare, WrongUseEndsWithOne) {
    expect_refusal(pair() + " --region 1,2,3", 1, "--region");
    expect_refusal(pair() + " --region 1,2,3,x", 1, "--region");
    expect_refusal(pair() + " --show flip", 1, "--show");
    expect_refusal(pair() + " --diff " + at("d.png").string() + " --show colours", 1, "--show");
    expect_refusal(pair() + " --diff " + at("d.png").string() + " --show flip --no-flip", 1,
                   "--no-flip");
    EXPECT_FALSE(std::filesystem::exists(at("d.png")));
}

}  // namespace
