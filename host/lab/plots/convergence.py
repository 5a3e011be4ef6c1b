# Residual and error of iterations, step by step.
# SPDX-License-Identifier: MIT
from style import SERIES, canvas, data, save_svg

PANELS = {"residuals": "Change of what arrives in a step,\nrelative to the first step",
          "errors": "Error of what arrives,\nagainst the converged solution"}
STYLES = ["-", "--", "-."]

curves = data()["curves"]
figure = canvas(960, 480)
for panel, (name, title) in enumerate(PANELS.items()):
    axes = figure.add_subplot(1, 2, panel + 1)
    for k, curve in enumerate(curves):
        # What no logarithm shows is left out.
        steps = [i for i, value in enumerate(curve[name], 1) if value is not None and value > 0]
        values = [curve[name][i - 1] for i in steps]
        color = SERIES[k % len(SERIES)][0]
        axes.plot(steps, values, STYLES[k % 3], color=color, linewidth=1.8,
                  label=curve["name"] + (", diverges" if curve["diverged"] else ""))
        if curve["diverged"]:  # a cross where it is given up
            axes.plot(steps[-1:], values[-1:], "x", color=color, markersize=9, markeredgewidth=2.2)
    axes.set(yscale="log", xlabel="step", ylabel="relative change" if panel == 0 else
             "relative error", title=title)
    axes.set_xlim(left=0)
figure.subplots_adjust(0.07, 0.2, 0.98, 0.87, wspace=0.22)
figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncol=len(curves))
save_svg(figure, "convergence.svg")
