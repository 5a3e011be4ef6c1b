// SPDX-License-Identifier: MIT
#include "io/gltf_image.hpp"

#include <array>
#include <clgi/error.hpp>
#include <climits>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "io/png_decode.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS (1 << 24)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace clgi::io::gltf {

namespace {

using namespace std::string_view_literals;

bool has_at(Bytes bytes, std::size_t at, std::string_view expected) {
    return bytes.size() >= at + expected.size() &&
           std::memcmp(bytes.data() + at, expected.data(), expected.size()) == 0;
}

std::uint32_t big_endian(Bytes bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
           std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

struct Size {
    std::uint64_t width;
    std::uint64_t height;
};

// Refuses a size that is too large, or that so few bytes cannot stand for: the densest coding
// spends most_per_byte pixels on a byte.
void judge(Size size, std::size_t most, std::size_t bytes, std::size_t most_per_byte) {
    const std::string text = std::to_string(size.width) + "x" + std::to_string(size.height);
    if (size.width == 0 || size.height == 0 || size.width > INT_MAX || size.height > INT_MAX) {
        throw InputError("is of " + text + " pixels");
    }
    const std::uint64_t pixels = size.width * size.height;
    if (pixels > most) {
        throw InputError("is of " + text + " pixels, " + std::to_string(most) + " are allowed");
    }
    if (pixels / most_per_byte > bytes) {
        throw InputError("says " + text + " pixels, but has only " + std::to_string(bytes) +
                         " bytes");
    }
}

Pixels decode_png_file(Bytes bytes, std::size_t most) {
    if (bytes.size() < 33 || !has_at(bytes, 12, "IHDR"sv)) throw InputError("is no complete PNG");
    const Size size{big_endian(bytes, 16), big_endian(bytes, 20)};
    // Deflate at best packs 1032 bytes into one, and a byte holds up to 8 pixels.
    judge(size, most, bytes.size(), 1032 * 8);
    Pixels pixels{static_cast<int>(size.width), static_cast<int>(size.height), {}};
    if (!decode_png(bytes, static_cast<std::uint32_t>(size.width),
                    static_cast<std::uint32_t>(size.height), pixels.rgba)) {
        throw InputError("is a damaged PNG");
    }
    return pixels;
}

Pixels decode_jpeg_file(Bytes bytes, std::size_t most) {
    int width = 0;
    int height = 0;
    int channels = 0;
    if (bytes.size() > INT_MAX) throw InputError("is a JPEG of more than 2 GiB");
    const int length = static_cast<int>(bytes.size());
    if (!stbi_info_from_memory(bytes.data(), length, &width, &height, &channels)) {
        throw InputError("is a damaged JPEG");
    }
    // A block of 64 pixels takes at least one bit.
    judge({static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)}, most,
          bytes.size(), 512);
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(bytes.data(), length, &width, &height, &channels, 4),
        stbi_image_free);
    if (!decoded) throw InputError("is a damaged JPEG");
    const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
    return {width, height, std::vector<std::uint8_t>(decoded.get(), decoded.get() + size)};
}

}  // namespace

ImageFormat image_format(Bytes bytes) {
    if (has_at(bytes, 0, "\x89PNG\r\n\x1a\n"sv)) return ImageFormat::png;
    if (has_at(bytes, 0, "\xff\xd8\xff"sv)) return ImageFormat::jpeg;
    const bool webp = has_at(bytes, 0, "RIFF"sv) && has_at(bytes, 8, "WEBP"sv);
    const bool avif = has_at(bytes, 4, "ftyp"sv);
    const bool ktx = has_at(bytes, 0, "\xabKTX "sv);
    const bool other =
        has_at(bytes, 0, "DDS "sv) || has_at(bytes, 0, "GIF8"sv) || has_at(bytes, 0, "BM"sv);
    return webp || avif || ktx || other ? ImageFormat::unsupported : ImageFormat::unknown;
}

Pixels decode_image(Bytes bytes, std::size_t most) {
    return image_format(bytes) == ImageFormat::png ? decode_png_file(bytes, most)
                                                   : decode_jpeg_file(bytes, most);
}

}  // namespace clgi::io::gltf
