// SPDX-License-Identifier: MIT
#include "io/png_decode.hpp"

#include <png.h>

#include <cstddef>
#include <cstring>

#include "io/png_errors.hpp"

namespace clgi::io {

namespace {

// As in png_encode.cpp, only trivial objects live between setjmp and a possible longjmp.
struct Source {
    const std::uint8_t* next;
    std::size_t left;
};

void read(png_structp png, png_bytep data, std::size_t length) {
    Source* source = static_cast<Source*>(png_get_io_ptr(png));
    if (length > source->left) png_error(png, "end of data");
    std::memcpy(data, source->next, length);
    source->next += length;
    source->left -= length;
}

bool decode(png_structp png, png_infop info, std::uint32_t w, std::uint32_t h, png_bytep rgba) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_info(png, info);
    if (png_get_image_width(png, info) != w || png_get_image_height(png, info) != h) return false;

    // Whatever the file holds becomes four bytes a pixel.
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    const std::size_t row_bytes = static_cast<std::size_t>(w) * 4;
    if (png_get_rowbytes(png, info) != row_bytes) return false;
    for (int pass = 0; pass < passes; ++pass) {
        for (std::uint32_t row = 0; row < h; ++row) {
            png_read_row(png, rgba + row * row_bytes, nullptr);
        }
    }
    return true;  // chunks behind the pixels are of no interest
}

}  // namespace

bool decode_png(std::span<const std::uint8_t> file, std::uint32_t w, std::uint32_t h,
                std::vector<std::uint8_t>& rgba) {
    rgba.assign(std::size_t{w} * h * 4, 0);
    Source source{file.data(), file.size()};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_png, ignore_png);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool complete = false;
    if (info) {
        png_set_read_fn(png, &source, read);
        png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
        complete = decode(png, info, w, h, rgba.data());
    }
    png_destroy_read_struct(&png, &info, nullptr);
    return complete;
}

}  // namespace clgi::io
