// Meshes: every placed copy becomes triangles in world space.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "io/gltf_instances.hpp"
#include "io/gltf_looks.hpp"
#include "io/gltf_normals.hpp"
#include "io/gltf_place.hpp"
#include "io/gltf_pose.hpp"
#include "io/gltf_text.hpp"
#include "io/gltf_topology.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double farthest = 1e18;  // metres; the square of a distance is still a float

class MeshPlacer {
public:
    MeshPlacer(Document& document, bool lightmaps, Scene& scene)
        : document_(document), scene_(scene), poser_(document), textured_(lightmaps) {
        for (const Material& material : scene.materials) {
            textured_ = textured_ || material.base_texture.texture >= 0 ||
                        material.emission_texture.texture >= 0;
        }
    }

    // Refuses a scene of too many triangles before the first is made.
    void count(const std::vector<int>& nodes, std::size_t most) {
        std::map<int, std::size_t> in_mesh;
        std::size_t total = 0;
        for (const int index : nodes) {
            const Node& node = document_.model.nodes[index];
            if (node.mesh < 0) continue;
            const auto [counted, fresh] = in_mesh.try_emplace(node.mesh, 0);
            if (fresh) counted->second = count_mesh(node.mesh);
            const std::size_t triangles = counted->second;
            if (triangles == 0) continue;
            const std::size_t copies = instance_count(document_, node);
            if (copies > most / triangles || total > most - copies * triangles) {
                throw InputError("places more than the " + std::to_string(most) +
                                 " triangles that are allowed");
            }
            total += copies * triangles;
            if (is_instanced(node) && node.skin >= 0) {
                document_.warnings.add("copies of a skinned mesh all stand in the same place");
            }
        }
    }

    void place(int index) {
        const Node& node = document_.model.nodes[index];
        const Mesh& mesh = document_.model.meshes[node.mesh];
        const std::size_t copies = instance_count(document_, node);
        for (const std::size_t p : drawn_[node.mesh]) {
            const Primitive& primitive = mesh.primitives[p];
            const auto [found, fresh] = topologies_.try_emplace({node.mesh, p});
            if (fresh) found->second = triangles_of(document_, primitive);
            if (found->second.triangles.empty()) continue;
            warn_of_missing_uv(primitive);
            for (std::size_t copy = 0; copy < copies; ++copy) {
                place(node, primitive, found->second, instance_matrix(document_, index, copy));
            }
        }
    }

private:
    // Also notes which primitives have triangles: a mesh may have a million that have none.
    std::size_t count_mesh(int index) {
        const Mesh& mesh = document_.model.meshes[index];
        std::size_t total = 0;
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const Primitive& primitive = mesh.primitives[p];
            if (attribute(primitive.attributes, "POSITION") < 0) {
                document_.warnings.add("a primitive without positions is skipped");
            } else if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                document_.warnings.add("a primitive of points or lines is skipped");
            }
            const std::size_t triangles = triangle_count(document_, primitive);
            if (triangles == 0) continue;
            total += std::min(triangles, SIZE_MAX - total);
            drawn_[index].push_back(p);
            colored_ = colored_ || attribute(primitive.attributes, "COLOR_0") >= 0;
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
        if (pose.normals.empty()) {
            Topology split = topology;
            make_flat(split, pose);
            append(node, primitive, split, pose);
            return;
        }
        if (mend_normals(topology, pose)) {
            document_.warnings.add("vertex normals without a direction are computed anew");
        }
        append(node, primitive, topology, pose);
    }

    void append(const Node& node, const Primitive& primitive, const Topology& topology,
                const Pose& pose) {
        if (topology.vertices.size() > UINT32_MAX - scene_.positions.size()) {
            throw InputError("has more than 2^32 vertices");
        }
        const std::string& mesh_name = document_.model.meshes[node.mesh].name;
        scene_.parts.push_back({short_name(node.name.empty() ? mesh_name : node.name),
                                static_cast<std::uint32_t>(scene_.triangles.size()),
                                static_cast<std::uint32_t>(topology.triangles.size())});

        const auto first = static_cast<std::uint32_t>(scene_.positions.size());
        const std::uint32_t material = material_of(primitive);
        for (const auto& [a, b, c] : topology.triangles) {
            // A mirror turns the sense of the corners: the second and third change places.
            const bool turned = pose.mirrored[a] != 0;
            scene_.triangles.push_back(
                {{first + a, first + (turned ? c : b), first + (turned ? b : c)}, material});
        }
        for (std::size_t i = 0; i < topology.vertices.size(); ++i) {
            scene_.positions.push_back(pose.positions[i]);
            scene_.normals.emplace_back(pose.normals[i]);
        }
        if (append_looks(document_, primitive, topology.vertices, textured_, colored_, scene_)) {
            document_.warnings.add("texture coordinates or colors that are not finite are mended");
        }
    }

    void warn_of_missing_uv(const Primitive& primitive) {
        if (primitive.material < 0) return;
        const Material& material = scene_.materials[primitive.material];
        for (const TextureSlot& slot : {material.base_texture, material.emission_texture}) {
            const char* uv = slot.uv_set == 0 ? "TEXCOORD_0" : "TEXCOORD_1";
            if (slot.texture >= 0 && attribute(primitive.attributes, uv) < 0) {
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
    bool textured_;  // or its texture coordinates are wanted all the same
    bool colored_ = false;
    std::optional<std::uint32_t> default_material_;
    std::map<int, std::vector<std::size_t>> drawn_;  // mesh: its primitives with triangles
    std::map<std::pair<int, std::size_t>, Topology> topologies_;
};

}  // namespace

void place_meshes(Document& document, const std::vector<int>& nodes, const GltfOptions& options,
                  Scene& scene) {
    check_instancing(document);
    MeshPlacer placer(document, options.lightmaps, scene);
    placer.count(nodes, std::min<std::size_t>(options.max_triangles, UINT32_MAX / 3));
    for (const int node : nodes) {
        if (document.model.nodes[node].mesh >= 0) placer.place(node);
    }
}

}  // namespace clgi::io::gltf
