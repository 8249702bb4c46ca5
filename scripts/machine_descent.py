"""From a machine that holds a frame rate to one that is as small as it can be."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from runs.kept_runs import KeptRuns
from machine_areas import Areas
from machine_axes import Machine
from runs.scenes import Scene
from runs.simulations import Run

LEAST_GAIN = 1.003  # in frames a second: what a step is worth taking for


class TooSlow(Exception):
    """No machine that steps on the axes lead to is fast enough; the text says where they end."""


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
        """With more of what speeds up the slowest view, until that is fast enough. Raises TooSlow
        where no axis does."""
        while (drawn := self.draw_all(machine, view))[0].fps() < self.wanted_fps:
            machine = self.faster(machine, drawn[0])
        return machine, drawn

    def faster(self, machine: Machine, slowest: Drawn) -> Machine:
        """One step further: on the axis that the view's binding names, or where that has no more or
        gains nothing, on the one that gains most for its area."""
        ahead = {
            axis.name: more
            for which, axis in enumerate(machine.order.axes)
            if (more := self.areas.neighbour(machine, which, 1))
        }
        key = slowest.view["binding"].get("key", "")
        for names in ([key] if key in ahead else [], list(ahead)):
            number = str(slowest.view["view"])
            views = [(slowest.scene, number)]
            runs = [run for name in names for run in self.runs(ahead[name], views)]
            worth = {}
            for name, outcome in zip(names, self.kept.outcomes(runs)):
                fps = outcome.views[0]["frame"]["fps"] if outcome.views else 0
                if fps >= slowest.fps() * LEAST_GAIN:
                    taken = max(self.areas.of(ahead[name]) - self.areas.of(machine), 1e-3)
                    worth[name] = math.log(fps / slowest.fps()) / taken
            if worth:
                return ahead[max(worth, key=lambda name: worth[name])]
        raise TooSlow(
            f"none: {slowest.scene.name} has {slowest.fps():.1f} fps, and one step on any axis "
            f"gains less than {LEAST_GAIN - 1:.1%}"
        )

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
