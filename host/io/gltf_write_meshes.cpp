// Geometry of a GLB: a node at the centre of the scene, below it a mesh for every part.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>

#include "io/gltf_write.hpp"

namespace clgi::io::gltf {

namespace {

constexpr int array_buffer = 34962;
constexpr int element_array_buffer = 34963;
constexpr int uint32_type = 5125;
constexpr int float_type = 5126;

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

// All vertices and indices of the file, attribute by attribute.
struct Arrays {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::array<float, 2>> uvs[2];
    std::vector<std::array<float, 4>> colors;
    std::vector<std::uint32_t> indices;
};

// Views are added at the end; until then accessors name them by what they will hold.
enum ViewSlot { positions_view, normals_view, uv0_view, uv1_view, colors_view, indices_view };

int add_accessor(GlbDraft& draft, ViewSlot slot, std::size_t offset, std::size_t count,
                 const char* type, int component) {
    return draft.add("accessors", {{"bufferView", static_cast<int>(slot)},
                                   {"byteOffset", offset},
                                   {"count", count},
                                   {"componentType", component},
                                   {"type", type}});
}

// The triangles of one material as a primitive with vertices of its own.
nlohmann::json write_primitive(const Scene& scene, const glm::dvec3& centre,
                               const std::vector<std::size_t>& triangles, Arrays& arrays,
                               GlbDraft& draft) {
    std::vector<std::uint32_t> vertices;
    for (const std::size_t t : triangles) {
        const auto& corner = scene.triangles[t].vertex;
        vertices.insert(vertices.end(), corner, corner + 3);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    const std::size_t first = arrays.positions.size();
    std::array<float, 3> low{};
    std::array<float, 3> high{};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::uint32_t v = vertices[i];
        const glm::vec3 p(scene.positions[v] - centre);
        const glm::vec3 n = glm::normalize(scene.normals[v]);
        arrays.positions.push_back({p.x, p.y, p.z});
        arrays.normals.push_back({n.x, n.y, n.z});
        for (int c = 0; c < 3; ++c) {
            low[c] = i == 0 ? p[c] : std::min(low[c], p[c]);
            high[c] = i == 0 ? p[c] : std::max(high[c], p[c]);
        }
        if (!scene.uvs.empty()) {
            const glm::vec4& uv = scene.uvs[v];
            arrays.uvs[0].push_back({uv.x, uv.y});
            arrays.uvs[1].push_back({uv.z, uv.w});
        }
        if (!scene.colors.empty()) {
            const glm::vec4& color = scene.colors[v];
            arrays.colors.push_back({color.r, color.g, color.b, color.a});
        }
    }
    const std::size_t first_index = arrays.indices.size();
    for (const std::size_t t : triangles) {
        for (const std::uint32_t v : scene.triangles[t].vertex) {
            const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
            arrays.indices.push_back(static_cast<std::uint32_t>(found - vertices.begin()));
        }
    }

    const std::size_t count = vertices.size();
    const auto attribute = [&](ViewSlot slot, const char* type, std::size_t floats) {
        return add_accessor(draft, slot, first * floats * 4, count, type, float_type);
    };
    nlohmann::json attributes;
    attributes["POSITION"] = attribute(positions_view, "VEC3", 3);
    draft.json["accessors"].back()["min"] = low;
    draft.json["accessors"].back()["max"] = high;
    attributes["NORMAL"] = attribute(normals_view, "VEC3", 3);
    if (!scene.uvs.empty()) {
        attributes["TEXCOORD_0"] = attribute(uv0_view, "VEC2", 2);
        attributes["TEXCOORD_1"] = attribute(uv1_view, "VEC2", 2);
    }
    if (!scene.colors.empty()) attributes["COLOR_0"] = attribute(colors_view, "VEC4", 4);
    return {{"attributes", attributes},
            {"material", scene.triangles[triangles[0]].material},
            {"indices", add_accessor(draft, indices_view, first_index * 4, triangles.size() * 3,
                                     "SCALAR", uint32_type)}};
}

// Appends the arrays and points the accessors at them.
void add_views(const Arrays& arrays, GlbDraft& draft) {
    int views[6] = {};
    const auto add = [&](ViewSlot slot, const auto& array, int target) {
        if (array.empty()) return;
        const std::size_t bytes = sizeof(array[0]);
        views[slot] = draft.add_view(array.data(), array.size() * bytes, target,
                                     target == array_buffer ? bytes : 0);
    };
    add(positions_view, arrays.positions, array_buffer);
    add(normals_view, arrays.normals, array_buffer);
    add(uv0_view, arrays.uvs[0], array_buffer);
    add(uv1_view, arrays.uvs[1], array_buffer);
    add(colors_view, arrays.colors, array_buffer);
    add(indices_view, arrays.indices, element_array_buffer);
    for (nlohmann::json& accessor : draft.json["accessors"]) {
        accessor["bufferView"] = views[accessor["bufferView"].get<int>()];
    }
}

}  // namespace

void write_meshes(const Scene& scene, GlbDraft& draft, std::vector<int>& roots) {
    if (scene.triangles.empty()) return;
    const Bounds box = bounds(scene);
    const glm::dvec3 centre = (box.low + box.high) * 0.5;

    Arrays arrays;
    std::vector<int> children;
    for (const Range& range : ranges_of(scene)) {
        std::map<std::uint32_t, std::vector<std::size_t>> by_material;
        for (std::size_t t = range.begin; t < range.end; ++t) {
            by_material[scene.triangles[t].material].push_back(t);
        }
        nlohmann::json primitives = nlohmann::json::array();
        for (const auto& [material, triangles] : by_material) {
            primitives.push_back(write_primitive(scene, centre, triangles, arrays, draft));
        }
        nlohmann::json node = {{"mesh", draft.add("meshes", {{"primitives", primitives}})}};
        if (!range.name.empty()) node["name"] = range.name;
        children.push_back(draft.add("nodes", std::move(node)));
    }
    add_views(arrays, draft);
    roots.push_back(draft.add(
        "nodes", {{"translation", {centre.x, centre.y, centre.z}}, {"children", children}}));
}

}  // namespace clgi::io::gltf
