// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "reference/material.hpp"

namespace clgi::reference {
namespace {

int wrapped(long long i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp_to_edge) return static_cast<int>(std::clamp<long long>(i, 0, size - 1));
    const long long period = wrap == Wrap::repeat ? size : 2LL * size;
    const long long folded = ((i % period) + period) % period;
    return static_cast<int>(folded < size ? folded : period - 1 - folded);
}

float decoded(std::uint8_t byte, bool srgb) {
    const float x = static_cast<float>(byte) / 255.0f;
    if (!srgb) return x;
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

glm::vec4 fetched(const Texture& texture, long long column, long long row) {
    const int x = wrapped(column, texture.width, texture.wrap_s);
    const int y = wrapped(row, texture.height, texture.wrap_t);
    const std::uint8_t* bytes =
        &texture.rgba[4 * (static_cast<std::size_t>(y) * texture.width + x)];
    return {decoded(bytes[0], texture.srgb), decoded(bytes[1], texture.srgb),
            decoded(bytes[2], texture.srgb), static_cast<float>(bytes[3]) / 255.0f};
}

// Into two periods, or next to the picture: whatever the coordinate, its texels are integers.
double folded(float coordinate, Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0.0;
    const auto u = double{coordinate};
    return wrap == Wrap::clamp_to_edge ? std::clamp(u, -1.0, 2.0) : u - 2.0 * std::floor(0.5 * u);
}

}  // namespace

glm::vec4 texel(const Texture& texture, glm::vec2 uv) {
    const double x = folded(uv.x, texture.wrap_s) * texture.width;
    const double y = folded(uv.y, texture.wrap_t) * texture.height;
    if (texture.nearest)
        return fetched(texture, static_cast<long long>(std::floor(x)),
                       static_cast<long long>(std::floor(y)));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const auto fx = static_cast<float>(x - 0.5 - left), fy = static_cast<float>(y - 0.5 - top);
    const auto column = static_cast<long long>(left), row = static_cast<long long>(top);
    return glm::mix(
        glm::mix(fetched(texture, column, row), fetched(texture, column + 1, row), fx),
        glm::mix(fetched(texture, column, row + 1), fetched(texture, column + 1, row + 1), fx), fy);
}

}  // namespace clgi::reference
