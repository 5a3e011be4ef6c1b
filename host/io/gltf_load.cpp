// load_gltf: the JSON of a file is judged, tinygltf makes its model, and the steps after that a
// Scene.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <climits>
#include <new>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "io/gltf_animation.hpp"

namespace clgi::io {

namespace gltf {

using nlohmann::json;

namespace {

constexpr const char* supported[] = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_materials_unlit"};  // gets its own warning where a material has it

// Nothing is lost when these are not read.
constexpr const char* harmless[] = {"KHR_xmp", "KHR_xmp_json_ld"};

bool contains(std::span<const char* const> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string version(const json& asset, const char* key) {
    static const std::regex digits("[0-9]{1,4}[.][0-9]{1,4}");
    const std::string text = asset.value(key, "2.0");
    require(std::regex_match(text, digits), "asset.", key, " is \"", printable(text),
            "\", not a version");
    return text;
}

// Version and extensions come first: in another version all the rest may be different.
void read_head(const json& root, Document& document) {
    json head = json::object();
    for (const char* name : {"asset", "extensionsRequired", "extensionsUsed"}) {
        if (root.contains(name)) head[name] = root[name];
    }
    guard(head);
    const std::string written = version(head["asset"], "version");
    require(written.starts_with("2."), "asset says glTF ", written, ", clgi reads 2.0");
    const std::string least = version(head["asset"], "minVersion");
    require(least == "2.0", "asset.minVersion asks for a reader of glTF ", least,
            ", clgi reads 2.0");
    for (const std::string name : head["extensionsRequired"]) {
        const Codec* codec = find_codec(name);
        if (codec && codec->built) continue;
        if (codec) fail("requires the extension ", missing(*codec));
        require(contains(supported, name), "requires the extension ", printable(name),
                ", which clgi does not read");
    }
    for (const std::string name : head["extensionsUsed"]) {
        if (name == "KHR_mesh_quantization") document.quantized = true;
        if (find_codec(name) || contains(supported, name) || contains(harmless, name)) continue;
        document.warnings.add("the extension " + printable(name) + " is ignored");
    }
}

// Compressed primitives have indices without a view, which tinygltf refuses: they move into the
// extension.
void move_packed_indices(json& root) {
    const auto move = [&](json& primitive) {
        if (!primitive.contains("indices") || !primitive.contains("extensions")) return;
        const auto packed = primitive["extensions"].find(draco_codec.extension);
        if (packed == primitive["extensions"].end()) return;
        const auto accessor = primitive["indices"].get<std::size_t>();
        if (draco_codec.built) {
            (*packed)["indices"] = accessor;
            primitive.erase("indices");
        } else if (!root["accessors"][accessor].contains("bufferView")) {
            fail("needs ", missing(draco_codec));
        }
    };
    each("meshes", root["meshes"], [&](json& mesh) {
        each(".primitives", mesh["primitives"], [&](json& primitive) { move(primitive); });
    });
}

std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return printable(text.substr(text.rfind('\n') + 1));
}

Document read_document(const std::filesystem::path& path) {
    Document document;
    document.folder = path.parent_path();
    document.files.push_back(read_file(path));
    const Container container = open_container(document.files[0]);
    json root = parse_json(container.json);
    if (!container.binary) document.files.clear();
    read_head(root, document);
    guard(root);
    each("accessors", root["accessors"], [](const json& accessor) {
        require(accessor.contains("bufferView") || !accessor.contains("byteOffset"),
                "has an offset into no view");
    });
    move_packed_indices(root);
    take_sources(root, container.binary, document);
    const std::string text = std::exchange(root, nullptr).dump();
    require(text.size() <= INT_MAX, "the JSON is larger than 2 GiB");

    std::string error;
    std::string warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                                  static_cast<unsigned>(text.size()), "")) {
        throw InputError(last_line(error));
    }
    return document;
}

Scene load(const std::filesystem::path& path, const GltfOptions& options) {
    // Everything the document says is checked before anything is built from it.
    Document document = read_document(path);
    if constexpr (draco_codec.built) unpack_meshes(document, options.max_triangles);
    check_links(document.model);
    check_accessors(document);
    check_meshes(document);
    read_lights(document);
    place_nodes(document);

    Scene scene;
    scene.name = path.stem().string();
    load_materials(document, options, scene);
    const std::vector<int> nodes = scene_nodes(document, options.scene);
    AnimationReader animation(document, options);
    place_meshes(document, nodes, options, animation, scene);
    place_lights(document, nodes, scene);
    animation.finish(scene);
    scene.warnings = document.warnings.lines();
    validate(scene);
    return scene;
}

}  // namespace

}  // namespace gltf

Scene load_gltf(const std::filesystem::path& path, const GltfOptions& options) {
    const auto refuse = [&](const char* what) {
        std::string line = path.string() + ": " + what;
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        return InputError(line);
    };
    try {
        return gltf::load(path, options);
    } catch (const InputError& error) {
        throw refuse(error.what());
    } catch (const std::bad_alloc&) {
        throw refuse("needs more memory than there is");
    } catch (const std::length_error&) {
        throw refuse("needs more memory than there is");
    }
}

}  // namespace clgi::io
