// place_meshes: every placed copy of a mesh becomes triangles in world space.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_accessor.hpp"
#include "io/gltf_animation.hpp"
#include "io/gltf_primitive.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double farthest = 1e18;  // metres; the square of a distance is still a float

struct DrawnPrimitive {
    const Primitive* source;
    std::optional<Topology> topology;  // once a node shows it
};

// A mesh may have a million primitives without triangles: they are not among these.
struct DrawnMesh {
    std::size_t triangles = 0;
    std::vector<DrawnPrimitive> primitives;
};

class MeshPlacer {
public:
    MeshPlacer(Document& document, bool lightmaps, AnimationReader& animation, Scene& scene)
        : document_(document),
          animation_(animation),
          scene_(scene),
          poser_(document),
          textured_(lightmaps) {
        for (const Material& material : scene.materials) {
            for (const TextureSlot* slot : texture_slots(material))
                textured_ = textured_ || slot->texture >= 0;
        }
    }

    // Refuses a scene of too many triangles before the first is made.
    void count(const std::vector<int>& nodes, std::size_t most) {
        std::size_t total = 0;
        for (const int index : nodes) {
            const Node& node = document_.model.nodes[index];
            if (node.mesh < 0) continue;
            const auto [found, fresh] = meshes_.try_emplace(node.mesh);
            if (fresh) find_drawn(document_.model.meshes[node.mesh], found->second);
            const std::size_t triangles = found->second.triangles;
            if (triangles == 0) continue;
            const std::size_t copies = copy_count(document_, node);
            require(copies <= most / triangles && total <= most - copies * triangles,
                    "places more than the ", most, " triangles that are allowed");
            total += copies * triangles;
            if (node.skin >= 0 && extension(node.extensions, "EXT_mesh_gpu_instancing")) {
                document_.warnings.add("copies of a skinned mesh all stand in the same place");
            }
        }
    }

    void place(int index) {
        const Node& node = document_.model.nodes[index];
        DrawnMesh& mesh = meshes_[node.mesh];
        if (mesh.triangles == 0) return;
        const std::vector<glm::dmat4> copies = copy_transforms(document_, node);
        for (auto& [primitive, topology] : mesh.primitives) {
            if (!topology) topology = triangles_of(document_, *primitive, renumberer_);
            if (topology->triangles.empty()) continue;
            warn_of_missing_uv(*primitive);
            for (const glm::dmat4& copy : copies) place(index, *primitive, *topology, copy);
        }
    }

private:
    void find_drawn(const Mesh& mesh, DrawnMesh& drawn) {
        for (const Primitive& primitive : mesh.primitives) {
            if (attribute(primitive.attributes, "POSITION") < 0) {
                document_.warnings.add("a primitive without positions is skipped");
            } else if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                document_.warnings.add("a primitive of points or lines is skipped");
            }
            const std::size_t triangles = triangle_count(document_, primitive);
            if (triangles == 0) continue;
            drawn.triangles += std::min(triangles, SIZE_MAX - drawn.triangles);
            drawn.primitives.push_back({&primitive, std::nullopt});
            colored_ = colored_ || attribute(primitive.attributes, "COLOR_0") >= 0;
        }
    }

    void place(int index, const Primitive& primitive, const Topology& topology,
               const glm::dmat4& copy) {
        const Node& node = document_.model.nodes[index];
        const glm::dmat4& placed = document_.matrices[index];
        const glm::dmat4 matrix = copies_of(node).empty() ? placed : placed * copy;
        PosedVertices pose = poser_.pose(primitive, node, matrix, topology.vertices);
        for (const glm::dvec3& p : pose.positions) {
            require(glm::length(p) <= farthest, "meshes[", node.mesh,
                    "] is placed at a distance beyond 1e18 m");
        }
        if (pose.normals.empty()) {
            Topology split = topology;
            make_flat(split, pose);
            append(node, primitive, split, pose);
            animation_.add({index, primitive, split, copy, true}, scene_);
            return;
        }
        if (repair_normals(topology, pose)) {
            document_.warnings.add("vertex normals without a direction are computed anew");
        }
        append(node, primitive, topology, pose);
        animation_.add({index, primitive, topology, copy, false}, scene_);
    }

    void append(const Node& node, const Primitive& primitive, const Topology& topology,
                const PosedVertices& pose) {
        require(topology.vertices.size() <= UINT32_MAX - scene_.positions.size(),
                "has more than 2^32 vertices");
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
        scene_.positions.insert(scene_.positions.end(), pose.positions.begin(),
                                pose.positions.end());
        scene_.normals.insert(scene_.normals.end(), pose.normals.begin(), pose.normals.end());
        sanitised_ = false;
        if (textured_) append_uvs(primitive.attributes, topology.vertices);
        if (colored_) append_colors(primitive.attributes, topology.vertices);
        if (sanitised_) {
            document_.warnings.add("texture coordinates or colors that are not finite are mended");
        }
    }

    float finite_or(double value, float fallback) {
        if (std::isfinite(value)) return static_cast<float>(value);
        sanitised_ = true;
        return fallback;
    }

    void append_uvs(const Attributes& attributes, const std::vector<std::uint32_t>& vertices) {
        const auto set_0 = reader_of(document_, attributes, "TEXCOORD_0");
        const auto set_1 = reader_of(document_, attributes, "TEXCOORD_1");
        for (const std::uint32_t vertex : vertices) {
            glm::vec4 uv(0.0f);
            for (int i = 0; i < 4; ++i) {
                const auto& set = i < 2 ? set_0 : set_1;
                if (set) uv[i] = finite_or(set->number(vertex, i % 2), 0.0f);
            }
            scene_.uvs.push_back(uv);
        }
    }

    void append_colors(const Attributes& attributes, const std::vector<std::uint32_t>& vertices) {
        const auto colors = reader_of(document_, attributes, "COLOR_0");
        const int accessor = attribute(attributes, "COLOR_0");
        const auto channels = colors ? rows(document_.model.accessors[accessor]) : 0;
        for (const std::uint32_t vertex : vertices) {
            glm::vec4 color(1.0f);
            for (std::size_t i = 0; i < channels; ++i) {
                color[static_cast<int>(i)] =
                    std::clamp(finite_or(colors->number(vertex, i), 1.0f), 0.0f, 1.0f);
            }
            scene_.colors.push_back(color);
        }
    }

    void warn_of_missing_uv(const Primitive& primitive) {
        if (primitive.material < 0) return;
        const Material& material = scene_.materials[primitive.material];
        for (const TextureSlot* slot : texture_slots(material)) {
            const char* uv = slot->uv_set == 0 ? "TEXCOORD_0" : "TEXCOORD_1";
            if (slot->texture >= 0 && attribute(primitive.attributes, uv) < 0) {
                document_.warnings.add("a textured primitive has no texture coordinates");
            }
        }
    }

    std::uint32_t material_of(const Primitive& primitive) {
        if (primitive.material >= 0) return static_cast<std::uint32_t>(primitive.material);
        if (!default_material_) {
            default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
            Material& rough_metal = scene_.materials.emplace_back();  // glTF's default
            rough_metal.metallic = rough_metal.specular = 1.0f;
        }
        return *default_material_;
    }

    Document& document_;
    AnimationReader& animation_;
    Scene& scene_;
    Poser poser_;
    bool textured_;  // or its texture coordinates are wanted all the same
    bool colored_ = false;
    bool sanitised_ = false;
    std::optional<std::uint32_t> default_material_;
    std::map<int, DrawnMesh> meshes_;
    Renumberer renumberer_;
};

}  // namespace

void place_meshes(Document& document, const std::vector<int>& nodes, const GltfOptions& options,
                  AnimationReader& animation, Scene& scene) {
    MeshPlacer placer(document, options.lightmaps, animation, scene);
    placer.count(nodes, std::min<std::size_t>(options.max_triangles, UINT32_MAX / 3));
    for (const int node : nodes) {
        if (document.model.nodes[node].mesh >= 0) placer.place(node);
    }
}

}  // namespace clgi::io::gltf
