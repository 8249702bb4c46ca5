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
import subprocess
import sys
from collections.abc import Sequence

import machine_cases
import machine_ratios
from runs import run_arguments
from results import tables
from runs.gpu_views import MODEL, model_gpu
from runs.kept_runs import KeptRuns
from machine_cases import Case, sizes_of
from machine_measures import GPU, modelled, simulated
from machine_tables import (
    ABOUT,
    CHARACTER_HEAD,
    HEAD,
    PARTS_TABLES,
    Entry,
    Parts,
    PartsTable,
    character_row,
    parts_rows,
    row,
)
from runs.simulations import REPOSITORY, Run, said
from runs.sweep_server import SweepServer
from runs.view_numbers import view_numbers

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


def runs_of(
    arguments: argparse.Namespace, cases: Sequence[Case]
) -> dict[tuple[Case, str, int], list[Run]]:
    """Of each case of one scene, machine and number of channels: a run for every view."""
    views = view_numbers(arguments.streaminggs, cases[0].scene, arguments.view)
    return {
        (case, machine, channels): [
            Run(case.scene, str(view), case.size, machine, (f"dram.channels={channels}",))
            for view in views
        ]
        for case in cases
        for machine in arguments.machines
        for channels in arguments.channels
    }


def measure_scene(
    arguments: argparse.Namespace, cases: Sequence[Case]
) -> tuple[list[Entry], set[str]]:
    """Of the cases of one scene, and the commits that the reports name. Raises ValueError for what
    is refused, Failure for what failed, when all else has been simulated and kept."""
    asked = runs_of(arguments, cases)
    program, kept = arguments.streaminggs, arguments.out / RUNS_FILE
    # A server of its own: it holds all ways in which the machines want their scene stored.
    with SweepServer(program, kept, arguments.side_by_side) as server:
        answered = iter(server.outcomes([run for runs in asked.values() for run in runs]))
        server.end()
    entries, commits = [], set()
    for (case, machine, _), runs in asked.items():
        views = [view for _ in runs for view in next(answered).accepted()]
        commits.update(view["provenance"].get("commit", "") for view in views)
        entries.append(Entry(case, machine, simulated(views)))
    print(f"{cases[0].scene.name}: {server.simulated} frames", file=sys.stderr, flush=True)
    return entries, commits


def measure(arguments: argparse.Namespace, cases: Sequence[Case]) -> tuple[list[Entry], str]:
    """And how it was made."""
    kept = KeptRuns(
        arguments.streaminggs, arguments.out / GPU_RUNS_FILE, arguments.side_by_side, model_gpu
    )
    entries, commits = [], set()
    for _, of_scene in itertools.groupby(cases, key=lambda case: case.scene):
        more, of = measure_scene(arguments, list(of_scene))
        entries, commits = entries + more, commits | of
    gpu_runs = [Run(case.scene, arguments.view, case.size, MODEL) for case in cases]
    for case, outcome in zip(cases, kept.outcomes(gpu_runs)):
        entries.append(Entry(case, GPU, modelled(outcome)))
    # Of each case in turn, memory by memory, the GPU last.
    place = {case: at for at, case in enumerate(cases)}
    entries.sort(key=lambda e: (place[e.case], e.machine == GPU, e.of.peak_gb_s))
    return entries, run_arguments.how_made_at(commits)


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
    cases = machine_cases.find_cases(arguments)
    entries, made = measure(arguments, cases)
    out = arguments.out
    tables.write(out, "compare_machines", made + ABOUT, HEAD, list(map(row, entries)))
    ratios = machine_ratios.rows(entries, size_groups(cases, arguments), arguments.machines)
    about = made + machine_ratios.ABOUT
    tables.write(out, "compare_machines_ratios", about, machine_ratios.HEAD, ratios)
    of_cases = machine_ratios.case_rows(entries, cases)
    about = made + machine_ratios.CASES_ABOUT
    tables.write(out, "compare_machines_cases", about, machine_ratios.CASE_HEAD, of_cases)
    parts = (lambda m: m.bytes_by_region, lambda m: m.joules_by_component, lambda m: m.busy)
    for of, what in zip(parts, PARTS_TABLES):
        write_parts(out, made, entries, of, what)
    shown = [e for e in entries if e.machine in (GPU, "gscore")]
    characters = list(map(character_row, shown))
    tables.write(out, "characterisation", made, CHARACTER_HEAD, characters)
    draw(out)


def main() -> int:
    parser = run_arguments.parser(__doc__, "as said above")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    machine_cases.add_arguments(parser, MACHINES, [4, 8])
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
