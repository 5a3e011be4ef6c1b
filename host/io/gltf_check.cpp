// SPDX-License-Identifier: MIT
#include "io/gltf_check.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

bool is_one_of(Component component, std::initializer_list<Component> allowed) {
    for (const Component candidate : allowed) {
        if (component == candidate) return true;
    }
    return false;
}

bool is_vector(const Accessor& accessor, int rows) {
    return accessor.columns == 1 && accessor.rows == rows;
}

bool is_small_integer(Component component) {
    return is_one_of(component,
                     {Component::int8, Component::uint8, Component::int16, Component::uint16});
}

bool is_float(const Accessor& accessor) { return accessor.component == Component::float32; }

bool is_unsigned_unit(const Accessor& accessor) {
    return is_float(accessor) ||
           (accessor.normalized &&
            is_one_of(accessor.component, {Component::uint8, Component::uint16}));
}

bool is_position(const Accessor& accessor, bool quantized) {
    return is_vector(accessor, 3) &&
           (is_float(accessor) || (quantized && is_small_integer(accessor.component)));
}

bool is_normal(const Accessor& accessor, bool quantized) {
    const bool signed_unit =
        accessor.normalized && is_one_of(accessor.component, {Component::int8, Component::int16});
    return is_vector(accessor, 3) && (is_float(accessor) || (quantized && signed_unit));
}

bool is_uv(const Accessor& accessor, bool quantized) {
    return is_vector(accessor, 2) &&
           (is_unsigned_unit(accessor) || (quantized && is_small_integer(accessor.component)));
}

bool is_color(const Accessor& accessor, bool) {
    return (is_vector(accessor, 3) || is_vector(accessor, 4)) && is_unsigned_unit(accessor);
}

bool is_joints(const Accessor& accessor, bool) {
    return is_vector(accessor, 4) &&
           is_one_of(accessor.component, {Component::uint8, Component::uint16});
}

bool is_weights(const Accessor& accessor, bool) {
    return is_vector(accessor, 4) && is_unsigned_unit(accessor);
}

// Differences may be signed and, in KHR_mesh_quantization, of small integers.
bool is_difference(const Accessor& accessor, bool) {
    return is_vector(accessor, 3) && (is_float(accessor) || is_small_integer(accessor.component));
}

bool is_indices(const Accessor& accessor) {
    return is_vector(accessor, 1) &&
           is_one_of(accessor.component, {Component::uint8, Component::uint16, Component::uint32});
}

// Elements to look through, more than scenes within max_triangles have. Accessors may overlap: a
// hundred thousand of them on the same megabytes would take hours.
constexpr std::size_t most_indices = std::size_t{1} << 28;
constexpr std::size_t most_positions = std::size_t{1} << 27;

class MeshChecker {
public:
    explicit MeshChecker(const Document& document)
        : document_(document),
          largest_index_(document.accessors.size()),
          finite_(document.accessors.size()) {}

    void check(const Primitive& primitive, const std::string& name) {
        const Attributes& attributes = primitive.attributes;
        if (attributes.position < 0) return;  // nothing will be drawn
        const std::size_t vertices = document_.accessors[attributes.position].count;

        attribute(name + " POSITION", attributes.position, vertices, is_position);
        attribute(name + " NORMAL", attributes.normal, vertices, is_normal);
        attribute(name + " TEXCOORD_0", attributes.uv[0], vertices, is_uv);
        attribute(name + " TEXCOORD_1", attributes.uv[1], vertices, is_uv);
        attribute(name + " COLOR_0", attributes.color, vertices, is_color);
        for (const int joints : attributes.joints) {
            attribute(name + " JOINTS", joints, vertices, is_joints);
        }
        for (const int weights : attributes.weights) {
            attribute(name + " WEIGHTS", weights, vertices, is_weights);
        }
        for (const MorphTarget& target : primitive.targets) {
            attribute(name + " target POSITION", target.position, vertices, is_difference);
            attribute(name + " target NORMAL", target.normal, vertices, is_difference);
            require_finite(name + " target POSITION", target.position);
        }
        require_finite(name + " POSITION", attributes.position);
        indices(name, primitive.indices, vertices);
    }

private:
    template <typename Format>
    void attribute(const std::string& name, int accessor, std::size_t vertices, Format is_allowed) {
        if (accessor < 0) return;
        const Accessor& found = document_.accessors[accessor];
        const std::string reference = name + " (accessors[" + std::to_string(accessor) + "])";
        if (!is_allowed(found, document_.quantized)) {
            throw InputError(reference + " has a format that is not allowed there");
        }
        if (found.count != vertices) {
            throw InputError(reference + " has " + std::to_string(found.count) +
                             " elements, there are " + std::to_string(vertices) + " vertices");
        }
    }

    void indices(const std::string& name, int accessor, std::size_t vertices) {
        if (accessor < 0) return;
        if (!is_indices(document_.accessors[accessor])) {
            throw InputError(name + " has indices that are not unsigned integers");
        }
        std::optional<std::uint32_t>& largest = largest_index_[accessor];
        if (!largest) {
            const AccessorReader reader(document_, accessor);
            spend(reader.size(), most_indices, indices_read_, name);
            std::uint32_t seen = 0;
            for (std::size_t i = 0; i < reader.size(); ++i) {
                seen = std::max(seen, reader.integer(i));
            }
            largest = seen;
        }
        if (*largest >= vertices) {
            throw InputError(name + " names vertex " + std::to_string(*largest) + ", there are " +
                             std::to_string(vertices));
        }
    }

    void require_finite(const std::string& name, int accessor) {
        if (accessor < 0 || finite_[accessor]) return;
        const AccessorReader reader(document_, accessor);
        spend(reader.size(), most_positions, positions_read_, name);
        for (std::size_t i = 0; i < reader.size(); ++i) {
            for (std::size_t component = 0; component < 3; ++component) {
                if (std::isfinite(reader.number(i, component))) continue;
                throw InputError(name + " of vertex " + std::to_string(i) + " is not finite");
            }
        }
        finite_[accessor] = true;
    }

    static void spend(std::size_t elements, std::size_t most, std::size_t& spent,
                      const std::string& name) {
        spent += elements;
        if (spent > most) throw InputError(name + ": too many elements");
    }

    const Document& document_;
    std::size_t indices_read_ = 0;
    std::size_t positions_read_ = 0;
    // Known once an accessor was read: thousands of primitives may share it.
    std::vector<std::optional<std::uint32_t>> largest_index_;
    std::vector<bool> finite_;
};

}  // namespace

void check_meshes(const Document& document) {
    MeshChecker checker(document);
    for (std::size_t i = 0; i < document.meshes.size(); ++i) {
        for (std::size_t k = 0; k < document.meshes[i].primitives.size(); ++k) {
            checker.check(
                document.meshes[i].primitives[k],
                "meshes[" + std::to_string(i) + "].primitives[" + std::to_string(k) + "]");
        }
    }
}

}  // namespace clgi::io::gltf
