"""Where the cycles of a frame go, as a section of the report page."""

from __future__ import annotations

import re
from collections.abc import Sequence

from reporting import report_charts as charts
from reporting.report_charts import percent

# Causes in the order in which they are drawn, each the name of its colour's class.
CAUSES = (
    ("busy", "works"),
    ("input", "waits for input"),
    ("reads", "for answers to reads"),
    ("writes", "for answers to writes"),
    ("room", "for room behind it"),
    ("port", "for its memory port"),
    ("loading", "for an on-chip memory to be filled"),
    ("phase", "for its phase of the frame"),
    ("idle", "nothing to do"),
)
NO_CAUSE = ("phase", "idle")  # of the longest wait: nothing there keeps it waiting
MOST_WAITS = 12  # places listed
Spent = tuple[str, str, dict[str, int]]  # unit and activity, resource, cycles by cause


def kind_of(unit: str) -> str:
    """hfu2.fine: hfu*.fine, what units that stand several times have in common."""
    return re.sub(r"^([a-z_]+?)\d+(?=\.|$)", r"\1*", unit)


def activities(view: dict) -> list[Spent]:
    return [
        (
            f"{unit} {name}",
            spent["resource"],
            {"busy": spent["busy_cycles"], **spent["waited_cycles"]},
        )
        for unit, of_unit in view["units"].items()
        for name, spent in of_unit["activities"].items()
    ]


def by_kind(spent: Sequence[Spent]) -> list[Spent]:
    """Units that stand several times as one line, their sums."""
    kinds: dict[str, list[Spent]] = {}
    for entry in spent:
        unit, _, activity = entry[0].partition(" ")
        kinds.setdefault(f"{kind_of(unit)} {activity}", []).append(entry)
    return [
        (
            f"{kind.replace('*', '')} × {len(same)}" if len(same) > 1 else same[0][0],
            same[0][1],
            {cause: sum(cycles[cause] for _, _, cycles in same) for cause in same[0][2]},
        )
        for kind, same in kinds.items()
    ]


def time_bars(spent: Sequence[Spent], caption: str) -> str:
    rows = []
    for label, resource, cycles in spent:
        whole = sum(cycles.values()) or 1
        parts = [
            (cause, cycles[cause] / whole, f"{text}: {percent(cycles[cause] / whole)}")
            for cause, text in CAUSES
        ]
        longest = max(
            (cause for cause, _ in CAUSES[1:] if cause not in NO_CAUSE),
            key=lambda cause: cycles[cause],
        )
        waits = f"{longest} {percent(cycles[longest] / whole)}" if cycles[longest] else ""
        rows.append((label, charts.bar(parts), (percent(cycles["busy"] / whole), waits)))
    return charts.bars(("activity", "works", "waits most"), rows, caption)


def time(view: dict) -> str:
    spent = activities(view)
    merged = by_kind(spent)
    text = charts.legend(CAUSES) + time_bars(merged, "Share of the frame's cycles")
    if len(merged) < len(spent):
        text += charts.details(
            "each unit by itself", time_bars(spent, "Share of the frame's cycles")
        )
    return text + charts.details("where it waits, and what to change", waits(view))


def waits(view: dict) -> str:
    cycles = view["frame"]["cycles"] or 1
    places = [
        (wait["cycles"], f"{unit} {name}", wait)
        for unit, of_unit in view["units"].items()
        for name, spent in of_unit["activities"].items()
        for wait in spent["waits"]
        if "on" in wait
    ]
    places.sort(key=lambda place: -place[0])
    rows = [
        (
            who,
            wait["for"],
            wait.get("on", ""),
            wait.get("other_end", ""),
            percent(count / cycles),
            " ".join(wait[end] for end in ("key", "turn") if end in wait),
        )
        for count, who, wait in places[:MOST_WAITS]
    ]
    head = ("activity", "waits for", "at", "at its other end", "of the frame", "key to change")
    return charts.table(head, rows, numeric=(4,))
