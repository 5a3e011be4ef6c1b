// Host and device agree about every byte of the structs that they share.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cstddef>
#include <cstring>
#include <string>

#include "device.hpp"
#include "kernel_text.hpp"
#include "layout_members.h"

namespace clgi {
namespace {

struct Entry {
    std::string name;
    std::size_t value;
    std::size_t bytes;  // of the member; 0 for a whole struct
};

#define HOST_SIZE(type) {#type, sizeof(type), 0},
#define HOST_MEMBER(type, member) {#type "." #member, offsetof(type, member), sizeof(type::member)},
const Entry entries[] = {CLGI_LAYOUT(HOST_SIZE, HOST_MEMBER)};

TEST(Layout, IsTheSameOnHostAndDevice) {
    const test::Device& on = test::device();
    cl::Program program(on.context, test::kernel_text(CLGI_LAYOUT_MEMBERS) +
                                        test::kernel_text("tests/support/layout.cl"));
    program.build(on.device, "-cl-std=CL1.2");
    cl::Kernel kernel(program, "layout");
    const cl::Buffer found = test::empty<cl_uint>(std::size(entries));
    kernel.setArg(0, found);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
    const auto values = test::download<cl_uint>(found, std::size(entries));
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(values[i], entries[i].value) << entries[i].name;
}

// Without gaps, and without a member that the list leaves out.
TEST(Layout, HasNoHiddenPadding) {
    std::size_t size = 0, filled = 0;
    for (const Entry& entry : entries) {
        if (entry.bytes == 0) {
            EXPECT_EQ(filled, size) << "before " << entry.name;
            size = entry.value;
            filled = 0;
        } else {
            EXPECT_EQ(entry.value, filled) << entry.name;
            filled += entry.bytes;
        }
    }
    EXPECT_EQ(filled, size);
}

TEST(Layout, KeepsRowsOfSixteenBytes) {
    for (const Entry& entry : entries)
        EXPECT_TRUE(entry.bytes > 0 || entry.value % 16 == 0) << entry.name;
}

TEST(Layout, GivesAMaterialItsRows) {
    EXPECT_EQ(sizeof(MaterialRecord), MATERIAL_ROWS * sizeof(float4));
    EXPECT_EQ(offsetof(MaterialRecord, base_color), MATERIAL_BASE * sizeof(float4));
    EXPECT_EQ(offsetof(MaterialRecord, emission), MATERIAL_EMISSION * sizeof(float4));
    EXPECT_EQ(offsetof(MaterialRecord, reflectance), MATERIAL_REFLECTANCE * sizeof(float4));
}

}  // namespace
}  // namespace clgi
