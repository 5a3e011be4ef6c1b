// SPDX-License-Identifier: MIT
#include "io/gltf_rules.hpp"

#include <climits>

namespace clgi::io::gltf {

namespace {

// For things of which no scene has as many as it has nodes.
constexpr std::uint64_t rare = std::uint64_t{1} << 16;

constexpr std::string_view components = "5120 5121 5122 5123 5125 5126";
constexpr std::string_view wraps = "10497 33071 33648";

// clang-format off
constexpr Rule of_the_asset[] = {
    {"asset!", Kind::object},
    {"asset.version!", Kind::text},
    {"asset.minVersion", Kind::text},
    {"extensionsRequired[]", Kind::text},
    {"extensionsUsed[]", Kind::text},
    {"extensions.*", Kind::object},
};

constexpr Rule of_the_rest[] = {
    {"buffers", Kind::list, "", rare},
    {"buffers[].byteLength!", Kind::count},
    {"buffers[].uri", Kind::text},
    {"buffers[].extensions.EXT_meshopt_compression.fallback", Kind::flag},

    {"bufferViews[].buffer!", Kind::index, "buffers"},
    {"bufferViews[].byteOffset", Kind::whole},
    {"bufferViews[].byteLength!", Kind::count},
    {"bufferViews[].byteStride", Kind::whole},
    {"bufferViews[].target", Kind::code, "34962 34963"},

    {"accessors[].componentType!", Kind::code, components},
    {"accessors[].count!", Kind::count},
    {"accessors[].normalized", Kind::flag},
    {"accessors[].bufferView", Kind::index, "bufferViews"},
    {"accessors[].byteOffset", Kind::whole},
    {"accessors[].type!", Kind::word, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"accessors[].sparse.count!", Kind::count, "", INT_MAX},
    {"accessors[].sparse.indices!", Kind::object},
    {"accessors[].sparse.indices.bufferView!", Kind::index, "bufferViews"},
    {"accessors[].sparse.indices.byteOffset", Kind::whole, "", INT_MAX},
    {"accessors[].sparse.indices.componentType!", Kind::code, "5121 5123 5125"},
    {"accessors[].sparse.values!", Kind::object},
    {"accessors[].sparse.values.bufferView!", Kind::index, "bufferViews"},
    {"accessors[].sparse.values.byteOffset", Kind::whole, "", INT_MAX},

    {"images", Kind::list, "", rare},
    {"images[].name", Kind::text},
    {"images[].bufferView", Kind::index, "bufferViews"},
    {"images[].uri", Kind::text},
    {"images[].mimeType", Kind::text},
    {"samplers", Kind::list, "", rare},
    {"samplers[].magFilter", Kind::code, "9728 9729"},
    {"samplers[].minFilter", Kind::code, "9728 9729 9984 9985 9986 9987"},
    {"samplers[].wrapS", Kind::code, wraps},
    {"samplers[].wrapT", Kind::code, wraps},
    {"textures", Kind::list, "", rare},
    {"textures[].source", Kind::index, "images"},
    {"textures[].sampler", Kind::index, "samplers"},

    {"materials", Kind::list, "", rare},
    {"materials[].name", Kind::text},
    {"materials[].pbrMetallicRoughness.baseColorFactor", Kind::numbers, "", 4},
    {"materials[].pbrMetallicRoughness.metallicFactor", Kind::number},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Kind::number},
    {"materials[].pbrMetallicRoughness.*Texture.index!", Kind::index, "textures"},
    {"materials[].pbrMetallicRoughness.*Texture.texCoord", Kind::whole, "", INT_MAX},
    {"materials[].pbrMetallicRoughness.*Texture.extensions.KHR_texture_transform.offset", Kind::numbers, "", 2},
    {"materials[].pbrMetallicRoughness.*Texture.extensions.KHR_texture_transform.scale", Kind::numbers, "", 2},
    {"materials[].pbrMetallicRoughness.*Texture.extensions.KHR_texture_transform.rotation", Kind::number},
    {"materials[].pbrMetallicRoughness.*Texture.extensions.KHR_texture_transform.texCoord", Kind::whole, "", INT_MAX},
    {"materials[].*Texture.index!", Kind::index, "textures"},
    {"materials[].emissiveTexture.texCoord", Kind::whole, "", INT_MAX},
    {"materials[].emissiveTexture.extensions.KHR_texture_transform.offset", Kind::numbers, "", 2},
    {"materials[].emissiveTexture.extensions.KHR_texture_transform.scale", Kind::numbers, "", 2},
    {"materials[].emissiveTexture.extensions.KHR_texture_transform.rotation", Kind::number},
    {"materials[].emissiveTexture.extensions.KHR_texture_transform.texCoord", Kind::whole, "", INT_MAX},
    {"materials[].emissiveFactor", Kind::numbers, "", 3},
    {"materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Kind::number},
    {"materials[].extensions.KHR_materials_unlit", Kind::object},
    {"materials[].alphaMode", Kind::word, "OPAQUE MASK BLEND"},
    {"materials[].alphaCutoff", Kind::number},
    {"materials[].doubleSided", Kind::flag},

    {"meshes[].name", Kind::text},
    {"meshes[].weights", Kind::numbers},
    {"meshes[].primitives!", Kind::list, "", max_entries},
    {"meshes[].primitives[].attributes!", Kind::object},
    {"meshes[].primitives[].attributes.*", Kind::index, "accessors"},
    {"meshes[].primitives[].indices", Kind::index, "accessors"},
    {"meshes[].primitives[].material", Kind::index, "materials"},
    {"meshes[].primitives[].mode", Kind::code, "0 1 2 3 4 5 6"},
    {"meshes[].primitives[].targets[].*", Kind::index, "accessors"},
    {"meshes[].primitives[].extensions.KHR_draco_mesh_compression", Kind::object},

    {"cameras", Kind::list, "", rare},
    {"cameras[].name", Kind::text},
    {"cameras[].type!", Kind::word, "perspective orthographic"},
    {"cameras[].perspective.yfov!", Kind::above_zero},
    {"cameras[].perspective.znear!", Kind::above_zero},
    {"cameras[].perspective.aspectRatio", Kind::above_zero},
    {"cameras[].perspective.zfar", Kind::above_zero},
    {"cameras[].orthographic.xmag!", Kind::number},
    {"cameras[].orthographic.ymag!", Kind::number},
    {"cameras[].orthographic.znear!", Kind::not_negative},
    {"cameras[].orthographic.zfar!", Kind::above_zero},

    {"extensions.KHR_lights_punctual.lights!", Kind::list, "", rare},
    {"extensions.KHR_lights_punctual.lights[].name", Kind::text},
    {"extensions.KHR_lights_punctual.lights[].type!", Kind::word, "directional point spot"},
    {"extensions.KHR_lights_punctual.lights[].color", Kind::numbers, "", 3},
    {"extensions.KHR_lights_punctual.lights[].intensity", Kind::number},
    {"extensions.KHR_lights_punctual.lights[].range", Kind::above_zero},
    {"extensions.KHR_lights_punctual.lights[].spot.innerConeAngle", Kind::not_negative},
    {"extensions.KHR_lights_punctual.lights[].spot.outerConeAngle", Kind::above_zero},

    {"skins", Kind::list, "", rare},
    {"skins[].joints!", Kind::list, "", max_entries},
    {"skins[].joints[]", Kind::index, "nodes"},
    {"skins[].skeleton", Kind::index, "nodes"},
    {"skins[].inverseBindMatrices", Kind::index, "accessors"},

    {"nodes[].name", Kind::text},
    {"nodes[].matrix", Kind::numbers, "", 16},
    {"nodes[].translation", Kind::numbers, "", 3},
    {"nodes[].rotation", Kind::numbers, "", 4},
    {"nodes[].scale", Kind::numbers, "", 3},
    {"nodes[].children[]", Kind::index, "nodes"},
    {"nodes[].mesh", Kind::index, "meshes"},
    {"nodes[].skin", Kind::index, "skins"},
    {"nodes[].camera", Kind::index, "cameras"},
    {"nodes[].weights", Kind::numbers},
    {"nodes[].extensions.KHR_lights_punctual.light!", Kind::index, "lights"},
    {"nodes[].extensions.EXT_mesh_gpu_instancing.attributes!", Kind::object},
    {"nodes[].extensions.EXT_mesh_gpu_instancing.attributes.*", Kind::index, "accessors"},
    {"scenes", Kind::list, "", rare},
    {"scenes[].name", Kind::text},
    {"scenes[].nodes[]", Kind::index, "nodes"},
    {"scene", Kind::index, "scenes"},

    {"animations", Kind::list, "", rare},
    {"animations[].samplers!", Kind::list, "", max_entries},
    {"animations[].channels!", Kind::list, "", max_entries},
    {"animations[].samplers[].input!", Kind::index, "accessors"},
    {"animations[].samplers[].output!", Kind::index, "accessors"},
    {"animations[].samplers[].interpolation", Kind::text},
    {"animations[].channels[].sampler!", Kind::index, ".samplers"},
    {"animations[].channels[].target!", Kind::object},
    {"animations[].channels[].target.node", Kind::index, "nodes"},
    {"animations[].channels[].target.path!", Kind::text},
};
// clang-format on

}  // namespace

std::span<const Rule> asset_rules() { return of_the_asset; }
std::span<const Rule> rules() { return of_the_rest; }

}  // namespace clgi::io::gltf
