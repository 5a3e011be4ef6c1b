// What the cells of a mask weigh in a transfer vector.
//
// A cell is a block of B x B pixels [Kautz04, section 3.2]. Its integral is
//
//   c_i = integral of Y_i(s) cos over the cell's directions = integral of Y_i over the cell in the
//   disc                                                          [Kautz04, Eq. 3 and section 3.1]
//
// and the transfer vector in the receiver's frame is the sum of c_i times the cell's share of
// pixels that are not blocked.
//
// The vector is turned to the world by values at directions: with d_j, j = 0 to 2 l, there are z_j
// with sum_j z_j Y_lm(d_j) = c_lm for all m of a degree l, and the turned coefficients are
// sum_j z_j Y_lm(R d_j). The weights are z already, so no rotation matrix is needed.
//                                                         [derived: addition theorem, any R]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/sh.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// What c_i of a cell is.
enum class CellIntegral {
    exact,   // the integral over all of the cell in the disc: without blockers nothing is lost
    centre,  // Y_i at the middle of the cell times pi times its share of pixels, as in [Kautz04];
             // a middle outside the disc is moved to radius 0.999
    // For comparison: pi / N times the sum of Y_i over those of N random directions, independent
    // and with density cos / pi, whose pixel lies in the cell. N: the pixels in the disc. The
    // directions depend on the size of the mask alone: all receivers share them, and every run.
    // Over sets of directions the mean is the exact integral. Of all cells together the standard
    // error is pi sqrt(variance of Y_i / N): 0 in the first band, and in every other term about
    // 1 / sqrt(N) of the first term. Cells that no direction meets weigh nothing.
    //                        [derived: Monte Carlo integration, which Kautz04, section 4, names]
    monte_carlo
};

struct MaskWeights {
    int cells = 0;  // (R / B)^2: columns of cells, each from the first row on
    int bands = 0;
    std::vector<double> integrals;      // [cells][terms] c_i
    std::vector<std::uint32_t> pixels;  // [cells] whose centres lie in the disc
    std::vector<float> values;  // [cells + 1][terms] z_j at l^2 + j: of one pixel of the cell;
                                // then of all pixels together
    std::vector<glm::vec4> directions;  // [2 * bands - 1] d_j; w: 0. Then [cells]: the mean
                                        // direction of a cell, unit; w: its pixels
};

// size: R, 8 to 128. block: B, 1, 2, 4 or 8. The part of the disc in cells without a pixel's centre
// is added to the nearest cell that has one.
CLGI_API MaskWeights mask_weights(int size, int block = 2, int bands = sh::default_bands,
                                  CellIntegral integral = CellIntegral::exact);

}  // namespace clgi
