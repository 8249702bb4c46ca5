"""Where the energy of a frame goes in both orders, and what the size of the pixel group does to it.
Makes

  energy_components  energy by component with the band that the sources leave, by scene
  energy_groups      energy, bytes, cycles and area against the group's size: arithmetic means over
                     the scenes, so that the columns of a row add up

Rows carry the name of the preset that was run. Both orders are charged what was counted on our
filters (hfu.cost=counted). On-chip memory is as large as each group needs. The ordering table of
paper order has the preset's bytes and, in groups of more pixels than the preset's, as many times
more.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Sequence

import tables
from tables import PRESET, SCENE, Column, Spread
from runs import run_arguments
from runs.scenes import find_scenes, shared_names
from runs.simulations import (
    MJ,
    Outcome,
    Run,
    asked_mb,
    bus_mb,
    cycles,
    group_assignments,
    mean,
    mm2,
    simulate_all,
)
from runs.sweep_server import swept

JOBS = ("results.py energy",)

# Second halves raw in both: codebooks are compare_variants' business.
PRESETS = ("exact", "paper_no_vq")
# One rule for both: paper order's presets charge a test what the paper states of its filters.
SAME_COST = "hfu.cost=counted"
GROUPS = ["16", "32", "48", "64", "96", "128", "160x120", "160x180"]

# Components of energy that are neither logic nor on-chip memory.
OTHER = {
    "clock": ("clock_j",),
    "leakage": ("logic_leakage_j", "sram_leakage_j"),
    "DRAM": ("dram_j",),
    "all": ("total_j",),
}
MEMORIES = ("SRAM: pixels", "SRAM: all else")

COMPONENT_COLUMNS = (
    PRESET,
    Column("mJ of", "component: units of logic, on-chip memory, clock, leakage, DRAM, all"),
    SCENE,
    Column("mJ", "with the middle of each band of the technology", "mJ", ".3f"),
    Column(
        "least mJ",
        "with the low ends; of the DRAM the lowest of the published sets of currents, of which "
        "the total has none",
        "mJ",
        ".3f",
    ),
    Column("most mJ", "with the high ends, or the highest set of currents", "mJ", ".3f"),
)
GROUP_COLUMNS = (
    PRESET,
    Column("group px", "side, or width and height, of a pixel group", "px"),
    Column("DRAM mJ", "mean over the scenes", "mJ", ".3f"),
    Column("SRAM mJ", "on-chip memory, mean over the scenes", "mJ", ".3f"),
    Column("logic mJ", "all units, mean over the scenes", "mJ", ".3f"),
    Column("clock and leakage mJ", "mean over the scenes", "mJ", ".3f"),
    Column("all mJ", "mean over the scenes", "mJ", ".3f"),
    Column("bus MB", "moved in whole bursts, mean over the scenes", "MB", ".2f"),
    Column("asked MB", "requested by units, mean over the scenes", "MB", ".2f"),
    Column("M cycles", "of the frame, mean over the scenes", "10^6 cycles", ".3f"),
    Column("mm2", "area for the scene that needs most", "mm2", ".2f"),
    Column("SRAM KiB", "on-chip memory for the scene that needs most", "KiB", ",.0f"),
    Column("ordering table B", "vsu.table_bytes; empty: the machine has none", "B", ","),
)


def components(view: dict) -> dict[str, tuple[str, ...]]:
    """Name of a row: the keys of the report's energy that it sums."""
    area = {name: mm2 for name, mm2 in view["area_mm2"].items() if not isinstance(mm2, dict)}
    logic = [name for name in area if name not in ("sram", "total")]
    rows = {name: (f"{name}_j",) for name in logic if f"{name}_j" in view["energy"]}
    elsewhere = {key for keys in [*rows.values(), *OTHER.values()] for key in keys}
    # Numbers, not what is split up once more, such as dram_by_region_j.
    taken = [k for k, of in view["energy"].items() if k.endswith("_j") and not isinstance(of, dict)]
    memories = sorted(key for key in taken if key not in elsewhere)
    pixels = tuple(key for key in memories if key == "pixel_state_j")
    rest = tuple(key for key in memories if key != "pixel_state_j")
    return {**rows, **dict(zip(MEMORIES, (pixels, rest))), **OTHER}


def joules(view: dict, keys: Iterable[str]) -> float:
    return sum(view["energy"].get(key, 0) for key in keys)


def joules_at_end(view: dict, keys: Iterable[str], end: str) -> float:
    """With the technology's energies at an end of their bands: low or high."""
    bands = view["energy"]["bands"]
    return sum(bands[key][end] for key in keys if key in bands)


def with_band(view: dict, keys: Sequence[str]) -> tuple[float, float, float]:
    """mJ, least and most."""
    middle = joules(view, keys)
    if keys == OTHER["DRAM"]:
        ends = [*view["energy"]["dram_by_current_set_j"].values(), middle]
    else:
        ends = [joules_at_end(view, keys, end) for end in ("low", "high")]
    return middle / MJ, min(ends) / MJ, max(ends) / MJ


def table_bytes(config: dict, shape: Sequence[str]) -> tuple[str, ...]:
    """The ordering table, where the machine has one, for groups of this shape."""
    if (bytes_of_preset := config["vsu"].get("table_bytes")) is None:
        return ()
    sides = [int(assignment.partition("=")[2]) for assignment in shape]
    pixels_of_preset = config["group_width_px"] * config["group_height_px"]
    times = max(1.0, math.prod(sides) / pixels_of_preset)
    return (f"vsu.table_bytes={math.ceil(bytes_of_preset * times)}",)


def group_row(preset: str, shape: str, views: Sequence[dict]) -> tuple:
    parts = components(views[0])
    logic = [name for name in parts if name not in (*MEMORIES, *OTHER)]

    def mj(*names: str) -> float:
        return mean(views, lambda v: sum(joules(v, components(v)[name]) for name in names) / MJ)

    sram = max(sum(v["sram"][f"{m}_bytes"] for m in ("input", "codebook", "shared")) for v in views)
    return (
        preset,
        shape,
        *(mj("DRAM"), mj(*MEMORIES), mj(*logic), mj("clock", "leakage"), mj("all")),
        *(mean(views, bus_mb), mean(views, asked_mb), mean(views, cycles) / 1e6),
        max(map(mm2, views)),
        sram / 1024,
        views[0]["config"]["vsu"].get("table_bytes"),
    )


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "all real scenes")
    run_arguments.add_side_by_side(to)
    to.add_argument("--view", default="0", help="number of a camera")
    run_arguments.add_size(to, "640x360")
    to.add_argument(
        "--groups", nargs="+", default=GROUPS, metavar="SHAPE", help="in px: SIDE or WxH"
    )
    run_arguments.add_settings(to, "both presets")


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--groups", arguments.groups)
    groups = {shape: group_assignments(shape) for shape in arguments.groups}
    scenes = find_scenes(arguments.scenes or shared_names())

    def runs_of(cases: Sequence[tuple[str, Sequence[str]]]) -> list[Run]:
        """Of all scenes, by preset and what is set."""
        return [
            Run(
                *(scene, arguments.view, arguments.size, preset),
                (SAME_COST, *overrides, *arguments.set),
                fit_memories=True,
            )
            for preset, overrides in cases
            for scene in scenes
        ]

    def by_case(outcomes: Iterable[Outcome]) -> list[list[dict]]:
        """The views of all scenes. Raises ValueError where one is refused."""
        views = [outcome.accepted()[0] for outcome in outcomes]
        return [views[at : at + len(scenes)] for at in range(0, len(views), len(scenes))]

    # `sweep` keeps no bands.
    runs = runs_of([(preset, ()) for preset in PRESETS])
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    shipped = dict(zip(PRESETS, by_case(outcomes)))
    cases = [(preset, shape) for preset in PRESETS for shape in groups]
    runs = runs_of(
        [
            (p, (*groups[shape], *table_bytes(shipped[p][0]["config"], groups[shape])))
            for p, shape in cases
        ]
    )
    grouped = by_case(swept(arguments, "energy", runs))
    by = tables.made_of(arguments.streaminggs, (v for of in shipped.values() for v in of), scenes)
    about = f"View {arguments.view} at {arguments.size} px, {SAME_COST}."
    rows = [
        (preset, name, scene.name, *with_band(view, keys))
        for preset, views in shipped.items()
        for name, keys in components(views[0]).items()
        for scene, view in zip(scenes, views)
    ]
    tables.write(
        *(arguments.out, "energy_components", by, COMPONENT_COLUMNS, rows, about),
        spread=Spread("scene", "{mJ} ({least mJ} .. {most mJ})"),
    )
    about += " Arithmetic means over the scenes; area and memory of the scene that needs most."
    rows = [group_row(preset, shape, views) for (preset, shape), views in zip(cases, grouped)]
    tables.write(arguments.out, "energy_groups", by, GROUP_COLUMNS, rows, about)
