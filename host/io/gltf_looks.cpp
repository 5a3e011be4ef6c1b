// SPDX-License-Identifier: MIT
#include "io/gltf_looks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

std::optional<AccessorReader> reader_of(const Document& document, const Primitive& primitive,
                                        const char* name) {
    const int accessor = attribute(primitive.attributes, name);
    if (accessor < 0) return std::nullopt;
    return AccessorReader(document, accessor);
}

float finite_or(double value, float fallback, bool& mended) {
    if (std::isfinite(value)) return static_cast<float>(value);
    mended = true;
    return fallback;
}

}  // namespace

bool append_looks(const Document& document, const Primitive& primitive,
                  const std::vector<std::uint32_t>& vertices, bool textured, bool colored,
                  Scene& scene) {
    bool mended = false;
    if (textured) {
        const std::optional<AccessorReader> sets[2] = {
            reader_of(document, primitive, "TEXCOORD_0"),
            reader_of(document, primitive, "TEXCOORD_1")};
        for (const std::uint32_t vertex : vertices) {
            glm::vec4 uv(0.0f);
            for (int i = 0; i < 4; ++i) {
                const auto& set = sets[i / 2];
                if (set) uv[i] = finite_or(set->number(vertex, i % 2), 0.0f, mended);
            }
            scene.uvs.push_back(uv);
        }
    }
    if (colored) {
        const auto colors = reader_of(document, primitive, "COLOR_0");
        const int channels = colors ? static_cast<int>(colors->width()) : 0;
        for (const std::uint32_t vertex : vertices) {
            glm::vec4 color(1.0f);
            for (int i = 0; i < channels; ++i) {
                const float channel = finite_or(colors->number(vertex, i), 1.0f, mended);
                color[i] = std::clamp(channel, 0.0f, 1.0f);
            }
            scene.colors.push_back(color);
        }
    }
    return mended;
}

}  // namespace clgi::io::gltf
