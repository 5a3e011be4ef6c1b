# A picture, and below it a bar that says what its colours mean.
# SPDX-License-Identifier: MIT
import math

import numpy

from style import INK, canvas, data, plt, points, width_of


def label(value):
    """At most four digits: "0.25", "-3", "2e-7"."""
    number, _, power = f"{value or 0.0:.4g}".partition("e")
    return number + (f"e{int(power)}" if power else "")


scale = data()
picture = plt.imread("picture.png")
height, width = picture.shape[:2]
text = max(12.0, 13.0 * math.sqrt(width / 640.0))
paper = max(width, round(22 * text))
low, high = scale["from"], scale["to"]
half = 0.5 * max(width_of(label(low), text), width_of(label(high), text))
left = math.ceil(2.2 * text + width_of(scale["caption"], text) + half)
length = math.floor(paper - left - half - text)

figure = canvas(paper, height + round(4 * text))
whole = figure.bbox.height
figure.figimage(picture, (paper - width) // 2, whole - height)
bar = figure.add_axes((left / paper, 1 - (height + 2 * text) / whole, length / paper,
                       1.1 * text / whole))
bar.imshow(numpy.array([scale["colors"]], numpy.uint8), aspect="auto", extent=(0, 1, 0, 1),
           interpolation="nearest")
steps = next((n for n in (4, 2) if n * (2 * half + text) <= length), 1)
shares = numpy.linspace(0, 1, steps + 1) if high > low else [0.5]
bar.set_xticks(shares, [label(low + (high - low) * share) for share in shares],
               fontsize=points(text))
bar.set_yticks([])
bar.grid(False)
for spine in bar.spines.values():
    spine.set(visible=True, color=INK)
bar.text(-(half + 1.2 * text) / length, 0.5, scale["caption"], va="center", ha="right",
         fontsize=points(text), transform=bar.transAxes)
figure.savefig("scaled.png")
