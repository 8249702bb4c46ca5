"""Where the time, the operations and the bytes of single frames go, from reports of `simulate`."""

from __future__ import annotations

from drawing.figure import Made, Results, bar_style, how_simulated, legend_above, line_style, panels
from reporting import costs
from reporting.folder import Run

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


FIGURES = {
    "roofline": roofline,
    "waits": waits,
    "traffic": traffic,
}
