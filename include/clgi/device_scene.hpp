// A scene's buffers on the device, in the local frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/shared/scene.h>
#include <array>
#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <memory>

namespace clgi {

// local = (world - origin) * scale. The scale is a power of two that brings the radius of the
// scene, or of its focus, into [0.5, 1), so neither size nor place of a scene costs precision: a
// scene moved or scaled by powers of two gives the same bits. Light is exposed by a power of two as
// well: radiance on the device is radiance / exposure.
struct SceneFrame {
    glm::dvec3 origin = glm::dvec3(0.0);
    double scale = 1.0;
    double exposure = 1.0;
    float radius = 1.0f;  // of a sphere around the origin that holds the scene
    float detail = 1.0f;  // of the focus: lifts, biases and near planes are shares of it
    // A box that holds the scene, local units: shadow maps of directional lights reach that far.
    glm::vec3 low = glm::vec3(-1.0f), high = glm::vec3(1.0f);

    glm::vec3 to_local(const glm::dvec3& world) const {
        return glm::vec3((world - origin) * scale);
    }
};

// A triangle that emits, in the local frame.
struct EmissiveTriangle {
    glm::vec3 corner[3];
    glm::vec3 normal;                      // unit, the side that emits
    float area = 0.0f;                     // local units squared
    glm::vec3 radiance = glm::vec3(0.0f);  // exposed; mean over the triangle's texels
    std::uint32_t lamp = 0;  // triangles with common corners are one lamp, as the scene was loaded
};

// How much the light of each part of an environment counts: [rows][columns], above 0, over the
// whole of its picture.
struct SkyWeights {
    int columns = 0, rows = 0;
    std::vector<float> values;
};

// Parts of an environment: what is brighter than 16 times the mean luminance over all directions
// (the sun, lamps), less that, and the rest. Without such light the rest is all.
enum class SkyPart { whole, soft, bright };

struct BrightSky {
    double share = 0.0;        // of the environment's luminance over all directions; 0: none
    double solid_angle = 0.0;  // steradians, of an even disc whose directions differ as much
};

// Copies share their buffers; SceneMover moves the geometry of all of them, but lists what emits
// for one.
class CLGI_API DeviceScene {
public:
    // Validates and uploads; the scene itself is not needed afterwards.
    // Throws InputError for a broken scene, DeviceError when the device has no room for it.
    DeviceScene(const cl::Context& context, const cl::Device& device, const Scene& scene);

    const SceneFrame& frame() const { return frame_; }
    const SceneInfo& info() const { return info_; }
    const std::vector<Light>& lights() const { return lights_; }
    const std::vector<EmissiveTriangle>& emissive() const { return emissive_; }
    // An environment of one colour has a picture of one texel.
    const std::optional<Environment>& environment() const { return environment_; }
    // At most `count` directional lights that approximate it [Debevec05], with all of its light.
    // Computed at the first call and kept until another count is given, for each part. May be
    // called by several threads.
    std::vector<Light> environment_lights(int count, SkyPart part = SkyPart::whole) const;
    // One directional light for each place of [0,1)², drawn from the environment by its luminance,
    // where this counts by `weights` (null: everywhere alike): the mean over places is the light of
    // the environment. Kept and called as above.
    std::vector<Light> drawn_environment_lights(
        const std::vector<glm::dvec2>& places,
        const std::shared_ptr<const SkyWeights>& weights = nullptr,
        SkyPart part = SkyPart::whole) const;
    // Kept as above. A part that does not exist is empty, as is any without an environment.
    std::optional<Environment> environment_part(SkyPart part) const;
    BrightSky bright_sky() const;
    bool has_lobes() const { return least_alpha_ <= 1.0f; }  // some material is not purely diffuse
    float least_alpha() const { return least_alpha_; }  // of its lobes; 0 where textures say it
    bool needs_textures() const {  // some surface has a texture, a mask or is blended
        return has_masks_ || (info_.flags & SCENE_HAS_TEXTURES) != 0;
    }
    bool has_blended() const { return has_blended_; }  // some material is AlphaMode::blend
    std::size_t bytes() const { return bytes_; }

    // Triangles lie on the device in an order that follows space. [triangle_count] the scene's
    // index of each; triangle indices in G-buffers are those of the device.
    const std::vector<std::uint32_t>& triangle_order() const { return triangle_order_; }
    // The same for vertices: [vertex_count] the scene's index of each. Vertices without a triangle
    // are not on the device.
    const std::vector<std::uint32_t>& vertex_order() const { return vertex_order_; }
    // Vertices of the scene, those included that are not on the device.
    std::size_t file_vertex_count() const { return file_vertex_count_; }

    // Replaces a light; solvers then need lights_changed(). The exposure stays as it was.
    // Throws Error when there is no such light, InputError for one that validate() refuses; the
    // old one stays.
    void set_light(std::size_t index, const Light& light);
    // The same of all lights, to those of a scene that has as many; Error for another number.
    void set_lights(const std::vector<Light>& lights);
    // Turns the environment about +Y, radians, beside the rotation that it was uploaded with;
    // solvers then need lights_changed(), antiradiance environment_changed(). Of this copy of the
    // scene alone. Throws Error for an angle that is not finite and a scene without environment.
    void turn_environment(double angle);

    // In the order of SCENE_ARGUMENTS in kernels/scene/buffers.clh.
    std::array<const cl::Buffer*, 9> kernel_arguments() const;
    const cl::Buffer& triangles() const { return triangles_; }
    const cl::Buffer& positions() const { return positions_; }
    const cl::Buffer& normals() const { return normals_; }
    const cl::Buffer& materials() const { return materials_; }
    // [info().cluster_count] Cluster: box and normal cone of runs of triangles, to cull many at
    // once.
    const cl::Buffer& clusters() const { return clusters_; }
    // [node_levels().back()] BoxNode: a tree of boxes over the clusters, level by level.
    const cl::Buffer& nodes() const { return nodes_; }
    // The first node of each level from the root on, and then the number of all nodes.
    const std::vector<std::uint32_t>& node_levels() const { return node_levels_; }
    // [info().cluster_count][CLUSTER_PARTS] PartCorners: corners of triangles, side by side.
    const cl::Buffer& parts() const { return parts_; }
    // [height][width][3] float of the environment's picture, before its factor.
    const cl::Buffer& environment_texels() const { return environment_texels_; }

private:
    friend class SceneMover;

    // What emissive_ is made from, one for each triangle of an emissive material.
    struct Glowing {
        std::uint32_t triangle;  // of the scene
        glm::uvec3 vertex;       // of the device
        glm::vec3 corner[3];
        glm::vec3 radiance;
        bool double_sided;
        std::uint32_t lamp;
    };
    void find_lamps();
    void list_emissive();

    SceneFrame frame_;
    SceneInfo info_{};
    std::vector<Light> lights_;
    std::vector<Glowing> glowing_;
    std::vector<EmissiveTriangle> emissive_;
    std::vector<std::uint32_t> triangle_order_, vertex_order_, node_levels_;
    std::size_t file_vertex_count_ = 0;
    std::optional<Environment> environment_;
    float uploaded_rotation_ = 0.0f;  // of the environment
    struct Cut;
    std::shared_ptr<Cut> cut_;
    float least_alpha_ = 2.0f;
    bool has_masks_ = false;  // or blended surfaces
    bool has_blended_ = false;
    std::size_t bytes_ = 0;
    cl::Buffer triangles_, positions_, normals_, uvs_, colors_, materials_, textures_, texels_,
        decode_, environment_texels_, clusters_, nodes_, parts_;
};

// What a material reflects of even light: shares of the base colour that are diffuse and in a lobe,
// a white coat, which lies in the lobe too, and the exponent of the Phong lobe that stands for GGX
// where light is kept in spherical harmonics or bins (clgi/shared/microfacet.h, docs/materials.md).
// diffuse + coat + lobe is at most 1, the exponent in [0,1154]. A material without metal and with
// specular 0 has diffuse 1.
struct Reflectance {
    float diffuse, coat, lobe, exponent;
};
CLGI_API Reflectance reflectance(const Material& material);

// Metalness in [0,1], alpha of GGX in [0.01,1], and F of what is no metal at normal and at grazing
// incidence, in [0,1].
CLGI_API glm::vec4 surface_of(const Material& material);

// The view of a camera for an image of this size, in the scene's local frame.
CLGI_API View make_view(const Camera& camera, const SceneFrame& frame, int width, int height);

}  // namespace clgi
