#!/usr/bin/env python3
"""The smallest machine of exact order that holds a frame rate on every view of the given scenes.

From the preset resources are taken away a step at a time, on the axes that fair_fight.py searches:
that step first which frees most area for the time it costs on the hardest view. A step after which
that view is too slow is not tried again. When none is left every view is drawn; one that turns out
to be too slow becomes a hardest view beside the first, and the descent begins again. Where the
preset itself is too slow, it first gets more of what binds the slowest view. Memory channels stay;
on-chip memory is as large as the rest needs.

Writes smallest_machine.md, a line for each size, and each machine as a configuration in
smallest_machine_SIZE.json. What was simulated is kept in smallest_machine_runs.jsonl.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import sys
from collections.abc import Sequence

import run_arguments
import tables
from fair_fight_tables import assigned_document, settings_text
from kept_runs import KeptRuns
from machine_areas import Areas, start_of
from machine_axes import EXACT, Machine
from scenes import Scene, find_scenes, shared_names
from simulations import Run

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


class TooSlow(Exception):
    """No machine on the axes is fast enough; the text says what more of was wanted."""


@dataclasses.dataclass(frozen=True)
class Drawn:
    scene: Scene
    view: dict

    def fps(self) -> float:
        return self.view["frame"]["fps"]


class Descent:
    """From a machine that holds the rate to one from which every step back is too slow."""

    def __init__(self, kept: KeptRuns, scenes: Sequence[Scene], size: str, wanted_fps: float):
        self.kept, self.scenes, self.size, self.wanted_fps = kept, scenes, size, wanted_fps
        self.areas = Areas(kept)
        self.hardest: list[tuple[Scene, int]] = []

    def runs(self, machine: Machine, views: Sequence[tuple[Scene, str]]) -> list[Run]:
        overrides = machine.overrides()
        return [Run(s, v, self.size, machine.order.preset, overrides) for s, v in views]

    def draw_all(self, machine: Machine, view: str) -> list[Drawn]:
        """The views of all scenes, the slowest first."""
        runs = self.runs(machine, [(scene, view) for scene in self.scenes])
        drawn = [
            Drawn(outcome.run.scene, v)
            for outcome in self.kept.outcomes(runs)
            for v in outcome.accepted()
        ]
        return sorted(drawn, key=Drawn.fps)

    def slowest_fps(self, machine: Machine) -> float:
        """Of the hardest views, up to the first that is too slow; 0 where one is refused."""
        slowest = math.inf
        for scene, view in self.hardest:
            (run,) = self.runs(machine, [(scene, str(view))])
            outcome = self.kept.outcome(run)
            if outcome.refused:
                return 0
            slowest = min(slowest, outcome.views[0]["frame"]["fps"])
            if slowest < self.wanted_fps:
                break
        return slowest

    def grown(self, machine: Machine, view: str) -> tuple[Machine, list[Drawn]]:
        """With more of what binds the slowest view, until that is fast enough. Raises TooSlow where
        no axis has more of it."""
        while (drawn := self.draw_all(machine, view))[0].fps() < self.wanted_fps:
            key = drawn[0].view["binding"]["key"]
            names = [a.name for a in machine.order.axes]
            more = machine.moved(names.index(key), 1) if key in names else None
            if more is None:
                name = drawn[0].scene.name
                raise TooSlow(f"none: {name} has {drawn[0].fps():.1f} fps, no more of '{key}'")
            machine = more
        return machine, drawn

    def shrunk(self, machine: Machine) -> Machine:
        """No step back holds the rate on the hardest views."""
        fps = self.slowest_fps(machine)
        # Area freed for the time lost, by axis, as last seen: it is looked at again before a step.
        worth = {which: math.inf for which in range(len(machine.at))}
        while worth:
            which = max(worth, key=lambda w: worth[w])
            back = self.areas.step_back(machine, which)
            slower = self.slowest_fps(back[0]) if back and back[1] > 0 else 0
            if slower < self.wanted_fps:
                del worth[which]
                continue
            now = back[1] / max(math.log(fps / slower), 1e-4)
            if now >= max((w for other, w in worth.items() if other != which), default=0):
                machine, fps = back[0], slower
            worth[which] = now
        return machine

    def smallest(self, machine: Machine, drawn: Sequence[Drawn], view: str) -> tuple:
        """A machine and all views as it draws them."""
        while True:
            slowest = (drawn[0].scene, drawn[0].view["view"])
            if slowest in self.hardest:
                raise ValueError(f"{slowest[0].name}: is too slow alone, not among other views")
            self.hardest.append(slowest)
            small = self.shrunk(machine)
            drawn = self.draw_all(small, view)
            if drawn[0].fps() >= self.wanted_fps:
                return small, drawn


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


def make_tables(arguments: argparse.Namespace) -> None:
    if arguments.fps <= 0:
        raise ValueError(f"--fps: {arguments.fps:g}, expected more than 0")
    scenes = find_scenes(arguments.scenes or shared_names() or [])
    kept = KeptRuns(arguments.streaminggs, arguments.out / RUNS_FILE, arguments.side_by_side)
    rows, measured = [], []
    for size in arguments.sizes:
        descent = Descent(kept, scenes, size, arguments.fps)
        preset = start_of(EXACT, kept)
        before = descent.draw_all(preset, arguments.view)
        measured += [d.view for d in before]
        try:
            grown, drawn = descent.grown(preset, arguments.view)
        except TooSlow as why:
            wanted = f"{arguments.fps:g}"
            rows.append((size, wanted, *[""] * (len(HEAD) - 3), str(why)))
            continue
        machine, drawn = descent.smallest(grown, drawn, arguments.view)
        rows.append(row(size, arguments.fps, machine, drawn, before))
        document = assigned_document(machine.overrides(), [d.view for d in drawn])
        path = arguments.out / f"smallest_machine_{size}.json"
        tables.write_text(path, json.dumps(document, indent=2) + "\n")
    text = run_arguments.how_made(measured) + tables.markdown(HEAD, rows)
    tables.write_text(arguments.out / "smallest_machine.md", text)
    print(text)
    kept.end()


def main() -> int:
    parser = run_arguments.parser(__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--fps", type=float, default=90, help="of the slowest view")
    parser.add_argument(
        "--sizes", nargs="+", default=["1280x720", "2560x1440"], metavar="WxH", help="in px"
    )
    parser.add_argument("--view", default="all", help="numbers of cameras, as in 0,2, or all")
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
