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
    const bool without_sign = format.name == "TANGENT" && use == target;
    const bool without_alpha = format.name == "COLOR_" && rows(accessor) == 3;
    return columns(accessor) == 1 && (format_of(accessor) & format.allowed[use]) != 0 &&
           (rows(accessor) == format.rows - without_sign || without_alpha);
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

    void check(const Primitive& primitive) {
        if (primitive.attributes.empty()) return;
        const int position = attribute(primitive.attributes, "POSITION");
        const int first = position >= 0 ? position : primitive.attributes.begin()->second;
        const std::size_t vertices = accessors_[first].count;

        check_attributes(primitive.attributes, vertices, document_.quantized ? quantized : plain);
        each(".targets", primitive.targets, [&](const Attributes& differences) {
            check_attributes(differences, vertices, target);
            require_finite(attribute(differences, "POSITION"), "POSITION of vertex ");
        });
        if (position < 0) return;  // nothing will be drawn
        require_finite(position, "POSITION of vertex ");
        if (primitive.indices >= 0) check_indices(primitive.indices, vertices);
    }

    void check_copies(const Node& node) {
        check_attributes(copies_of(node), copy_count(document_, node), instance);
    }

    // Accessors of animations and skins, and those that nothing uses.
    void check_others() {
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            if (mended_[i]) continue;
            of_entry("accessors", i, [&] { require_finite(static_cast<int>(i), "element "); });
        }
    }

private:
    void check_attributes(const Attributes& attributes, std::size_t count, Use use) {
        for (const auto& [key, accessor] : attributes) {
            if (use != instance && key != "POSITION") mended_[accessor] = true;
            const Format* format = find_format(key, use);
            if (!format) continue;
            const Accessor& found = accessors_[accessor];
            const std::string name = printable(key) + " (" + entry("accessors", accessor) + ") ";
            require(is_allowed(*format, found, use), name,
                    "has a format that is not allowed there");
            require(found.count == count, name, "has ", found.count, " elements, there are ", count,
                    use == instance ? " copies" : " vertices");
        }
    }

    void check_indices(int accessor, std::size_t vertices) {
        const Accessor& declared = accessors_[accessor];
        require(declared.type == TINYGLTF_TYPE_SCALAR &&
                    format_of(declared) & (unsigned_integers | unsigned_units | long_integers),
                "has indices that are not unsigned integers");
        std::optional<std::uint32_t>& largest = largest_index_[accessor];
        if (!largest) {
            const AccessorReader reader(document_, declared);
            spend(reader.size(), most_indices, indices_read_);
            largest = 0;
            for (std::size_t i = 0; i < reader.size(); ++i) {
                largest = std::max(*largest, reader.integer(i));
            }
        }
        require(*largest < vertices, "names vertex ", *largest, ", there are ", vertices);
    }

    void require_finite(int accessor, const char* element) {
        if (accessor < 0 || finite_[accessor]) return;
        finite_[accessor] = true;
        const Accessor& declared = accessors_[accessor];
        const bool zeros = declared.bufferView < 0 && !declared.sparse.isSparse;
        if (zeros || format_of(declared) != floats) return;
        // check_accessors has bounded the count by the bytes that there are.
        spend(declared.count * rows(declared) * columns(declared), most_floats, floats_read_);
        const std::size_t bad = AccessorReader(document_, declared).first_not_finite();
        require(bad == declared.count, element, bad, " is not finite");
    }

    static void spend(std::size_t elements, std::size_t most, std::size_t& spent) {
        spent += elements;
        require(spent <= most, "reads too many elements, with those before it");
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
    each("meshes", document.model.meshes, [&](const Mesh& mesh) {
        each(".primitives", mesh.primitives, [&](const Primitive& p) { checker.check(p); });
    });
    each("nodes", document.model.nodes, [&](const Node& node) { checker.check_copies(node); });
    checker.check_others();
}

}  // namespace clgi::io::gltf
