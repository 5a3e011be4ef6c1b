// save_glb: the meshes and skins of vertices that an animation moves.
// SPDX-License-Identifier: MIT
#include "io/gltf_write_posed.hpp"

#include <algorithm>
#include <cmath>

#include "scene/range_matrices.hpp"

namespace clgi::io::gltf {

namespace {

const Part& part_of(const Scene& scene, const PosedRange& range) { return scene.parts[range.part]; }

}  // namespace

std::vector<double> matrix_numbers(const glm::dmat4& matrix) {
    require(
        matrix[0][3] == 0.0 && matrix[1][3] == 0.0 && matrix[2][3] == 0.0 && matrix[3][3] == 1.0,
        "has a matrix that is not affine");
    std::vector<double> list;
    for (int i = 0; i < 16; ++i) list.push_back(matrix[i / 4][i % 4]);
    return list;
}

std::vector<bool> moved_triangles(const Scene& scene) {
    std::vector<bool> moved(scene.triangles.size());
    if (!scene.animation) return moved;
    std::vector<bool> moved_vertices(scene.positions.size());
    for (const PosedRange& range : scene.animation->ranges) {
        const Part& part = part_of(scene, range);
        std::fill_n(moved.begin() + part.first_triangle, part.triangle_count, true);
        std::fill_n(moved_vertices.begin() + range.first_vertex, range.vertex_count, true);
    }
    for (std::size_t t = 0; t < moved.size(); ++t)
        for (const std::uint32_t vertex : scene.triangles[t].vertex)
            require(moved[t] || !moved_vertices[vertex], "triangle ", t, " names vertex ", vertex,
                    ", which moves with a part that does not have the triangle");
    return moved;
}

PosedMeshWriter::PosedMeshWriter(const Scene& scene, PrimitiveWriter& meshes, GlbModel& out)
    : scene_(scene),
      animation_(*scene.animation),
      rest_(rest_pose(animation_)),
      meshes_(meshes),
      out_(out) {}

Influence PosedMeshWriter::influence(const PosedRange& range, std::uint32_t i,
                                     std::uint32_t v) const {
    return animation_.influences[range.first_influence + std::uint64_t{i} * range.vertex_count + v];
}

bool PosedMeshWriter::follows_own_node(const PosedRange& range) const {
    const std::size_t own = animation_.skins[static_cast<std::size_t>(range.skin)].joints.size();
    for (std::uint32_t i = 0; i < range.influence_count; ++i)
        for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
            const Influence found = influence(range, i, v);
            if (found.weight > 0.0f && found.joint == own) return true;
        }
    return false;
}

// Where a vertex follows the range's own node besides joints, that node becomes the last joint.
int PosedMeshWriter::skin_of(const PosedRange& range, int first_node) {
    const bool own = follows_own_node(range);
    if (const auto found = skins_.find(range.skin); found != skins_.end() && !own)
        return found->second;
    const Skin& skin = animation_.skins[static_cast<std::size_t>(range.skin)];
    tinygltf::Skin written;
    std::vector<glm::mat4> binds;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        written.joints.push_back(first_node + static_cast<int>(skin.joints[j]));
        binds.emplace_back(skin.inverse_binds[j]);
    }
    if (own) {
        written.joints.push_back(first_node + static_cast<int>(range.node));
        binds.emplace_back(range.placement);
    }
    for (const glm::mat4& bind : binds)
        for (int i = 0; i < 16; ++i)
            require(std::isfinite(bind[i / 4][i % 4]),
                    "a skin has an inverse bind matrix beyond "
                    "the range of a float");
    written.inverseBindMatrices =
        out_.add_array(binds, binds.size(), TINYGLTF_TYPE_MAT4, TINYGLTF_COMPONENT_TYPE_FLOAT);
    const int index = add(out_.model.skins, std::move(written));
    if (!own) skins_[range.skin] = index;
    return index;
}

void PosedMeshWriter::add_influences(const PosedRange& range,
                                     const std::vector<std::uint32_t>& used, Primitive& primitive) {
    using Joints = glm::vec<4, std::uint16_t>;
    for (std::uint32_t first = 0; first < range.influence_count; first += 4) {
        std::vector<Joints> joints;
        std::vector<glm::vec4> weights;
        for (const std::uint32_t vertex : used) {
            Joints names(std::uint16_t{0});
            glm::vec4 shares(0.0f);
            for (std::uint32_t i = first; i < std::min(first + 4, range.influence_count); ++i) {
                const Influence found = influence(range, i, vertex - range.first_vertex);
                if (!(found.weight > 0.0f)) continue;
                require(found.joint <= UINT16_MAX, "a vertex follows joint ", found.joint,
                        ", a file names 65536 at most");
                names[static_cast<int>(i - first)] = static_cast<std::uint16_t>(found.joint);
                shares[static_cast<int>(i - first)] = found.weight;
            }
            joints.push_back(names);
            weights.push_back(shares);
        }
        const std::string set = std::to_string(first / 4);
        primitive.attributes["JOINTS_" + set] = out_.add_array(
            joints, joints.size(), TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
            TINYGLTF_TARGET_ARRAY_BUFFER, sizeof(Joints));
        primitive.attributes["WEIGHTS_" + set] = out_.add_vertices(weights);
    }
}

// As many targets as the node has weights; a range may have fewer.
void PosedMeshWriter::add_targets(const PosedRange& range, const std::vector<std::uint32_t>& used,
                                  Primitive& primitive) {
    const std::uint32_t count = animation_.nodes[range.node].weight_count;
    const auto differences = [&](std::uint32_t target, std::uint32_t first_row) {
        std::vector<glm::vec3> values;
        for (const std::uint32_t vertex : used)
            values.push_back(target < range.target_count
                                 ? animation_.differences[range.first_difference +
                                                          (std::uint64_t{first_row} + target) *
                                                              range.vertex_count +
                                                          vertex - range.first_vertex]
                                 : glm::vec3(0.0f));
        return values;
    };
    for (std::uint32_t target = 0; target < count; ++target) {
        Attributes written;
        written["POSITION"] = out_.add_bounded(differences(target, 0));
        if (range.morphs_normals)
            written["NORMAL"] = out_.add_vertices(differences(target, range.target_count));
        primitive.targets.push_back(std::move(written));
    }
}

// The reader exchanges two corners of triangles that the rest pose mirrors.
void PosedMeshWriter::repair_order(const PosedRange& range, const std::vector<std::uint32_t>& used,
                                   const Primitive& primitive) {
    const std::vector<glm::dmat4> matrices = range_matrices(animation_, range, rest_);
    const auto is_mirrored = [&](std::uint32_t v) {
        glm::dmat4 sum(range.influence_count == 0 ? matrices.back() : glm::dmat4(0.0));
        for (std::uint32_t i = 0; i < range.influence_count; ++i) {
            const Influence found = influence(range, i, v);
            if (found.weight > 0.0f) sum += matrices[found.joint] * double{found.weight};
        }
        return glm::determinant(glm::dmat3(sum)) < 0.0;
    };
    const Accessor& accessor = out_.model.accessors[primitive.indices];
    auto* index = reinterpret_cast<std::uint32_t*>(
        out_.binary.data() + out_.model.bufferViews[accessor.bufferView].byteOffset);
    for (std::size_t i = 0; i < accessor.count; i += 3)
        if (is_mirrored(used[index[i]] - range.first_vertex)) std::swap(index[i + 1], index[i + 2]);
}

void PosedMeshWriter::add_range(const PosedRange& range, Mesh& mesh) {
    const Part& part = part_of(scene_, range);
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
        triangles.push_back(part.first_triangle + t);
    std::vector<std::vector<std::uint32_t>> vertices;  // of the primitives
    Mesh made = meshes_.mesh_of(
        triangles, [&](const std::vector<std::uint32_t>& used, Primitive& primitive) {
            std::vector<glm::vec3> positions, normals;
            for (const std::uint32_t vertex : used) {
                const std::uint32_t rest = range.first_rest + vertex - range.first_vertex;
                positions.emplace_back(glm::dvec3(animation_.rest_positions[rest]) + range.centre);
                normals.push_back(animation_.rest_normals[rest]);
            }
            primitive.attributes["POSITION"] = out_.add_bounded(positions);
            if (!range.flat) primitive.attributes["NORMAL"] = out_.add_vertices(normals);
            add_influences(range, used, primitive);
            add_targets(range, used, primitive);
            vertices.push_back(used);
        });
    for (std::size_t i = 0; i < made.primitives.size(); ++i)
        repair_order(range, vertices[i], made.primitives[i]);
    if (mesh.name.empty()) mesh.name = utf8(part.name);
    std::move(made.primitives.begin(), made.primitives.end(), std::back_inserter(mesh.primitives));
}

}  // namespace clgi::io::gltf
