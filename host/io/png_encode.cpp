// SPDX-License-Identifier: MIT
#include "io/png_encode.hpp"

#include <png.h>

#include <clgi/error.hpp>
#include <cstddef>
#include <new>
#include <string>

#include "io/png_errors.hpp"

namespace clgi::io {

namespace {

// libpng leaves a failed call by longjmp, which must not pass over a C++ destructor: the frame
// that sets the jump holds nothing but pointers, and the bytes live in the caller's.
struct Encoded {
    std::vector<std::uint8_t>* bytes;
    bool out_of_memory;
};

void append(png_structp png, png_bytep data, std::size_t length) {
    Encoded* encoded = static_cast<Encoded*>(png_get_io_ptr(png));
    try {
        encoded->bytes->insert(encoded->bytes->end(), data, data + length);
    } catch (const std::bad_alloc&) {
        encoded->out_of_memory = true;
    }
    if (encoded->out_of_memory) png_error(png, "out of memory");
}

void flush(png_structp) {}

bool write(png_structp png, png_infop info, int w, int h, const std::uint8_t* rgba) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_IHDR(png, info, static_cast<png_uint_32>(w), static_cast<png_uint_32>(h), 8,
                 PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const std::size_t row_bytes = static_cast<std::size_t>(w) * 4;
    for (int row = 0; row < h; ++row) {
        png_write_row(png, rgba + static_cast<std::size_t>(row) * row_bytes);
    }
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::vector<std::uint8_t> encode_png(int w, int h, const std::uint8_t* rgba) {
    const std::string size = std::to_string(w) + "x" + std::to_string(h);
    if (w <= 0 || h <= 0) throw Error("encode_png: a picture of " + size + " pixels");

    std::vector<std::uint8_t> bytes;
    Encoded encoded{&bytes, false};
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_png, ignore_png);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool written = false;
    if (info) {
        png_set_write_fn(png, &encoded, append, flush);
        png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
        written = write(png, info, w, h, rgba);
    }
    png_destroy_write_struct(&png, &info);
    if (encoded.out_of_memory) throw std::bad_alloc();
    if (!written) throw Error("encode_png: libpng cannot write " + size + " pixels");
    return bytes;
}

}  // namespace clgi::io
