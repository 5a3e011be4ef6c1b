// glTF 2.0 and GLB to and from a Scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

namespace clgi::io {

struct GltfOptions {
    int scene = -1;          // index of the scene; -1: the file's default, else its first
    bool lightmaps = false;  // keeps texture coordinates without a texture
    bool animation = true;   // fills Scene::animation if the file has any that moves something
    std::size_t max_triangles = std::size_t{1} << 26;  // of all instances; more is an InputError
    std::size_t max_texels = std::size_t{1} << 28;     // of all textures together
};

// Reads a .gltf or .glb file (recognised by content) and flattens it: nodes, skins and morph
// targets in their rest pose, strips and fans, every instance of a mesh in world space. What moves
// by the file's animations is in Scene::animation besides.
// The file is not trusted: every index, offset, count and number is checked before use.
//
// Throws InputError with one line "file: what is wrong and where" for a file that is invalid or
// that requires an unsupported extension. Unusual but usable content becomes a line in
// Scene::warnings.
CLGI_API Scene load_gltf(const std::filesystem::path& path, const GltfOptions& options = {});

// Numbers of vertices that glTF has no meaning for.
struct VertexAttribute {
    std::string name;               // begins with an underscore, as glTF asks
    std::vector<glm::vec4> values;  // one a vertex of the scene, finite
    bool double_sided = false;      // of double-sided surfaces alone
};

// What save_glb writes beside the scene.
struct GlbExtras {
    std::vector<VertexAttribute> attributes;   // VEC4 of floats
    std::map<std::string, std::string> notes;  // into asset.extras
};

// Writes a self-contained .glb: geometry, materials, textures (as PNG), lights, cameras and the
// animation. Positions are stored as float32: those that stand still relative to a node at the
// scene's centre, those that move in their mesh's own space.
// Not kept: the environment, moving_bounds, channels and clips that move nothing (a clip without
// any other channel holds the rest pose), and the order of what moves among what does not: parts,
// lights and cameras that stand still come first, then the others in the order of their nodes.
// Either the complete file is written or none. Throws InputError when it cannot be written, and for
// triangles that share vertices with a part that moves without belonging to it, or for attributes
// that are not as VertexAttribute says.
CLGI_API void save_glb(const Scene& scene, const std::filesystem::path& path,
                       const GlbExtras& extras = {});

}  // namespace clgi::io
