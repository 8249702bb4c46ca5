"""What figures are made from: tables that scripts wrote, and reports of `simulate`; and how they
look: readable on paper and in grey, since colours differ in lightness and every series has a hatch
or a marker of its own. Needs Matplotlib, which figures.py asks for first."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import textwrap
from collections.abc import Iterable, Sequence

import matplotlib
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from reporting import costs
from reporting.folder import Run, find_runs
from runs.files import read_csv
from tables import facts_of, made_sentence


class Missing(Exception):
    """An input that is not there, or holds nothing to draw; the text says which."""


@dataclasses.dataclass(frozen=True)
class Data:
    """A CSV table: its rows by column, and the sentence of who made it."""

    rows: tuple[dict[str, str], ...]
    made: str

    def different(self, column: str) -> list[str]:
        """Values of a column, in the order in which they come."""
        return list(dict.fromkeys(row[column] for row in self.rows))

    def where(self, **wanted: str) -> list[dict[str, str]]:
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]


def number(text: str) -> float | None:
    """None where it is none, as `equal`."""
    try:
        return float(text.replace(",", "").removesuffix("%"))
    except ValueError:
        return None


class Results:
    """Folders of tables, and of what `simulate` wrote."""

    def __init__(self, tables: pathlib.Path, folder: pathlib.Path):
        self.tables, self.folder = tables, folder

    def table(self, name: str, maker: str, columns: Iterable[str]) -> Data:
        """Raises Missing; ValueError where the table has not these columns."""
        path = self.tables / f"{name}.csv"
        if not path.exists():
            raise Missing(f"{path} is not there; scripts/{maker} --out {self.tables} makes it")
        head, rows = read_csv(path)
        for column in columns:
            if column not in head:
                raise ValueError(f"{path}: columns {', '.join(head)}; expected {column}")
        if not rows:
            raise Missing(f"{path} has no rows")
        made = made_sentence(facts_of(self.tables, name)).replace("`", "").strip()
        return Data(tuple(dict(zip(head, row)) for row in rows), f"{path}. {made}")

    def runs(self) -> list[Run]:
        """Raises Missing."""
        below = find_runs(self.folder) if self.folder.is_dir() else ()
        found = [run for run in below if run.views]
        if not found:
            raise Missing(f"{self.folder} has no report.json of `streaminggs simulate` below it")
        return found


def how_simulated(runs: Iterable[Run]) -> str:
    """Commits and commands of the runs' first views."""
    facts = [run.views[0].report["provenance"] for run in runs]
    commits = ", ".join(dict.fromkeys(fact["commit"] for fact in facts))
    commands = "; ".join(dict.fromkeys(fact["command"] for fact in facts))
    return f"Made by {commands}; commit {commits}."


matplotlib.use("Agg")
# From dark to light and back, told apart in grey and by those who see no red or green.
COLOURS = ("#1f4e8c", "#f0a830", "#7fc4b0", "#a63d57", "#c9c4e8", "#6b6f78", "#e9e2c8", "#3d7a52")
HATCHES = ("", "///", "...", "xxx", "\\\\\\", "", "++", "ooo")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<")
LINES = ("-", "--", "-.", ":")
INK, SOFT = "#20242c", "#626a78"
ON_PAPER = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8}
CAPTION_PER_INCH = 15.5  # characters

Made = tuple[Figure, str]  # a figure with its caption

pyplot.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.edgecolor": SOFT,
        "axes.labelcolor": INK,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
        "axes.grid": True,
        "grid.color": "#dde1e7",
        "grid.linewidth": 0.6,
        "xtick.color": INK,
        "ytick.color": INK,
        "hatch.linewidth": 0.6,
        "hatch.color": "#ffffff",
        "legend.frameon": False,
        "legend.fontsize": 8.5,
        "lines.linewidth": 1.6,
        "lines.markersize": 5,
        "savefig.dpi": 160,
        "svg.hashsalt": "streaminggs",  # the same numbers give the same file
        "svg.fonttype": "none",
    }
)


def panels(
    count: int,
    width: float = 4.2,
    height: float = 3.1,
    across: int = 2,
    heights: Sequence[float] | None = None,
):
    """A figure of so many axes side by side, `across` in a row; sizes of one, in inches. heights:
    of the rows to each other, where they are not alike."""
    rows = -(-count // across)
    columns = min(count, across)
    size = (columns * width, rows * height)
    figure, axes = pyplot.subplots(
        rows, columns, figsize=size, squeeze=False, height_ratios=heights
    )
    flat = list(axes.flat)
    for unused in flat[count:]:
        unused.set_visible(False)
    return figure, flat[:count]


def bar_style(at: int) -> dict:
    colour = COLOURS[at % len(COLOURS)]
    light = sum(int(colour[i : i + 2], 16) for i in (1, 3, 5)) > 420
    return {
        "color": colour,
        "hatch": HATCHES[(at + at // len(COLOURS)) % len(HATCHES)],  # a ninth is not like the first
        "edgecolor": INK if light else "white",
        "linewidth": 0.5,
    }


def line_style(at: int) -> dict:
    # The lightest colours are for areas, not for lines.
    colours = [c for c in COLOURS if c not in ("#e9e2c8", "#c9c4e8")]
    return {
        "color": colours[at % len(colours)],
        "marker": MARKERS[at % len(MARKERS)],
        "linestyle": LINES[at % len(LINES)],
    }


def note(axes: Axes, x: float, y: float, text: str, **more: object) -> None:
    """A remark in the diagram, such as a published figure."""
    axes.annotate(text, (x, y), fontsize=8, color=SOFT, bbox=ON_PAPER, **more)


def case_label(scene: str, size: str) -> str:
    """Below a group of bars, on lines short enough not to meet the next one's."""
    return "\n".join([*scene.replace("?", ":").split(":"), size])


def from_zero(axes: Axes) -> None:
    """The axis of values begins at 0, with room above what is drawn."""
    axes.set_ylim(0, 1.08 * axes.dataLim.y1 or 1)


def plain_logarithmic(axis: Axis) -> None:
    """1, 2, 5, 10 and so on, as written, in place of powers with minor marks between."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def heat_map(
    axes: Axes, across: Sequence[str], up: Sequence[str], values: Sequence[Sequence[float]]
) -> AxesImage:
    """Each value in its cell; values: a row for each of up, from below."""
    drawn = axes.imshow(values, cmap="YlGnBu", origin="lower", aspect="auto")
    middle = (drawn.get_clim()[0] + drawn.get_clim()[1]) / 2
    for y, line in enumerate(values):
        for x, value in enumerate(line):
            colour = "white" if value > middle else "black"
            axes.annotate(f"{value:.2f}", (x, y), ha="center", va="center", color=colour)
    axes.set_xticks(range(len(across)), across)
    axes.set_yticks(range(len(up)), up)
    axes.grid(visible=False)
    return drawn


def published(axes: Axes, value: float, text: str, vertical: bool = False) -> None:
    """A published figure as a dotted line across."""
    draw = axes.axvline if vertical else axes.axhline
    draw(value, color=INK, linestyle=(0, (1, 1.5)), linewidth=1.2)
    where = (value, 0.99) if vertical else (0.995, value)
    axes.annotate(
        text,
        where,
        xycoords=("data", "axes fraction") if vertical else ("axes fraction", "data"),
        xytext=(3, -2) if vertical else (-2, 2),
        textcoords="offset points",
        ha="left" if vertical else "right",
        va="top" if vertical else "bottom",
        fontsize=8,
        color=INK,
        bbox=ON_PAPER,
    )


def legend_above(figure: Figure, axes: Axes, columns: int = 4) -> None:
    """Of one of the axes, for all of them, above the figure."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=columns)


def save(figure: Figure, out: pathlib.Path, name: str, caption: str) -> None:
    """As NAME.svg and NAME.png, each whole or not at all, with the caption below the axes."""
    figure.tight_layout()
    width = figure.get_size_inches()[0]
    lines = textwrap.wrap(caption, int(width * CAPTION_PER_INCH))
    figure.text(0.01, -0.02, "\n".join(lines), fontsize=7.5, color=SOFT, va="top", ha="left")
    out.mkdir(parents=True, exist_ok=True)
    for kind, about in (("svg", {"Date": None}), ("png", {"Software": None})):
        path = out / f"{name}.{kind}"
        part = out / f"{name}.{kind}.part"
        try:
            figure.savefig(part, format=kind, bbox_inches="tight", pad_inches=0.12, metadata=about)
            os.replace(part, path)
        except BaseException:
            part.unlink(missing_ok=True)
            raise
    pyplot.close(figure)


MOST_RUNS = 6  # whose frames are drawn
# Components of the ledger whose unit has another name.
UNITS = {"lists": "lister"}


def first_runs(results: Results) -> list[Run]:
    return results.runs()[:MOST_RUNS]


def name_of(run: Run) -> str:
    view = run.views[0].report
    return f"{run.name or view['config']['machine']}, view {view['view']}"


def caption_of(results: Results, what: str) -> str:
    """With the runs that are drawn, and how many are not."""
    runs = results.runs()
    more = f" The first {MOST_RUNS} of {len(runs)} runs." if len(runs) > MOST_RUNS else ""
    return f"{what}{more} From {results.folder}. {how_simulated(runs[:MOST_RUNS])}"


def bytes_of(view: dict, component: str) -> int:
    """That its units asked for: those with it in their path, whatever their number."""
    unit = UNITS.get(component, component)
    return sum(
        count
        for by_unit in view["dram"]["bytes_by_region"].values()
        for path, ways in by_unit.items()
        if unit in (part.rstrip("0123456789") for part in path.split("."))
        for count in ways.values()
    )


def lanes_of(view: dict) -> list[tuple[str, float, float, int]]:
    """Component and kind of lane; multiply-accumulates; lanes; bytes that its units asked for. Of
    those that did and fetched anything."""
    found = []
    for line in view["ledger"]["lines"]:
        component, _, kind = line["what"].partition(": ")
        moved = bytes_of(view, component)
        if kind.endswith("_lane") and line["done"] > 0 and moved > 0:
            name = f"{component}, {kind.removesuffix('_lane')}"
            found.append((name, line["done"], line["per_cycle"], moved))
    return found


def roofline(results: Results) -> Made:
    """The lanes of each unit: what they do a cycle against what they do for a byte."""
    runs = first_runs(results)
    figure, all_axes = panels(len(runs), across=min(3, len(runs)), height=3.5)
    for axes, run in zip(all_axes, runs):
        view = run.views[0].report
        cycles, dram = view["frame"]["cycles"], view["dram"]
        bytes_a_cycle = dram["peak_gb_s"] * 1e3 / view["config"]["clock_mhz"]
        units = lanes_of(view)
        if not units:
            continue
        places = [macs / moved for _, macs, _, moved in units]
        reach = (min(places) / 4, max(places) * 4)
        axes.plot(
            reach,
            [bytes_a_cycle * place for place in reach],
            color="#20242c",
            label=f"{dram['peak_gb_s']:g} GB/s",
        )
        for at, ((name, macs, lanes, _), place) in enumerate(zip(units, places)):
            style = line_style(at) | {"linestyle": "none"}
            roof = min(lanes, bytes_a_cycle * place)
            label = f"{name}: {macs / cycles / roof:.0%}"
            axes.plot([place], [macs / cycles], label=label, **style)
            axes.plot([place, place], [macs / cycles, roof], color=style["color"], linewidth=0.8)
            wide = [place / 1.4, place * 1.4]
            axes.plot(wide, [roof, roof], color=style["color"], linewidth=2.2)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlim(reach)
        least = min(macs for _, macs, _, _ in units) / cycles
        # The legend has the room below.
        axes.set_ylim(least / 40, 4 * max(lanes for _, _, lanes, _ in units))
        axes.set_xlabel("multiply-accumulates a byte that the unit moves")
        axes.set_title(name_of(run))
        axes.legend(fontsize=7.5, loc="lower right")
    all_axes[0].set_ylabel("multiply-accumulates a cycle")
    what = (
        "Roofline of each unit: the mark is what its lanes did over the whole frame, the bar above "
        "it what they could, or the memory's bandwidth for this unit alone; per cent of that."
    )
    return figure, caption_of(results, what)


def waits(results: Results) -> Made:
    runs = first_runs(results)
    spent = [costs.by_kind(costs.activities(run.views[0].report)) for run in runs]
    met = {cause for of_run in spent for *_, of in of_run for cause, count in of.items() if count}
    across = min(2, len(runs))
    rows = max(map(len, spent))
    figure, all_axes = panels(len(runs), width=5.4, height=0.24 * rows + 0.9, across=across)
    for axes, run, activities in zip(all_axes, runs, spent):
        left = [0.0] * len(activities)
        names = [name for name, _, _ in activities]
        for at, (cause, text) in enumerate(costs.CAUSES):
            shares = [100 * of[cause] / (sum(of.values()) or 1) for _, _, of in activities]
            if cause not in met:
                continue
            style = bar_style(at) if cause != "idle" else {"color": "#eef0f3"}
            axes.barh(names, shares, left=left, label=text, **style)
            left = [a + b for a, b in zip(left, shares)]
        axes.set_xlim(0, 100)
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        axes.set_title(f"{name_of(run)}: % of the frame")
    legend_above(figure, all_axes[0])
    return figure, caption_of(results, "What each activity works and waits for.")


def traffic(results: Results) -> Made:
    runs = first_runs(results)
    asked = {
        name_of(run): {
            region: sum(count for ways in by_unit.values() for count in ways.values()) / 1e6
            for region, by_unit in run.views[0].report["dram"]["bytes_by_region"].items()
        }
        for run in runs
    }
    regions = list(dict.fromkeys(region for of_run in asked.values() for region in of_run))
    figure, (axes,) = panels(1, width=7.4, height=0.42 * len(asked) + 1.0)
    left = [0.0] * len(asked)
    for at, region in enumerate(regions):
        counts = [of_run.get(region, 0) for of_run in asked.values()]
        axes.barh(list(asked), counts, left=left, label=region.replace("_", " "), **bar_style(at))
        left = [a + b for a, b in zip(left, counts)]
    bus = [run.views[0].report["dram"]["bus_bytes"] / 1e6 for run in runs]
    axes.plot(bus, list(asked), "|", color="#20242c", markersize=14, label="on the bus")
    axes.invert_yaxis()
    axes.set_xlabel("MB asked for")
    axes.grid(axis="y", visible=False)
    legend_above(figure, axes, columns=5)
    return figure, caption_of(results, "DRAM traffic of a frame by region.")


OF_FRAMES = {
    "roofline": roofline,
    "waits": waits,
    "traffic": traffic,
}
