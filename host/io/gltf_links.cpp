// check_links: how the parts of a model fit each other.
// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"
#include "io/gltf_check.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

void check_primitive(const Primitive& primitive, const Model& model, const std::string& name) {
    for (int set = 0;; ++set) {
        const std::string number = std::to_string(set);
        const int joints = attribute(primitive.attributes, "JOINTS_" + number);
        const int weights = attribute(primitive.attributes, "WEIGHTS_" + number);
        if (joints < 0 && weights < 0) break;
        if (joints < 0 || weights < 0) {
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
        refuse(name, "has " + std::to_string(mesh.weights.size()) + " weights for " +
                         std::to_string(targets) + " morph targets");
    }
}

void check_node(const Node& node, const Model& model, const std::string& name) {
    if (node.mesh < 0) {
        if (node.skin >= 0) refuse(name, "has a skin, but no mesh");
        if (!node.weights.empty()) refuse(name, "has weights, but no mesh");
        return;
    }
    const std::size_t targets = model.meshes[node.mesh].primitives[0].targets.size();
    if (!node.weights.empty() && node.weights.size() != targets) {
        refuse(name, "has " + std::to_string(node.weights.size()) + " weights, its mesh has " +
                         std::to_string(targets) + " morph targets");
    }
}

void check_skin(const Skin& skin, const Model& model, const std::string& name) {
    if (skin.joints.empty()) refuse(name + ".joints", "is empty");
    if (skin.inverseBindMatrices < 0) return;
    const Accessor& accessor = model.accessors[skin.inverseBindMatrices];
    if (accessor.type != TINYGLTF_TYPE_MAT4 ||
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        refuse(name, "has inverse bind matrices that are not 4x4 floats");
    }
    if (accessor.count < skin.joints.size()) {
        refuse(name, "has " + std::to_string(accessor.count) + " inverse bind matrices for " +
                         std::to_string(skin.joints.size()) + " joints");
    }
}

// Of the values that animate `path` of a node; 0: of an extension.
std::size_t rows_of(const std::string& path) {
    if (path == "translation" || path == "scale") return 3;
    if (path == "rotation") return 4;
    return path == "weights" ? 1 : 0;
}

void check_channel(const tinygltf::AnimationChannel& channel,
                   const tinygltf::AnimationSampler& curve, const Model& model,
                   const std::string& name) {
    const std::size_t expected = rows_of(channel.target_path);
    const Accessor& output = model.accessors[curve.output];
    if (expected == 0 || channel.target_node < 0) return;
    if (rows(output) != expected) refuse(name, "has key values of the wrong shape");

    // A cubic spline has a tangent, a value and a tangent a key.
    std::size_t values = curve.interpolation == "CUBICSPLINE" ? 3 : 1;
    if (channel.target_path == "weights") {
        const int mesh = model.nodes[channel.target_node].mesh;
        if (mesh < 0 || model.meshes[mesh].primitives[0].targets.empty()) return;
        values *= model.meshes[mesh].primitives[0].targets.size();
    }
    const std::size_t keys = model.accessors[curve.input].count;
    if (output.count / values != keys || output.count % values != 0) {
        refuse(name, "has " + std::to_string(output.count) + " values for " + std::to_string(keys) +
                         " keys");
    }
}

// Animations are not played, but may not refer to what is not there.
void check_animation(const tinygltf::Animation& animation, const Model& model,
                     const std::string& name) {
    for (std::size_t i = 0; i < animation.samplers.size(); ++i) {
        const Accessor& input = model.accessors[animation.samplers[i].input];
        if (input.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || rows(input) != 1) {
            refuse(name + entry(".samplers", i) + ".input", "is not an accessor of float scalars");
        }
    }
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
        const tinygltf::AnimationChannel& channel = animation.channels[i];
        check_channel(channel, animation.samplers[channel.sampler], model,
                      name + entry(".channels", i));
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
