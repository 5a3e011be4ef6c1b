// SPDX-License-Identifier: MIT
#include "io/gltf_material.hpp"

#include <algorithm>
#include <cmath>

#include "io/gltf_text.hpp"
#include "io/gltf_textures.hpp"

namespace clgi::io::gltf {

namespace {

// A number that the specification holds in [0,1]; what leaves it is mended, not refused.
float unit_number(double number, const std::string& name, Warnings& warnings) {
    if (number >= 0.0 && number <= 1.0) return static_cast<float>(number);
    warnings.add("a material factor outside 0..1 is clamped, first in " + name);
    return static_cast<float>(std::clamp(number, 0.0, 1.0));
}

double number_or(const tinygltf::Value& object, const char* key, double fallback) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

glm::dvec2 pair_or(const tinygltf::Value& object, const char* key, double fallback) {
    if (!object.Has(key)) return glm::dvec2(fallback);
    const tinygltf::Value& pair = object.Get(key);
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

// KHR_texture_transform: scale, then turn counter-clockwise as seen with v pointing down, then
// shift.
glm::mat3 uv_transform(const tinygltf::Value& transform, const std::string& name) {
    const glm::dvec2 offset = pair_or(transform, "offset", 0.0);
    const glm::dvec2 scale = pair_or(transform, "scale", 1.0);
    const double angle = number_or(transform, "rotation", 0.0);
    for (const double number : {offset.x, offset.y, scale.x, scale.y}) {
        if (std::abs(number) > 1e9) {
            refuse(name, "has a texture that is shifted or scaled by more than 1e9");
        }
    }
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return glm::mat3(glm::dmat3(c * scale.x, -s * scale.x, 0.0,  // first column
                                s * scale.y, c * scale.y, 0.0,   // second
                                offset.x, offset.y, 1.0));
}

TextureSlot read_slot(const tinygltf::TextureInfo& info, const std::string& name,
                      Warnings& warnings) {
    TextureSlot slot;
    if (info.index < 0) return slot;
    slot.texture = info.index;
    int set = info.texCoord;
    if (const auto* transform = extension(info.extensions, "KHR_texture_transform")) {
        slot.transform = uv_transform(*transform, name);
        if (transform->Has("texCoord")) set = index_in(*transform, "texCoord");
    }
    if (set > 1) {
        warnings.add("a texture on TEXCOORD_2 or above is ignored");
        return {};
    }
    slot.uv_set = set;
    return slot;
}

double emissive_strength(const tinygltf::Material& source, Warnings& warnings) {
    const auto* found = extension(source.extensions, "KHR_materials_emissive_strength");
    const double strength = found ? number_or(*found, "emissiveStrength", 1.0) : 1.0;
    if (strength >= 0.0 && strength <= 1e30) return strength;
    warnings.add("an emissive strength outside 0..1e30 is clamped");
    return std::clamp(strength, 0.0, 1e30);
}

void read_alpha(const tinygltf::Material& source, Material& material, Warnings& warnings) {
    if (source.alphaMode == "MASK") {
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
    } else if (source.alphaMode == "BLEND") {
        material.alpha_mode = AlphaMode::mask;
        warnings.add("a blended material is cut out where its alpha is below 0.5");
    }
}

// With its slots naming textures of the model.
Material read_material(const tinygltf::Material& source, const std::string& name,
                       Warnings& warnings) {
    const tinygltf::PbrMetallicRoughness& metal_rough = source.pbrMetallicRoughness;
    Material material;
    material.name = short_name(source.name);
    for (int i = 0; i < 4; ++i) {
        material.base_color[i] = unit_number(metal_rough.baseColorFactor[i], name, warnings);
    }
    material.metallic = unit_number(metal_rough.metallicFactor, name, warnings);
    material.roughness = unit_number(metal_rough.roughnessFactor, name, warnings);
    material.base_texture = read_slot(metal_rough.baseColorTexture, name, warnings);

    const bool dark = source.emissiveFactor == std::vector<double>(3, 0.0);
    const double strength = dark ? 1.0 : emissive_strength(source, warnings);
    for (int i = 0; i < 3; ++i) {
        const double channel = unit_number(source.emissiveFactor[i], name, warnings);
        material.emission[i] = static_cast<float>(channel * strength);
    }
    material.emission_texture = read_slot(source.emissiveTexture, name, warnings);
    read_alpha(source, material, warnings);
    material.double_sided = source.doubleSided;
    if (extension(source.extensions, "KHR_materials_unlit")) {
        warnings.add("an unlit material is lit like any other");
    }
    return material;
}

}  // namespace

void load_materials(Document& document, const std::filesystem::path& folder,
                    const GltfOptions& options, Scene& scene) {
    TextureLoader textures(document, folder, options, scene);
    textures.check_images();
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        const tinygltf::Material& source = document.model.materials[i];
        const std::string name = entry("materials", i);
        Material material = read_material(source, name, document.warnings);
        material.base_texture.texture = textures.load(material.base_texture.texture);
        // A texture that is multiplied by black need not be there.
        const bool dark = material.emission == glm::vec3(0.0f);
        material.emission_texture.texture =
            dark ? -1 : textures.load(material.emission_texture.texture);
        const MetalRough mean = textures.mean_metal_rough(
            read_slot(source.pbrMetallicRoughness.metallicRoughnessTexture, name, document.warnings)
                .texture);
        material.metallic *= static_cast<float>(mean.metallic);
        material.roughness *= static_cast<float>(mean.roughness);
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace clgi::io::gltf
