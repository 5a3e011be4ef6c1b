// A GLB while it is put together: the JSON tree and the binary chunk that it describes.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace clgi::io::gltf {

struct GlbDraft {
    nlohmann::json json = nlohmann::json::object();
    std::vector<std::uint8_t> binary;

    // Appends to an array of the document; returns the index of the new entry.
    int add(const char* array, nlohmann::json entry);

    // Appends the bytes as a buffer view, aligned to 4. stride 0: none.
    int add_view(const void* data, std::size_t bytes, int target = 0, std::size_t stride = 0);

    void declare_extension(const char* name);
};

// The parts of a scene. Nodes that they add to the document are appended to roots.
void write_materials(const Scene& scene, GlbDraft& draft);
void write_meshes(const Scene& scene, GlbDraft& draft, std::vector<int>& roots);
void write_lights(const Scene& scene, GlbDraft& draft, std::vector<int>& roots);
void write_cameras(const Scene& scene, GlbDraft& draft, std::vector<int>& roots);

}  // namespace clgi::io::gltf
