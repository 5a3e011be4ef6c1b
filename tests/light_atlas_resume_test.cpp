// A bake that is cancelled while the atlas is filled goes on to the bits of one that is not.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "frames.hpp"
#include "report/bake_state.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

Scene room() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_box(scene, glm::dvec3(-1.0), {1.0, 1.2, 1.4}, -1);
    scene.lights = {test::spot_light({0.2, 1.0, 0.3}, {-0.3f, -1.0f, -0.2f}, 0.6, 10.0f)};
    return scene;
}

struct Baker {
    explicit Baker(std::uint32_t vpls = 200, std::size_t budget = 0) {
        const Patches patches = make_patches(world);
        VplOptions vpl_options;
        vpl_options.count = vpls;
        AtlasOptions atlas_options;
        atlas_options.size = 40;
        options.memory_budget = budget;
        options.filling_size = 64;
        options.exchange_size = 64;
        options.bounces = 3;
        const AtlasLayout atlas = make_atlas(world, patches.triangle_patch, atlas_options);
        const VplLayout placed = place_vpls(world, patches, vpl_options);
        vpl_count = static_cast<std::uint32_t>(placed.vpls.size());
        solver = std::make_unique<LightAtlasSolver>(test::programs(), test::device().queue,
                                                    on_device, placed, atlas, options);
    }

    // Stops at the first report of at least this share.
    bool run_until(double share) {
        return solver->run([&](double done) { return done < share; });
    }

    Scene world = room();
    DeviceScene on_device = test::on_device(world);
    LightAtlasOptions options;
    std::uint32_t vpl_count = 0;
    std::unique_ptr<LightAtlasSolver> solver;
};

const std::vector<glm::vec3>& wanted() {
    static const std::vector<glm::vec3> bits = [] {
        Baker whole;
        EXPECT_TRUE(whole.solver->run());
        EXPECT_FALSE(whole.solver->state());
        return whole.solver->irradiance();
    }();
    return bits;
}

TEST(LightAtlasState, GoesOnToTheSameBits) {
    for (const double share : {0.45, 0.6, 0.8}) {
        Baker first;
        ASSERT_FALSE(first.run_until(share));
        const auto state = first.solver->state();
        ASSERT_TRUE(state);
        EXPECT_GT(state->filled_vpls, 0u);
        EXPECT_LT(state->filled_vpls, first.vpl_count);
        Baker second;
        second.solver->restore(*state);
        ASSERT_TRUE(second.solver->run());
        EXPECT_FALSE(second.solver->state());
        EXPECT_TRUE(test::same_bits(second.solver->irradiance(), wanted())) << share;
        EXPECT_EQ(second.solver->status().shots, 2 * second.vpl_count);
        // Whoever went on can start anew.
        ASSERT_TRUE(second.solver->run());
        EXPECT_TRUE(test::same_bits(second.solver->irradiance(), wanted())) << share;
    }
}

TEST(LightAtlasState, MayBeCutShortAgainAndAgain) {
    Baker baker;
    EXPECT_FALSE(baker.run_until(0.45));
    int rounds = 0;
    for (auto state = baker.solver->state(); state; state = baker.solver->state(), ++rounds) {
        ASSERT_LT(rounds, 20);
        Baker next;
        next.solver->restore(*state);
        int reports = 0;
        next.solver->run([&](double) { return ++reports < 3; });
        baker.solver->restore(*state);
        if (const auto later = next.solver->state()) {
            EXPECT_GE(later->filled_vpls, state->filled_vpls);
            // Cancelled before anything was done, the state is the one that was given.
            baker.solver->restore(*later);
        }
        if (rounds >= 3)
            baker.solver->run();
        else
            baker.run_until(0.5 + 0.15 * rounds);
    }
    EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted()));
}

TEST(LightAtlasState, IsKeptWhenTheNextRunIsCancelledAtOnce) {
    Baker first, second;
    ASSERT_FALSE(first.run_until(0.6));
    const auto state = first.solver->state();
    ASSERT_TRUE(state);
    second.solver->restore(*state);
    ASSERT_FALSE(second.run_until(0.0));
    const auto again = second.solver->state();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->filled_vpls, state->filled_vpls);
    EXPECT_TRUE(test::same_bits(again->irradiance, state->irradiance));
    EXPECT_TRUE(test::same_bits(again->light, state->light));
}

TEST(LightAtlasState, IsNoneBeforeTheFirstTexelIsLit) {
    Baker baker;
    EXPECT_FALSE(baker.solver->state());
    ASSERT_FALSE(baker.run_until(0.01));
    EXPECT_FALSE(baker.solver->state());
    ASSERT_TRUE(baker.solver->run());
    EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted()));
}

// What is asked for after the last texel comes too late.
TEST(LightAtlasState, IsNoneAtTheEnd) {
    Baker baker;
    EXPECT_TRUE(baker.run_until(1.0));
    EXPECT_FALSE(baker.solver->state());
}

TEST(LightAtlasState, OfAnotherSizeIsRefused) {
    Baker baker, other(120);
    ASSERT_FALSE(baker.run_until(0.45));
    LightAtlasState state = *baker.solver->state();
    EXPECT_THROW(other.solver->restore(state), Error);
    const auto refused = [&](LightAtlasState changed) {
        EXPECT_THROW(baker.solver->restore(changed), Error);
    };
    LightAtlasState changed = state;
    changed.filled_vpls = 0;
    refused(changed);
    changed.filled_vpls = state.vpls + 4;
    refused(changed);
    changed.filled_vpls = state.filled_vpls + 1;
    refused(changed);
    changed = state;
    changed.texels += 1;
    refused(changed);
    for (std::vector<float> LightAtlasState::*part :
         {&LightAtlasState::light, &LightAtlasState::balance, &LightAtlasState::irradiance,
          &LightAtlasState::filled}) {
        changed = state;
        (changed.*part).pop_back();
        refused(changed);
    }
    ASSERT_TRUE(baker.solver->run());  // nothing of it stayed behind
    EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted()));
}

TEST(LightAtlasSolver, NeedsAtLeastTheBytesThatAreCheckedBefore) {
    Baker baker;
    const std::size_t least = light_atlas_least_bytes(baker.vpl_count, 10 * baker.vpl_count);
    EXPECT_GT(least, 100 * 10 * baker.vpl_count);
    EXPECT_LT(least, baker.solver->bytes());
}

// ---- the file -----------------------------------------------------------------------------------

class BakeState : public testing::Test {
protected:
    void SetUp() override {
        file_ = std::filesystem::temp_directory_path() /
                ("clgi_bake_state_" + std::to_string(::getpid()));
        state_.vpls = 7;
        state_.texels = 3;
        state_.filled_vpls = 4;
        state_.shots = 28;
        state_.light = {1.0f, 2.0f, std::numeric_limits<float>::infinity()};
        state_.balance = {3.0f};
        state_.irradiance = {-0.0f, 5.0f, 6.0f, 7.0f};
    }
    void TearDown() override { std::filesystem::remove(file_); }

    std::string bytes() const {
        std::ifstream in(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
    void expect_refused(const char* why, const std::string& key = "key") const {
        try {
            report::load_bake_state(file_, key);
            ADD_FAILURE() << "taken, though it " << why;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).rfind(file_.string(), 0), 0u) << error.what();
        }
    }

    std::filesystem::path file_;
    LightAtlasState state_;
};

TEST_F(BakeState, ComesBackFromItsFile) {
    report::save_bake_state(state_, "key", file_);
    const LightAtlasState back = report::load_bake_state(file_, "key");
    EXPECT_EQ(back.vpls, 7u);
    EXPECT_EQ(back.texels, 3u);
    EXPECT_EQ(back.filled_vpls, 4u);
    EXPECT_EQ(back.shots, 28u);
    EXPECT_TRUE(test::same_bits(back.light, state_.light));
    EXPECT_TRUE(test::same_bits(back.balance, state_.balance));
    EXPECT_TRUE(test::same_bits(back.irradiance, state_.irradiance));
    EXPECT_TRUE(back.filled.empty());
}

TEST_F(BakeState, IsRefusedUnlessItIsWholeAndFits) {
    report::save_bake_state(state_, "key", file_);
    expect_refused("belongs to a bake of another scene", "other");
    const std::string good = bytes();
    std::string bad = good;
    bad[16] = 2;
    put(bad);
    expect_refused("is of version 2, 1 needed");
    put("PNG");
    expect_refused("is no state of a bake");
    put(std::string(64, 'x'));
    expect_refused("is no state of a bake");
    // Any byte changed, any end cut off or put on: refused, for whatever reason.
    for (std::size_t i = 0; i < good.size(); ++i) {
        bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x40);
        put(bad);
        EXPECT_THROW(report::load_bake_state(file_, "key"), InputError) << "byte " << i;
        put(good.substr(0, i));
        EXPECT_THROW(report::load_bake_state(file_, "key"), InputError) << "cut at " << i;
    }
    put(good + '\0');
    expect_refused("is damaged");
    std::filesystem::remove(file_);
    expect_refused("cannot be read");
}

}  // namespace
}  // namespace clgi
