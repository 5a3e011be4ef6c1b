// What glTF 2.0 asks of the members that clgi and tinygltf read. gltf_guard.hpp has the notation.
// SPDX-License-Identifier: MIT
#include "io/gltf_guard.hpp"

namespace clgi::io::gltf {

const char* const schema = R"({
"asset!": {"version!": "text", "minVersion": "text"},
"extensionsRequired": ["text"],
"extensionsUsed": ["text"],
"extensions": {"KHR_lights_punctual": {"lights!": [{
        "name": "text", "type!": "word directional point spot",
        "color": "numbers 3", "intensity": "number", "range": "above_zero",
        "spot": {"innerConeAngle": "not_negative", "outerConeAngle": "above_zero"}}, 65536]},
    "*": {}},

"buffers": [{"byteLength!": "count", "uri": "text",
    "extensions": {"EXT_meshopt_compression": {"fallback": "flag"}}}, 65536],
"bufferViews": [{"buffer!": "index buffers", "byteOffset": "whole", "byteLength!": "count",
    "byteStride": "whole", "target": "code 34962 34963"}],
"accessors": [{
    "componentType!": "code 5120 5121 5122 5123 5125 5126", "count!": "count",
    "type!": "word SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", "normalized": "flag",
    "bufferView": "index bufferViews", "byteOffset": "whole",
    "sparse": {"count!": "int",
        "indices!": {"bufferView!": "index bufferViews", "byteOffset": "int",
                     "componentType!": "code 5121 5123 5125"},
        "values!": {"bufferView!": "index bufferViews", "byteOffset": "int"}}}],

"images": [{"name": "text", "bufferView": "index bufferViews", "uri": "text",
    "mimeType": "text"}, 65536],
"$texture": {"index!": "index textures", "texCoord": "int", "extensions":
    {"KHR_texture_transform": {"offset": "numbers 2", "scale": "numbers 2",
                               "rotation": "number", "texCoord": "int"}}},
"samplers": [{"magFilter": "code 9728 9729", "minFilter": "code 9728 9729 9984 9985 9986 9987",
    "wrapS": "code 10497 33071 33648", "wrapT": "code 10497 33071 33648"}, 65536],
"textures": [{"source": "index images", "sampler": "index samplers"}, 65536],
"materials": [{
    "name": "text", "alphaMode": "word OPAQUE MASK BLEND", "alphaCutoff": "number",
    "doubleSided": "flag", "emissiveFactor": "numbers 3",
    "emissiveTexture": "$texture", "*Texture": {"index!": "index textures"},
    "pbrMetallicRoughness": {"baseColorFactor": "numbers 4", "metallicFactor": "number",
        "roughnessFactor": "number", "*Texture": "$texture"},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": "number"},
                   "KHR_materials_unlit": {}}}, 65536],

"meshes": [{"name": "text", "weights": "numbers", "primitives!": [{
    "attributes!": {"*": "index accessors"}, "indices": "index accessors",
    "material": "index materials", "mode": "code 0 1 2 3 4 5 6",
    "targets": [{"*": "index accessors"}],
    "extensions": {"KHR_draco_mesh_compression": {}}}]}],
"skins": [{"joints!": ["index nodes"], "skeleton": "index nodes",
    "inverseBindMatrices": "index accessors"}, 65536],
"cameras": [{"name": "text", "type!": "word perspective orthographic",
    "perspective": {"yfov!": "above_zero", "znear!": "above_zero",
                    "aspectRatio": "above_zero", "zfar": "above_zero"},
    "orthographic": {"xmag!": "number", "ymag!": "number",
                     "znear!": "not_negative", "zfar!": "above_zero"}}, 65536],
"nodes": [{
    "name": "text", "matrix": "numbers 16", "translation": "numbers 3", "rotation": "numbers 4",
    "scale": "numbers 3", "children": ["index nodes"], "mesh": "index meshes",
    "skin": "index skins", "camera": "index cameras", "weights": "numbers",
    "extensions": {"KHR_lights_punctual": {"light!": "index lights"},
                   "EXT_mesh_gpu_instancing": {"attributes!": {"*": "index accessors"}}}}],
"scenes": [{"name": "text", "nodes": ["index nodes"]}, 65536],
"scene": "index scenes",
"animations": [{
    "samplers!": [{"input!": "index accessors", "output!": "index accessors",
                   "interpolation": "text"}],
    "channels!": [{"sampler!": "int", "target!": {"node": "index nodes", "path!": "text"}}]
    }, 65536]
})";

}  // namespace clgi::io::gltf
