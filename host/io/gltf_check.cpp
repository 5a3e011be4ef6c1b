// Checks of the model: how its parts fit each other, and what the buffers hold.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <string_view>

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
    if (draco_codec.built || !extension(primitive.extensions, draco_codec.extension)) return;
    const int position = attribute(attributes, "POSITION");
    if (position < 0 || model.accessors[position].bufferView < 0) {
        fail("needs ", missing(draco_codec));
    }
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

void check_channel(const tinygltf::AnimationChannel& channel,
                   const tinygltf::AnimationSampler& curve, const Model& model) {
    static const std::map<std::string, std::pair<std::size_t, unsigned>> rows_and_formats = {
        {"translation", {3, floats}},
        {"scale", {3, floats}},
        {"rotation", {4, any_unit}},
        {"weights", {1, any_unit}}};
    const auto expected = rows_and_formats.find(channel.target_path);
    if (expected == rows_and_formats.end() || channel.target_node < 0) return;  // of an extension
    const auto [height, formats] = expected->second;
    const Accessor& output = model.accessors[curve.output];
    require(rows(output) == height && columns(output) == 1, "has key values of the wrong shape");
    require((format_of(output) & formats) != 0, "has key values of a format that is not allowed");

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

// Animations may be left out when the scene is loaded, but may not refer to what is not there.
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
          sanitised_(accessors_.size()),
          needed_(accessors_.size()) {}

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

    // Animations that hold such numbers are left out.
    void pass_over(const tinygltf::Animation& animation) {
        for (const tinygltf::AnimationSampler& sampler : animation.samplers)
            sanitised_[sampler.input] = sanitised_[sampler.output] = true;
    }

    void need(const tinygltf::Skin& skin) {
        if (skin.inverseBindMatrices >= 0) needed_[skin.inverseBindMatrices] = true;
    }

    // Accessors of skins and copies, and those that nothing uses.
    void check_others() {
        for (std::size_t i = 0; i < accessors_.size(); ++i) {
            if (sanitised_[i] && !needed_[i]) continue;
            of_entry("accessors", i, [&] { require_finite(static_cast<int>(i), "element "); });
        }
    }

private:
    void check_attributes(const Attributes& attributes, std::size_t count, Use use) {
        for (const auto& [key, accessor] : attributes) {
            if (use == instance) needed_[accessor] = true;
            if (use != instance && key != "POSITION") sanitised_[accessor] = true;
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
    std::vector<bool> sanitised_;  // used where numbers that are not finite are sanitised
    std::vector<bool> needed_;     // used where they cannot be
};

}  // namespace

void check_links(const Model& model) {
    each("meshes", model.meshes, [&](const Mesh& mesh) { check_mesh(mesh, model); });
    each("nodes", model.nodes, [&](const Node& node) { check_node(node, model); });
    each("skins", model.skins, [&](const tinygltf::Skin& skin) { check_skin(skin, model); });
    each("animations", model.animations,
         [&](const tinygltf::Animation& animation) { check_animation(animation, model); });
}

void check_meshes(const Document& document) {
    MeshChecker checker(document);
    each("meshes", document.model.meshes, [&](const Mesh& mesh) {
        each(".primitives", mesh.primitives, [&](const Primitive& p) { checker.check(p); });
    });
    each("nodes", document.model.nodes, [&](const Node& node) { checker.check_copies(node); });
    for (const tinygltf::Animation& animation : document.model.animations)
        checker.pass_over(animation);
    for (const tinygltf::Skin& skin : document.model.skins) checker.need(skin);
    checker.check_others();
}

}  // namespace clgi::io::gltf
