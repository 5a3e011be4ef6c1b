// save_glb: triangles as meshes.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>

#include "io/gltf_writer.hpp"

namespace clgi::io::gltf {

namespace {

// More meshes than this make a file that readers choke on; the parts are then given up.
constexpr std::size_t most_parts = 100'000;

}  // namespace

PrimitiveWriter::PrimitiveWriter(const Scene& scene, const std::vector<VertexAttribute>& further,
                                 GlbModel& out)
    : scene_(scene), further_(further), out_(out) {
    std::set<std::string> names;
    for (const VertexAttribute& one : further_) {
        require(one.name.size() > 1 && one.name[0] == '_', "attribute '", one.name,
                "' does not begin with an underscore");
        require(names.insert(one.name).second, "two attributes are named ", one.name);
        require(one.values.size() == scene_.positions.size(), "attribute ", one.name, " has ",
                one.values.size(), " values, the scene has ", scene_.positions.size(), " vertices");
        for (const glm::vec4& value : one.values)
            for (int c = 0; c < 4; ++c)
                require(std::isfinite(value[c]), "attribute ", one.name,
                        " has a value that is not finite");
    }
}

Mesh PrimitiveWriter::mesh_of(const std::vector<std::uint32_t>& triangles,
                              const AddAttributes& attributes) {
    std::map<std::uint32_t, std::vector<Corners>> by_material;
    for (const std::uint32_t t : triangles) {
        const auto& [vertex, material] = scene_.triangles[t];
        by_material[material].push_back({vertex[0], vertex[1], vertex[2]});
    }
    Mesh mesh;
    for (auto& [material, corners] : by_material) {
        const std::vector<std::uint32_t> used = renumberer_.renumber(corners);
        Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = static_cast<int>(material);
        attributes(used, primitive);
        if (!scene_.uvs.empty()) {
            std::vector<glm::vec2> first, second;
            for (const std::uint32_t v : used) {
                const glm::vec4& uv = scene_.uvs[v];
                first.emplace_back(uv);
                second.emplace_back(uv.z, uv.w);
            }
            primitive.attributes["TEXCOORD_0"] = out_.add_vertices(first);
            primitive.attributes["TEXCOORD_1"] = out_.add_vertices(second);
        }
        if (!scene_.colors.empty()) {
            std::vector<glm::vec4> colors;
            for (const std::uint32_t v : used) colors.push_back(scene_.colors[v]);
            primitive.attributes["COLOR_0"] = out_.add_vertices(colors);
        }
        for (const VertexAttribute& one : further_) {
            if (one.double_sided && !scene_.materials[material].double_sided) continue;
            std::vector<glm::vec4> values;
            for (const std::uint32_t v : used) values.push_back(one.values[v]);
            primitive.attributes[one.name] = out_.add_vertices(values);
        }
        std::vector<std::uint32_t> indices;
        for (const Corners& corner : corners)
            indices.insert(indices.end(), corner.begin(), corner.end());
        primitive.indices = out_.add_array(indices, indices.size(), TINYGLTF_TYPE_SCALAR,
                                           TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                           TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        mesh.primitives.push_back(std::move(primitive));
    }
    return mesh;
}

// A node at the centre of the scene; below it the parts in the order of their triangles, and what
// is between them. Readers take nodes by their distance from the root; beside parts that move,
// each is a root of its own, so that it comes first.
void add_static_meshes(const Scene& scene, const std::vector<bool>& moved, PrimitiveWriter& meshes,
                       GlbModel& out) {
    if (std::find(moved.begin(), moved.end(), false) == moved.end()) return;
    const Bounds box = bounds(scene);
    const glm::dvec3 centre = (box.low + box.high) * 0.5;
    const auto attributes = [&](const std::vector<std::uint32_t>& used, Primitive& primitive) {
        std::vector<glm::vec3> positions, normals;
        for (const std::uint32_t v : used) {
            positions.emplace_back(scene.positions[v] - centre);
            normals.push_back(glm::normalize(scene.normals[v]));
        }
        primitive.attributes["POSITION"] = out.add_bounded(positions);
        primitive.attributes["NORMAL"] = out.add_vertices(normals);
    };
    Node root;
    root.translation = numbers(centre);
    const auto add_range = [&](const std::string& name, std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> triangles;
        for (std::size_t t = begin; t < end; ++t)
            if (!moved[t]) triangles.push_back(static_cast<std::uint32_t>(t));
        if (triangles.empty()) return;
        Node node;
        node.name = utf8(name);
        node.mesh = add(out.model.meshes, meshes.mesh_of(triangles, attributes));
        if (scene.animation) {
            node.translation = root.translation;
            out.add_root(std::move(node));
        } else {
            root.children.push_back(add(out.model.nodes, std::move(node)));
        }
    };

    std::vector<Part> parts = scene.parts;
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.first_triangle < b.first_triangle;
    });
    if (parts.size() > most_parts) parts.clear();
    std::size_t done = 0;
    for (const Part& part : parts) {
        const std::size_t begin = std::max<std::size_t>(part.first_triangle, done);
        const std::size_t end = std::size_t{part.first_triangle} + part.triangle_count;
        if (end <= begin) continue;  // inside the part before it
        add_range("", done, begin);
        add_range(part.name, begin, end);
        done = end;
    }
    add_range("", done, scene.triangles.size());
    if (!scene.animation) out.add_root(std::move(root));
}

}  // namespace clgi::io::gltf
