// Low-resolution points in both kinds of storage: the very bits of their pixels, and zeros after
// them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// Rows of halves as clgi/shared/planes.h lays them out: positions take two, normals one.
constexpr int half_rows = 9;

// Words of 16 bits of a plane: where it begins and how many a value has.
struct Place {
    std::size_t first, each;
};

Place place_of(int plane, std::size_t stride, Storage storage) {
    if (storage == Storage::full) return {2 * stride * static_cast<std::size_t>(plane), 2};
    if (plane < 3) return {2 * stride * static_cast<std::size_t>(plane), 2};
    return {stride * static_cast<std::size_t>(plane + 3), 1};
}

void expect_picked(std::uint32_t width, std::uint32_t height, std::uint32_t step, Storage storage,
                   const GBufferPasses& passes) {
    test::Random random(width + step);
    const std::uint32_t stride = test::padded(width * height);
    const std::uint32_t low_width = (width + step - 1) / step;
    const std::uint32_t count = low_width * ((height + step - 1) / step);
    const std::uint32_t low_stride = test::padded(count);
    const std::size_t rows = storage == Storage::full ? 12 : half_rows;
    std::vector<std::uint16_t> bits(rows * stride);
    for (std::uint16_t& word : bits) word = static_cast<std::uint16_t>(random.integer(1, 65535));
    const cl::Buffer points = test::upload(std::vector<std::uint16_t>(rows * low_stride, 0x5555));
    passes.downsample(test::device().queue, {width, height, stride, low_stride, step, 0, 0, 0},
                      test::upload(bits), points);
    const auto low = test::download<std::uint16_t>(points, rows * low_stride);
    const auto lanes = static_cast<std::uint32_t>(passes.packet_width());
    for (int plane = 0; plane < POINT_PLANES; ++plane) {
        const Place from = place_of(plane, stride, storage),
                    to = place_of(plane, low_stride, storage);
        for (std::uint32_t i = 0; i < (count + lanes - 1) / lanes * lanes; ++i)
            for (std::size_t word = 0; word < to.each; ++word) {
                const std::size_t pixel = step * (i / low_width * width + i % low_width);
                const std::uint16_t wanted =
                    i < count ? bits[from.first + pixel * from.each + word] : 0;
                ASSERT_EQ(low[to.first + i * to.each + word], wanted) << plane << ": " << i;
            }
    }
}

TEST(Downsample, KeepsEveryBitAndEndsInZeros) {
    for (const Storage storage : {Storage::full, Storage::half})
        for (const int lanes : {0, 4}) {
            const GBufferPasses passes(test::programs(),
                                       {.storage = storage, .packet_width = lanes});
            for (const std::uint32_t step : {2u, 4u})
                for (const auto& [width, height] :
                     {std::pair(1u, 1u), {2u, 9u}, {33u, 18u}, {64u, 6u}, {71u, 13u}})
                    expect_picked(width, height, step, storage, passes);
        }
}

}  // namespace
}  // namespace clgi
