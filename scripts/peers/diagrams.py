"""Work-precision diagrams of the measured runs: `diagrams.py RUNS.json DIAGRAM.svg`. The same runs give the same file."""

import json
import sys
from math import ceil, floor, log10
from pathlib import Path

import matplotlib
import matplotlib.ticker

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "cosserat", "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans"], "font.size": 11, "axes.titlesize": 12,
})
import matplotlib.pyplot as plt

# Title, and what its reference is known to where a run may come near it.
PANELS = {
    "spring": ("Helical spring to 100 N", "error of the tip [m]", None),
    "bend": ("45° bend, force 600", "error of the tip", None),
    "pendulum": ("Wilberforce pendulum, 2 s", "largest error of the bob [m]", 1.5e-5),
    "cantilever": ("Soft cantilever in motion, 1 s", "largest error of the tip [m]", 5e-5),
}
# Colours of Okabe and Ito; ours are lines, theirs are dashed.
STYLES = {
    "cosserat, degree 2": ("#0072B2", "o", "-"),
    "cosserat, degree 4": ("#009E73", "s", "-"),
    "cosserat, degree 6": ("#56B4E9", "D", "-"),
    "cosserat, SE(3)": ("#4D4D4D", "v", "-"),
    "Exudyn": ("#D55E00", "^", "--"),
    "OpenSees": ("#CC79A7", "P", "--"),
    "PyElastica": ("#E69F00", "X", "--"),
}


def panel(axes, problem, runs):
    title, error, known = PANELS[problem]
    for series, (colour, marker, line) in STYLES.items():
        points = sorted((run["error"], run["seconds"]) for run in runs if run["series"] == series)
        if points:
            axes.plot(*zip(*points), color=colour, marker=marker, linestyle=line, markersize=6, label=series)
    if known:
        axes.axvspan(known / 100, known, color="#DDDDDD", zorder=0, linewidth=0)
        axes.text(0.985, 0.97, "the reference is no better", rotation=90, ha="right", va="top", fontsize=9,
                  color="#555555", transform=axes.transAxes)
    axes.set(xscale="log", yscale="log", title=title, xlabel=error, ylabel="processor time of the solve [s]")
    errors = [run["error"] for run in runs]
    low = min([*errors, known] if known else errors)
    axes.set_xlim(low / 2.5, max(errors) * 2.5)
    axes.invert_xaxis()
    # Whole decades, so that every axis has its powers of ten.
    times = [log10(run["seconds"]) for run in runs]
    axes.set_ylim(10.0 ** floor(min(times) - 0.1), 10.0 ** ceil(max(times) + 0.1))
    axes.yaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axes.grid(True, which="major", color="#E5E5E5", linewidth=0.8)
    axes.set_axisbelow(True)


def main():
    runs = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["runs"]
    figure, grid = plt.subplots(2, 2, figsize=(10.5, 8.6), layout="constrained")
    for axes, problem in zip(grid.flat, PANELS):
        panel(axes, problem, [run for run in runs if run["problem"] == problem])
    handles = {}
    for axes in grid.flat:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    shown = [name for name in STYLES if name in handles]
    figure.legend([handles[name] for name in shown], shown, loc="outside lower center", ncols=4, frameon=False)
    figure.suptitle("Work and precision: lower is faster, further right is more accurate", fontsize=12)
    figure.savefig(sys.argv[2], metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main()
