#!/usr/bin/env python3
"""What plans save, and how far they get: the tables and the plot of docs/results/plans.md.

    samples/effects.py saving build/clgi out/ SCENE.glb ...
    samples/effects.py same build/clgi out/ SCENE.glb ...
    samples/effects.py race build/clgi out/ SCENE.glb ...

saving: each scene is rendered by its plan, and with every effect on, for the same error. A row has
what is off, what the plan says that this changes at most, what it does change, and both times.
same: each scene is rendered by its plan, and by the plan's method with the same settings and no
effect left out. A row has what is off, the largest difference that the plan allows, the one that is
there, and both times. What cannot be loaded is told with its error line.
race: the error of --method auto after 0.1, 1 and 10 s beside that of the path tracer after the same
times, against a picture of the path tracer with --truth samples a pixel, whose noise is taken out.
Times are of a picture with facts, plan and all that is done before it but loading, upload and
building kernels.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import math
import os
import subprocess
import sys

from commands import run

SIZE = "160x120"


def picture_ms(stats):
    """Of what was done before the first picture, and of one picture."""
    once = stats.get("plan", {}).get("ms", 0)
    if "bake" in stats:
        once += stats["bake"]["layout_ms"] + stats["bake"]["bake_ms"]
    if "antiradiance" in stats:
        once += stats["antiradiance"]["linking_ms"]
    return once + stats["frame_ms"]["median"]


def render(clgi, scene, name, *flags):
    """The statistics of a picture by a plan."""
    run(clgi, "render", scene, "--quiet", "--full", "--size", SIZE,
        "-o", name + ".exr", "--stats", name + ".json", *flags)
    with open(name + ".json") as file:
        return json.load(file)


def difference(clgi, a, b):
    """Root mean squared difference over the mean of b."""
    return json.loads(run(clgi, "compare", a + ".exr", b + ".exr", "--no-flip", "--json"))["rel_rmse"]


def without(error, noise):
    """What is left of an error when the noise of the truth is taken out."""
    return math.sqrt(max(error * error - noise * noise, 0.0))


def percent(value):
    return "0" if value == 0 else f"{float(f'{100 * value:.2g}'):g} %"


def saving(options):
    print("| scene | method, with all | off although there is light for it | at most | changed "
          "| ms | with all, ms | saving |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene in options.scenes:
        name = os.path.join(options.out, os.path.splitext(os.path.basename(scene))[0])
        wish = ["--target-error", options.error]
        lean, full = [], []
        for _ in range(options.rounds):  # in turn: other programs slow both
            a = render(options.clgi, scene, name + "-plan", *wish)
            b = render(options.clgi, scene, name + "-all", *wish, "--with", "all")
            lean.append(picture_ms(a))
            full.append(picture_ms(b))
        lean, full = sorted(lean)[len(lean) // 2], sorted(full)[len(full) // 2]
        off = [e["name"] for e in a["plan"]["effects"]
               if not e["on"] and e["ground"] in ("proven", "measured")]
        # The same method with the same settings and all effects tells what was left out.
        same = a["method"] == b["method"] and a["plan"]["settings"] == b["plan"]["settings"]
        changed = percent(difference(options.clgi, name + "-plan", name + "-all")) \
            if same else "other settings"
        print(f"| {os.path.basename(name)} | {a['method']}, {b['method']} | {', '.join(off) or 'nothing'} "
              f"| {percent(a['plan']['bound'] or 0)} | {changed} | {lean:.1f} | {full:.1f} "
              f"| {full / lean:.1f} |", flush=True)


def whole(stats):
    """Flags for the method of a plan with its settings, and every effect that the scene has."""
    plan, out = stats["plan"], []
    for flag, name in (("--shadow-size", "shadow_size"), ("--face-size", "face_size"),
                       ("--area-samples", "area_samples")):
        out += [flag, plan["direct_light"][name]]
    settings = plan["settings"]
    if plan["method"] == "antiradiance":
        return out + ["--method", "antiradiance", "--bins", settings["bins"], "--elements",
                      settings["elements"]]
    if plan["method"] == "atlas":
        return out + ["--method", "atlas", "--vpls", settings["vpls"], "--atlas-size",
                      stats["bake"]["atlas_size"], "--bounces", 0]
    if plan["method"] == "transfer":
        return out + ["--method", "transfer"]
    return out + ["--method", "second-order", "--vpls", settings.get("vpls", 1000),
                  "--negative-vpls", max(settings.get("negative_vpls", 0), 100)]


def same(options):
    print("| scene | triangles | method | off although there is light for it | at most | changed "
          "| ms | with all, ms | saving |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene in options.scenes:
        label = os.path.splitext(os.path.basename(scene))[0]
        name = os.path.join(options.out, label)
        wish = ["--target-error", options.error]
        lean, full = [], []
        probe = subprocess.run([options.clgi, "plan", scene, "--quiet", "--size", SIZE],
                               capture_output=True, text=True)
        if probe.returncode:
            print(f"{label}: {probe.stderr.strip()}", file=sys.stderr)
            continue
        for _ in range(options.rounds):
            a = render(options.clgi, scene, name + "-plan", *wish)
            b = render(options.clgi, scene, name + "-all", *whole(a))
            lean.append(picture_ms(a))
            full.append(picture_ms(b))
        lean, full = sorted(lean)[len(lean) // 2], sorted(full)[len(full) // 2]
        off = [e["name"] for e in a["plan"]["effects"]
               if not e["on"] and e["ground"] in ("proven", "measured")]
        print(f"| {label} | {a['scene']['triangles']} | {a['method']} "
              f"| {', '.join(off) or 'nothing'} | {percent(a['plan']['bound'])} "
              f"| {percent(difference(options.clgi, name + '-plan', name + '-all'))} "
              f"| {lean:.1f} | {full:.1f} | {full / lean:.1f} |", flush=True)


def trace(options, scene, name, spp):
    """Seconds that the path tracer took."""
    run(options.clgi, "reference", scene, "--quiet", "--full", "--size", SIZE, "--spp", spp,
        "--seed", 7, "-o", name + ".exr", "--stats", name + ".json")
    with open(name + ".json") as file:
        return json.load(file)["seconds"]


def race(options):
    print("| scene | s | auto | takes, s | error | path tracer: samples | takes, s | error |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    rows = []
    for scene in options.scenes:
        name = os.path.join(options.out, os.path.splitext(os.path.basename(scene))[0])
        truth = name + "-truth"
        if not os.path.exists(truth + ".exr"):
            run(options.clgi, "reference", scene, "--quiet", "--full", "--size", SIZE, "--spp",
                options.truth, "-o", truth + ".exr", "--stats", truth + ".json")
        with open(truth + ".json") as file:
            own = json.load(file)["relative_error"]
        once = trace(options, scene, name + "-path", 1)
        for seconds in (0.1, 1, 10):
            stats = render(options.clgi, scene, name + "-auto", "--time-budget", f"{seconds}s")
            taken = picture_ms(stats) / 1000
            error = without(difference(options.clgi, name + "-auto", truth), own)
            spp = max(1, int(seconds / once))
            traced = trace(options, scene, name + "-path", spp)
            noise = without(difference(options.clgi, name + "-path", truth), own)
            print(f"| {os.path.basename(name)} | {seconds:g} | {stats['method']} | {taken:.2f} "
                  f"| {percent(error)} | {spp} | {traced:.2f} | {percent(noise)} |", flush=True)
            rows.append((os.path.basename(name), taken, error, traced, noise))
    plot(options, rows)


def plot(options, rows):
    """out/race.svg: error against time, a pair of lines for each scene."""
    sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "host", "lab", "plots"))
    from style import SERIES, canvas, save_svg
    figure = canvas(800, 500)
    axes = figure.add_axes((0.09, 0.11, 0.61, 0.85))
    for index, scene in enumerate(dict.fromkeys(row[0] for row in rows)):
        color, marker = SERIES[index % len(SERIES)]
        for column, label, line in ((1, scene, "-"), (3, scene + ", path tracer", "--")):
            times, errors = zip(*((row[column], 100 * row[column + 1]) for row in rows if row[0] == scene))
            axes.plot(times, errors, line, color=color, marker=marker, label=label)
    axes.set(xscale="log", yscale="log", xlabel="time of a picture, s", ylabel="error, %")
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0)
    save_svg(figure, os.path.join(options.out, "race.svg"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("what", choices=["saving", "same", "race"])
    parser.add_argument("clgi", help="the program")
    parser.add_argument("out", help="folder for pictures")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--error", default="0.1", help="saving, same: of the pictures")
    parser.add_argument("--rounds", type=int, default=3, help="saving, same: measurements of each")
    parser.add_argument("--truth", type=int, default=4096, help="race: samples a pixel of the truth")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    {"saving": saving, "same": same, "race": race}[options.what](options)


if __name__ == "__main__":
    main()
