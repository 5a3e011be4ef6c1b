// Included before each test of the stability suite with -DCLGI_SHARES=ON: prints what share of its
// bounds a test reached at most, for the table of docs/stability.md. Bounds are those of
// EXPECT_NEAR, EXPECT_LE and EXPECT_LT on floating-point numbers, and of their ASSERT_ forms.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <type_traits>

namespace clgi::test {

inline double largest_share = 0.0;

inline void note_share(double value, double bound) {
    if (bound > 0.0 && value >= 0.0 && std::isfinite(value / bound))
        largest_share = std::max(largest_share, value / bound);
}

inline testing::AssertionResult near_bound(const char* a, const char* b, const char* within,
                                           double left, double right, double bound) {
    note_share(std::abs(left - right), bound);
    return testing::internal::DoubleNearPredFormat(a, b, within, left, right, bound);
}

#define CLGI_BELOW(name, compare)                                                                \
    template <typename A, typename B>                                                            \
    testing::AssertionResult name(const char* a, const char* b, const A& left, const B& right) { \
        if constexpr (std::is_floating_point_v<A> && std::is_floating_point_v<B>)                \
            note_share(left, right);                                                             \
        return testing::internal::compare(a, b, left, right);                                    \
    }
CLGI_BELOW(at_most, CmpHelperLE)
CLGI_BELOW(less_than, CmpHelperLT)
#undef CLGI_BELOW

class ShareListener : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { largest_share = 0.0; }
    void OnTestEnd(const testing::TestInfo& info) override {
        std::printf("[    SHARE ] %s.%s %.4g\n", info.test_suite_name(), info.name(),
                    largest_share);
    }
};

inline const bool listening = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new ShareListener);
    return true;
}();

}  // namespace clgi::test

#undef EXPECT_NEAR
#undef ASSERT_NEAR
#undef EXPECT_LE
#undef ASSERT_LE
#undef EXPECT_LT
#undef ASSERT_LT
#define EXPECT_NEAR(a, b, within) EXPECT_PRED_FORMAT3(clgi::test::near_bound, a, b, within)
#define ASSERT_NEAR(a, b, within) ASSERT_PRED_FORMAT3(clgi::test::near_bound, a, b, within)
#define EXPECT_LE(a, b) EXPECT_PRED_FORMAT2(clgi::test::at_most, a, b)
#define ASSERT_LE(a, b) ASSERT_PRED_FORMAT2(clgi::test::at_most, a, b)
#define EXPECT_LT(a, b) EXPECT_PRED_FORMAT2(clgi::test::less_than, a, b)
#define ASSERT_LT(a, b) ASSERT_PRED_FORMAT2(clgi::test::less_than, a, b)
