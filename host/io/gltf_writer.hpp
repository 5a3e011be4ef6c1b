// What the parts of save_glb share: the model under construction with its one buffer.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/gltf.hpp>
#include <functional>

#include "io/gltf_primitive.hpp"

namespace clgi::io::gltf {

// Names may come from anywhere; what is not UTF-8 in them is replaced.
std::string utf8(const std::string& name);

// Appends to a list of the model; returns the index of the new entry.
template <typename T>
int add(std::vector<T>& list, T entry) {
    list.push_back(std::move(entry));
    return static_cast<int>(list.size()) - 1;
}

template <typename Vector>
std::vector<double> numbers(const Vector& v) {
    std::vector<double> list;
    for (int i = 0; i < Vector::length(); ++i) list.push_back(v[i]);
    return list;
}

// For emission and lights: a color whose largest channel is 1, and what multiplies it.
std::pair<glm::dvec3, double> color_and_strength(const glm::vec3& light);

struct GlbModel {
    Model model;
    std::vector<std::uint8_t> binary;
    std::vector<int> roots;  // nodes of the scene

    void add_root(Node node) { roots.push_back(add(model.nodes, std::move(node))); }

    // Appends the bytes as a buffer view, aligned to 4. stride 0: none.
    int add_view(const void* data, std::size_t bytes, int target = 0, std::size_t stride = 0);

    // Each array gets a view of its own: tinygltf writes the offsets of accessors with 32 bits.
    template <typename T>
    int add_array(const std::vector<T>& values, std::size_t count, int type, int component,
                  int target = 0, std::size_t stride = 0) {
        Accessor accessor;
        accessor.bufferView = add_view(values.data(), values.size() * sizeof(T), target, stride);
        accessor.count = count;
        accessor.type = type;
        accessor.componentType = component;
        return add(model.accessors, std::move(accessor));
    }

    // Floats, a vector a vertex. tinygltf's types: VEC2 is 2, VEC3 is 3, VEC4 is 4.
    template <typename T>
    int add_vertices(const std::vector<T>& values) {
        return add_array(values, values.size(), T::length(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                         TINYGLTF_TARGET_ARRAY_BUFFER, sizeof(T));
    }

    // With the least and largest numbers, which the format wants for positions.
    int add_bounded(const std::vector<glm::vec3>& values);
};

// Lights and cameras where the scene has them, but for those that a node carries.
class LightWriter {
public:
    LightWriter(const Scene& scene, GlbModel& out);

    void add_static();
    // What the node carries: nodes have room for one light and one camera.
    void put_light(const Light& light, Node& node);
    void put_camera(const Camera& camera, Node& node);

private:
    const Scene& scene_;
    GlbModel& out_;
    double size_;  // of the scene
};

// The triangles of a scene as primitives.
class PrimitiveWriter {
public:
    // Throws InputError for attributes that are not as VertexAttribute says.
    PrimitiveWriter(const Scene& scene, const std::vector<VertexAttribute>& further, GlbModel& out);

    // A mesh of triangles: a primitive with vertices of its own for each material. `attributes`
    // adds positions, normals and whatever else the given vertices have.
    using AddAttributes =
        std::function<void(const std::vector<std::uint32_t>& vertices, Primitive& primitive)>;
    Mesh mesh_of(const std::vector<std::uint32_t>& triangles, const AddAttributes& attributes);

private:
    const Scene& scene_;
    const std::vector<VertexAttribute>& further_;
    GlbModel& out_;
    Renumberer renumberer_;
};

// Triangles that no range of the animation moves, below one node at their centre.
void add_static_meshes(const Scene& scene, const std::vector<bool>& moved, PrimitiveWriter& meshes,
                       GlbModel& out);

// Triangles whose vertices a range of the animation moves. Throws InputError for one that names
// vertices both of a range and of none, or of a range to whose part it does not belong.
std::vector<bool> moved_triangles(const Scene& scene);

// The nodes of an animation with all that they show and carry, its skins and clips.
void add_animation(const Scene& scene, PrimitiveWriter& meshes, LightWriter& lights, GlbModel& out);

}  // namespace clgi::io::gltf
