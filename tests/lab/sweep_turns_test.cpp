// Settings measured in turn: once where they are the same, in all rounds, with medians.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <string>

#include "lab/sweep_run.hpp"

namespace clgi::lab {
namespace {

const std::vector<SweepSetting> settings = {{"one", "a", {{"knob", "1"}}},
                                            {"one", "a", {{"knob", "2"}}},
                                            {"one", "b", {{"knob", "1"}}},
                                            {"two", "a", {{"knob", "1"}}}};

struct Turning : testing::Test {
    std::string order;  // of settings, in which they were measured; results in capitals
    std::size_t non_finite = 0;
    std::function<bool(double)> said = nullptr;
    Turns turns;

    Turning() {
        turns.rounds = 3;
        turns.measure = [this](std::size_t i, SweepPoint* result, const Progress&) {
            order += static_cast<char>((result ? 'A' : 'a') + i);
            if (result) result->energy = 10.0 + static_cast<double>(i);
            Measured out;
            // 5, 1, 3 in three rounds
            constexpr double times[] = {5.0, 1.0, 3.0};
            for (int k = 0; k < 2; ++k)
                out.milliseconds.push_back(static_cast<double>(i) + times[rounds_of(i) - 1]);
            if (i == 1) out.once = 100.0 * times[rounds_of(i) - 1];
            out.non_finite = 7;
            out.again = i != 3;
            return out;
        };
    }
    int rounds_of(std::size_t i) const {
        int out = 0;
        for (const char c : order)
            out += c == static_cast<char>('a' + i) || c == static_cast<char>('A' + i);
        return out;
    }
    std::vector<SweepPoint> measured() {
        const SweepProgress progress(said);
        return measure_in_turn(settings, turns, progress, non_finite);
    }
};

TEST_F(Turning, MeasuresTheSameOnceAndSlowOnesInTheFirstRound) {
    const std::vector<SweepPoint> points = measured();
    EXPECT_EQ(order, "ABDabab");
    ASSERT_EQ(points.size(), settings.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(points[i].method, settings[i].method);
        EXPECT_EQ(points[i].series, settings[i].series);
        EXPECT_EQ(points[i].knobs, settings[i].knobs);
        EXPECT_EQ(points[i].once_milliseconds.has_value(), i == 1);
    }
    EXPECT_EQ(points[0].milliseconds, 3.0);
    EXPECT_EQ(points[1].milliseconds, 4.0);
    EXPECT_EQ(points[1].once_milliseconds, 300.0);
    EXPECT_EQ(points[2].milliseconds, 3.0) << "as the first, in another series";
    EXPECT_EQ(points[2].energy, 10.0);
    EXPECT_EQ(points[3].milliseconds, 8.0);
    EXPECT_EQ(points[3].energy, 13.0);
    EXPECT_EQ(non_finite, 21u) << "of results, which are of the first round";
}

TEST_F(Turning, AsksWhatIsTheSame) {
    turns.rounds = 1;
    turns.same = [](std::size_t, std::size_t) { return false; };
    measured();
    EXPECT_EQ(order, "ABCD");
}

// Shares are those of the work.
TEST_F(Turning, SaysHowFarItIs) {
    turns.rounds = 1;
    turns.work = [](std::size_t i) { return i == 0 ? 6.0 : 1.0; };
    std::vector<double> shares;
    said = [&](double share) {
        shares.push_back(share);
        return true;
    };
    const auto measure = turns.measure;
    turns.measure = [&](std::size_t i, SweepPoint* result, const Progress& part) {
        part(0.5);
        return measure(i, result, part);
    };
    measured();
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()) ||
                std::count(shares.begin(), shares.end(), 0.0) > 0);
    EXPECT_NEAR(shares[1], 0.375, 1e-12) << "half of six eighths";
    EXPECT_LE(shares.back(), 1.0);
}

TEST_F(Turning, CanBeCancelled) {
    said = [&](double) { return order.size() < 2; };
    EXPECT_THROW(measured(), Error);
    EXPECT_EQ(order, "AB");
}

}  // namespace
}  // namespace clgi::lab
