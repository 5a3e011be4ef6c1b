// Images, samplers, textures and materials as the JSON declares them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

Wrap wrap(const Value& sampler, const char* key) {
    const std::uint64_t code = sampler.integer_or(key, 10497);
    switch (code) {
        case 10497:
            return Wrap::repeat;
        case 33648:
            return Wrap::mirrored_repeat;
        case 33071:
            return Wrap::clamp_to_edge;
        default:
            sampler.at(key).fail("is " + std::to_string(code) + ", no wrap mode");
    }
}

Sampler read_sampler(const Value& value) {
    const std::uint64_t magnify = value.integer_or("magFilter", 9729);
    if (magnify != 9728 && magnify != 9729) value.at("magFilter").fail("is no filter");
    const std::uint64_t minify = value.integer_or("minFilter", 9729);
    if (minify != 9728 && minify != 9729 && (minify < 9984 || minify > 9987)) {
        value.at("minFilter").fail("is no filter");
    }
    return {wrap(value, "wrapS"), wrap(value, "wrapT"), magnify == 9728};
}

Picture read_picture(const Value& value, std::size_t views) {
    Picture picture;
    picture.name = value.name_or_empty();
    picture.view = value.index_or_none("bufferView", views, "buffer views");
    const auto uri = value.find("uri");
    if (uri) picture.uri = uri->text();
    const auto mime = value.find("mimeType");
    if (mime) picture.mime = mime->name();
    if (uri.has_value() == (picture.view >= 0)) {
        value.fail(uri ? "has a uri and a buffer view" : "has neither a uri nor a buffer view");
    }
    if (picture.view >= 0 && !mime) value.fail("is in a buffer view, but says no mimeType");
    return picture;
}

// A number that the specification holds in [0,1]; what leaves it is mended, not refused.
float unit_number(const Value& value, double number, Warnings& warnings) {
    if (number >= 0.0 && number <= 1.0) return static_cast<float>(number);
    const std::string path = value.path();
    warnings.add("a material factor outside 0..1 is clamped, first in " +
                 path.substr(0, path.find('.')));
    return static_cast<float>(std::clamp(number, 0.0, 1.0));
}

// KHR_texture_transform: scale, then turn counter-clockwise as seen with v pointing down, then
// shift.
glm::mat3 uv_transform(const Value& transform) {
    const auto pair = [&](const char* key, double fallback) {
        const auto member = transform.find(key);
        return member ? member->numbers(2) : std::vector<double>(2, fallback);
    };
    const std::vector<double> offset = pair("offset", 0.0);
    const std::vector<double> scale = pair("scale", 1.0);
    const double angle = transform.number_or("rotation", 0.0);
    for (const double number : {offset[0], offset[1], scale[0], scale[1]}) {
        if (std::abs(number) > 1e9) transform.fail("shifts or scales by more than 1e9");
    }
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return glm::mat3(glm::dmat3(c * scale[0], -s * scale[0], 0.0,  // first column
                                s * scale[1], c * scale[1], 0.0,   // second
                                offset[0], offset[1], 1.0));
}

TextureSlot read_slot(const Value& material, const char* key, Document& document) {
    TextureSlot slot;
    const auto info = material.find(key);
    if (!info) return slot;
    slot.texture = info->at("index").index(document.textures.size(), "textures");
    std::uint64_t set = info->integer_or("texCoord", 0);
    if (const auto transform = info->extension("KHR_texture_transform")) {
        slot.transform = uv_transform(*transform);
        set = transform->integer_or("texCoord", set);
    }
    if (set > 1) {
        document.warnings.add("a texture on TEXCOORD_2 or above is ignored");
        return {};
    }
    slot.uv_set = static_cast<int>(set);
    return slot;
}

void read_metal_rough(const Value& value, MaterialSource& source, Document& document) {
    Material& material = source.material;
    if (const auto factor = value.find("baseColorFactor")) {
        const std::vector<double> color = factor->numbers(4);
        for (int i = 0; i < 4; ++i) {
            material.base_color[i] = unit_number(*factor, color[i], document.warnings);
        }
    }
    material.metallic =
        unit_number(value, value.number_or("metallicFactor", 1.0), document.warnings);
    material.roughness =
        unit_number(value, value.number_or("roughnessFactor", 1.0), document.warnings);
    material.base_texture = read_slot(value, "baseColorTexture", document);
    source.metal_rough_texture = read_slot(value, "metallicRoughnessTexture", document).texture;
}

void read_emission(const Value& value, Material& material, Document& document) {
    material.emission_texture = read_slot(value, "emissiveTexture", document);
    const auto factor = value.find("emissiveFactor");
    if (!factor) return;

    double strength = 1.0;
    if (const auto extension = value.extension("KHR_materials_emissive_strength")) {
        strength = extension->number_or("emissiveStrength", 1.0);
        if (strength < 0.0 || strength > 1e30) {
            document.warnings.add("an emissive strength outside 0..1e30 is clamped");
            strength = std::clamp(strength, 0.0, 1e30);
        }
    }
    const std::vector<double> color = factor->numbers(3);
    for (int i = 0; i < 3; ++i) {
        const double channel = unit_number(*factor, color[i], document.warnings);
        material.emission[i] = static_cast<float>(channel * strength);
    }
}

void read_alpha(const Value& value, Material& material, Warnings& warnings) {
    const auto mode = value.find("alphaMode");
    const std::string text = mode ? mode->text() : "OPAQUE";
    const double cutoff = value.number_or("alphaCutoff", 0.5);
    if (text == "MASK") {
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = static_cast<float>(std::clamp(cutoff, 0.0, 1e6));
    } else if (text == "BLEND") {
        material.alpha_mode = AlphaMode::mask;
        warnings.add("a blended material is cut out where its alpha is below 0.5");
    } else if (text != "OPAQUE") {
        mode->fail("is \"" + printable(text) + "\"");
    }
}

MaterialSource read_material(const Value& value, Document& document) {
    MaterialSource source;
    Material& material = source.material;
    material.name = value.name_or_empty();
    material.metallic = 1.0f;  // glTF's defaults
    material.roughness = 1.0f;
    if (const auto metal_rough = value.find("pbrMetallicRoughness")) {
        read_metal_rough(*metal_rough, source, document);
    }
    read_emission(value, material, document);
    read_alpha(value, material, document.warnings);
    material.double_sided = value.flag_or("doubleSided", false);

    // Not used, but a reference to nothing is still a broken file.
    for (const char* key : {"normalTexture", "occlusionTexture"}) {
        if (const auto info = value.find(key)) {
            info->at("index").index(document.textures.size(), "textures");
        }
    }
    if (value.extension("KHR_materials_unlit")) {
        document.warnings.add("an unlit material is lit like any other");
    }
    return source;
}

}  // namespace

void read_images(const Value& root, Document& document) {
    const std::size_t pictures = entries(root, "images", max_rare_entries);
    for (std::size_t i = 0; i < pictures; ++i) {
        document.pictures.push_back(read_picture(root.at("images").item(i), document.views.size()));
    }
    const std::size_t samplers = entries(root, "samplers", max_rare_entries);
    for (std::size_t i = 0; i < samplers; ++i) {
        document.samplers.push_back(read_sampler(root.at("samplers").item(i)));
    }
    const std::size_t textures = entries(root, "textures", max_rare_entries);
    for (std::size_t i = 0; i < textures; ++i) {
        const Value value = root.at("textures").item(i);
        document.textures.push_back({value.index_or_none("source", pictures, "images"),
                                     value.index_or_none("sampler", samplers, "samplers")});
    }
}

void read_materials(const Value& root, Document& document) {
    const std::size_t materials = entries(root, "materials", max_rare_entries);
    for (std::size_t i = 0; i < materials; ++i) {
        document.materials.push_back(read_material(root.at("materials").item(i), document));
    }
}

}  // namespace clgi::io::gltf
