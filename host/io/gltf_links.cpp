// check_links: how the parts of a model fit each other.
// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

std::string counted(std::size_t count, const char* things) {
    return std::to_string(count) + " " + things;
}

std::size_t targets_of(const Model& model, int mesh) {
    return model.meshes[mesh].primitives[0].targets.size();
}

void check_primitive(const Primitive& primitive, const Model& model, const std::string& name) {
    for (int set = 0;; ++set) {
        const std::string number = std::to_string(set);
        const bool joints = primitive.attributes.count("JOINTS_" + number) > 0;
        const bool weights = primitive.attributes.count("WEIGHTS_" + number) > 0;
        if (!joints && !weights) break;
        if (joints != weights) {
            refuse(name + ".attributes", "has joints without weights or weights alone");
        }
    }
    if (extension(primitive.extensions, "KHR_draco_mesh_compression")) {
        const int position = attribute(primitive.attributes, "POSITION");
        if (position < 0 || model.accessors[position].bufferView < 0) {
            refuse(name, "needs KHR_draco_mesh_compression, which clgi does not read");
        }
    }
}

void check_mesh(const Mesh& mesh, const Model& model, const std::string& name) {
    if (mesh.primitives.empty()) refuse(name + ".primitives", "is empty");
    const std::size_t targets = mesh.primitives[0].targets.size();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::string primitive = name + entry(".primitives", i);
        check_primitive(mesh.primitives[i], model, primitive);
        if (mesh.primitives[i].targets.size() != targets) {
            refuse(primitive, "has another number of morph targets than the first");
        }
    }
    if (!mesh.weights.empty() && mesh.weights.size() != targets) {
        refuse(name, "has " + counted(mesh.weights.size(), "weights for ") +
                         counted(targets, "morph targets"));
    }
}

void check_node(const Node& node, const Model& model, const std::string& name) {
    if (node.mesh < 0 && node.skin >= 0) refuse(name, "has a skin, but no mesh");
    if (node.weights.empty()) return;
    if (node.mesh < 0) refuse(name, "has weights, but no mesh");
    const std::size_t targets = targets_of(model, node.mesh);
    if (node.weights.size() != targets) {
        refuse(name, "has " + counted(node.weights.size(), "weights, its mesh has ") +
                         counted(targets, "morph targets"));
    }
}

void check_skin(const tinygltf::Skin& skin, const Model& model, const std::string& name) {
    if (skin.joints.empty()) refuse(name + ".joints", "is empty");
    if (skin.inverseBindMatrices < 0) return;
    const Accessor& accessor = model.accessors[skin.inverseBindMatrices];
    if (accessor.type != TINYGLTF_TYPE_MAT4 ||
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        refuse(name, "has inverse bind matrices that are not 4x4 floats");
    }
    if (accessor.count < skin.joints.size()) {
        refuse(name, "has " + counted(accessor.count, "inverse bind matrices for ") +
                         counted(skin.joints.size(), "joints"));
    }
}

// Animations are not played, but may not refer to what is not there.
void check_channel(const tinygltf::AnimationChannel& channel,
                   const tinygltf::AnimationSampler& curve, const Model& model,
                   const std::string& name) {
    static const std::map<std::string, std::size_t> rows_of = {
        {"translation", 3}, {"scale", 3}, {"rotation", 4}, {"weights", 1}};
    const auto rows = rows_of.find(channel.target_path);
    if (rows == rows_of.end() || channel.target_node < 0) return;  // of an extension
    const Accessor& output = model.accessors[curve.output];
    if (Layout(output).rows != rows->second) refuse(name, "has key values of the wrong shape");

    // A cubic spline has a tangent, a value and a tangent a key.
    std::size_t values = curve.interpolation == "CUBICSPLINE" ? 3 : 1;
    if (channel.target_path == "weights") {
        const int mesh = model.nodes[channel.target_node].mesh;
        if (mesh < 0 || targets_of(model, mesh) == 0) return;
        values *= targets_of(model, mesh);
    }
    const std::size_t keys = model.accessors[curve.input].count;
    if (output.count / values != keys || output.count % values != 0) {
        refuse(name, "has " + counted(output.count, "values for ") + counted(keys, "keys"));
    }
}

void check_animation(const tinygltf::Animation& animation, const Model& model,
                     const std::string& name) {
    for (std::size_t i = 0; i < animation.samplers.size(); ++i) {
        const Accessor& input = model.accessors[animation.samplers[i].input];
        if (input.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || Layout(input).rows != 1) {
            refuse(name + entry(".samplers", i) + ".input", "is not an accessor of float scalars");
        }
    }
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
        const std::string channel = name + entry(".channels", i);
        const auto sampler = static_cast<std::size_t>(animation.channels[i].sampler);
        if (sampler >= animation.samplers.size()) {
            refuse(channel + ".sampler", "is " + std::to_string(sampler) + ", there are " +
                                             counted(animation.samplers.size(), "samplers"));
        }
        check_channel(animation.channels[i], animation.samplers[sampler], model, channel);
    }
}

}  // namespace

void check_links(const Model& model) {
    const auto each = [&](const auto& list, const char* name, auto check) {
        for (std::size_t i = 0; i < list.size(); ++i) check(list[i], model, entry(name, i));
    };
    each(model.meshes, "meshes", check_mesh);
    each(model.nodes, "nodes", check_node);
    each(model.skins, "skins", check_skin);
    each(model.animations, "animations", check_animation);
}

}  // namespace clgi::io::gltf
