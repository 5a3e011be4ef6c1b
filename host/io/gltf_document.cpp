// The document as a whole: version, extensions, and the order in which its parts are read.
// SPDX-License-Identifier: MIT
#include "io/gltf_document.hpp"

#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <cstring>

namespace clgi::io::gltf {

namespace {

constexpr std::array supported_extensions = {
    "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"};

// Nothing is lost when these are not read; a file may even require the first.
constexpr std::array harmless_extensions = {
    "KHR_materials_unlit",  // gets its own warning where a material has it
    "KHR_xmp", "KHR_xmp_json_ld", "EXT_meshopt_compression", "EXT_texture_webp"};

template <std::size_t n>
bool contains(const std::array<const char*, n>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// "2.0" as 2 and 0. Anything else than digits, a point and digits is refused.
std::array<unsigned, 2> version(const Value& value) {
    const std::string text = value.text();
    const std::size_t point = text.find('.');
    const std::string major = text.substr(0, point);
    const std::string minor = point == std::string::npos ? "" : text.substr(point + 1);
    for (const std::string& part : {major, minor}) {
        if (part.empty() || part.size() > 4 ||
            part.find_first_not_of("0123456789") != std::string::npos) {
            value.fail("is \"" + printable(text) + "\", not a version");
        }
    }
    return {static_cast<unsigned>(std::stoul(major)), static_cast<unsigned>(std::stoul(minor))};
}

void read_extensions(const Value& root, Document& document) {
    if (const auto required = root.find("extensionsRequired")) {
        for (std::size_t i = 0; i < required->count(); ++i) {
            const std::string name = required->item(i).text();
            if (!contains(supported_extensions, name) && name != harmless_extensions[0]) {
                throw InputError("requires the extension " + printable(name) +
                                 ", which clgi does not read");
            }
        }
    }
    if (const auto used = root.find("extensionsUsed")) {
        for (std::size_t i = 0; i < used->count(); ++i) {
            const std::string name = used->item(i).text();
            if (name == "KHR_mesh_quantization") document.quantized = true;
            if (!contains(supported_extensions, name) && !contains(harmless_extensions, name)) {
                document.warnings.add("the extension " + printable(name) + " is ignored");
            }
        }
    }
}

}  // namespace

void read_asset(const Value& root, Document& document) {
    const Value asset = root.at("asset");
    const auto [major, minor] = version(asset.at("version"));
    if (major != 2) {
        asset.fail("says glTF " + std::to_string(major) + "." + std::to_string(minor) +
                   ", clgi reads 2.0");
    }
    if (const auto minimum = asset.find("minVersion")) {
        const auto [least_major, least_minor] = version(*minimum);
        if (least_major != 2 || least_minor != 0) {
            minimum->fail("asks for a reader of glTF " + std::to_string(least_major) + "." +
                          std::to_string(least_minor) + ", clgi reads 2.0");
        }
    }
    read_extensions(root, document);
    if (const auto extensions = root.find("extensions")) {
        for (const auto& [name, extension] : extensions->members()) extension.expect_object();
    }
}

Document read_document(const Value& root) {
    Document document;
    read_asset(root, document);
    read_data(root, document);
    read_images(root, document);
    read_materials(root, document);
    read_meshes(root, document);
    read_lights(root, document);
    read_nodes(root, document);
    check_animations(root, document);
    return document;
}

}  // namespace clgi::io::gltf
