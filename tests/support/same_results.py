#!/usr/bin/env python3
"""Compares two builds of clgi: every picture, bake and JSON value of many scenes and all methods.

    tests/support/same_results.py OLD NEW [--scenes FOLDER] [--only TEXT] [--quick]

OLD, NEW: programs. Scenes: all that `clgi scene` writes, and the .gltf and .glb files of FOLDER. EXR
and GLB files must be the same byte for byte; JSON must have the same values, but for times and what
depends on them. Prints a line for each difference and a summary; the exit code is 1 if there is one.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

GENERATED = {
    "box": [], "cornell": [], "corridor": [], "furnace": [], "maze": [], "office": [],
    "character": [], "chess": [], "cloth": [], "fight-like": [], "hand-like": [],
    "glossy-box": [], "glossy-bust-like": [], "oriental-like": [],
}
SKY = ["--environment", "0.4,0.5,0.7"]
SIZE = ["--size", "64x48", "--full"]
# name: command and flags, without the scene and the outputs
TASKS = {
    "auto": ["render", *SIZE],
    "direct": ["render", "--method", "direct", *SIZE],
    "second-order": ["render", "--method", "second-order", *SIZE],
    "second-order-sky-fast": ["render", "--method", "second-order", "--math", "fast", *SKY, *SIZE],
    "second-order-half": ["render", "--method", "second-order", "--storage", "half", *SIZE],
    "atlas": ["render", "--method", "atlas", "--vpls", "200", "--atlas-size", "256", "--bounces",
              "10", *SIZE],
    "antiradiance": ["render", "--method", "antiradiance", "--bins", "64", "--elements", "500",
                     *SKY, *SIZE],
    "transfer": ["render", "--method", "transfer", "--mask", "16", "--interreflections", "1", *SKY,
                 *SIZE],
    "bake": ["bake", "--vpls", "200", "--atlas-size", "256", "--bounces", "10", "--direct"],
    "vectors": ["transfer", "--mask", "16"],
}
LONG = {"transfer", "vectors", "antiradiance"}  # quadratic in triangles: not of large scenes
LARGE = 20000  # triangles


def values(node, name=""):
    if isinstance(node, dict):
        for key, value in node.items():
            yield from values(value, f"{name}.{key}")
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from values(value, f"{name}[{i}]")
    else:
        yield name, node


def timeless(path):
    parts = path.replace("]", "").replace("[", ".").split(".")
    return not any(part.endswith(t) for part in parts for t in ("ms", "seconds")) and not any(
        part in ("frame_ms", "ms_median", "seconds", "passes_ms", "once_ms") for part in parts)


def run(program, arguments):
    return subprocess.run([program, *arguments, "--quiet"], capture_output=True, text=True,
                          timeout=1800)


def outputs(name, folder):
    exr, stats, glb = folder / "out.exr", folder / "stats.json", folder / "out.glb"
    arguments = ["-o", str(exr), "--stats", str(stats)]
    if name in ("bake", "vectors"):
        arguments += ["--gltf", str(glb)]
    return arguments, [exr, glb], stats


def compare(name, scene, old, new, folder):
    found = []
    results = {}
    for which, program in (("old", old), ("new", new)):
        there = folder / which
        there.mkdir(exist_ok=True)
        for file in there.iterdir():
            file.unlink()
        task = TASKS[name]
        more, files, stats = outputs(name, there)
        done = run(program, [task[0], str(scene), *task[1:], *more])
        results[which] = (done, [f.read_bytes() if f.exists() else None for f in files],
                          json.loads(stats.read_text()) if stats.exists() else None)
    (a, files_a, json_a), (b, files_b, json_b) = results["old"], results["new"]
    if a.returncode != b.returncode:
        return [f"exit code {a.returncode} became {b.returncode}: {b.stderr.strip()[-200:]}"]
    for kind, x, y in zip(("EXR", "GLB"), files_a, files_b):
        if x != y:
            found.append(f"{kind} differs")
    if json_a is not None and json_b is not None:
        old_values, new_values = dict(values(json_a)), dict(values(json_b))
        for key in old_values:
            if not timeless(key):
                continue
            if key not in new_values:
                found.append(f"JSON lacks {key}")
            elif old_values[key] != new_values[key]:
                found.append(f"JSON {key}: {old_values[key]} became {new_values[key]}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--scenes", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--quick", action="store_true", help="small scenes alone")
    options = parser.parse_args()
    count = differences = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        scenes = []
        for name, flags in GENERATED.items():
            for which, program in (("old", options.old), ("new", options.new)):
                run(program, ["scene", name, *flags, "-o", str(folder / f"{which}-{name}.glb")])
            same = ((folder / f"old-{name}.glb").read_bytes() ==
                    (folder / f"new-{name}.glb").read_bytes())
            count += 1
            if not same:
                differences += 1
                print(f"{name}: the generated scene differs")
            scenes.append((name, folder / f"old-{name}.glb"))
        if options.scenes:
            found = [*options.scenes.rglob("*.glb"), *options.scenes.rglob("*.gltf")]
            scenes += [(str(p.relative_to(options.scenes)), p) for p in sorted(found)]
        for name, scene in scenes:
            plan = [run(p, ["plan", str(scene), "--json"]) for p in (options.old, options.new)]
            try:
                triangles = json.loads(plan[0].stdout)["facts"]["triangles"]
            except (ValueError, KeyError):
                triangles = 0
            if options.quick and triangles > LARGE:
                continue
            for task in TASKS:
                if options.only not in f"{name} {task}" or (task in LONG and triangles > LARGE):
                    continue
                count += 1
                for text in compare(task, scene, options.old, options.new, folder):
                    differences += 1
                    print(f"{name} {task}: {text}", flush=True)
    print(f"{count} comparisons of {len(scenes)} scenes, {differences} differences")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
