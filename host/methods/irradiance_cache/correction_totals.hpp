// How many directions of the sky corrections had (kernels/cache/gauge.cl).
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi {

// M and Q: directions of all corrections, and the sum of their squares, where those that have the
// same directions count as one.
struct CorrectionTotals {
    float total = 0.0f, squares = 0.0f;
    float last = 0.0f;  // of the directions of the last correction, together

    // again: the last one's directions once more.
    void add(float directions, bool again);
};

}  // namespace clgi
