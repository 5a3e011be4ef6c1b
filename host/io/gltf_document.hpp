// A glTF document in types: what the JSON says, every member checked for its kind and every index
// for its range, nothing yet read from the buffers.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_container.hpp"
#include "io/gltf_json.hpp"
#include "io/gltf_warnings.hpp"

namespace clgi::io::gltf {

struct Buffer {
    std::size_t length = 0;
    std::optional<std::string> uri;
    bool fallback = false;  // a placeholder for data that only EXT_meshopt_compression gives
    Bytes data;             // empty until load_buffers
};

struct BufferView {
    int buffer = 0;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::size_t stride = 0;  // 0: tightly packed
};

enum class Component { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

std::size_t byte_size(Component component);

struct Sparse {
    std::size_t count = 0;
    int index_view = 0;
    std::size_t index_offset = 0;
    Component index_type = Component::uint32;
    int value_view = 0;
    std::size_t value_offset = 0;
};

struct Accessor {
    int view = -1;  // -1: zeros
    std::size_t offset = 0;
    std::size_t count = 0;
    Component component = Component::float32;
    int rows = 1;
    int columns = 1;  // above 1: a matrix
    bool normalized = false;
    std::optional<Sparse> sparse;

    std::size_t column_bytes() const;  // of a matrix: a multiple of 4
    std::size_t element_bytes() const;
};

struct Picture {  // an entry of "images"
    std::string name;
    std::string mime;
    int view = -1;
    std::string uri;
};

struct Sampler {
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    bool nearest = false;
};

struct TextureSource {  // an entry of "textures"
    int picture = -1;   // -1: only an extension would give one
    int sampler = -1;
};

// The material with its slots naming entries of "textures".
struct MaterialSource {
    Material material;
    int metal_rough_texture = -1;
};

struct Attribute {
    std::string name;
    int accessor = -1;
};

struct Attributes {
    std::vector<Attribute> all;  // those below and those that are not read
    int position = -1;
    int normal = -1;
    int uv[2] = {-1, -1};
    int color = -1;
    std::vector<int> joints;  // sets of four
    std::vector<int> weights;
};

struct MorphTarget {
    std::vector<Attribute> all;
    int position = -1;
    int normal = -1;
};

enum class Mode { points, lines, line_loop, line_strip, triangles, strip, fan };

struct Primitive {
    Attributes attributes;
    int indices = -1;
    int material = -1;
    Mode mode = Mode::triangles;
    std::vector<MorphTarget> targets;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights;  // one a morph target, or none
};

struct Instancing {  // EXT_mesh_gpu_instancing
    int translation = -1;
    int rotation = -1;
    int scale = -1;
};

struct Node {
    std::string name;
    glm::dmat4 matrix = glm::dmat4(1.0);  // to the parent; to the world after place_nodes
    std::vector<int> children;
    int parent = -1;
    int mesh = -1;
    int skin = -1;
    int camera = -1;
    int light = -1;
    int instancing = -1;  // index into Document::instancing
    std::vector<double> weights;
};

struct Skin {
    std::vector<int> joints;
    int inverse_bind = -1;
};

struct SceneRoots {
    std::string name;
    std::vector<int> nodes;
};

struct Document {
    std::vector<Buffer> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<Picture> pictures;
    std::vector<Sampler> samplers;
    std::vector<TextureSource> textures;
    std::vector<MaterialSource> materials;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<Camera> cameras;  // at the origin
    std::vector<Light> lights;    // at the origin
    std::vector<SceneRoots> scenes;
    std::vector<Instancing> instancing;
    int default_scene = -1;
    bool quantized = false;  // KHR_mesh_quantization is declared

    Warnings warnings;
    std::vector<std::vector<std::uint8_t>> storage;  // what Buffer::data may point into
};

Document read_document(const Value& root);

// The parts of read_document, one file each.
void read_asset(const Value& root, Document& document);   // version, extensions
void read_data(const Value& root, Document& document);    // buffers, views, accessors
void read_images(const Value& root, Document& document);  // images, samplers, textures
void read_materials(const Value& root, Document& document);
void read_meshes(const Value& root, Document& document);
void read_nodes(const Value& root, Document& document);   // nodes, skins, scenes
void read_lights(const Value& root, Document& document);  // and cameras
void check_animations(const Value& root, const Document& document);

}  // namespace clgi::io::gltf
