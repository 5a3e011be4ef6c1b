// The scene on the host: one list of triangles in world space, with lights and cameras.
//
// Right-handed, +Y up, metres, linear Rec.709. Light units are those of KHR_lights_punctual and
// KHR_materials_emissive_strength: candela, lux, candela per square metre.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/animation.hpp>
#include <clgi/advanced/export.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi {

enum class Wrap { repeat, mirrored_repeat, clamp_to_edge };

// An 8-bit image, row 0 at the top, four bytes per texel.
struct Texture {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // [height][width][4]
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    bool nearest = false;  // sample without interpolation
    bool srgb = true;      // rgb is sRGB-encoded; alpha is always linear
};

// How a material reads a texture: KHR_texture_transform applied to one of two UV sets.
struct TextureSlot {
    int texture = -1;                       // index into Scene::textures; -1: none
    int uv_set = 0;                         // 0 or 1
    glm::mat3 transform = glm::mat3(1.0f);  // uv' = transform * (u, v, 1)
};

// What alpha does: nothing; cut out what is below the cutoff; or, blend, cover a share of what lies
// behind. Each view shows a blended surface at a share alpha of the pixels, and so do shadow maps:
// the mean of many samples is the blend (docs/materials.md, with limits).
enum class AlphaMode { opaque, mask, blend };

// glTF metallic-roughness. docs/materials.md defines the reflectance.
struct Material {
    std::string name;
    glm::vec4 base_color = glm::vec4(1.0f);  // linear rgb in [0,1], alpha
    TextureSlot base_texture;
    float metallic = 0.0f;   // [0,1]; with metallic_roughness_texture: the mean
    float roughness = 1.0f;  // [0,1]; with metallic_roughness_texture: the mean
    // Of what is no metal: strength of its white reflection, in [0,1], and index of refraction, at
    // least 1, or 0 for one that reflects all (KHR_materials_specular, KHR_materials_ior). A file
    // that says nothing has 1 and 1.5. With specular 0 and metallic 0 a material is Lambertian.
    float specular = 0.0f;
    float ior = 1.5f;
    // Where views show the surface: metalness is the factor's x times the texture's blue, roughness
    // its y times the green. Each in [0,1].
    TextureSlot metallic_roughness_texture;
    glm::vec2 metallic_roughness_factor = glm::vec2(1.0f);
    // Normals in the frame of the texture's coordinates, x and y times the scale, -100 to 100.
    TextureSlot normal_texture;
    float normal_scale = 1.0f;
    glm::vec3 emission = glm::vec3(0.0f);  // radiance, cd/m^2 (factor times strength)
    TextureSlot emission_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
};

// All textures that a material may read.
template <typename AnyMaterial>
auto texture_slots(AnyMaterial& material) {
    return std::array{&material.base_texture, &material.emission_texture,
                      &material.metallic_roughness_texture, &material.normal_texture};
}

// Vertices of a triangle in Scene's vertex arrays, counter-clockwise seen from the front.
struct SceneTriangle {
    std::uint32_t vertex[3];
    std::uint32_t material;
};

struct Light {
    enum class Kind { spot, point, directional };
    std::string name;
    Kind kind = Kind::point;
    glm::dvec3 position = glm::dvec3(0.0);
    glm::vec3 direction = glm::vec3(0.0f, 0.0f, -1.0f);  // unit; spot and directional
    glm::vec3 intensity = glm::vec3(1.0f);  // color times intensity: candela, directional lux
    float range = 0.0f;                     // metres; the light ends there; 0: unlimited
    float inner_angle = 0.0f;               // radians from the axis; full intensity inside; spot
    float outer_angle = 0.78539816f;        // radians from the axis; no light outside; spot
};

struct Camera {
    enum class Kind { perspective, orthographic };
    std::string name;
    Kind kind = Kind::perspective;
    glm::dvec3 position = glm::dvec3(0.0);
    glm::vec3 right = glm::vec3(1.0f, 0.0f, 0.0f);  // unit, orthogonal
    glm::vec3 up = glm::vec3(0.0f, 1.0f, 0.0f);
    glm::vec3 forward = glm::vec3(0.0f, 0.0f, -1.0f);
    float vertical_fov = 0.8f;  // radians, whole angle; perspective
    float half_height = 1.0f;   // metres; orthographic
    float near = 0.0f;          // metres; 0: derived from the scene's size
    // Where pixels are looked through: pixels to the right and down from their centres.
    glm::vec2 offset = glm::vec2(0.0f);
    // Share of a pixel's area that textures and the environment are looked up over, above 0 to 1:
    // less for a picture that is one of many samples.
    float footprint = 1.0f;
};

// Light from infinitely far away: a latitude-longitude picture or one colour.
//
// Row 0 of the picture lies around +Y, the last row around -Y. Columns run from left to right as
// seen from the origin: the middle of the picture is -Z, three quarters of its width are +X, both
// edges are +Z. Radiance is constant over a texel.
struct Environment {
    int width = 0;  // texels; 0x0: no picture, the factor alone
    int height = 0;
    std::vector<glm::vec3> texels;       // [height][width] linear rgb, at least 0
    glm::vec3 factor = glm::vec3(1.0f);  // times the texel: radiance, cd/m^2
    float rotation = 0.0f;  // radians about +Y, counter-clockwise seen from above: a quarter
                            // turn moves the picture's middle from -Z to -X
};

// A range of triangles: a glTF primitive of one node.
struct Part {
    std::string name;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

struct Bounds {
    glm::dvec3 low = glm::dvec3(0.0);
    glm::dvec3 high = glm::dvec3(0.0);
};

// A sphere around what pictures show and what that is lit by.
struct Focus {
    glm::dvec3 centre = glm::dvec3(0.0);  // metres
    double radius = 1.0;
};

struct Scene {
    std::string name;

    // One entry per vertex. uv: set 0 in xy, set 1 in zw; color: linear, empty if no vertex has
    // one.
    std::vector<glm::dvec3> positions;  // metres
    std::vector<glm::vec3> normals;     // unit, world space
    std::vector<glm::vec4> uvs;         // empty if there are no textures
    std::vector<glm::vec4> colors;      // rgba multiplier; empty: all white

    std::vector<SceneTriangle> triangles;
    std::vector<Material> materials;  // at least one if there is a triangle
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    std::vector<Part> parts;
    std::optional<Environment> environment;  // none: black

    std::optional<Animation> animation;   // none: nothing moves by itself
    std::optional<Bounds> moving_bounds;  // a box that moving vertices stay in; the local frame on
                                          // the device covers it too
    std::optional<Focus> focus;  // none: all of it. The local frame lies around it, and what must
                                 // be small, such as distances that surfaces are lifted by, is
                                 // small beside it

    std::vector<std::string> warnings;  // one line each: what was ignored, corrected or assumed
};

// The box around all vertices of triangles; both corners are zero for a scene without triangles.
CLGI_API Bounds bounds(const Scene& scene);

// Throws InputError naming the first array, index and value that violates Scene's contract:
// array lengths, indices in range, finite positions, unit-length normals, materials, lights,
// environment and animation in their ranges.
CLGI_API void validate(const Scene& scene);

// A camera for files that have none, in front of an object or inside a room. For a valid scene.
CLGI_API Camera default_camera(const Scene& scene);

// The camera moved to `eye`, its axis through `target` and +Y upwards in the picture; what else it
// is stays. Throws Error for places that are the same or not finite; along +Y its right stays as
// near as may be to what it was.
CLGI_API Camera look_at(const Camera& camera, const glm::dvec3& eye, const glm::dvec3& target);

// A light for scenes without light, emissive surface and environment: directional, pi lux. For a
// valid scene.
CLGI_API Light default_light(const Scene& scene);

CLGI_API bool has_emission(const Scene& scene);

// Adds default_camera() to a scene without camera, and default_light() to one without light,
// emission and environment.
CLGI_API void add_defaults(Scene& scene);

}  // namespace clgi
