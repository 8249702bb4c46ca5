"""Errors of pictures against time, bytes and energy: of machines, of renderers in software, of
tuning and training as they go, of sizes of voxels."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from drawing.figure import (
    COLOURS,
    INK,
    LINES,
    MARKERS,
    ON_PAPER,
    Data,
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
NAME_OFFSETS = ((4, -9), (-1, 6), (-1, 15), (4, -18), (-1, 24), (4, -27), (-60, -9))  # points
HIGHEST = 100  # dB; nearer pictures are drawn there, equal ones above
NAMED_APART = 3  # dB better than the machine before
COSTS = {"ms": "frame time, ms", "MB": "DRAM traffic, MB", "mJ": "energy, mJ"}
SCRIPT = "results.py error_against_time"
ORDERS = {"exact": "exact order", "paper": "paper order", "tiles": "tile-centric"}
# Colour and face of a marker say the order, its shape what was moved.
ORDER_COLOURS = {"exact": COLOURS[0], "paper": COLOURS[3], "tiles": COLOURS[1]}
ORDER_FACES = {"exact": "full", "paper": "none", "tiles": "full"}
KNOBS = {
    "as the preset": ("*", "as the preset"),
    "group px": ("s", "group"),
    "chunk": ("^", "chunk"),
    "voxel": ("^", "chunk, voxel"),
    "merge": ("v", "merge buffer"),
    "rays": ("v", "merge buffer, rays"),
    "voxels cut": ("v", "merge buffer, rays"),
    "encoding": ("D", "encoding"),
    "precision": ("o", "precision"),
    "finishing": ("X", "finishing off"),
    "pixels": ("P", "8-bit pixels"),
    "combined": ("<", "combined"),
    "tuning": (">", "tuned"),
}
# Of one marker, in the words of both orders.
KNOB_NAMES = {"^": "chunk, voxel", "v": "merge buffer, rays"}
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


def draw_machines(axes: Axes, rows: Sequence[dict[str, str]], cost: str, value) -> None:
    """A marker for each machine; value: of a row, upwards."""
    for row in rows:
        colour = ORDER_COLOURS[row["order"]]
        axes.plot(
            number(row[cost]),
            value(row),
            marker=KNOBS[row["moved"]][0],
            markersize=9 if row["moved"] == "as the preset" else 5.5,
            markerfacecolor=colour if ORDER_FACES[row["order"]] == "full" else "white",
            markeredgecolor=colour,
            linestyle="none",
            zorder=3,
        )
    axes.set_xscale("log")
    plain_logarithmic(axes.xaxis)


def name_of(row: dict[str, str]) -> str:
    words = row["to"] if row["moved"] == "combined" else f"{row['moved']} {row['to']}"
    return words.strip().replace("group px", "group")


def draw_front(axes: Axes, rows: Sequence[dict[str, str]], cost: str) -> None:
    """A line along what no cheaper machine reaches, and the names of these. The limits of the axes
    are set."""
    points = {(number(row[cost]), quality(row["PSNR dB"])): name_of(row) for row in rows}
    line = front(list(points))
    axes.step(*zip(*line), where="post", color="#626a78", linewidth=1, zorder=1)
    named = [p for at, p in enumerate(line) if not at or p[1] - line[at - 1][1] > NAMED_APART]
    taken: list[Bbox] = []
    for point in named:
        name_beside(axes, points[point], point, taken)


def name_beside(axes: Axes, name: str, point: tuple[float, float], taken: list[Bbox]) -> None:
    """At the first place around the point where no other name stands."""
    for offset in NAME_OFFSETS:
        text = axes.annotate(name, point, xytext=offset, textcoords="offset points", fontsize=6.5,
                             bbox=ON_PAPER, zorder=2)  # fmt: skip
        box = text.get_window_extent()
        if not any(box.overlaps(other) for other in taken) or offset == NAME_OFFSETS[-1]:
            taken.append(box)
            return
        text.remove()


def legend_of_machines(figure: Figure, axes: Axes) -> None:
    for order, label in ORDERS.items():
        face = ORDER_COLOURS[order] if ORDER_FACES[order] == "full" else "white"
        style = {"markerfacecolor": face, "markeredgecolor": ORDER_COLOURS[order]}
        axes.plot([], [], marker="o", linestyle="none", label=label, **style)
    for marker in dict.fromkeys(marker for marker, _ in KNOBS.values()):
        names = [name for of, name in KNOBS.values() if of == marker]
        label = KNOB_NAMES.get(marker, names[0])
        axes.plot([], [], marker=marker, linestyle="none", color=INK, fillstyle="none", label=label)
    legend_above(figure, axes, columns=7)


def image_table(results: Results) -> Data:
    columns = ("scene", "order", "moved", "to", "PSNR dB", "SSIM", "largest", "missed")
    return results.table("error_image", SCRIPT, (*columns, "misordered", *COSTS))


def error_image(results: Results) -> Made:
    """A row of diagrams for each scene: PSNR against time, bytes and energy."""
    data = image_table(results)
    scenes = data.different("scene")
    figure, flat = panels(3 * len(scenes), across=3, width=3.9, height=2.7)
    for at, axes in enumerate(flat):
        rows, cost = data.where(scene=scenes[at // 3]), list(COSTS)[at % 3]
        draw_machines(axes, rows, cost, lambda row: quality(row["PSNR dB"]))
        axes.set(xlabel=COSTS[cost], ylim=(None, quality(EQUAL) + 8))
        draw_front(axes, rows, cost)
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
        axes.set_title(f"{scenes[at // 3]}: PSNR, dB" if cost == "ms" else "")
    legend_of_machines(figure, flat[0])
    return figure, (
        "Pictures of machines against what a frame takes; full: exact order and tile-centric, "
        "open: paper order; the line: what no cheaper machine reaches; above "
        f"{HIGHEST} dB at {HIGHEST}. From {data.made}"
    )


def error_image_kinds(results: Results) -> Made:
    """Kinds of error against frame time, a row of diagrams for each scene."""
    data = image_table(results)
    scenes = data.different("scene")
    kinds = {
        "1 - SSIM": lambda row: 1 - number(row["SSIM"]),
        "largest error": lambda row: number(row["largest"]),
        "missed, (group, splat) pairs": lambda row: number(row["missed"]),
        "misordered, share of blends": lambda row: number(row["misordered"]),
    }
    figure, flat = panels(len(kinds) * len(scenes), across=len(kinds), width=3.2, height=2.4)
    for at, axes in enumerate(flat):
        title, value = list(kinds.items())[at % len(kinds)]
        rows = data.where(scene=scenes[at // len(kinds)])
        draw_machines(axes, rows, "ms", value)
        smallest = min((v for row in rows if (v := value(row)) > 0), default=1)
        smallest = 10 ** math.floor(math.log10(smallest))
        axes.set_yscale("symlog", linthresh=smallest, linscale=0.8)
        axes.set_ylim(-0.3 * smallest, 3 * max(map(value, rows)) or 1)
        axes.set_title(f"{scenes[at // len(kinds)]}: {title}", fontsize=8.5)
        axes.set_xlabel(COSTS["ms"])
    legend_of_machines(figure, flat[0])
    return figure, (
        "The same machines by other errors, logarithmic above the smallest one, 0 at the bottom. "
        f"From {data.made}"
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
    "error_image_kinds": error_image_kinds,
    "error_tuning": error_tuning,
    "error_renderers": error_renderers,
    "tuning_curve": tuning_curve,
    "training_curve": training_curve,
    "voxel_size": voxel_size,
}
