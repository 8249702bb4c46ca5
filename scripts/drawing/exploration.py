"""What explore.py judged: what was required as a line, machines that were given by name beside it;
and what machines of one area are worth."""

from __future__ import annotations

import dataclasses
import math
import statistics

from matplotlib.axes import Axes

from drawing.figure import (
    INK,
    ON_PAPER,
    Data,
    Made,
    Missing,
    Results,
    bar_style,
    from_zero,
    heat_map,
    legend_above,
    line_style,
    number,
    panels,
    published,
)
from tables import REQUIRED, measure_of

# What is drawn across where it is there, and what is drawn up beside what is required.
ACROSS = ("mm2", "mm2_high", "mm2_with_phy", "area_mm2.total", "sram_bytes", "filter_lanes")
UP = ("cycles", "seconds", "joules", "joules_mean", "watts", "dram_bytes", "fps", "psnr_db")
# In which a column is drawn, and how many of its own unit that is.
UNITS = {
    "mm2": ("area, mm²", 1),
    "mm2_high": ("area at the upper end of its band, mm²", 1),
    "mm2_with_phy": ("area with the memory's PHY and controller, mm²", 1),
    "area_mm2.total": ("area, mm²", 1),
    "cycles": ("M cycles", 1e6),
    "seconds": ("ms", 1e-3),
    "joules": ("mJ", 1e-3),
    "joules_mean": ("mJ, mean over the views", 1e-3),
    "watts": ("W", 1),
    "dram_bytes": ("MB of DRAM traffic", 1e6),
    "sram_bytes": ("KB of SRAM", 1e3),
    "fps": ("frames/s", 1),
}
MORE_IS_BETTER = ("fps", "psnr_db")
EQUAL = "equal"

Point = tuple[float, float]


def lower_left(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Those with less of the second than any with less of the first, by the first."""
    front: list[tuple[float, float]] = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def axes_of(data: Data) -> tuple[str, list[str]]:
    """The column across, and those that are drawn over it: what is required before all else.
    Raises Missing."""
    head = {column: measure_of(column) for column in data.rows[0]}
    bounds = [column for column in head if REQUIRED.fullmatch(column)]
    machine = [c for name in ACROSS for c in (*bounds, *head) if head[c] == name]
    across = next(iter(machine or bounds[1:]), None)
    required = [c for c in bounds if c != across]
    drawn = {head[c] for c in (*required, across) if c}
    others = [c for name in UP for c, of in head.items() if of == name and of not in drawn]
    ups = required + others[:1]
    if not across or not ups:
        raise Missing(
            f"columns {', '.join(head)}: expected one of {', '.join(ACROSS)}, and of "
            f"{', '.join(UP)} or something that is required"
        )
    return across, ups


def unit_of(column: str) -> tuple[str, float]:
    """What is required stands in its own unit, as its bound does."""
    if REQUIRED.fullmatch(column) and measure_of(column) not in ACROSS:
        return column, 1
    return UNITS.get(measure_of(column), (column, 1))


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


LOST = {"facecolor": "#f1f2f5", "edgecolor": "#c9ced8", "hatch": "///", "lw": 0, "zorder": 0}


def reach(name: str, ends: tuple[float, float]) -> tuple[float, Point, Point]:
    """The bound; the ends of the axis with room for it; and between what it does not hold."""
    _, relation, bound = REQUIRED.fullmatch(name).groups()
    value = float(bound) / unit_of(name)[1]
    room = 0.08 * (ends[1] - ends[0])
    low, high = min(ends[0], value - room), max(ends[1], value + room)
    return value, (low, high), ((low, value) if relation == ">=" else (value, high))


def draw_required(axes: Axes, name: str) -> None:
    """The bound as a line, and hatched what does not hold."""
    value, ends, lost = reach(name, axes.get_ylim())
    axes.axhspan(*lost, **LOST)
    published(axes, value, f"required: {name}")
    axes.set_ylim(ends)


def draw_required_across(axes: Axes, name: str) -> None:
    value, ends, lost = reach(name, axes.get_xlim())
    axes.axvspan(*lost, **LOST)
    published(axes, value, f"required: {name}", vertical=True)
    axes.set_xlim(ends)


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
    if not any(point_of(row, across, up) for row in everything.rows for up in ups):
        raise Missing(f"{results.tables / 'explore.csv'}: no configuration was drawn")
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
        if REQUIRED.fullmatch(across):
            draw_required_across(axes, across)
        axes.set_xlabel(unit_of(across)[0])
        measured = required[1] if required else unit_of(up)[0]
        axes.set_title(f"{measured} against {unit_of(across)[0].partition(',')[0]}")
        if equal:
            equal.draw(axes)
        draw_beside(axes, data, across, up)
    legend_above(figure, all_axes[0], columns=3 if wide else 5)
    held = "; hatched: what does not hold" if any(map(REQUIRED.fullmatch, (across, *ups))) else ""
    given = any(row.get("beside") for row in everything.rows)
    rings = "; in rings: what was given beside" if given else ""
    return figure, (
        "What was explored: filled where no other point that holds is better in everything that "
        f"was asked for{held}{rings}. From {everything.made}"
    )


def filter_units(results: Results) -> Made:
    """The grid of CFUs and FFU lanes."""
    data = results.table("explore", "explore.py", ())
    head = list(data.rows[0])
    measured = next((column for column in head if measure_of(column) == "cycles"), None)
    if not measured:
        raise Missing(f"{results.tables / 'explore.csv'} has no column of cycles")
    keys = head[: head.index(measured)]
    varying = [key for key in keys if len(data.different(key)) > 1]
    coarse = [key for key in varying if key.rpartition(".")[2].startswith("cfu")]
    fine = [key for key in varying if key.rpartition(".")[2].startswith("ffu")]
    if len(varying) != 2 or len(coarse) != 1 or len(fine) != 1:
        raise Missing(
            f"{results.tables / 'explore.csv'} varies {', '.join(varying) or 'nothing'}, not CFUs "
            "and FFUs; scripts/explore.py --config paper --axis hfu.cfus=1,2,4,8 "
            "--axis hfu.ffu_lanes=4,8,16,32 makes it"
        )
    columns, rows = (sorted(data.different(key), key=number) for key in (coarse[0], fine[0]))
    cycles = {(row[coarse[0]], row[fine[0]]): number(row[measured]) for row in data.rows}
    slowest = max(cycles.values())
    gains = [
        [slowest / cycles[c, f] if (c, f) in cycles else float("nan") for c in columns]
        for f in rows
    ]
    figure, (axes,) = panels(1, width=5.2, height=3.9)
    drawn = heat_map(axes, columns, rows, gains)
    axes.set_xlabel(coarse[0])
    axes.set_ylabel(fine[0])
    axes.set_title("Times as fast as the slowest")
    figure.colorbar(drawn, ax=axes, shrink=0.9)
    said = "The paper's heat map says that more CFUs help and more FFUs do not"
    return figure, f"Coarse filters against lanes of the fine ones. {said}. From {data.made}"


def fronts_of_orders(results: Results) -> Made:
    columns = ("order", "mm2", "cycles", "joules", "on the front")
    data = results.table("fair_fight_front", "results.py fair_fight", columns)
    figure, (time, energy) = panels(2)
    for axes, column, scale, unit in (
        (time, "cycles", 1e-6, "M cycles"),
        (energy, "joules", 1e3, "mJ"),
    ):
        for at, order in enumerate(data.different("order")):
            rows = data.where(order=order)
            points = [(number(row["mm2"]), scale * number(row[column])) for row in rows]
            style = line_style(at)
            axes.plot(*zip(*points), **style | {"linestyle": "none", "alpha": 0.35})
            axes.step(*zip(*lower_left(points)), where="post", label=order, **style)
        axes.set_xlabel("area, mm²")
        from_zero(axes)
        axes.set_title(f"{unit} of a frame")
    legend_above(figure, time)
    return (
        figure,
        f"Machines that a search of both orders tried, and their fronts. From {data.made}",
    )


def equal_area(results: Results) -> Made:
    data = results.table(
        "fair_fight_views",
        "results.py fair_fight",
        ("size", "machine", "cycles", "joules", "mm2"),
    )
    machines, sizes = data.different("machine"), data.different("size")
    figure, both = panels(2, width=max(4.2, 1.1 * len(machines)), height=3.4)
    for axes, column, scale, title in (
        (both[0], "cycles", 1e-6, "M cycles of a frame"),
        (both[1], "joules", 1e3, "mJ of a frame"),
    ):
        width = 0.8 / len(sizes)
        for at, size in enumerate(sizes):
            found = []
            for machine in machines:
                rows = data.where(size=size, machine=machine)
                found.append([scale * v for row in rows if (v := number(row[column]))])
            means = [statistics.geometric_mean(values) if values else 0 for values in found]
            # A mean of equal values may be less than they are, by rounding.
            reach = [
                [max(0, mean - min(values, default=mean)) for mean, values in zip(means, found)],
                [max(0, max(values, default=mean) - mean) for mean, values in zip(means, found)],
            ]
            places = [x + (at - (len(sizes) - 1) / 2) * width for x in range(len(machines))]
            axes.bar(
                places,
                means,
                width,
                yerr=reach,
                capsize=2,
                label=f"{size} px",
                error_kw={"elinewidth": 0.8},
                **bar_style(at),
            )
        areas = [
            max((number(row["mm2"]) or 0 for row in data.where(machine=machine)), default=0)
            for machine in machines
        ]
        names = [f"{machine}\n{area:.2f} mm²" for machine, area in zip(machines, areas)]
        axes.set_xticks(range(len(machines)), names, fontsize=8, rotation=20, ha="right")
        axes.grid(axis="x", visible=False)
        axes.set_title(title)
    legend_above(figure, both[0])
    return (
        figure,
        f"Orders at equal area: geometric means, least and most of all views. From {data.made}",
    )


FIGURES = {
    "exploration": exploration,
    "filter_units": filter_units,
    "fronts_of_orders": fronts_of_orders,
    "equal_area": equal_area,
}
