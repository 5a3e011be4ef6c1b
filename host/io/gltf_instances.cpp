// SPDX-License-Identifier: MIT
#include "io/gltf_instances.hpp"

#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

std::size_t instance_count(const Document& document, const Node& node) {
    if (node.instancing < 0) return 1;
    const Instancing& instancing = document.instancing[node.instancing];
    for (const int accessor : {instancing.translation, instancing.rotation, instancing.scale}) {
        if (accessor >= 0) return document.accessors[accessor].count;
    }
    return 1;
}

glm::dmat4 instance_matrix(const Document& document, const Node& node, std::size_t instance) {
    if (node.instancing < 0) return node.matrix;
    const Instancing& instancing = document.instancing[node.instancing];
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
    return node.matrix * local;
}

void check_instancing(const Document& document) {
    for (const Instancing& instancing : document.instancing) {
        std::size_t count = 0;
        const auto check = [&](int index, int rows, bool integers) {
            if (index < 0) return;
            const Accessor& accessor = document.accessors[index];
            const bool normalized = accessor.normalized && (accessor.component == Component::int8 ||
                                                            accessor.component == Component::int16);
            const std::string name =
                "EXT_mesh_gpu_instancing: accessors[" + std::to_string(index) + "]";
            if (accessor.columns != 1 || accessor.rows != rows ||
                (accessor.component != Component::float32 && !(integers && normalized))) {
                throw InputError(name + " has a format that is not allowed there");
            }
            if (count == 0) count = accessor.count;
            if (accessor.count != count) throw InputError(name + " has another length");
        };
        check(instancing.translation, 3, false);
        check(instancing.rotation, 4, true);
        check(instancing.scale, 3, false);
    }
}

}  // namespace clgi::io::gltf
