"""What explore.py judged, as figures: what was required as a line, machines that were given by name
beside it."""

from __future__ import annotations

import dataclasses
import math
import re

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drawing.figure_inputs import Data, Missing, Results, number
from drawing.figure_style import INK, ON_PAPER, legend_above, line_style, panels, published
from drawing.figures_of_machines import lower_left

# What is drawn across where it is there, and what is drawn up beside what is required.
ACROSS = ("mm2", "area_mm2.total", "sram_bytes", "filter_lanes")
UP = ("cycles", "seconds", "joules", "watts", "dram_bytes", "fps", "psnr_db")
# In which a column is drawn, and how many of its own unit that is.
UNITS = {
    "mm2": ("area, mm²", 1),
    "area_mm2.total": ("area, mm²", 1),
    "cycles": ("M cycles", 1e6),
    "seconds": ("ms", 1e-3),
    "joules": ("mJ", 1e-3),
    "watts": ("W", 1),
    "dram_bytes": ("MB of DRAM traffic", 1e6),
    "sram_bytes": ("KB of SRAM", 1e3),
    "fps": ("frames/s", 1),
}
MORE_IS_BETTER = ("fps", "psnr_db")
EQUAL = "equal"
REQUIRED = re.compile(r"(.+) (>=|<=) (\S+)")
Made = tuple[Figure, str]  # with its caption
Point = tuple[float, float]


def axes_of(data: Data) -> tuple[str, list[str]]:
    """The column across, and those that are drawn over it. Raises Missing."""
    head = list(data.rows[0])
    across = next((name for name in ACROSS if name in head), None)
    required = [name for name in head if REQUIRED.fullmatch(name)]
    ups = required + [name for name in UP if name in head][:1]
    if not across or not ups:
        raise Missing(
            f"columns {', '.join(head)}: expected one of {', '.join(ACROSS)}, and of "
            f"{', '.join(UP)} or something that is required"
        )
    return across, ups


def unit_of(column: str) -> tuple[str, float]:
    return UNITS.get(column, (column, 1))


def point_of(row: dict[str, str], across: str, up: str) -> Point | None:
    """In the units of UNITS. None where it was not drawn to its end."""
    x, y = number(row[across]), number(row[up])
    if x is None or y is None:
        return None
    return x / unit_of(across)[1], y / unit_of(up)[1]


@dataclasses.dataclass(frozen=True)
class Equal:
    """Where pictures without error are drawn: above the highest of all others and of what is
    required."""

    highest: float
    level: float

    def put_into(self, data: Data, up: str) -> Data:
        rows = [
            {**row, up: f"{self.level}"} if number(row[up]) == math.inf else row
            for row in data.rows
        ]
        return dataclasses.replace(data, rows=tuple(rows))

    def draw(self, axes: Axes) -> None:
        """A line with its name in place of a number, and no numbers above the others."""
        low, high = axes.get_ylim()
        ticks = [tick for tick in axes.get_yticks() if low <= tick <= self.highest]
        axes.set_yticks([*ticks, self.level], [*(f"{tick:g}" for tick in ticks), EQUAL])
        axes.set_ylim(low, high)
        axes.axhline(self.level, color=INK, linewidth=0.6, linestyle=":", zorder=1)


def equal_of(data: Data, up: str) -> Equal | None:
    """None where there are no pictures without error."""
    values = [value for row in data.rows if (value := number(row[up])) is not None]
    if math.inf not in values:
        return None
    required = REQUIRED.fullmatch(up)
    others = [value for value in values if math.isfinite(value)]
    others += [float(required[3])] if required else []
    if not others:
        return Equal(-math.inf, 0)
    return Equal(max(others), max(others) + max((max(others) - min(others)) / 4, 1))


def draw_points(axes: Axes, data: Data, across: str, up: str) -> None:
    """A marker for each unit that binds, filled on the front."""
    for at, binding in enumerate(data.different("binding")):
        style = line_style(at) | {"linestyle": "none"}
        label: str | None = f"{binding} binds"
        for best, face in (("yes", style["color"]), ("", "white")):
            rows = data.where(binding=binding, front=best)
            points = [p for row in rows if (p := point_of(row, across, up))]
            if points:
                axes.plot(*zip(*points), label=label, **style, markerfacecolor=face)
                label = None


def draw_required(axes: Axes, name: str) -> None:
    """The bound as a line, and hatched what does not hold."""
    _, relation, bound = REQUIRED.fullmatch(name).groups()
    low, high = axes.get_ylim()
    value = float(bound)
    room = 0.08 * (high - low)
    low, high = min(low, value - room), max(high, value + room)
    lost = (low, value) if relation == ">=" else (value, high)
    axes.axhspan(*lost, facecolor="#f1f2f5", edgecolor="#c9ced8", hatch="///", lw=0, zorder=0)
    published(axes, value, f"required: {name}")
    axes.set_ylim(low, high)


def draw_front(axes: Axes, data: Data, across: str, up: str) -> None:
    """Of these two columns, of what holds."""
    held = [row for row in data.rows if row.get("holds", "") in ("yes", "")]
    if points := [p for row in held if (p := point_of(row, across, up))]:
        line = lower_left(points)
        axes.step(*zip(*line), where="post", color="#626a78", linewidth=1, zorder=1)


def draw_beside(axes: Axes, data: Data, across: str, up: str) -> None:
    """A ring around each machine that was given, and its name."""
    middle = sum(axes.get_xlim()) / 2
    for row in data.rows:
        point = point_of(row, across, up)
        if not row.get("beside") or not point:
            continue
        axes.plot(*point, "o", markersize=13, markerfacecolor="none", markeredgecolor=INK)
        right = point[0] <= middle
        axes.annotate(
            row["beside"],
            point,
            xytext=(11 if right else -11, 0),
            textcoords="offset points",
            ha="left" if right else "right",
            va="center",
            bbox=ON_PAPER,
        )


def exploration(results: Results) -> Made:
    """Of explore.csv: area against what was required, and against cycles or what else was asked
    for."""
    everything = results.table("explore", "explore.py", ("front", "binding"))
    across, ups = axes_of(everything)
    wide = len(ups) == 1
    figure, all_axes = panels(len(ups), width=6 if wide else 4.6, height=4 if wide else 3.6)
    for axes, up in zip(all_axes, ups):
        equal = equal_of(everything, up)
        data = equal.put_into(everything, up) if equal else everything
        draw_points(axes, data, across, up)
        axes.margins(0.08)
        required = REQUIRED.fullmatch(up)
        if required:
            draw_required(axes, up)
        elif up not in MORE_IS_BETTER:
            draw_front(axes, data, across, up)
        axes.set_xlabel(unit_of(across)[0])
        measured = required[1] if required else unit_of(up)[0]
        axes.set_title(f"{measured} against {unit_of(across)[0].partition(',')[0]}")
        if equal:
            equal.draw(axes)
        draw_beside(axes, data, across, up)
    legend_above(figure, all_axes[0], columns=3 if wide else 5)
    held = "; hatched: what does not hold" if any(map(REQUIRED.fullmatch, ups)) else ""
    given = any(row.get("beside") for row in everything.rows)
    rings = "; in rings: what was given beside" if given else ""
    return figure, (
        "What was explored: filled where no other point that holds is better in everything that "
        f"was asked for{held}{rings}. From {everything.made}"
    )


FIGURES = {"exploration": exploration}
