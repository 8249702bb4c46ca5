#!/usr/bin/env python3
"""The smallest machine of exact order that holds a frame rate on every view of the given scenes.

From the preset resources are taken away a step at a time, on the axes that fair_fight.py searches:
that step first which frees most area for the time it costs on the hardest view. A step after which
that view is too slow is not tried again. When none is left every view is drawn; one that turns out
to be too slow becomes a hardest view beside the first, and the descent begins again. Where the
preset itself is too slow, it first gets more of what the slowest view's binding names, or where
that gains nothing, of what gains most for its area. Memory channels stay; on-chip memory is as
large as the rest needs.

Writes smallest_machine.md, a line for each size, and each machine as a configuration in
smallest_machine_SIZE.json. What was simulated is kept in smallest_machine_runs.jsonl.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import sys
from collections.abc import Sequence

from runs import run_arguments
from results import tables
from fair_fight_tables import assigned_document, settings_text
from runs.kept_runs import KeptRuns
from machine_areas import start_of
from machine_axes import EXACT, Machine
from machine_descent import Descent, Drawn, TooSlow
from runs.scenes import Scene, find_scenes, shared_names

RUNS_FILE = "smallest_machine_runs.jsonl"
HEAD = (
    "size px",
    "fps wanted",
    "mm2",
    "low .. high",
    "W, most",
    "mJ, most",
    "fps, worst view",
    "which",
    "at the start: fps",
    "at the start: mm2",
    "setting",
)


def row(
    size: str, wanted: float, machine: Machine, drawn: Sequence[Drawn], before: Sequence[Drawn]
) -> tuple:
    first = drawn[0]
    area = first.view["area_mm2"]["bands"]["total"]
    return (
        size,
        f"{wanted:g}",
        f"{area['middle']:.2f}",
        f"{area['low']:.2f} .. {area['high']:.2f}",
        f"{max(d.view['energy']['mean_power_w'] for d in drawn):.2f}",
        f"{max(d.view['energy']['total_j'] for d in drawn) * 1e3:.2f}",
        f"{first.fps():.1f}",
        f"{first.scene.name} {first.view['view']}",
        f"{before[0].fps():.0f}",
        f"{before[0].view['area_mm2']['total']:.2f}",
        settings_text(machine),
    )


def found(
    arguments: argparse.Namespace, kept: KeptRuns, scenes: Sequence[Scene], size: str
) -> tuple[tuple, list[dict]]:
    """A line of the table, and the views that it is of."""
    descent = Descent(kept, scenes, size, arguments.fps)
    preset = start_of(EXACT, kept.outcome)
    before = descent.draw_all(preset, arguments.view)
    try:
        grown, drawn = descent.grown(preset, arguments.view)
    except TooSlow as why:
        line = (size, f"{arguments.fps:g}", *[""] * (len(HEAD) - 3), str(why))
        return line, [d.view for d in before]
    machine, drawn = descent.smallest(grown, drawn, arguments.view)
    views = [d.view for d in drawn]
    document = assigned_document(kept.binary, machine, views)
    path = arguments.out / f"smallest_machine_{size}.json"
    tables.write_text(path, json.dumps(document, indent=2) + "\n")
    return row(size, arguments.fps, machine, drawn, before), views


def make_tables(arguments: argparse.Namespace) -> None:
    run_arguments.check_above_zero("--fps", arguments.fps)
    run_arguments.check_once("--sizes", arguments.sizes)
    scenes = find_scenes(arguments.scenes or shared_names())
    kept = KeptRuns(arguments.streaminggs, arguments.out / RUNS_FILE, arguments.side_by_side)
    # A descent looks at one view at a time; sizes know nothing of each other.
    with concurrent.futures.ThreadPoolExecutor(kept.workers) as pool:
        waiting = [pool.submit(found, arguments, kept, scenes, size) for size in arguments.sizes]
        try:
            lines = [each.result() for each in waiting]
        finally:
            pool.shutdown(cancel_futures=True)
    made = run_arguments.how_made(view for _, views in lines for view in views)
    text = made + tables.markdown(HEAD, [line for line, _ in lines])
    tables.write_text(arguments.out / "smallest_machine.md", text)
    print(text)
    kept.end()


def main() -> int:
    parser = run_arguments.parser(__doc__, "all real scenes")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--fps", type=float, default=90, help="of the slowest view")
    parser.add_argument(
        "--sizes", nargs="+", default=["1280x720", "2560x1440"], metavar="WxH", help="in px"
    )
    parser.add_argument("--view", default="all", help="numbers of cameras, as in 0,2, or all")
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
