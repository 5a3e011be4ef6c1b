// A GLB while it is put together: tinygltf's model with one buffer.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <string>
#include <vector>

#include "io/gltf_tiny.hpp"

namespace clgi::io::gltf {

struct GlbDraft {
    tinygltf::Model model;
    std::vector<std::uint8_t> binary;
    std::vector<int> roots;  // nodes of the scene

    // Appends the bytes as a buffer view, aligned to 4. stride 0: none.
    int add_view(const void* data, std::size_t bytes, int target = 0, std::size_t stride = 0);

    void declare_extension(const char* name);
};

// Appends to a list of the model; returns the index of the new entry.
template <typename T>
int add(std::vector<T>& list, T entry) {
    list.push_back(std::move(entry));
    return static_cast<int>(list.size()) - 1;
}

// Names may come from anywhere; what is not UTF-8 in them is replaced.
std::string utf8(const std::string& name);

// The parts of a scene.
void write_materials(const Scene& scene, GlbDraft& draft);
void write_meshes(const Scene& scene, GlbDraft& draft);
void write_lights(const Scene& scene, GlbDraft& draft);
void write_cameras(const Scene& scene, GlbDraft& draft);

}  // namespace clgi::io::gltf
