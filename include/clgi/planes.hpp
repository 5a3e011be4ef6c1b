// Sizes of planes of pixels in bytes. Layout: clgi/shared/planes.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/image.h>
#include <clgi/shared/planes.h>
#include <clgi/pass.hpp>

namespace clgi {

// A G-buffer, or the first planes of one, stride values from plane to plane.
inline std::size_t gbuffer_bytes(Storage storage, std::size_t stride,
                                 std::size_t planes = GBUFFER_PLANES) {
    const std::size_t half_rows =
        planes == GBUFFER_PLANES ? std::size_t{GBUFFER_HALF_ROWS} : HALF_ROW(planes);
    return storage == Storage::half ? half_rows * stride * sizeof(std::uint16_t)
                                    : planes * stride * sizeof(float);
}

// A set of points: positions and normals.
inline std::size_t point_bytes(Storage storage, std::size_t stride) {
    return gbuffer_bytes(storage, stride, POINT_PLANES);
}

inline std::size_t irradiance_bytes(Storage storage, std::size_t stride) {
    return IRRADIANCE_PLANES * stride *
           (storage == Storage::half ? sizeof(std::uint16_t) : sizeof(float));
}

}  // namespace clgi
