# A contact sheet: panels of one size in three columns, of more than six in four, each with its lines
# below.
# SPDX-License-Identifier: MIT
import math

from style import canvas, data, plt, points, width_of

panels = data()
columns = 3 if len(panels) <= 6 else 4
pictures = [plt.imread(panel["picture"]) for panel in panels]
height, width = pictures[0].shape[:2]
text = max(12.0, width / 23.0)
gap = round(0.8 * text)
cell = math.ceil(max([width] + [width_of(line, text) for panel in panels for line in panel["lines"]]))
below = round(3.9 * text)
across, down = min(len(panels), columns), math.ceil(len(panels) / columns)
sheet = canvas(gap + across * (cell + gap), gap + down * (height + below))
paper = sheet.bbox.height
for i, (panel, picture) in enumerate(zip(panels, pictures)):
    left, top = gap + i % columns * (cell + gap), gap + i // columns * (height + below)
    sheet.figimage(picture, left, paper - top - height)
    for line, (words, weight) in enumerate(zip(panel["lines"], ("bold", "normal"))):
        sheet.text(left / sheet.bbox.width, 1 - (top + height + (0.4 + 1.4 * line) * text) / paper,
                   words, va="top", fontsize=points(text), fontweight=weight)
sheet.savefig("sheet.png")
