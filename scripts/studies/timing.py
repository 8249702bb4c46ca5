"""Wall time of the model: of a design point of each machine, one simulation at a time, medians over
the repeats. `simulate` reads the scene, lays it out, renders the pictures that the frame is judged
by, simulates and writes everything. Makes

  timing                a line for each case, memory and machine
  design_point_seconds  of each machine the case that takes least and the one that takes most,
                        beside what NeRArch-Sim states of one of GSCore

On a machine with nothing else to do.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import statistics
from collections.abc import Sequence

import tables
from tables import SCENE, SIZE, Column
from runs import run_arguments
from runs.simulations import Run, keep_no_codebooks, simulate_all
from studies import cases
from studies.cases import Case

JOBS = ("results.py timing builtin:object builtin:outdoor yard park --repeats 2",)

# NeRArch-Sim (ISCA 2026), of a design point of GSCore.
PUBLISHED_SECONDS = 47.7

MACHINE = (
    Column("GB/s", "peak of the DRAM", "GB/s", ".1f"),
    Column("machine", "preset"),
)
SECONDS = (
    Column("simulation s", "in the SystemC kernel", "s", ".2f"),
    Column("whole command s", "of the call, the scene read and prepared", "s", ".2f"),
)
COLUMNS = (
    *(SCENE, SIZE, *MACHINE),
    Column("Gaussians", "of the scene", "", ","),
    *SECONDS,
    Column("peak MB", "host memory used, the most of the repeats", "MB", ",.0f"),
)
POINT_COLUMNS = (Column("of", "scene, or who states it"), SIZE, *MACHINE, *SECONDS)
ABOUT = (
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


def add_arguments(to: run_arguments.Parser) -> None:
    cases.add_arguments(to, ("gscore", "exact"), [4])
    to.add_argument("--view", type=int, default=0, help="number of a camera")
    to.add_argument("--repeats", type=int, default=3, help="of each; the median counts")


def make(arguments: argparse.Namespace) -> None:
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
    tables.write(arguments.out, "timing", by, COLUMNS, rows)
    tables.write(
        arguments.out, "design_point_seconds", by, POINT_COLUMNS, point_rows(points), ABOUT
    )
