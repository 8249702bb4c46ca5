#!/usr/bin/env python3
"""Wall time of a view, accurate and fast timing in turn, so that both meet the same machine;
medians over the repeats. `whole command` is a process that reads the scene, lays it out, renders both
golden images, simulates and writes everything."""

from __future__ import annotations

import argparse
import pathlib
import statistics
import sys

import run_arguments
import tables
from scenes import find_scenes
from simulations import REPOSITORY, Failure, Run, simulate_all

MODES = ("accurate", "fast")
HEAD = (
    "scene",
    "Gaussians",
    "order",
    "accurate: simulation s",
    "whole command s",
    "fast: simulation s",
    "whole command s",
    "fast / accurate: cycles",
    "bytes",
    "peak MB",
)


def make_table(arguments: argparse.Namespace) -> None:
    if arguments.repeats < 1:
        raise ValueError(f"--repeats: {arguments.repeats}, expected at least 1")
    rows, measured = [], []
    for scene in find_scenes(arguments.scenes):
        for order in arguments.orders:
            runs = [
                Run(scene, arguments.view, config=order, timing=mode)
                for _ in range(arguments.repeats)
                for mode in MODES
            ]
            views = []
            for outcome in simulate_all(arguments.streaminggs, runs, side_by_side=1):
                if outcome.refused:
                    raise Failure(f"{outcome.run.label()}: {outcome.refused}")
                views.append(outcome.views[0])
            accurate, fast = views[0::2], views[1::2]
            measured += views

            def median(of: list[dict], key: str) -> str:
                return f"{statistics.median(view['host'][key] for view in of):.2f}"

            rows.append(
                (
                    scene.name,
                    views[0]["scene"]["gaussians"],
                    order,
                    median(accurate, "simulation_wall_s"),
                    median(accurate, "wall_s"),
                    median(fast, "simulation_wall_s"),
                    median(fast, "wall_s"),
                    f"{fast[0]['frame']['cycles'] / accurate[0]['frame']['cycles']:.2f}",
                    f"{fast[0]['dram']['bytes'] / accurate[0]['dram']['bytes']:.3f}",
                    round(max(view["host"]["peak_rss_bytes"] for view in views) / 1e6),
                )
            )
    text = run_arguments.how_made(arguments, measured) + tables.markdown(HEAD, rows)
    tables.write_text(arguments.out / "timing.md", text)
    print(text)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    run_arguments.add_scenes(parser)
    parser.add_argument("--view", type=int, default=0, help="number of a camera")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--orders", nargs="+", choices=("exact", "paper"), default=["exact"])
    parser.add_argument("--out", type=pathlib.Path, default=REPOSITORY / "out")
    arguments = parser.parse_args()
    arguments.view = str(arguments.view)
    return run_arguments.main(lambda: make_table(arguments))


if __name__ == "__main__":
    sys.exit(main())
