// Nodes, skins and scenes as the JSON declares them.
// SPDX-License-Identifier: MIT
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

glm::dmat4 read_transform(const Value& value, Warnings& warnings) {
    if (const auto matrix = value.find("matrix")) {
        const std::vector<double> m = matrix->numbers(16);  // by columns, as glm has them
        glm::dmat4 transform;
        for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = m[i];
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            warnings.add("a node matrix with a projective row is read without it");
            for (int column = 0; column < 4; ++column) transform[column][3] = column == 3;
        }
        return transform;
    }
    const glm::dvec3 translation = value.vec3_or("translation", glm::dvec3(0.0));
    const glm::dvec3 scale = value.vec3_or("scale", glm::dvec3(1.0));
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    if (const auto member = value.find("rotation")) {
        const std::vector<double> q = member->numbers(4);
        const glm::dquat read(q[3], q[0], q[1], q[2]);
        const double length = glm::length(read);
        if (length > 1e-6 && length < 1e6) {
            rotation = read / length;
        } else {
            warnings.add("a node rotation that is no quaternion is ignored");
        }
    }
    glm::dmat4 transform = glm::mat4_cast(rotation);
    for (int column = 0; column < 3; ++column) transform[column] *= scale[column];
    transform[3] = glm::dvec4(translation, 1.0);
    return transform;
}

int read_instancing(const Value& value, Document& document) {
    const auto extension = value.extension("EXT_mesh_gpu_instancing");
    if (!extension) return -1;
    const Value attributes = extension->at("attributes");
    const std::size_t accessors = document.accessors.size();
    for (const auto& [name, member] : attributes.members()) member.index(accessors, "accessors");
    document.instancing.push_back({attributes.index_or_none("TRANSLATION", accessors, "accessors"),
                                   attributes.index_or_none("ROTATION", accessors, "accessors"),
                                   attributes.index_or_none("SCALE", accessors, "accessors")});
    return static_cast<int>(document.instancing.size()) - 1;
}

Node read_node(const Value& value, std::size_t nodes, std::size_t skins, Document& document) {
    Node node;
    node.name = value.name_or_empty();
    node.matrix = read_transform(value, document.warnings);
    if (const auto children = value.find("children")) {
        node.children = children->indices(nodes, "nodes");
    }
    node.mesh = value.index_or_none("mesh", document.meshes.size(), "meshes");
    node.skin = value.index_or_none("skin", skins, "skins");
    node.camera = value.index_or_none("camera", document.cameras.size(), "cameras");
    if (const auto light = value.extension("KHR_lights_punctual")) {
        node.light = light->at("light").index(document.lights.size(), "lights");
    }
    if (const auto weights = value.find("weights")) node.weights = weights->numbers();

    if (node.mesh < 0) {
        if (node.skin >= 0) value.fail("has a skin, but no mesh");
        if (!node.weights.empty()) value.fail("has weights, but no mesh");
        return node;
    }
    const std::size_t targets = document.meshes[node.mesh].primitives[0].targets.size();
    if (!node.weights.empty() && node.weights.size() != targets) {
        value.fail("has " + std::to_string(node.weights.size()) + " weights, its mesh has " +
                   std::to_string(targets) + " morph targets");
    }
    node.instancing = read_instancing(value, document);
    return node;
}

Skin read_skin(const Value& value, const Document& document, std::size_t nodes) {
    Skin skin;
    const Value joints = value.at("joints");
    skin.joints = joints.indices(nodes, "nodes");
    if (skin.joints.empty()) joints.fail("is empty");
    value.index_or_none("skeleton", nodes, "nodes");
    skin.inverse_bind =
        value.index_or_none("inverseBindMatrices", document.accessors.size(), "accessors");
    if (skin.inverse_bind < 0) return skin;

    const Accessor& accessor = document.accessors[skin.inverse_bind];
    if (accessor.columns != 4 || accessor.component != Component::float32) {
        value.fail("has inverse bind matrices that are not 4x4 floats");
    }
    if (accessor.count < skin.joints.size()) {
        value.fail("has " + std::to_string(accessor.count) + " inverse bind matrices for " +
                   std::to_string(skin.joints.size()) + " joints");
    }
    return skin;
}

}  // namespace

void read_nodes(const Value& root, Document& document) {
    const std::size_t nodes = entries(root, "nodes");
    const std::size_t skins = entries(root, "skins", max_rare_entries);
    for (std::size_t i = 0; i < skins; ++i) {
        document.skins.push_back(read_skin(root.at("skins").item(i), document, nodes));
    }
    document.nodes.reserve(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        document.nodes.push_back(read_node(root.at("nodes").item(i), nodes, skins, document));
    }
    const std::size_t scenes = entries(root, "scenes", max_rare_entries);
    for (std::size_t i = 0; i < scenes; ++i) {
        const Value value = root.at("scenes").item(i);
        SceneRoots scene;
        scene.name = value.name_or_empty();
        if (const auto roots = value.find("nodes")) scene.nodes = roots->indices(nodes, "nodes");
        document.scenes.push_back(std::move(scene));
    }
    document.default_scene = root.index_or_none("scene", scenes, "scenes");
}

}  // namespace clgi::io::gltf
