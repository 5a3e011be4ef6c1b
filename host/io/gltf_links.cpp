// check_links: how the parts of a model fit each other.
// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

std::size_t targets_of(const Model& model, int mesh) {
    return model.meshes[mesh].primitives[0].targets.size();
}

void check_primitive(const Primitive& primitive, const Model& model) {
    const Attributes& attributes = primitive.attributes;
    bool joints = true;
    for (int set = 0; joints; ++set) {
        joints = attributes.contains("JOINTS_" + std::to_string(set));
        require(attributes.contains("WEIGHTS_" + std::to_string(set)) == joints,
                ".attributes has joints without weights or weights alone");
    }
    if (!extension(primitive.extensions, "KHR_draco_mesh_compression")) return;
    const int position = attribute(attributes, "POSITION");
    require(position >= 0 && model.accessors[position].bufferView >= 0,
            "needs KHR_draco_mesh_compression, which clgi does not read");
}

void check_mesh(const Mesh& mesh, const Model& model) {
    require(!mesh.primitives.empty(), ".primitives is empty");
    const std::size_t targets = mesh.primitives[0].targets.size();
    each(".primitives", mesh.primitives, [&](const Primitive& primitive) {
        check_primitive(primitive, model);
        require(primitive.targets.size() == targets,
                "has another number of morph targets than the first");
    });
    require(mesh.weights.empty() || mesh.weights.size() == targets, "has ", mesh.weights.size(),
            " weights for ", targets, " morph targets");
}

void check_node(const Node& node, const Model& model) {
    require(node.mesh >= 0 || node.skin < 0, "has a skin, but no mesh");
    if (node.weights.empty()) return;
    require(node.mesh >= 0, "has weights, but no mesh");
    const std::size_t targets = targets_of(model, node.mesh);
    require(node.weights.size() == targets, "has ", node.weights.size(), " weights, its mesh has ",
            targets, " morph targets");
}

void check_skin(const tinygltf::Skin& skin, const Model& model) {
    require(!skin.joints.empty(), ".joints is empty");
    if (skin.inverseBindMatrices < 0) return;
    const Accessor& accessor = model.accessors[skin.inverseBindMatrices];
    require(accessor.type == TINYGLTF_TYPE_MAT4 &&
                accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT,
            "has inverse bind matrices that are not 4x4 floats");
    require(accessor.count >= skin.joints.size(), "has ", accessor.count,
            " inverse bind matrices for ", skin.joints.size(), " joints");
}

void check_channel(const tinygltf::AnimationChannel& channel,
                   const tinygltf::AnimationSampler& curve, const Model& model) {
    static const std::map<std::string, std::size_t> rows_of = {
        {"translation", 3}, {"scale", 3}, {"rotation", 4}, {"weights", 1}};
    const auto expected = rows_of.find(channel.target_path);
    if (expected == rows_of.end() || channel.target_node < 0) return;  // of an extension
    const Accessor& output = model.accessors[curve.output];
    require(rows(output) == expected->second, "has key values of the wrong shape");

    // A cubic spline has a tangent, a value and a tangent a key.
    std::size_t values = curve.interpolation == "CUBICSPLINE" ? 3 : 1;
    if (channel.target_path == "weights") {
        const int mesh = model.nodes[channel.target_node].mesh;
        if (mesh < 0 || targets_of(model, mesh) == 0) return;
        values *= targets_of(model, mesh);
    }
    const std::size_t keys = model.accessors[curve.input].count;
    require(output.count / values == keys && output.count % values == 0, "has ", output.count,
            " values for ", keys, " keys");
}

// Animations are not played, but may not refer to what is not there.
void check_animation(const tinygltf::Animation& animation, const Model& model) {
    each(".samplers", animation.samplers, [&](const tinygltf::AnimationSampler& sampler) {
        const Accessor& input = model.accessors[sampler.input];
        require(input.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && rows(input) == 1,
                ".input is not an accessor of float scalars");
    });
    each(".channels", animation.channels, [&](const tinygltf::AnimationChannel& channel) {
        const auto sampler = static_cast<std::size_t>(channel.sampler);
        require(sampler < animation.samplers.size(), ".sampler is ", sampler, ", there are ",
                animation.samplers.size(), " samplers");
        check_channel(channel, animation.samplers[sampler], model);
    });
}

}  // namespace

void check_links(const Model& model) {
    each("meshes", model.meshes, [&](const Mesh& mesh) { check_mesh(mesh, model); });
    each("nodes", model.nodes, [&](const Node& node) { check_node(node, model); });
    each("skins", model.skins, [&](const tinygltf::Skin& skin) { check_skin(skin, model); });
    each("animations", model.animations,
         [&](const tinygltf::Animation& animation) { check_animation(animation, model); });
}

}  // namespace clgi::io::gltf
