// SPDX-License-Identifier: MIT
#include "program/picture.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "lab/preview.hpp"

namespace clgi::program {

void add_picture_flags(CLI::App& command, PictureFlags& flags, int width, int height) {
    command.add_option("-o,--output", flags.exr, "EXR picture: radiance in cd/m^2")
        ->type_name("FILE")
        ->default_str("none");
    command.add_option("--png", flags.png, "8-bit sRGB preview")
        ->type_name("FILE")
        ->default_str("none");
    command.add_option("--exposure", flags.exposure, "Exposure of the preview; at 0, 1 is white")
        ->type_name("STOPS")
        ->default_str("from the picture");
    command.add_flag("--full", flags.full, "Write 32-bit EXR channels instead of 16-bit ones");
    command.add_option("--size", flags.size, "Pixels across and down")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", width, height));
}

void parse_size(const std::string& command, const std::string& text, int most, int& width,
                int& height) {
    if (text.empty()) return;
    int used = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) != 2 ||
        used != static_cast<int>(text.size()) || width < 1 || height < 1 || width > most ||
        height > most)
        throw Error(fmt::format("{}: --size is '{}', WIDTHxHEIGHT from 1x1 to {}x{} needed",
                                command, text, most, most));
}

void check_formats(const std::string& command, const PictureFlags& flags) {
    const std::filesystem::path exr = flags.exr, png = flags.png;
    if (exr.extension() == ".png" || exr.extension() == ".PNG")
        throw Error(
            fmt::format("{}: -o is '{}', an EXR needed; --png writes PNG", command, flags.exr));
    if (png.extension() == ".exr" || png.extension() == ".EXR")
        throw Error(
            fmt::format("{}: --png is '{}', a PNG needed; -o writes EXR", command, flags.png));
}

void check_picture(const std::string& command, const PictureFlags& flags, int& width, int& height) {
    check_formats(command, flags);
    if (flags.exr.empty() && flags.png.empty())
        throw Error(command + ": no output is given, -o FILE.exr or --png FILE.png needed");
    parse_size(command, flags.size, 16384, width, height);
}

std::string names_of(const PictureFlags& flags) {
    const bool both = !flags.exr.empty() && !flags.png.empty();
    return flags.exr + (both ? ", " : "") + flags.png;
}

void save_picture(const io::Image& picture, const PictureFlags& flags) {
    if (!flags.exr.empty())
        io::save_exr(picture, flags.exr, flags.full ? io::PixelType::full : io::PixelType::half);
    if (!flags.png.empty()) {
        const float exposure =
            flags.exposure ? std::exp2(*flags.exposure) : lab::preview_exposure(picture);
        io::save_png(picture.width, picture.height, lab::preview(picture, exposure), flags.png);
    }
}

}  // namespace clgi::program
