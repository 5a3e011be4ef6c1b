// Neumaier's compensated sum: the error does not grow with the number of samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace clgi::lab {

class Sum {
public:
    void add(double value) {
        const double next = sum_ + value;
        lost_ += std::abs(sum_) >= std::abs(value) ? (sum_ - next) + value : (value - next) + sum_;
        sum_ = next;
    }
    // What an infinite sum has lost is infinity minus infinity.
    double total() const { return std::isfinite(sum_) ? sum_ + lost_ : sum_; }

private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

}  // namespace clgi::lab
