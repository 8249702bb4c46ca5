#!/usr/bin/env python3
"""Architecture exploration: simulates a grid or a list of configurations over scenes and views and
shows those that no other one beats in everything (the Pareto front).

  explore.py builtin:object --axis hfus=2,4,8 --axis hfu.ffu_lanes=8,16,32 --axis group_px=64,128

--axis KEY=V1,V2,... spans a grid; --points FILE takes a list instead, one configuration a line:
KEY=VALUE KEY=VALUE ... A configuration that needs more on-chip memory than the preset has is given
it: on-chip memory is what it costs, not what stops it. Any other refusal is printed at the end.

Objectives, all to be as small as possible, sums over the views simulated:
  cycles      frame cycles
  dram_bytes  bytes that units moved
  sram_bytes  on-chip memory that the configuration uses
  mac_lanes   multiply-accumulate lanes of all filters: hfus x (cfus x cfu_lanes + ffu_lanes)
or any number of a view's report.json by its path, such as `dram.row_conflicts`.
"""

from __future__ import annotations

import argparse
import itertools
import pathlib
import sys
from collections.abc import Callable, Sequence

import run_arguments
import tables
from scenes import find_scenes
from simulations import REPOSITORY, Outcome, Run, simulate_all, sram_bytes

Objectives = Sequence[float]


def mac_lanes(view: dict) -> int:
    hfu = view["config"]["hfu"]
    return view["config"]["hfus"] * (hfu["cfus"] * hfu["cfu_lanes"] + hfu["ffu_lanes"])


# Counts add up over views; what a configuration costs does not.
COUNTS: dict[str, Callable[[dict], float]] = {
    "cycles": lambda view: view["frame"]["cycles"],
    "dram_bytes": lambda view: view["dram"]["bytes"],
}
COSTS: dict[str, Callable[[dict], float]] = {"sram_bytes": sram_bytes, "mac_lanes": mac_lanes}


def report_value(view: dict, path: str) -> float:
    """A number of the report. Raises ValueError when there is none at the path."""
    value: object = view
    for key in path.split("."):
        value = value.get(key) if isinstance(value, dict) else None
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"--objectives: report.json has no number at '{path}'")
    return value


def objective(name: str, views: Sequence[dict]) -> float:
    if name in COSTS:
        return COSTS[name](views[0])
    count = COUNTS.get(name, lambda view: report_value(view, name))
    return sum(count(view) for view in views)


def dominates(a: Objectives, b: Objectives) -> bool:
    """a is nowhere worse than b, and somewhere better."""
    return all(x <= y for x, y in zip(a, b)) and any(x < y for x, y in zip(a, b))


def pareto_front(points: Sequence[Objectives]) -> list[bool]:
    """For each point, whether no other one dominates it."""
    return [not any(dominates(other, point) for other in points) for point in points]


def parse_axis(text: str) -> list[str]:
    """`KEY=V1,V2` as [`KEY=V1`, `KEY=V2`]. Raises ValueError."""
    key, equals, values = text.partition("=")
    if not key or not equals or not all(values.split(",")):
        raise ValueError(f"--axis: '{text}', expected KEY=VALUE,VALUE,...")
    return [f"{key}={value}" for value in values.split(",")]


def read_points(path: pathlib.Path) -> list[tuple[str, ...]]:
    """Configurations of a file, one a line; `#` begins a comment. Raises ValueError."""
    points = []
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        assignments = tuple(line.partition("#")[0].split())
        for assignment in assignments:
            if "=" not in assignment:
                raise ValueError(f"{path}:{number}: '{assignment}', expected KEY=VALUE")
        if assignments:
            points.append(assignments)
    return points


def configurations(arguments: argparse.Namespace) -> list[tuple[str, ...]]:
    if arguments.points:
        return read_points(arguments.points)
    return list(itertools.product(*(parse_axis(axis) for axis in arguments.axis)))


def explore(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    points = configurations(arguments)
    runs = [
        Run(
            scene,
            arguments.view,
            arguments.size,
            arguments.config,
            (*arguments.set, *point),
            arguments.timing,
        )
        for point in points
        for scene in scenes
    ]
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    built: list[tuple[tuple[str, ...], list[dict]]] = []
    refused: list[Outcome] = []
    for point in points:
        of_point = [next(outcomes) for _ in scenes]
        refused += [outcome for outcome in of_point[:1] if outcome.refused]
        if views := [view for outcome in of_point for view in outcome.views]:
            built.append((point, views))
    write(arguments, built, refused)


def write(
    arguments: argparse.Namespace,
    built: Sequence[tuple[tuple[str, ...], list[dict]]],
    refused: Sequence[Outcome],
) -> None:
    names = arguments.objectives.split(",")
    values = [[objective(name, views) for name in names] for _, views in built]
    front = pareto_front(values)
    keys = list(dict.fromkeys(a.partition("=")[0] for point, _ in built for a in point))

    rows = []
    for (point, views), of_point, best in zip(built, values, front):
        chosen = dict(a.split("=", 1) for a in point)
        binders = sorted({view["binding"]["unit"] for view in views})
        settings = [chosen.get(key, "") for key in keys]
        rows.append((*settings, *of_point, "+".join(binders), "yes" if best else ""))
    head = (*keys, *names, "binding", "pareto")
    tables.write_text(arguments.out / "explore.csv", tables.csv_text(head, rows))

    kept = sorted((row[:-1] for row in rows if row[-1]), key=lambda row: row[len(keys)])
    text = run_arguments.how_made(arguments, (view for _, views in built for view in views))
    text += f"{len(kept)} of {len(rows)} configurations are on the Pareto front.\n\n"
    text += tables.markdown(head[:-1], kept)
    text += "".join(f"\nRefused: `{' '.join(o.run.overrides)}`: {o.refused}\n" for o in refused)
    tables.write_text(arguments.out / "explore.md", text)
    print(text)


def main() -> int:
    parser = run_arguments.parser(__doc__, default_timing="fast")
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--axis", action="append", default=[], metavar="KEY=V1,V2,...")
    which.add_argument("--points", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    parser.add_argument("--size", default="", metavar="WxH", help="in px; default: the camera's")
    parser.add_argument("--config", default="exact", help="preset or JSON file to start from")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="for every configuration"
    )
    parser.add_argument(
        "--objectives", default="cycles,dram_bytes,sram_bytes,mac_lanes", metavar="NAME,..."
    )
    parser.add_argument("--out", type=pathlib.Path, default=REPOSITORY / "out")
    arguments = parser.parse_args()
    return run_arguments.main(lambda: explore(arguments))


if __name__ == "__main__":
    sys.exit(main())
