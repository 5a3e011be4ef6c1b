// Radiance HDR: a text header, a size line, then rows of shared-exponent bytes (R, G, B, E), each
// row run-length coded in one of two ways or not at all.
//
// Own code because the packaged reader takes a truncated file for a black one. Rows are decoded
// one after another and memory grows with them, so a header cannot ask for more than the file has.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "io/image_formats.hpp"

namespace clgi::io {
namespace {

using Texel = std::array<std::uint8_t, 4>;  // mantissas of R, G, B and their exponent

// The file's bytes and how far they are read.
class Reader {
public:
    explicit Reader(const std::filesystem::path& path) : path_(path) {
        std::ifstream stream(path, std::ios::binary);
        bytes_.assign(std::istreambuf_iterator<char>(stream), {});
        if (stream.bad()) fail("cannot be read");
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(path_.string() + ": " + what);
    }

    std::string line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string::npos) fail("the header does not end");
        std::string text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (!text.empty() && text.back() == '\r') text.pop_back();
        return text;
    }

    std::uint8_t byte() {
        if (at_ == bytes_.size()) fail("is truncated");
        return static_cast<std::uint8_t>(bytes_[at_++]);
    }

    Texel texel() { return {byte(), byte(), byte(), byte()}; }
    void step_back(std::size_t count) { at_ -= count; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::string bytes_;
    std::size_t at_ = 0;
};

struct Header {
    int width = 0;
    int height = 0;
    bool bottom_up = false;
    bool right_to_left = false;
    double exposure = 1.0;  // the samples were multiplied with it
};

void read_variables(Reader& reader, Header& header) {
    for (std::string line = reader.line(); !line.empty(); line = reader.line()) {
        if (line.rfind("FORMAT=", 0) == 0 && line.find("32-bit_rle_rgbe") == std::string::npos) {
            reader.fail("has " + line + ", needs 32-bit_rle_rgbe");
        }
        if (line.rfind("EXPOSURE=", 0) == 0) {
            const double factor = std::strtod(line.c_str() + 9, nullptr);
            if (!(factor > 0.0) || !std::isfinite(factor)) reader.fail("has " + line);
            header.exposure *= factor;  // each program that changed it added a line
        }
    }
}

void read_size(Reader& reader, Header& header) {
    const std::string line = reader.line();
    std::istringstream words(line);
    std::string vertical, horizontal;
    long long height = 0, width = 0;
    words >> vertical >> height >> horizontal >> width;
    if (!words || (vertical != "-Y" && vertical != "+Y") ||
        (horizontal != "+X" && horizontal != "-X")) {
        reader.fail("has the size line '" + line.substr(0, 60) + "', needs -Y height +X width");
    }
    check_dimensions(reader.path(), width, height, 3);
    header.width = static_cast<int>(width);
    header.height = static_cast<int>(height);
    header.bottom_up = vertical == "+Y";
    header.right_to_left = horizontal == "-X";
}

// Newer code: the four components one after another, each as runs and literal stretches.
void read_planar_row(Reader& reader, std::vector<Texel>& row) {
    for (std::size_t component = 0; component < 4; ++component) {
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = reader.byte();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128u : code;
            if (count == 0 || count > row.size() - x) reader.fail("a run passes the row's end");
            std::uint8_t value = run ? reader.byte() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i, ++x) {
                if (!run) value = reader.byte();
                row[x][component] = value;
            }
        }
    }
}

// Older code: a texel (1, 1, 1, n) repeats the one before it n times, shifted by eight bits for
// every such texel that came directly before.
void read_flat_row(Reader& reader, std::vector<Texel>& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const Texel texel = reader.texel();
        if (texel[0] != 1 || texel[1] != 1 || texel[2] != 1) {
            row[x++] = texel;
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 16) reader.fail("a run has nothing to repeat");
        const std::size_t count = static_cast<std::size_t>(texel[3]) << shift;
        if (count > row.size() - x) reader.fail("a run passes the row's end");
        for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
        shift += 8;
    }
}

void read_row(Reader& reader, std::vector<Texel>& row) {
    const Texel start = reader.texel();
    const bool planar = start[0] == 2 && start[1] == 2 && start[2] < 128 && row.size() >= 8;
    if (!planar) {
        reader.step_back(4);
        read_flat_row(reader, row);
        return;
    }
    if (start[2] * 256u + start[3] != row.size()) reader.fail("a row has another width");
    read_planar_row(reader, row);
}

}  // namespace

Image read_hdr(const std::filesystem::path& path) {
    Reader reader(path);
    Header header;
    read_variables(reader, header);
    read_size(reader, header);

    Image image;
    image.width = header.width;
    image.height = header.height;
    image.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
    std::vector<Texel> row(static_cast<std::size_t>(header.width));
    for (int y = 0; y < header.height; ++y) {
        read_row(reader, row);
        if (header.right_to_left) std::reverse(row.begin(), row.end());
        for (const Texel& texel : row) {
            // Mantissas are fractions of 256 and exponents biased by 128; 0 means black.
            const double scale =
                texel[3] == 0 ? 0.0 : std::ldexp(1.0 / header.exposure, texel[3] - 136);
            for (std::size_t c = 0; c < 3; ++c) {
                image.channels[c].values.push_back(static_cast<float>(texel[c] * scale));
            }
        }
    }
    if (!header.bottom_up) return image;
    const auto width = static_cast<std::ptrdiff_t>(header.width);
    for (Image::Channel& channel : image.channels) {
        for (std::ptrdiff_t top = 0, low = header.height - 1; top < low; ++top, --low) {
            const auto upper = channel.values.begin() + top * width;
            std::swap_ranges(upper, upper + width, channel.values.begin() + low * width);
        }
    }
    return image;
}

}  // namespace clgi::io
