#!/usr/bin/env python3
"""Wall time of a view; medians over the repeats, one simulation at a time. `whole command` is a
process that reads the scene, lays it out, renders the golden images, simulates and writes
everything. Writes timing.md."""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Sequence

from runs import run_arguments
from results import tables
from runs.scenes import find_scenes
from runs.simulations import Run, simulate_all

HEAD = ("scene", "size", "Gaussians", "preset", "simulation s", "whole command s", "peak MB")


def median(views: Sequence[dict], key: str) -> str:
    return f"{statistics.median(view['host'][key] for view in views):.2f}"


def make_table(arguments: argparse.Namespace) -> None:
    run_arguments.check_at_least("--repeats", arguments.repeats, 1)
    run_arguments.check_once("--configs", arguments.configs)
    rows, measured = [], []
    for scene in find_scenes(arguments.scenes):
        for config in arguments.configs:
            runs = [Run(scene, str(arguments.view), config=config)] * arguments.repeats
            outcomes = simulate_all(arguments.streaminggs, runs, side_by_side=1)
            views = [outcome.accepted()[0] for outcome in outcomes]
            measured += views
            rows.append(
                (
                    scene.name,
                    "{width_px}x{height_px}".format_map(views[0]["frame"]),
                    views[0]["scene"]["gaussians"],
                    config,
                    median(views, "simulation_wall_s"),
                    median(views, "wall_s"),
                    round(max(view["host"]["peak_rss_bytes"] for view in views) / 1e6),
                )
            )
    text = run_arguments.how_made(measured) + tables.markdown(HEAD, rows)
    tables.write_text(arguments.out / "timing.md", text)
    print(text)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    parser.add_argument("--view", type=int, default=0, help="number of a camera")
    parser.add_argument("--repeats", type=int, default=3, help="of each scene; the median counts")
    parser.add_argument(
        "--configs", nargs="+", default=["exact"], metavar="PRESET", help="preset or JSON file"
    )
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
