# A contact sheet: panels of one size in three columns, each with its lines below.
# SPDX-License-Identifier: MIT
import math

from style import canvas, data, plt, points, width_of

COLUMNS = 3

panels = data()
pictures = [plt.imread(panel["picture"]) for panel in panels]
height, width = pictures[0].shape[:2]
text = max(12.0, width / 23.0)
gap = round(0.8 * text)
cell = math.ceil(max([width] + [width_of(line, text) for panel in panels for line in panel["lines"]]))
below = round(3.9 * text)
across, down = min(len(panels), COLUMNS), math.ceil(len(panels) / COLUMNS)
sheet = canvas(gap + across * (cell + gap), gap + down * (height + below))
paper = sheet.bbox.height
for i, (panel, picture) in enumerate(zip(panels, pictures)):
    left, top = gap + i % COLUMNS * (cell + gap), gap + i // COLUMNS * (height + below)
    sheet.figimage(picture, left, paper - top - height)
    for line, (words, weight) in enumerate(zip(panel["lines"], ("bold", "normal"))):
        sheet.text(left / sheet.bbox.width, 1 - (top + height + (0.4 + 1.4 * line) * text) / paper,
                   words, va="top", fontsize=points(text), fontweight=weight)
sheet.savefig("sheet.png")
