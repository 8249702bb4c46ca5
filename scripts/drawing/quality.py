"""Errors of pictures against time, bytes and energy: of machines, of renderers in software, of
tuning and training as they go, of sizes of voxels."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.transforms import Bbox

from drawing.figure import (
    COLOURS,
    INK,
    LINES,
    MARKERS,
    ON_PAPER,
    Made,
    Results,
    from_zero,
    legend_above,
    line_style,
    number,
    panels,
    plain_logarithmic,
    published,
)

EQUAL = "equal"
NAME_OFFSETS = ((6, -10), (-1, 7), (-1, 17), (6, -20), (-1, 27), (6, -30), (-70, -10))  # points
HIGHEST = 100  # dB; nearer pictures are drawn there, equal ones above
NAMED_APART = 3  # dB better than the machine before
SCRIPT = "results.py error_against_time"
# By order: its name, colour, marker and face.
ORDERS = {
    "exact": ("exact order", COLOURS[0], "o", COLOURS[0]),
    "tiles": ("tile-centric", COLOURS[1], "s", COLOURS[1]),
    "paper": ("paper order", COLOURS[3], "D", "white"),
}
PRESET = "as the preset"  # what is moved of it
TIMED = ("scene", "view", "renderer", "finished below", "threads", "ms", "PSNR dB")
DOUBLE = "double"


def quality(text: str) -> float:
    """In dB, of equal pictures as well."""
    value = number(text)
    equal = value is None or not math.isfinite(value)
    return HIGHEST + 10 if equal else min(value, HIGHEST)


def front(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Of (cost, quality) those that no cheaper one reaches, from the cheapest on."""
    kept: list[tuple[float, float]] = []
    for cost, gain in sorted(points, key=lambda p: (p[0], -p[1])):
        if not kept or gain > kept[-1][1]:
            kept.append((cost, gain))
    return kept


def draw_machines(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    """A marker for each machine, larger for the preset of an order."""
    for order, (label, colour, marker, face) in ORDERS.items():
        for preset, size in ((False, 5), (True, 10)):
            of = [r for r in rows if r["order"] == order and (r["moved"] == PRESET) == preset]
            axes.plot(
                [number(row["ms"]) for row in of],
                [quality(row["PSNR dB"]) for row in of],
                marker=marker,
                markersize=size,
                markerfacecolor=face,
                markeredgecolor=INK if preset else colour,
                linestyle="none",
                label=None if preset else label,
                zorder=4 if preset else 3,
            )
    axes.set_xscale("log")
    plain_logarithmic(axes.xaxis)


def name_of(row: dict[str, str]) -> str:
    words = row["to"] if row["moved"] == "combined" else f"{row['moved']} {row['to']}"
    return words.strip().replace("group px", "group")


def draw_front(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    """A line along what no faster machine reaches, and the names of these. The limits of the axes
    are set."""
    points = {(number(row["ms"]), quality(row["PSNR dB"])): name_of(row) for row in rows}
    line = front(list(points))
    axes.step(*zip(*line), where="post", color="#626a78", linewidth=1, zorder=1)
    named = [p for at, p in enumerate(line) if not at or p[1] - line[at - 1][1] > NAMED_APART]
    taken: list[Bbox] = []
    for point in named:
        name_beside(axes, points[point], point, taken)


def name_beside(axes: Axes, name: str, point: tuple[float, float], taken: list[Bbox]) -> None:
    """At the first place around the point where no other name stands."""
    for offset in NAME_OFFSETS:
        text = axes.annotate(name, point, xytext=offset, textcoords="offset points", fontsize=8,
                             bbox=ON_PAPER, zorder=2)  # fmt: skip
        box = text.get_window_extent()
        if not any(box.overlaps(other) for other in taken) or offset == NAME_OFFSETS[-1]:
            taken.append(box)
            return
        text.remove()


def error_image(results: Results) -> Made:
    """A diagram for each scene."""
    columns = ("scene", "order", "moved", "to", "PSNR dB", "ms")
    data = results.table("error_image", SCRIPT, columns)
    scenes = data.different("scene")
    figure, flat = panels(len(scenes), width=4.4, height=3.2)
    for axes, scene in zip(flat, scenes):
        rows = data.where(scene=scene)
        draw_machines(axes, rows)
        axes.set(xlabel="frame time, ms", ylim=(None, quality(EQUAL) + 8))
        draw_front(axes, rows)
        axes.axhline(quality(EQUAL), color=INK, linewidth=0.6, linestyle=":")
        axes.annotate(
            EQUAL,
            (0.99, quality(EQUAL)),
            xycoords=("axes fraction", "data"),
            ha="right",
            va="bottom",
            fontsize=8,
            bbox=ON_PAPER,
        )
        axes.set_title(f"{scene}: PSNR, dB")
    legend_above(figure, flat[0])
    return figure, (
        "Each marker is a machine, a large one a preset; the line: what no faster machine reaches; "
        f"above {HIGHEST} dB at {HIGHEST}. From {data.made}"
    )


def error_tuning(results: Results) -> Made:
    columns = ("what", "of", "moved", "to", "seconds", "PSNR dB")
    data = results.table("error_tuning", SCRIPT, columns)
    subjects = list(dict.fromkeys((row["what"], row["of"], row["moved"]) for row in data.rows))
    figure, flat = panels(len(subjects), across=3, width=3.9, height=2.7)
    for axes, (what, of, knob) in zip(flat, subjects):
        of_subject = data.where(what=what, of=of)
        for at, value in enumerate(dict.fromkeys(row["to"] for row in of_subject)):
            rows = [row for row in of_subject if row["to"] == value]
            x, y = ([number(row[name]) for row in rows] for name in ("seconds", "PSNR dB"))
            axes.plot(x, y, **line_style(at), label=f"{knob} {value}")
        axes.set_title(f"{what} {of}: PSNR of test views, dB", fontsize=8.5)
        axes.set_xlabel("seconds, with the looks in them")
        axes.legend(loc="best")
    return (
        figure,
        f"Quality against wall time; a marker is a look at the test views. From {data.made}",
    )


def error_renderers(results: Results) -> Made:
    """A row of diagrams for each view: renderers, and thresholds of finishing."""
    data = results.table("error_renderers", SCRIPT, TIMED)
    views = list(dict.fromkeys((row["scene"], row["view"]) for row in data.rows))
    figure, flat = panels(2 * len(views), width=4.6, height=2.7)
    for (scene, view), of_renderers, of_thresholds in zip(views, flat[::2], flat[1::2]):
        rows = data.where(scene=scene, view=view)
        draw_renderers(of_renderers, rows)
        draw_thresholds(of_thresholds, [row for row in rows if row["renderer"] == DOUBLE])
        for axes, what in ((of_renderers, "renderers"), (of_thresholds, "finished below")):
            axes.set_xscale("log")
            plain_logarithmic(axes.xaxis)
            axes.set_title(f"{scene} {view}, {what}: PSNR, dB", fontsize=8.5)
            axes.set_xlabel("ms of a frame, wall time")
    legend_above(figure, flat[0], columns=4)
    return figure, (
        "Left: renderers beside the one in double precision, whose time is the upright line; "
        "small markers: one thread, larger ones: more. Right: double that takes a pixel as "
        "finished below "
        f"so much light, beside double to its end. From {data.made}"
    )


def draw_renderers(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    """A line from one thread to more for each renderer; the upright one is double."""
    others = [row for row in rows if row["renderer"] != DOUBLE]
    for at, name in enumerate(dict.fromkeys(row["renderer"] for row in others)):
        of_name = [row for row in others if row["renderer"] == name]
        x = [number(row["ms"]) for row in of_name]
        y = [quality(row["PSNR dB"]) for row in of_name]
        style = {"color": COLOURS[at % len(COLOURS)], "marker": MARKERS[at % len(MARKERS)]}
        axes.plot(x, y, linestyle=":", linewidth=0.8, color=style["color"])
        for size, (ms, psnr_db) in enumerate(zip(x, y)):
            label = name if size == 0 else None
            axes.plot(ms, psnr_db, linestyle="none", markersize=5 + 2.5 * size, label=label,
                      **style, markeredgecolor=INK, markeredgewidth=0.5)  # fmt: skip
    finished = {row["finished below"] for row in others}
    for row in rows:
        if row["renderer"] == DOUBLE and row["finished below"] in finished:
            axes.axvline(number(row["ms"]), color=INK, linestyle=":", linewidth=1)


def draw_thresholds(axes: Axes, rows: Sequence[dict[str, str]]) -> None:
    for at, threads in enumerate(dict.fromkeys(row["threads"] for row in rows)):
        of_threads = [row for row in rows if row["threads"] == threads]
        x, y = ([number(row[name]) for row in of_threads] for name in ("ms", "PSNR dB"))
        style = {"color": COLOURS[3 * at % len(COLOURS)], "linestyle": LINES[at % len(LINES)]}
        axes.plot(
            x,
            y,
            marker=MARKERS[at % len(MARKERS)],
            label=f"{threads} thread{'s' * (threads != '1')}",
            **style,
        )
        for row, *place in zip(of_threads, x, y) if at == 0 else ():
            axes.annotate(row["finished below"], place, xytext=(5, -3),
                          textcoords="offset points", fontsize=7, bbox=ON_PAPER)  # fmt: skip
    axes.legend(loc="lower right")


def finite(text: str) -> float:
    """What is none, as of a picture without error, is a gap."""
    value = number(text)
    return value if value is not None and math.isfinite(value) else math.nan


def curve(axes: Axes, rows: Sequence[dict[str, str]], x: str, y: str, **style: object) -> None:
    axes.plot(
        [number(row[x]) for row in rows],
        [finite(row[y]) for row in rows],
        markevery=max(1, len(rows) // 10),
        **style,
    )


def tuning_curve(results: Results) -> Made:
    """A row of diagrams for each scene: a colour for each size of voxels, a dash for each beta."""
    data = results.table(
        "boundary_study",
        "results.py boundary_study",
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
        "results.py training_curves",
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


def voxel_size(results: Results) -> Made:
    columns = ("scene", "of the preset's", "scene is", "PSNR dB", "mJ")
    data = results.table("voxel_study", "results.py voxel_study", columns)
    figure, (decibels, energy) = panels(2)
    lines = [(s, state) for s in data.different("scene") for state in data.different("scene is")]
    for at, (scene, state) in enumerate(lines):
        rows = data.where(**{"scene": scene, "scene is": state})
        rows.sort(key=lambda row: number(row["of the preset's"]))
        sizes = [number(row["of the preset's"]) for row in rows]
        for axes, column in ((decibels, "PSNR dB"), (energy, "mJ")):
            style = {"label": f"{scene}, {state}", **line_style(at)}
            axes.plot(sizes, [finite(row[column]) for row in rows], **style)
    decibels.set_title("PSNR, dB")
    energy.set_title("Energy of a frame, mJ")
    from_zero(energy)
    sizes = sorted({number(row["of the preset's"]) for row in data.rows})
    for axes in (decibels, energy):
        axes.set_xscale("log", base=2)
        axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
        axes.minorticks_off()
        axes.set_xlabel("size of a voxel, times the preset's (2 or 0.4, by extent)")
        published(axes, 1, "the paper's", vertical=True)
    legend_above(figure, decibels, columns=3)
    return figure, f"Size of a voxel against quality and energy. From {data.made}"


FIGURES = {
    "error_image": error_image,
    "error_tuning": error_tuning,
    "error_renderers": error_renderers,
    "tuning_curve": tuning_curve,
    "training_curve": training_curve,
    "voxel_size": voxel_size,
}
