"""Sections of the report page about one view."""

from __future__ import annotations

import re
from collections.abc import Sequence

import report_charts as charts
from png_pictures import size_of
from report_charts import escaped, number, percent
from report_folder import ViewFiles

# Causes in the order in which they are drawn, each the name of its colour's class.
CAUSES = (
    ("busy", "works"),
    ("input", "waits for input"),
    ("reads", "for answers to reads"),
    ("writes", "for answers to writes"),
    ("room", "for room behind it"),
    ("port", "for its memory port"),
    ("loading", "for an on-chip memory to be filled"),
    ("idle", "nothing to do"),
)
MOST_WAITS = 12  # places listed
MOST_COMPONENTS = 14  # of energy; the rest is one line
HEAT_MAPS = (
    ("cycles", "Cycles of rendering", "cycles"),
    ("bytes", "Bytes asked for", "B"),
    ("misordered", "Blends out of order", "blends"),
    ("missed", "Splats missed", "splats"),
    ("blends", "Blends", "blends"),
)


def quality(view: dict) -> str:
    psnr_db = view["image"]["psnr_db"]
    return "equal" if psnr_db is None else f"{psnr_db:.2f} dB"


def key_numbers(view: dict) -> str:
    frame, image, dram, energy = view["frame"], view["image"], view["dram"], view["energy"]
    area = view["area_mm2"]
    joules, squares = energy["bands"]["total_j"], area["bands"]["total"]
    is_model = image["equals_streaming_renderer"]
    cards = (
        ("frames a second", number(frame["fps"]), f"{number(frame['cycles'])} cycles"),
        (
            "PSNR",
            quality(view),
            f"SSIM {image['ssim']:.4f}; {'bit for bit' if is_model else 'NOT'} the model's",
        ),
        (
            "DRAM",
            f"{number(dram['bytes'] / 1e6)} MB",
            f"{number(view['limit']['ratio'])} x once; {percent(dram['of_peak'])} of peak",
        ),
        (
            "energy",
            f"{number(1e3 * energy['total_j'])} mJ",
            f"{number(1e3 * joules['low'])} .. {number(1e3 * joules['high'])} mJ; "
            f"{number(energy['mean_power_w'])} W",
        ),
        (
            "area",
            f"{number(area['total'])} mm²",
            f"{number(squares['low'])} .. {number(squares['high'])} mm², "
            f"{view['provenance']['technology']}",
        ),
        (
            "binds",
            view["binding"]["unit"],
            f"works {percent(view['binding']['utilisation'])} of the frame",
        ),
    )
    return (
        "<dl class=cards>"
        + "".join(
            f"<div><dt>{escaped(name)}</dt><dd><b>{escaped(value)}</b>"
            f"<small>{escaped(more)}</small></dd></div>"
            for name, value, more in cards
        )
        + "</dl>"
    )


def binding(view: dict) -> str:
    return f"<p class=note><b>What binds.</b> {escaped(view['binding']['explanation'])}</p>"


def pictures(files: ViewFiles, uris: dict[str, str], name: str, remark: str) -> str:
    """uris: data of the pictures that are embedded, by what they show. name: a prefix of ids."""
    if "frame" not in uris:
        return f"<p class=note>{escaped(remark or 'No pictures lie beside this report.')}</p>"
    others = [what for what in uris if what != "frame"]
    width, height = files.report["frame"]["width_px"], files.report["frame"]["height_px"]
    layers = "".join(
        f'<div class=layer data-what={what} {"" if at == 0 else "hidden"}>'
        f'<img src="{uris[what]}" alt="{escaped(alt_text(what))}" '
        f'style="height:{tallness(files, what):.3f}%"></div>'
        for at, what in enumerate(others)
    )
    choices = "".join(
        f'<label><input type=radio name="{name}-with" value={what} {"checked" if at == 0 else ""}>'
        f"<span>{escaped(what)}</span></label>"
        for at, what in enumerate(others)
    )
    note = f"<p class=small>{escaped(remark)}</p>" if remark else ""
    slider = (
        f'<fieldset class=choice><legend>frame beside</legend>{choices}</fieldset>'
        f'<label class=slide><span>frame</span><input type=range min=0 max=100 value=50 step=1 '
        f'aria-label="how much of the picture shows the frame, in per cent">'
        f"<span class=other>{escaped(others[0])}</span></label>"
        if others
        else ""
    )
    return (
        f'<div class=compare style="--w:{width};--h:{height}">'
        f'<div class=stage><img src="{uris["frame"]}" alt="frame, read back from the modelled DRAM">'
        f"{layers}<i class=edge></i></div>{slider}"
        "<p class=legend-of-error hidden>0.002 or less <i></i> 1, largest channel error, logarithmic</p>"
        f"{note}{error_parts(files.report)}</div>"
    )


def tallness(files: ViewFiles, what: str) -> float:
    """Of a picture, in per cent of the frame's height: the legend of an error map stands beside it,
    and may be taller."""
    (_, frame), (_, height) = (size_of(files.pictures[name]) for name in ("frame", what))
    return 100 * height / frame


def error_parts(view: dict) -> str:
    """What an order that loses has lost, where."""
    parts = {
        name: part for name, part in view["image"].get("error_parts", {}).items() if part is not None
    }
    if not parts:
        return ""
    shares = ", ".join(
        f"{name.replace('_', ' ')} {percent(part['share'])}" for name, part in parts.items()
    )
    counts = (
        f"{number(view['image']['missed'])} splats missed by a group, "
        f"{number(view['image']['misordered'])} of {number(view['image']['blends'])} blends out of order"
    )
    return f"<p class=small>Of the squared error: {escaped(shares)}. {escaped(counts)}.</p>"


def alt_text(what: str) -> str:
    texts = {"reference": "picture of the reference renderer", "error": "largest channel error"}
    return texts.get(what, f"squared error of what was {what}")


def kind_of(unit: str) -> str:
    """hfu2.fine: hfu*.fine, what units that stand several times have in common."""
    return re.sub(r"^([a-z_]+?)\d+(?=\.|$)", r"\1*", unit)


Spent = tuple[str, str, dict[str, int]]  # unit and activity, resource, cycles by cause


def activities(view: dict) -> list[Spent]:
    return [
        (f"{unit} {name}", spent["resource"], {"busy": spent["busy_cycles"], **spent["waited_cycles"]})
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
            (cause for cause, _ in CAUSES[1:] if cause != "idle"), key=lambda cause: cycles[cause]
        )
        waits = f"{longest} {percent(cycles[longest] / whole)}" if cycles[longest] else ""
        rows.append((label, charts.bar(parts), (percent(cycles["busy"] / whole), waits)))
    return charts.bars(("activity", "works", "waits most"), rows, caption)


def time(view: dict) -> str:
    spent = activities(view)
    merged = by_kind(spent)
    text = charts.legend(CAUSES) + time_bars(merged, "Share of the frame's cycles")
    if len(merged) < len(spent):
        text += charts.details("each unit by itself", time_bars(spent, "Share of the frame's cycles"))
    return text + charts.details("where it waits, and what to change", waits(view))


def waits(view: dict) -> str:
    cycles = view["frame"]["cycles"] or 1
    places = [
        (wait["cycles"], f"{unit} {name}", wait)
        for unit, of_unit in view["units"].items()
        for name, spent in of_unit["activities"].items()
        for wait in spent["waits"]
        if wait["for"] != "idle"
    ]
    places.sort(key=lambda place: -place[0])
    rows = [
        (
            who,
            wait["for"],
            wait.get("on", ""),
            wait.get("other_end", ""),
            percent(count / cycles),
            f"{wait['key']} {wait['turn']}" if "key" in wait else "",
        )
        for count, who, wait in places[:MOST_WAITS]
    ]
    head = ("activity", "waits for", "at", "at its other end", "of the frame", "key to change")
    return charts.table(head, rows, numeric=(4,))


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
        what = f"{name}: {value} {unit} ({number(scale * band['low'])} .. {number(scale * band['high'])})"
        drawn = charts.bar(
            [(colours.get(name, "memory"), middle[name] / widest, what)],
            (band["low"] / widest, band["high"] / widest) if band["high"] > band["low"] else None,
        )
        rows.append((name.replace("_", " "), drawn, (value, percent(middle[name] / whole))))
    if rest := order[len(shown) :]:
        left = sum(middle[name] for name in rest)
        drawn = charts.bar([("memory", left / widest, f"{len(rest)} more")])
        rows.append(
            (f"{len(rest)} smaller", drawn, (number(scale * left), percent(left / whole)))
        )
    return charts.bars(("component", unit, "share"), rows, caption)


def component_colours(view: dict) -> dict[str, str]:
    logic = dict.fromkeys(amounts(view["area_mm2"], ""), "logic")
    leakage = dict.fromkeys(("logic_leakage", "sram_leakage"), "leakage")
    return logic | leakage | {"sram": "memory", "clock": "clock", "dram": "dram"}


KINDS_OF_ENERGY = (
    ("dram", "DRAM"),
    ("logic", "logic"),
    ("memory", "on-chip memory"),
    ("clock", "clock"),
    ("leakage", "leakage"),
)


def energy(view: dict) -> str:
    kinds = kinds_of_energy(view)
    whole = sum(kinds.values()) or 1
    parts = [
        (kind, kinds[kind] / whole, f"{text}: {percent(kinds[kind] / whole)}")
        for kind, text in KINDS_OF_ENERGY
    ]
    named = [(kind, f"{text} {percent(kinds[kind] / whole)}") for kind, text in KINDS_OF_ENERGY]
    return (
        f"<div class=lone>{charts.bar(parts)}</div>{charts.legend(named)}"
        + cost_bars(
            view["energy"],
            "_j",
            1e3,
            "mJ",
            "Energy of the frame by component; lines: what the sources allow",
            component_colours(view),
        )
    )


def area(view: dict) -> str:
    caption = f"Area at {view['provenance']['technology']}; lines: what the sources allow"
    return cost_bars(view["area_mm2"], "", 1, "mm²", caption, component_colours(view))


WAYS = (("read", "read"), ("write", "written"), ("bus", "on the bus, in whole bursts"))


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
    widest = max([*(sum(both.values()) for both in asked.values()), *on_bus.values()], default=0) or 1
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
    rows_of_banks = ", ".join(number(dram[f"row_{what}"]) for what in ("hits", "misses", "conflicts"))
    return text + (
        f"<p class=small>{number(dram['bandwidth_gb_s'])} of {number(dram['peak_gb_s'])} GB/s over the "
        f"frame, {number(dram['busy_bandwidth_gb_s'])} GB/s while there were requests. Row hits, misses, "
        f"conflicts: {rows_of_banks}. Latency of reads: mean {number(dram['read_latency_mean_ns'])} ns, "
        f"99th percentile {number(dram['read_latency_p99_ns'])} ns.</p>"
    )


def heat_maps(files: ViewFiles) -> str:
    columns = [entry for entry in HEAT_MAPS if files.groups.get(entry[0])]
    if not columns:
        return "<p class=small>This machine has no groups of pixels, or its results no groups.csv.</p>"
    maps = (charts.heat_map(title, unit, files.groups, name) for name, title, unit in columns)
    return f"<div class=heats>{''.join(maps)}</div>"


def left_out(view: dict) -> str:
    rows = [
        (entry["what"].replace("_", " "), number(entry["count"]), entry["why"], entry["saves"])
        for entry in view["left_out"]
    ]
    return charts.table(("left out", "count", "why", "saves"), rows, numeric=(1,))


def counters(view: dict) -> str:
    rows = [
        (unit, name.replace("_", " "), number(count))
        for unit, of_unit in view["units"].items()
        for name, count in of_unit["counters"].items()
    ]
    return charts.table(("unit", "counter", "count"), rows, numeric=(2,))


def flat(config: dict, path: str = "") -> list[tuple[str, object]]:
    """(key.path, value) of every leaf."""
    found: list[tuple[str, object]] = []
    for key, value in config.items():
        below = flat(value, f"{path}{key}.") if isinstance(value, dict) else [(path + key, value)]
        found += below
    return found


def configuration(view: dict) -> str:
    why = {entry["key"]: entry["why"] for entry in view.get("chosen", ())}

    def text(value: object) -> str:
        return str(value).lower() if isinstance(value, bool) else str(value)

    rows = [(key, text(value), why.get(key, "")) for key, value in flat(view["config"])]
    head = ("key", "value", "where it was left open: why the model chose it")
    facts = view["provenance"]
    made = (
        f"Version {facts['version']}, commit {facts['commit']}; technology {facts['technology']}; "
        f"memory image {facts['memory_image_fnv1a64']}; {number(view['host']['simulation_wall_s'])} s "
        "of wall time."
    )
    return (
        "<p>To run it again:</p><div class=command>"
        f"<code tabindex=0>{escaped(facts['command'])}</code><button type=button>copy</button></div>"
        f"<p class=small>{escaped(made)}</p>"
        + charts.details(f"all {len(rows)} keys of the configuration", charts.table(head, rows))
        + charts.details("counters of the units", counters(view))
    )


def panel(files: ViewFiles, uris: dict[str, str], name: str, remark: str) -> str:
    """Everything about a view."""
    view = files.report
    sections = (
        ("Picture", pictures(files, uris, name, remark), "wide"),
        ("Where the time goes", time(view), "wide"),
        ("Energy", energy(view), ""),
        ("DRAM traffic", traffic(view), ""),
        ("Area", area(view), ""),
        ("Left out", left_out(view), ""),
        ("Over the picture, by group", heat_maps(files), "wide"),
        ("Configuration", configuration(view), "wide"),
    )
    body = "".join(
        f'<section class="{size}"><h3>{escaped(title)}</h3>{text}</section>'
        for title, text, size in sections
    )
    return key_numbers(view) + binding(view) + f"<div class=grid>{body}</div>"
