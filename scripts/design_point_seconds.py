#!/usr/bin/env python3
"""How long this model takes for one design point, beside what NeRArch-Sim states of one of GSCore:
`simulate` by itself, accurate, its scene read and prepared, one view, one call at a time.

Writes design_point_seconds.md: of each machine the scene and size that take least, and those that
take most. Wall times: on a machine with nothing else to do.

Without SCENE: the real scenes that there are, the built-in ones, and a built-in one of a million
Gaussians.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import sys
from collections.abc import Sequence

import machine_cases
from runs import run_arguments
from results import tables
from machine_cases import Case
from runs.simulations import Run, simulate_all

# NeRArch-Sim (ISCA 2026), of a design point of GSCore.
PUBLISHED_SECONDS = 47.7

ABOUT = (
    "Wall time of this model on the machine that made the table, one simulation at a time. "
    "One view of the scene and size that take least, and of those that take most. "
    "NeRArch-Sim (ISCA 2026) states neither scene nor size nor host here: "
    "its time is for the order of magnitude.\n\n"
)
HEAD = (
    "of", "size", "GB/s", "machine", "s to read and prepare the scene", "s of simulation", "s in all"
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Timed:
    """seconds: of the call, wall time. simulating: of them, in the SystemC kernel."""

    case: Case
    machine: str
    peak_gb_s: float
    seconds: float
    simulating: float

    def row(self) -> tuple:
        """In tenths of a second, which add up: the first is what the others leave."""
        simulating, in_all = (round(seconds, 1) for seconds in (self.simulating, self.seconds))
        of = (*self.case.cells(), f"{self.peak_gb_s:.1f}", self.machine)
        return (*of, *(f"{t:.1f}" for t in (in_all - simulating, simulating, in_all)))


def rows(points: Sequence[Timed]) -> list[tuple]:
    """The quickest and the slowest of each machine, below what is published."""
    unsaid = "not stated"
    published = (unsaid, unsaid, "gscore", unsaid, unsaid, f"{PUBLISHED_SECONDS}")
    made = [("NeRArch-Sim, published", *published)]
    for machine in dict.fromkeys(point.machine for point in points):
        of = sorted((p for p in points if p.machine == machine), key=lambda p: p.seconds)
        made += [point.row() for point in dict.fromkeys((of[0], of[-1]))]
    return made


def make(arguments: argparse.Namespace) -> None:
    cases = machine_cases.find_cases(arguments)
    asked = list(itertools.product(cases, arguments.channels, arguments.machines))
    runs = [
        Run(case.scene, arguments.view, case.size, machine, (f"dram.channels={channels}",))
        for case, channels, machine in asked
    ]
    points, views = [], []
    for (case, _, machine), outcome in zip(asked, simulate_all(arguments.streaminggs, runs, 1)):
        (view,) = outcome.accepted()
        simulating = view["host"]["simulation_wall_s"]
        peak = view["dram"]["peak_gb_s"]
        points.append(Timed(case, machine, peak, outcome.seconds, simulating))
        views.append(view)
    about = run_arguments.how_made(views) + ABOUT
    tables.write(arguments.out, "design_point_seconds", about, HEAD, rows(points))


def main() -> int:
    parser = run_arguments.parser(__doc__, "as said above")
    machine_cases.add_arguments(parser, ("gscore", "exact"), [4])
    parser.add_argument("--view", type=int, default=0, help="number of a camera")
    arguments = parser.parse_args()
    arguments.view = str(arguments.view)
    return run_arguments.main_of_tables(make, arguments)


if __name__ == "__main__":
    sys.exit(main())
