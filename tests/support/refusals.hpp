// Passes called with a buffer that is exactly large enough, one byte too small, and none.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <functional>
#include <string>

#include "device.hpp"

namespace clgi::test {

// One argument of a pass: what it needs, and the pass called with a buffer in its place.
struct Argument {
    const char* pass;
    const char* name;
    std::size_t needed;  // bytes
    std::function<void(const cl::Buffer&)> call;
};

inline void expect_refusals(const std::vector<Argument>& arguments) {
    const cl::Context& context = device().context;
    for (const Argument& argument : arguments) {
        const std::string label = std::string(argument.pass) + ", " + argument.name;
        EXPECT_NO_THROW(argument.call(cl::Buffer(context, CL_MEM_READ_WRITE, argument.needed)))
            << label;
        device().queue.finish();
        try {
            argument.call(cl::Buffer(context, CL_MEM_READ_WRITE, argument.needed - 1));
            ADD_FAILURE() << label << " took a buffer one byte too small";
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), std::string(argument.pass) + ": " + argument.name + " holds " +
                                        std::to_string(argument.needed - 1) + " bytes, " +
                                        std::to_string(argument.needed) + " needed");
        }
        EXPECT_THROW(argument.call(cl::Buffer()), Error) << label << " that is none";
    }
}

// The message of the error that this throws.
template <typename Thrown, typename Make>
std::string refusal(Make&& make) {
    try {
        make();
    } catch (const Thrown& error) {
        return error.what();
    }
    return "nothing was refused";
}

}  // namespace clgi::test
