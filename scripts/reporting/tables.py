"""CSV tables on the report page, sortable, with a diagram of any two columns; and runs beside each
other."""

from __future__ import annotations

import json
from collections.abc import Sequence

from reporting import charts
from reporting.charts import escaped, number, rate
from reporting.costs import KINDS_OF_ENERGY, WAYS, kinds_of_energy, ways_of_bytes, without_memory
from reporting.folder import Run, Table, ViewFiles
from tables import REQUIRED, measure_of
from reporting.page import mm2_with_phy, quality

MOST_ROWS = 2000  # of a table that are shown
# Columns that are drawn at first where they are there, the likelier ones first.
ACROSS = ("area_mm2.total", "mm2", "mm2_high", "area_mm2", "sram_bytes", "DRAM MB", "MB a frame")
ACROSS += ("bus MB",)
UP = ("fps", "frames/s", "cycles", "frame.cycles", "k cycles", "M cycles", "joules", "mJ")
UP += ("PSNR dB",)
# Columns of words that say nothing of what a row is.
NO_LABELS = ("binding", "binding.unit", "binding.holds", "binds", "key", "status")
NO_LABELS += ("slowest view", "holds", "front")


def value_of(cell: str) -> float | None:
    """The number that a cell begins with nothing before and no words behind: 1,234.5 or 12%."""
    try:
        return float(cell.replace(",", "").removesuffix("%"))
    except ValueError:
        return None


def numeric_columns(table: Table) -> list[int]:
    """Those with nothing but numbers where they are filled, and at least one."""
    found = []
    for at in range(len(table.head)):
        cells = [row[at] for row in table.rows if row[at]]
        if cells and all(value_of(cell) is not None for cell in cells):
            found.append(at)
    return found


def first_choice(table: Table, wanted: Sequence[str], among: Sequence[int], other: int) -> int:
    """What is required before all else; what names a row only where nothing was measured."""
    bounds_first = sorted(among, key=lambda at: not REQUIRED.fullmatch(table.head[at]))
    for name in wanted:
        for at in bounds_first:
            if measure_of(table.head[at]) == name:
                return at
    labels = labels_of(table, among)
    left = [at for at in bounds_first if at != other] or list(among)
    measured = [at for at in left if table.head[at] not in labels] or left
    differ = [at for at in measured if len({row[at] for row in table.rows}) > 1]
    return (differ or measured)[0]


def up_choice(table: Table, among: Sequence[int], across: int) -> int:
    """A bound of something else than what is drawn across, if there is one."""
    bounds = [at for at in among if REQUIRED.fullmatch(table.head[at])]
    other = [at for at in bounds if measure_of(table.head[at]) not in ACROSS]
    return first_choice(table, (*table.costs[:1], *UP), other or among, across)


def labels_of(table: Table, numeric: Sequence[int]) -> Sequence[str]:
    """Columns that name a row: of an exploration its axes, else words that are no range."""
    if table.labels:
        return table.labels
    if "front" in table.head and "group" in table.head:
        given = tuple(name for name in table.head if name == "beside")
        return (*given, *table.head[: table.head.index("group") + 1])
    words = [at for at in range(len(table.head)) if at not in numeric]
    return [
        table.head[at]
        for at in words
        if table.head[at] not in NO_LABELS and not any(" .. " in row[at] for row in table.rows)
    ]


def cell_text(cell: str) -> str:
    """Of a column of numbers: as long as it can be read."""
    value = value_of(cell)
    if value is None or "," in cell or "%" in cell:
        return cell
    if cell.lstrip("-").isdecimal():
        return f"{int(cell):,}"
    return f"{value:.6g}" if len(cell) > 9 else cell


def row_names(table: Table) -> list[str]:
    """Of each row what names it and is not the same in all."""
    numeric = numeric_columns(table)
    named = labels_of(table, numeric)
    varying = [
        at
        for at, name in enumerate(table.head)
        if name in named and len({row[at] for row in table.rows}) > 1
    ]

    def name_of(row: Sequence[str]) -> str:
        words = (f"{table.head[at]} {row[at]}" if at in numeric else row[at] for at in varying)
        return ", ".join(filter(None, words))

    return [name_of(row) for row in table.rows]


def diagram(table: Table, name: str) -> str:
    numeric = [at for at in numeric_columns(table) if not (table.opens and at == 0)]
    if len(numeric) < 2 or len(table.rows) < 2:
        return ""
    across = first_choice(table, (*table.costs[1:2], *ACROSS), numeric, -1)
    ups = [at for at in numeric if at != across]
    up = up_choice(table, ups, across)
    best = table.head.index("front") if "front" in table.head else None
    facts = {
        "names": [table.head[at] for at in numeric],
        "points": [[value_of(row[at]) for at in numeric] for row in table.rows],
        "labels": row_names(table),
        "best": [best is None or row[best] == "yes" for row in table.rows],
    }

    def choice(axis: str, chosen: int, before: str = "") -> str:
        options = before + "".join(
            f"<option value={place} {'selected' if at == chosen else ''}>{escaped(table.head[at])}"
            for place, at in enumerate(numeric)
        )
        return f"<label>{axis} <select data-axis={axis}>{options}</select></label>"

    third = ""
    if len(table.costs) > 2:
        at = table.head.index(table.costs[2])
        third = choice("size", at, "<option value=-1>all the same")
    note = (
        "<span class=small>filled: no other point is better in "
        f"{' and '.join(table.costs) or 'everything'}</span>"
        if best is not None
        else ""
    )
    return (
        f'<figure class=scatter data-points="{escaped(json.dumps(facts, separators=(",", ":")))}">'
        f"<figcaption>{choice('up', up)} {choice('across', across)} {third} {note}"
        "</figcaption>"
        f'<svg role=img tabindex=0 aria-label="{escaped(name)}: a diagram of '
        f'{len(table.rows)} points; arrow keys read single points'
        f'{", Enter shows one" if table.opens else ""}"></svg>'
        "<output aria-live=polite>&nbsp;</output></figure>"
    )


def table_html(table: Table) -> str:
    numeric = numeric_columns(table)

    def content_of(at: int, cell: str) -> str:
        if table.opens and at == 0:
            return f"<button type=button data-open={int(cell) - 1}>{escaped(cell)}</button>"
        return escaped(cell_text(cell))

    head = "".join(
        f'<th scope=col{" class=n" if at in numeric else ""}><button type=button>'
        f"{escaped(name)}</button></th>"
        for at, name in enumerate(table.head)
    )
    body = "".join(
        "<tr>"
        + "".join(
            f"<td class=n>{content_of(at, cell)}</td>"
            if at in numeric
            else f"<td>{escaped(cell)}</td>"
            for at, cell in enumerate(row)
        )
        + "</tr>"
        for row in table.rows[:MOST_ROWS]
    )
    more = len(table.rows) - MOST_ROWS
    note = (
        f"<p class=small>{more} more lines are in {escaped(table.name)}.csv.</p>"
        if more > 0
        else ""
    )
    return (
        f'<div class=scroll tabindex=0 role=region aria-label="table {escaped(table.name)}">'
        f'<table class="plain sortable" aria-label="{escaped(table.name)}">'
        f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        f"</div>{note}"
    )


def content(table: Table, title: str) -> str:
    return diagram(table, title) + table_html(table)


def section(table: Table, title: str) -> str:
    return f"<section class=wide><h3>{escaped(title)}</h3>{content(table, title)}</section>"


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
        for files in run.shown()
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
        total = f"{number(1e3 * view['energy']['total_j'])}{without_memory(view)}"
        rows.append((label, charts.bar(parts), (total,)))
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
    head = ("run", "scene", "view", "px", "fps", "cycles", "PSNR", "DRAM MB", "bus MB", "mJ", "W")
    head += ("mm2", "mm2 with PHY", "binds")
    rows = []
    for run in runs:
        for files in run.shown():
            view = files.report
            frame, energy = view["frame"], view["energy"]
            rows.append(
                (
                    run.name or view["config"]["machine"],
                    view["scene"]["name"],
                    str(view["view"]),
                    f"{frame['width_px']}x{frame['height_px']}",
                    rate(frame["fps"]),
                    number(frame["cycles"]),
                    quality(view["image"]),
                    number(view["dram"]["bytes"] / 1e6),
                    number(view["dram"]["bus_bytes"] / 1e6),
                    *(
                        f"{number(of)}{without_memory(view)}"
                        for of in (1e3 * energy["total_j"], energy["mean_power_w"])
                    ),
                    number(view["area_mm2"]["total"]),
                    mm2_with_phy(view),
                    view["binding"]["unit"],
                )
            )
    return Table("all views", head, tuple(rows), ("run", "scene", "view"))


def sections(runs: Sequence[Run]) -> str:
    text = section(table_of_views(runs), "All views")
    for title, draw in (("Energy", energy_of_views), ("DRAM traffic", traffic_of_views)):
        text += f"<section><h3>{title}</h3>{draw(runs)}</section>"
    return text
