// SPDX-License-Identifier: MIT
#include "io/gltf_asset.hpp"

#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <nlohmann/json.hpp>

#include "io/gltf_text.hpp"

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

// Anything else than digits, a point and digits is refused.
std::string version(const nlohmann::json& asset, const char* key) {
    const std::string text = asset.at(key).get<std::string>();
    const std::size_t point = std::min(text.find('.'), text.size());
    for (const std::string& part : {text.substr(0, point), text.substr(point).erase(0, 1)}) {
        if (part.empty() || part.size() > 4 ||
            part.find_first_not_of("0123456789") != std::string::npos) {
            refuse(std::string("asset.") + key, "is \"" + printable(text) + "\", not a version");
        }
    }
    return text;
}

}  // namespace

void check_asset(const nlohmann::json& root, Document& document) {
    const nlohmann::json& asset = root.at("asset");
    const std::string written = version(asset, "version");
    if (!written.starts_with("2.")) refuse("asset", "says glTF " + written + ", clgi reads 2.0");
    const std::string least = asset.contains("minVersion") ? version(asset, "minVersion") : "2.0";
    if (least != "2.0") {
        refuse("asset.minVersion", "asks for a reader of glTF " + least + ", clgi reads 2.0");
    }

    const nlohmann::json none = nlohmann::json::array();
    for (const std::string name : root.value("extensionsRequired", none)) {
        if (!contains(supported_extensions, name) && name != harmless_extensions[0]) {
            throw InputError("requires the extension " + printable(name) +
                             ", which clgi does not read");
        }
    }
    for (const std::string name : root.value("extensionsUsed", none)) {
        if (name == "KHR_mesh_quantization") document.quantized = true;
        if (!contains(supported_extensions, name) && !contains(harmless_extensions, name)) {
            document.warnings.add("the extension " + printable(name) + " is ignored");
        }
    }
}

}  // namespace clgi::io::gltf
