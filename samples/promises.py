#!/usr/bin/env python3
"""Whether pictures are as right as clgi says: scenes drawn from seeds, rendered and judged.

    samples/promises.py build/clgi out/ [--kinds room,window] [--seeds 1-10] [--truth 4s] [-- FLAG ...]

Each scene of each kind (clgi scene) is rendered by its plan with the flags behind --, by default
--target-error 5%. The picture is then judged by clgi verify with other random numbers and more time.
A row of the table has what the render says of its error and what the judge finds, each with its 95 %
interval; below it stands how often the judge's value lies above the end that the render names.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import os
import time

from commands import run

KINDS = ["room", "window", "slit", "courtyard", "terrain", "many-rooms", "dim-room", "dim-plain",
         "hidden-wall", "gloss"]
SKY = {"window", "courtyard", "dim-plain"}  # those that nothing else lights


def percent(value):
    return "" if value is None else f"{float(f'{100 * value:.2g}'):g}"


def interval(found):
    """ "4.2 (3.5 to 4.9)" of a value with its ends; an end that is not limited is empty. """
    return f"{percent(found['value'])} ({percent(found['low'])} to {percent(found['high'])})"


def judged(options, kind, seed):
    """The statistics of a render, what the judge says of it, and the seconds of the whole command."""
    name = os.path.join(options.out, f"{kind}-{seed}")
    sky = ["--environment", options.sky] if kind in SKY else []
    run(options.clgi, "scene", kind, "--seed", seed, "-o", name + ".glb", "--quiet")
    begin = time.monotonic()
    run(options.clgi, "render", name + ".glb", "--quiet", "--full", "--size", options.size,
        "-o", name + ".exr", "--png", name + ".png", "--stats", name + ".json", *sky, *options.flags)
    seconds = time.monotonic() - begin
    with open(name + ".json") as file:
        stats = json.load(file)
    judge = run(options.clgi, "verify", name + ".exr", name + ".glb", "--quiet", "--json",
                "--limit", options.truth, "--seed", 7, *sky)
    return stats, json.loads(judge), seconds


def seeds_of(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("clgi")
    parser.add_argument("out")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--seeds", default="1-3", help="1-10")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--sky", default="1,1.2,1.5", help="environment of kinds that need one")
    parser.add_argument("--truth", default="4s", help="how long the judge traces paths")
    parser.add_argument("flags", nargs="*")
    options = parser.parse_args()
    options.flags = options.flags or ["--target-error", "5%"]
    os.makedirs(options.out, exist_ok=True)
    print("| scene | method | said, % | judged, % | energy | picture, s | command, s |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    above = checked = 0
    for kind in options.kinds.split(","):
        for seed in seeds_of(options.seeds):
            stats, judge, seconds = judged(options, kind, seed)
            said = stats.get("measured_error")
            if said and said["high"] is not None:
                checked += 1
                above += judge["value"] > said["high"]
            print(f"| {kind} {seed} | {stats['method']} | {interval(said) if said else ''} "
                  f"| {interval(judge)} | {judge['energy']['value']:.3f} "
                  f"| {stats['frame_ms']['median'] / 1e3:.2f} | {seconds:.1f} |", flush=True)
    print(f"\nAbove the end that was said: {above} of {checked}.")


if __name__ == "__main__":
    main()
