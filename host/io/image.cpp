// Which reader a file needs, and what every picture goes through after it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "io/file_error.hpp"
#include "io/image_formats.hpp"

namespace clgi::io {
namespace {

namespace fs = std::filesystem;

std::string first_bytes(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) fail(path, "there is no such file");
    if (fs::is_directory(status)) fail(path, "is a directory");
    // Not for speed: a pipe or a device may never end.
    if (!fs::is_regular_file(status)) fail(path, "is not a regular file");

    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail(path, "cannot be read");
    std::string bytes(8, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    if (bytes.empty()) fail(path, "is empty");
    return bytes;
}

bool starts_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

}  // namespace

const Image::Channel* Image::find(const std::string& name) const {
    const auto found = std::find_if(channels.begin(), channels.end(),
                                    [&](const Channel& channel) { return channel.name == name; });
    return found == channels.end() ? nullptr : &*found;
}

float finite(float sample) {
    if (std::isnan(sample)) return 0.0f;
    constexpr float largest = std::numeric_limits<float>::max();
    return std::clamp(sample, -largest, largest);
}

std::size_t make_finite(Image& image) {
    std::size_t replaced = 0;
    for (Image::Channel& channel : image.channels) {
        for (float& sample : channel.values) {
            if (std::isfinite(sample)) continue;
            sample = finite(sample);
            ++replaced;
        }
    }
    return replaced;
}

void check_dimensions(const fs::path& path, std::int64_t width, std::int64_t height,
                      std::int64_t channels) {
    constexpr std::int64_t longest = 65536, most_samples = std::int64_t{1} << 30;
    const std::string size = std::to_string(width) + "x" + std::to_string(height) + " pixels";
    if (width < 1 || height < 1) fail(path, "has " + size + ", needs at least 1x1");
    if (width > longest || height > longest) {
        fail(path, "has " + size + ", at most 65536x65536 can be read");
    }
    if (channels > most_samples / (width * height)) {
        fail(path, "has " + size + " of " + std::to_string(channels) +
                       " channels, at most 2^30 samples can be read");
    }
}

Image read_image(const fs::path& path) {
    const std::string bytes = first_bytes(path);
    if (starts_with(bytes, "\x76\x2f\x31\x01")) return read_exr(path);
    if (starts_with(bytes, "#?")) return read_hdr(path);
    if (starts_with(bytes, "\x89PNG")) fail(path, "is a PNG; OpenEXR or Radiance HDR is needed");
    fail(path, "is neither OpenEXR nor Radiance HDR");
}

Image read_image_or_png(const fs::path& path) {
    return starts_with(first_bytes(path), "\x89PNG") ? read_png(path) : read_image(path);
}

Image load_image(const fs::path& path, LoadReport* report) {
    Image image = read_image(path);
    const std::size_t replaced = make_finite(image);
    if (report) report->non_finite = replaced;
    return image;
}

Image radiance_image(int width, int height, std::array<std::vector<float>, 3> planes) {
    Image image;
    image.width = width;
    image.height = height;
    image.attributes = {{"clgi:quantity", "radiance"}, {"clgi:unit", "cd/m^2"}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (std::size_t c = 0; c < planes.size(); ++c) {
        if (planes[c].size() != pixels)
            throw Error("radiance_image: a plane has " + std::to_string(planes[c].size()) +
                        " values, " + std::to_string(pixels) + " needed");
        image.channels.push_back({std::string(1, "RGB"[c]), std::move(planes[c])});
    }
    return image;
}

}  // namespace clgi::io
