#!/usr/bin/env python3
"""What an estimate is worth: seeded random machines on scenes, each simulated and reckoned, and how
far the reckoned numbers are from the simulated ones.

  estimate_error.py truck yard platform --configurations 200

Machines are points of the axes that searches use (machine_axes.py), one choice of each axis drawn
alike; on-chip memory is as large as the rest needs. What the command refuses is counted and drawn
no further. Both runs are kept (estimate_accurate.jsonl, estimate_reckoned.jsonl): started again the
script goes on where it ended.

Writes estimate_error.md: errors of cycles, bytes and energy over all frames (median, 95th of 100,
worst, and the mean with its sign), seconds a frame, whether machines come in the same order
(Kendall's tau-b), and how many of the machines that no other beats in both time and area the
estimate finds; estimate_error.csv, a line a frame; and estimate_error.svg and .png.
"""

from __future__ import annotations

import argparse
import dataclasses
import os
import random
import statistics
import sys
import time

import run_arguments
import tables
from figures_beside import draw_beside
from machine_axes import ORDERS, Machine, Order
from scenes import Scene, find_scenes
from simulations import Run
from sweep_server import SweepServer

ORDERS_ESTIMATED = ("exact", "paper")
MEASURES = (
    ("cycles", lambda view: view["frame"]["cycles"]),
    ("bytes", lambda view: view["dram"]["bytes"]),
    ("energy", lambda view: view["energy"]["total_j"]),
)
HEAD = ("of", "error of", "median %", "p95 %", "worst %", "mean %", "frames")
CSV_HEAD = (
    "scene", "machine", "settings", "mm2", "cycles", "cycles_estimated", "bytes",
    "bytes_estimated", "energy_j", "energy_j_estimated", "seconds", "seconds_estimated",
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Frame:
    """One machine on one scene, in both reports."""

    scene: str
    machine: int
    settings: str
    accurate: dict
    estimate: dict

    def error(self, of) -> float:
        return of(self.estimate) / of(self.accurate) - 1


def draw_machines(order: Order, count: int, seed: int) -> list[Machine]:
    draw = random.Random(seed)
    drawn = [tuple(draw.randrange(len(a.settings)) for a in order.axes) for _ in range(count)]
    return [Machine(order, at) for at in drawn]


def reports(server: SweepServer, runs: list[Run]) -> tuple[list[dict | None], float]:
    """Of each run its view's report, None for a refused one; and the seconds that all took.
    Raises ValueError with the last reason where all are refused."""
    began = time.monotonic()
    outcomes = server.outcomes(runs)
    server.end()
    if not any(o.views for o in outcomes):
        raise ValueError(f"all configurations are refused: {outcomes[-1].refused}")
    return [o.views[0] if o.views else None for o in outcomes], time.monotonic() - began


def tau_b(a: list[float], b: list[float]) -> float:
    """Kendall's rank correlation; ties count for neither side. nan where all are tied."""
    both, of_a, of_b = 0, 0, 0
    for i in range(len(a)):
        for j in range(i):
            x, y = (a[i] > a[j]) - (a[i] < a[j]), (b[i] > b[j]) - (b[i] < b[j])
            both, of_a, of_b = both + x * y, of_a + (x != 0), of_b + (y != 0)
    return both / (of_a * of_b) ** 0.5 if of_a and of_b else float("nan")


def front(points: dict[int, tuple[float, float]]) -> set[int]:
    """Those that no other one beats in both numbers, which are to be small."""

    def beats(a: tuple[float, float], b: tuple[float, float]) -> bool:
        return a != b and a[0] <= b[0] and a[1] <= b[1]

    return {i for i, p in points.items() if not any(beats(q, p) for q in points.values())}


def error_rows(frames: list[Frame], scenes: list[str]) -> list[tuple]:
    rows = []
    for scene in [*scenes, "all"]:
        of_scene = [f for f in frames if scene in (f.scene, "all")]
        for name, of in MEASURES:
            errors = [100 * f.error(of) for f in of_scene]
            sizes = sorted(map(abs, errors))
            p95 = sizes[min(len(sizes) - 1, round(0.95 * (len(sizes) - 1)))]
            numbers = (statistics.median(sizes), p95, sizes[-1], statistics.mean(errors))
            rows.append((scene, name, *(f"{n:.2f}" for n in numbers), len(sizes)))
    return rows


def rank_lines(frames: list[Frame], scenes: list[str]) -> list[str]:
    lines = []
    for scene in scenes:
        of_scene = [f for f in frames if f.scene == scene]
        taus = [
            f"{name} {tau_b(*([of(r(f)) for f in of_scene] for r in SIDES)):.3f}"
            for name, of in MEASURES
        ]
        lines.append(f"Kendall's tau-b on {scene}: {', '.join(taus)}.\n")
    complete = [
        m for m in {f.machine for f in frames} if sum(f.machine == m for f in frames) == len(scenes)
    ]
    fronts = []
    for report in SIDES:
        points = {}
        for machine in complete:
            views = [report(f) for f in frames if f.machine == machine]
            seconds = sum(v["frame"]["time_s"] for v in views)
            points[machine] = (seconds, max(v["area_mm2"]["total"] for v in views))
        fronts.append(front(points))
    found = len(fronts[0] & fronts[1])
    lines.append(
        f"Of the {len(fronts[0])} machines of {len(complete)} that no other beats in time (of all "
        f"scenes together) and area, the estimate finds {found}; it names {len(fronts[1])}.\n"
    )
    return lines


SIDES = (lambda f: f.accurate, lambda f: f.estimate)


def csv_rows(frames: list[Frame]) -> list[tuple]:
    return [
        (
            f.scene,
            f.machine,
            f.settings,
            f.accurate["area_mm2"]["total"],
            *(of(r(f)) for _, of in MEASURES for r in SIDES),
            *(r(f)["host"]["simulation_wall_s"] for r in SIDES),
        )
        for f in frames
    ]


def compared_frames(scenes: list[Scene], arguments: argparse.Namespace) -> tuple[list[Frame], int]:
    """Frames that both sides drew, and how many were refused. Raises ValueError where all were,
    Failure."""
    order = ORDERS[arguments.machine]
    machines = draw_machines(order, arguments.configurations, arguments.seed)
    runs = [
        Run(scene, str(arguments.view), arguments.size, order.preset, machine.overrides())
        for machine in machines
        for scene in scenes
    ]
    sides = []
    for name, options in (("reckoned", ("--estimate",)), ("accurate", ())):
        kept = arguments.out / f"estimate_{name}.jsonl"
        with SweepServer(arguments.streaminggs, kept, arguments.jobs, options) as server:
            views, seconds = reports(server, runs)
            print(f"{name}: {len(runs)} frames in {seconds:.0f} s, {server.simulated} of them new")
        sides.append(views)
    frames = [
        Frame(run.scene.name, at // len(scenes), " ".join(machines[at // len(scenes)].settings()),
              accurate, estimate)
        for at, (run, estimate, accurate) in enumerate(zip(runs, *sides))
        if accurate and estimate
    ]  # fmt: skip
    if not frames:
        raise ValueError("each configuration is refused by one side")
    return frames, len(runs) - len(frames)


def make_table(arguments: argparse.Namespace) -> None:
    run_arguments.check_at_least("--configurations", arguments.configurations, 1)
    run_arguments.check_at_least("--view", arguments.view, 0)
    scenes: list[Scene] = find_scenes(arguments.scenes)
    frames, refused = compared_frames(scenes, arguments)
    names = [scene.name for scene in scenes]
    walls = [[r(f)["host"]["simulation_wall_s"] for f in frames] for r in SIDES]
    text = (
        run_arguments.how_made(f.accurate for f in frames)
        + f"{len(frames)} frames, {refused} refused.\n\n"
        + tables.markdown(HEAD, error_rows(frames, names))
        + "\n"
        + "\n".join(rank_lines(frames, names))
        + f"\nA frame takes {statistics.median(walls[0]):.2f} s simulated and "
        f"{statistics.median(walls[1]):.2f} s reckoned (medians).\n"
    )
    print(text, end="")
    tables.write_text(arguments.out / "estimate_error.md", text)
    rows = tables.csv_text(CSV_HEAD, csv_rows(frames))
    tables.write_text(arguments.out / "estimate_error.csv", rows)
    draw_beside(arguments.out, "estimate_error")


def main() -> int:
    parser = run_arguments.parser(__doc__)
    parser.add_argument("--configurations", type=int, default=200, help="machines")
    parser.add_argument("--seed", type=int, default=1, help="that they are drawn by")
    parser.add_argument("--machine", choices=ORDERS_ESTIMATED, default="exact", help="order")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="of the frames")
    parser.add_argument("--view", type=int, default=0, help="one number")
    parser.add_argument(
        "-j", "--jobs", type=int, default=os.cpu_count(), help="frames side by side"
    )
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
