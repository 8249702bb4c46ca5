"""The paper's claims (StreamingGS, DAC 2025) beside what its two presets give."""

from __future__ import annotations

import itertools
import math
import textwrap

from matplotlib.axes import Axes

from drawing.figure import (
    COLOURS,
    INK,
    MARKERS,
    Data,
    Made,
    Missing,
    Results,
    bar_style,
    from_zero,
    heat_map,
    legend_above,
    number,
    panels,
    published,
)

MAKER = "results.py reproduction"
PRESETS = ("paper_ideal", "paper_text")
PUBLISHED_SPEED = 2.1  # over GSCore
STEP_CHARACTERS = 16
# Of the paper, over the machine without codebooks and coarse filter: energy 21.5, 27.3, 62.9 times
# less than that of the GPU; speed 22.2, 45.7.
PAPER_SPEED = {"neither": 1.0, "codebooks": 1.0, "both": 45.7 / 22.2}
PAPER_ENERGY = {"neither": 1.0, "codebooks": 27.3 / 21.5, "both": 62.9 / 21.5}


def one_point(data: Data) -> list[dict[str, str]]:
    """Claims with a published number, of each preset at the group and memory where most pass with
    PRESETS[0]: a reproduction is of one machine."""
    rows = [row for row in data.rows if number(row["published"])]
    passes: dict[tuple[str, str], int] = {}
    for row in rows:
        if row["preset"] == PRESETS[0]:
            at = row["group px"], row["GB/s"]
            passes[at] = passes.get(at, 0) + (row["passes"] == "yes")
    if not passes:
        raise Missing(f"{data.made}: no rows of {PRESETS[0]}")
    best = max(passes, key=lambda at: passes[at])
    return [row for row in rows if (row["group px"], row["GB/s"]) == best]


def draw_claims(axes: Axes, rows: list[dict[str, str]]) -> None:
    """Measured over published; the bar is where a claim holds."""
    claims = list(dict.fromkeys(row["claim"] for row in rows))
    for row in rows[: len(claims)]:
        y, said = claims.index(row["claim"]), number(row["published"])
        low, high = (number(row[end]) / said for end in ("least", "most"))
        axes.barh(y, high - low, 0.62, left=low, color=COLOURS[6], edgecolor="none")
    for at, preset in enumerate(PRESETS):
        of = [row for row in rows if row["preset"] == preset]
        x = [number(row["measured"]) / number(row["published"]) for row in of]
        y = [claims.index(row["claim"]) for row in of]
        face = COLOURS[at] if at == 0 else "white"
        style = {"markerfacecolor": face, "markeredgecolor": INK, "linestyle": "none"}
        axes.plot(x, y, MARKERS[at], label=preset, markersize=6, **style)
    axes.axvline(1, color=INK, linewidth=0.6)
    axes.set_yticks(range(len(claims)), claims)
    axes.set_ylim(len(claims) - 0.4, -0.6)
    axes.set_xscale("log")
    axes.set_xticks((0.25, 0.5, 1, 2), ("0.25", "0.5", "1", "2"))
    axes.minorticks_off()
    axes.grid(axis="y", visible=False)
    where = f"groups of {rows[0]['group px']} px, {rows[0]['GB/s']} GB/s"
    axes.set_title(f"Over published, {where}")


def draw_waterfall(axes: Axes, data: Data, order: str) -> None:
    """From the ideal to the text."""
    rows = [row for row in data.where(order=order) if number(row["factor"])]
    values = [number(row["times as fast as GSCore"]) for row in rows]
    names = [rows[0]["step"], *(f"− {row['step']}" for row in rows[1:])]
    axes.plot(range(len(rows)), values, drawstyle="steps-mid", color=COLOURS[0], linewidth=1.6)
    for at, value in enumerate(values):
        axes.annotate(f"{value:.2f}", (at, value), (0, 3), textcoords="offset points", ha="center")
    labels = ["\n".join(textwrap.wrap(name, STEP_CHARACTERS)) for name in names]
    axes.set_xticks(range(len(rows)), labels, fontsize=7, rotation=35, ha="right")
    published(axes, PUBLISHED_SPEED, "published")
    from_zero(axes)
    axes.set_ylim(top=1.15 * max(*values, PUBLISHED_SPEED))
    axes.set_title(f"Times as fast as GSCore, {order}")


def draw_map(axes: Axes, data: Data, preset: str) -> None:
    rows = data.where(preset=preset)
    of = {(row["CFUs"], row["FFUs"]): number(row["times as fast"]) for row in rows}
    cfus, ffus = (sorted({row[each] for row in rows}, key=number) for each in ("CFUs", "FFUs"))
    gains = [[of.get((c, f), math.nan) for c in cfus] for f in ffus]
    heat_map(axes, cfus, ffus, gains)
    axes.set_xlabel("CFUs of an HFU")
    axes.set_ylabel("FFUs of an HFU")
    axes.set_title(f"Times as fast as with one of each, {preset}")


def reproduction(results: Results) -> Made:
    claims = results.table(
        *("reproduction_claims", MAKER),
        ("claim", "published", "least", "most", "preset", "group px", "GB/s", "measured", "passes"),
    )
    waterfall = results.table(
        "reproduction_waterfall", MAKER, ("order", "step", "times as fast as GSCore", "factor")
    )
    units = results.table("reproduction_map", MAKER, ("preset", "CFUs", "FFUs", "times as fast"))
    rows = one_point(claims)
    figure, axes = panels(4, width=5.6, height=3.6)
    draw_claims(axes[0], rows)
    draw_map(axes[1], units, PRESETS[1])
    for panel, order in zip(axes[2:], waterfall.different("order")):
        draw_waterfall(panel, waterfall, order)
    legend_above(figure, axes[0])
    text = "Shaded: where a claim holds. The paper's map says that more CFUs help, more FFUs do not."
    return figure, f"{text} From {claims.made}"


def variants(results: Results) -> Made:
    """Of the first preset of PRESETS and then the other, a group of bars for each scene."""
    gains = {"times as fast": PAPER_SPEED, "times less energy": PAPER_ENERGY}
    data = results.table("reproduction_variants", MAKER, ("scene", "preset", "with", *gains))
    parts = data.different("with")
    width = 0.8 / len(parts)
    figure, grid = panels(4, width=5.6, height=3.0)
    pairs = itertools.product(PRESETS, gains.items())
    for axes, (preset, (column, said)) in zip(grid, pairs):
        scenes = data.different("scene")
        groups = [*scenes, "StreamingGS,\nas stated"]
        for at, part in enumerate(parts):
            rows = [data.where(scene=scene, preset=preset, **{"with": part}) for scene in scenes]
            values = [number(row[column]) if row else 0 for (row,) in rows]
            values.append(said.get(part, 0))
            places = [x + (at - (len(parts) - 1) / 2) * width for x in range(len(groups))]
            axes.bar(places, values, width, label=part, **bar_style(at))
        axes.axvline(len(scenes) - 0.5, color="#626a78", linewidth=0.8)
        axes.set_xticks(range(len(groups)), groups, rotation=35, ha="right", fontsize=7)
        axes.grid(axis="x", visible=False)
        axes.set_title(f"{column.capitalize()}, {preset}")
    legend_above(figure, grid[0], len(parts))
    caption = (
        "Over the machine with neither. StreamingGS states nothing of the coarse filter alone. "
        f"From {data.made}"
    )
    return figure, caption


FIGURES = {"reproduction": reproduction, "variants": variants}
