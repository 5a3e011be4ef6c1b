// The list of pixels to be lit in full: counted, put in a row and put back, exactly.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "frames.hpp"
#include "lighting.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

struct Input {
    RefineParams params{};
    std::vector<cl_uchar> flags;
    std::vector<float> planes;  // [GBUFFER_PLANES][stride], no two values alike
};

Input random_input(cl_uint width, cl_uint height, double share) {
    test::Random random(width + 7 * height);
    Input out;
    out.params.width = width;
    out.params.height = height;
    out.params.stride = test::padded(std::size_t{width} * height) + 16;
    out.params.low_stride = out.params.stride;
    out.params.step = 4;
    for (cl_uint i = 0; i < width * height; ++i) out.flags.push_back(random(0, 1) < share);
    for (std::size_t i = 0; i < GBUFFER_PLANES * out.params.stride; ++i)
        out.planes.push_back(static_cast<float>(i) + 0.5f);
    return out;
}

const ParallelPasses& offsets() {
    static const ParallelPasses passes(test::programs());
    return passes;
}

TEST(Compact, ListsWhatIsFlaggedInOrderAndPutsItBack) {
    const cl::CommandQueue& queue = test::device().queue;
    const ImagePasses& passes = test::image_passes();
    for (const auto& [width, height] : {std::pair<cl_uint, cl_uint>(1, 1),
                                        {5, 3},
                                        {COMPACT_BLOCK, 1},
                                        {COMPACT_BLOCK, 3},
                                        {COMPACT_BLOCK + 1, 2},
                                        {97, 83}})
        for (const double share : {0.0, 0.02, 0.6, 1.0}) {
            const Input in = random_input(width, height, share);
            const std::size_t stride = in.params.stride, pixels = in.flags.size();
            const std::size_t blocks = (pixels + COMPACT_BLOCK - 1) / COMPACT_BLOCK;
            std::vector<cl_uint> listed, counts(blocks);
            for (cl_uint i = 0; i < pixels; ++i)
                if (in.flags[i]) listed.push_back(i), ++counts[i / COMPACT_BLOCK];

            // One more block and one more flag than there are: neither is touched.
            std::vector<cl_uchar> flags = in.flags;
            flags.resize(flags.size() + COMPACT_BLOCK, 1);
            const cl::Buffer device_flags = test::upload(flags);
            const cl::Buffer device_counts = test::upload(std::vector<cl_uint>(blocks + 1, 77u));
            passes.count(queue, static_cast<cl_uint>(pixels), device_flags, device_counts);
            std::vector<cl_uint> wanted = counts;
            wanted.push_back(77u);
            EXPECT_EQ(test::download<cl_uint>(device_counts, blocks + 1), wanted) << pixels;

            const cl::Buffer device_listed = test::upload(std::vector<cl_uint>(stride, 77u));
            const cl::Buffer points =
                test::upload(std::vector<float>(POINT_PLANES * stride, -1.0f));
            const cl::Buffer count = test::upload(std::vector<cl_uint>{77u});
            offsets().offsets(queue, static_cast<cl_uint>(blocks), device_counts, cl::Buffer());
            passes.compact(queue, in.params, device_flags, device_counts, test::upload(in.planes),
                           device_listed, points, count);
            EXPECT_EQ(test::download<cl_uint>(count, 1)[0], listed.size());
            EXPECT_EQ(test::download<cl_uint>(device_listed, listed.size()), listed);
            const auto found = test::download<float>(points, POINT_PLANES * stride);
            const std::size_t packet = static_cast<std::size_t>(passes.packet_width());
            const std::size_t whole = (listed.size() + packet - 1) / packet * packet;
            for (std::size_t plane = 0; plane < POINT_PLANES; ++plane)
                for (std::size_t i = 0; i < stride; ++i)
                    EXPECT_EQ(found[plane * stride + i], i < listed.size()
                                                             ? in.planes[plane * stride + listed[i]]
                                                         : i < whole ? 0.0f
                                                                     : -1.0f)
                        << "plane " << plane << ", point " << i;

            // Only what is listed is lit.
            const cl::Buffer light = test::upload(std::vector<Vpl>(1));
            const cl::Buffer lit =
                test::upload(std::vector<float>(IRRADIANCE_PLANES * stride, 7.0f));
            passes.gather(queue, {static_cast<cl_uint>(stride), 1, 0, 0}, pixels, count, points,
                          light, light, lit);
            const auto irradiances = test::download<float>(lit, IRRADIANCE_PLANES * stride);
            for (std::size_t i = 0; i < irradiances.size(); ++i)
                EXPECT_EQ(irradiances[i], i % stride < whole ? 0.0f : 7.0f) << i;

            std::vector<float> refined(IRRADIANCE_PLANES * stride), before = refined;
            for (std::size_t i = 0; i < refined.size(); ++i) {
                refined[i] = 1000.25f + static_cast<float>(i);
                before[i] = -0.25f - static_cast<float>(i);
            }
            const cl::Buffer irradiance = test::upload(before);
            passes.place(queue, in.params, count, device_listed, test::upload(refined), irradiance);
            std::vector<float> after = before;
            for (std::size_t plane = 0; plane < IRRADIANCE_PLANES; ++plane)
                for (std::size_t i = 0; i < listed.size(); ++i)
                    after[plane * stride + listed[i]] = refined[plane * stride + i];
            EXPECT_EQ(test::download<float>(irradiance, IRRADIANCE_PLANES * stride), after);
        }
}

}  // namespace
}  // namespace clgi
