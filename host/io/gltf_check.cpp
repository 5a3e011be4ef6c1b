// SPDX-License-Identifier: MIT
#include "io/gltf_check.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <initializer_list>
#include <optional>
#include <string_view>

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

bool is_tangent(const Accessor& accessor, bool quantized) {
    const bool signed_unit =
        accessor.normalized && is_one_of(accessor.component, {Component::int8, Component::int16});
    return is_vector(accessor, 4) && (is_float(accessor) || (quantized && signed_unit));
}

// Differences may be signed and, in KHR_mesh_quantization, of small integers.
bool is_difference(const Accessor& accessor, bool) {
    return is_vector(accessor, 3) && (is_float(accessor) || is_small_integer(accessor.component));
}

bool is_uv_difference(const Accessor& accessor, bool) {
    return is_vector(accessor, 2) && (is_float(accessor) || is_small_integer(accessor.component));
}

bool is_color_difference(const Accessor& accessor, bool) {
    const bool unit = accessor.normalized && is_small_integer(accessor.component);
    return (is_vector(accessor, 3) || is_vector(accessor, 4)) && (is_float(accessor) || unit);
}

using Format = bool (*)(const Accessor&, bool quantized);

struct Formats {
    std::string_view name;  // with '_' at its end: followed by a number
    Format vertex;
    Format target;  // null: not in morph targets
};
constexpr Formats formats[] = {
    {"POSITION", is_position, is_difference},  {"NORMAL", is_normal, is_difference},
    {"TANGENT", is_tangent, is_difference},    {"TEXCOORD_", is_uv, is_uv_difference},
    {"COLOR_", is_color, is_color_difference}, {"JOINTS_", is_joints, nullptr},
    {"WEIGHTS_", is_weights, nullptr}};

// Null for names that are not of the specification.
const Formats* find_formats(std::string_view name) {
    for (const Formats& entry : formats) {
        const bool numbered = entry.name.back() == '_' && name.starts_with(entry.name);
        if (numbered || name == entry.name) return &entry;
    }
    return nullptr;
}

bool is_indices(const Accessor& accessor) {
    return is_vector(accessor, 1) &&
           is_one_of(accessor.component, {Component::uint8, Component::uint16, Component::uint32});
}

// Elements to look through, more than scenes within max_triangles have. Accessors may overlap: a
// hundred thousand of them on the same megabytes would take hours.
constexpr std::size_t most_indices = std::size_t{1} << 28;
constexpr std::size_t most_floats = std::size_t{3} << 27;

class MeshChecker {
public:
    explicit MeshChecker(const Document& document)
        : document_(document),
          largest_index_(document.accessors.size()),
          finite_(document.accessors.size()),
          mended_(document.accessors.size()) {}

    void check(const Primitive& primitive, const std::string& name) {
        const Attributes& attributes = primitive.attributes;
        if (attributes.all.empty()) return;
        const int first =
            attributes.position >= 0 ? attributes.position : attributes.all[0].accessor;
        const std::size_t vertices = document_.accessors[first].count;

        for (const Attribute& each : attributes.all) {
            const Formats* allowed = find_formats(each.name);
            attribute(name + " ", each, vertices, allowed ? allowed->vertex : nullptr);
        }
        for (const MorphTarget& target : primitive.targets) {
            for (const Attribute& each : target.all) {
                const Formats* allowed = find_formats(each.name);
                attribute(name + " target ", each, vertices, allowed ? allowed->target : nullptr);
            }
            require_finite(name + " target POSITION of vertex ", target.position);
        }
        if (attributes.position < 0) return;  // nothing will be drawn
        require_finite(name + " POSITION of vertex ", attributes.position);
        indices(name, primitive.indices, vertices);
    }

    // Accessors of animations and skins, and those that nothing uses.
    void check_others() {
        for (std::size_t i = 0; i < document_.accessors.size(); ++i) {
            if (mended_[i]) continue;
            require_finite("accessors[" + std::to_string(i) + "] element ", static_cast<int>(i));
        }
    }

private:
    void attribute(const std::string& owner, const Attribute& each, std::size_t vertices,
                   Format is_allowed) {
        if (each.name != "POSITION") mended_[each.accessor] = true;
        if (!is_allowed) return;
        const Accessor& found = document_.accessors[each.accessor];
        const std::string reference =
            owner + each.name + " (accessors[" + std::to_string(each.accessor) + "])";
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

    // The name is followed by the number of an element.
    void require_finite(const std::string& name, int accessor) {
        if (accessor < 0 || finite_[accessor]) return;
        finite_[accessor] = true;
        const Accessor& declared = document_.accessors[accessor];
        const bool zeros = declared.view < 0 && !declared.sparse;
        if (zeros || !is_float(declared)) return;
        // check_accessors has bounded the count by the bytes that there are.
        const std::size_t floats = declared.count * (declared.element_bytes() / sizeof(float));
        spend(floats, most_floats, floats_read_, "accessors[" + std::to_string(accessor) + "]");
        const std::size_t bad = AccessorReader(document_, accessor).first_not_finite();
        if (bad < declared.count) throw InputError(name + std::to_string(bad) + " is not finite");
    }

    static void spend(std::size_t elements, std::size_t most, std::size_t& spent,
                      const std::string& name) {
        spent += elements;
        if (spent > most) throw InputError(name + ": too many elements");
    }

    const Document& document_;
    std::size_t indices_read_ = 0;
    std::size_t floats_read_ = 0;
    // Known once an accessor was read: thousands of primitives may share it.
    std::vector<std::optional<std::uint32_t>> largest_index_;
    std::vector<bool> finite_;
    std::vector<bool> mended_;  // used where numbers that are not finite are mended
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
    checker.check_others();
}

}  // namespace clgi::io::gltf
