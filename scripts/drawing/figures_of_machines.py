"""Our own figures: what machines of one area are worth, and where the time, the operations and the
bytes of single frames go."""

from __future__ import annotations

import statistics

from matplotlib.figure import Figure

from reporting import report_time
from drawing.figure_inputs import Results, how_simulated, number
from drawing.figure_style import bar_style, from_zero, legend_above, line_style, panels
from reporting.report_folder import Run

MOST_RUNS = 6  # whose frames are drawn
Made = tuple[Figure, str]  # with its caption


def lower_left(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Those with less of the second than any with less of the first, by the first."""
    front: list[tuple[float, float]] = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def fronts_of_orders(results: Results) -> Made:
    columns = ("order", "mm2", "M cycles", "mJ", "on the front")
    data = results.table("fair_fight_front", "fair_fight.py", columns)
    figure, (time, energy) = panels(2)
    for axes, column in ((time, "M cycles"), (energy, "mJ")):
        for at, order in enumerate(data.different("order")):
            rows = data.where(order=order)
            points = [(number(row["mm2"]), number(row[column])) for row in rows]
            style = line_style(at)
            axes.plot(*zip(*points), **style | {"linestyle": "none", "alpha": 0.35})
            axes.step(*zip(*lower_left(points)), where="post", label=order, **style)
        axes.set_xlabel("area, mm²")
        from_zero(axes)
        axes.set_title(f"{column} of a frame")
    legend_above(figure, time)
    return (
        figure,
        f"Machines that a search of both orders tried, and their fronts. From {data.made}",
    )


def equal_area(results: Results) -> Made:
    data = results.table(
        "fair_fight_views",
        "fair_fight.py",
        ("size_px", "machine", "cycles", "energy_j", "area_mm2", "psnr_db"),
    )
    machines, sizes = data.different("machine"), data.different("size_px")
    figure, both = panels(2, width=max(4.2, 1.1 * len(machines)), height=3.4)
    for axes, column, scale, title in (
        (both[0], "cycles", 1e-6, "M cycles of a frame"),
        (both[1], "energy_j", 1e3, "mJ of a frame"),
    ):
        width = 0.8 / len(sizes)
        for at, size in enumerate(sizes):
            found = []
            for machine in machines:
                rows = data.where(size_px=size, machine=machine)
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
            max((number(row["area_mm2"]) or 0 for row in data.where(machine=machine)), default=0)
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


def group_size(results: Results) -> Made:
    parts = ("DRAM mJ", "SRAM mJ", "logic mJ", "clock and leakage mJ")
    columns = ("preset", "group px", *parts, "bus MB", "mm2")
    data = results.table("energy_groups", "energy_tables.py", columns)
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


# Components of the ledger whose unit has another name.
UNITS = {"lists": "lister"}


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
    spent = [report_time.by_kind(report_time.activities(run.views[0].report)) for run in runs]
    met = {cause for of_run in spent for *_, of in of_run for cause, count in of.items() if count}
    across = min(2, len(runs))
    rows = max(map(len, spent))
    figure, all_axes = panels(len(runs), width=5.4, height=0.24 * rows + 0.9, across=across)
    for axes, run, activities in zip(all_axes, runs, spent):
        left = [0.0] * len(activities)
        names = [name for name, _, _ in activities]
        for at, (cause, text) in enumerate(report_time.CAUSES):
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


FIGURES = {
    "fronts_of_orders": fronts_of_orders,
    "equal_area": equal_area,
    "group_size": group_size,
    "roofline": roofline,
    "waits": waits,
    "traffic": traffic,
}
