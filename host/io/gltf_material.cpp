// SPDX-License-Identifier: MIT
#include "io/gltf_material.hpp"

#include <clgi/error.hpp>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "io/gltf_buffer.hpp"
#include "io/gltf_image.hpp"
#include "io/gltf_uri.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::size_t most_encoded = std::size_t{1} << 32;  // bytes, of all images read

struct MetalRough {
    double metallic = 1.0;
    double roughness = 1.0;
};

class TextureLoader {
public:
    TextureLoader(Document& document, const std::filesystem::path& folder,
                  const GltfOptions& options, Scene& scene)
        : document_(document),
          folder_(folder),
          scene_(scene),
          texels_left_(options.max_texels),
          averaged_left_(options.max_texels),
          most_texels_(options.max_texels) {}

    // Index into scene.textures; -1 where there is no image that can be read.
    int load(int texture) {
        if (texture < 0) return -1;
        const TextureSource& source = document_.textures[texture];
        if (!is_readable(source.picture)) return -1;
        const Sampler sampler = source.sampler < 0 ? Sampler{} : document_.samplers[source.sampler];
        const auto key =
            std::make_tuple(source.picture, sampler.wrap_s, sampler.wrap_t, sampler.nearest);
        const auto known = loaded_.find(key);
        if (known != loaded_.end()) return known->second;

        Pixels pixels = decode(source.picture, texels_left_);
        Texture result;
        const Picture& picture = document_.pictures[source.picture];
        result.name = picture.name;
        if (result.name.empty() && !is_data_uri(picture.uri)) result.name = printable(picture.uri);
        result.width = pixels.width;
        result.height = pixels.height;
        result.rgba = std::move(pixels.rgba);
        result.wrap_s = sampler.wrap_s;
        result.wrap_t = sampler.wrap_t;
        result.nearest = sampler.nearest;
        scene_.textures.push_back(std::move(result));
        return loaded_[key] = static_cast<int>(scene_.textures.size()) - 1;
    }

    // The means of a texture's blue and green, which multiply the factors.
    MetalRough mean_metal_rough(int texture) {
        if (texture < 0 || !is_readable(document_.textures[texture].picture)) return {};
        const int picture = document_.textures[texture].picture;
        const auto known = means_.find(picture);
        if (known != means_.end()) return known->second;

        const Pixels pixels = decode(picture, averaged_left_);
        std::uint64_t green = 0;
        std::uint64_t blue = 0;
        for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
            green += pixels.rgba[i + 1];
            blue += pixels.rgba[i + 2];
        }
        const double full = 255.0 * static_cast<double>(pixels.rgba.size() / 4);
        return means_[picture] = {static_cast<double>(blue) / full,
                                  static_cast<double>(green) / full};
    }

    // Every image, used or not, must exist and be what it says.
    void check_pictures() {
        for (std::size_t i = 0; i < document_.pictures.size(); ++i) {
            const int picture = static_cast<int>(i);
            std::vector<std::uint8_t> held;
            const Bytes bytes = read(picture, inspected_bytes, held);
            try {
                formats_.push_back(inspect_image(bytes));
            } catch (const InputError& error) {
                fail(picture, error.what());
            }
            check_types(picture);
        }
    }

private:
    [[noreturn]] void fail(int picture, const std::string& what) const {
        throw InputError("images[" + std::to_string(picture) + "] " + what);
    }

    // What a data uri says of itself must be true; files and views are known by their bytes alone.
    void check_types(int picture) const {
        const Picture& source = document_.pictures[picture];
        if (!is_data_uri(source.uri)) return;
        for (const std::string_view type :
             {data_uri_type(source.uri), std::string_view(source.mime)}) {
            if (!contradicts(type, formats_[picture])) continue;
            fail(picture, "calls its data " + printable(std::string(type)) + ", but they are a " +
                              (formats_[picture] == ImageFormat::png ? "PNG" : "JPEG"));
        }
    }

    Bytes read(int picture, std::size_t limit, std::vector<std::uint8_t>& held) {
        try {
            return picture_bytes(document_, document_.pictures[picture], folder_, limit, held);
        } catch (const InputError& error) {
            fail(picture, error.what());
        }
    }

    bool is_readable(int picture) {
        if (picture >= 0 && formats_[picture] != ImageFormat::unsupported) return true;
        document_.warnings.add("a texture in a format that is not read is taken as white");
        return false;
    }

    // Takes the texels from a budget, so that a thousand images of one small file stay bounded.
    Pixels decode(int picture, std::size_t& budget) {
        std::vector<std::uint8_t> held;
        const Bytes bytes = read(picture, most_encoded - encoded_, held);
        encoded_ += bytes.size();
        if (encoded_ >= most_encoded) fail(picture, "is too large with those before it");
        try {
            Pixels pixels = decode_image(bytes, budget);
            budget -= pixels.rgba.size() / 4;
            return pixels;
        } catch (const InputError& error) {
            const bool partly_used = budget < most_texels_;
            fail(picture, error.what() + std::string(partly_used ? " (with those before it)" : ""));
        }
    }

    Document& document_;
    const std::filesystem::path& folder_;
    Scene& scene_;
    std::size_t texels_left_;
    std::size_t averaged_left_;
    std::size_t most_texels_;
    std::size_t encoded_ = 0;
    std::vector<ImageFormat> formats_;  // of every picture
    std::map<std::tuple<int, Wrap, Wrap, bool>, int> loaded_;
    std::map<int, MetalRough> means_;
};

}  // namespace

void load_materials(Document& document, const std::filesystem::path& folder,
                    const GltfOptions& options, Scene& scene) {
    TextureLoader textures(document, folder, options, scene);
    textures.check_pictures();
    for (const MaterialSource& source : document.materials) {
        Material material = source.material;
        material.base_texture.texture = textures.load(material.base_texture.texture);
        // A texture that is multiplied by black need not be there.
        const bool dark = material.emission == glm::vec3(0.0f);
        material.emission_texture.texture =
            dark ? -1 : textures.load(material.emission_texture.texture);
        const MetalRough mean = textures.mean_metal_rough(source.metal_rough_texture);
        material.metallic *= static_cast<float>(mean.metallic);
        material.roughness *= static_cast<float>(mean.roughness);
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace clgi::io::gltf
