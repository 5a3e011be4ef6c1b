// Weights of the cells of a mask, against sums over fine grids and closed forms.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>

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

// ---- random directions -------------------------------------------------------------------------

const double y00 = std::sqrt(1 / (4 * M_PI));

MaskWeights random_weights(int size, int block, int bands) {
    return mask_weights(size, block, bands, CellIntegral::monte_carlo);
}

// Whether cells around it, two each way, have pixels too: nothing is merged into it.
bool is_far_from_the_edge(const MaskWeights& weights, int side, int column, int row) {
    for (int i = column - 2; i <= column + 2; ++i)
        for (int j = row - 2; j <= row + 2; ++j)
            if (i < 0 || j < 0 || i >= side || j >= side || weights.pixels[side * i + j] == 0)
                return false;
    return true;
}

// What a direction adds to the first band is a constant, so cells tell how many they have.
TEST(MonteCarloWeights, CountEachDirectionOnce) {
    for (const int size : {8, 32, 128})
        for (const int block : {1, 2, 4, 8}) {
            const MaskWeights weights = random_weights(size, block, 3);
            const auto all = static_cast<double>(test::disc_pixels(size).size());
            double sum = 0.0, directions = 0.0, most = 0.0;
            for (int cell = 0; cell < weights.cells; ++cell) {
                const double integral = weights.integrals[9 * cell];
                const double count = integral * all / (M_PI * y00);
                EXPECT_NEAR(count, std::round(count), 1e-9);
                EXPECT_TRUE(weights.pixels[cell] > 0 || count == 0.0);
                sum += integral;
                directions += std::round(count);
                most = std::max(most, count / std::max(weights.pixels[cell], 1u));
            }
            EXPECT_NEAR(sum, M_PI * y00, 1e-12);
            EXPECT_EQ(directions, all);
            EXPECT_TRUE(block == size || most > 1.2) << "they are random: not one a pixel";
        }
}

// The mean of its directions' x and y is inside of a cell.
TEST(MonteCarloWeights, LieInTheirCells) {
    const double per_x = sh::evaluate(glm::dvec3(1, 0, 0), 2)[3] / y00;
    const double per_y = sh::evaluate(glm::dvec3(0, 1, 0), 2)[1] / y00;
    for (const int size : {32, 128})
        for (const int block : {1, 2, 4}) {
            const MaskWeights weights = random_weights(size, block, 3);
            const int side = size / block;
            int met = 0;
            double outermost[2] = {};  // of the last column and row
            for (int column = 0; column < side; ++column)
                for (int row = 0; row < side; ++row) {
                    const double* c = &weights.integrals[9 * (side * column + row)];
                    if (column == side - 1) outermost[0] += c[0];
                    if (row == side - 1) outermost[1] += c[0];
                    if (c[0] == 0.0 || !is_far_from_the_edge(weights, side, column, row)) continue;
                    ++met;
                    EXPECT_NEAR(c[3] / c[0] / per_x, (2 * column + 1.0) / side - 1, 1.0 / side);
                    EXPECT_NEAR(c[1] / c[0] / per_y, (2 * row + 1.0) / side - 1, 1.0 / side);
                }
            EXPECT_GT(met, 10);
            for (const double sum : outermost) EXPECT_GT(sum, 0.0) << size << ", " << block;
        }
}

// One set of directions for a size of mask: cells of any width are sums of the same, and further
// bands change none.
TEST(MonteCarloWeights, DependOnTheSizeOfTheMaskAlone) {
    const MaskWeights pixels = random_weights(32, 1, 3), cells = random_weights(32, 4, 5);
    for (int column = 2; column < 6; ++column)
        for (int row = 2; row < 6; ++row)
            for (int k = 0; k < 9; ++k) {
                double sum = 0.0;
                for (int i = 4 * column; i < 4 * column + 4; ++i)
                    for (int j = 4 * row; j < 4 * row + 4; ++j)
                        sum += pixels.integrals[9 * (32 * i + j) + k];
                EXPECT_NEAR(sum, cells.integrals[25 * (8 * column + row) + k], 1e-12);
            }
    EXPECT_EQ(random_weights(32, 4, 5).integrals, cells.integrals);
}

// The sum over all cells is the clamped cosine, off by pi sqrt(variance of Y_i / N): 400 such
// numbers, 5 sizes and 80 terms behind the first, have a mean square of about one.
TEST(MonteCarloWeights, HaveTheErrorOfIndependentDirections) {
    constexpr int terms = 81, fine = 512;
    const std::vector<double> wanted = sh::around({0, 0, 1}, sh::cosine_kernel(9));
    std::vector<double> variance(terms);
    for (const test::Pixel& p : test::disc_pixels(fine)) {
        const std::vector<double> y = sh::evaluate(p.direction, 9);
        for (int i = 0; i < terms; ++i) variance[i] += y[i] * y[i] * 4 / fine / fine / M_PI;
    }
    for (int i = 0; i < terms; ++i) variance[i] -= wanted[i] * wanted[i] / M_PI / M_PI;

    std::vector<double> mean(terms);
    double all = 0.0, square = 0.0;
    for (const int size : {8, 16, 32, 64, 128}) {
        const MaskWeights weights = random_weights(size, 4, 9);
        const auto count = static_cast<double>(test::disc_pixels(size).size());
        double error = 0.0, whole = 0.0;
        for (int i = 0; i < terms; ++i) {
            double sum = 0.0;
            for (int cell = 0; cell < weights.cells; ++cell)
                sum += weights.integrals[terms * cell + i];
            mean[i] += count * sum;
            error += (sum - wanted[i]) * (sum - wanted[i]);
            whole += wanted[i] * wanted[i];
            if (i == 0) continue;
            const double in_errors = (sum - wanted[i]) / (M_PI * std::sqrt(variance[i] / count));
            EXPECT_LT(std::abs(in_errors), 4.5) << size << ", " << i;
            square += in_errors * in_errors;
        }
        all += count;
        std::printf("[          ] R = %d: %.4f of the vector\n", size, std::sqrt(error / whole));
    }
    EXPECT_NEAR(std::sqrt(square / 400), 1.0, 0.15);
    // All sizes together are one larger set.
    for (int i = 1; i < terms; ++i)
        EXPECT_LT(std::abs(mean[i] / all - wanted[i]), 4 * M_PI * std::sqrt(variance[i] / all))
            << i;
}

}  // namespace
}  // namespace clgi
