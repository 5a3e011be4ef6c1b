// The mean of replicates of a picture's luminance, and how far off it may be.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace clgi {

class ReplicateMean {
public:
    // Luminances of all pixels of one more replicate.
    void add(const std::vector<double>& luminances) {
        sum_.resize(luminances.size());
        square_.resize(luminances.size());
        for (std::size_t i = 0; i < luminances.size(); ++i) {
            sum_[i] += luminances[i];
            square_[i] += luminances[i] * luminances[i];
        }
        ++count_;
    }

    std::vector<double> mean() const {
        std::vector<double> out = sum_;
        for (double& each : out) each /= count_;
        return out;
    }

    // Squared standard error of the mean, of every pixel, from two replicates or more.
    std::vector<double> variance() const {
        std::vector<double> out = mean();
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = std::max(square_[i] / count_ - out[i] * out[i], 0.0) / (count_ - 1);
        return out;
    }

private:
    std::vector<double> sum_, square_;
    int count_ = 0;
};

}  // namespace clgi
