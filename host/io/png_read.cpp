// A PNG as planes: what masks come as.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

#include "io/gltf_image.hpp"
#include "io/image_formats.hpp"

namespace clgi::io {
namespace {

constexpr std::size_t most_pixels = std::size_t{1} << 28;  // 2^30 samples, as in other formats

gltf::Pixels decode(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) throw InputError(path.string() + ": cannot be read");
    try {
        return gltf::decode_image(bytes, most_pixels);
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
}

}  // namespace

Image read_png(const std::filesystem::path& path) {
    const gltf::Pixels pixels = decode(path);
    const std::size_t count = pixels.rgba.size() / 4;
    Image image;
    image.width = pixels.width;
    image.height = pixels.height;
    for (std::size_t c = 0; c < 4; ++c) {
        std::vector<float>& plane =
            image.channels.emplace_back(Image::Channel{std::string(1, "RGBA"[c]), {}}).values;
        plane.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            plane[i] = static_cast<float>(pixels.rgba[4 * i + c]) / 255.0f;
        }
    }
    return image;
}

}  // namespace clgi::io
