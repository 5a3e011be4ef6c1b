// Build options of kernels that do not come in every variant.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>

namespace clgi {

// Planes of floats, whatever storage other rooms have.
inline BuildOptions full(BuildOptions options) {
    options.storage = Storage::full;
    return options;
}

// The same, and one lane: a work-item is no packet.
inline BuildOptions scalar(BuildOptions options) {
    options.packet_width = 1;
    return full(options);
}

}  // namespace clgi
