// SPDX-License-Identifier: MIT
#include "lab/preview.hpp"

#include <algorithm>
#include <cmath>

#include "lab/metrics.hpp"

namespace clgi::lab {
namespace {

std::uint8_t encoded(float linear) {
    const float v = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // not a number is black
    const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(s * 255.0f + 0.5f);
}

}  // namespace

io::Image radiance_picture(const Renderer& renderer) {
    const auto [width, height] = renderer.size();
    return io::radiance_image(width, height, renderer.read_radiance());
}

std::vector<glm::vec3> radiance_of(const io::Image& picture) {
    std::vector<glm::vec3> out(picture.find("R")->values.size());
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>& plane = picture.find(std::string(1, "RGB"[c]))->values;
        for (std::size_t k = 0; k < out.size(); ++k) out[k][c] = plane[k];
    }
    return out;
}

float preview_exposure(const io::Image& picture) {
    std::vector<double> luminance = luminance_of(picture);
    std::erase_if(luminance, [](double y) { return !(y > 0.0); });
    if (luminance.empty()) return 1.0f;
    const auto white = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() * 97 / 100);
    std::nth_element(luminance.begin(), white, luminance.end());
    return static_cast<float>(1.0 / *white);
}

std::vector<std::uint8_t> preview(const io::Image& picture, float exposure) {
    std::vector<std::uint8_t> rgba(picture.find("R")->values.size() * 4, 255);
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>& values = picture.find(std::string(1, "RGB"[c]))->values;
        for (std::size_t i = 0; i < values.size(); ++i)
            rgba[4 * i + c] = encoded(values[i] * exposure);
    }
    return rgba;
}

}  // namespace clgi::lab
