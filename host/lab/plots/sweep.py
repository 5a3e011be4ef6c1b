# The plots of a sweep, error against time, and the page that has them.
# SPDX-License-Identifier: MIT
import base64
import pathlib

import jinja2
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from style import BASELINE, SERIES, canvas, data, save_svg

PATH_TRACER = "path tracer"
MOST_SHOWN = 10.0  # larger errors are listed in the tables only; they would compress the plot
WORK = {"pictures": "a frame", "atlas": "a bake", "vertices": "for all vertices"}


def shown(point, truth):
    error = point["error"][truth]
    return not point.get("given_up") and error is not None and 0 < error <= MOST_SHOWN


def belongs(point, truth):
    """The path tracer has points for each truth."""
    return point["method"] != PATH_TRACER or point["series"] == truth


def left_out(points, truth):
    """How many points the plot leaves out, and why."""
    counts = dict.fromkeys(("diverged", "not finite", "above 1000 %", "within noise"), 0)
    for point in points:
        error = point["error"][truth]
        if not belongs(point, truth) or shown(point, truth):
            continue
        counts["diverged" if point.get("given_up") else "not finite" if error is None else
               "above 1000 %" if error > MOST_SHOWN else "within noise"] += 1
    told = ", ".join(f"{count} {why}" for why, count in counts.items() if count)
    return f" ({told} left out)" if told else ""


def label_logarithmic(axis, low, high):
    """Plain numbers, at more places where the axis is short."""
    digits = (1, 1.5, 2, 3, 5, 7) if high < 12 * low else (1, 2, 5) if high < 300 * low else (1,)
    axis.set_major_locator(LogLocator(subs=digits, numticks=20))
    axis.set_minor_locator(LogLocator(subs=range(1, 10), numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def plot(sweep, truth, work):
    figure = canvas(900, 460)
    axes = figure.add_axes((0.07, 0.12, 0.62, 0.76))
    places = []

    def line(name, points, **how):
        points = sorted((p["ms"], 100 * p["error"][truth]) for p in points if shown(p, truth))
        places.extend(points)
        if points:
            axes.plot(*zip(*points), label=name, gid=name, **how)

    for k, method in enumerate(sweep["methods"]):
        color, marker = SERIES[k % len(SERIES)]
        of = [point for point in sweep["points"] if point["method"] == method]
        line(f"{method}, all settings", of, color=color, marker=marker, linestyle="", alpha=0.35,
             markersize=4, markeredgewidth=0)
        line(f"{method}, front", [point for point in of if point["front"][truth]], color=color,
             marker=marker, markersize=5, linewidth=1.8, zorder=3)
    line(PATH_TRACER, [point for point in sweep["points"]
                       if point["method"] == PATH_TRACER and point["series"] == truth],
         color=BASELINE[0], marker=BASELINE[1], markersize=5, linewidth=1.8, linestyle="--")
    axes.set(xscale="log", yscale="log", xlabel=f"milliseconds {work}", ylabel="relative error, %",
             title=f"Error against the {truth} reference{left_out(sweep['points'], truth)}")
    for axis, values in zip((axes.xaxis, axes.yaxis), zip(*places)):
        label_logarithmic(axis, min(values), max(values))
    if places:
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0)
    save_svg(figure, f"error-{truth}.svg")


def inline(name):
    """A plot without the XML prologue can stand inside the page."""
    text = pathlib.Path(name).read_text(encoding="utf-8")
    return text[text.index("<svg"):]


def png(name):
    return base64.b64encode(pathlib.Path(name).read_bytes()).decode()


def knobs(values):
    return ", ".join(f"{name} {value}" for name, value in values.items())


def fixed(value, digits, factor=1):
    return "not finite" if value is None else f"{factor * value:.{digits}f}"


given = data()
sweep = given["sweep"]
sweep["methods"] = given["methods"]
for reference in sweep["references"]:
    plot(sweep, reference["name"], WORK[given["of"]])
page = jinja2.Environment(loader=jinja2.FileSystemLoader("."), autoescape=True, trim_blocks=True,
                          lstrip_blocks=True)
page.filters.update(inline=inline, png=png, knobs=knobs, fixed=fixed)
pathlib.Path("index.html").write_text(
    page.get_template("page.html").render(given, **sweep), encoding="utf-8")
