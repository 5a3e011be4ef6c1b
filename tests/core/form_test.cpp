// Which form kernels are built in: by the options, else by CLGI_FORM, else by the kind of device.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/kernel_source.hpp>
#include <clgi/error.hpp>
#include <cstdlib>
#include <optional>
#include <string>

#include "core/opencl/program.hpp"
#include "device.hpp"

namespace clgi {
namespace {

// Sets CLGI_FORM, or removes it, and puts it back.
class FormVariable {
public:
    explicit FormVariable(const char* value) {
        if (const char* was = std::getenv("CLGI_FORM")) was_ = was;
        set(value);
    }
    ~FormVariable() { set(was_ ? was_->c_str() : nullptr); }

private:
    static void set(const char* value) {
        if (value)
            setenv("CLGI_FORM", value, 1);
        else
            unsetenv("CLGI_FORM");
    }
    std::optional<std::string> was_;
};

bool grouped(Form form) { return in_groups(test::device().device, {.form = form}); }

TEST(Form, IsThatOfTheOptionsThenOfTheVariableThenOfTheDevice) {
    for (const char* value : {"groups", "packets"}) {
        const FormVariable variable(value);
        EXPECT_EQ(grouped(Form::automatic), std::string(value) == "groups");
        EXPECT_TRUE(grouped(Form::groups));
        EXPECT_FALSE(grouped(Form::packets));
    }
    const FormVariable none(nullptr);
    const bool cpu = test::device().device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU;
    EXPECT_EQ(grouped(Form::automatic), !cpu);
}

TEST(Form, OfAnotherNameIsRefused) {
    const FormVariable variable("waves");
    try {
        grouped(Form::automatic);
        FAIL() << "taken";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "CLGI_FORM is \"waves\", packets or groups needed");
    }
}

// Groups are one lane wide unless a width was asked for.
TEST(Form, SetsTheWidth) {
    const auto options = [](const BuildOptions& build) {
        return compiler_options(test::device().device, build) + " ";
    };
    EXPECT_NE(options({.form = Form::groups}).find("-DCLGI_WIDTH=1 "), std::string::npos);
    EXPECT_NE(options({.packet_width = 4, .form = Form::groups}).find("-DCLGI_WIDTH=4 "),
              std::string::npos);
}

}  // namespace
}  // namespace clgi
