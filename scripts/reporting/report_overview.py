"""What several views have in common, at the beginning of the report page."""

from __future__ import annotations

from collections.abc import Sequence

from reporting import report_charts as charts, report_tables
from reporting.report_charts import number
from reporting.report_costs import KINDS_OF_ENERGY, WAYS, kinds_of_energy, ways_of_bytes
from reporting.report_folder import Run, Table, ViewFiles
from reporting.report_view import quality

MOST_BARS = 40  # views whose energy and traffic are drawn


def labelled(runs: Sequence[Run]) -> list[tuple[str, ViewFiles]]:
    several = len(runs) > 1
    return [
        (
            f"{run.name} view {files.report['view']}"
            if several
            else f"view {files.report['view']}",
            files,
        )
        for run in runs
        for files in run.views
    ]


def energy_of_views(runs: Sequence[Run]) -> str:
    """Stacked bars, all to one scale."""
    views = [(label, files.report) for label, files in labelled(runs)][:MOST_BARS]
    most = max(view["energy"]["total_j"] for _, view in views) or 1
    rows = []
    for label, view in views:
        kinds = kinds_of_energy(view)
        parts = [
            (kind, kinds[kind] / most, f"{text}: {number(1e3 * kinds[kind])} mJ")
            for kind, text in KINDS_OF_ENERGY
        ]
        rows.append((label, charts.bar(parts), (number(1e3 * view["energy"]["total_j"]),)))
    return charts.legend(KINDS_OF_ENERGY) + charts.bars(("view", "mJ"), rows, "Energy of a frame")


def traffic_of_views(runs: Sequence[Run]) -> str:
    """Bytes read and written, all to one scale."""
    views = [(label, files.report["dram"]) for label, files in labelled(runs)][:MOST_BARS]
    most = max(max(dram["bytes"], dram["bus_bytes"]) for _, dram in views) or 1
    rows = []
    for label, dram in views:
        parts = [
            (way, count / most, f"{way}: {number(count / 1e6)} MB")
            for way, count in ways_of_bytes(dram).items()
        ]
        bus = charts.bar([("bus", dram["bus_bytes"] / most, "on the bus")], thin=True)
        rows.append((label, charts.bar(parts) + bus, (number(dram["bytes"] / 1e6),)))
    return charts.legend(WAYS) + charts.bars(("view", "asked, MB"), rows, "DRAM traffic of a frame")


def table_of_views(runs: Sequence[Run]) -> Table:
    head = (
        "run",
        "scene",
        "view",
        "px",
        "fps",
        "cycles",
        "PSNR",
        "DRAM MB",
        "mJ",
        "W",
        "mm2",
        "binds",
    )
    rows = []
    for run in runs:
        for files in run.views:
            view = files.report
            frame, energy = view["frame"], view["energy"]
            rows.append(
                (
                    run.name or view["config"]["machine"],
                    view["scene"]["name"],
                    str(view["view"]),
                    f"{frame['width_px']}x{frame['height_px']}",
                    number(frame["fps"]),
                    number(frame["cycles"]),
                    quality(view),
                    number(view["dram"]["bytes"] / 1e6),
                    number(1e3 * energy["total_j"]),
                    number(energy["mean_power_w"]),
                    number(view["area_mm2"]["total"]),
                    view["binding"]["unit"],
                )
            )
    return Table("all views", head, tuple(rows), ("run", "scene", "view"))


def sections(runs: Sequence[Run]) -> str:
    text = report_tables.section(table_of_views(runs), "All views")
    for title, draw in (("Energy", energy_of_views), ("DRAM traffic", traffic_of_views)):
        text += f"<section><h3>{title}</h3>{draw(runs)}</section>"
    return text
