// SPDX-License-Identifier: MIT
#include "io/gltf_check.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <optional>
#include <string_view>

#include "io/gltf_accessor.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

// Formats of components as bits; which of the two an integer is depends on "normalized".
constexpr unsigned floats = 1;
constexpr unsigned unsigned_integers = 2;  // of 8 or 16 bits
constexpr unsigned unsigned_units = 4;
constexpr unsigned signed_integers = 8;
constexpr unsigned signed_units = 16;
constexpr unsigned any_unit = floats | unsigned_units | signed_units;
constexpr unsigned any_small = any_unit | unsigned_integers | signed_integers;

unsigned format_of(const Accessor& accessor) {
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return floats;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return accessor.normalized ? unsigned_units : unsigned_integers;
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return accessor.normalized ? signed_units : signed_integers;
        default:
            return 0;
    }
}

struct Format {
    std::string_view name;  // with '_' at its end: followed by a number
    std::size_t rows;
    unsigned plain;
    unsigned quantized;  // with KHR_mesh_quantization
    unsigned target;     // of the differences in a morph target; 0: not there
    std::size_t target_rows;
};
constexpr Format formats[] = {
    {"POSITION", 3, floats, any_small, any_small, 3},
    {"NORMAL", 3, floats, floats | signed_units, any_small, 3},
    {"TANGENT", 4, floats, floats | signed_units, any_small, 3},
    {"TEXCOORD_", 2, floats | unsigned_units, any_small, any_small, 2},
    {"COLOR_", 4, floats | unsigned_units, floats | unsigned_units, any_unit, 4},
    {"JOINTS_", 4, unsigned_integers | unsigned_units, unsigned_integers | unsigned_units, 0, 0},
    {"WEIGHTS_", 4, floats | unsigned_units, floats | unsigned_units, 0, 0}};

// Null for names that are not of the specification, which may look like anything.
const Format* find_format(std::string_view name, bool target) {
    for (const Format& format : formats) {
        const bool numbered = format.name.back() == '_' && name.starts_with(format.name);
        if (numbered || name == format.name) return target && !format.target ? nullptr : &format;
    }
    return nullptr;
}

bool is_allowed(const Format& format, const Accessor& accessor, bool target, bool quantized) {
    const std::size_t expected = target ? format.target_rows : format.rows;
    const bool without_alpha = format.name == "COLOR_" && rows(accessor) == 3;
    const unsigned allowed = target ? format.target : quantized ? format.quantized : format.plain;
    return columns(accessor) == 1 && (rows(accessor) == expected || without_alpha) &&
           (format_of(accessor) & allowed) != 0;
}

bool is_indices(const Accessor& accessor) {
    return accessor.type == TINYGLTF_TYPE_SCALAR &&
           (format_of(accessor) == unsigned_integers || format_of(accessor) == unsigned_units ||
            accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
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

        check_attributes(name, primitive.attributes, vertices, false);
        for (const auto& target : primitive.targets) {
            check_attributes(name + " target", target, vertices, true);
            require_finite(name + " target POSITION of vertex ", attribute(target, "POSITION"));
        }
        if (position < 0) return;  // nothing will be drawn
        require_finite(name + " POSITION of vertex ", position);
        check_indices(name, primitive.indices, vertices);
    }

    // Accessors of animations and skins, and those that nothing uses.
    void check_others() {
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            if (mended_[i]) continue;
            require_finite(entry("accessors", i) + " element ", static_cast<int>(i));
        }
    }

private:
    void check_attributes(const std::string& owner, const std::map<std::string, int>& attributes,
                          std::size_t vertices, bool target) {
        for (const auto& [key, accessor] : attributes) {
            if (key != "POSITION") mended_[accessor] = true;
            const Format* format = find_format(key, target);
            if (!format) continue;
            const Accessor& found = accessors_[accessor];
            const std::string reference =
                owner + " " + printable(key) + " (" + entry("accessors", accessor) + ")";
            if (!is_allowed(*format, found, target, document_.quantized)) {
                throw InputError(reference + " has a format that is not allowed there");
            }
            if (found.count != vertices) {
                throw InputError(reference + " has " + std::to_string(found.count) +
                                 " elements, there are " + std::to_string(vertices) + " vertices");
            }
        }
    }

    void check_indices(const std::string& name, int accessor, std::size_t vertices) {
        if (accessor < 0) return;
        if (!is_indices(accessors_[accessor])) {
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
        const Accessor& declared = accessors_[accessor];
        const bool zeros = declared.bufferView < 0 && !declared.sparse.isSparse;
        if (zeros || format_of(declared) != floats) return;
        // check_accessors has bounded the count by the bytes that there are.
        const std::size_t read = declared.count * (element_bytes(declared) / sizeof(float));
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
    checker.check_others();
}

}  // namespace clgi::io::gltf
