#!/usr/bin/env python3
"""Architecture exploration: simulates a grid or a list of configurations over scenes and views and
shows those that no other one beats in everything (the Pareto front).

  explore.py builtin:object --axis hfus=2,4,8 --axis hfu.ffu_lanes=8,16,32 --axis group=64,160x120

--axis KEY=V1,V2,... spans a grid; --points FILE takes a list instead, one configuration a line:
KEY=VALUE KEY=VALUE ... Every configuration gets as much input and shared on-chip memory as it
needs, unless --set, --axis or the list say how much: memory is what it costs, not what stops it,
and no other size follows from it. What the command refuses is printed at the end. The tables show
what was simulated: values as the resolved configuration has them, the size of the
pixel group always among them: `group=SHAPE` stands for both of its sides.

Objectives, all to be as small as possible:
  cycles        frame cycles, sum over the views simulated
  dram_bytes    bytes that units moved, sum over the views
  sram_bytes    on-chip memory
  filter_lanes  multiply-accumulate lanes of coarse and fine filters, and of nothing else:
                hfus x (cfus x cfu_lanes + ffu_lanes)
or any number of a view's report.json by its path, such as `area_mm2.total`, which has every lane
and memory there is, or `dram.row_conflicts`: a sum over the views, but for what an accelerator has
or is (`config`, `sram`, `area_mm2`).

Writes explore.csv and explore.md. An exploration that is interrupted or fails midway leaves what it
has simulated so far as explore_partial.csv and .md.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import pathlib
import sys
from collections.abc import Iterator, Sequence

import run_arguments
import tables
from group_shapes import NAME, expanded, shape_of
from objectives import objective, pareto_front, value_at
from scenes import Scene, find_scenes
from simulations import SRAM_AS_NEEDED, Failure, Outcome, Run, simulate_all

Assignments = tuple[str, ...]


def parse_axis(text: str) -> list[str]:
    """`KEY=V1,V2` as [`KEY=V1`, `KEY=V2`]. Raises ValueError."""
    key, equals, values = text.partition("=")
    if not key or not equals or not all(values.split(",")):
        raise ValueError(f"--axis: '{text}', expected KEY=VALUE,VALUE,...")
    assignments = [f"{key}={value}" for value in values.split(",")]
    if len(set(assignments)) < len(assignments):
        raise ValueError(f"--axis: '{text}', expected different values")
    return assignments


def parse_axes(texts: Sequence[str]) -> list[list[str]]:
    """Raises ValueError, also where two axes set one key: the later would win unseen."""
    axes = [parse_axis(text) for text in texts]
    keys = [a.partition("=")[0] for axis in axes for a in expanded((axis[0],))]
    for key in keys:
        if keys.count(key) > 1:
            raise ValueError(f"--axis: {key}: there are two")
    return axes


def read_points(path: pathlib.Path) -> list[Assignments]:
    """Configurations of a file, one a line; `#` begins a comment. Raises ValueError."""
    points = []
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), start=1):
        assignments = tuple(line.partition("#")[0].split())
        for assignment in assignments:
            if "=" not in assignment:
                raise ValueError(f"{path}:{number}: '{assignment}', expected KEY=VALUE")
        if assignments:
            points.append(assignments)
    if not points:
        raise ValueError(f"{path}: no configurations, expected KEY=VALUE ... on each line")
    return points


def configurations(arguments: argparse.Namespace) -> list[Assignments]:
    if arguments.points:
        return read_points(arguments.points)
    return list(itertools.product(*parse_axes(arguments.axis)))


@dataclasses.dataclass(frozen=True)
class Point:
    """A configuration that was simulated in every scene."""

    assignments: Assignments
    views: tuple[dict, ...]
    values: tuple[float, ...]  # of the objectives

    def setting(self, key: str) -> object:
        """The value that was simulated; empty where its machine has no such key."""
        if key == NAME:
            return shape_of(self.views[0]["config"])
        value = value_at(self.views[0]["config"], key)
        if isinstance(value, bool):
            return str(value).lower()
        return "" if value is None else value


class Exploration:
    """What has been simulated so far."""

    def __init__(self, objectives: Sequence[str]):
        self.objectives = objectives
        self.points: list[Point] = []
        self.refused: list[Outcome] = []

    def add(self, assignments: Assignments, outcomes: Sequence[Outcome]) -> None:
        """Takes a configuration's outcomes, one for each scene."""
        if refused := [outcome for outcome in outcomes if outcome.refused]:
            self.refused.append(refused[0])
            return
        views = tuple(view for outcome in outcomes for view in outcome.views)
        values = tuple(objective(name, views) for name in self.objectives)
        self.points.append(Point(assignments, views, values))

    def head(self) -> tuple[str, ...]:
        keys = [a.partition("=")[0] for point in self.points for a in point.assignments]
        return (*dict.fromkeys([*keys, NAME]), *self.objectives, "binding", "pareto")

    def rows(self) -> list[tuple]:
        keys = self.head()[: -len(self.objectives) - 2]
        rows = []
        for point, best in zip(self.points, pareto_front([p.values for p in self.points])):
            binders = sorted({view["binding"]["unit"] for view in point.views})
            settings = [point.setting(key) for key in keys]
            rows.append((*settings, *point.values, "+".join(binders), "yes" if best else ""))
        return rows

    def markdown(self) -> str:
        head, rows = self.head(), self.rows()
        first_objective = len(head) - len(self.objectives) - 2
        kept = sorted((row[:-1] for row in rows if row[-1]), key=lambda row: row[first_objective])
        text = run_arguments.how_made(view for point in self.points for view in point.views)
        text += f"{len(kept)} of {len(rows)} configurations are on the Pareto front.\n\n"
        text += tables.markdown(head[:-1], kept)
        return text + "".join(f"\nRefused: {o.run.label()}: {o.refused}\n" for o in self.refused)

    def write(self, out: pathlib.Path, name: str, remark: str = "") -> None:
        text = remark + self.markdown()
        tables.write_text(out / f"{name}.csv", tables.csv_text(self.head(), self.rows()))
        tables.write_text(out / f"{name}.md", text)
        print(text)


def run_of(arguments: argparse.Namespace, scene: Scene, point: Assignments) -> Run:
    overrides = expanded((*SRAM_AS_NEEDED, *arguments.set, *point))
    return Run(scene, arguments.view, arguments.size, arguments.config, overrides)


def simulate_points(
    arguments: argparse.Namespace, scenes: Sequence[Scene], points: Sequence[Assignments]
) -> Iterator[tuple[Assignments, list[Outcome]]]:
    """Each configuration with its outcomes, one for each scene."""
    runs = [run_of(arguments, scene, point) for point in points for scene in scenes]
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    for point in points:
        yield point, [next(outcomes) for _ in scenes]


def explore(arguments: argparse.Namespace) -> None:
    points = configurations(arguments)
    scenes = find_scenes(arguments.scenes)
    made = Exploration(arguments.objectives.split(","))
    try:
        for point, outcomes in simulate_points(arguments, scenes, points):
            made.add(point, outcomes)
    except (KeyboardInterrupt, Failure, ValueError):
        if made.points:
            done = len(made.points) + len(made.refused)
            remark = f"Not complete: {done} of {len(points)} configurations.\n\n"
            made.write(arguments.out, "explore_partial", remark)
        raise
    if not made.points:
        made.refused[0].accepted()
    made.write(arguments.out, "explore")


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument(
        "--axis", action="append", default=[], metavar="KEY=V1,V2,...", help="any number of them"
    )
    which.add_argument(
        "--points", type=pathlib.Path, metavar="FILE", help="a list in place of a grid"
    )
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    parser.add_argument("--size", default="", metavar="WxH", help="in px; default: the camera's")
    parser.add_argument("--config", default="exact", help="preset or JSON file to start from")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="for every configuration"
    )
    parser.add_argument(
        "--objectives",
        default="cycles,dram_bytes,sram_bytes,filter_lanes,area_mm2.total",
        metavar="NAME,...",
        help="numbers to make small",
    )
    return run_arguments.main_of_tables(explore, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
