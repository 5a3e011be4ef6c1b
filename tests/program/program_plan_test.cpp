// clgi plan, and render --method auto.
// SPDX-License-Identifier: MIT
#include <clgi/io/image.hpp>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.hpp"

namespace {

using clgi::test::Outcome;
using clgi::test::Program;

TEST_F(Program, PlansBeforeItRenders) {
    const std::string scene = make("cornell --light spot");
    const Outcome text = run("plan " + scene + " --size 64x48 --time-budget 0.2s");
    ASSERT_EQ(text.code, 0) << text.err;
    for (const char* word : {"spot-light", "first-bounce", "indirect-occlusion", "predicted"})
        EXPECT_NE(text.out.find(word), std::string::npos) << word;

    const Outcome json = run("plan " + scene + " --size 64x48 --json");
    ASSERT_EQ(json.code, 0) << json.err;
    const auto plan = nlohmann::json::parse(json.out);
    EXPECT_EQ(plan.at("wish").at("width"), 64);
    EXPECT_EQ(plan.at("facts").at("triangles"), 30);
    ASSERT_EQ(plan.at("effects").size(), 15u);
    for (const auto& effect : plan.at("effects")) {
        EXPECT_EQ(effect.at("on") == true, effect.at("bound").is_null()) << effect;
        EXPECT_FALSE(effect.at("why").get<std::string>().empty());
    }
    EXPECT_GT(plan.at("once_ms").get<double>() + plan.at("frame_ms").get<double>(), 0.0);

    ASSERT_EQ(run("render " + scene + " --size 64x48 --quiet -o " + file("a.exr").string() +
                  " --stats " + file("s.json").string())
                  .code,
              0);
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats.at("method"), plan.at("method"));
    EXPECT_EQ(stats.at("plan").at("settings"), plan.at("settings"));
    EXPECT_FALSE(stats.contains("time_budget"));
}

// A first picture for a part of the time, and another if there are settings of less error for the
// rest. A bake's error is what its plan expects, of each attempt less; what records leave in doubt
// is known with the picture, and the plan after it expects less than that.
TEST_F(Program, UsesATimeByWhatItsFirstPictureTook) {
    const std::string scene = make("cornell --light spot");
    // On a GPU the first one has the finest settings already; on a busy CPU it may take it all.
    const bool gpu = run("devices").out.find("    CPU, ") == std::string::npos;
    for (const std::string method : {"", " --method cache"}) {
        ASSERT_EQ(run("render " + scene + " --size 64x48 --time-budget 2s --quiet -o " +
                      file("a.exr").string() + " --stats " + file("s.json").string() + method)
                      .code,
                  0);
        const auto stats = nlohmann::json::parse(read("s.json"));
        const auto& budget = stats.at("time_budget");
        EXPECT_EQ(budget.at("seconds"), 2.0);
        const auto& attempts = budget.at("attempts");
        const bool room = attempts[0].at("seconds").get<double>() < 0.5;
        ASSERT_GE(attempts.size(), !gpu && room ? 2u : 1u);
        const auto expected = [&](std::size_t i) {
            return attempts[i].at("expected").get<double>();
        };
        const double planned = stats.at("plan").at("error").get<double>();
        double sum = 1e-3 * stats.at("plan").at("ms").get<double>();
        for (std::size_t i = 0; i < attempts.size(); ++i) {
            sum += attempts[i].at("seconds").get<double>() +
                   1e-3 * attempts[i].at("refine_ms").get<double>();
            if (i > 0) {
                EXPECT_LT(expected(i), expected(i - 1)) << method;
            }
        }
        EXPECT_NEAR(budget.at("used").get<double>(), sum, 1e-6);
        EXPECT_EQ(attempts.back().at("refine_ms"), stats.at("samples").at("refine_ms"));
        if (attempts.size() > 1) {
            EXPECT_LT(planned, expected(attempts.size() - 2)) << method;
        }
        if (!stats.contains("cache")) {
            EXPECT_NEAR(planned, expected(attempts.size() - 1), 1e-12) << method;
        }
    }

    const Outcome late = run("render " + scene + " --size 64x48 --time-budget 0.01ms --quiet -o " +
                             file("a.exr").string());
    EXPECT_EQ(late.code, 0) << late.err;
    EXPECT_NE(late.err.find("of --time-budget were used"), std::string::npos) << late.err;
}

// What is expected of a picture once it is made: records of this box differ by more than those of
// furnished rooms err, and samples of a bake add what they differ by to what they leave of
// direct light.
TEST_F(Program, SaysWhatAPictureIsExpectedToErrBy) {
    const auto expected = [&](const std::string& scene, const std::string& flags) {
        const Outcome outcome =
            run("render " + make(scene) + " --size 64x48 --png " + file("a.png").string() +
                " --stats " + file("s.json").string() + flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const auto stats = nlohmann::json::parse(read("s.json"));
        const double out = stats.at("expected_error").get<double>();
        std::ostringstream percent;
        percent << ", error about " << std::setprecision(2) << 100.0 * out << " %";
        EXPECT_NE(outcome.out.find(percent.str()), std::string::npos) << outcome.out;
        return std::pair(out, stats.at("plan").at("error").get<double>());
    };
    // One picture, for which there is no time.
    const auto [of_records, of_kind] =
        expected("cornell --light point", " --method cache --time-budget 1ms --samples 1");
    EXPECT_GT(of_records, 1.3 * of_kind);
    const auto [of_one, planned] =
        expected("cornell", " --method atlas --time-budget 1ms --samples 1");
    EXPECT_NEAR(of_one, planned, 1e-9);
    const auto of_samples = [&](const std::string& count) {
        return expected("cornell", " --method atlas --time-budget 1ms --samples " + count).first;
    };
    EXPECT_GT(of_samples("16"), 2.0 * of_samples("256"));
}

// What a plan sets is what flags set: shadow maps of a bake too.
TEST_F(Program, RendersAPlanAsFlagsOfItsMethodDo) {
    const std::string render =
        "render " + make("cornell --light spot") + " --size 32x24 --full --samples 1";
    const std::string to = " --quiet -o " + file("a.exr").string() + " --stats ";
    ASSERT_EQ(
        run(render + " --with all --time-budget 1s --method atlas" + to + file("s.json").string())
            .code,
        0);
    const auto stats = nlohmann::json::parse(read("s.json"));
    const auto& plan = stats.at("plan");
    std::string flags = " --bounces 0";
    for (const auto& [flag, value] :
         {std::pair{"--vpls", plan.at("settings").at("vpls")},
          {"--atlas-size", stats.at("bake").at("atlas_size")},
          {"--shadow-size", plan.at("direct_light").at("shadow_size")},
          {"--face-size", plan.at("direct_light").at("face_size")},
          {"--area-samples", plan.at("direct_light").at("area_samples")}})
        flags += std::string(" ") + flag + " " + value.dump();
    ASSERT_EQ(
        run(render + " --method atlas" + flags + " --quiet -o " + file("b.exr").string()).code, 0);
    const clgi::io::Image planned = clgi::io::load_image(file("a.exr"));
    const clgi::io::Image given = clgi::io::load_image(file("b.exr"));
    for (const char* channel : {"R", "G", "B"})
        EXPECT_EQ(planned.find(channel)->values, given.find(channel)->values) << channel;
}

TEST_F(Program, OverrulesAPlan) {
    const std::string scene = make("cornell --light spot");
    const std::string render = "render " + scene + " --size 32x24 --time-budget 0.1s -o " +
                               file("a.exr").string() + " --stats " + file("s.json").string();
    const Outcome direct = run(render + " --without first-bounce");
    ASSERT_EQ(direct.code, 0) << direct.err;
    EXPECT_NE(direct.err.find("plan: direct"), std::string::npos) << direct.err;
    EXPECT_EQ(nlohmann::json::parse(read("s.json")).at("method"), "direct");
    ASSERT_EQ(run(render + " --with all --quiet").code, 0);
    for (const auto& effect : nlohmann::json::parse(read("s.json")).at("plan").at("effects"))
        EXPECT_EQ(effect.at("on"), true) << effect;
    // A request that nothing meets is met as nearly as can be, and a warning says so.
    const Outcome never = run(render + " --target-error 0.01% --quiet");
    EXPECT_EQ(never.code, 0);
    EXPECT_NE(never.err.find("the target error of 0.01 % is not reached"), std::string::npos)
        << never.err;
    // Flags of a method choose it.
    ASSERT_EQ(run("render " + scene + " --size 32x24 --vpls 20 --quiet -o " +
                  file("b.exr").string() + " --stats " + file("s.json").string())
                  .code,
              0);
    EXPECT_EQ(nlohmann::json::parse(read("s.json")).at("method"), "second-order");
}

// A time for all has one meaning, whatever the method: a plan of that method.
TEST_F(Program, PlansAMethodForATime) {
    const std::string scene = make("cornell --light spot");
    for (const std::string method : {"second-order", "atlas", "antiradiance"}) {
        SCOPED_TRACE(method);
        ASSERT_EQ(
            run("render " + scene + " --size 32x24 --time-budget 0.3s --quiet --method " + method +
                " -o " + file("a.exr").string() + " --stats " + file("s.json").string())
                .code,
            0);
        const auto stats = nlohmann::json::parse(read("s.json"));
        EXPECT_EQ(stats.at("method"), method);
        EXPECT_EQ(stats.at("plan").at("wish").at("seconds"), 0.3);
        EXPECT_EQ(stats.at("plan").at("wish").at("method"), method);
        EXPECT_FALSE(stats.contains("ask"));
    }
}

TEST_F(Program, RefusesWrongPlans) {
    const std::string scene = make("cornell");
    for (const char* flags :
         {"--with caustics", "--without", "--tolerance 0", "--size 0x3",
          "--with gloss --without gloss", "--time-budget 3", "--method fast", "--frame-time 20ms",
          "--animated --time-budget 1s", "--target-error=-1%", "--camera 3"})
        expect_one_error_line(run("plan " + scene + " --quiet " + flags), 1);
    expect_one_error_line(run("plan " + file("absent.glb").string()), 2);
    expect_one_error_line(run("plan " + scene + " --quiet --device nobody::"), 3);
    expect_one_error_line(run("render " + scene + " --quiet --method atlas --tolerance 2% -o " +
                              file("x.exr").string()),
                          1);
    EXPECT_FALSE(std::filesystem::exists(file("x.exr")));
}

}  // namespace
