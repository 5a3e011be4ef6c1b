// save_glb: the nodes of an animation, what they show and carry, and the clips that drive them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_write_posed.hpp"
#include "scene/node_matrix.hpp"

namespace clgi::io::gltf {

namespace {

// As poses take it.
glm::dquat unit(const glm::dquat& q) {
    return is_rotation(q) ? q / glm::length(q) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

// Floats that are unit but for their rounding are kept.
void make_unit(float* xyzw) {
    const glm::dquat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    if (std::abs(glm::length(q) - 1.0) < 1e-6) return;
    const glm::dquat made = unit(q);
    const double components[4] = {made.x, made.y, made.z, made.w};
    std::transform(components, components + 4, xyzw,
                   [](double component) { return static_cast<float>(component); });
}

Node node_of(const AnimatedNode& source) {
    Node node;
    node.name = utf8(source.name);
    if (source.matrix) {
        node.matrix = matrix_numbers(*source.matrix);
        return node;
    }
    const glm::dquat q = unit(source.rotation);
    node.translation = numbers(source.translation);
    node.rotation = {q.x, q.y, q.z, q.w};
    node.scale = numbers(source.scale);
    return node;
}

const char* path_of(ChannelTarget target) {
    if (target == ChannelTarget::translation) return "translation";
    if (target == ChannelTarget::rotation) return "rotation";
    return target == ChannelTarget::scale ? "scale" : "weights";
}

class AnimationWriter {
public:
    AnimationWriter(const Scene& scene, PrimitiveWriter& meshes, LightWriter& lights, GlbModel& out)
        : scene_(scene),
          animation_(*scene.animation),
          posed_(scene, meshes, out),
          lights_(lights),
          out_(out),
          first_(static_cast<int>(out.model.nodes.size())),
          morphed_(animation_.nodes.size()) {}

    void write() {
        for (std::size_t i = 0; i < animation_.nodes.size(); ++i) {
            const AnimatedNode& source = animation_.nodes[i];
            const int index = of_entry("animation: node", i,
                                       [&] { return add(out_.model.nodes, node_of(source)); });
            if (source.parent >= 0)
                out_.model.nodes[first_ + source.parent].children.push_back(index);
        }
        add_roots();
        add_meshes();
        for (const Carried& light : animation_.lights) {
            Node* node = &out_.model.nodes[first_ + static_cast<int>(light.node)];
            if (node->extensions.contains("KHR_lights_punctual")) node = &child_of(light.node);
            lights_.put_light(scene_.lights[light.index], *node);
        }
        for (const Carried& camera : animation_.cameras) {
            Node* node = &out_.model.nodes[first_ + static_cast<int>(camera.node)];
            if (node->camera >= 0) node = &child_of(camera.node);
            lights_.put_camera(scene_.cameras[camera.index], *node);
        }
        for (const AnimationClip& clip : animation_.clips) add_clip(clip);
    }

private:
    // A new node that stands where the parent does. Earlier references to nodes end.
    Node& child_of(std::uint32_t parent) {
        const int index = add(out_.model.nodes, Node());
        out_.model.nodes[first_ + static_cast<int>(parent)].children.push_back(index);
        return out_.model.nodes.back();
    }

    // In the order of the ranges below them, which the reader then finds in the same order.
    void add_roots() {
        std::vector<bool> listed(animation_.nodes.size());
        const auto list = [&](std::size_t node) {
            while (animation_.nodes[node].parent >= 0)
                node = static_cast<std::size_t>(animation_.nodes[node].parent);
            if (!listed[node]) out_.roots.push_back(first_ + static_cast<int>(node));
            listed[node] = true;
        };
        for (const PosedRange& range : animation_.ranges) list(range.node);
        for (std::size_t node = 0; node < listed.size(); ++node) list(node);
    }

    // Ranges of one node are primitives of one mesh, but for copies and where skins differ.
    void add_meshes() {
        std::vector<bool> done(animation_.ranges.size());
        for (std::size_t i = 0; i < done.size(); ++i) {
            const PosedRange& first = animation_.ranges[i];
            const bool own = first.influence_count > 0 && posed_.follows_own_node(first);
            Mesh mesh;
            for (std::size_t k = i; k < done.size(); ++k) {
                const PosedRange& range = animation_.ranges[k];
                if (done[k] || range.node != first.node || range.placement != first.placement ||
                    skin(range) != skin(first))
                    continue;
                // A skin with the node as a joint is that of one range.
                if (k > i && (own || (skin(range) >= 0 && posed_.follows_own_node(range))))
                    continue;
                done[k] = true;
                if (scene_.parts[range.part].triangle_count > 0) posed_.add_range(range, mesh);
            }
            if (!mesh.primitives.empty()) show(first, std::move(mesh));
        }
    }

    // The reader takes vertices for skinned where both the node has a skin and they have joints.
    static int skin(const PosedRange& range) { return range.influence_count > 0 ? range.skin : -1; }

    void show(const PosedRange& range, Mesh mesh) {
        const AnimatedNode& source = animation_.nodes[range.node];
        int index = first_ + static_cast<int>(range.node);
        if (out_.model.nodes[index].mesh >= 0 || range.placement != glm::dmat4(1.0)) {
            Node& child = child_of(range.node);
            child.matrix = matrix_numbers(range.placement);
            index = static_cast<int>(out_.model.nodes.size()) - 1;
        }
        Node& node = out_.model.nodes[index];
        node.mesh = add(out_.model.meshes, std::move(mesh));
        if (skin(range) >= 0) node.skin = posed_.skin_of(range, first_);
        if (source.weight_count == 0) return;
        const double* weights = animation_.weights.data() + source.first_weight;
        node.weights.assign(weights, weights + source.weight_count);
        out_.model.meshes[node.mesh].weights = node.weights;
        morphed_[range.node].push_back(index);
    }

    int sampler_of(const Curve& curve, ChannelTarget target) {
        tinygltf::AnimationSampler sampler;
        sampler.interpolation = curve.interpolation == Interpolation::step     ? "STEP"
                                : curve.interpolation == Interpolation::linear ? "LINEAR"
                                                                               : "CUBICSPLINE";
        sampler.input = out_.add_array(curve.times, curve.times.size(), TINYGLTF_TYPE_SCALAR,
                                       TINYGLTF_COMPONENT_TYPE_FLOAT);
        Accessor& input = out_.model.accessors.back();
        input.minValues = {curve.times.front()};
        input.maxValues = {curve.times.back()};
        int type = target == ChannelTarget::rotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
        std::size_t count = curve.values.size() / curve.components;
        if (target == ChannelTarget::weights) {
            type = TINYGLTF_TYPE_SCALAR;
            count = curve.values.size();
        }
        std::vector<float> values = curve.values;
        // Tangents belong to the values of a cubic as they are.
        if (target == ChannelTarget::rotation && curve.interpolation != Interpolation::cubic)
            for (std::size_t i = 0; i < values.size(); i += 4) make_unit(&values[i]);
        sampler.output = out_.add_array(values, count, type, TINYGLTF_COMPONENT_TYPE_FLOAT);
        return add(samplers_, std::move(sampler));
    }

    void add_clip(const AnimationClip& clip) {
        tinygltf::Animation written;
        written.name = utf8(clip.name);
        samplers_.clear();
        std::map<std::pair<std::uint32_t, bool>, int> made;  // curves, whether of weights
        for (const Channel& channel : clip.channels) {
            const bool weights = channel.target == ChannelTarget::weights;
            std::vector<int> nodes = {first_ + static_cast<int>(channel.node)};
            if (weights) nodes = morphed_[channel.node];
            if (!weights && animation_.nodes[channel.node].matrix) continue;  // changes nothing
            for (const int node : nodes) {
                const auto [found, fresh] = made.try_emplace({channel.curve, weights});
                if (fresh) found->second = sampler_of(clip.curves[channel.curve], channel.target);
                tinygltf::AnimationChannel to;
                to.sampler = found->second;
                to.target_node = node;
                to.target_path = path_of(channel.target);
                written.channels.push_back(std::move(to));
            }
        }
        if (written.channels.empty()) hold_still(written);
        written.samplers = std::move(samplers_);
        out_.model.animations.push_back(std::move(written));
    }

    // The format has no clip without a channel; clips keep their numbers. What has a matrix takes
    // no channel: where all nodes have one, another node is held.
    void hold_still(tinygltf::Animation& written) {
        const auto held = std::find_if(animation_.nodes.begin(), animation_.nodes.end(),
                                       [](const AnimatedNode& node) { return !node.matrix; });
        glm::vec3 place(0.0f);
        tinygltf::AnimationChannel to;
        if (held != animation_.nodes.end()) {
            place = glm::vec3(held->translation);
            to.target_node = first_ + static_cast<int>(held - animation_.nodes.begin());
        } else {
            if (still_ < 0) {
                Node node;
                node.name = "still";  // tinygltf writes null for a node of nothing
                out_.roots.push_back(still_ = add(out_.model.nodes, std::move(node)));
            }
            to.target_node = still_;
        }
        const Curve curve{Interpolation::step, 3, {0.0f}, {place.x, place.y, place.z}};
        to.sampler = sampler_of(curve, ChannelTarget::translation);
        to.target_path = path_of(ChannelTarget::translation);
        written.channels.push_back(std::move(to));
    }

    const Scene& scene_;
    const Animation& animation_;
    PosedMeshWriter posed_;
    LightWriter& lights_;
    GlbModel& out_;
    const int first_;                        // of the animation's nodes, in the model
    int still_ = -1;                         // a node that carries nothing
    std::vector<std::vector<int>> morphed_;  // nodes that show the weights of the animation's nodes
    std::vector<tinygltf::AnimationSampler> samplers_;  // of the clip at work
};

}  // namespace

void add_animation(const Scene& scene, PrimitiveWriter& meshes, LightWriter& lights,
                   GlbModel& out) {
    if (scene.animation) AnimationWriter(scene, meshes, lights, out).write();
}

}  // namespace clgi::io::gltf
