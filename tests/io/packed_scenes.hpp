// What the tests of codecs share: a surface with all attributes, and damage.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <random>

#include "gltf_draft.hpp"

namespace clgi::test {

using Bytes = std::vector<std::uint8_t>;

// A wavy surface of exact binary fractions, with a colour for each vertex.
struct WavySurface {
    static constexpr int width = 9, height = 7;
    Floats3 positions, normals;
    std::vector<std::array<float, 2>> uvs;
    std::vector<std::array<std::uint8_t, 4>> colors;
    std::vector<std::uint32_t> indices;

    WavySurface() {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float slope = 0.125f * static_cast<float>((3 * x + y) % 5 - 2);
                positions.push_back({0.25f * static_cast<float>(x), 0.5f * static_cast<float>(y),
                                     0.125f * static_cast<float>(x * y % 7)});
                const float length = std::sqrt(slope * slope + 1.25f);
                normals.push_back({slope / length, -0.5f / length, 1.0f / length});
                uvs.push_back({static_cast<float>(x) / 8.0f, static_cast<float>(y) / 16.0f});
                const int i = x + width * y;
                colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(3 * i),
                                  static_cast<std::uint8_t>(255 - i), 255});
            }
        }
        for (std::uint32_t y = 0; y + 1 < height; ++y) {
            for (std::uint32_t x = 0; x + 1 < width; ++x) {
                const std::uint32_t i = x + width * y;
                for (const std::uint32_t corner :
                     {i, i + 1, i + width, i + width, i + 1, i + width + 1})
                    indices.push_back(corner);
            }
        }
    }

    std::size_t count() const { return positions.size(); }

    // Written without any compression. Its texture coordinates are kept for a light map alone.
    Scene load() const {
        GltfDraft draft;
        json attributes = {{"POSITION", draft.vec3(positions)}, {"NORMAL", draft.vec3(normals)}};
        attributes["TEXCOORD_0"] = draft.accessor(draft.view(uvs), count(), "VEC2", float_type);
        attributes["COLOR_0"] =
            draft.accessor(draft.view(colors), count(), "VEC4", uint8_type, true);
        const int corners =
            draft.accessor(draft.view(indices), indices.size(), "SCALAR", uint32_type);
        draft.show({{"attributes", attributes}, {"indices", corners}});
        return draft.load({.lightmaps = true});
    }
};

// The triangles by what they are made of, whatever the order of vertices and triangles: corners as
// they follow each other, from the least one on.
inline std::vector<std::vector<double>> triangle_soup(const Scene& scene) {
    std::vector<std::vector<double>> soup;
    for (const auto& triangle : scene.triangles) {
        std::array<std::vector<double>, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t v = triangle.vertex[i];
            const glm::dvec3 p = scene.positions[v], n = scene.normals[v];
            corners[i] = {p.x, p.y, p.z, n.x, n.y, n.z};
            for (int k = 0; k < 4 && !scene.uvs.empty(); ++k) corners[i].push_back(scene.uvs[v][k]);
            for (int k = 0; k < 4 && !scene.colors.empty(); ++k)
                corners[i].push_back(scene.colors[v][k]);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        soup.emplace_back();
        for (const auto& corner : corners)
            soup.back().insert(soup.back().end(), corner.begin(), corner.end());
    }
    std::sort(soup.begin(), soup.end());
    return soup;
}

// Every beginning of the stream and 500 changed bytes: each loads or is refused in one line.
// Returns how many were refused.
inline int expect_damage_is_survived(const Bytes& intact,
                                     const std::function<GltfDraft(const Bytes&)>& draft_of) {
    int refused = 0;
    const auto survive = [&](const Bytes& bytes) {
        const std::string message = refusal(draft_of(bytes), {.lightmaps = true});
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        refused += !message.empty();
        return message;
    };
    EXPECT_EQ(survive(intact), "");
    for (std::size_t length = 1; length < intact.size(); ++length) {
        survive({intact.begin(), intact.begin() + static_cast<long>(length)});
    }
    std::mt19937 random(7);
    for (int i = 0; i < 500; ++i) {
        Bytes damaged = intact;
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
        survive(damaged);
    }
    return refused;
}

}  // namespace clgi::test
