// How far a picture is from the one it should be. Definitions and sources: docs/metrics.md.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/io/image.hpp>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "lab/mask.hpp"

namespace clgi::lab {

// Of picture A against B, the truth; means run over the pixels that count and over R, G and B.
// Sums are compensated doubles. Non-finite samples are counted, then replaced as load_image does.
struct Comparison {
    int width = 0;
    int height = 0;
    std::size_t pixels = 0;      // that count
    double rmse = 0.0;           // sqrt(mean (a-b)^2)
    double rel_rmse = 0.0;       // rmse / mean of B
    double rel_mse = 0.0;        // mean (a-b)^2 / (b^2 + (mean of B / 10)^2)
    double psnr = 0.0;           // dB, peak = largest sample of B; infinite for equal pictures
    double smape = 0.0;          // mean |a-b| / (|a|+|b|), 0 where both are 0; 0 to 1
    std::optional<double> flip;  // mean HDR-FLIP, 0 to 1; none when it was not asked for
    double p999_abs = 0.0;       // |a-b| that at most one sample in a thousand exceeds
    double max_abs = 0.0;        // max |a-b|
    int max_x = 0;               // a pixel where it occurs, row 0 at the top
    int max_y = 0;
    double mean_a = 0.0;
    double mean_b = 0.0;
    double energy_ratio = 0.0;  // mean of A / mean of B
    double nonfinite_a = 0.0;   // share of samples that are NaN or infinite, 0 to 1
    double nonfinite_b = 0.0;
};

struct CompareOptions {
    const Mask* mask = nullptr;  // null: every pixel counts
    bool flip = true;            // takes far longer than all others together
};

// A quotient by zero is 0 where the numerator is 0 too (energy_ratio: 1), else infinite.
// Throws InputError when the sizes differ, a picture lacks R, G or B, or no pixel counts.
Comparison compare(const io::Image& a, const io::Image& b, const CompareOptions& options = {});

// ---- luminance ----------------------------------------------------------------------------------

// Of every pixel. Channels are found by name: files keep them in an order of their own.
std::vector<double> luminance_of(const io::Image& picture);

// sqrt(mean (Y_a - Y_b)^2 - mean e_b^2) / mean Y_b, Y the luminance and e_b the standard error
// that picture B states in its plane error.Y, if it has one. 0 where noise explains all.
// mask: the pixels that count; null: all. Throws InputError when sizes differ, R, G or B is missing
// or no pixel counts.
double relative_error(const io::Image& a, const io::Image& b, const Mask* mask = nullptr);

// Mean luminance of a over that of b, over the same pixels.
double luminance_ratio(const io::Image& a, const io::Image& b, const Mask* mask = nullptr);

// ---- parts of comparisons -----------------------------------------------------------------------

using RgbPlanes = std::array<const std::vector<float>*, 3>;

// Throws InputError when the sizes differ, a picture is empty or lacks one of the three.
std::pair<RgbPlanes, RgbPlanes> rgb_planes(const io::Image& a, const io::Image& b);

// Of a value for each pixel, over the pixels that count.
double mean(const std::vector<float>& map, const Mask& mask);

}  // namespace clgi::lab
