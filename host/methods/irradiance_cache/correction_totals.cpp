// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/correction_totals.hpp"

namespace clgi {

void CorrectionTotals::add(float directions, bool again) {
    const float before = again ? last : 0.0f;
    last = before + directions;
    total += directions;
    squares += last * last - before * before;
}

}  // namespace clgi
