#!/usr/bin/env python3
"""Renders a diffuse glTF scene with Mitsuba 3 and compares a picture of `clgi reference` with it.

    pip install mitsuba numpy
    clgi scene cornell -o cornell.glb
    clgi reference cornell.glb -o ours.exr --full --size 256x256 --spp 256
    samples/cross_check.py cornell.glb ours.exr --spp 256

Takes what `clgi scene` writes: one buffer, Lambert materials, emission, point lights, a perspective
camera. Prints ratios of means: of the whole pictures, of all blocks that are not far brighter than
most, and block by block.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import struct

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

KINDS = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3}

def read_glb(path):
    """The JSON of a .glb file and its binary chunk."""
    data = open(path, "rb").read()
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[20 + size + 8 :]


def accessor(gltf, binary, index):
    """An accessor's values, [count][width]."""
    entry = gltf["accessors"][index]
    view = gltf["bufferViews"][entry["bufferView"]]
    kind = np.dtype(KINDS[entry["componentType"]])
    width = WIDTHS[entry["type"]]
    start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
    stride = view.get("byteStride", kind.itemsize * width)
    places = [start + i * stride for i in range(entry["count"])]
    return np.array([np.frombuffer(binary, kind, width, place) for place in places])


def placement(node):
    """A node's matrix in its parent."""
    *axis, w = node.get("rotation", [0, 0, 0, 1])
    cross = np.cross(np.eye(3), axis)
    out = np.eye(4)
    out[:3, :3] += 2 * (w * cross + cross @ cross)
    out[:3, 3] = node.get("translation", [0, 0, 0])
    return out


def placed(gltf, node, above):
    """A node and all below it, each with its matrix in the world, metres."""
    matrix = above @ placement(node)
    yield node, matrix
    for child in node.get("children", []):
        yield from placed(gltf, gltf["nodes"][child], matrix)


def mesh(name, positions, faces, material):
    """Triangles with faces of their own normals, Lambert, shining where the material does."""
    color = material["pbrMetallicRoughness"].get("baseColorFactor", [1, 1, 1, 1])[:3]
    strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
    factor = np.array(material.get("emissiveFactor", [0, 0, 0]))
    radiance = factor * strength.get("emissiveStrength", 1.0)
    lambert = {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}}
    props = mi.Properties()
    props["bsdf"] = mi.load_dict(lambert)
    if radiance.max() > 0:
        shine = {"type": "area", "radiance": {"type": "rgb", "value": radiance.tolist()}}
        props["emitter"] = mi.load_dict(shine)
    out = mi.Mesh(name, len(positions), len(faces), props=props)
    values = mi.traverse(out)
    values["vertex_positions"] = positions.ravel().tolist()
    values["faces"] = faces.ravel().tolist()
    values.update()
    return out


def scene_of(path, width, height, spp):
    """The file as a Mitsuba scene: path tracer without a limit, box filter."""
    gltf, binary = read_glb(path)
    scene = {"type": "scene", "integrator": {"type": "path", "max_depth": -1}}
    roots = [gltf["nodes"][i] for i in gltf["scenes"][gltf["scene"]]["nodes"]]
    nodes = [pair for root in roots for pair in placed(gltf, root, np.eye(4))]
    for number, (node, matrix) in enumerate(nodes):
        primitives = gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []
        for part, primitive in enumerate(primitives):
            points = accessor(gltf, binary, primitive["attributes"]["POSITION"])
            faces = accessor(gltf, binary, primitive["indices"]).reshape(-1, 3)
            world = points @ matrix[:3, :3].T + matrix[:3, 3]
            name = f"mesh_{number}_{part}"
            scene[name] = mesh(name, world, faces, gltf["materials"][primitive["material"]])
        lamp = node.get("extensions", {}).get("KHR_lights_punctual")
        if lamp:
            light = gltf["extensions"]["KHR_lights_punctual"]["lights"][lamp["light"]]
            if light["type"] != "point":
                raise SystemExit(f"{path}: a {light['type']} light; point lights needed")
            candela = light.get("intensity", 1.0) * np.array(light.get("color", [1, 1, 1]))
            scene[f"lamp_{number}"] = {
                "type": "point",
                "position": matrix[:3, 3].tolist(),
                "intensity": {"type": "rgb", "value": candela.tolist()},
            }
        if "camera" in node and "sensor" not in scene:
            eye = matrix[:3, 3]
            scene["sensor"] = {
                "type": "perspective",
                "fov_axis": "y",
                "fov": float(np.degrees(gltf["cameras"][node["camera"]]["perspective"]["yfov"])),
                "to_world": mi.ScalarTransform4f().look_at(
                    eye.tolist(), (eye - matrix[:3, 2]).tolist(), matrix[:3, 1].tolist()
                ),
                "film": {"type": "hdrfilm", "width": width, "height": height,
                         "pixel_format": "rgb", "rfilter": {"type": "box"}},
                "sampler": {"type": "independent", "sample_count": spp}}
    return mi.load_dict(scene)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("picture", help="of clgi reference: EXR")
    parser.add_argument("--spp", type=int, default=256)
    flags = parser.parse_args()
    ours = np.array(mi.Bitmap(flags.picture).split()[0][1])[:, :, :3].astype(float)
    height, width = ours.shape[:2]
    theirs = np.array(mi.render(scene_of(flags.scene, width, height, flags.spp))).astype(float)
    rows, columns = height // 8, width // 8
    blocks = [
        picture[: rows * 8, : columns * 8].reshape(rows, 8, columns, 8, 3).swapaxes(1, 2)
        for picture in (ours, theirs)
    ]
    # Without lamps and their edges: we look through the centres of pixels, they average.
    both = blocks[0].mean((2, 3, 4)) + blocks[1].mean((2, 3, 4))
    dim = both < 4 * np.median(both)
    a, b = (picture.mean((2, 3))[dim] for picture in blocks)
    ratio = (a / b).ravel()
    whole = ours.mean((0, 1)) / theirs.mean((0, 1))
    print("whole pictures, ours over theirs (R G B):", *np.round(whole, 4))
    print(f"{dim.sum()} of {dim.size} blocks of 8x8:", *np.round(a.mean(0) / b.mean(0), 4))
    print(f"block by block: median {np.median(ratio):.4f}, standard deviation {ratio.std():.4f}")


if __name__ == "__main__":
    main()
