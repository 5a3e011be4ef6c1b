// save_glb: a scene as tinygltf's model with one buffer, then the file.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/atomic_file.hpp"
#include "io/gltf_writer.hpp"
#include "io/png_encode.hpp"

namespace clgi::io {

namespace gltf {

namespace {

using tinygltf::Value;

// The transform as scale, then turn, then shift, which is all that glTF can say.
Value transform_of(const glm::dmat3& m) {
    const double scale_u = std::hypot(m[0][0], m[0][1]);
    const double angle =
        scale_u > 0.0 ? std::atan2(-m[0][1], m[0][0]) : std::atan2(m[1][0], m[1][1]);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double scale_v = m[1][0] * s + m[1][1] * c;
    const double shear = m[1][0] * c - m[1][1] * s;
    const bool affine = m[0][2] == 0.0 && m[1][2] == 0.0 && m[2][2] == 1.0;
    require(affine && std::abs(shear) <= 1e-4 * (scale_u + std::abs(scale_v)),
            "has a uv transform that glTF cannot express");
    const auto pair = [](double x, double y) { return Value(Value::Array{Value(x), Value(y)}); };
    return Value(Value::Object{{"offset", pair(m[2][0], m[2][1])},
                               {"rotation", Value(angle)},
                               {"scale", pair(scale_u, scale_v)}});
}

class GlbWriter {
public:
    GlbWriter(const Scene& scene, const GlbExtras& extras) {
        model_.asset.generator = "clgi";
        Value::Object notes;
        for (const auto& [name, text] : extras.notes) notes[utf8(name)] = Value(utf8(text));
        if (!notes.empty()) model_.asset.extras = Value(std::move(notes));
        for (const Texture& texture : scene.textures) add_texture(texture);
        each("materials", scene.materials,
             [&](const Material& material) { add_material(material); });
        PrimitiveWriter meshes(scene, extras.attributes, out_);
        LightWriter lights(scene, out_);
        add_static_meshes(scene, moved_triangles(scene), meshes, out_);
        lights.add_static();
        add_animation(scene, meshes, lights, out_);
        if (!out_.roots.empty()) {  // tinygltf writes null for a scene of nothing
            tinygltf::Scene listed;
            listed.name = utf8(scene.name);
            listed.nodes = out_.roots;
            model_.defaultScene = add(model_.scenes, std::move(listed));
        }
        if (!out_.binary.empty()) model_.buffers.emplace_back().data = std::move(out_.binary);
    }

    std::string file() {
        std::ostringstream stream;
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true);
        return std::move(stream).str();
    }

private:
    void add_texture(const Texture& texture) {
        const auto png = encode_png(texture.width, texture.height, texture.rgba.data());
        tinygltf::Image image;
        image.name = utf8(texture.name);
        image.mimeType = "image/png";
        image.bufferView = out_.add_view(png.data(), png.size());
        tinygltf::Sampler sampler;
        sampler.wrapS = wrap_code(texture.wrap_s);
        sampler.wrapT = wrap_code(texture.wrap_t);
        sampler.magFilter =
            texture.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
        sampler.minFilter = sampler.magFilter;
        tinygltf::Texture written;
        written.source = add(model_.images, std::move(image));
        written.sampler = add(model_.samplers, std::move(sampler));
        add(model_.textures, std::move(written));
    }

    void extend(tinygltf::ExtensionMap& extensions, const char* name, Value value) {
        extensions[name] = std::move(value);
        std::vector<std::string>& used = model_.extensionsUsed;
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    }

    tinygltf::TextureInfo info_of(const TextureSlot& slot) {
        tinygltf::TextureInfo info;
        info.index = slot.texture;  // -1, none, is not written
        info.texCoord = slot.uv_set;
        if (slot.texture >= 0 && slot.transform != glm::mat3(1.0f)) {
            extend(info.extensions, "KHR_texture_transform",
                   transform_of(glm::dmat3(slot.transform)));
        }
        return info;
    }

    void add_material(const Material& material) {
        tinygltf::Material written;
        written.name = utf8(material.name);
        written.pbrMetallicRoughness.baseColorFactor = numbers(material.base_color);
        const bool finished = material.metallic_roughness_texture.texture >= 0;
        written.pbrMetallicRoughness.metallicFactor =
            finished ? material.metallic_roughness_factor.x : material.metallic;
        written.pbrMetallicRoughness.roughnessFactor =
            finished ? material.metallic_roughness_factor.y : material.roughness;
        written.pbrMetallicRoughness.baseColorTexture = info_of(material.base_texture);
        written.pbrMetallicRoughness.metallicRoughnessTexture =
            info_of(material.metallic_roughness_texture);
        const tinygltf::TextureInfo normal = info_of(material.normal_texture);
        written.normalTexture.index = normal.index;
        written.normalTexture.texCoord = normal.texCoord;
        written.normalTexture.extensions = normal.extensions;
        written.normalTexture.scale = material.normal_scale;
        written.doubleSided = material.double_sided;
        if (material.alpha_mode == AlphaMode::mask) {
            written.alphaMode = "MASK";
            written.alphaCutoff = material.alpha_cutoff;
        } else if (material.alpha_mode == AlphaMode::blend) {
            written.alphaMode = "BLEND";
        }
        written.emissiveFactor = numbers(material.emission);
        written.emissiveTexture = info_of(material.emission_texture);
        // Factors end at 1; what is brighter goes into the strength. So does what is very dark:
        // tinygltf takes factors below 1e-12 for black.
        const auto [color, strength] = color_and_strength(material.emission);
        if (strength > 1.0 || (strength > 0.0 && strength < 1e-6)) {
            written.emissiveFactor = numbers(color);
            extend(written.extensions, "KHR_materials_emissive_strength",
                   Value(Value::Object{{"emissiveStrength", Value(strength)}}));
        }
        if (material.specular != 1.0f)
            extend(written.extensions, "KHR_materials_specular",
                   Value(Value::Object{{"specularFactor", Value(double{material.specular})}}));
        if (material.ior != 1.5f)
            extend(written.extensions, "KHR_materials_ior",
                   Value(Value::Object{{"ior", Value(double{material.ior})}}));
        add(model_.materials, std::move(written));
    }

    GlbModel out_;
    Model& model_ = out_.model;
};

}  // namespace

}  // namespace gltf

void save_glb(const Scene& scene, const std::filesystem::path& path, const GlbExtras& extras) {
    std::string bytes;
    try {
        validate(scene);
        bytes = gltf::GlbWriter(scene, extras).file();
        // tinygltf cuts the length of a file to 32 bits.
        gltf::require(bytes.size() <= UINT32_MAX, "the scene is larger than the 4 GiB of a GLB");
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace clgi::io
