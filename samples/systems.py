#!/usr/bin/env python3
"""One scene by every system in equal time, beside the ground truth: out/systems.png.

    samples/systems.py build/clgi out/ SCENE.glb [--environment R,G,B] [--time 2s] [--exposure STOPS]

Each method has a plan for the time, with all that it does before its picture but loading, upload and
building kernels, and as many samples as fit: through other points of the pixels, by other lights of the
sky. The path tracer has as long. Errors are those of clgi compare, without the noise of the ground
truth. python3-matplotlib draws the sheet.
SPDX-License-Identifier: MIT
"""
import json
import os
import subprocess
import sys

from commands import arguments, run

METHODS = {"second-order": "second-order", "antiradiance": "antiradiance",
           "atlas": "light atlas", "transfer": "dynamic transfer", "cache": "irradiance cache"}
SHEET = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "host", "lab", "plots", "sheet.py")


def draw(folder):
    """The sheet of a folder's data.json. python3 of the path may lack packages that the system's has."""
    for python in (sys.executable, "/usr/bin/python3"):
        done = subprocess.run([python, SHEET], cwd=folder, capture_output=True, text=True)
        if not done.returncode:
            return
    sys.exit(f"{done.stderr.strip().splitlines()[-1]}; the sheet needs python3-matplotlib")


def main():
    parser = arguments(__doc__)
    parser.add_argument("scene", help=".glb or .gltf file")
    parser.add_argument("--environment", help="file or R,G,B")
    parser.add_argument("--time", default="2s", help="of each picture")
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--exposure", default="0", help="stops")
    parser.add_argument("--spp", type=int, default=1024, help="samples a pixel of the ground truth")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)

    def path(name):
        return os.path.join(options.out, name)

    def picture(command, name, *flags):
        """Renders one, and returns its statistics."""
        light = ["--environment", options.environment] if options.environment else []
        run(options.clgi, command, options.scene, "--quiet", "--full", "--size", options.size, *light,
            "-o", path(name + ".exr"), "--png", path(name + ".png"), "--exposure", options.exposure,
            "--stats", path(name + ".json"), *flags)
        with open(path(name + ".json"), encoding="utf-8") as file:
            return json.load(file)

    def error(name):
        found = json.loads(run(options.clgi, "compare", path(name + ".exr"), path("truth.exr"), "--json"))
        return f"error {100 * found['luminance_error']:.1f} %"

    def trace(name, samples, seed):
        return picture("reference", name, "--filter", "box", "--spp", samples, "--seed", seed)

    truth = trace("truth", options.spp, 1)
    panels = [("truth", "ground truth, by path tracing", f"standard error {100 * truth['relative_error']:.1f} %")]
    for method, name in METHODS.items():
        found = picture("render", method, "--method", method, "--time-budget", options.time)
        budget = found["time_budget"]
        panels.append((method, f"{name}: {error(method)}",
                       f"{budget['used']:.2g} s, {found['samples']['count']} samples"))
    samples = max(1, int(options.spp * budget["seconds"] / truth["seconds"]))
    seconds = trace("path", samples, 2)["seconds"]
    panels.append(("path", f"path tracer: {error('path')}", f"{seconds:.2g} s, {samples} samples"))
    with open(path("data.json"), "w", encoding="utf-8") as file:
        json.dump([{"picture": name + ".png", "lines": lines} for name, *lines in panels], file)
    draw(options.out)
    os.replace(path("sheet.png"), path("systems.png"))


if __name__ == "__main__":
    main()
