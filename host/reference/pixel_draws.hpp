// Which pixels are path-traced to find out how far a picture is from the truth.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "reference/random.hpp"

namespace clgi::reference {

// The luminance of a picture's pixels, or of places: [height][width].
struct Brightness {
    std::vector<float> values;
    std::size_t width = 0;
    std::size_t height = 0;
};

struct DrawnPixel {
    std::size_t pixel = 0;
    std::size_t stratum = 0;
    // The mean probability of all pixels over that of this one: the mean of weighted values over
    // the draws of a stratum, and then over strata, estimates the mean over the picture.
    double weight = 0.0;
};

// The pixels, block after block, are divided into strata of equal probability. A third of a pixel's
// probability is the same for all, a third follows its brightness up to four times the mean, and a
// third follows its brightness without a limit. So dark pixels are drawn as well, and a bright one
// among dark ones is not missed.
class PixelDraws {
public:
    explicit PixelDraws(const Brightness& brightness);

    double mean() const { return mean_; }  // luminance, of all pixels

    // counts: draws of each stratum. By rising stratum.
    std::vector<DrawnPixel> draw(const std::vector<int>& counts, Random& random) const;

private:
    double share(std::size_t pixel) const;

    const Brightness& brightness_;
    double mean_ = 0.0;
    double size_ = 0.0;   // mean of absolute values
    double total_ = 0.0;  // of all shares
};

}  // namespace clgi::reference
