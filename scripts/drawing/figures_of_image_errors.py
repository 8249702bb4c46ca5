"""Errors of pictures that machines draw against time, bytes and energy of a frame."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from drawing.figure_inputs import Data, Results, number
from drawing.figure_style import COLOURS, INK, ON_PAPER, legend_above, panels, plain_logarithmic

Made = tuple[Figure, str]  # with its caption
EQUAL = "equal"
NAME_OFFSETS = ((4, -9), (-1, 6), (-1, 15), (4, -18), (-1, 24), (4, -27), (-60, -9))  # points
HIGHEST = 100  # dB; nearer pictures are drawn there, equal ones above
NAMED_APART = 3  # dB better than the machine before
COSTS = {"ms": "frame time, ms", "MB": "DRAM traffic, MB", "mJ": "energy, mJ"}
SCRIPT = "error_against_time.py"
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
        "Pictures of machines against what a frame takes; full: exact order and tile-centric, open: "
        f"paper order; the line: what no cheaper machine reaches; above {HIGHEST} dB at {HIGHEST}. From {data.made}"
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


FIGURES = {"error_image": error_image, "error_image_kinds": error_image_kinds}
