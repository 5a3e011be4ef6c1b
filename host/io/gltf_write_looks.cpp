// Materials and textures of a GLB.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "io/gltf_write.hpp"
#include "io/png_encode.hpp"

namespace clgi::io::gltf {

namespace {

using tinygltf::Value;

int wrap_code(Wrap wrap) {
    if (wrap == Wrap::mirrored_repeat) return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    return wrap == Wrap::clamp_to_edge ? TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE
                                       : TINYGLTF_TEXTURE_WRAP_REPEAT;
}

void write_texture(const Texture& texture, GlbDraft& draft) {
    const std::vector<std::uint8_t> png =
        encode_png(texture.width, texture.height, texture.rgba.data());
    tinygltf::Image image;
    image.name = utf8(texture.name);
    image.mimeType = "image/png";
    image.bufferView = draft.add_view(png.data(), png.size());
    tinygltf::Sampler sampler;
    sampler.wrapS = wrap_code(texture.wrap_s);
    sampler.wrapT = wrap_code(texture.wrap_t);
    sampler.magFilter =
        texture.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = sampler.magFilter;
    tinygltf::Texture written;
    written.source = add(draft.model.images, std::move(image));
    written.sampler = add(draft.model.samplers, std::move(sampler));
    add(draft.model.textures, std::move(written));
}

Value pair(double x, double y) { return Value(Value::Array{Value(x), Value(y)}); }

// The transform as scale, then turn, then shift, which is all that glTF can say.
Value transform_of(const glm::dmat3& m, std::size_t material) {
    const double scale_u = std::hypot(m[0][0], m[0][1]);
    const double angle =
        scale_u > 0.0 ? std::atan2(-m[0][1], m[0][0]) : std::atan2(m[1][0], m[1][1]);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double scale_v = m[1][0] * s + m[1][1] * c;
    const double shear = m[1][0] * c - m[1][1] * s;
    const bool affine = m[0][2] == 0.0 && m[1][2] == 0.0 && m[2][2] == 1.0;
    if (!affine || std::abs(shear) > 1e-4 * (scale_u + std::abs(scale_v))) {
        throw InputError("material " + std::to_string(material) +
                         " has a uv transform that glTF cannot express");
    }
    return Value(Value::Object{{"offset", pair(m[2][0], m[2][1])},
                               {"rotation", Value(angle)},
                               {"scale", pair(scale_u, scale_v)}});
}

tinygltf::TextureInfo info_of(const TextureSlot& slot, std::size_t material, GlbDraft& draft) {
    tinygltf::TextureInfo info;
    info.index = slot.texture;  // -1, none, is not written
    info.texCoord = slot.uv_set;
    if (slot.texture >= 0 && slot.transform != glm::mat3(1.0f)) {
        draft.declare_extension("KHR_texture_transform");
        info.extensions["KHR_texture_transform"] =
            transform_of(glm::dmat3(slot.transform), material);
    }
    return info;
}

void write_emission(const Material& material, tinygltf::Material& written, GlbDraft& draft) {
    const glm::dvec3 emission(material.emission);
    const double largest = std::max({emission.r, emission.g, emission.b});
    if (!(largest > 0.0)) return;
    // Factors end at 1; what is brighter goes into the strength. So does what is very dark:
    // tinygltf takes factors below 1e-12 for black.
    const double strength = largest < 1e-6 ? largest : std::max(1.0, largest);
    const glm::dvec3 factor = emission / strength;
    written.emissiveFactor = {factor.r, factor.g, factor.b};
    if (strength == 1.0) return;
    draft.declare_extension("KHR_materials_emissive_strength");
    written.extensions["KHR_materials_emissive_strength"] =
        Value(Value::Object{{"emissiveStrength", Value(strength)}});
}

void write_material(const Material& material, std::size_t index, GlbDraft& draft) {
    const glm::dvec4 base(material.base_color);
    tinygltf::Material written;
    written.name = utf8(material.name);
    written.pbrMetallicRoughness.baseColorFactor = {base.r, base.g, base.b, base.a};
    written.pbrMetallicRoughness.metallicFactor = material.metallic;
    written.pbrMetallicRoughness.roughnessFactor = material.roughness;
    written.pbrMetallicRoughness.baseColorTexture = info_of(material.base_texture, index, draft);
    written.doubleSided = material.double_sided;
    if (material.alpha_mode == AlphaMode::mask) {
        written.alphaMode = "MASK";
        written.alphaCutoff = material.alpha_cutoff;
    }
    written.emissiveFactor = {0.0, 0.0, 0.0};
    write_emission(material, written, draft);
    written.emissiveTexture = info_of(material.emission_texture, index, draft);
    add(draft.model.materials, std::move(written));
}

}  // namespace

void write_materials(const Scene& scene, GlbDraft& draft) {
    for (const Texture& texture : scene.textures) write_texture(texture, draft);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        write_material(scene.materials[i], i, draft);
    }
}

}  // namespace clgi::io::gltf
