// How far a picture is from the one it should be.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <cstddef>

namespace clgi::report {

// Of picture A against B, the truth; means run over pixels and over R, G and B. Sums are
// compensated doubles. Non-finite samples are counted, then replaced as load_image does.
struct Comparison {
    int width = 0;
    int height = 0;
    double rmse = 0.0;      // sqrt(mean (a-b)^2)
    double rel_rmse = 0.0;  // rmse / mean of B
    double rel_mse = 0.0;   // mean (a-b)^2 / (b^2 + (mean of B / 10)^2)
    double psnr = 0.0;      // dB, peak = largest sample of B; infinite for equal pictures
    double smape = 0.0;     // mean |a-b| / (|a|+|b|), 0 where both are 0; 0 to 1
    double max_abs = 0.0;   // max |a-b|
    int max_x = 0;          // a pixel where it occurs, row 0 at the top
    int max_y = 0;
    double mean_a = 0.0;
    double mean_b = 0.0;
    double energy_ratio = 0.0;  // mean of A / mean of B
    double nonfinite_a = 0.0;   // share of samples that are NaN or infinite, 0 to 1
    double nonfinite_b = 0.0;
};

// A quotient by zero is 0 where the numerator is 0 too (energy_ratio: 1), else infinite.
// Throws InputError when the sizes differ or a picture lacks R, G or B.
Comparison compare(const io::Image& a, const io::Image& b);

}  // namespace clgi::report
