// render --verify and bake --verify: the error that they measure is the one that clgi compare
// finds.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/io/image.hpp>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "scene/luminance.hpp"

namespace {

using clgi::test::Outcome;
using clgi::test::Program;
using nlohmann::json;

class VerifyProgram : public Program {
protected:
    // What a picture is off a converged one.
    json compared(const std::string& picture, const std::string& truth) const {
        const Outcome outcome = run("compare --no-flip --json " + picture + " " + truth);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out);
    }

    // slack: the noise of the truth, and what one check in forty misses. How many samples are
    // taken depends on how busy the machine is.
    static void expect_in(const json& found, double wanted, double slack) {
        EXPECT_LE(found.at("low").get<double>(), wanted + slack) << found;
        EXPECT_GE(found.at("high").get<double>(), wanted - slack) << found;
        EXPECT_LE(found.at("low"), found.at("value"));
        EXPECT_LE(found.at("value"), found.at("high"));
    }
};

TEST_F(VerifyProgram, MeasuresTheErrorOfAPicture) {
    const std::string scene = make("cornell --light spot");
    const std::string exr = file("a.exr").string(), truth = file("t.exr").string();
    const Outcome outcome =
        run("render " + scene + " --size 64x48 --full --method second-order --verify 0.3s -o " +
            exr + " --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_EQ(run("reference " + scene + " --size 64x48 --spp 400 --quiet --full -o " + truth).code,
              0);
    EXPECT_NE(outcome.out.find(", measured error "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("), energy 0.7"), std::string::npos) << outcome.out;
    const json found = json::parse(read("s.json")).at("measured_error");
    const json compare = compared(exr, truth);
    // One bounce of many: some 37 %.
    expect_in(found, compare.at("luminance_error"), 0.03);
    EXPECT_NEAR(found.at("value").get<double>(), compare.at("luminance_error").get<double>(), 0.1);
    expect_in(found.at("energy"), compare.at("luminance_energy"), 0.02);
    EXPECT_GE(found.at("pixels"), 328);
    EXPECT_GT(found.at("samples"), 328 * 2);
    EXPECT_EQ(found.at("non_finite"), 0);
    EXPECT_GT(found.at("seconds"), 0.1);
    const clgi::io::Image image = clgi::io::load_image(exr);
    ASSERT_FALSE(found.at("largest").empty());
    for (const json& one : found.at("largest")) {
        const std::size_t at = one.at("pixel").at(1).get<std::size_t>() * 64 +
                               one.at("pixel").at(0).get<std::size_t>();
        double luminance = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            luminance += double{clgi::luminance_weights[c]} *
                         double{image.find(std::string(1, "RGB"[c]))->values.at(at)};
        EXPECT_NEAR(one.at("picture").get<double>(), luminance, 1e-3 * luminance) << one;
        EXPECT_GT(one.at("share"), 0.0);
        EXPECT_GE(one.at("deviation"), 0.0);
    }
    for (const auto& [name, value] : {std::pair{"clgi:measured_error", found.at("value")},
                                      {"clgi:measured_error_low", found.at("low")},
                                      {"clgi:measured_error_high", found.at("high")},
                                      {"clgi:measured_energy", found.at("energy").at("value")},
                                      {"clgi:measured_energy_low", found.at("energy").at("low")},
                                      {"clgi:measured_energy_high", found.at("energy").at("high")}})
        EXPECT_NEAR(std::stod(image.attributes.at(name)), value.get<double>(), 1e-5) << name;
}

TEST_F(VerifyProgram, LooksAtTheLastPicture) {
    // The camera goes around: another one's pixels would differ by half of the picture.
    const std::string scene = make("cornell --light spot");
    const auto error = [&](const std::string& flags) {
        const Outcome outcome =
            run("render " + scene +
                " --size 64x48 --method second-order "
                "--verify --quiet --png " +
                file("a.png").string() + " --stats " + file("s.json").string() + flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        return json::parse(read("s.json")).at("measured_error").at("low").get<double>();
    };
    EXPECT_LT(error(" --frames 2 --orbit"), 0.6);
    EXPECT_LT(error(" --replicates 2"), 0.4);
}

TEST_F(VerifyProgram, SaysWhereAPlanExpectedLess) {
    // One bounce in a bright sphere has a quarter of the light, and the plan knows spheres of less
    // albedo.
    const std::string scene = make("furnace --albedo 0.9");
    const Outcome outcome = run("render " + scene +
                                " --size 64x48 --time-budget 20ms --method second-order --verify "
                                "0.3s --png " +
                                file("a.png").string() + " --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json stats = json::parse(read("s.json"));
    ASSERT_LT(stats.at("expected_error"), stats.at("measured_error").at("low"));
    EXPECT_NE(outcome.err.find("clgi: warning: the plan expected an error of "), std::string::npos)
        << outcome.err;
    EXPECT_NE(stats.at("warnings").dump().find("the plan expected an error of "),
              std::string::npos);

    const Outcome better = run("render " + make("cornell --light spot") +
                               " --size 64x48 --time-budget 0.1s --method second-order --verify "
                               "--quiet --png " +
                               file("a.png").string());
    EXPECT_EQ(better.err.find("expected"), std::string::npos) << better.err;
}

TEST_F(VerifyProgram, MeasuresTheErrorOfABake) {
    const std::string scene = make("cornell --light spot");
    const std::string exr = file("a.exr").string(), truth = file("t.exr").string();
    const std::string gltf = file("u.glb").string();
    const Outcome outcome =
        run("bake " + scene + " --atlas-size 48 --vpls 200 --verify 0.3s -o " + exr +
            " --unwrapped " + gltf + " --stats " + file("s.json").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_EQ(
        run("reference " + gltf + " --atlas 48 --effects indirect --spp 400 --quiet -o " + truth)
            .code,
        0);
    EXPECT_NE(outcome.out.find(" s, measured error "), std::string::npos) << outcome.out;
    const json found = json::parse(read("s.json")).at("measured_error");
    const json compare = compared(exr, truth + " --mask " + truth);
    expect_in(found, compare.at("luminance_error"), 0.03);
    expect_in(found.at("energy"), compare.at("luminance_energy"), 0.02);
    EXPECT_NEAR(std::stod(clgi::io::load_image(exr).attributes.at("clgi:measured_error")),
                found.at("value").get<double>(), 1e-5);
}

TEST_F(VerifyProgram, RefusesWhatItCannotCheck) {
    const std::string scene = make("cornell");
    const std::string out = " -o " + file("a.exr").string();
    for (const std::string flags : {"--verify 5", "--verify 0s", "--verify --fps 10",
                                    "--verify --no-direct", "--verify --frames 3 --spin-light"})
        expect_one_error_line(run("render " + scene + out + " " + flags), 1);
    expect_one_error_line(run("bake " + scene + out + " --verify fast"), 1);
}

// A picture that is there: the error is what the check of the render found, from other pixels.
TEST_F(VerifyProgram, JudgesAPictureOfAnyOrigin) {
    const std::string scene = make("cornell --light spot");
    const std::string exr = file("a.exr").string(), truth = file("t.exr").string();
    ASSERT_EQ(
        run("render " + scene + " --size 64x48 --full --quiet --method second-order -o " + exr)
            .code,
        0);
    ASSERT_EQ(run("reference " + scene + " --size 64x48 --spp 400 --quiet --full -o " + truth).code,
              0);
    const Outcome outcome =
        run("verify " + exr + " " + scene + " --limit 0.3s --seed 5 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json found = json::parse(outcome.out), compare = compared(exr, truth);
    expect_in(found, compare.at("luminance_error"), 0.03);
    expect_in(found.at("energy"), compare.at("luminance_energy"), 0.02);
    const Outcome line = run("verify " + exr + " " + scene + " --limit 0.1s --quiet");
    EXPECT_NE(line.out.find("a.exr: measured error "), std::string::npos) << line.out;
    // Against direct light alone the picture has too much.
    const Outcome direct = run("verify " + exr + " " + scene +
                               " --limit 0.2s --effects emission,direct --json --quiet");
    EXPECT_GT(json::parse(direct.out).at("energy").at("low"), 1.02) << direct.out;

    // One pixel that is far too bright has nearly all of the error.
    clgi::io::Image wrong = clgi::io::load_image(exr);
    for (auto& channel : wrong.channels) channel.values[30 * 64 + 17] = 100.0f;
    clgi::io::save_exr(wrong, exr, clgi::io::PixelType::full);
    const Outcome where = run("verify " + exr + " " + scene + " --limit 0.1s --quiet");
    const std::string lines = where.out.substr(where.out.find('\n') + 1);
    EXPECT_NE(lines.find(" % of the squared error at 17,30: 1"), std::string::npos) << where.out;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << where.out;

    expect_one_error_line(run("verify " + file("none.exr").string() + " " + scene), 2);
    expect_one_error_line(run("verify " + scene + " " + scene), 2);
    expect_one_error_line(run("verify " + exr + " " + scene + " --limit soon"), 1);
    expect_one_error_line(run("verify " + exr + " " + scene + " --camera 7"), 1);
}

// --target-error is a promise: the picture is checked, and made by other settings until the check
// is within it, or the best is kept and the program says so.
TEST_F(VerifyProgram, GoesOnUntilTheErrorIsReached) {
    const std::string scene = make("cornell --light spot");
    const auto target = [&](const std::string& flags) {
        const Outcome outcome =
            run("render " + scene + " --size 32x24 --full --target-error " + flags + " -o " +
                file("a.exr").string() + " --stats " + file("s.json").string());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        json out = json::parse(read("s.json"));
        out["err"] = outcome.err;
        return out;
    };
    // However busy the machine is: the check ends when it is decided.
    const json easy = target("20% --verify 5s");
    EXPECT_EQ(easy.at("target").at("met"), true) << easy;
    EXPECT_EQ(easy.at("target").at("error"), 0.2);
    EXPECT_LE(easy.at("measured_error").at("high"), 0.2);
    // 32 samples would do, but more cost next to nothing.
    EXPECT_GT(easy.at("samples").at("count"), 32) << easy.at("samples");
    EXPECT_EQ(easy.at("err").get<std::string>().find("not reached"), std::string::npos);
    // Nothing reaches a thousandth of a percent: the settings become finer while there is time, the
    // best is kept, and a check that was decided soon is done once more in all of its time.
    const json hard = target("0.001% --time-budget 1s --without further-bounces");
    EXPECT_EQ(hard.at("target").at("met"), false) << hard;
    EXPECT_NE(hard.at("err").get<std::string>().find("the target error of 0.001 % is not reached"),
              std::string::npos)
        << hard;
    const json& attempts = hard.at("target").at("attempts");
    ASSERT_GE(attempts.size(), 1u);
    const json& last = hard.at("measured_error");
    EXPECT_GT(last.at("seconds"), 0.7 * 4.0);  // of which the first check took less, or all
    EXPECT_GT(last.at("low"), 0.01) << "there is more than one reflection";
    json best;
    for (const json& one : attempts) {
        const json& found = one.at("measured_error");
        if (best.is_null() || found.at("value") < best.at("value")) best = found;
    }
    EXPECT_LE(best.at("seconds"), last.at("seconds"));
    EXPECT_LE(best.at("low"), last.at("high"));
    EXPECT_GE(best.at("high"), last.at("low"));
}

// Stills by a plan have several samples, and say so wherever they are judged.
TEST_F(VerifyProgram, JudgesPicturesOfSeveralSamplesByWholePixels) {
    const std::string scene = make("cornell");
    const std::string exr = file("a.exr").string(),
                      to = " --quiet --full -o " + exr + " --stats " + file("s.json").string();
    const auto stats = [&](const std::string& flags) {
        const Outcome outcome = run("render " + scene + " --size 48x36 " + flags + to);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(read("s.json")).at("samples");
    };
    // However slow the device is; within a budget of time there may be one sample or many.
    const json still = stats("--verify 0.2s");
    EXPECT_GE(still.at("count"), 4);
    EXPECT_LE(still.at("count"), 1024);
    EXPECT_GT(still.at("refine_ms"), 0.0);
    EXPECT_EQ(clgi::io::load_image(exr).attributes.at("clgi:filter"), "box");
    const bool one = stats("--time-budget 0.3s").at("count") == 1;
    EXPECT_EQ(clgi::io::load_image(exr).attributes.at("clgi:filter"), one ? "center" : "box");
    // The lamp's edges are smooth, so that centres of pixels tell another truth.
    const auto error = [&](const std::string& flags) {
        const Outcome outcome = run("verify " + exr + " " + scene + " --json --limit 0.5s" + flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out).at("value").get<double>();
    };
    EXPECT_EQ(stats("--samples 64 --verify 0.5s").at("count"), 64);
    const json many = json::parse(read("s.json"));
    EXPECT_EQ(many.at("samples").at("refine_ms"), 0.0);
    const double by_centers = error(" --filter center");
    EXPECT_LT(error(""), 0.5 * by_centers);
    EXPECT_LT(many.at("measured_error").at("value").get<double>(), 0.5 * by_centers);

    for (const char* flags : {"--time-budget 0.1s --frames 2",
                              "--time-budget 0.1s --orbit --frames 2", "--method direct"}) {
        EXPECT_EQ(stats(flags).at("count"), 1) << flags;
        EXPECT_EQ(clgi::io::load_image(exr).attributes.at("clgi:filter"), "center") << flags;
    }
    const Outcome twice = run("render " + scene + " --samples 2 --replicates 2 -o " + exr);
    EXPECT_EQ(twice.code, 1);
    EXPECT_NE(twice.err.find("--samples goes not with --gbuffer gl or --replicates"),
              std::string::npos)
        << twice.err;
}

}  // namespace
