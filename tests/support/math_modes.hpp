// Tests that hold in strict and in fast math run in both, and with planes in half storage.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <string>

#include "device.hpp"

namespace clgi::test {

// Helpers build kernels in the mode of the running test, unless it says otherwise.
template <typename Mode>
class InMode : public testing::TestWithParam<Mode> {
    const UsualBuild build_{testing::TestWithParam<Mode>::GetParam()};
};

inline std::string mode_name(const testing::TestParamInfo<BuildOptions>& info) {
    if (info.param.storage == Storage::half) return "half";
    return info.param.math == Math::strict ? "strict" : "fast";
}

inline std::string math_name(const testing::TestParamInfo<Math>& info) {
    return info.param == Math::strict ? "strict" : "fast";
}

}  // namespace clgi::test

// Makes `subject` a fixture for TEST_P, whose GetParam() is the kind of math.
#define CLGI_IN_BOTH_MATHS(subject)                                                                \
    class subject : public clgi::test::InMode<clgi::Math> {};                                      \
    INSTANTIATE_TEST_SUITE_P(Math, subject, testing::Values(clgi::Math::strict, clgi::Math::fast), \
                             clgi::test::math_name)

// The same with GetParam() the build options, once in half storage.
#define CLGI_IN_ALL_MODES(subject)                                                          \
    class subject : public clgi::test::InMode<clgi::BuildOptions> {};                       \
    INSTANTIATE_TEST_SUITE_P(                                                               \
        Mode, subject,                                                                      \
        testing::Values(clgi::BuildOptions{}, clgi::BuildOptions{.math = clgi::Math::fast}, \
                        clgi::BuildOptions{.storage = clgi::Storage::half}),                \
        clgi::test::mode_name)
