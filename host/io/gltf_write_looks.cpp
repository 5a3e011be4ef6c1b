// Materials and textures of a GLB.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "io/gltf_write.hpp"
#include "io/png_encode.hpp"

namespace clgi::io::gltf {

namespace {

int wrap_code(Wrap wrap) {
    switch (wrap) {
        case Wrap::mirrored_repeat:
            return 33648;
        case Wrap::clamp_to_edge:
            return 33071;
        default:
            return 10497;
    }
}

void write_texture(const Texture& texture, GlbDraft& draft) {
    const std::vector<std::uint8_t> png =
        encode_png(texture.width, texture.height, texture.rgba.data());
    nlohmann::json image = {{"mimeType", "image/png"},
                            {"bufferView", draft.add_view(png.data(), png.size())}};
    if (!texture.name.empty()) image["name"] = texture.name;
    const int filter = texture.nearest ? 9728 : 9729;
    const int sampler = draft.add("samplers", {{"wrapS", wrap_code(texture.wrap_s)},
                                               {"wrapT", wrap_code(texture.wrap_t)},
                                               {"magFilter", filter},
                                               {"minFilter", filter}});
    draft.add("textures",
              {{"source", draft.add("images", std::move(image))}, {"sampler", sampler}});
}

// The transform as scale, then turn, then shift, which is all that glTF can say.
nlohmann::json transform_json(const glm::dmat3& m, std::size_t material) {
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
    return {{"offset", {m[2][0], m[2][1]}}, {"rotation", angle}, {"scale", {scale_u, scale_v}}};
}

nlohmann::json slot_json(const TextureSlot& slot, std::size_t material, GlbDraft& draft) {
    nlohmann::json info = {{"index", slot.texture}, {"texCoord", slot.uv_set}};
    if (slot.transform != glm::mat3(1.0f)) {
        draft.declare_extension("KHR_texture_transform");
        info["extensions"]["KHR_texture_transform"] =
            transform_json(glm::dmat3(slot.transform), material);
    }
    return info;
}

void write_material(const Material& material, std::size_t index, GlbDraft& draft) {
    const glm::vec4& base = material.base_color;
    nlohmann::json metal_rough = {{"baseColorFactor", {base.r, base.g, base.b, base.a}},
                                  {"metallicFactor", material.metallic},
                                  {"roughnessFactor", material.roughness}};
    if (material.base_texture.texture >= 0) {
        metal_rough["baseColorTexture"] = slot_json(material.base_texture, index, draft);
    }
    nlohmann::json json = {{"pbrMetallicRoughness", std::move(metal_rough)}};
    if (!material.name.empty()) json["name"] = material.name;
    if (material.double_sided) json["doubleSided"] = true;
    if (material.alpha_mode == AlphaMode::mask) {
        json["alphaMode"] = "MASK";
        json["alphaCutoff"] = material.alpha_cutoff;
    }

    // Factors end at 1; what is brighter goes into the strength.
    const glm::dvec3 emission(material.emission);
    const double strength = std::max(1.0, std::max({emission.r, emission.g, emission.b}));
    const glm::dvec3 factor = emission / strength;
    if (emission != glm::dvec3(0.0)) json["emissiveFactor"] = {factor.r, factor.g, factor.b};
    if (strength > 1.0) {
        draft.declare_extension("KHR_materials_emissive_strength");
        json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
    if (material.emission_texture.texture >= 0) {
        json["emissiveTexture"] = slot_json(material.emission_texture, index, draft);
    }
    draft.add("materials", std::move(json));
}

}  // namespace

void write_materials(const Scene& scene, GlbDraft& draft) {
    for (const Texture& texture : scene.textures) write_texture(texture, draft);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        write_material(scene.materials[i], i, draft);
    }
}

}  // namespace clgi::io::gltf
