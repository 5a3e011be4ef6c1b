// Corners of clipped polygons lie where the same corners of whole triangles lie, to the last bit:
// meshes that are clipped in part have no holes.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "patchwork.hpp"

namespace clgi {
namespace {

using test::Looking;
using test::ScreenVertex;

class ClippedCorners : public testing::TestWithParam<Looking> {};

INSTANTIATE_TEST_SUITE_P(Views, ClippedCorners,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

TEST_P(ClippedCorners, AreThoseOfWholeTriangles) {
    const DeviceScene scene = test::on_device(test::patchwork(3000, 131, false));
    const test::Device& on = test::device();
    cl::Program program(on.context, test::kernel_text("tests/support/clipped_corners.cl"));
    program.build(on.device, compiler_options(on.device, {.packet_width = 1}).c_str());
    cl::Kernel kernel(program, "clipped_corners");
    const std::uint32_t count = scene.info().vertex_count;
    const cl::Buffer projected = test::empty<ScreenVertex>(count);
    const View view = test::looking(GetParam(), scene, 211, 157);
    kernel.setArg(0, view);
    kernel.setArg(1, scene.positions());
    kernel.setArg(2, projected);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(count));
    const auto clipped = test::download<ScreenVertex>(projected, count);
    const auto whole = test::project(scene, view);
    std::size_t checked = 0, negative = 0;
    for (std::uint32_t v = 0; v < count; ++v) {
        if (whole[v].outside != 0) continue;
        ++checked;
        negative += whole[v].x < 0 || whole[v].y < 0;
        ASSERT_EQ(clipped[v].x, whole[v].x) << v;
        ASSERT_EQ(clipped[v].y, whole[v].y) << v;
        ASSERT_EQ(clipped[v].closeness, whole[v].closeness) << v;
    }
    EXPECT_GT(checked, 5000u);
    EXPECT_GT(negative, 100u);
}

}  // namespace
}  // namespace clgi
