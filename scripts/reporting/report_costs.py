"""Energy, area and traffic of a view, as sections of the report page."""

from __future__ import annotations

from reporting import report_charts as charts
from reporting.report_charts import number, percent

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


def energy(view: dict) -> str:
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
        "Energy of the frame by component; lines: what the sources allow",
        component_colours(view),
    )


def area(view: dict) -> str:
    caption = f"Area at {view['provenance']['technology']}; lines: what the sources allow"
    return cost_bars(view["area_mm2"], "", 1, "mm²", caption, component_colours(view))


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
