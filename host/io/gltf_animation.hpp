// From a document's animations, skins and morph targets to Scene::animation. What it holds is read
// after everything else was checked; data that is no use, or too much of it, becomes a warning and
// the scene stands still, as files did before animations were read.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_primitive.hpp"

namespace clgi::io::gltf {

// A primitive that was appended to the scene, as its last part.
struct AppendedPart {
    int node;
    const Primitive& primitive;
    const Topology& topology;
    const glm::dmat4& copy;  // from the mesh to the node
    bool flat;
};

class AnimationReader {
public:
    AnimationReader(Document& document, const GltfOptions& options);

    // Keeps the rest pose of vertices that some animation moves.
    void add(const AppendedPart& part, const Scene& scene);

    // After all meshes, lights and cameras are placed.
    void finish(Scene& scene);

private:
    bool is_moved(const AppendedPart& part);
    bool is_skinned(const AppendedPart& part) const;
    bool spend(std::size_t numbers);  // false: too many, nothing will be read
    void need(int node);
    void read_all(const Scene& scene);
    void read_rest(const AppendedPart& part, PosedRange& range);
    void read_influences(const AppendedPart& part, PosedRange& range);
    void read_differences(const AppendedPart& part, PosedRange& range);
    void read_nodes();
    void read_skins();
    void read_clip(const tinygltf::Animation& source, AnimationClip& clip);
    bool is_read(const tinygltf::AnimationChannel& channel);
    Curve read_curve(const tinygltf::AnimationSampler& sampler, std::uint32_t components);

    Document& document_;
    Animation out_;
    bool active_ = false;
    std::size_t numbers_ = 0;           // that have been read
    std::vector<bool> moving_;          // nodes whose matrix to the world some channel changes
    std::vector<bool> morphing_;        // whose weights
    std::map<int, bool> moving_skins_;  // those that were met
    std::vector<bool> needed_;          // nodes
    std::vector<int> index_;            // in out_.nodes; -1: not there
    std::map<int, int> skins_;          // index in out_.skins
};

}  // namespace clgi::io::gltf
