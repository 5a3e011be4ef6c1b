// SPDX-License-Identifier: MIT
#include "lab/reference_picture.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <cstdlib>

#include "lab/hash.hpp"

namespace clgi::lab {
namespace {

std::string picture_key(const std::string& scene, const Camera& camera,
                        const reference::Options& options) {
    Hash hash;
    hash.add(tracer_version, scene, camera.kind, camera.position, camera.right, camera.up,
             camera.forward, camera.vertical_fov, camera.half_height, camera.near, options.width,
             options.height, options.samples, options.target, options.seed, options.roulette_depth);
    return hash.text();
}

std::map<std::string, std::string> traced_attributes(const std::string& effects, int samples,
                                                     double relative_error) {
    return {{"clgi:effects", effects.empty() ? "all" : effects},
            {"clgi:samples", std::to_string(samples)},
            {"clgi:relative_error", fmt::format("{:.6g}", relative_error)}};
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
        const TextureSlot &base = material.base_texture, &emission = material.emission_texture;
        hash.add(material.base_color, base.texture, base.uv_set, base.transform, material.metallic,
                 material.roughness, material.emission, emission.texture, emission.uv_set,
                 emission.transform, material.alpha_mode, material.alpha_cutoff,
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

}  // namespace clgi::lab
