"""Figures of machines beside each other and the modelled GPU, from the tables of
compare_machines.py."""

from __future__ import annotations

import math
import statistics

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drawing.figure_inputs import Data, Results, number
from drawing.figure_style import COLOURS, INK, bar_style, case_label, legend_above, panels

MAKER = "compare_machines.py"
GPU = "GPU, modelled"  # it has its own memory, and stands beside machines with any
AT_MOST = "frames/s at most, overlapped"

Made = tuple[Figure, str]  # with its caption


def memories(data: Data) -> list[str]:
    return list(dict.fromkeys(row["GB/s"] for row in data.rows if row["machine"] != GPU))


def rates(results: Results) -> Made:
    """A panel for each memory; of a scene's sizes the last, which is the largest by default."""
    columns = ("scene", "size", "GB/s", "machine", "frames/s", AT_MOST)
    data = results.table("compare_machines", MAKER, columns)
    size_of = {row["scene"]: row["size"] for row in data.rows}
    machines = data.different("machine")
    width = max(7.4, max(1.15, 0.155 * len(machines)) * len(size_of) + 1)
    figure, all_axes = panels(len(memories(data)), width=width, height=2.8, across=1)
    bar = 0.86 / len(machines)
    for memory, axes in zip(memories(data), all_axes):
        for number_of, machine in enumerate(machines):
            rows = [
                row
                for row in data.where(machine=machine)
                if row["GB/s"] == memory or machine == GPU
                if row["size"] == size_of[row["scene"]]
            ]
            shift = (number_of - (len(machines) - 1) / 2) * bar
            at = [list(size_of).index(row["scene"]) + shift for row in rows]
            rate = [number(row["frames/s"]) for row in rows]
            own = {row["GB/s"] for row in rows} if machine == GPU else ()
            label = ", ".join([machine, *(f"{gb_s} GB/s" for gb_s in own)])
            axes.bar(at, rate, bar, label=label, **bar_style(number_of))
            most = [number(row[AT_MOST]) for row in rows]
            label = "at most, frames overlapped" if machine == machines[-1] else None
            axes.plot(at, most, "_", markersize=6, markeredgewidth=1.2, color=INK, label=label)
        axes.set_yscale("log")
        least = min(number(row["frames/s"]) for row in data.rows)
        axes.set_ylim(bottom=10 ** math.floor(math.log10(least)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.set_title(f"Frames a second, {memory} GB/s")
        axes.set_xticks(range(len(size_of)), [case_label(*case) for case in size_of.items()])
        axes.set_xlim(-0.6, len(size_of) - 0.4)
        axes.tick_params(axis="x", labelsize=8, length=0)
        axes.grid(axis="x", visible=False)
    legend_above(figure, all_axes[0], columns=5)
    return figure, f"Bars: frames alone, means over the views. From {data.made}"


def mean_mb(rows: list[dict[str, str]]) -> float:
    """Over the scenes of the means over their cases."""
    by_scene: dict[str, list[float]] = {}
    for row in rows:
        by_scene.setdefault(row["scene"], []).append(number(row["value"]))
    return statistics.fmean(map(statistics.fmean, by_scene.values())) if by_scene else 0


def traffic(results: Results) -> Made:
    """With the first memory: what moves hardly depends on it. The GPU moves so much more that it
    has an axis of its own."""
    columns = ("scene", "GB/s", "machine", "part", "value")
    data = results.table("compare_machines_bytes", MAKER, columns)
    first = memories(data)[0]
    machines = [name for name in data.different("machine") if name != GPU]
    groups = [machines, *([[GPU]] if GPU in data.different("machine") else [])]
    rows_of = [len(group) + 1.5 for group in groups]
    height = 0.3 * sum(rows_of) / len(groups) + 0.6
    figure, all_axes = panels(len(groups), width=7.4, height=height, across=1, heights=rows_of)
    style = 0
    for group, axes in zip(groups, all_axes):
        left = [0.0] * len(group)
        for part in data.different("part"):
            rows = [row for row in data.where(part=part) if row["GB/s"] == first or group == [GPU]]
            of = [mean_mb([r for r in rows if r["machine"] == machine]) for machine in group]
            if any(of):
                axes.barh(group, of, left=left, label=part.replace("_", " "), **bar_style(style))
                left = [a + b for a, b in zip(left, of)]
                style += 1
        axes.set_xlim(0, 1.03 * max(left))
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        axes.legend(loc="upper left", bbox_to_anchor=(1, 1.05), fontsize=8)
    all_axes[0].set_title(f"MB a frame on the bus, {first} GB/s")
    if len(groups) > 1:
        all_axes[1].set_title("MB a frame that its kernels ask for")
    what = "Bytes of a frame by region of DRAM, of the GPU by kind: means over the scenes."
    return figure, f"{what} From {data.made}"


def span(text: str) -> tuple[float, float]:
    low, _, high = text.partition(" .. ")
    return float(low), float(high)


def draw_ratios(axes: Axes, rows: list[dict[str, str]], columns: tuple[str, ...]) -> None:
    """columns: of the mean, the range over single views, what is published, and the bound."""
    what, of_views, said, bound = columns
    faces = dict(zip(dict.fromkeys(row["GB/s"] for row in rows), (COLOURS[4], "white")))
    for y, row in enumerate(rows):
        first = y == 0
        face = faces.get(row["GB/s"], COLOURS[6])
        label = "mean over the scenes, frames alone" if first else None
        axes.barh(y, number(row[what]), 0.7, color=face, edgecolor=INK, linewidth=0.5, label=label)
        label = "least to most of single views" if first else None
        axes.plot(span(row[of_views]), (y, y), color=INK, linewidth=0.9, label=label)
        if bound:
            label = "ratio of the bounds, frames overlapped" if first else None
            style = {"markersize": 9, "markeredgewidth": 2.2, "color": COLOURS[3]}
            axes.plot(number(row[bound]), y, "|", label=label, **style)
        published = number(row[said].removesuffix(" derived"))
        if published is not None:
            face = INK if row[said].endswith("derived") else "white"
            axes.plot(published, y, "D", markersize=5, markeredgecolor=INK, color=face)
    axes.axvline(1, color=INK, linewidth=0.6)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)


def ratios(results: Results) -> Made:
    """Over all sizes: over the GPU, and over tile-centric machines."""
    speed = ("times as fast", "of views", "published speed", "both overlapped")
    energy = ("times less energy", "of views, energy", "published energy", "")
    columns = ("GB/s", "sizes", "machine", "than", *speed, *energy[:3])
    data = results.table("compare_machines_ratios", MAKER, columns)
    every = data.where(sizes="all")
    over_gpu = [row for row in every if row["than"] == GPU]
    groups = [rows for rows in (over_gpu, [r for r in every if r["than"] != GPU]) if rows]
    rows_of = [len(rows) + 2 for rows in groups]
    height = 0.24 * sum(rows_of) / len(groups) + 0.4
    figure, all_axes = panels(2 * len(groups), width=5, height=height, heights=rows_of)
    for rows, left, right in zip(groups, all_axes[::2], all_axes[1::2]):
        than_gpu = rows is over_gpu
        names = [
            f"{row['machine']}{'' if than_gpu else ' / ' + row['than']}, {row['GB/s']}"
            for row in rows
        ]
        draw_ratios(left, rows, speed)
        draw_ratios(right, rows, energy)
        left.set_yticks(range(len(names)), names, fontsize=8)
        right.set_yticks([])
        left.set_title("Times as fast" + (" as the modelled GPU" if than_gpu else ""))
        right.set_title("Times less energy" + (" than the modelled GPU" if than_gpu else ""))
    legend_above(figure, all_axes[0])
    return figure, (
        "Behind each name its GB/s. Diamond: published, black where derived from published ratios. "
        "The GPU's time is modelled, its joules are watts times that time. Of exact / gscore the "
        f"precisions differ. From {data.made}"
    )


FIGURES = {
    "compare_machines_rates": rates,
    "compare_machines_traffic": traffic,
    "compare_machines_ratios": ratios,
}
