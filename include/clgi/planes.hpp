// How many bytes planes of pixels take. Layout: clgi/shared/planes.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/image.h>
#include <clgi/shared/planes.h>
#include <clgi/pass.hpp>

namespace clgi {

// A whole G-buffer, stride values from plane to plane.
inline std::size_t gbuffer_bytes(Storage storage, std::size_t stride) {
    return storage == Storage::half ? GBUFFER_HALF_ROWS * stride * sizeof(std::uint16_t)
                                    : GBUFFER_PLANES * stride * sizeof(float);
}

// A set of points: positions and normals.
inline std::size_t point_bytes(Storage storage, std::size_t stride) {
    return storage == Storage::half ? POINT_HALF_ROWS * stride * sizeof(std::uint16_t)
                                    : POINT_PLANES * stride * sizeof(float);
}

inline std::size_t irradiance_bytes(Storage storage, std::size_t stride) {
    return IRRADIANCE_PLANES * stride *
           (storage == Storage::half ? sizeof(std::uint16_t) : sizeof(float));
}

}  // namespace clgi
