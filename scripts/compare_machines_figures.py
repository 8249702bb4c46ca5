#!/usr/bin/python3
"""Figures of what compare_machines.py wrote into a folder, as SVG beside the tables:

  compare_machines_rates.svg     frames a second by scene and machine
  compare_machines_traffic.svg   bytes of a frame by region of DRAM and machine
  compare_machines_ratios.svg    times as fast and times less energy, with the range of single views

Drawn with Debian's python3-matplotlib, for Debian's own interpreter, from the .csv alone.
"""

from __future__ import annotations

import csv
import pathlib
import statistics
import sys
from collections.abc import Callable, Sequence

try:
    import matplotlib
except ImportError:
    sys.exit(f"{sys.argv[0]}: matplotlib is missing; scripts/tools.sh installs python3-matplotlib")
matplotlib.use("svg")
# Equal files for equal tables, and text that stays text.
matplotlib.rcParams.update({"svg.hashsalt": "", "svg.fonttype": "none", "font.size": 8})
from matplotlib import pyplot  # noqa: E402 (the backend goes first)

Table = list[dict[str, str]]

# Neighbours differ in grey and in hatching, as they must in print.
FILLS = [
    ("0.95", ""), ("0.35", ""), ("0.75", "///"), ("0.55", ""), ("0.9", "xxx"), ("0.15", ""),
    ("0.85", "..."), ("0.65", ""), ("0.45", "---"), ("1.0", "+++"), ("0.25", "///"),
]  # fmt: skip
GPU = "GPU, modelled"


def read(folder: pathlib.Path, name: str) -> Table:
    path = folder / f"{name}.csv"
    if not path.exists():
        sys.exit(f"{sys.argv[0]}: {path}: not there; scripts/compare_machines.py writes it")
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def distinct(rows: Table, column: str) -> list[str]:
    return list(dict.fromkeys(row[column] for row in rows))


def fill(number: int) -> dict:
    colour, hatch = FILLS[number % len(FILLS)]
    return {"facecolor": colour, "hatch": hatch, "edgecolor": "black", "linewidth": 0.4}


def save(figure: pyplot.Figure, folder: pathlib.Path, name: str) -> None:
    """Whole or not at all."""
    part = folder / f"{name}.svg.part"
    figure.savefig(part, format="svg", bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)
    part.replace(folder / f"{name}.svg")


def rates(folder: pathlib.Path) -> None:
    """A panel for each memory; of a scene's sizes the largest. The GPU has its own memory, and
    stands in each panel."""
    table = read(folder, "compare_machines")
    memories = distinct([row for row in table if row["machine"] != GPU], "GB/s")
    cases = {row["scene"]: row["size"] for row in table}  # the last one
    machines = distinct(table, "machine")
    figure, panels = pyplot.subplots(
        len(memories), squeeze=False, sharex=True,
        figsize=(max(10, 1.5 * len(cases)), 2.6 * len(memories)),
    )  # fmt: skip
    width = 0.9 / len(machines)
    for memory, panel in zip(memories, panels[:, 0]):
        for number, machine in enumerate(machines):
            of = {
                row["scene"]: float(row["frames/s"])
                for row in table
                if row["machine"] == machine
                and (machine == GPU or row["GB/s"] == memory)
                and row["size"] == cases[row["scene"]]
            }
            at = [i + (number - (len(machines) - 1) / 2) * width for i in range(len(cases))]
            panel.bar(at, [of.get(s, 0) for s in cases], width, label=machine, **fill(number))
        panel.set_yscale("log")
        panel.set_ylabel(f"frames a second\nat {memory} GB/s")
        panel.grid(axis="y", linewidth=0.3)
        panel.set_axisbelow(True)
    names = [f"{scene}\n{size}" for scene, size in cases.items()]
    panels[-1, 0].set_xticks(range(len(cases)), names)
    panels[0, 0].legend(ncols=6, loc="lower center", bbox_to_anchor=(0.5, 1), frameon=False)
    save(figure, folder, "compare_machines_rates")


def mean_mb(table: Table, machine: str, region: str) -> float:
    """Over the scenes of the means over their cases."""
    by_scene: dict[str, list[float]] = {}
    for row in table:
        if row["machine"] == machine and row["part"] == region:
            by_scene.setdefault(row["scene"], []).append(float(row["value"]))
    return statistics.fmean(map(statistics.fmean, by_scene.values())) if by_scene else 0


def traffic(folder: pathlib.Path) -> None:
    """With the first memory: what moves hardly depends on it. The GPU moves so much more that it
    has an axis of its own."""
    table = read(folder, "compare_machines_bytes")
    first = next(row["GB/s"] for row in table if row["machine"] != GPU)
    table = [row for row in table if row["machine"] == GPU or row["GB/s"] == first]
    machines = [name for name in distinct(table, "machine") if name != GPU][::-1]
    groups = [machines, *([[GPU]] if GPU in distinct(table, "machine") else [])]
    figure, panels = pyplot.subplots(
        len(groups), figsize=(8, 0.32 * len(machines) + 1.6), squeeze=False,
        height_ratios=[max(2, len(group)) for group in groups],
    )  # fmt: skip
    for group, panel in zip(groups, panels[:, 0]):
        number = 0
        own = [row for row in table if row["machine"] in group]
        left = [0.0] * len(group)
        for region in distinct(own, "part"):
            of = [mean_mb(table, machine, region) for machine in group]
            if not any(of):
                continue
            panel.barh(group, of, left=left, label=region.replace("_", " "), **fill(number))
            left = [a + b for a, b in zip(left, of)]
            number += 1
        panel.set_xlim(0)
        panel.legend(loc="upper left", bbox_to_anchor=(1, 1.05), frameon=False)
    panels[0, 0].set_title(f"MB a frame, mean over the scenes, {first} GB/s", fontsize=8)
    panels[-1, 0].set_xlabel("MB; on the bus, of the GPU as its kernels ask for them")
    figure.subplots_adjust(hspace=0.35)
    save(figure, folder, "compare_machines_traffic")


def ratios(folder: pathlib.Path) -> None:
    """A row of panels for each machine that others are held against: speed, energy."""
    table = read(folder, "compare_machines_ratios")
    others = distinct(table, "than")
    memories = distinct(table, "GB/s")
    counts = [len([row for row in table if row["than"] == other]) for other in others]
    figure, panels = pyplot.subplots(
        len(others), 2, squeeze=False, figsize=(10, 0.2 * sum(counts) + 0.8 * len(others)),
        height_ratios=[count + 1 for count in counts], layout="constrained",
    )  # fmt: skip
    for other, pair in zip(others, panels):
        rows = [row for row in table if row["than"] == other][::-1]
        names = [f"{row['machine']}, {row['GB/s']} GB/s" for row in rows]
        of_panel = (("times as fast", "as", ""), ("times less energy", "than", " "))
        for panel, (what, than, blank) in zip(pair, of_panel):
            mean = [float(row[what]) for row in rows]
            below = [m - float(row["least" + blank]) for m, row in zip(mean, rows)]
            above = [float(row["most" + blank]) - m for m, row in zip(mean, rows)]
            fills = [fill(7 if memories.index(row["GB/s"]) % 2 else 0) for row in rows]
            for at, (of, style) in enumerate(zip(mean, fills)):
                panel.barh(at, of, 0.7, **style)
            # A mean of ratios of means may lie beyond what single views have.
            span = [[max(0, x) for x in below], [max(0, x) for x in above]]
            panel.errorbar(mean, range(len(mean)), xerr=span, fmt="none", ecolor="black",
                           elinewidth=0.8, capsize=2)  # fmt: skip
            panel.set_yticks(range(len(names)), names if panel is pair[0] else [""] * len(names))
            panel.set_title(f"{what} {than} {other}", fontsize=8)
            published = [row["published" + blank].removeprefix("about ") for row in rows]
            for at, text in enumerate(published):
                if text:
                    panel.plot(float(text), at, marker="D", markersize=4, color="white",
                               markeredgecolor="black")  # fmt: skip
            panel.axvline(1, color="black", linewidth=0.5)
    figure.supxlabel("bar: geometric mean over the scenes; line: single views; diamond: published",
                     fontsize=8)  # fmt: skip
    save(figure, folder, "compare_machines_ratios")


FIGURES: Sequence[Callable[[pathlib.Path], None]] = (rates, traffic, ratios)


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(f"usage: {sys.argv[0]} FOLDER\n\n{__doc__}")
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    for figure in FIGURES:
        figure(pathlib.Path(sys.argv[1]))


if __name__ == "__main__":
    main()
