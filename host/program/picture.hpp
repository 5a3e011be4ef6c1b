// From a finished picture to files.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/io/image.hpp>
#include <optional>
#include <string>

namespace clgi::program {

struct PictureFlags {
    std::string exr;                // empty: none
    std::string png;                // empty: none
    bool full = false;              // 32-bit EXR channels instead of half
    std::optional<float> exposure;  // stops, 0: radiance 1 is white; none: from the picture
    std::string size;               // WIDTHxHEIGHT; empty: the default
};
// width, height: the default size.
void add_picture_flags(CLI::App& command, PictureFlags& flags, int width, int height);

// "640x480", each side from 1 to `most`; empty: both stay as they are. Throws Error that begins
// with the command's name.
void parse_size(const std::string& command, const std::string& text, int most, int& width,
                int& height);

// Throws Error for a file name that says another format than the one that is written.
void check_formats(const std::string& command, const PictureFlags& flags);

// Throws Error that begins with the command's name if there is no output, if a file's name says
// another format, or if the size is invalid.
void check_picture(const std::string& command, const PictureFlags& flags, int& width, int& height);

// The files that the flags name, for a line about them: "out.exr, out.png".
std::string names_of(const PictureFlags& flags);

// Writes the files that the flags name.
void save_picture(const io::Image& picture, const PictureFlags& flags);

}  // namespace clgi::program
