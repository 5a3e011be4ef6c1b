// The file of a bake that was cancelled.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "frames.hpp"
#include "lab/bake_state.hpp"

namespace clgi {
namespace {

class BakeState : public testing::Test {
protected:
    void SetUp() override {
        file_ = std::filesystem::temp_directory_path() /
                ("clgi_bake_state_" + std::to_string(::getpid()));
        state_.vpls = 7;
        state_.texels = 3;
        state_.measured_vpls = 5;
        state_.filled_vpls = 4;
        state_.shots = 28;
        state_.rows = {1, 2, 0xffff};
        state_.seen = {0, 255, 7, 9, 11};
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
            lab::load_bake_state(file_, key);
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
    lab::save_bake_state(state_, "key", file_);
    const LightAtlasState back = lab::load_bake_state(file_, "key");
    EXPECT_EQ(back.vpls, 7u);
    EXPECT_EQ(back.texels, 3u);
    EXPECT_EQ(back.measured_vpls, 5u);
    EXPECT_EQ(back.filled_vpls, 4u);
    EXPECT_EQ(back.shots, 28u);
    EXPECT_EQ(back.rows, state_.rows);
    EXPECT_EQ(back.seen, state_.seen);
    EXPECT_TRUE(test::same_bits(back.light, state_.light));
    EXPECT_TRUE(test::same_bits(back.balance, state_.balance));
    EXPECT_TRUE(test::same_bits(back.irradiance, state_.irradiance));
    EXPECT_TRUE(back.filled.empty());
}

TEST_F(BakeState, IsRefusedUnlessItIsWholeAndFits) {
    lab::save_bake_state(state_, "key", file_);
    expect_refused("belongs to a bake of another scene", "other");
    const std::string good = bytes();
    std::string bad = good;
    bad[16] = 1;
    put(bad);
    expect_refused("is of version 1, 2 needed");
    put("PNG");
    expect_refused("is no state of a bake");
    put(std::string(64, 'x'));
    expect_refused("is no state of a bake");
    // Any byte changed, any end cut off or put on: refused, for whatever reason.
    for (std::size_t i = 0; i < good.size(); ++i) {
        bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x40);
        put(bad);
        EXPECT_THROW(lab::load_bake_state(file_, "key"), InputError) << "byte " << i;
        put(good.substr(0, i));
        EXPECT_THROW(lab::load_bake_state(file_, "key"), InputError) << "cut at " << i;
    }
    put(good + '\0');
    expect_refused("is damaged");
    std::filesystem::remove(file_);
    expect_refused("cannot be read");
}

}  // namespace
}  // namespace clgi
