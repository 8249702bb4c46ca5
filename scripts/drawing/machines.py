"""Machines beside each other and the modelled GPU; the paper's figures of them (StreamingGS, DAC
2025) from our measurements, with its numbers where it has any: quoted as dotted lines and text, all
else measured."""

from __future__ import annotations

import math
import re
import statistics

from matplotlib.axes import Axes

from drawing.figure import (
    COLOURS,
    INK,
    MARKERS,
    ON_PAPER,
    Data,
    Made,
    Missing,
    Results,
    bar_style,
    case_label,
    from_zero,
    legend_above,
    line_style,
    note,
    number,
    panels,
    published,
)

MAKER = "results.py compare_machines"
GPU = "GPU, modelled"  # it has its own memory, and stands beside machines with any
AT_MOST = "frames/s at most, overlapped"
WISHED_FPS = 90
# What the ratios show: pairs of one precision, and the one that is published.
PAIRS = (
    ("exact_fast", "gscore_lossless_boxes"),
    ("exact", "gscore_lossless_boxes"),
    ("exact_fp16", "gscore_boxes"),
    ("paper_text", "gscore"),
)
CIRCLES = {
    "marker": "o",
    "markersize": 4.5,
    "markerfacecolor": "white",
    "markeredgecolor": INK,
    "linestyle": "none",
}
LPDDR3_GB_S, ORIN_NX_GB_S = 25.6, 102.4
GPU_FPS = (2, 9)  # of the paper


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
    columns = ("scene", "GB/s", "machine", "region", "value")
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
        for part in data.different("region"):
            rows = data.where(region=part)
            rows = [row for row in rows if row["GB/s"] == first or group == [GPU]]
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


def draw_ratios(axes: Axes, rows: list[dict[str, str]], columns: tuple[str, ...]) -> None:
    """columns: of the mean, what is published, and the bound."""
    what, said, bound = columns
    faces = dict(zip(dict.fromkeys(row["GB/s"] for row in rows), (COLOURS[4], "white")))
    for y, row in enumerate(rows):
        first = y == 0
        face = faces.get(row["GB/s"], COLOURS[6])
        label = "mean over the scenes, frames alone" if first else None
        axes.barh(y, number(row[what]), 0.7, color=face, edgecolor=INK, linewidth=0.5, label=label)
        label = "least to most of single views" if first else None
        ends = [number(row[f"{what}, {end}"]) for end in ("least", "most")]
        axes.plot(ends, (y, y), color=INK, linewidth=0.9, label=label)
        if bound:
            label = "ratio of the bounds, frames overlapped" if first else None
            style = {"markersize": 9, "markeredgewidth": 2.2, "color": COLOURS[3]}
            axes.plot(number(row[bound]), y, "|", label=label, **style)
        if (published := number(row[said])) is not None:
            axes.plot(published, y, "D", markersize=5, markeredgecolor=INK, color="white")
    axes.axvline(1, color=INK, linewidth=0.6)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)


def ratios(results: Results) -> Made:
    """Over all sizes, each machine over the tile-centric one that it is held against."""
    speed = ("times as fast", "published speed", "both overlapped")
    energy = ("times less energy", "published energy", "")
    columns = ("GB/s", "sizes", "machine", "than", *speed, *energy[:2])
    data = results.table("compare_machines_ratios", MAKER, columns)
    every = [row for row in data.where(sizes="all") if (row["machine"], row["than"]) in PAIRS]
    if not every:
        raise Missing(f"{data.made}: no rows of {', '.join(map(' / '.join, PAIRS))}")
    rows = sorted(every, key=lambda row: PAIRS.index((row["machine"], row["than"])))
    figure, (left, right) = panels(2, width=4.8, height=0.32 * len(rows) + 1)
    draw_ratios(left, rows, speed)
    draw_ratios(right, rows, energy)
    names = [f"{row['machine']} / {row['than']}, {row['GB/s']}" for row in rows]
    left.set_yticks(range(len(names)), names)
    right.set_yticks([])
    left.set_title("Speed-up")
    right.set_title("Energy, baseline over machine")
    legend_above(figure, left)
    return figure, (f"Behind each name its GB/s. Diamond: published. From {data.made}")


def cases_of(data: Data) -> list[tuple[str, str]]:
    """(scene, size) each."""
    return list(dict.fromkeys((row["scene"], row["size"]) for row in data.rows))


def with_memory(data: Data, row: dict[str, str]) -> str:
    """The machine of a row, with its memory where it has several."""
    machine = row["machine"]
    several = len({r["GB/s"] for r in data.where(machine=machine)}) > 1
    return f"{machine}, {row['GB/s']} GB/s" if several else machine


def grouped_bars(axes, data: Data, value) -> None:
    """A group of bars for each scene and size, one for each machine and memory; room for a remark
    behind the last."""
    cases = cases_of(data)
    machines: dict[str, dict[tuple[str, str], float]] = {}
    for row in data.rows:
        machines.setdefault(with_memory(data, row), {})[row["scene"], row["size"]] = value(row)
    width = 0.8 / len(machines)
    for at, (machine, found) in enumerate(machines.items()):
        axes.bar(
            [x + (at - (len(machines) - 1) / 2) * width for x in range(len(cases))],
            [found.get(case, 0) for case in cases],
            width,
            label=machine,
            **bar_style(at),
        )
    axes.set_xticks(range(len(cases)), [case_label(*case) for case in cases], fontsize=8)
    axes.set_xlim(-0.6, 1.1 * len(cases) - 0.4)
    axes.grid(axis="x", visible=False)


def characterisation(results: Results) -> Made:
    demand = f"GB/s at {WISHED_FPS} frames/s"
    data = results.table(
        "characterisation",
        MAKER,
        ("scene", "size", "machine", "GB/s", "frames/s", demand),
    )
    figure, (rate, bandwidth) = panels(2, width=max(7.4, 0.8 * len(cases_of(data)) + 1.4), across=1)
    grouped_bars(rate, data, lambda row: number(row["frames/s"]) or 0)
    rate.set_yscale("log")
    rate.set_title("Frames a second")
    low, high = GPU_FPS
    said = f"the paper's GPU: {low} to {high}"
    rate.axhspan(low, high, color="#c9ced8", alpha=0.55, zorder=0, label=said)
    rate.set_ylim(bottom=1)
    published(rate, WISHED_FPS, f"{WISHED_FPS} frames/s")
    grouped_bars(bandwidth, data, lambda row: number(row[demand]) or 0)
    bandwidth.set_title(f"GB/s needed for {WISHED_FPS} frames a second")
    most = max(number(row[demand]) or 0 for row in data.rows)
    for gb_s, text in ((LPDDR3_GB_S, "4 x LPDDR3-1600"), (ORIN_NX_GB_S, "Orin NX")):
        if gb_s < 1.6 * most:
            published(bandwidth, gb_s, f"{text}, {gb_s} GB/s")
            bandwidth.set_ylim(top=max(bandwidth.get_ylim()[1], 1.15 * gb_s))
    legend_above(figure, rate)
    return figure, f"Frame rate, and bandwidth at {WISHED_FPS} frames a second. From {data.made}"


def dram_by_stage(results: Results) -> Made:
    """With the first memory: what moves hardly depends on it."""
    parts = ("scene %", "intermediate %", "pixels %")
    data = results.table(
        "characterisation",
        MAKER,
        ("scene", "size", "machine", "GB/s", "MB a frame", *parts),
    )
    first = memories(data)[0]
    rows = [row for row in data.rows if row["GB/s"] == first or row["machine"] == GPU]
    labels = [f"{row['scene']} {row['size']}, {row['machine']}" for row in rows]
    figure, (axes,) = panels(1, width=7.4, height=0.34 * len(labels) + 1.1)
    left = [0.0] * len(labels)
    for at, part in enumerate(parts):
        shares = [number(row[part]) or 0 for row in rows]
        axes.barh(labels, shares, left=left, label=part.removesuffix(" %"), **bar_style(at))
        left = [a + b for a, b in zip(left, shares)]
    for y, row in enumerate(rows):
        moved = f"{number(row['MB a frame']):.1f} MB"
        note(axes, 101, y, moved, va="center", annotation_clip=False)
    axes.set_xlim(0, 100)
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.set_xlabel("% of the bytes of a frame")
    axes.grid(axis="y", visible=False)
    legend_above(figure, axes)
    said = (
        "What is written and read again within a frame is intermediate: of the paper's GPU 85 %. At "
        "2560x1440 Neo has up to 91 % of a GPU's bytes and 69 % of GSCore's for sorting"
    )
    return figure, f"DRAM traffic by stage, {first} GB/s. {said}. From {data.made}"


def group_size(results: Results) -> Made:
    parts = ("DRAM mJ", "SRAM mJ", "logic mJ", "clock and leakage mJ")
    columns = ("preset", "group px", *parts, "bus MB", "mm2")
    data = results.table("energy_groups", "results.py energy", columns)
    presets = data.different("preset")
    figure, axes = panels(len(presets) + 1, width=3.6, across=3)
    most = max(sum(number(row[part]) for part in parts) for row in data.rows)
    for of_preset, preset in zip(axes, presets):
        rows = data.where(preset=preset)
        names, below = [row["group px"] for row in rows], [0.0] * len(rows)
        for at, part in enumerate(parts):
            values = [number(row[part]) for row in rows]
            style = bar_style(at)
            of_preset.bar(names, values, bottom=below, label=part.removesuffix(" mJ"), **style)
            below = [a + b for a, b in zip(below, values)]
        of_preset.set_ylim(0, 1.05 * most)
        of_preset.set_title(f"{preset}: mJ of a frame")
        of_preset.set_xlabel("group, px")
        of_preset.grid(axis="x", visible=False)
    for at, preset in enumerate(presets):
        rows = data.where(preset=preset)
        axes[-1].plot(
            [number(row["mm2"]) for row in rows],
            [number(row["bus MB"]) for row in rows],
            label=preset,
            **line_style(at),
        )
        for row in rows:
            place = number(row["mm2"]), number(row["bus MB"])
            axes[-1].annotate(
                row["group px"], place, xytext=(4, 4), textcoords="offset points", fontsize=7.5
            )
    axes[-1].set_title("MB on the bus against area")
    axes[-1].set_xlabel("area, mm²")
    from_zero(axes[-1])
    axes[-1].legend()
    legend_above(figure, axes[0])
    return figure, f"What the size of a group costs. From {data.made}"


def of_memories(results: Results) -> Made:
    """A panel for each scene, a line for each memory over its channels, a colour for its family.
    Memories without joules are named below."""
    columns = ("memory", "channels", "scene", "frames/s", "mJ")
    table = results.table("compare_memories", "results.py compare_memories", columns)
    unknown = list(dict.fromkeys(row["memory"] for row in table.rows if not row["mJ"]))
    data = Data(tuple(row for row in table.rows if row["memory"] not in unknown), table.made)
    if not data.rows:
        raise Missing(f"{data.made}: no memory whose energy is known")
    figure, all_axes = panels(len(data.different("scene")), width=4.2, height=3.4, across=2)
    members: dict[str, list[str]] = {}
    for memory in data.different("memory"):
        members.setdefault(re.match(r"[a-z]*\d?", memory)[0], []).append(memory)
    for scene, axes in zip(data.different("scene"), all_axes):
        for number_of, family in enumerate(members.values()):
            colour = line_style(number_of)["color"]
            for at, memory in enumerate(family):
                rows = data.where(scene=scene, memory=memory)
                rate, mj = ([number(row[column]) for row in rows] for column in ("frames/s", "mJ"))
                axes.plot(rate, mj, label=memory, **line_style(at) | {"color": colour})
                sizes = [20 * number(row["channels"]) for row in rows]
                axes.scatter(rate, mj, sizes, colour, marker=MARKERS[at], zorder=3)
        axes.set_title(f"{scene}: mJ of a frame")
        axes.set_xlabel("frames a second")
        from_zero(axes)
    legend_above(figure, all_axes[0])
    channels = ", ".join(data.different("channels"))
    said = f"Not drawn, no energy is known: {', '.join(unknown)}. " if unknown else ""
    return figure, f"Larger marks: more channels ({channels}). {said}From {data.made}"


def headline(results: Results) -> Made:
    """A pair of bars for each machine and its baseline: geometric means over the scenes, a circle
    each."""
    pair, columns = "machine / baseline", ("speed-up", "energy, baseline over machine")
    data = results.table("headline_scenes", "results.py headline", (pair, "scene", *columns))
    pairs = data.different(pair)
    figure, (axes,) = panels(1, width=6, height=0.6 * len(pairs) + 0.9)
    for at, column in enumerate(columns):
        places = [y + (at - 0.5) * 0.36 for y in range(len(pairs))]
        single = [[number(row[column]) for row in data.where(**{pair: of})] for of in pairs]
        means = [statistics.geometric_mean(of) for of in single]
        axes.barh(places, means, 0.36, label=column, **bar_style(at))
        for y, of, mean in zip(places, single, means):
            label = "single scenes" if (at, y) == (0, places[0]) else None
            axes.plot(of, [y] * len(of), label=label, **CIRCLES)
            axes.annotate(f"{mean:.2f}", (0.06, y), va="center", fontweight="bold", bbox=ON_PAPER)
    axes.axvline(1, color=INK, linewidth=1.2)
    axes.set_yticks(range(len(pairs)), [of.replace(" / ", "\nover ") for of in pairs])
    axes.set_ylim(len(pairs) - 0.45, -0.55)
    axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("times the baseline, more is better")
    legend_above(figure, axes)
    return figure, f"Bars: geometric means over trained scenes. From {data.made}"


def steps_of_waterfall(data: Data, machine: str) -> dict[str, list[float]]:
    """Middle, least and most mJ by component: the largest first, those that hardly show as one
    line, last all."""
    columns = ("mJ", "least mJ", "most mJ")
    rows = data.where(preset=machine)
    steps = {row["mJ of"].replace("_", " "): [number(row[c]) for c in columns] for row in rows}
    whole = steps.pop("all")
    small = [steps.pop(name) for name, (mj, *_) in list(steps.items()) if mj < 0.01 * whole[0]]
    order = sorted(steps, key=lambda name: -steps[name][0])
    smaller = {f"{len(small)} smaller": [sum(of) for of in zip(*small)]} if small else {}
    return {name: steps[name] for name in order} | smaller | {"all": whole}


def waterfall(results: Results) -> Made:
    """A panel for each machine: its components on top of each other from the left, with what the
    sources allow of each."""
    columns = ("preset", "mJ of", "scene", "mJ", "least mJ", "most mJ")
    data = results.table("frame_waterfall", "results.py power", columns)
    machines = data.different("preset")
    figure, all_axes = panels(len(machines), width=5.2, height=3.4)
    for axes, machine in zip(all_axes, machines):
        steps = steps_of_waterfall(data, machine)
        left = 0.0
        for y, (name, (mj, least, most)) in enumerate(steps.items()):
            whole = name == "all"
            begin = 0.0 if whole else left
            style = bar_style(0 if whole else 1)
            axes.barh(y, mj, 0.66, left=begin, **style)
            ends = [[mj - least], [most - mj]]
            axes.errorbar(begin + mj, y, xerr=ends, color=INK, capsize=2.5, linewidth=1)
            text = f"{mj:.2f} ({least:.2f} .. {most:.2f})"
            axes.annotate(
                text,
                (begin + most, y),
                xytext=(5, 0),
                textcoords="offset points",
                va="center",
                fontsize=7.5,
            )
            left += mj
        axes.set_yticks(range(len(steps)), steps)
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        axes.set_title(f"{machine}: mJ of a frame of {data.rows[0]['scene']}")
    most = max(number(row["most mJ"]) for row in data.rows)
    for axes in all_axes:
        axes.set_xlim(0, 1.42 * most)
    return figure, f"Lines: what the sources allow. From {data.made}"


FIGURES = {
    "headline": headline,
    "waterfall": waterfall,
    "compare_memories": of_memories,
    "compare_machines_rates": rates,
    "compare_machines_traffic": traffic,
    "compare_machines_ratios": ratios,
    "characterisation": characterisation,
    "dram_by_stage": dram_by_stage,
    "group_size": group_size,
}
