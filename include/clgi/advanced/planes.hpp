// Sizes of planes of pixels in bytes. Layout: clgi/shared/planes.h.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/image.h>
#include <clgi/shared/planes.h>
#include <clgi/advanced/pass.hpp>

namespace clgi {

// Values from plane to plane for so many points: a multiple of 16, so that every packet stays
// inside its plane, and no multiple of a page, so that the same point of all planes does not fall
// into one set of a CPU's cache.
inline std::uint32_t plane_stride(std::size_t points) {
    constexpr std::size_t line = 16, page = 1024, skew = 5 * line;
    const std::size_t whole = (points + line - 1) / line * line;
    if (whole < page) return static_cast<std::uint32_t>(whole);
    return static_cast<std::uint32_t>((whole + page - 1 - skew) / page * page + skew);
}

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
