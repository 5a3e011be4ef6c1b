// Meshes as the JSON declares them.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

// Every attribute counts, also those that are not used here.
std::vector<Attribute> read_all(const Value& value, std::size_t accessors) {
    std::vector<Attribute> all;
    for (const auto& [name, member] : value.members()) {
        all.push_back({printable(name), member.index(accessors, "accessors")});
    }
    return all;
}

Attributes read_attributes(const Value& value, std::size_t accessors) {
    Attributes attributes;
    attributes.all = read_all(value, accessors);
    const auto accessor = [&](const char* key) {
        return value.index_or_none(key, accessors, "accessors");
    };
    attributes.position = accessor("POSITION");
    attributes.normal = accessor("NORMAL");
    attributes.uv[0] = accessor("TEXCOORD_0");
    attributes.uv[1] = accessor("TEXCOORD_1");
    attributes.color = accessor("COLOR_0");
    for (int set = 0;; ++set) {
        const int joints = accessor(("JOINTS_" + std::to_string(set)).c_str());
        const int weights = accessor(("WEIGHTS_" + std::to_string(set)).c_str());
        if (joints < 0 && weights < 0) break;
        if (joints < 0 || weights < 0) value.fail("has joints without weights or weights alone");
        attributes.joints.push_back(joints);
        attributes.weights.push_back(weights);
    }
    return attributes;
}

Primitive read_primitive(const Value& value, const Document& document) {
    Primitive primitive;
    const std::size_t accessors = document.accessors.size();
    primitive.attributes = read_attributes(value.at("attributes"), accessors);
    primitive.indices = value.index_or_none("indices", accessors, "accessors");
    primitive.material = value.index_or_none("material", document.materials.size(), "materials");
    const std::uint64_t mode = value.integer_or("mode", 4);
    if (mode > 6) value.at("mode").fail("is " + std::to_string(mode) + ", no primitive mode");
    primitive.mode = static_cast<Mode>(mode);

    if (const auto targets = value.find("targets")) {
        for (std::size_t i = 0; i < targets->count(); ++i) {
            const Value target = targets->item(i);
            primitive.targets.push_back({read_all(target, accessors),
                                         target.index_or_none("POSITION", accessors, "accessors"),
                                         target.index_or_none("NORMAL", accessors, "accessors")});
        }
    }
    if (value.extension("KHR_draco_mesh_compression")) {
        const int position = primitive.attributes.position;
        if (position < 0 || document.accessors[position].view < 0) {
            value.fail("needs KHR_draco_mesh_compression, which clgi does not read");
        }
    }
    return primitive;
}

Mesh read_mesh(const Value& value, const Document& document) {
    Mesh mesh;
    mesh.name = value.name_or_empty();
    if (const auto weights = value.find("weights")) mesh.weights = weights->numbers();
    const Value primitives = value.at("primitives");
    if (primitives.count() == 0) primitives.fail("is empty");
    for (std::size_t i = 0; i < primitives.count(); ++i) {
        mesh.primitives.push_back(read_primitive(primitives.item(i), document));
        if (mesh.primitives[i].targets.size() != mesh.primitives[0].targets.size()) {
            primitives.item(i).fail("has another number of morph targets than the first");
        }
    }
    const std::size_t targets = mesh.primitives[0].targets.size();
    if (!mesh.weights.empty() && mesh.weights.size() != targets) {
        value.fail("has " + std::to_string(mesh.weights.size()) + " weights for " +
                   std::to_string(targets) + " morph targets");
    }
    return mesh;
}

}  // namespace

void read_meshes(const Value& root, Document& document) {
    const std::size_t meshes = entries(root, "meshes");
    for (std::size_t i = 0; i < meshes; ++i) {
        document.meshes.push_back(read_mesh(root.at("meshes").item(i), document));
    }
}

}  // namespace clgi::io::gltf
