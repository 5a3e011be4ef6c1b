// load_materials: materials and the textures that they need.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "io/gltf_document.hpp"
#include "io/gltf_image.hpp"

namespace clgi::io::gltf {

namespace {

using tinygltf::Value;

constexpr std::size_t most_encoded = std::size_t{1} << 32;  // bytes, of all images read

Wrap wrap(int code) {
    for (const Wrap each : {Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
        if (code == wrap_code(each)) return each;
    }
    return Wrap::repeat;
}

// What a texture says of blue, metalness, and green, roughness.
struct Finish {
    Finish() = default;
    explicit Finish(const std::vector<std::uint8_t>& rgba) {
        glm::dvec2 sum(0.0);
        for (std::size_t i = 0; i < rgba.size(); i += 4) {
            sum += glm::dvec2(rgba[i + 2], rgba[i + 1]);
            varies = varies || rgba[i + 2] != rgba[2] || rgba[i + 1] != rgba[1];
        }
        mean = sum / (255.0 * static_cast<double>(rgba.size() / 4));
    }
    glm::dvec2 mean = glm::dvec2(1.0);
    bool varies = false;
};

class TextureLoader {
public:
    // Looks at every image, used or not: it must exist and be what it says.
    TextureLoader(Document& document, const GltfOptions& options, Scene& scene)
        : document_(document),
          scene_(scene),
          most_texels_(options.max_texels),
          texels_left_(options.max_texels),
          detail_left_(options.max_texels) {
        each("images", document.images, [&](const Image& image) { inspect(image); });
    }

    // Index into scene.textures; -1 where there is no image that can be read. decoded: its pixels,
    // if they are at hand.
    int load(int texture, bool srgb = true, Pixels decoded = {}) {
        if (texture < 0) return -1;
        const tinygltf::Texture& source = document_.model.textures[texture];
        const int image = image_of(source);
        if (!is_readable(image)) return -1;
        const tinygltf::Sampler sampler =
            source.sampler < 0 ? tinygltf::Sampler() : document_.model.samplers[source.sampler];
        const Wrap wrap_s = wrap(sampler.wrapS);
        const Wrap wrap_t = wrap(sampler.wrapT);
        const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        const auto [known, fresh] = loaded_.try_emplace({image, wrap_s, wrap_t, nearest, srgb},
                                                        static_cast<int>(scene_.textures.size()));
        if (!fresh) return known->second;
        std::size_t& budget = srgb ? texels_left_ : detail_left_;
        Pixels pixels = decoded.rgba.empty() ? decode(image, budget) : std::move(decoded);
        scene_.textures.push_back({document_.images[image].name, pixels.width, pixels.height,
                                   std::move(pixels.rgba), wrap_s, wrap_t, nearest, srgb});
        return known->second;
    }

    // Metalness and roughness. The material keeps the means, and the texture only where it varies.
    void load_finish(const TextureSlot& slot, Material& material) {
        if (slot.texture < 0) return;
        const int image = image_of(document_.model.textures[slot.texture]);
        if (!is_readable(image)) return;
        Pixels pixels;
        const auto [known, fresh] = finishes_.try_emplace(image);
        if (fresh) {
            pixels = decode(image, detail_left_);
            known->second = Finish(pixels.rgba);
        }
        const Finish& finish = known->second;
        const glm::vec2 factor(material.metallic, material.roughness);
        material.metallic *= static_cast<float>(finish.mean.x);
        material.roughness *= static_cast<float>(finish.mean.y);
        if (!finish.varies) return;
        material.metallic_roughness_factor = factor;
        material.metallic_roughness_texture = slot;
        material.metallic_roughness_texture.texture = load(slot.texture, false, std::move(pixels));
    }

private:
    void inspect(const Image& image) {
        std::vector<std::uint8_t> held;
        formats_.push_back(inspect_image(image_bytes(document_, image, inspected_bytes, held)));
        // What a data uri says of itself must be true; files and views are known by their bytes.
        for (const std::string& type : image.types) {
            require(!contradicts(type, formats_.back()), "calls its data ", printable(type),
                    ", but they are a ", name_of(formats_.back()));
        }
    }

    // The source of EXT_texture_webp goes before the one that is there for other readers.
    static int image_of(const tinygltf::Texture& texture) {
        const Value* better = extension(texture.extensions, webp_codec.extension);
        return webp_codec.built && better ? index_in(*better, "source") : texture.source;
    }

    bool is_readable(int image) {
        if (image >= 0 && formats_[image] != ImageFormat::unsupported) return true;
        document_.warnings.add("a texture in a format that is not read is taken as white");
        return false;
    }

    // Takes the texels from a budget, so that a thousand images of one small file stay bounded.
    Pixels decode(std::size_t image, std::size_t& budget) {
        const char* shared = budget < most_texels_ ? " (with those before it)" : "";
        return of_entry("images", image, [&] {
            std::vector<std::uint8_t> held;
            const Bytes bytes =
                image_bytes(document_, document_.images[image], most_encoded - encoded_, held);
            encoded_ += bytes.size();
            require(encoded_ < most_encoded, "is too large with those before it");
            try {
                Pixels pixels = decode_image(bytes, budget);
                budget -= pixels.rgba.size() / 4;
                return pixels;
            } catch (const InputError& error) {
                fail(error.what(), shared);
            }
        });
    }

    Document& document_;
    Scene& scene_;
    std::size_t most_texels_;
    std::size_t texels_left_;
    std::size_t detail_left_;           // for textures that are linear
    std::size_t encoded_ = 0;           // bytes
    std::vector<ImageFormat> formats_;  // of every image
    std::map<std::tuple<int, Wrap, Wrap, bool, bool>, int> loaded_;
    std::map<int, Finish> finishes_;  // of images
};

// What an object of an extension says; the fallback where it says nothing.
double number_in(const Value& object, const char* key, double fallback) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

glm::dvec2 pair_in(const Value& object, const char* key, double fallback) {
    if (!object.Has(key)) return glm::dvec2(fallback);
    const Value& pair = object.Get(key);
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

// KHR_texture_transform: scale, then turn counter-clockwise as seen with v pointing down, then
// shift.
glm::mat3 uv_transform(const Value& transform) {
    const glm::dvec2 offset = pair_in(transform, "offset", 0.0);
    const glm::dvec2 scale = pair_in(transform, "scale", 1.0);
    const double angle = number_in(transform, "rotation", 0.0);
    for (const glm::dvec2& pair : {offset, scale}) {
        require(std::max(std::abs(pair.x), std::abs(pair.y)) <= 1e9,
                "has a texture that is shifted or scaled by more than 1e9");
    }
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return glm::mat3(glm::dmat3(c * scale.x, -s * scale.x, 0.0,  // first column
                                s * scale.y, c * scale.y, 0.0,   // second
                                offset.x, offset.y, 1.0));
}

// Info: of a colour or of normals.
template <typename Info>
TextureSlot read_slot(const Info& info, Warnings& warnings) {
    TextureSlot slot;
    if (info.index < 0) return slot;
    slot.texture = info.index;
    slot.uv_set = info.texCoord;
    if (const Value* transform = extension(info.extensions, "KHR_texture_transform")) {
        slot.transform = uv_transform(*transform);
        if (transform->Has("texCoord")) slot.uv_set = index_in(*transform, "texCoord");
    }
    if (slot.uv_set <= 1) return slot;
    warnings.add("a texture on TEXCOORD_2 or above is ignored");
    return {};
}

// Its slots name textures of the model.
Material read_material(const tinygltf::Material& source, const std::string& name,
                       Warnings& warnings) {
    // What leaves the range of the specification is sanitised, not refused.
    const auto clamped = [&](double number, double most, const std::string& warning) {
        if (number < 0.0 || number > most) warnings.add(warning);
        return std::clamp(number, 0.0, most);
    };
    const auto unit = [&](double number) {
        const char* warning = "a material factor outside 0..1 is clamped, first in ";
        return static_cast<float>(clamped(number, 1.0, warning + name));
    };
    const tinygltf::PbrMetallicRoughness& metal_rough = source.pbrMetallicRoughness;
    Material material;
    material.name = short_name(source.name);
    for (int i = 0; i < 4; ++i) material.base_color[i] = unit(metal_rough.baseColorFactor[i]);
    material.metallic = unit(metal_rough.metallicFactor);
    material.roughness = unit(metal_rough.roughnessFactor);
    material.specular = 1.0f;
    if (const Value* specular = extension(source.extensions, "KHR_materials_specular")) {
        material.specular = unit(number_in(*specular, "specularFactor", 1.0));
        for (const char* ignored :
             {"specularTexture", "specularColorFactor", "specularColorTexture"})
            if (specular->Has(ignored))
                warnings.add("of KHR_materials_specular only the factor is read, first in " + name);
    }
    if (const Value* ior = extension(source.extensions, "KHR_materials_ior")) {
        const double index = number_in(*ior, "ior", 1.5);
        const bool known = index == 0.0 || (index >= 1.0 && index <= 1e6);
        if (!known) warnings.add("an index of refraction outside 1..1e6 is taken for 1.5");
        material.ior = known ? static_cast<float>(index) : 1.5f;
    }
    material.base_texture = read_slot(metal_rough.baseColorTexture, warnings);
    material.metallic_roughness_texture = read_slot(metal_rough.metallicRoughnessTexture, warnings);
    material.normal_texture = read_slot(source.normalTexture, warnings);
    material.normal_scale =
        static_cast<float>(std::clamp(source.normalTexture.scale, -100.0, 100.0));
    const Value* emissive = extension(source.extensions, "KHR_materials_emissive_strength");
    double strength = 1.0;
    if (emissive && source.emissiveFactor != std::vector<double>(3, 0.0)) {
        strength = clamped(number_in(*emissive, "emissiveStrength", 1.0), 1e30,
                           "an emissive strength outside 0..1e30 is clamped");
    }
    for (int i = 0; i < 3; ++i) {
        material.emission[i] = static_cast<float>(unit(source.emissiveFactor[i]) * strength);
    }
    material.emission_texture = read_slot(source.emissiveTexture, warnings);
    if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::blend;
    if (source.alphaMode == "MASK") {
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
    }
    material.double_sided = source.doubleSided;
    if (extension(source.extensions, "KHR_materials_unlit")) {
        warnings.add("an unlit material is lit like any other");
    }
    return material;
}

}  // namespace

void load_materials(Document& document, const GltfOptions& options, Scene& scene) {
    TextureLoader textures(document, options, scene);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        const tinygltf::Material& source = document.model.materials[i];
        const std::string name = entry("materials", i);
        Material material = of_entry(
            "materials", i, [&] { return read_material(source, name, document.warnings); });
        material.base_texture.texture = textures.load(material.base_texture.texture);
        // A texture that is multiplied by black need not be there.
        const bool dark = material.emission == glm::vec3(0.0f);
        material.emission_texture.texture =
            dark ? -1 : textures.load(material.emission_texture.texture);
        textures.load_finish(std::exchange(material.metallic_roughness_texture, {}), material);
        material.normal_texture.texture = textures.load(material.normal_texture.texture, false);
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace clgi::io::gltf
