"""Study of what presets take: area, energy and time of each, and areas beside published ones."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Mapping

import tables
from runs import run_arguments
from runs.files import read_json
from runs.scenes import find_scene, find_scenes
from runs.simulations import MB, MJ, Run, cycles, decibels, simulate_all
from studies.synthesis import SMALL_SCENE, TECHNOLOGY
from tables import PRESET, PSNR, Column, Study

SCENE = "truck"
PRESETS = (
    *("exact", "exact_fast", "exact_wide", "exact_half", "exact_fp16"),
    *("exact_vq", "exact_vq_packed"),
    *("paper_text", "paper_ideal", "paper", "paper_no_vq", "paper_no_cgf", "paper_no_vq_cgf"),
    *("gscore", "gscore_fp32_keys", "gscore_boxes", "gscore_lossless", "gscore_lossless_boxes"),
)
PRESET_COLUMNS = (
    PRESET,
    Column("mm2", "without PHY and controller of the memory", "mm2", ".2f"),
    Column("mm2, least", "all sources at their low end", "mm2", ".2f"),
    Column("mm2, most", "all sources at their high end", "mm2", ".2f"),
    Column("mm2 with PHY", "with PHY and controller of the memory", "mm2", ".2f"),
    Column("cycles", "of the frame", "cycles", ",d"),
    Column("DRAM MB", "requested by units", "MB", ".1f"),
    Column("mJ", "of the frame, without PHY and controller", "mJ", ".2f"),
    Column("mJ, least", "all sources at their low end", "mJ", ".2f"),
    Column("mJ, most", "all sources at their high end", "mJ", ".2f"),
    Column("mJ with PHY", "with PHY and controller of the memory", "mJ", ".2f"),
    PSNR,
)

# GSCore (ASPLOS 2024), mm2 by part, scaled from 28 nm; our components that do what the part does,
# `sram` all on-chip memory.
TO_32NM = 1.40
GSCORE_PARTS = (
    ("CCUs", ("ccu",), 1.15),
    ("tile tests, lists", ("lists",), None),
    ("QSUs, BSUs", ("qsu", "bsu"), 0.10),
    ("VRUs", ("rendering",), 2.53),
    ("memories", ("sram",), 1.75),
    ("memory path", ("memory_path",), None),
    ("all", ("total",), 5.53),
)
GSCORE_COLUMNS = (
    Column("part", "of the tile-centric machine"),
    Column("here, mm2", "preset gscore at 32 nm", "mm2", ".2f"),
    Column("published, mm2", f"from 28 to 32 nm by {TO_32NM:.2f}", "mm2", ".2f"),
    Column("here over published", "less 1", "", "+.0%"),
)

# StreamingGS (DAC 2025), table 1, mm2 at 32 nm.
HFUS_MM2, HFU_LANES = 0.79, 128
RENDERING_MM2, RENDERING_PIXELS = 2.53, 64
SORTING_MM2, COMPARE_EXCHANGES = 0.042, 160
KEY_BITS, SUBTILE_PIXELS = 64, 16
AREA_COLUMNS = (
    Column("published", "StreamingGS, table 1"),
    Column("mm2", "as published", "mm2", ",g"),
    Column("for each of", "what the area is divided by"),
    Column("um2 each", "as published", "um2", ",.0f"),
    Column("here, um2 each", "by the technology table", "um2", ",.0f"),
    Column("what of ours", "is beside it"),
)

FOLDED = ("exact", "gscore_lossless")
SHARED_COLUMNS = (
    PRESET,
    Column("datapath", "that is folded: its lanes begin an item once in some cycles"),
    Column("copies", "of it"),
    Column("register bits", "between the lanes of a copy, as charged", "", ",.0f"),
    Column("more, not shared", "if each value had registers of its own", "", "+.0%"),
    Column("mm2 more", "of all copies, with clock gates", "mm2", ".3f"),
)


def um2(parts: Iterable[tuple[str, float]], rows: Mapping[str, dict]) -> float:
    """With the clock gates of their registers."""
    gate = rows["clock_gate"]["mm2"]["middle"] / 32
    return 1e6 * sum(
        count * (rows[kind]["mm2"]["middle"] + rows[kind]["register_bits"] * gate)
        for kind, count in parts
    )


def preset_row(preset: str, view: dict) -> tuple:
    def ends(section: str, unit: str) -> tuple[float, float, float]:
        band = view[section][f"without_memory_interface{unit}"]
        return band["middle"], band["low"], band["high"]

    return (
        *(preset, *ends("area_mm2", "")),
        view["area_mm2"]["with_memory_interface"]["middle"],
        cycles(view),
        view["dram"]["bytes"] / MB,
        *(of / MJ for of in ends("energy", "_j")),
        view["energy"]["with_memory_interface_j"]["middle"] / MJ,
        decibels(view),
    )


def gscore_rows(view: dict) -> list[tuple]:
    rows = []
    for part, components, published in GSCORE_PARTS:
        here = sum(view["area_mm2"][name] for name in components)
        rows.append((part, here, published, here / published - 1 if published else None))
    return rows


def blend_row(view: dict, rows: Mapping[str, dict]) -> tuple:
    """Of a pixel a cycle."""
    blend = view["datapath"]["subtile_blend"]
    used = blend["used"]
    a_cycle = view["config"]["rendering"]["clusters"] * SUBTILE_PIXELS / used["interval_cycles"]
    parts = [(kind, of["parts"]) for kind, of in blend["beside"].items()]
    of_pixel = used["macs"] / SUBTILE_PIXELS
    return (
        um2([(blend["lane"], blend["lanes"]), *parts], rows) / a_cycle,
        f"preset {view['provenance']['configuration']}: {of_pixel:.1f} multiply-accumulates on "
        f"{blend['lane']}, and what stands beside and between lanes",
    )


def sorting_row(view: dict, rows: Mapping[str, dict]) -> tuple:
    """Of a compare-exchange."""
    built = {
        line["what"].removeprefix("sorting: "): line["per_cycle"]
        for line in view["ledger"]["lines"]
        if line["what"].startswith("sorting: ")
    }
    pairs = built["comparator"] / (KEY_BITS / 32)
    parts = [(kind, built[kind] / pairs) for kind in ("comparator", "exchange_bit")]
    place = built["exchange_bit"] / pairs - KEY_BITS
    preset = view["provenance"]["configuration"]
    return um2(parts, rows), f"preset {preset}: keys of {KEY_BITS} bits, places of {place:.0f}"


def published_rows(single: dict, half: dict, technology: dict) -> list[tuple]:
    """single, half: views of machines that blend so."""
    rows = technology["parts"]
    alone = technology["published"]["fp32_lane"]["mm2"]["low"] * 1e6
    beside = {
        (HFUS_MM2, HFU_LANES, "single-precision lanes", "4 HFUs"): (
            (um2([("fp32_lane", 1)], rows), "a lane; what is beside and between comes on top"),
            (alone, "adder and multiplier alone, as published"),
        ),
        (RENDERING_MM2, RENDERING_PIXELS, "pixels", "64 rendering units"): (
            blend_row(single, rows),
            blend_row(half, rows),
        ),
        (
            *(SORTING_MM2, COMPARE_EXCHANGES),
            *("compare-exchanges of 16-bit keys and numbers", "2 sorting units"),
        ): (sorting_row(single, rows), sorting_row(half, rows)),
    }
    return [
        (what, area, f"{count} {of}", area / count * 1e6, here, ours)
        for (area, count, of, what), each in beside.items()
        for here, ours in each
    ]


def sharing_rows(preset: str, view: dict, technology: dict) -> list[tuple]:
    """An item writes each of its values into as many registers as it would have alone."""
    rows = []
    for name, datapath in view["datapath"].items():
        used, bits = datapath["used"], datapath["beside"].get("register_bit")
        if used["interval_cycles"] == 1 or not bits:
            continue
        copies = datapath["lanes"] // math.ceil(used["macs"] / used["interval_cycles"])
        more = bits["operations"] - bits["parts"] / copies
        area = um2([("register_bit", copies * more)], technology["parts"]) * 1e-6
        rows.append(
            (preset, name, copies, bits["parts"] / copies, more * copies / bits["parts"], area)
        )
    return rows


def add_preset_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, SCENE)
    run_arguments.add_side_by_side(to)
    to.add_argument("--view", default="0", help="number of a camera")
    run_arguments.add_size(to, "640x360")


def make_presets(arguments: argparse.Namespace) -> None:
    # Datapaths are the machine's, and this scene has all spherical harmonics.
    folded = [Run(find_scene(SMALL_SCENE), config=preset) for preset in FOLDED]
    scenes = find_scenes(arguments.scenes or [SCENE], arguments.cameras)
    if len(scenes) > 1:
        raise ValueError(f"SCENE: got {len(scenes)}, expected one")
    (scene,) = scenes
    runs = [Run(scene, arguments.view, arguments.size, preset) for preset in PRESETS]
    runs += folded
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    views = {preset: next(outcomes).accepted()[0] for preset in PRESETS}
    of_folded = {preset: next(outcomes).accepted()[0] for preset in FOLDED}
    by = tables.made_of(arguments.streaminggs, views.values(), [scene])
    peak = views[PRESETS[0]]["dram"]["peak_gb_s"]
    about = (
        f"Scene {scene.name}, untuned, view {arguments.view}, {arguments.size} px, memory of "
        f"{peak:.1f} GB/s."
    )
    rows = [preset_row(*of) for of in views.items()]
    tables.write(arguments.out, "presets", by, PRESET_COLUMNS, rows, about)
    about = (
        "GSCore is published with 3.95 mm2 and 0.87 W at 28 nm and 1 GHz; its parts stand here at "
        "32 nm."
    )
    tables.write(
        arguments.out, "gscore_area", by, GSCORE_COLUMNS, gscore_rows(views["gscore"]), about
    )
    technology = read_json(TECHNOLOGY)
    rows = published_rows(views["exact"], views["paper"], technology)
    tables.write(arguments.out, "published_areas", by, AREA_COLUMNS, rows)
    rows = [
        row for preset, view in of_folded.items() for row in sharing_rows(preset, view, technology)
    ]
    tables.write(arguments.out, "registers_shared", by, SHARED_COLUMNS, rows)


PRESETS_STUDY = Study(
    "presets",
    """What every preset takes for one view, and areas beside published ones. Makes

  presets          area, cycles, bytes, energy and quality, without and with PHY and controller
  gscore_area      area of the preset gscore by part, beside GSCore's
  published_areas  areas that StreamingGS states, of one lane, pixel or compare-exchange, beside ours
  registers_shared register bits between lanes, and how many more there were if no values shared any
""",
    ("results.py presets",),
    add_preset_arguments,
    make_presets,
)
