# What all drawings have in common: letters, colours, sizes in pixels.
# SPDX-License-Identifier: MIT
import json

import matplotlib

matplotlib.use("agg")
from matplotlib import pyplot as plt  # noqa: E402

DPI = 96  # that of SVG in browsers
INK, PALE = "#282828", "#dddddd"
# Of Okabe and Ito: told apart by those who see no red or no green. Each with a marker of its own.
SERIES = [("#0072b2", "o"), ("#009e73", "s"), ("#aa4499", "^"), ("#56b4e9", "v"), ("#e69f00", "P"),
          ("#666666", "X")]
BASELINE = ("#d55e00", "D")

plt.rcParams.update({
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans", "Verdana", "sans-serif"],
    "font.size": 9, "axes.titlesize": 10, "axes.titlelocation": "left", "axes.titlepad": 10,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": PALE, "grid.linewidth": 0.6,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
    "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": "#888888", "xtick.color": INK,
    "ytick.color": INK, "figure.dpi": DPI, "savefig.dpi": DPI,
    "svg.fonttype": "none", "svg.hashsalt": "clgi"})


def data():
    with open("data.json", encoding="utf-8") as file:
        return json.load(file)


def canvas(width, height):
    """Empty paper, in pixels."""
    return plt.figure(figsize=(width / DPI, height / DPI))


def save_svg(figure, name):
    """The same bytes for the same data."""
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    figure.savefig(name, metadata=nothing)


def points(pixels):
    """A height of letters as matplotlib wants it."""
    return 72 * pixels / DPI


def width_of(text, size):
    """Of a line of letters of that height, pixels."""
    from matplotlib.textpath import TextPath
    return TextPath((0, 0), text, size=size).get_extents().width if text.strip() else 0.0
