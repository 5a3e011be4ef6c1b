#!/usr/bin/env python3
"""Whether pictures are as right as clgi says: scenes rendered and judged.

    samples/promises.py build/clgi out/ [--kinds room,window] [--seeds 1-10] [--truth 4s] [-- FLAG ...]
    samples/promises.py build/clgi out/ --peer --plot plot.svg --budgets 1s,10s
    samples/promises.py build/clgi out/ --kinds SCENE.glb --environment sky.hdr

Each scene of each kind (clgi scene, drawn from a seed; or a file) is rendered by its plan with the
flags behind --, by default --target-error 5%. The picture is then judged by clgi verify with other
random numbers and more time. A row of the table has what the render says of its error and what the
judge finds, each with its 95 % interval; below it stands how often the judge's value lies above the
end that the render names. With --peer the path tracer takes as long as the render did, and its
picture is judged as well. With --extents each scene stands in grounds of several sizes.
SPDX-License-Identifier: MIT
"""
import json
import os
import sys
import time

from commands import arguments, run

KINDS = ["room", "window", "sunlit", "slit", "courtyard", "pit", "terrain", "many-rooms", "dim-room",
         "dim-plain", "hidden-wall", "gloss"]
SKY = {"window", "sunlit", "courtyard", "pit", "dim-plain"}  # those that a sky lights


def percent(value):
    return "" if value is None else f"{float(f'{100 * value:.2g}'):g}"


def interval(found):
    """ "4.2 (3.5 to 4.9)" of a value with its ends; an end that is not limited is empty. """
    return f"{percent(found['value'])} ({percent(found['low'])} to {percent(found['high'])})"


def used(stats):
    """Seconds of the picture: of a time budget all that was used, else a sample of it."""
    return stats["time_budget"]["used"] if "time_budget" in stats else stats["frame_ms"]["median"] / 1e3


def timed(*command):
    begin = time.monotonic()
    run(*command)
    return time.monotonic() - begin


class Case:
    """A scene in its file, with the flags that light it."""

    def __init__(self, options, kind, seed, extent):
        self.options = options
        is_file = kind.endswith((".glb", ".gltf"))
        stem = os.path.splitext(os.path.basename(kind))[0] if is_file else f"{kind}-{seed}"
        self.label = stem if is_file else f"{kind} {seed}"
        if extent:
            self.label += f", {float(extent):g} m"
            stem += f"-{extent}"
        self.name = os.path.join(options.out, stem)
        self.scene = kind if is_file else self.name + ".glb"
        self.sky = ["--environment", options.environment] if is_file or kind in SKY else []
        if not options.environment:
            self.sky = []
        if not is_file:
            around = ["--extent", extent] if extent else []
            run(options.clgi, "scene", kind, "--seed", seed, "-o", self.scene, "--quiet", *around)

    def render(self, flags):
        """The statistics of the render and the seconds of the whole command."""
        seconds = timed(self.options.clgi, "render", self.scene, "--quiet", "--full",
                        "--size", self.options.size, "-o", self.name + ".exr",
                        "--png", self.name + ".png", "--stats", self.name + ".json",
                        *self.sky, *flags, *self.options.flags)
        with open(self.name + ".json") as file:
            return json.load(file), seconds

    def trace(self, seconds):
        """The path tracer's picture after as many seconds."""
        command = [self.options.clgi, "reference", self.scene, "--quiet", "--full",
                   "--size", self.options.size, "-o", self.name + "-peer.exr", "--filter", "box", *self.sky, "--spp"]
        few = 4
        one = timed(*command, few) / few  # loading counts, as it does in the render's time
        timed(*command, max(1, round(seconds / one)))

    def judge(self, name, *flags):
        return json.loads(run(self.options.clgi, "verify", name, self.scene, "--quiet", "--json",
                              "--limit", self.options.truth, "--seed", 7, *self.sky, *flags))


def seeds_of(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def plot(path, rows):
    """Errors against seconds of the whole command, the budgets of a scene joined. rows: name of the
    scene, seconds, errors of clgi and of the path tracer (0 to 1)."""
    sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "host", "lab", "plots"))
    from style import BASELINE, SERIES, canvas, save_svg
    figure = canvas(800, 500)
    axes = figure.add_axes((0.09, 0.11, 0.88, 0.85))
    least = 1e-3  # of the axis; an error of 0 is one that the judge's noise hides
    for column, label in ((2, "clgi"), (3, "the path tracer, on the same cores")):
        color, marker = SERIES[0] if column == 2 else BASELINE
        for name in dict.fromkeys(row[0] for row in rows):
            of = sorted(row for row in rows if row[0] == name)
            axes.plot([row[1] for row in of], [100 * max(row[column], least) for row in of], "-",
                      color=color, marker=marker, label=label, linewidth=0.8)
            label = None
    axes.set(xscale="log", yscale="log", xlabel="time of the whole command, s", ylabel="error, %")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    axes.legend(loc="upper right")
    save_svg(figure, path)


def main():
    parser = arguments(__doc__.split("\n")[0])
    parser.add_argument("--kinds", default=",".join(KINDS), help="kinds or files")
    parser.add_argument("--seeds", default="1-3", help="1-10")
    parser.add_argument("--extents", default="", help="metres, with commas; 0: as the kind has it")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--environment", default="1,1.2,1.5", help="of kinds and files that need one")
    parser.add_argument("--truth", default="4s", help="how long the judge traces paths")
    parser.add_argument("--budgets", default="", help="times with commas, each as --time-budget")
    parser.add_argument("--peer", action="store_true", help="the path tracer beside it")
    parser.add_argument("--plot", help="with --peer: errors by time, .svg; needs matplotlib")
    given = sys.argv[1:]
    end = given.index("--") if "--" in given else len(given)
    options = parser.parse_args(given[:end])
    options.flags = given[end + 1:] or ([] if options.budgets else ["--target-error", "5%"])
    os.makedirs(options.out, exist_ok=True)
    if options.plot:
        import matplotlib  # noqa: F401: what is missing is told before all pictures, not after
    peer = " path tracer, % |" if options.peer else ""
    print("| scene | method | said, % | judged, % | energy | used, s | command, s |" + peer)
    print("| --- | --- | --- | --- | --- | --- | --- |" + (" --- |" if options.peer else ""))
    above = checked = 0
    rows = []
    cases = [(kind, seed, extent, budget) for kind in options.kinds.split(",")
             for seed in ([0] if "." in kind else seeds_of(options.seeds))
             for extent in options.extents.split(",") for budget in options.budgets.split(",")]
    for kind, seed, extent, budget in cases:
        case = Case(options, kind, seed, extent)
        stats, seconds = case.render(["--time-budget", budget] if budget else [])
        judged = case.judge(case.name + ".exr")
        said = stats.get("measured_error")
        if said and said["high"] is not None:
            checked += 1
            above += judged["value"] > said["high"]
        row = (f"| {case.label} | {stats['method']} | {interval(said) if said else ''} "
               f"| {interval(judged)} | {judged['energy']['value']:.3f} "
               f"| {used(stats):.2f} | {seconds:.1f} |")
        if options.peer:
            case.trace(seconds)
            traced = case.judge(case.name + "-peer.exr", "--filter", "box")
            rows.append((case.label, seconds, judged["value"], traced["value"]))
            row += f" {interval(traced)} |"
        print(row, flush=True)
    print(f"\nAbove the end that was said: {above} of {checked}.")
    if options.plot and rows:
        plot(options.plot, rows)


if __name__ == "__main__":
    main()
