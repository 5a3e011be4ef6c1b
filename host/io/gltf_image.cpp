// SPDX-License-Identifier: MIT
#include "io/gltf_image.hpp"

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstring>
#include <memory>
#include <string>

#include "io/gltf_codecs.hpp"
#include "io/gltf_text.hpp"
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

bool is_webp(Bytes bytes) { return has_at(bytes, 0, "RIFF"sv) && has_at(bytes, 8, "WEBP"sv); }

bool is_png(Bytes bytes) { return has_at(bytes, 0, "\x89PNG\r\n\x1a\n"sv); }

std::uint32_t big_endian(Bytes bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
           std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

struct Size {
    std::uint32_t width;
    std::uint32_t height;

    std::string text() const { return std::to_string(width) + "x" + std::to_string(height); }
};

Size png_size(Bytes bytes) {
    require(bytes.size() >= 33 && has_at(bytes, 8, "\0\0\0\rIHDR"sv), "is no complete PNG");
    const Size size{big_endian(bytes, 16), big_endian(bytes, 20)};
    require(size.width > 0 && size.height > 0 && size.width <= INT_MAX && size.height <= INT_MAX,
            "is of ", size.text(), " pixels");
    return size;
}

// Refuses a size that is too large, or that so few bytes cannot stand for: the densest coding
// spends most_per_byte pixels on a byte.
void judge(Size size, std::size_t most, std::size_t bytes, std::size_t most_per_byte) {
    const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
    require(pixels <= most, "is of ", size.text(), " pixels, ", most, " are allowed");
    require(pixels / most_per_byte <= bytes, "says ", size.text(), " pixels, but has only ", bytes,
            " bytes");
}

// Follows the segments of a JPEG to the one with its size.
void check_jpeg_start(Bytes start) {
    constexpr std::size_t size_end = 9;  // in the segment with the size
    std::size_t at = 2;
    while (at + size_end <= start.size()) {
        if (start[at] != 0xff || start[at + 1] == 0xff) {  // decoders skip what lies between
            ++at;
            continue;
        }
        const int marker = start[at + 1];
        const bool frame = marker >= 0xc0 && marker <= 0xcf;
        if (frame && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) return;
        const std::size_t length = std::size_t{start[at + 2]} << 8 | start[at + 3];
        const bool segment = frame || marker >= 0xdb;  // not a restart, an end, or the pixels
        require(segment && length >= 2, "is a damaged JPEG");
        at += 2 + length;
    }
    require(start.size() >= inspected_bytes, "is no complete JPEG");
}

Pixels decode_png_file(Bytes bytes, std::size_t most) {
    const Size size = png_size(bytes);
    // Deflate at best packs 1032 bytes into one, and a byte holds up to 8 pixels.
    judge(size, most, bytes.size(), 1032 * 8);
    Pixels pixels{static_cast<int>(size.width), static_cast<int>(size.height), {}};
    require(decode_png(bytes, size.width, size.height, pixels.rgba), "is a damaged PNG");
    return pixels;
}

Pixels decode_jpeg_file(Bytes bytes, std::size_t most) {
    require(bytes.size() <= INT_MAX, "is a JPEG of more than 2 GiB");
    const int length = static_cast<int>(bytes.size());
    Pixels pixels;
    int channels = 0;
    require(stbi_info_from_memory(bytes.data(), length, &pixels.width, &pixels.height, &channels),
            "is a damaged JPEG");
    const Size size{static_cast<std::uint32_t>(pixels.width),
                    static_cast<std::uint32_t>(pixels.height)};
    judge(size, most, bytes.size(), 512);  // a block of 64 pixels takes at least one bit
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(bytes.data(), length, &pixels.width, &pixels.height, &channels, 4),
        stbi_image_free);
    require(decoded != nullptr, "is a damaged JPEG");
    const std::size_t count = std::size_t{size.width} * size.height;
    pixels.rgba.assign(decoded.get(), decoded.get() + count * 4);
    return pixels;
}

}  // namespace

ImageFormat inspect_image(Bytes bytes) {
    if (is_png(bytes)) return png_size(bytes), ImageFormat::png;
    if (has_at(bytes, 0, "\xff\xd8\xff"sv)) {
        check_jpeg_start(bytes.first(std::min(bytes.size(), inspected_bytes)));
        return ImageFormat::jpeg;
    }
    if (webp_codec.built && is_webp(bytes)) return ImageFormat::webp;
    const bool avif = has_at(bytes, 4, "ftyp"sv);
    const bool other = has_at(bytes, 0, "\xabKTX "sv) || has_at(bytes, 0, "DDS "sv) ||
                       has_at(bytes, 0, "GIF8"sv) || has_at(bytes, 0, "BM"sv);
    require(is_webp(bytes) || avif || other, "is neither PNG nor JPEG nor WebP");
    return ImageFormat::unsupported;
}

const char* name_of(ImageFormat format) {
    if (format == ImageFormat::webp) return "WebP";
    return format == ImageFormat::png ? "PNG" : "JPEG";
}

bool contradicts(std::string_view media_type, ImageFormat format) {
    std::string type(media_type);
    for (char& c : type) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!type.starts_with("image/") || format == ImageFormat::unsupported) return false;
    if (format == ImageFormat::png) return type != "image/png";
    if (format == ImageFormat::webp) return type != "image/webp";
    return type != "image/jpeg" && type != "image/jpg";
}

Pixels decode_image(Bytes bytes, std::size_t most) {
    if constexpr (webp_codec.built) {
        if (is_webp(bytes)) return decode_webp_file(bytes, most);
    }
    return is_png(bytes) ? decode_png_file(bytes, most) : decode_jpeg_file(bytes, most);
}

}  // namespace clgi::io::gltf
