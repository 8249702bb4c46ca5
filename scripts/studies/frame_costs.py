"""Studies of what a frame costs: energy by component, the resource that binds, wall time of the model."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import itertools
import json
import math
import pathlib
import statistics
import sys
import tempfile
from collections.abc import Iterable, Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import Scene, answered, find_scenes, program_provenance, shared_names
from runs.simulations import (
    MJ,
    Outcome,
    Run,
    asked_mb,
    bus_mb,
    cycles,
    group_assignments,
    keep_no_codebooks,
    mean,
    mm2,
    simulate_all,
)
from studies import cases
from studies.cases import MEMORIES, OTHER, Case, components, joules_of
from tables import PRESET, SCENE, SIZE, VIEW, Column, Spread, Study

# Second halves raw in both: codebooks are the reproduction's business.
PRESETS = ("exact", "paper_no_vq")
# One rule for both: paper order's presets charge a test what the paper states of its filters.
SAME_COST = "hfu.cost=counted"
GROUPS = ["16", "32", "48", "64", "96", "128", "160x120", "160x180"]

COMPONENT_COLUMNS = (
    PRESET,
    Column("mJ of", "component: units of logic, on-chip memory, clock, leakage, DRAM, all"),
    SCENE,
    Column("mJ", "with the middle of each band of the sources", "mJ", ".3f"),
    Column("least mJ", "with the low ends", "mJ", ".3f"),
    Column("most mJ", "with the high ends", "mJ", ".3f"),
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


def joules_at_end(energy: dict, keys: Iterable[str], end: str) -> float:
    """Of a section of energy, with the sources' values at an end of their bands: low or high."""
    bands = energy["bands"]
    return sum(bands[key][end] for key in keys if key in bands)


def with_band(view: dict, keys: Sequence[str]) -> tuple[float, float, float]:
    """mJ, least and most."""
    ends = (joules_at_end(view["energy"], keys, end) / MJ for end in ("low", "high"))
    return (joules_of(view, keys) / MJ, *ends)


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
        return mean(views, lambda v: sum(joules_of(v, components(v)[name]) for name in names) / MJ)

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


def add_energy_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "all real scenes")
    run_arguments.add_side_by_side(to)
    to.add_argument("--view", default="0", help="number of a camera")
    run_arguments.add_size(to, "640x360")
    to.add_argument(
        "--groups", nargs="+", default=GROUPS, metavar="SHAPE", help="in px: SIDE or WxH"
    )
    run_arguments.add_settings(to, "both presets")


def make_energy(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--groups", arguments.groups)
    groups = {shape: group_assignments(shape) for shape in arguments.groups}
    scenes = find_scenes(arguments.scenes or shared_names(), arguments.cameras)

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


ENERGY = Study(
    "energy",
    """Where the energy of a frame goes in both orders, and what the size of the pixel group does to it.
Makes

  energy_components  energy by component with the band that the sources leave, by scene
  energy_groups      energy, bytes, cycles and area against the group's size: arithmetic means over
                     the scenes, so that the columns of a row add up

Rows carry the name of the preset that was run. Both orders are charged what was counted on our
filters (hfu.cost=counted). On-chip memory is as large as each group needs. The ordering table of
paper order has the preset's bytes and, in groups of more pixels than the preset's, as many times
more.
""",
    ("results.py energy",),
    add_energy_arguments,
    make_energy,
)


BINDING_COLUMNS = (
    SCENE,
    VIEW,
    Column("M cycles", "of the frame", "10^6 cycles", ".3f"),
    Column("binding names", "key of the resource that `binding` says holds the frame"),
    Column("its doubling saves", "share of the frame's cycles; empty: not doubled", "", ".1%"),
    Column("gains most", "key whose doubling saves most"),
    Column("that saves", "share of the frame's cycles", "", ".1%"),
    Column("named gains most", "whether the two are one, or save the same but for noise"),
    Column("noise", "those of the two that save no more than the noise of a frame"),
    Column("why not", "verdict of what-if"),
)


def binding_row(scene: str, answer: dict) -> tuple:
    """Of what-if on one view."""
    doubled = [each for each in answer.get("doubled", []) if "refused" not in each]
    gains = {each["key"]: each["time_saved"] for each in doubled}
    best = max(gains, key=gains.get, default="")
    right = answer["named_gains_most"]
    base = answer["base"]
    noise = {each["key"] for each in doubled if each["time_below_noise"]}
    noisy = [key for key in dict.fromkeys((base["holds_key"], best)) if key in noise]
    return (
        *(scene, answer["view"], base["cycles"] / 1e6),
        *(base["holds_key"], gains.get(base["holds_key"]), best, gains.get(best)),
        *(right, ", ".join(noisy), "" if right else answer["verdict"]),
    )


def ask_what_if(arguments: argparse.Namespace, scene: Scene) -> list[tuple]:
    """Raises Failure, and ValueError where the command refuses."""
    run = Run(scene, arguments.view, arguments.size, arguments.config, tuple(arguments.set))
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        out = pathlib.Path(folder) / "what_if.json"
        words = [*run.arguments(), "--out", str(out)]
        answered(arguments.streaminggs, "what-if", words, run.label())
        print(run.label(), file=sys.stderr, flush=True)
        return [binding_row(scene.name, answer) for answer in json.loads(out.read_text())]


def add_binding_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "all real scenes")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, "640x360")
    to.add_argument("--config", default="exact", help="preset or JSON file")
    run_arguments.add_settings(to, "the configuration")


def make_binding_check(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or shared_names(), arguments.cameras)
    with concurrent.futures.ThreadPoolExecutor(arguments.side_by_side) as pool:
        waiting = [pool.submit(ask_what_if, arguments, scene) for scene in scenes]
        try:
            rows = [row for each in waiting for row in each.result()]
        finally:
            pool.shutdown(cancel_futures=True)
    by = tables.made(arguments.streaminggs, [program_provenance(arguments.streaminggs)], scenes)
    right = sum(row[-3] for row in rows)
    about = f"The resource named gains most on {right} of {len(rows)} views."
    tables.write(arguments.out, "binding_check", by, BINDING_COLUMNS, rows, about)


BINDING_CHECK = Study(
    "binding_check",
    """Whether the resource that a view's `binding` names is the one whose doubling gains most: the
answers of `streaminggs what-if`, a line for each view. Makes binding_check.
""",
    ("results.py binding_check",),
    add_binding_arguments,
    make_binding_check,
)


# NeRArch-Sim (ISCA 2026), of a design point of GSCore.
PUBLISHED_SECONDS = 47.7

TIMED_MACHINE = (
    Column("GB/s", "peak of the DRAM", "GB/s", ".1f"),
    Column("machine", "preset"),
)
SECONDS = (
    Column("simulation s", "in the SystemC kernel", "s", ".2f"),
    Column("whole command s", "of the call, the scene read and prepared", "s", ".2f"),
)
TIMING_COLUMNS = (
    *(SCENE, SIZE, *TIMED_MACHINE),
    Column("Gaussians", "of the scene", "", ","),
    *SECONDS,
    Column("peak MB", "host memory used, the most of the repeats", "MB", ",.0f"),
)
POINT_COLUMNS = (Column("of", "scene, or who states it"), SIZE, *TIMED_MACHINE, *SECONDS)
SECONDS_ABOUT = (
    "Wall time of this model on the machine that made the table, one simulation at a time. "
    "One view of the scene and size that take least, and of those that take most. "
    "NeRArch-Sim (ISCA 2026) states neither scene nor size nor host here: "
    "its time is for the order of magnitude."
)


@dataclasses.dataclass(frozen=True)
class Timed:
    """seconds: of the call. simulating: of them, in the kernel."""

    case: Case
    machine: str
    peak_gb_s: float
    seconds: float
    simulating: float

    def row(self) -> tuple:
        return (*self.case.cells(), self.peak_gb_s, self.machine, self.simulating, self.seconds)


def point_rows(points: Sequence[Timed]) -> list[tuple]:
    """The quickest and the slowest of each machine, below what is published."""
    rows = [("NeRArch-Sim, published", "not stated", None, "gscore", None, PUBLISHED_SECONDS)]
    for machine in dict.fromkeys(point.machine for point in points):
        of = sorted((p for p in points if p.machine == machine), key=lambda p: p.seconds)
        rows += [point.row() for point in dict.fromkeys((of[0], of[-1]))]
    return rows


def add_timing_arguments(to: run_arguments.Parser) -> None:
    cases.add_arguments(to, ("gscore", "exact"), [4])
    to.add_argument("--view", type=int, default=0, help="number of a camera")
    to.add_argument("--repeats", type=int, default=3, help="of each; the median counts")


def make_timing(arguments: argparse.Namespace) -> None:
    run_arguments.check_at_least("--repeats", arguments.repeats, 1)
    arguments.view = str(arguments.view)
    found = cases.find_cases(arguments)
    asked = list(itertools.product(found, arguments.channels, arguments.machines))
    runs = [
        Run(case.scene, arguments.view, case.size, machine, (f"dram.channels={channels}",))
        for case, channels, machine in asked
        for _ in range(arguments.repeats)
    ]
    keep_no_codebooks()
    outcomes = simulate_all(arguments.streaminggs, runs, side_by_side=1)
    points, rows, measured = [], [], []
    for case, _, machine in asked:
        repeats = list(itertools.islice(outcomes, arguments.repeats))
        views = [outcome.accepted()[0] for outcome in repeats]
        measured += views
        timed = Timed(
            case,
            machine,
            views[0]["dram"]["peak_gb_s"],
            statistics.median(outcome.seconds for outcome in repeats),
            statistics.median(view["host"]["simulation_wall_s"] for view in views),
        )
        *machine_of, simulating, seconds = timed.row()
        peak_mb = max(view["host"]["peak_rss_bytes"] for view in views) / 1e6
        gaussians = views[0]["scene"]["gaussians"]
        points.append(timed)
        rows.append((*machine_of, gaussians, simulating, seconds, peak_mb))
    by = tables.made_of(arguments.streaminggs, measured, [case.scene for case in found])
    tables.write(arguments.out, "timing", by, TIMING_COLUMNS, rows)
    tables.write(
        arguments.out, "design_point_seconds", by, POINT_COLUMNS, point_rows(points), SECONDS_ABOUT
    )


TIMING = Study(
    "timing",
    """Wall time of the model: of a design point of each machine, one simulation at a time, medians over
the repeats. `simulate` reads the scene, lays it out, renders the pictures that the frame is judged
by, simulates and writes everything. Makes

  timing                a line for each case, memory and machine
  design_point_seconds  of each machine the case that takes least and the one that takes most,
                        beside what NeRArch-Sim states of one of GSCore

On a machine with nothing else to do.
""",
    ("results.py timing builtin:object builtin:outdoor yard park --repeats 2",),
    add_timing_arguments,
    make_timing,
)
