#!/usr/bin/env python3
"""What plans save where a scene does not call for everything.

    samples/effects.py build/clgi out/ SCENE.glb ... [--environment R,G,B] [--error 0.1]

Each scene is rendered by its plan, and by a plan with every effect on, for the same expected error,
in turn. A row has what is off, what the plan says that this changes at most, and the times of one
sample with analysis, plan and all that is done before it, but without loading, upload and building
kernels. SCENE.glb,black stands for the scene with surfaces that reflect nothing.
SPDX-License-Identifier: MIT
"""
import json
import os
import statistics
import struct

from commands import arguments, run


def blackened(scene, path):
    """Writes the scene (.glb) with black materials."""
    with open(scene, "rb") as file:
        magic, version, _, size, kind = struct.unpack("<5I", file.read(20))
        gltf, rest = json.loads(file.read(size)), file.read()
    for material in gltf.get("materials", []):
        material["pbrMetallicRoughness"] = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}
        material["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
    gltf["extensionsUsed"] = ["KHR_materials_specular"] + gltf.get("extensionsUsed", [])
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<5I", magic, version, 20 + len(text) + len(rest), len(text), kind))
        file.write(text + rest)


def milliseconds(stats):
    """Of all that was done before a sample, and of the sample."""
    before = stats["plan"]["ms"]
    if "bake" in stats:
        before += stats["bake"]["layout_ms"] + stats["bake"]["bake_ms"]
    if "antiradiance" in stats:
        before += stats["antiradiance"]["linking_ms"]
    return before + stats["frame_ms"]["median"]


def main():
    parser = arguments(__doc__)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--environment", help="of all scenes")
    parser.add_argument("--error", default="0.1", help="that is expected of the pictures")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    sky = ["--environment", options.environment] if options.environment else []

    def render(scene, name, *flags):
        run(options.clgi, "render", scene, "--quiet", "--full", "--size", "160x120", "--samples", "1",
            "--target-error", options.error, *sky, *flags,
            "-o", name + ".exr", "--stats", name + ".json")
        with open(name + ".json") as file:
            return json.load(file)

    print("| scene | what is off although there is light for it | at most, % | method, with all "
          "| ms | with all, ms | saving |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for scene in options.scenes:
        label = os.path.splitext(os.path.basename(scene))[0]
        name = os.path.join(options.out, label)
        if scene.endswith(",black"):
            label, name = label + ", black", name + "-black"
            blackened(scene.removesuffix(",black"), name + ".glb")
            scene = name + ".glb"
        pairs = [(render(scene, name + "-plan"), render(scene, name + "-all", "--with", "all"))
                 for _ in range(options.rounds)]
        plan, full = pairs[-1]
        off = [e["name"] for e in plan["plan"]["effects"]
               if not e["on"] and e["ground"] in ("proven", "measured")]
        lean, every = (statistics.median(milliseconds(pair[k]) for pair in pairs) for k in (0, 1))
        print(f"| {label} | {', '.join(off)} | {100 * plan['plan']['bound']:.2g} "
              f"| {plan['method']}, {full['method']} | {lean:.1f} | {every:.1f} | {every / lean:.1f} |",
              flush=True)


if __name__ == "__main__":
    main()
