#!/usr/bin/env python3
"""Machines beside each other: the same scenes, views, DRAM and ledger, each with the scene stored as
it reads it; and the original rasteriser on a mobile GPU, which is modelled, not simulated. A case is a scene at a size.
Machines are held against those of their own precision: exact_fp16 and the paper's presets blend in
half as gscore and gscore_fp32_keys do, exact and exact_fast in single as gscore_lossless; exact
against gscore as well, and marked.

  compare_machines.md          a line for each case, memory and machine: means over the views;
                               frames a second of frames alone, and at most if frames overlapped
  compare_machines_ratios.md   times as fast, of both, and times less energy; by size and over all;
                               dB and published figures beside them. A scene counts once in the
                               geometric mean, however many sizes and views it has; least and most
                               are of single views
  compare_machines_cases.md    the same for each case, of the pairs of one precision and loss
  compare_machines_bytes.md    MB by region of DRAM, on the bus; of the GPU by kind, as its kernels
                               ask for them
  compare_machines_joules.md   mJ by component
  compare_machines_busy.md     share of the frame that each resource works; of the GPU's time, by
                               kernel
  compare_machines_seconds.md  wall time of this model for one design point (--side-by-side 1: that
                               nothing disturbs)
  characterisation.md          what the GPU and the tile-centric machine move, and what they would
                               have to move at 90 frames a second

Tables by region, component and resource are means over the scenes of the means over their cases;
their .csv have each case. In the end figures.py draws compare_machines_rates, _traffic and _ratios
from them into figures/, which it does again by itself. What was simulated is kept in
compare_machines_runs.jsonl and compare_machines_gpu_runs.jsonl: started again, the script goes on
where it ended.

Without SCENE: the real scenes that there are at --sizes, or at --object-sizes those that show an
object, the built-in ones, and a built-in one of a million Gaussians.
"""

from __future__ import annotations

import argparse
import itertools
import pathlib
import re
import subprocess
import sys
from collections.abc import Sequence

import machine_ratios
import run_arguments
import tables
from gpu_views import MODEL, model_gpu
from kept_runs import KeptRuns
from machine_measures import GPU, modelled, simulated
from machine_tables import (
    ABOUT,
    CHARACTER_HEAD,
    HEAD,
    PARTS_TABLES,
    SECONDS_HEAD,
    Case,
    Entry,
    Parts,
    PartsTable,
    character_row,
    parts_rows,
    row,
    seconds_about,
    seconds_rows,
)
from scenes import Scene, find_scene, shared_names
from simulations import REPOSITORY, Run, said

MACHINES = (
    "gscore",
    "gscore_fp32_keys",
    "gscore_lossless",
    "paper",
    "paper_no_vq",
    "paper_no_cgf",
    "paper_no_vq_cgf",
    "exact_fp16",
    "exact",
    "exact_fast",
    "exact_vq",
)
RUNS_FILE, GPU_RUNS_FILE = "compare_machines_runs.jsonl", "compare_machines_gpu_runs.jsonl"
DRAWER = REPOSITORY / "scripts" / "figures.py"
FIGURES = ("compare_machines_rates", "compare_machines_traffic", "compare_machines_ratios")
OBJECTS = ("truck", "playbot", "builtin:object")  # whatever their parameters
SIZES, OBJECT_SIZES = ("640x360", "980x545"), ("640x360", "800x800")
BUILT_IN = ("builtin:object", "builtin:outdoor", "builtin:outdoor?n=1000000")

PARTS_HEAD = ("scene", "size", "GB/s", "machine", "part", "value", "unit")


def write_parts(
    folder: pathlib.Path, made: str, entries: Sequence[Entry], of: Parts, what: PartsTable
) -> None:
    """The means as .md, each case as .csv."""
    machines = list(dict.fromkeys(e.machine for e in entries))
    text = f"{made}{what.about()}" + tables.markdown(
        ("GB/s", what.head, *machines), parts_rows(entries, machines, of, what.scale)
    )
    name = f"compare_machines_{what.name}"
    rows = [
        (*e.case.cells(), e.memory, e.machine, part, f"{value / what.scale:.4f}", what.unit)
        for e in entries
        for part, value in of(e.of).items()
    ]
    tables.write_text(folder / f"{name}.md", text)
    tables.write_text(folder / f"{name}.csv", tables.csv_text(PARTS_HEAD, rows))
    print(f"{text}\n", flush=True)


def shows_object(name: str) -> bool:
    return any(name == text or name.startswith(f"{text}?") for text in OBJECTS)


def sizes_of(name: str, arguments: argparse.Namespace) -> list[str]:
    if shows_object(name):
        return arguments.object_sizes or OBJECT_SIZES
    return arguments.sizes or SIZES


def check_sizes(arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
    """Raises ValueError for what is no size, and where only the sizes of other scenes are given."""
    given = {"--sizes": arguments.sizes, "--object-sizes": arguments.object_sizes}
    for option, sizes in given.items():
        for size in sizes or ():
            if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", size):
                raise ValueError(f"{option}: got {size}, expected WIDTHxHEIGHT in px")
    asked = {option for option, sizes in given.items() if sizes}
    used = {"--object-sizes" if shows_object(scene.name) else "--sizes" for scene in scenes}
    if asked and not asked & used:
        names = ", ".join(scene.name for scene in scenes)
        objects = ", ".join(OBJECTS)
        raise ValueError(
            f"{asked.pop()}: got only this, expected {used.pop()} for {names} (objects: {objects})"
        )


def check_machines(arguments: argparse.Namespace) -> None:
    """Before hours of simulation. Raises ValueError for what the program refuses to be told of."""
    for machine, channels in itertools.product(arguments.machines, arguments.channels):
        asked = ("--config", machine, "--set", f"dram.channels={channels}")
        command = [str(arguments.streaminggs), "describe", *asked]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise ValueError(said(done))


def find_cases(arguments: argparse.Namespace) -> list[Case]:
    scenes = [find_scene(text) for text in arguments.scenes or [*BUILT_IN, *shared_names()]]
    check_sizes(arguments, scenes)
    check_machines(arguments)
    return [Case(scene, size) for scene in scenes for size in sizes_of(scene.name, arguments)]


def measure(arguments: argparse.Namespace, cases: Sequence[Case]) -> tuple[list[Entry], str]:
    """And how it was made. Raises ValueError for what is refused, Failure for what failed, when
    all else has been simulated and kept."""
    out, program, pace = arguments.out, arguments.streaminggs, arguments.side_by_side
    kept = KeptRuns(program, out / RUNS_FILE, pace)
    kept_gpu = KeptRuns(program, out / GPU_RUNS_FILE, pace, model_gpu)
    runs = {
        (case, channels, machine): Run(
            case.scene, arguments.view, case.size, machine, (f"dram.channels={channels}",)
        )
        for case in cases
        for channels in arguments.channels
        for machine in arguments.machines
    }
    gpu_runs = [Run(case.scene, arguments.view, case.size, MODEL) for case in cases]
    outcomes = dict(zip(runs, kept.outcomes(list(runs.values()))))
    of_gpu = dict(zip(cases, kept_gpu.outcomes(gpu_runs)))
    entries = [Entry(case, name, simulated(o)) for (case, _, name), o in outcomes.items()]
    entries += [Entry(case, GPU, modelled(o)) for case, o in of_gpu.items()]
    return entries, run_arguments.how_made(v for o in outcomes.values() for v in o.views)


def size_groups(cases: Sequence[Case], arguments: argparse.Namespace) -> dict[str, list[Case]]:
    """The cases at the first of --sizes and --object-sizes, those at the second, ...; and all."""
    by_place: dict[int, list[Case]] = {}
    for case in cases:
        place = sizes_of(case.scene.name, arguments).index(case.size)
        by_place.setdefault(place, []).append(case)
    named = {
        ", ".join(sorted({case.size for case in of})): of for _, of in sorted(by_place.items())
    }
    return {**(named if len(named) > 1 else {}), machine_ratios.ALL: list(cases)}


def draw(folder: pathlib.Path) -> None:
    """Figures out of the tables, which are there. Raises ValueError where they cannot be drawn."""
    command = [str(DRAWER), *FIGURES, "--from", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(f"tables are complete, figures are not: {said(done)}")


def make_tables(arguments: argparse.Namespace) -> None:
    cases = find_cases(arguments)
    entries, made = measure(arguments, cases)
    out = arguments.out
    in_turn = sorted(entries, key=lambda e: cases.index(e.case))  # stable: the GPU last
    tables.write(out, "compare_machines", made + ABOUT, HEAD, list(map(row, in_turn)))
    ratios = machine_ratios.rows(entries, size_groups(cases, arguments), arguments.machines)
    about = made + machine_ratios.ABOUT
    tables.write(out, "compare_machines_ratios", about, machine_ratios.HEAD, ratios)
    of_cases = machine_ratios.case_rows(entries, cases)
    about = made + machine_ratios.CASES_ABOUT
    tables.write(out, "compare_machines_cases", about, machine_ratios.CASE_HEAD, of_cases)
    parts = (lambda m: m.bytes_by_region, lambda m: m.joules_by_component, lambda m: m.busy)
    for of, what in zip(parts, PARTS_TABLES):
        write_parts(out, made, entries, of, what)
    about = made + seconds_about(arguments.side_by_side)
    tables.write(out, "compare_machines_seconds", about, SECONDS_HEAD, seconds_rows(entries))
    shown = [e for e in in_turn if e.machine in (GPU, "gscore")]
    characters = list(map(character_row, shown))
    tables.write(out, "characterisation", made, CHARACTER_HEAD, characters)
    draw(out)


def main() -> int:
    parser = run_arguments.parser(__doc__, "as said above")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    parser.add_argument(
        "--sizes", nargs="+", metavar="WxH", help=f"in px; default: {' '.join(SIZES)}"
    )
    parser.add_argument(
        "--object-sizes",
        nargs="+",
        metavar="WxH",
        help=f"of {', '.join(OBJECTS)}; default: {' '.join(OBJECT_SIZES)}",
    )
    parser.add_argument(
        "--channels",
        nargs="+",
        type=int,
        default=[4, 8],
        metavar="N",
        help="of LPDDR3-1600, 6.4 GB/s each",
    )
    parser.add_argument(
        "--machines", nargs="+", default=list(MACHINES), metavar="PRESET", help="to compare"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
