// SPDX-License-Identifier: MIT
#include "io/gltf_instances.hpp"

#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_accessor.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

bool is_instanced(const Node& node) {
    return node.mesh >= 0 && extension(node.extensions, "EXT_mesh_gpu_instancing");
}

namespace {

struct Instancing {  // accessors, -1: none
    int translation = -1;
    int rotation = -1;
    int scale = -1;
};

Instancing instancing_of(const Node& node) {
    if (!is_instanced(node)) return {};
    const auto& attributes = node.extensions.at("EXT_mesh_gpu_instancing").Get("attributes");
    return {index_in(attributes, "TRANSLATION"), index_in(attributes, "ROTATION"),
            index_in(attributes, "SCALE")};
}

}  // namespace

std::size_t instance_count(const Document& document, const Node& node) {
    const Instancing instancing = instancing_of(node);
    for (const int accessor : {instancing.translation, instancing.rotation, instancing.scale}) {
        if (accessor >= 0) return document.model.accessors[accessor].count;
    }
    return 1;
}

glm::dmat4 instance_matrix(const Document& document, int node, std::size_t instance) {
    if (!is_instanced(document.model.nodes[node])) return document.matrices[node];
    const Instancing instancing = instancing_of(document.model.nodes[node]);
    glm::dmat4 local(1.0);
    if (instancing.rotation >= 0) {
        const glm::dvec4 q = AccessorReader(document, instancing.rotation).vec4(instance);
        const double length = glm::length(q);
        if (length > 1e-6 && length < 1e6) {
            local = glm::mat4_cast(glm::dquat(q.w, q.x, q.y, q.z) / length);
        }
    }
    if (instancing.scale >= 0) {
        const glm::dvec3 scale = AccessorReader(document, instancing.scale).vec3(instance);
        for (int column = 0; column < 3; ++column) local[column] *= scale[column];
    }
    if (instancing.translation >= 0) {
        local[3] = glm::dvec4(AccessorReader(document, instancing.translation).vec3(instance), 1.0);
    }
    return document.matrices[node] * local;
}

void check_instancing(const Document& document) {
    for (const Node& node : document.model.nodes) {
        const Instancing instancing = instancing_of(node);
        std::size_t count = 0;
        const auto check = [&](int index, int type, bool integers) {
            if (index < 0) return;
            const Accessor& accessor = document.model.accessors[index];
            const bool normalized =
                accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE ||
                                        accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT);
            const std::string name = "EXT_mesh_gpu_instancing: " + entry("accessors", index);
            if (accessor.type != type || (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT &&
                                          !(integers && normalized))) {
                throw InputError(name + " has a format that is not allowed there");
            }
            if (count == 0) count = accessor.count;
            if (accessor.count != count) throw InputError(name + " has another length");
        };
        check(instancing.translation, TINYGLTF_TYPE_VEC3, false);
        check(instancing.rotation, TINYGLTF_TYPE_VEC4, true);
        check(instancing.scale, TINYGLTF_TYPE_VEC3, false);
    }
}

}  // namespace clgi::io::gltf
