// guard: what stands before tinygltf. tinygltf 2.7 takes what is not of its kind as absent, cuts
// large numbers to 32 bits, aborts on materials that are no objects, and reads past its arrays.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <climits>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

// What glTF 2.0 asks of the members that clgi and tinygltf read: an example of a document that has
// "kind arguments" in place of its values.
//   "name!"         the member may not be absent where what holds it is there
//   "*", "*Texture" every other member whose name ends so
//   [kind, most]    an array of at most so many entries, 2^20 if nothing is said: a million empty
//                   objects take three megabytes of text, and a hundred times that as nodes
//   flag, text, number, above_zero, not_negative
//   whole, count    a whole number, at least 0 or 1; int: one that fits into an int
//   numbers 3       an array of so many numbers; of any number without the 3
//   code, word      a whole number or a string that is among the arguments
//   index nodes     into that array of the root
//   $texture        what the schema says under that name
constexpr const char* schema = R"({
"asset!": {"version!": "text", "minVersion": "text"},
"extensionsRequired": ["text"],
"extensionsUsed": ["text"],
"extensions": {"KHR_lights_punctual": {"lights!": [{
        "name": "text", "type!": "word directional point spot",
        "color": "numbers 3", "intensity": "number", "range": "above_zero",
        "spot": {"innerConeAngle": "not_negative", "outerConeAngle": "above_zero"}}, 65536]},
    "*": {}},

"buffers": [{"byteLength!": "count", "uri": "text",
    "extensions": {"EXT_meshopt_compression": {"fallback": "flag"}}}, 65536],
"bufferViews": [{"buffer!": "index buffers", "byteOffset": "whole", "byteLength!": "count",
    "byteStride": "whole", "target": "code 34962 34963",
    "extensions": {"EXT_meshopt_compression": {"buffer!": "index buffers", "byteOffset": "whole",
        "byteLength!": "count", "byteStride!": "count", "count!": "count",
        "mode!": "word ATTRIBUTES TRIANGLES INDICES",
        "filter": "word NONE OCTAHEDRAL QUATERNION EXPONENTIAL"}}}],
"accessors": [{
    "componentType!": "code 5120 5121 5122 5123 5125 5126", "count!": "count",
    "type!": "word SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", "normalized": "flag",
    "bufferView": "index bufferViews", "byteOffset": "whole",
    "sparse": {"count!": "int",
        "indices!": {"bufferView!": "index bufferViews", "byteOffset": "int",
                     "componentType!": "code 5121 5123 5125"},
        "values!": {"bufferView!": "index bufferViews", "byteOffset": "int"}}}],

"images": [{"name": "text", "bufferView": "index bufferViews", "uri": "text",
    "mimeType": "text"}, 65536],
"$texture": {"index!": "index textures", "texCoord": "int", "scale": "number", "extensions":
    {"KHR_texture_transform": {"offset": "numbers 2", "scale": "numbers 2",
                               "rotation": "number", "texCoord": "int"}}},
"samplers": [{"magFilter": "code 9728 9729", "minFilter": "code 9728 9729 9984 9985 9986 9987",
    "wrapS": "code 10497 33071 33648", "wrapT": "code 10497 33071 33648"}, 65536],
"textures": [{"source": "index images", "sampler": "index samplers",
    "extensions": {"EXT_texture_webp": {"source!": "index images"}}}, 65536],
"materials": [{
    "name": "text", "alphaMode": "word OPAQUE MASK BLEND", "alphaCutoff": "number",
    "doubleSided": "flag", "emissiveFactor": "numbers 3",
    "emissiveTexture": "$texture", "normalTexture": "$texture", "*Texture": {"index!": "index textures"},
    "pbrMetallicRoughness": {"baseColorFactor": "numbers 4", "metallicFactor": "number",
        "roughnessFactor": "number", "*Texture": "$texture"},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": "number"},
                   "KHR_materials_ior": {"ior": "number"},
                   "KHR_materials_specular": {"specularFactor": "number",
                       "specularColorFactor": "numbers 3", "*Texture": {"index!": "index textures"}},
                   "KHR_materials_unlit": {}}}, 65536],

"meshes": [{"name": "text", "weights": "numbers", "primitives!": [{
    "attributes!": {"*": "index accessors"}, "indices": "index accessors",
    "material": "index materials", "mode": "code 0 1 2 3 4 5 6",
    "targets": [{"*": "index accessors"}],
    "extensions": {"KHR_draco_mesh_compression": {"bufferView!": "index bufferViews",
        "attributes!": {"*": "int"}}}}]}],
"skins": [{"joints!": ["index nodes"], "skeleton": "index nodes",
    "inverseBindMatrices": "index accessors"}, 65536],
"cameras": [{"name": "text", "type!": "word perspective orthographic",
    "perspective": {"yfov!": "above_zero", "znear!": "above_zero",
                    "aspectRatio": "above_zero", "zfar": "above_zero"},
    "orthographic": {"xmag!": "number", "ymag!": "number",
                     "znear!": "not_negative", "zfar!": "above_zero"}}, 65536],
"nodes": [{
    "name": "text", "matrix": "numbers 16", "translation": "numbers 3", "rotation": "numbers 4",
    "scale": "numbers 3", "children": ["index nodes"], "mesh": "index meshes",
    "skin": "index skins", "camera": "index cameras", "weights": "numbers",
    "extensions": {"KHR_lights_punctual": {"light!": "index lights"},
                   "EXT_mesh_gpu_instancing": {"attributes!": {"*": "index accessors"}}}}],
"scenes": [{"name": "text", "nodes": ["index nodes"]}, 65536],
"scene": "index scenes",
"animations": [{
    "name": "text",
    "samplers!": [{"input!": "index accessors", "output!": "index accessors",
                   "interpolation": "text"}],
    "channels!": [{"sampler!": "int", "target!": {"node": "index nodes", "path!": "text"}}]
    }, 65536]
})";

constexpr std::size_t most_entries = std::size_t{1} << 20;

class Guard {
public:
    Guard(const json& root, const json& rules) : rules_(rules) {
        for (const auto& [name, list] : root.items()) sizes_[name] = list.size();
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        sizes_["lights"] = root.contains(lights) ? root.at(lights).size() : 0;
    }

    void check(json& value, const json& rule) const {
        if (rule.is_object()) return check_members(value, rule);
        if (rule.is_array()) return check_entries(value, rule);
        const std::string_view text = rule.get_ref<const std::string&>();
        if (text[0] == '$') return check(value, rules_.at(text));
        const std::size_t space = std::min(text.find(' '), text.size() - 1);
        check_value(value, text.substr(0, text.find(' ')), text.substr(space + 1));
    }

private:
    static void expect(bool right, const json& value, const char* kind) {
        if (!right) fail("is ", value.type_name(), ", not ", kind);
    }

    static const json* rule_for(const std::string& name, const json& rules) {
        if (const auto rule = rules.find(name); rule != rules.end()) return &*rule;
        if (const auto rule = rules.find(name + "!"); rule != rules.end()) return &*rule;
        for (const auto& [key, rule] : rules.items()) {
            if (key[0] == '*' && name.ends_with(key.substr(1))) return &rule;
        }
        return nullptr;
    }

    void check_members(json& value, const json& rules) const {
        expect(value.is_object(), value, "an object");
        for (const auto& [key, rule] : rules.items()) {
            const std::string_view name(key.data(), key.size() - 1);
            if (key.back() == '!' && !value.contains(name)) fail("has no ", name);
        }
        for (auto member = value.begin(); member != value.end();) {
            const json* rule = rule_for(member.key(), rules);
            if (rule) {
                within([&] { return "." + printable(member.key()); },
                       [&] { check(*member, *rule); });
            }
            member = rule ? std::next(member) : value.erase(member);
        }
    }

    void check_entries(json& value, const json& rule) const {
        check_size(value, rule.size() > 1 ? rule[1].get<std::size_t>() : most_entries);
        each("", value, [&](json& item) { check(item, rule[0]); });
    }

    static void check_size(const json& value, std::size_t most) {
        expect(value.is_array(), value, "an array");
        require(value.size() <= most, "has ", value.size(), " entries, at most ", most,
                " are read");
    }

    static std::uint64_t whole(json& value) {
        if (!value.is_number_unsigned()) {
            const double real = value.get<double>();
            // 2^53: up to here a double that is whole is the number that was written.
            if (real < 0.0 || real > 9007199254740992.0 || real != std::floor(real)) {
                fail("is ", value.dump(), ", not a whole number");
            }
            value = static_cast<std::uint64_t>(real);
        }
        return value.get<std::uint64_t>();
    }

    static void check_among(const std::string& word, std::string_view all) {
        std::istringstream words{std::string(all)};
        using Words = std::istream_iterator<std::string>;
        if (std::find(Words(words), Words(), word) != Words()) return;
        fail("is ", printable(word), ", none of ", all);
    }

    void check_value(json& value, std::string_view kind, std::string_view arguments) const {
        if (kind == "flag") return expect(value.is_boolean(), value, "true or false");
        if (kind == "numbers") {
            check_size(value, most_entries);
            require(arguments.empty() || std::to_string(value.size()) == arguments, "has ",
                    value.size(), " numbers, not ", arguments);
            for (const json& number : value) expect(number.is_number(), number, "a number");
            return;
        }
        if (kind == "text" || kind == "word") {
            expect(value.is_string(), value, "a string");
            if (kind == "word") check_among(value.get<std::string>(), arguments);
            return;
        }
        expect(value.is_number(), value, "a number");
        if (kind == "number") return;
        if (kind == "above_zero" || kind == "not_negative") {
            require(value.get<double>() >= 0.0, "is negative");
            require(kind == "not_negative" || value != 0, "is not above 0");
            return;
        }
        const std::uint64_t number = whole(value);
        if (kind == "code") check_among(std::to_string(number), arguments);
        require(kind != "count" || number > 0, "is 0, at least 1 is needed");
        require(kind != "int" || number <= INT_MAX, "is ", number, ", too large for 32 bits");
        if (kind != "index") return;
        const auto size = sizes_.find(arguments);
        const std::size_t there = size == sizes_.end() ? 0 : size->second;
        require(number < there, "is ", number, ", there are ", there, " ", arguments);
    }

    const json& rules_;
    std::map<std::string, std::size_t, std::less<>> sizes_;  // of the arrays of the root
};

}  // namespace

void guard(json& root) {
    static const json rules = json::parse(schema);
    try {
        Guard(root, rules).check(root, rules);
    } catch (const InputError& error) {
        const std::string what = error.what();
        fail(what.substr(what[0] == '.'));
    }
}

}  // namespace clgi::io::gltf
