// decode_webp_file: WebP as EXT_texture_webp allows it, lossy or lossless, without animation.
// SPDX-License-Identifier: MIT
#include <webp/decode.h>

#include "io/gltf_image.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

Pixels decode_webp_file(Bytes bytes, std::size_t most) {
    WebPBitstreamFeatures features;
    require(WebPGetFeatures(bytes.data(), bytes.size(), &features) == VP8_STATUS_OK,
            "is a damaged WebP");
    require(features.has_animation == 0, "is an animated WebP");
    // Its codes may spend no bit on a pixel, so the number of bytes tells nothing of their number.
    const std::size_t pixels =
        static_cast<std::size_t>(features.width) * static_cast<std::size_t>(features.height);
    require(pixels <= most, "is of ", features.width, "x", features.height, " pixels, ", most,
            " are allowed");
    Pixels decoded{features.width, features.height, std::vector<std::uint8_t>(pixels * 4)};
    require(WebPDecodeRGBAInto(bytes.data(), bytes.size(), decoded.rgba.data(), decoded.rgba.size(),
                               features.width * 4) != nullptr,
            "is a damaged WebP");
    return decoded;
}

}  // namespace clgi::io::gltf
