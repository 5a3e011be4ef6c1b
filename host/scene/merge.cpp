// SPDX-License-Identifier: MIT
#include "scene/merge.hpp"

#include <cstring>
#include <string>
#include <unordered_map>

namespace clgi {
namespace {

template <typename T>
void append_bytes(std::string& key, const std::vector<T>& values, std::size_t at) {
    if (values.empty()) return;
    char bytes[sizeof(T)];
    std::memcpy(bytes, &values[at], sizeof(T));
    key.append(bytes, sizeof(T));
}

template <typename T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
    if (values.empty()) return;
    std::vector<T> out;
    out.reserve(kept.size());
    for (const std::uint32_t v : kept) out.push_back(values[v]);
    values = std::move(out);
}

}  // namespace

void merge_equal_vertices(Scene& scene) {
    std::unordered_map<std::string, std::uint32_t> number;
    std::vector<std::uint32_t> kept;
    for (SceneTriangle& triangle : scene.triangles)
        for (std::uint32_t& v : triangle.vertex) {
            std::string key;
            append_bytes(key, scene.positions, v);
            append_bytes(key, scene.normals, v);
            append_bytes(key, scene.uvs, v);
            append_bytes(key, scene.colors, v);
            const auto [found, is_new] =
                number.try_emplace(std::move(key), static_cast<std::uint32_t>(kept.size()));
            if (is_new) kept.push_back(v);
            v = found->second;
        }
    keep(scene.positions, kept);
    keep(scene.normals, kept);
    keep(scene.uvs, kept);
    keep(scene.colors, kept);
}

}  // namespace clgi
