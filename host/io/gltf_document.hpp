// A glTF document: what its file says, and the steps from there to a Scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/gltf.hpp>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "io/gltf_codecs.hpp"
#include "io/gltf_image.hpp"
#include "io/gltf_text.hpp"
#include "io/gltf_tiny.hpp"

namespace clgi::io::gltf {

using tinygltf::Accessor;
using tinygltf::Mesh;
using tinygltf::Model;
using tinygltf::Node;
using tinygltf::Primitive;
using Attributes = std::map<std::string, int>;  // accessors by name

// Still encoded. Its bytes are in a buffer view, a data uri or a file.
struct Image {
    std::string name;
    std::string uri;
    int view = -1;
    std::vector<std::string> types;  // that a data uri says of itself
};

struct Document {
    std::filesystem::path folder;
    std::vector<std::vector<std::uint8_t>> files;  // what the buffers point into
    std::vector<Bytes> buffers;  // without bytes where only compressed views have them
    UnpackBudget unpacking;
    std::vector<Image> images;
    Model model;                       // everything else
    bool quantized = false;            // KHR_mesh_quantization is declared
    std::vector<int> parents;          // of the nodes, -1: none
    std::vector<int> order;            // all nodes, parents before children
    std::vector<glm::dmat4> matrices;  // of the nodes, to the world
    std::vector<Light> lights;         // at the origin, as are the cameras
    std::vector<Camera> cameras;
    std::vector<int> light_nodes;   // of the lights that the scene has
    std::vector<int> camera_nodes;  // of its cameras
    Warnings warnings;
};

// The accessor of an attribute, -1 where there is none of that name.
inline int attribute(const Attributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

// Null where an object does not carry the extension.
inline const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions,
                                        const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

inline int wrap_code(Wrap wrap) {
    if (wrap == Wrap::mirrored_repeat) return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    return wrap == Wrap::clamp_to_edge ? TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE
                                       : TINYGLTF_TEXTURE_WRAP_REPEAT;
}

// An index that an extension gives, -1 where it gives none.
inline int index_in(const tinygltf::Value& value, const char* key) {
    return value.Has(key) ? value.Get(key).GetNumberAsInt() : -1;
}

// The first `limit` bytes of a regular file, fewer when it is shorter.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path,
                                    std::uint64_t limit = UINT64_MAX);

// The parts of a .glb, or bare JSON.
struct Container {
    Bytes json;
    std::optional<Bytes> binary;  // the BIN chunk
};
Container open_container(Bytes file);

// An object that nests no deeper than glTF can need.
nlohmann::json parse_json(Bytes text);

// The steps of load_gltf in their order. Each throws InputError for what it finds wrong.

// That every member of the JSON that will be read is of its kind and every index in its range, or
// "nodes[3].mesh is 99, there are 24 meshes". Whole numbers that are written like 3.0, which glTF
// allows, become integers. Members that are not read are removed: in tinygltf's model they would be
// a hundred times the size of their text.
void guard(nlohmann::json& root);

// Replaces the buffers and images of the JSON by those of the document. Their uris name data, or
// files in the folder of the scene.
void take_sources(nlohmann::json& root, std::optional<Bytes> binary, Document& document);

// Unpacks a view of EXT_meshopt_compression, whose compressed bytes lie in their buffer, and lets
// it show them. Built with CLGI_MESHOPT alone.
void unpack_view(nlohmann::json& view, Document& document);

// Gives the primitives of KHR_draco_mesh_compression accessors of their unpacked vertices and
// triangles, of the latter `most` in all. Built with CLGI_DRACO alone.
void unpack_meshes(Document& document, std::size_t most);

// That weights, joints, morph targets and keys of animations match in number and shape, and that
// nothing is missing that only a foreign extension gives.
void check_links(const Model& model);

// That no accessor, or its sparse part, reads outside its view, and that replaced elements are in
// order. After this no read by an AccessorReader leaves its buffer.
void check_accessors(const Document& document);

// What the buffers hold, whether a node places it or not: attributes are of an allowed format and
// of equal length, indices name vertices, numbers are finite except where they are sanitised, in
// the attributes other than POSITION, or left out with what they belong to, in keys of animations.
void check_meshes(const Document& document);

// Fills lights and cameras, one for one, whether a node carries them or not.
void read_lights(Document& document);

// Fills parents, order and matrices. The nodes are a forest; no transform overflows.
void place_nodes(Document& document);

// Fills scene.materials, one for one, and scene.textures. Only images that a base color, an
// emission, a metallic-roughness or a normal texture needs are decoded; of the others only the
// start is looked at.
void load_materials(Document& document, const GltfOptions& options, Scene& scene);

// The nodes of a scene, parents first. scene -1: the default scene, else the first, else, in a
// file without scenes, every node.
std::vector<int> scene_nodes(Document& document, int scene);

// The copies of a node's mesh that EXT_mesh_gpu_instancing places, else one: the accessors of their
// transforms, their number, and their matrices to the node.
Attributes copies_of(const Node& node);
std::size_t copy_count(const Document& document, const Node& node);
std::vector<glm::dmat4> copy_transforms(const Document& document, const Node& node);

// What a node's matrix to its parent is made of.
AnimatedNode transform_of(const Node& node, Warnings& warnings);

class AnimationReader;
void place_meshes(Document& document, const std::vector<int>& nodes, const GltfOptions& options,
                  AnimationReader& animation, Scene& scene);

// Fills scene.lights and scene.cameras, and the nodes that carry them.
void place_lights(Document& document, const std::vector<int>& nodes, Scene& scene);

// The bytes of an image or the first of them, at least `limit`. `held` holds what has to be read.
Bytes image_bytes(const Document& document, const Image& image, std::size_t limit,
                  std::vector<std::uint8_t>& held);

}  // namespace clgi::io::gltf
