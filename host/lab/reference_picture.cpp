// SPDX-License-Identifier: MIT
#include "lab/reference_picture.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <cstdlib>
#include <type_traits>

#include "scene/lightmap_uvs.hpp"

namespace clgi::lab {
namespace {

// A hash of any data, to tell inputs apart: FNV-1a, 64 bits.
class Hash {
public:
    // Numbers and what is made of them alone, texts, and vectors with their length.
    template <typename... T>
    void add(const T&... values) {
        (put(values), ...);
    }
    std::string text() const { return fmt::format("{:016x}", state_); }

private:
    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes(&value, sizeof value);
    }
    template <typename T>
    void put(const std::vector<T>& values) {
        put(values.size());
        for (const T& value : values) put(value);
    }
    void put(const std::string& text) { bytes(text.data(), text.size()); }
    void bytes(const void* data, std::size_t size) {
        const auto* byte = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ byte[i]) * 0x100000001b3u;
    }
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::string picture_key(const std::string& scene, const Camera& camera,
                        const reference::Options& options) {
    Hash hash;
    hash.add(tracer_version, scene, camera.kind, camera.position, camera.right, camera.up,
             camera.forward, camera.vertical_fov, camera.half_height, camera.near, options.width,
             options.height, options.samples, options.target, options.seed, options.roulette_depth,
             options.filter);
    return hash.text();
}

std::map<std::string, std::string> traced_attributes(const std::string& effects, int samples,
                                                     double relative_error) {
    return {{"clgi:effects", effects.empty() ? "all" : effects},
            {"clgi:samples", std::to_string(samples)},
            {"clgi:relative_error", fmt::format("{:.6g}", relative_error)}};
}

void add_place(AtlasPlaces& atlas, const Scene& scene, const UvTexel& texel) {
    const UvPlace place = place_at(scene, texel);
    atlas.texels.push_back(texel.texel);
    atlas.places.push_back({place.position, glm::vec3(place.normal), glm::vec3(place.geometric)});
}

}  // namespace

io::Image reference_image(const reference::Picture& picture, const std::string& effects) {
    io::Image out;
    out.width = picture.width;
    out.height = picture.height;
    out.attributes = traced_attributes(effects, picture.samples, picture.relative_error);
    out.attributes["clgi:quantity"] = "radiance";
    out.attributes["clgi:unit"] = "cd/m^2";
    for (int c = 0; c < 3; ++c) {
        io::Image::Channel channel{std::string(1, "RGB"[c]), {}};
        for (const glm::vec3& radiance : picture.radiance) channel.values.push_back(radiance[c]);
        out.channels.push_back(std::move(channel));
    }
    out.channels.push_back({"error.Y", picture.error});
    return out;
}

io::Image blank_irradiance(int width, int height, const std::vector<const char*>& planes) {
    io::Image out;
    out.width = width;
    out.height = height;
    out.attributes = {{"clgi:quantity", "irradiance"}, {"clgi:unit", "lux"}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (const char* name : planes)
        out.channels.push_back({name, std::vector<float>(pixels, 0.0f)});
    return out;
}

void set_rgb(io::Image& picture, std::size_t pixel, const glm::vec3& color) {
    for (int c = 0; c < 3; ++c)
        picture.channels[static_cast<std::size_t>(c)].values[pixel] = color[c];
}

io::Image irradiance_image(io::Image blank, const std::vector<std::uint32_t>& pixels,
                           const reference::Irradiance& found, const std::string& effects) {
    blank.attributes.merge(traced_attributes(effects, found.samples, found.relative_error));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        set_rgb(blank, pixels[i], found.values[i]);
        blank.channels.back().values[pixels[i]] = found.error[i];
    }
    return blank;
}

double stated_error(const io::Image& picture) {
    const auto found = picture.attributes.find("clgi:relative_error");
    return found == picture.attributes.end() ? 0.0 : std::atof(found->second.c_str());
}

std::string scene_key(const Scene& scene) {
    Hash hash;
    hash.add(scene.positions, scene.normals, scene.uvs, scene.colors, scene.triangles);
    for (const Material& material : scene.materials) {
        for (const TextureSlot* slot : texture_slots(material))
            hash.add(slot->texture, slot->uv_set, slot->transform);
        hash.add(material.base_color, material.metallic, material.roughness, material.specular,
                 material.ior, material.metallic_roughness_factor, material.normal_scale,
                 material.emission, material.alpha_mode, material.alpha_cutoff,
                 material.double_sided);
    }
    for (const Texture& texture : scene.textures)
        hash.add(texture.rgba, texture.width, texture.wrap_s, texture.wrap_t, texture.nearest,
                 texture.srgb);
    for (const Light& light : scene.lights)
        hash.add(light.kind, light.position, light.direction, light.intensity, light.range,
                 light.inner_angle, light.outer_angle);
    if (scene.environment) {
        hash.add(scene.environment->texels, scene.environment->width, scene.environment->factor,
                 scene.environment->rotation);
    }
    return hash.text();
}

io::Image kept_image(const std::filesystem::path& file, const std::string& key,
                     const std::function<io::Image()>& make) {
    if (std::filesystem::exists(file)) {
        try {
            io::Image kept = io::load_image(file);
            const auto found = kept.attributes.find("clgi:key");
            if (found != kept.attributes.end() && found->second == key) return kept;
        } catch (const InputError&) {
            // Broken or another program's: made anew.
        }
    }
    io::Image out = make();
    if (out.channels.empty()) return out;
    out.attributes["clgi:key"] = key;
    io::save_exr(out, file, io::PixelType::full);
    return out;
}

io::Image cached_reference(const reference::PathTracer& tracer, const Camera& camera,
                           const reference::Options& options, const std::string& effects,
                           const std::filesystem::path& file, const std::string& scene,
                           const Progress& progress) {
    const std::string key = picture_key(scene, camera, options) + " " + effects;
    return kept_image(file, key, [&] {
        const reference::Picture picture = tracer.render(camera, options, progress);
        return picture.cancelled ? io::Image() : reference_image(picture, effects);
    });
}

AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set) {
    const std::vector<int> sets = uv_set < 0 ? std::vector<int>{1, 0} : std::vector<int>{uv_set};
    const LightmapUvs lightmap = lightmap_uvs(scene, size, sets);
    if (lightmap.uv_set < 0) throw InputError("atlas: there is no lightmap: " + lightmap.faults);
    AtlasPlaces out;
    out.size = size;
    out.uv_set = lightmap.uv_set;
    out.warnings = lightmap.warnings;
    for (const UvTexel& texel : lightmap.found.texels) add_place(out, scene, texel);
    return out;
}

AtlasPlaces atlas_places(const Scene& scene, const AtlasLayout& layout) {
    AtlasPlaces out;
    out.size = layout.size;
    out.pages = layout.pages;
    out.uv_set = layout.uv_set;
    for (const AtlasTexel& texel : layout.texels)
        if (texel.centre)
            add_place(out, scene,
                      {texel.texel, texel.triangle, double{texel.b1}, double{texel.b2}});
    return out;
}

io::Image atlas_image(const AtlasPlaces& atlas, const reference::Irradiance& irradiance,
                      const std::string& effects) {
    io::Image out = irradiance_image(
        blank_irradiance(atlas.size, atlas.size * atlas.pages, {"R", "G", "B", "A", "error.Y"}),
        atlas.texels, irradiance, effects);
    out.attributes["clgi:uv_set"] = std::to_string(atlas.uv_set);
    for (const std::uint32_t texel : atlas.texels) out.channels[3].values[texel] = 1.0f;
    return out;
}

io::Image cached_atlas(const reference::PathTracer& tracer, const AtlasPlaces& atlas,
                       const reference::Options& options, const std::string& effects,
                       const std::filesystem::path& file, const std::string& scene,
                       const Progress& progress) {
    Hash hash;
    hash.add(tracer_version, scene, effects, atlas.size, atlas.pages, atlas.texels);
    for (const reference::Place& place : atlas.places)
        hash.add(place.position, place.normal, place.geometric);
    hash.add(options.samples, options.target, options.seed, options.roulette_depth);
    return kept_image(file, "atlas " + hash.text(), [&] {
        const reference::Irradiance found = tracer.irradiance(atlas.places, options, progress);
        return found.cancelled ? io::Image() : atlas_image(atlas, found, effects);
    });
}

}  // namespace clgi::lab
