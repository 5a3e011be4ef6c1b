// Geometry of a GLB: a node at the centre of the scene, below it a mesh for every part.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "io/gltf_write.hpp"

namespace clgi::io::gltf {

namespace {

// More meshes than this make a file that readers choke on; the parts are then given up.
constexpr std::size_t most_parts = 100'000;

struct Range {
    std::string name;
    std::size_t begin;
    std::size_t end;
};

// The parts in the order of their triangles, and what lies between them.
std::vector<Range> ranges_of(const Scene& scene) {
    std::vector<const Part*> parts;
    for (const Part& part : scene.parts) {
        if (part.triangle_count > 0) parts.push_back(&part);
    }
    std::stable_sort(parts.begin(), parts.end(), [](const Part* a, const Part* b) {
        return a->first_triangle < b->first_triangle;
    });
    if (parts.size() > most_parts) parts.clear();

    std::vector<Range> ranges;
    std::size_t done = 0;
    for (const Part* part : parts) {
        const std::size_t begin = std::max<std::size_t>(part->first_triangle, done);
        const std::size_t end = std::size_t{part->first_triangle} + part->triangle_count;
        if (end <= begin) continue;  // inside the part before it
        if (begin > done) ranges.push_back({"", done, begin});
        ranges.push_back({part->name, begin, end});
        done = end;
    }
    if (done < scene.triangles.size()) ranges.push_back({"", done, scene.triangles.size()});
    return ranges;
}

// Each array gets a view of its own: tinygltf writes the offsets of accessors with 32 bits.
template <typename T>
int add_array(GlbDraft& draft, const std::vector<T>& values, int type, int component, int target) {
    const bool vertices = target == TINYGLTF_TARGET_ARRAY_BUFFER;
    tinygltf::Accessor accessor;
    accessor.bufferView =
        draft.add_view(values.data(), values.size() * sizeof(T), target, vertices ? sizeof(T) : 0);
    accessor.count = values.size();
    accessor.type = type;
    accessor.componentType = component;
    return add(draft.model.accessors, std::move(accessor));
}

template <typename T>
int add_vertices(GlbDraft& draft, const std::vector<T>& values) {
    // tinygltf's types: VEC2 is 2, VEC3 is 3, VEC4 is 4.
    return add_array(draft, values, T::length(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                     TINYGLTF_TARGET_ARRAY_BUFFER);
}

// The triangles of one material as a primitive with vertices of its own.
tinygltf::Primitive write_primitive(const Scene& scene, const glm::dvec3& centre,
                                    const std::vector<std::size_t>& triangles, GlbDraft& draft) {
    std::vector<std::uint32_t> vertices;
    for (const std::size_t t : triangles) {
        const auto& corner = scene.triangles[t].vertex;
        vertices.insert(vertices.end(), corner, corner + 3);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    std::vector<std::uint32_t> indices;
    for (const std::size_t t : triangles) {
        for (const std::uint32_t v : scene.triangles[t].vertex) {
            const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
            indices.push_back(static_cast<std::uint32_t>(found - vertices.begin()));
        }
    }
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs[2];
    std::vector<glm::vec4> colors;
    for (const std::uint32_t v : vertices) {
        positions.emplace_back(scene.positions[v] - centre);
        normals.push_back(glm::normalize(scene.normals[v]));
        if (!scene.uvs.empty()) {
            uvs[0].emplace_back(scene.uvs[v].x, scene.uvs[v].y);
            uvs[1].emplace_back(scene.uvs[v].z, scene.uvs[v].w);
        }
        if (!scene.colors.empty()) colors.push_back(scene.colors[v]);
    }
    glm::vec3 low = positions[0];
    glm::vec3 high = positions[0];
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(scene.triangles[triangles[0]].material);
    primitive.attributes["POSITION"] = add_vertices(draft, positions);
    draft.model.accessors.back().minValues = {low.x, low.y, low.z};
    draft.model.accessors.back().maxValues = {high.x, high.y, high.z};
    primitive.attributes["NORMAL"] = add_vertices(draft, normals);
    if (!scene.uvs.empty()) {
        primitive.attributes["TEXCOORD_0"] = add_vertices(draft, uvs[0]);
        primitive.attributes["TEXCOORD_1"] = add_vertices(draft, uvs[1]);
    }
    if (!scene.colors.empty()) primitive.attributes["COLOR_0"] = add_vertices(draft, colors);
    primitive.indices =
        add_array(draft, indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                  TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return primitive;
}

}  // namespace

void write_meshes(const Scene& scene, GlbDraft& draft) {
    if (scene.triangles.empty()) return;
    const Bounds box = bounds(scene);
    const glm::dvec3 centre = (box.low + box.high) * 0.5;

    tinygltf::Node root;
    root.translation = {centre.x, centre.y, centre.z};
    for (const Range& range : ranges_of(scene)) {
        std::map<std::uint32_t, std::vector<std::size_t>> by_material;
        for (std::size_t t = range.begin; t < range.end; ++t) {
            by_material[scene.triangles[t].material].push_back(t);
        }
        tinygltf::Mesh mesh;
        for (const auto& [material, triangles] : by_material) {
            mesh.primitives.push_back(write_primitive(scene, centre, triangles, draft));
        }
        tinygltf::Node node;
        node.name = utf8(range.name);
        node.mesh = add(draft.model.meshes, std::move(mesh));
        root.children.push_back(add(draft.model.nodes, std::move(node)));
    }
    draft.roots.push_back(add(draft.model.nodes, std::move(root)));
}

}  // namespace clgi::io::gltf
