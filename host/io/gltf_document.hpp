// A glTF document: tinygltf's model and what is derived from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "io/gltf_tiny.hpp"
#include "io/gltf_warnings.hpp"

namespace clgi::io::gltf {

using tinygltf::Accessor;
using tinygltf::BufferView;
using tinygltf::Mesh;
using tinygltf::Model;
using tinygltf::Node;
using tinygltf::Primitive;
using tinygltf::Skin;

// What a data uri says of its type and what "mimeType" says beside it.
struct MediaTypes {
    std::string header;
    std::string member;
};

struct Document {
    Model model;
    std::vector<MediaTypes> image_types;  // one an image; empty: not a data uri
    bool quantized = false;               // KHR_mesh_quantization is declared
    std::vector<int> parents;             // of the nodes, -1: none
    std::vector<glm::dmat4> matrices;     // of the nodes, to the world
    std::vector<Light> lights;            // at the origin, as are the cameras
    std::vector<Camera> cameras;
    Warnings warnings;
};

// The accessor of an attribute, -1 where there is none of that name.
inline int attribute(const std::map<std::string, int>& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

// Null where an object does not carry the extension.
inline const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions,
                                        const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

// An index that an extension gives, -1 where it gives none.
inline int index_in(const tinygltf::Value& value, const char* key) {
    return value.Has(key) ? value.Get(key).GetNumberAsInt() : -1;
}

}  // namespace clgi::io::gltf
