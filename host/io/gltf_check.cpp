// check_meshes: what the buffers hold.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <string_view>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

// Formats of components as bits; which of the two an integer is depends on "normalized".
enum : unsigned {
    floats = 1,
    unsigned_integers = 2,  // of 8 or 16 bits
    unsigned_units = 4,
    signed_integers = 8,
    signed_units = 16,
    long_integers = 32,
    any_unit = floats | unsigned_units | signed_units,
    any_small = any_unit | unsigned_integers | signed_integers,
    joints = unsigned_integers | unsigned_units,
    unit_floats = floats | unsigned_units,
    signed_floats = floats | signed_units
};

unsigned format_of(const Accessor& accessor) {
    const int type = accessor.componentType;
    if (type == TINYGLTF_COMPONENT_TYPE_FLOAT) return floats;
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return long_integers;
    const bool has_sign =
        type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT;
    if (accessor.normalized) return has_sign ? signed_units : unsigned_units;
    return has_sign ? signed_integers : unsigned_integers;
}

enum Use { plain, quantized, target, instance };

// allowed[use] is 0 where the specification knows no such attribute.
struct Format {
    std::string_view name;  // with '_' at its end: followed by a number
    std::size_t rows;
    unsigned allowed[4];
};
constexpr Format formats[] = {{"POSITION", 3, {floats, any_small, any_small, 0}},
                              {"NORMAL", 3, {floats, signed_floats, any_small, 0}},
                              {"TANGENT", 4, {floats, signed_floats, any_small, 0}},
                              {"TEXCOORD_", 2, {unit_floats, any_small, any_small, 0}},
                              {"COLOR_", 4, {unit_floats, unit_floats, any_unit, 0}},
                              {"JOINTS_", 4, {joints, joints, 0, 0}},
                              {"WEIGHTS_", 4, {unit_floats, unit_floats, 0, 0}},
                              {"TRANSLATION", 3, {0, 0, 0, floats}},
                              {"ROTATION", 4, {0, 0, 0, signed_floats}},
                              {"SCALE", 3, {0, 0, 0, floats}}};

// Null for names that are not of the specification, which may look like anything.
const Format* find_format(std::string_view name, Use use) {
    for (const Format& format : formats) {
        const bool numbered = format.name.back() == '_' && name.starts_with(format.name);
        if ((numbered || name == format.name) && format.allowed[use]) return &format;
    }
    return nullptr;
}

bool is_allowed(const Format& format, const Accessor& accessor, Use use) {
    const Layout layout(accessor);
    const bool without_sign = format.name == "TANGENT" && use == target;
    const bool without_alpha = format.name == "COLOR_" && layout.rows == 3;
    return layout.columns == 1 && (layout.rows == format.rows - without_sign || without_alpha) &&
           (format_of(accessor) & format.allowed[use]) != 0;
}

// Elements to look through, more than scenes within max_triangles have. Accessors may overlap: a
// hundred thousand of them on the same megabytes would take hours.
constexpr std::size_t most_indices = std::size_t{1} << 28;
constexpr std::size_t most_floats = std::size_t{3} << 27;

class MeshChecker {
public:
    explicit MeshChecker(const Document& document)
        : document_(document),
          accessors_(document.model.accessors),
          largest_index_(accessors_.size()),
          finite_(accessors_.size()),
          mended_(accessors_.size()) {}

    void check(const Primitive& primitive, const std::string& name) {
        if (primitive.attributes.empty()) return;
        const int position = attribute(primitive.attributes, "POSITION");
        const int first = position >= 0 ? position : primitive.attributes.begin()->second;
        const std::size_t vertices = accessors_[first].count;

        const Use use = document_.quantized ? quantized : plain;
        check_attributes(name, primitive.attributes, vertices, use);
        for (const auto& differences : primitive.targets) {
            check_attributes(name + " target", differences, vertices, target);
            require_finite(name + " target POSITION of vertex ",
                           attribute(differences, "POSITION"));
        }
        if (position < 0) return;  // nothing will be drawn
        require_finite(name + " POSITION of vertex ", position);
        if (primitive.indices >= 0) check_indices(name, primitive.indices, vertices);
    }

    void check_copies(const Node& node, const std::string& name) {
        const auto attributes = copies_of(node);
        for (const char* first : {"TRANSLATION", "ROTATION", "SCALE"}) {
            const int accessor = attribute(attributes, first);
            if (accessor < 0) continue;
            return check_attributes(name, attributes, accessors_[accessor].count, instance);
        }
    }

    // Accessors of animations and skins, and those that nothing uses.
    void check_others() {
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            if (mended_[i]) continue;
            require_finite(entry("accessors", i) + " element ", static_cast<int>(i));
        }
    }

private:
    void check_attributes(const std::string& owner, const Attributes& attributes, std::size_t count,
                          Use use) {
        for (const auto& [key, accessor] : attributes) {
            if (use != instance && key != "POSITION") mended_[accessor] = true;
            const Format* format = find_format(key, use);
            if (!format) continue;
            const Accessor& found = accessors_[accessor];
            const std::string reference =
                owner + " " + printable(key) + " (" + entry("accessors", accessor) + ")";
            if (!is_allowed(*format, found, use)) {
                refuse(reference, "has a format that is not allowed there");
            }
            if (found.count != count) {
                refuse(reference, "has " + std::to_string(found.count) + " elements, there are " +
                                      std::to_string(count) +
                                      (use == instance ? " copies" : " vertices"));
            }
        }
    }

    void check_indices(const std::string& name, int accessor, std::size_t vertices) {
        const Accessor& declared = accessors_[accessor];
        if (declared.type != TINYGLTF_TYPE_SCALAR ||
            !(format_of(declared) & (unsigned_integers | unsigned_units | long_integers))) {
            refuse(name, "has indices that are not unsigned integers");
        }
        std::optional<std::uint32_t>& largest = largest_index_[accessor];
        if (!largest) {
            const AccessorReader reader(document_, accessor);
            spend(reader.size(), most_indices, indices_read_, name);
            largest = 0;
            for (std::size_t i = 0; i < reader.size(); ++i) {
                largest = std::max(*largest, reader.integer(i));
            }
        }
        if (*largest >= vertices) {
            refuse(name, "names vertex " + std::to_string(*largest) + ", there are " +
                             std::to_string(vertices));
        }
    }

    // The name is followed by the number of an element.
    void require_finite(const std::string& name, int accessor) {
        if (accessor < 0 || finite_[accessor]) return;
        finite_[accessor] = true;
        const Accessor& declared = accessors_[accessor];
        const bool zeros = declared.bufferView < 0 && !declared.sparse.isSparse;
        if (zeros || format_of(declared) != floats) return;
        // check_accessors has bounded the count by the bytes that there are.
        const std::size_t read = declared.count * (Layout(declared).bytes / sizeof(float));
        spend(read, most_floats, floats_read_, entry("accessors", accessor));
        const std::size_t bad = AccessorReader(document_, accessor).first_not_finite();
        if (bad < declared.count) throw InputError(name + std::to_string(bad) + " is not finite");
    }

    static void spend(std::size_t elements, std::size_t most, std::size_t& spent,
                      const std::string& name) {
        spent += elements;
        if (spent > most) throw InputError(name + ": too many elements");
    }

    const Document& document_;
    const std::vector<Accessor>& accessors_;
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
    for (std::size_t i = 0; i < document.model.meshes.size(); ++i) {
        const std::vector<Primitive>& primitives = document.model.meshes[i].primitives;
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            checker.check(primitives[k], entry("meshes", i) + entry(".primitives", k));
        }
    }
    for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
        checker.check_copies(document.model.nodes[i], entry("nodes", i));
    }
    checker.check_others();
}

}  // namespace clgi::io::gltf
