"""From a machine that holds a frame rate to one that is as small as it can be."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from kept_runs import KeptRuns
from machine_areas import Areas
from machine_axes import Machine
from scenes import Scene
from simulations import Run


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
            key = drawn[0].view["binding"].get("key", "")
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
