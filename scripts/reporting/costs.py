"""What a frame costs on the report page: energy, area, bytes; and where its time goes."""

from __future__ import annotations

import re
from collections.abc import Sequence

from reporting import charts
from reporting.charts import number, percent
from runs.simulations import memory_known

MOST_COMPONENTS = 14  # of energy; the rest is one line
KINDS_OF_ENERGY = (
    ("dram", "DRAM"),
    ("logic", "logic"),
    ("memory", "on-chip memory"),
    ("clock", "clock"),
    ("leakage", "leakage"),
)
WAYS = (("read", "read"), ("write", "written"), ("bus", "on the bus, in whole bursts"))


def amounts(costs: dict, suffix: str) -> dict[str, float]:
    """Middle values by component, without the total."""
    names = [name for name in costs["bands"] if name != f"total{suffix}"]
    return {name.removesuffix(suffix): costs[name] for name in names}


def without_memory(view: dict) -> str:
    """Words behind joules and watts; empty where the memory's are known."""
    return "" if memory_known(view) else " without the memory"


def kinds_of_energy(view: dict) -> dict[str, float]:
    """Joules of logic, on-chip memory, clock, leakage and DRAM."""
    logic = set(amounts(view["area_mm2"], "")) - {"sram"}
    kinds = dict.fromkeys(("dram", "logic", "memory", "clock", "leakage"), 0.0)
    for name, joules in amounts(view["energy"], "_j").items():
        if name in logic:
            kinds["logic"] += joules
        elif name.endswith("leakage"):
            kinds["leakage"] += joules
        else:
            kinds[name if name in kinds else "memory"] += joules
    return kinds


def component_colours(view: dict) -> dict[str, str]:
    logic = dict.fromkeys(amounts(view["area_mm2"], ""), "logic")
    leakage = dict.fromkeys(("logic_leakage", "sram_leakage"), "leakage")
    return logic | leakage | {"sram": "memory", "clock": "clock", "dram": "dram"}


def cost_bars(
    costs: dict, suffix: str, scale: float, unit: str, caption: str, colours: dict[str, str]
) -> str:
    """Components from the largest down, each with the band of what the sources allow."""
    middle = amounts(costs, suffix)
    whole = costs[f"total{suffix}"] or 1
    order = sorted(middle, key=lambda name: -middle[name])
    shown = order if len(order) <= MOST_COMPONENTS + 1 else order[:MOST_COMPONENTS]
    bands = costs["bands"]
    widest = max((bands[name + suffix]["high"] for name in shown), default=0) or 1
    rows = []
    for name in shown:
        band = bands[name + suffix]
        value = number(scale * middle[name])
        low, high = (number(scale * band[end]) for end in ("low", "high"))
        what = f"{name}: {value} {unit} ({low} .. {high})"
        drawn = charts.bar(
            [(colours.get(name, "memory"), middle[name] / widest, what)],
            (band["low"] / widest, band["high"] / widest) if band["high"] > band["low"] else None,
        )
        rows.append((name.replace("_", " "), drawn, (value, percent(middle[name] / whole))))
    if rest := order[len(shown) :]:
        left = sum(middle[name] for name in rest)
        drawn = charts.bar([("memory", left / widest, f"{len(rest)} more")])
        rows.append((f"{len(rest)} smaller", drawn, (number(scale * left), percent(left / whole))))
    return charts.bars(("component", unit, "share"), rows, caption)


def energy(view: dict, of: str = "the frame") -> str:
    kinds = kinds_of_energy(view)
    whole = sum(kinds.values()) or 1
    parts = [
        (kind, kinds[kind] / whole, f"{text}: {percent(kinds[kind] / whole)}")
        for kind, text in KINDS_OF_ENERGY
    ]
    named = [(kind, f"{text} {percent(kinds[kind] / whole)}") for kind, text in KINDS_OF_ENERGY]
    return f"<div class=lone>{charts.bar(parts)}</div>{charts.legend(named)}" + cost_bars(
        view["energy"],
        "_j",
        1e3,
        "mJ",
        f"Energy of {of}{without_memory(view)} by component; lines: what the sources allow",
        component_colours(view),
    )


def owners(view: dict) -> str:
    """Square millimetres of each kind of unit, its on-chip memory included, the largest first."""
    by_owner = view["area_mm2"].get("by_owner")
    if not by_owner:
        return ""
    whole = sum(by_owner.values())
    rows = []
    for name in sorted(by_owner, key=lambda name: -by_owner[name]):
        what = f"{name}: {number(by_owner[name])} mm²"
        drawn = charts.bar([("logic", by_owner[name] / max(by_owner.values()), what)])
        shares = (number(by_owner[name]), percent(by_owner[name] / whole))
        rows.append((name.replace("_", " "), drawn, shares))
    caption = "Area by owner: each unit with its on-chip memory; PHY and controller of the memory"
    return charts.bars(("owner", "mm²", "share"), rows, caption)


def area(view: dict) -> str:
    caption = f"Area at {view['provenance']['technology']}; lines: what the sources allow"
    by_kind = cost_bars(view["area_mm2"], "", 1, "mm²", caption, component_colours(view))
    return by_kind + owners(view)


def ways_of_bytes(dram: dict) -> dict[str, int]:
    """Bytes asked for, read and written."""
    both = [by_way for by_unit in dram["bytes_by_region"].values() for by_way in by_unit.values()]
    return {way: sum(by_way.get(way, 0) for by_way in both) for way in ("read", "write")}


def traffic(view: dict) -> str:
    dram = view["dram"]
    asked = {
        region: {
            way: sum(both.get(way, 0) for both in by_unit.values()) for way in ("read", "write")
        }
        for region, by_unit in dram["bytes_by_region"].items()
    }
    on_bus = dram["bus_bytes_by_region"]
    widest = (
        max([*(sum(both.values()) for both in asked.values()), *on_bus.values()], default=0) or 1
    )
    rows = []
    for region, both in sorted(asked.items(), key=lambda entry: -sum(entry[1].values())):
        bus = on_bus.get(region, 0)
        parts = [
            ("read", both["read"] / widest, f"read {number(both['read'])} B"),
            ("write", both["write"] / widest, f"written {number(both['write'])} B"),
        ]
        drawn = charts.bar(parts) + charts.bar(
            [("bus", bus / widest, f"on the bus {number(bus)} B")], thin=True
        )
        megabytes = (number(count / 1e6) for count in (sum(both.values()), bus))
        rows.append((region.replace("_", " "), drawn, tuple(megabytes)))
    text = charts.legend(WAYS)
    text += charts.bars(("region", "asked, MB", "bus, MB"), rows, "DRAM by region")
    requests = [
        (region, unit, number(both.get("read", 0)), number(both.get("write", 0)))
        for region, by_unit in dram["bytes_by_region"].items()
        for unit, both in by_unit.items()
    ]
    head = ("region", "asked by", "read, B", "written, B")
    text += charts.details("who asked", charts.table(head, requests, numeric=(2, 3)))
    rows_of_banks = ", ".join(
        number(dram[f"row_{what}"]) for what in ("hits", "misses", "conflicts")
    )
    return text + (
        f"<p class=small>{number(dram['bandwidth_gb_s'])} of {number(dram['peak_gb_s'])} GB/s over "
        f"the frame, {number(dram['busy_bandwidth_gb_s'])} GB/s while there were requests. Row "
        f"hits, misses, conflicts: {rows_of_banks}. Latency of reads: mean "
        f"{number(dram['read_latency_mean_ns'])} ns, 99th percentile "
        f"{number(dram['read_latency_p99_ns'])} ns.</p>"
    )


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
    text = charts.legend(CAUSES) + time_bars(merged, "Share of all cycles")
    if len(merged) < len(spent):
        text += charts.details("each unit by itself", time_bars(spent, "Share of all cycles"))
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
