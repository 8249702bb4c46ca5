"""Curves of training and of boundary-aware tuning over their steps, of our measurements."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drawing.figure_inputs import Results, number
from drawing.figure_style import COLOURS, LINES, MARKERS, from_zero, legend_above, line_style, panels

Made = tuple[Figure, str]  # with its caption


def curve(axes: Axes, rows: Sequence[dict[str, str]], x: str, y: str, **style: object) -> None:
    """What is no number (`equal`) is a gap."""
    values = [number(row[y]) for row in rows]
    axes.plot(
        [number(row[x]) for row in rows],
        [float("nan") if value is None else value for value in values],
        markevery=max(1, len(rows) // 10),
        **style,
    )


def tuning_curve(results: Results) -> Made:
    """A row of diagrams for each scene: a colour for each size of voxels, a dash for each beta."""
    data = results.table(
        "boundary_study",
        "boundary_study.py",
        ("scene", "of the preset's", "beta", "step", "PSNR dB", "misordered", "in pixels"),
    )
    scenes, factors, betas = (data.different(key) for key in ("scene", "of the preset's", "beta"))
    columns = {
        "PSNR dB": "PSNR of paper order, dB",
        "misordered": "misordered in groups, share of Gaussians",
        "in pixels": "misordered at pixels, share of blends",
    }
    figure, flat = panels(len(columns) * len(scenes), across=len(columns), width=3.6, height=2.4)
    for at, axes in enumerate(flat):
        scene = scenes[at // len(columns)]
        column, title = list(columns.items())[at % len(columns)]
        for size, factor in enumerate(factors):
            for dash, beta in enumerate(betas):
                rows = data.where(**{"scene": scene, "of the preset's": factor, "beta": beta})
                style = {"color": COLOURS[3 * size % len(COLOURS)], "linestyle": LINES[dash % 4]}
                marker = MARKERS[(len(betas) * size + dash) % len(MARKERS)]
                label = f"voxels x {factor}, beta {beta}"
                curve(axes, rows, "step", column, label=label, marker=marker, **style)
        axes.set_title(f"{scene}: {title}", fontsize=8.5)
        axes.set_xlabel("step")
        if column != "PSNR dB":
            from_zero(axes)
    legend_above(figure, flat[0], columns=len(betas))
    return figure, f"Boundary-aware tuning. From {data.made}"


def training_curve(results: Results) -> Made:
    data = results.table(
        "training_curves",
        "training_curves.py",
        ("data set", "seed", "step", "seconds", "PSNR dB"),
    )
    figure, (steps, minutes) = panels(2)
    trainings = list(dict.fromkeys((row["data set"], row["seed"]) for row in data.rows))
    for at, (name, seed) in enumerate(trainings):
        rows = data.where(**{"data set": name, "seed": seed})
        style = {"label": f"{name}, seed {seed}", **line_style(at)}
        curve(steps, rows, "step", "PSNR dB", **style)
        timed = [{**row, "minutes": f"{number(row['seconds']) / 60:.2f}"} for row in rows]
        curve(minutes, timed, "minutes", "PSNR dB", **style)
    for axes, what in ((steps, "step"), (minutes, "minutes, with the looks in them")):
        axes.set_title("PSNR of the test views, dB")
        axes.set_xlabel(what)
    legend_above(figure, steps)
    return figure, f"Training from photographs. From {data.made}"


FIGURES = {"tuning_curve": tuning_curve, "training_curve": training_curve}
