// SPDX-License-Identifier: MIT
#include "io/gltf_animation.hpp"

#include <algorithm>

#include "io/gltf_accessor.hpp"
#include "scene/validate.hpp"

namespace clgi::io::gltf {

namespace {

// Floats of keys, vertices, targets and matrices of joints together: half a gigabyte. Samplers and
// primitives may share accessors, so the file need not be as large.
constexpr std::size_t most_numbers = std::size_t{1} << 27;

std::optional<ChannelTarget> target_of(const std::string& path) {
    static const std::map<std::string, ChannelTarget> targets = {
        {"translation", ChannelTarget::translation},
        {"rotation", ChannelTarget::rotation},
        {"scale", ChannelTarget::scale},
        {"weights", ChannelTarget::weights}};
    const auto found = targets.find(path);
    return found == targets.end() ? std::nullopt : std::optional(found->second);
}

std::size_t targets_of(const Model& model, const Node& node) {
    return node.mesh < 0 ? 0 : model.meshes[node.mesh].primitives[0].targets.size();
}

}  // namespace

AnimationReader::AnimationReader(Document& document, const GltfOptions& options)
    : document_(document) {
    const Model& model = document.model;
    if (!options.animation || model.animations.empty()) return;
    moving_.resize(model.nodes.size());
    morphing_.resize(model.nodes.size());
    needed_.resize(model.nodes.size());
    for (const tinygltf::Animation& animation : model.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            if (!is_read(channel)) continue;
            const bool weights = channel.target_path == "weights";
            (weights ? morphing_ : moving_)[channel.target_node] = true;
            active_ = true;
        }
    for (const int node : document.order) {
        const int parent = document.parents[node];
        if (parent >= 0 && moving_[parent]) moving_[node] = true;
    }
}

bool AnimationReader::is_read(const tinygltf::AnimationChannel& channel) {
    const std::optional<ChannelTarget> target = target_of(channel.target_path);
    if (!target || channel.target_node < 0) return false;  // of an extension
    const Node& node = document_.model.nodes[channel.target_node];
    if (*target == ChannelTarget::weights) return targets_of(document_.model, node) > 0;
    if (node.matrix.empty()) return true;
    document_.warnings.add("an animation channel of a node that has a matrix is left out");
    return false;
}

bool AnimationReader::spend(std::size_t numbers) {
    if (!active_) return false;
    if (numbers <= most_numbers - numbers_) {
        numbers_ += numbers;
        return true;
    }
    document_.warnings.add("animation is left out: it has more than " +
                           std::to_string(most_numbers) + " numbers");
    active_ = false;  // out_ may be at work further up, finish() empties it
    return false;
}

void AnimationReader::need(int node) {
    for (; node >= 0 && !needed_[node]; node = document_.parents[node]) needed_[node] = true;
}

void AnimationReader::read_nodes() {
    index_.assign(needed_.size(), -1);
    std::vector<bool> shows_targets(needed_.size());
    for (const PosedRange& range : out_.ranges)
        if (range.target_count > 0) shows_targets[range.node] = true;
    Warnings said;  // when the node was placed
    for (const int node : document_.order) {
        if (!needed_[node]) continue;
        const Node& source = document_.model.nodes[node];
        index_[node] = static_cast<int>(out_.nodes.size());
        AnimatedNode& made = out_.nodes.emplace_back(transform_of(source, said));
        made.name = short_name(source.name);
        const int parent = document_.parents[node];
        made.parent = parent < 0 ? -1 : index_[parent];
        if (!shows_targets[node]) continue;
        made.first_weight = static_cast<std::uint32_t>(out_.weights.size());
        made.weight_count = static_cast<std::uint32_t>(targets_of(document_.model, source));
        if (!spend(made.weight_count)) return;
        const std::vector<double>& weights =
            source.weights.empty() ? document_.model.meshes[source.mesh].weights : source.weights;
        out_.weights.insert(out_.weights.end(), weights.begin(), weights.end());
        out_.weights.resize(std::size_t{made.first_weight} + made.weight_count);
    }
}

void AnimationReader::read_skins() {
    out_.skins.resize(skins_.size());
    for (const auto& [index, place] : skins_) {
        const tinygltf::Skin& source = document_.model.skins[index];
        if (!spend(16 * source.joints.size())) return;
        Skin& skin = out_.skins[static_cast<std::size_t>(place)];
        for (const int joint : source.joints)
            skin.joints.push_back(static_cast<std::uint32_t>(index_[joint]));
        skin.inverse_binds.assign(source.joints.size(), glm::dmat4(1.0));
        if (source.inverseBindMatrices < 0) continue;
        const AccessorReader reader(document_,
                                    document_.model.accessors[source.inverseBindMatrices]);
        for (std::size_t j = 0; j < source.joints.size(); ++j)
            for (int k = 0; k < 4; ++k) skin.inverse_binds[j][k] = reader.vector<4>(j, 4 * k);
    }
}

Curve AnimationReader::read_curve(const tinygltf::AnimationSampler& sampler,
                                  std::uint32_t components) {
    Curve curve;
    curve.components = components;
    if (sampler.interpolation == "STEP") curve.interpolation = Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") curve.interpolation = Interpolation::cubic;
    require(curve.interpolation != Interpolation::linear || sampler.interpolation == "LINEAR",
            "interpolation is ", printable(sampler.interpolation),
            ", none of LINEAR, STEP, CUBICSPLINE");
    const AccessorReader times(document_, document_.model.accessors[sampler.input]);
    const AccessorReader values(document_, document_.model.accessors[sampler.output]);
    const std::size_t height = rows(document_.model.accessors[sampler.output]);
    if (!spend(times.size() + values.size() * height)) return curve;
    for (std::size_t key = 0; key < times.size(); ++key)
        curve.times.push_back(static_cast<float>(times.number(key, 0)));
    for (std::size_t value = 0; value < values.size(); ++value)
        for (std::size_t row = 0; row < height; ++row)
            curve.values.push_back(static_cast<float>(values.number(value, row)));
    return curve;
}

void AnimationReader::read_clip(const tinygltf::Animation& source, AnimationClip& clip) {
    clip.name = short_name(source.name);
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> read;  // samplers and components
    for (const tinygltf::AnimationChannel& channel : source.channels) {
        if (!is_read(channel) || index_[channel.target_node] < 0) continue;
        const AnimatedNode& node =
            out_.nodes[static_cast<std::size_t>(index_[channel.target_node])];
        Channel made;
        made.target = *target_of(channel.target_path);
        made.node = static_cast<std::uint32_t>(index_[channel.target_node]);
        std::uint32_t components = made.target == ChannelTarget::rotation ? 4 : 3;
        if (made.target == ChannelTarget::weights) components = node.weight_count;
        if (components == 0) continue;  // the node's mesh does not move
        const auto [found, fresh] = read.try_emplace(
            {channel.sampler, components}, static_cast<std::uint32_t>(clip.curves.size()));
        if (fresh) {
            Curve curve = read_curve(source.samplers[channel.sampler], components);
            if (!active_) return;
            clip.curves.push_back(std::move(curve));
            clip.duration = std::max(clip.duration, double{clip.curves.back().times.back()});
        }
        made.curve = found->second;
        clip.channels.push_back(made);
    }
}

void AnimationReader::finish(Scene& scene) {
    if (active_) read_all(scene);
    if (active_) scene.animation = std::move(out_);
    out_ = {};
}

void AnimationReader::read_all(const Scene& scene) {
    const auto carried = [&](const std::vector<int>& nodes, std::vector<Carried>& out) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!moving_[nodes[i]]) continue;
            need(nodes[i]);
            out.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(nodes[i])});
        }
    };
    carried(document_.light_nodes, out_.lights);
    carried(document_.camera_nodes, out_.cameras);
    if (out_.ranges.empty() && out_.lights.empty() && out_.cameras.empty()) {
        active_ = false;
        return;
    }
    try {
        read_nodes();
        for (std::vector<Carried>* list : {&out_.lights, &out_.cameras})
            for (Carried& item : *list) item.node = static_cast<std::uint32_t>(index_[item.node]);
        for (PosedRange& range : out_.ranges)
            range.node = static_cast<std::uint32_t>(index_[range.node]);
        if (active_) read_skins();
        out_.clips.resize(document_.model.animations.size());
        for (std::size_t i = 0; i < out_.clips.size() && active_; ++i)
            within([&] { return "clip " + std::to_string(i) + ":"; },
                   [&] { read_clip(document_.model.animations[i], out_.clips[i]); });
        if (active_) validate_animation(out_, scene);
    } catch (const InputError& error) {
        active_ = false;
        document_.warnings.add(std::string("animation is left out: ") + error.what());
    }
}

}  // namespace clgi::io::gltf
