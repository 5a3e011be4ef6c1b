// Meshes: every placed copy becomes triangles in world space.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <map>

#include "gltf_accessor.hpp"
#include "gltf_instances.hpp"
#include "gltf_place.hpp"
#include "gltf_pose.hpp"
#include "gltf_topology.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double farthest = 1e18;  // metres; the square of a distance is still a float

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 1e-300 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

// Reads uv or color, which are mended where they are not numbers.
float finite_or(double value, double fallback, bool& mended) {
    if (std::isfinite(value)) return static_cast<float>(value);
    mended = true;
    return static_cast<float>(fallback);
}

class MeshPlacer {
public:
    MeshPlacer(Document& document, Scene& scene) : document_(document), scene_(scene), poser_(document) {
        for (const Material& material : scene.materials) {
            textured_ = textured_ || material.base_texture.texture >= 0 ||
                        material.emission_texture.texture >= 0;
        }
    }

    // Refuses a scene of too many triangles before the first is made.
    void count(const std::vector<int>& nodes, std::size_t most) {
        std::size_t total = 0;
        std::vector<std::size_t> in_mesh(document_.meshes.size(), unknown);
        for (const int index : nodes) {
            const Node& node = document_.nodes[index];
            if (node.mesh < 0) continue;
            if (in_mesh[node.mesh] == unknown) in_mesh[node.mesh] = count_mesh(node.mesh);
            const std::size_t triangles = in_mesh[node.mesh];
            if (triangles == 0) continue;
            const std::size_t copies = instance_count(document_, node);
            if (copies > most / triangles || total > most - copies * triangles) {
                throw InputError("places more than the " + std::to_string(most) +
                                 " triangles that are allowed");
            }
            total += copies * triangles;
            if (!(document_.nodes[index].instancing < 0) && node.skin >= 0) {
                document_.warnings.add("copies of a skinned mesh all stand in the same place");
            }
        }
    }

    void place(const Node& node) {
        const Mesh& mesh = document_.meshes[node.mesh];
        for (const std::size_t p : drawn_[node.mesh]) {
            const Primitive& primitive = mesh.primitives[p];
            const auto [found, fresh] = topologies_.try_emplace({node.mesh, p});
            if (fresh) found->second = triangles_of(document_, primitive);
            const Topology& topology = found->second;
            if (topology.triangles.empty()) continue;

            const std::size_t copies = instance_count(document_, node);
            for (std::size_t copy = 0; copy < copies; ++copy) {
                place(node, primitive, topology, instance_matrix(document_, node, copy));
            }
        }
    }

private:
    static constexpr std::size_t unknown = SIZE_MAX;

    // Also notes which primitives have triangles: a mesh may have a million that have none.
    std::size_t count_mesh(int index) {
        const Mesh& mesh = document_.meshes[index];
        std::size_t total = 0;
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const Primitive& primitive = mesh.primitives[p];
            if (primitive.attributes.position < 0) {
                document_.warnings.add("a primitive without positions is skipped");
            } else if (primitive.mode < Mode::triangles) {
                document_.warnings.add("a primitive of points or lines is skipped");
            }
            const std::size_t triangles = triangle_count(document_, primitive);
            if (triangles == 0) continue;
            total += std::min(triangles, SIZE_MAX - total);
            drawn_[index].push_back(p);
            colored_ = colored_ || primitive.attributes.color >= 0;
        }
        return total;
    }

    void place(const Node& node, const Primitive& primitive, const Topology& topology,
               const glm::dmat4& matrix) {
        Pose pose = poser_.pose(primitive, node, matrix, topology.vertices);
        for (const glm::dvec3& p : pose.positions) {
            if (!(glm::length(p) <= farthest)) {
                throw InputError("meshes[" + std::to_string(node.mesh) +
                                 "] is placed at a distance beyond 1e18 m");
            }
        }
        Part part;
        part.name = node.name.empty() ? document_.meshes[node.mesh].name : node.name;
        part.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
        part.triangle_count = static_cast<std::uint32_t>(topology.triangles.size());

        const bool flat = pose.normals.empty();
        if (!flat) mend_normals(topology, pose);
        const std::size_t corners = topology.triangles.size() * 3;
        const std::size_t fresh = flat ? corners : topology.vertices.size();
        if (fresh > UINT32_MAX - scene_.positions.size()) throw InputError("has 2^32 vertices");

        const auto first = static_cast<std::uint32_t>(scene_.positions.size());
        const std::uint32_t material = material_of(primitive);
        for (const auto& corner : topology.triangles) {
            // A mirror turns the sense of the corners; the second and third change places.
            const bool turn = pose.mirrored[corner[0]] != 0;
            const std::uint32_t ordered[3] = {corner[0], corner[turn ? 2 : 1],
                                              corner[turn ? 1 : 2]};
            SceneTriangle triangle{{}, material};
            for (int i = 0; i < 3; ++i) triangle.vertex[i] = first + ordered[i];
            if (flat) add_flat(topology, pose, ordered, triangle);
            scene_.triangles.push_back(triangle);
        }
        if (flat) {
            add_looks(primitive, topology, flat_order_);
            flat_order_.clear();
        } else {
            for (std::size_t i = 0; i < topology.vertices.size(); ++i) {
                scene_.positions.push_back(pose.positions[i]);
                scene_.normals.emplace_back(pose.normals[i]);
            }
            add_looks(primitive, topology, {});
        }
        scene_.parts.push_back(std::move(part));
    }

    // Three vertices of its own for a triangle of a mesh without normals.
    void add_flat(const Topology&, const Pose& pose, const std::uint32_t (&ordered)[3],
                  SceneTriangle& triangle) {
        const glm::dvec3 a = pose.positions[ordered[0]];
        glm::dvec3 normal = unit_or_zero(
            glm::cross(pose.positions[ordered[1]] - a, pose.positions[ordered[2]] - a));
        if (normal == glm::dvec3(0.0)) normal.y = 1.0;  // of no area, never seen
        for (int i = 0; i < 3; ++i) {
            triangle.vertex[i] = static_cast<std::uint32_t>(scene_.positions.size());
            scene_.positions.push_back(pose.positions[ordered[i]]);
            scene_.normals.emplace_back(normal);
            flat_order_.push_back(ordered[i]);
        }
    }

    // Replaces normals without a direction by the mean of the triangles around the vertex.
    void mend_normals(const Topology& topology, Pose& pose) {
        std::map<std::uint32_t, glm::dvec3> sums;
        for (std::uint32_t i = 0; i < pose.normals.size(); ++i) {
            if (pose.normals[i] == glm::dvec3(0.0)) sums.emplace(i, 0.0);
        }
        if (sums.empty()) return;
        document_.warnings.add("vertex normals without a direction are computed anew");
        for (const auto& corner : topology.triangles) {
            const glm::dvec3 a = pose.positions[corner[0]];
            glm::dvec3 normal = unit_or_zero(
                glm::cross(pose.positions[corner[1]] - a, pose.positions[corner[2]] - a));
            if (pose.mirrored[corner[0]]) normal = -normal;
            for (const std::uint32_t vertex : corner) {
                const auto found = sums.find(vertex);
                if (found != sums.end()) found->second += normal;
            }
        }
        for (const auto& [vertex, sum] : sums) {
            const glm::dvec3 normal = unit_or_zero(sum);
            pose.normals[vertex] = normal == glm::dvec3(0.0) ? glm::dvec3(0, 1, 0) : normal;
        }
    }

    // uv and color of the vertices just added; order: positions in topology.vertices, empty: all.
    void add_looks(const Primitive& primitive, const Topology& topology,
                   const std::vector<std::uint32_t>& order) {
        const Attributes& attributes = primitive.attributes;
        std::vector<AccessorReader> sets;
        int column[2] = {-1, -1};
        for (int set = 0; set < 2; ++set) {
            if (!textured_ || attributes.uv[set] < 0) continue;
            column[set] = static_cast<int>(sets.size());
            sets.emplace_back(document_, attributes.uv[set]);
        }
        std::vector<AccessorReader> colors;
        if (attributes.color >= 0) colors.emplace_back(document_, attributes.color);
        warn_of_missing_uv(primitive);

        bool mended = false;
        const std::size_t count = order.empty() ? topology.vertices.size() : order.size();
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t vertex = topology.vertices[order.empty() ? i : order[i]];
            glm::vec4 uv(0.0f);
            for (int set = 0; set < 2; ++set) {
                if (column[set] < 0) continue;
                const glm::dvec2 read = sets[column[set]].vec2(vertex);
                uv[2 * set] = finite_or(read.x, 0.0, mended);
                uv[2 * set + 1] = finite_or(read.y, 0.0, mended);
            }
            if (textured_) scene_.uvs.push_back(uv);
            if (!colored_) continue;
            glm::vec4 color(1.0f);
            for (std::size_t c = 0; !colors.empty() && c < colors[0].width(); ++c) {
                const float read = finite_or(colors[0].number(vertex, c), 1.0, mended);
                color[static_cast<int>(c)] = std::min(std::max(read, 0.0f), 1.0f);
            }
            scene_.colors.push_back(color);
        }
        if (mended) document_.warnings.add("texture coordinates or colors that are not finite");
    }

    void warn_of_missing_uv(const Primitive& primitive) {
        if (primitive.material < 0) return;
        const Material& material = scene_.materials[primitive.material];
        for (const TextureSlot& slot : {material.base_texture, material.emission_texture}) {
            if (slot.texture >= 0 && primitive.attributes.uv[slot.uv_set] < 0) {
                document_.warnings.add("a textured primitive has no texture coordinates");
            }
        }
    }

    std::uint32_t material_of(const Primitive& primitive) {
        if (primitive.material >= 0) return static_cast<std::uint32_t>(primitive.material);
        if (!default_material_) {
            Material material;
            material.metallic = 1.0f;  // glTF's default is a rough metal
            default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
            scene_.materials.push_back(material);
        }
        return *default_material_;
    }

    Document& document_;
    Scene& scene_;
    Poser poser_;
    bool textured_ = false;
    bool colored_ = false;
    std::optional<std::uint32_t> default_material_;
    std::map<int, std::vector<std::size_t>> drawn_;  // mesh: its primitives with triangles
    std::map<std::pair<int, std::size_t>, Topology> topologies_;
    std::vector<std::uint32_t> flat_order_;
};

}  // namespace

void place_meshes(Document& document, const std::vector<int>& nodes, const GltfOptions& options,
                  Scene& scene) {
    check_instancing(document);
    MeshPlacer placer(document, scene);
    placer.count(nodes, std::min<std::size_t>(options.max_triangles, UINT32_MAX / 3));
    for (const int node : nodes) {
        if (document.nodes[node].mesh >= 0) placer.place(document.nodes[node]);
    }
}

}  // namespace clgi::io::gltf
