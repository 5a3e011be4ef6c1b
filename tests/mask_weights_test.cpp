// Weights of the cells of a mask, against sums over fine grids and closed forms.
// SPDX-License-Identifier: MIT
#include "mask_tools.hpp"

namespace clgi {
namespace {

// The cells together are the hemisphere: Y_i times the cosine.
TEST(MaskWeights, OfAllCellsAreTheClampedCosine) {
    const std::vector<double> wanted = sh::around({0, 0, 1}, sh::cosine_kernel(9));
    for (const int size : {8, 16, 32, 64})
        for (const int block : {1, 2, 4, 8}) {
            const MaskWeights weights = mask_weights(size, block, 9);
            std::vector<double> sum(81);
            std::uint32_t pixels = 0;
            for (int cell = 0; cell < weights.cells; ++cell) {
                for (int i = 0; i < 81; ++i) sum[i] += weights.integrals[81 * cell + i];
                pixels += weights.pixels[cell];
                EXPECT_TRUE(weights.pixels[cell] > 0 || weights.integrals[81 * cell] == 0.0);
            }
            EXPECT_EQ(pixels, test::disc_pixels(size).size());
            // Of cells that the circle leaves: limits have a root where it crosses a side.
            for (int i = 0; i < 81; ++i) EXPECT_NEAR(sum[i], wanted[i], 2e-8) << size << ", " << i;
        }
    EXPECT_THROW(mask_weights(20), Error);
    EXPECT_THROW(mask_weights(32, 3), Error);
    EXPECT_THROW(mask_weights(32, 4, 10), Error);
}

// Against the midpoints of a fine grid, cell by cell, at the edge of the disc too.
TEST(MaskWeights, AreIntegralsOverCells) {
    const MaskWeights weights = mask_weights(32, 4);
    constexpr int fine = 2048, per_cell = fine / 8;
    for (const int column : {0, 1, 2, 3})
        for (const int row : {1, 4, 7}) {
            std::vector<double> sum(25);
            for (int i = 0; i < per_cell; ++i)
                for (int j = 0; j < per_cell; ++j) {
                    const double x = (2 * (column * per_cell + i) + 1.0) / fine - 1;
                    const double y = (2 * (row * per_cell + j) + 1.0) / fine - 1;
                    if (x * x + y * y >= 1) continue;
                    const std::vector<double> value =
                        sh::evaluate(glm::dvec3(x, y, std::sqrt(1 - x * x - y * y)), 5);
                    for (int k = 0; k < 25; ++k) sum[k] += value[k] * 4.0 / fine / fine;
                }
            for (int k = 0; k < 25; ++k)
                EXPECT_NEAR(weights.integrals[25 * (8 * column + row) + k], sum[k], 3e-5)
                    << column << ", " << row << ", " << k;
        }
}

}  // namespace
}  // namespace clgi
