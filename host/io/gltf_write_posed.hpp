// save_glb: ranges of vertices that an animation moves, as primitives with joints and targets.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_writer.hpp"

namespace clgi::io::gltf {

// By columns. Throws InputError for one that is not affine.
std::vector<double> matrix_numbers(const glm::dmat4& matrix);

class PosedMeshWriter {
public:
    PosedMeshWriter(const Scene& scene, PrimitiveWriter& meshes, GlbModel& out);

    // Appends the range's triangles to a mesh.
    void add_range(const PosedRange& range, Mesh& mesh);

    // The skin for a mesh of such ranges. first_node: of the animation, in the model.
    int skin_of(const PosedRange& range, int first_node);

    // Whether a vertex follows the range's node by a skin that has other joints.
    bool follows_own_node(const PosedRange& range) const;

private:
    Influence influence(const PosedRange& range, std::uint32_t i, std::uint32_t v) const;
    void add_influences(const PosedRange& range, const std::vector<std::uint32_t>& used,
                        Primitive& primitive);
    void add_targets(const PosedRange& range, const std::vector<std::uint32_t>& used,
                     Primitive& primitive);
    void repair_order(const PosedRange& range, const std::vector<std::uint32_t>& used,
                      const Primitive& primitive);

    const Scene& scene_;
    const Animation& animation_;
    const Pose rest_;
    PrimitiveWriter& meshes_;
    GlbModel& out_;
    std::map<int, int> skins_;  // that were written
};

}  // namespace clgi::io::gltf
