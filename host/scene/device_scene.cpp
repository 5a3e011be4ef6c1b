// SPDX-License-Identifier: MIT
#include <clgi/device_scene.hpp>

#include <clgi/shared/microfacet.h>
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <mutex>
#include <string>
#include <tuple>

#include "core/opencl/error_text.hpp"
#include "scene/box_tree.hpp"
#include "scene/clusters.hpp"
#include "scene/emission.hpp"
#include "scene/environment.hpp"
#include "scene/lamps.hpp"
#include "scene/local_frame.hpp"
#include "scene/locality.hpp"
#include "scene/luminance.hpp"
#include "scene/median_cut.hpp"
#include "scene/sky_cells.hpp"
#include "scene/sky_parts.hpp"
#include "scene/texture_pool.hpp"
#include "scene/validate.hpp"

namespace clgi {
namespace {

MaterialRecord record_of(const Material& material, double exposure) {
    MaterialRecord out{};
    const Reflectance shares = reflectance(material);
    out.base_color = material.base_color;
    const bool blended = material.alpha_mode == AlphaMode::blend;
    out.emission = glm::vec4(glm::dvec3(material.emission) / exposure,
                             blended ? ALPHA_BLENDED : material.alpha_cutoff);
    out.reflectance = glm::vec4(shares.diffuse, shares.coat, shares.lobe, shares.exponent);
    out.surface = surface_of(material);
    out.base_texture = material.base_texture.texture;
    out.base_uv_set = material.base_texture.uv_set;
    out.emission_texture = material.emission_texture.texture;
    out.emission_uv_set = material.emission_texture.uv_set;
    const auto row = [](const glm::mat3& m, int r) {
        return glm::vec4(m[0][r], m[1][r], m[2][r], 0.0f);
    };
    out.base_u = row(material.base_texture.transform, 0);
    out.base_v = row(material.base_texture.transform, 1);
    out.emission_u = row(material.emission_texture.transform, 0);
    out.emission_v = row(material.emission_texture.transform, 1);
    out.normal_texture = material.normal_texture.texture;
    out.normal_uv_set = material.normal_texture.uv_set;
    out.metallic_roughness_texture = material.metallic_roughness_texture.texture;
    out.metallic_roughness_uv_set = material.metallic_roughness_texture.uv_set;
    out.normal_u = row(material.normal_texture.transform, 0);
    out.normal_v = row(material.normal_texture.transform, 1);
    out.metallic_roughness_u = row(material.metallic_roughness_texture.transform, 0);
    out.metallic_roughness_v = row(material.metallic_roughness_texture.transform, 1);
    out.normal_u.w = material.normal_scale;
    out.metallic_roughness_u.w = material.metallic_roughness_factor.x;
    out.metallic_roughness_v.w = material.metallic_roughness_factor.y;
    return out;
}

class Uploader {
public:
    Uploader(const cl::Context& context, const cl::Device& device)
        : context_(context), most_(device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>()) {}

    // A buffer is never empty: kernels take all of them, also those a scene has no use for.
    template <typename T>
    cl::Buffer operator()(const char* what, std::vector<T> values,
                          cl_mem_flags access = CL_MEM_READ_ONLY) {
        if (values.empty()) values.resize(1);
        const std::size_t size = values.size() * sizeof(T);
        if (size > most_)
            throw DeviceError(std::string("scene: ") + what + " need " + std::to_string(size) +
                              " bytes in one buffer, the device allows " + std::to_string(most_));
        bytes += size;
        try {
            return cl::Buffer(context_, access | CL_MEM_COPY_HOST_PTR, size, values.data());
        } catch (const cl::Error& error) {
            throw DeviceError(std::string("scene: no room for ") + what + " (" +
                              std::to_string(size) + " bytes): " + error_text(error.err()));
        }
    }

    std::size_t bytes = 0;

private:
    cl::Context context_;
    std::size_t most_;
};

std::vector<glm::vec4> arranged(const std::vector<glm::vec4>& values,
                                const std::vector<std::uint32_t>& order) {
    std::vector<glm::vec4> out;
    if (values.empty()) return out;
    out.reserve(order.size());
    for (const std::uint32_t index : order) out.push_back(values[index]);
    return out;
}

}  // namespace

glm::vec4 surface_of(const Material& material) {
    const float root = (material.ior - 1.0f) / (material.ior + 1.0f);  // of 0: all is reflected
    return {material.metallic, microfacet_alpha(material.roughness),
            material.specular * root * root, material.specular};
}

Reflectance reflectance(const Material& material) {
    const glm::vec4 s = surface_of(material);
    const glm::vec4 means = microfacet_means(s.x, s.y, s.z, s.w);
    return {means.x, means.y, means.z, means.w};
}

// Copies of a scene share it until their environment is turned.
namespace {

Light as_light(const SkyLight& from) {
    Light out;
    out.kind = Light::Kind::directional;
    out.direction = glm::vec3(-from.toward);
    out.intensity = glm::vec3(from.lux);
    return out;
}

}  // namespace

struct DeviceScene::Cut {
    struct Part {
        int count = 0;
        std::vector<Light> lights;
        std::optional<SkyCells> cells;
        std::shared_ptr<const SkyWeights> weights;  // of the cells
    };
    const SkyParts& parts(const Environment& of) {
        if (!found) found = sky_parts(of);
        return *found;
    }
    // Null where the part does not exist.
    const Environment* environment(const Environment& of, SkyPart part) {
        if (part == SkyPart::whole) return &of;
        const SkyParts& known = parts(of);
        if (part == SkyPart::soft) return &known.soft;
        return known.found.share > 0.0 ? &known.bright : nullptr;
    }
    std::mutex mutex;
    std::optional<SkyParts> found;
    std::array<Part, 3> of;  // by SkyPart
};

DeviceScene::DeviceScene(const cl::Context& context, const cl::Device& device, const Scene& scene) {
    validate(scene);
    if (!scene.triangles.empty())
        frame_ = local_frame(united(bounds(scene), scene.moving_bounds), scene.focus);
    frame_.exposure = common_exposure(scene, frame_);
    lights_ = scene.lights;

    std::vector<glm::vec4> local;
    local.reserve(scene.positions.size());
    for (const glm::dvec3& position : scene.positions)
        local.emplace_back(frame_.to_local(position), 0.0f);
    const SpatialOrder order = spatial_order(local, scene.triangles);
    triangle_order_ = order.triangles;
    vertex_order_ = order.vertices;
    file_vertex_count_ = scene.positions.size();
    const std::vector<glm::vec4> positions = arranged(local, order.vertices);
    const std::vector<glm::vec4> uvs = arranged(scene.uvs, order.vertices);
    const std::vector<glm::vec4> colors = arranged(scene.colors, order.vertices);
    std::vector<glm::vec4> normals;
    for (const std::uint32_t vertex : order.vertices)
        normals.emplace_back(scene.normals[vertex], 0.0f);
    std::vector<MaterialRecord> materials;
    bool emits = false;
    for (const Material& material : scene.materials) {
        materials.push_back(record_of(material, frame_.exposure));
        emits = emits || luminance(material.emission) > 0.0f;
        const Reflectance shares = reflectance(material);
        const bool finished = material.metallic_roughness_texture.texture >= 0;
        if (finished || shares.coat + shares.lobe > 1e-4f)
            least_alpha_ =
                std::min(least_alpha_, finished ? 0.0f : microfacet_alpha(material.roughness));
        if (finished || shares.diffuse != 1.0f) info_.flags |= SCENE_HAS_SHARES;
        if (finished || material.normal_texture.texture >= 0) info_.flags |= SCENE_HAS_DETAIL;
        has_blended_ = has_blended_ || material.alpha_mode == AlphaMode::blend;
        has_masks_ = has_masks_ || material.alpha_mode != AlphaMode::opaque;
    }
    const EmissionMeans emission(scene);

    std::vector<glm::uvec4> triangles;
    triangles.reserve(scene.triangles.size());
    for (const std::uint32_t index : order.triangles) {
        const SceneTriangle& triangle = scene.triangles[index];
        const Material& material = scene.materials[triangle.material];
        std::uint32_t word = triangle.material;
        if (material.double_sided) word |= static_cast<std::uint32_t>(TRIANGLE_DOUBLE_SIDED);
        if (material.alpha_mode != AlphaMode::opaque) word |= TRIANGLE_MASKED;
        std::uint32_t corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = order.renumbered[triangle.vertex[k]];
        triangles.emplace_back(corner[0], corner[1], corner[2], word);

        const glm::vec3 radiance(emission(triangle) / frame_.exposure);
        if (!(luminance(radiance) > 0.0f)) continue;
        Glowing& glowing = glowing_.emplace_back();
        glowing.triangle = index;
        glowing.vertex = glm::uvec3(corner[0], corner[1], corner[2]);
        for (int k = 0; k < 3; ++k) glowing.corner[k] = glm::vec3(positions[corner[k]]);
        glowing.radiance = radiance;
        glowing.double_sided = material.double_sided;
    }
    find_lamps();
    list_emissive();

    TexturePool pool = make_texture_pool(scene.textures);
    info_.vertex_count = static_cast<std::uint32_t>(positions.size());
    info_.triangle_count = static_cast<std::uint32_t>(triangles.size());
    std::vector<Cluster> clusters = make_clusters(triangles, positions);
    BoxTree tree = make_box_tree(clusters);
    std::vector<PartCorners> parts = make_parts(triangles, positions);
    info_.cluster_count = static_cast<std::uint32_t>(clusters.size());
    if (!scene.uvs.empty()) info_.flags |= SCENE_HAS_UVS;
    if (!scene.colors.empty()) info_.flags |= SCENE_HAS_COLORS;
    if (!scene.textures.empty()) info_.flags |= SCENE_HAS_TEXTURES;
    if (emits) info_.flags |= SCENE_HAS_EMISSION;

    Uploader upload(context, device);
    triangles_ = upload("triangles", std::move(triangles));
    // What SceneMover writes.
    positions_ = upload("positions", positions, CL_MEM_READ_WRITE);
    normals_ = upload("normals", std::move(normals), CL_MEM_READ_WRITE);
    uvs_ = upload("texture coordinates", uvs);
    colors_ = upload("vertex colors", colors);
    clusters_ = upload("clusters", std::move(clusters), CL_MEM_READ_WRITE);
    nodes_ = upload("boxes around clusters", std::move(tree.nodes), CL_MEM_READ_WRITE);
    node_levels_ = std::move(tree.levels);
    parts_ = upload("corners of triangles", std::move(parts), CL_MEM_READ_WRITE);
    materials_ = upload("materials", std::move(materials));
    textures_ = upload("texture records", std::move(pool.records));
    texels_ = upload("texels", std::move(pool.texels));
    decode_ = upload("the sRGB table", srgb_decode_table());
    if (scene.environment) {
        environment_ = with_picture(*scene.environment);
        uploaded_rotation_ = environment_->rotation;
        cut_ = std::make_shared<Cut>();
        environment_texels_ = upload("environment texels", environment_->texels);
    }
    bytes_ = upload.bytes;
}

void DeviceScene::find_lamps() {
    std::vector<std::array<glm::vec3, 3>> triangles;
    for (const Glowing& g : glowing_) triangles.push_back({g.corner[0], g.corner[1], g.corner[2]});
    const std::vector<std::uint32_t> lamps = lamps_of(triangles);
    for (std::size_t i = 0; i < lamps.size(); ++i) glowing_[i].lamp = lamps[i];
}

// Lamp by lamp, and those of one along a Z-order curve, so that moved ones are sampled as loaded
// ones are.
void DeviceScene::list_emissive() {
    std::vector<std::pair<std::uint32_t, const Glowing*>> order;
    for (const Glowing& g : glowing_)
        order.emplace_back(place_on_curve(g.corner[0], g.corner[1], g.corner[2]), &g);
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return std::tie(a.second->lamp, a.first, a.second->triangle) <
               std::tie(b.second->lamp, b.first, b.second->triangle);
    });
    emissive_.clear();
    for (const auto& [place, glowing] : order) {
        EmissiveTriangle source;
        std::copy(glowing->corner, glowing->corner + 3, source.corner);
        const glm::vec3 normal =
            glm::cross(source.corner[1] - source.corner[0], source.corner[2] - source.corner[0]);
        const float twice_area = glm::length(normal);
        if (!(twice_area > 0.0f)) continue;
        source.normal = normal / twice_area;
        source.area = 0.5f * twice_area;
        source.radiance = glowing->radiance;
        source.lamp = glowing->lamp;
        emissive_.push_back(source);
        if (!glowing->double_sided) continue;
        source.normal = -source.normal;
        emissive_.push_back(source);
    }
}

std::vector<Light> DeviceScene::environment_lights(int count, SkyPart part) const {
    if (!environment_) return {};
    const std::lock_guard lock(cut_->mutex);
    const Environment* environment = cut_->environment(*environment_, part);
    if (!environment) return {};
    Cut::Part& kept = cut_->of[static_cast<std::size_t>(part)];
    if (kept.count == count) return kept.lights;
    std::vector<Light> lights;
    for (const SkyLight& light : median_cut(*environment, count)) lights.push_back(as_light(light));
    kept.lights = std::move(lights);
    kept.count = count;
    return kept.lights;
}

std::vector<Light> DeviceScene::drawn_environment_lights(
    const std::vector<glm::dvec2>& places, const std::shared_ptr<const SkyWeights>& weights,
    SkyPart part) const {
    if (!environment_ || places.empty()) return {};
    const std::lock_guard lock(cut_->mutex);
    const Environment* environment = cut_->environment(*environment_, part);
    if (!environment) return {};
    Cut::Part& kept = cut_->of[static_cast<std::size_t>(part)];
    if (!kept.cells || kept.weights != weights) {
        kept.cells.emplace(*environment, weights ? *weights : SkyWeights());
        kept.weights = weights;
    }
    std::vector<Light> lights;
    for (const glm::dvec2& place : places) lights.push_back(as_light(kept.cells->drawn(place)));
    const float share = 1.0f / static_cast<float>(places.size());
    for (Light& light : lights) light.intensity *= share;
    return lights;
}

std::optional<Environment> DeviceScene::environment_part(SkyPart part) const {
    if (!environment_) return std::nullopt;
    const std::lock_guard lock(cut_->mutex);
    const Environment* environment = cut_->environment(*environment_, part);
    return environment ? std::optional(*environment) : std::nullopt;
}

BrightSky DeviceScene::bright_sky() const {
    if (!environment_) return {};
    const std::lock_guard lock(cut_->mutex);
    return cut_->parts(*environment_).found;
}

void DeviceScene::turn_environment(double angle) {
    if (!environment_) throw Error("scene: turn_environment(): there is no environment");
    if (!std::isfinite(angle)) throw Error("scene: turn_environment(): the angle is not finite");
    environment_->rotation = static_cast<float>(uploaded_rotation_ + angle);
    auto turned = std::make_shared<Cut>();
    {
        const std::lock_guard lock(cut_->mutex);
        turned->found = cut_->found;  // the parts turn as one
    }
    if (turned->found)
        turned->found->soft.rotation = turned->found->bright.rotation = environment_->rotation;
    cut_ = std::move(turned);
}

void DeviceScene::set_light(std::size_t index, const Light& light) {
    if (index >= lights_.size())
        throw Error("scene: light " + std::to_string(index) + " was to be set, there are " +
                    std::to_string(lights_.size()));
    validate_light(light, index);
    lights_[index] = light;
}

void DeviceScene::set_lights(const std::vector<Light>& lights) {
    if (lights.size() != lights_.size())
        throw Error("scene: " + std::to_string(lights.size()) +
                    " lights were to be set, there are " + std::to_string(lights_.size()));
    for (std::size_t i = 0; i < lights.size(); ++i) validate_light(lights[i], i);
    lights_ = lights;
}

std::array<const cl::Buffer*, 9> DeviceScene::kernel_arguments() const {
    return {&triangles_, &positions_, &normals_, &uvs_,   &colors_,
            &materials_, &textures_,  &texels_,  &decode_};
}

View make_view(const Camera& camera, const SceneFrame& frame, int width, int height) {
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        throw Error("view: the image is " + std::to_string(width) + "x" + std::to_string(height) +
                    ", 1x1 to 16384x16384 needed");
    View view{};
    const glm::vec3 eye = frame.to_local(camera.position);
    const bool orthographic = camera.kind == Camera::Kind::orthographic;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const float half_height = orthographic ? static_cast<float>(camera.half_height * frame.scale)
                                           : std::tan(0.5f * camera.vertical_fov);
    float near = static_cast<float>(camera.near * frame.scale);
    if (!orthographic && !(near > 0.0f)) near = 1e-3f * frame.detail;
    view.eye = glm::vec4(eye, orthographic ? 1.0f : 0.0f);
    view.right = glm::vec4(camera.right, half_height * aspect);
    view.up = glm::vec4(camera.up, half_height);
    view.forward = glm::vec4(camera.forward, near);
    // Beyond everything: the eye's distance from the centre and the scene's radius.
    view.window.z = near + 1.01f * (glm::length(eye) + frame.radius) + 1e-3f;
    view.window.x = 2.0f * camera.offset.x / static_cast<float>(width) * view.right.w;
    view.window.y = -2.0f * camera.offset.y / static_cast<float>(height) * view.up.w;
    view.window.w = camera.footprint;
    view.width = static_cast<std::uint32_t>(width);
    view.height = static_cast<std::uint32_t>(height);
    view.flags = VIEW_CULL_BACK_FACES;
    return view;
}

}  // namespace clgi
