// SPDX-License-Identifier: MIT
#include "io/gltf_textures.hpp"

#include <clgi/error.hpp>

#include "io/gltf_source.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::size_t most_encoded = std::size_t{1} << 32;  // bytes, of all images read

Wrap wrap(int code) {
    if (code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirrored_repeat;
    return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ? Wrap::clamp_to_edge : Wrap::repeat;
}

}  // namespace

TextureLoader::TextureLoader(Document& document, const std::filesystem::path& folder,
                             const GltfOptions& options, Scene& scene)
    : document_(document),
      folder_(folder),
      scene_(scene),
      texels_left_(options.max_texels),
      averaged_left_(options.max_texels),
      most_texels_(options.max_texels) {}

void TextureLoader::check_images() {
    for (std::size_t i = 0; i < document_.model.images.size(); ++i) {
        const tinygltf::Image& image = document_.model.images[i];
        if (image.bufferView >= 0 && image.mimeType.empty()) {
            refuse(entry("images", i), "is in a buffer view, but says no mimeType");
        }
        std::vector<std::uint8_t> held;
        of_entry("images", i, [&] {
            formats_.push_back(
                inspect_image(image_bytes(document_.model, i, folder_, inspected_bytes, held)));
        });
        check_types(i);
    }
}

// What a data uri says of itself must be true; files and views are known by their bytes alone.
void TextureLoader::check_types(std::size_t image) const {
    const MediaTypes& types = document_.image_types[image];
    for (const std::string& type : {types.header, types.member}) {
        if (!contradicts(type, formats_[image])) continue;
        refuse(entry("images", image), "calls its data " + printable(type) + ", but they are a " +
                                           (formats_[image] == ImageFormat::png ? "PNG" : "JPEG"));
    }
}

int TextureLoader::load(int texture) {
    if (texture < 0) return -1;
    const tinygltf::Texture& source = document_.model.textures[texture];
    if (!is_readable(source.source)) return -1;
    const tinygltf::Sampler sampler =
        source.sampler < 0 ? tinygltf::Sampler() : document_.model.samplers[source.sampler];
    const Wrap wrap_s = wrap(sampler.wrapS);
    const Wrap wrap_t = wrap(sampler.wrapT);
    const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    const auto key = std::make_tuple(source.source, wrap_s, wrap_t, nearest);
    const auto known = loaded_.find(key);
    if (known != loaded_.end()) return known->second;

    Pixels pixels = decode(source.source, texels_left_);
    const tinygltf::Image& image = document_.model.images[source.source];
    const std::string name = image.name.empty() ? printable(image.uri) : short_name(image.name);
    scene_.textures.push_back(
        {name, pixels.width, pixels.height, std::move(pixels.rgba), wrap_s, wrap_t, nearest});
    return loaded_[key] = static_cast<int>(scene_.textures.size()) - 1;
}

MetalRough TextureLoader::mean_metal_rough(int texture) {
    if (texture < 0 || !is_readable(document_.model.textures[texture].source)) return {};
    const int image = document_.model.textures[texture].source;
    const auto known = means_.find(image);
    if (known != means_.end()) return known->second;

    const Pixels pixels = decode(image, averaged_left_);
    std::uint64_t green = 0;
    std::uint64_t blue = 0;
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        green += pixels.rgba[i + 1];
        blue += pixels.rgba[i + 2];
    }
    const double full = 255.0 * static_cast<double>(pixels.rgba.size() / 4);
    return means_[image] = {static_cast<double>(blue) / full, static_cast<double>(green) / full};
}

bool TextureLoader::is_readable(int image) {
    if (image >= 0 && formats_[image] != ImageFormat::unsupported) return true;
    document_.warnings.add("a texture in a format that is not read is taken as white");
    return false;
}

// Takes the texels from a budget, so that a thousand images of one small file stay bounded.
Pixels TextureLoader::decode(std::size_t image, std::size_t& budget) {
    const char* shared = budget < most_texels_ ? " (with those before it)" : "";
    return of_entry("images", image, [&] {
        std::vector<std::uint8_t> held;
        const Bytes bytes =
            image_bytes(document_.model, image, folder_, most_encoded - encoded_, held);
        encoded_ += bytes.size();
        if (encoded_ >= most_encoded) throw InputError("is too large with those before it");
        try {
            Pixels pixels = decode_image(bytes, budget);
            budget -= pixels.rgba.size() / 4;
            return pixels;
        } catch (const InputError& error) {
            throw InputError(error.what() + std::string(shared));
        }
    });
}

}  // namespace clgi::io::gltf
