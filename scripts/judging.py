"""A configuration judged: what it costs, by how much it misses what is required, and which of its
views told."""

from __future__ import annotations

import dataclasses
import math
import threading
from collections.abc import Callable, Sequence

from runs.group_shapes import NAME as GROUP
from runs.group_shapes import shape_of
from machine_areas import SMALL, SMALL_SIZE
from measures import Measure, Objective, Requirement, value_at
from runs.scenes import Scene
from runs.simulations import Outcome, Run

Assignments = tuple[str, ...]
Simulate = Callable[[Run], Outcome]  # called from several threads


@dataclasses.dataclass(frozen=True)
class Judged:
    """costs: of the objectives, each to be small; values: of the measures that the requirements are
    about, and violations of these, as far as the views that were drawn tell; shown: of what else is
    to be shown. settings: what was simulated, by key. dropped: why not all views were drawn;
    refused, failed: what the command said. Nothing but what JSON can hold, since others read it out
    of a study."""

    assignments: Assignments
    costs: tuple[float, ...] = ()
    values: tuple[float, ...] = ()
    violations: tuple[float, ...] = ()
    shown: tuple[float, ...] = ()
    settings: dict[str, object] = dataclasses.field(default_factory=dict)
    drawn: int = 0
    slowest: str = ""  # view of those drawn
    binding: str = ""
    commit: str = ""
    dropped: str = ""
    refused: str = ""
    failed: str = ""

    def is_told(self) -> bool:
        """Whether it has numbers."""
        return not self.refused and not self.failed

    def holds(self) -> bool:
        """Whether it was judged to the end, and all that is required holds."""
        return self.is_told() and not self.dropped and all(v <= 0 for v in self.violations)


@dataclasses.dataclass(frozen=True)
class Task:
    """What a configuration is judged by. base: what all of them have set, which a configuration
    may set anew."""

    views: tuple[tuple[Scene, int], ...]
    keys: tuple[str, ...]  # of the settings to be shown
    size: str
    config: str
    base: Assignments
    objectives: tuple[Objective, ...]
    requirements: tuple[Requirement, ...]
    shown: tuple[Measure, ...] = ()  # that nothing is judged by

    def run(self, scene: Scene, view: int, assignments: Assignments) -> Run:
        return Run(scene, str(view), self.size, self.config, (*self.base, *assignments))

    def of_the_machine(self) -> bool:
        """Whether everything that is to be made small is known without a frame."""
        return all(o.measure.is_of_the_machine() for o in self.objectives)


class Judge:
    """Draws a configuration's views until one shows that a requirement is lost: those first which
    took longest of the configurations before. For several threads."""

    def __init__(self, task: Task, simulate: Simulate):
        self.task, self.simulate = task, simulate
        self.lock = threading.Lock()
        self.seconds = {(scene.name, view): math.inf for scene, view in task.views}

    def hardest_first(self) -> list[tuple[Scene, int]]:
        with self.lock:
            return sorted(self.task.views, key=lambda v: -self.seconds[v[0].name, v[1]])

    def machine_costs(self, assignments: Assignments) -> tuple[float, ...] | None:
        """What the objectives come to on the smallest frame there is, where that tells them; none
        where there is no such machine."""
        run = Run(SMALL, "0", SMALL_SIZE, self.task.config, (*self.task.base, *assignments))
        views = self.simulate(run).views
        return tuple(o.cost(views) for o in self.task.objectives) if views else None

    def judged(self, assignments: Assignments) -> Judged:
        """Raises ValueError where a report has no number that is asked for."""
        views: list[dict] = []
        dropped = ""
        for scene, number in self.hardest_first():
            outcome = self.simulate(self.task.run(scene, number, assignments))
            if outcome.failure:
                return Judged(assignments, failed=str(outcome.failure))
            if outcome.refused:
                return Judged(assignments, refused=f"{outcome.run.label()}: {outcome.refused}")
            views += [{**view, "scene_name": scene.name} for view in outcome.views]
            with self.lock:
                self.seconds[scene.name, number] = outcome.views[0]["frame"]["time_s"]
            lost = [r.text for r in self.task.requirements if r.is_lost(views)]
            if lost and len(views) < len(self.task.views):
                dropped = f"{lost[0]}: lost on {scene.name} {number}"
                break
        # Sums are the same however views were drawn.
        order = {(scene.name, n): i for i, (scene, n) in enumerate(self.task.views)}
        views.sort(key=lambda view: order[view["scene_name"], view["view"]])
        return self.summed(assignments, views, dropped)

    def summed(self, assignments: Assignments, views: Sequence[dict], dropped: str) -> Judged:
        slowest = max(views, key=lambda view: view["frame"]["time_s"])
        return Judged(
            assignments,
            costs=tuple(o.cost(views) for o in self.task.objectives),
            values=tuple(r.measure.of(views) for r in self.task.requirements),
            violations=tuple(r.violation(views) for r in self.task.requirements),
            shown=tuple(measure.of(views) for measure in self.task.shown),
            settings={key: setting(views[0]["config"], key) for key in self.task.keys},
            drawn=len(views),
            slowest=f"{slowest['scene_name']} {slowest['view']}",
            binding="+".join(sorted({view["binding"]["unit"] for view in views})),
            commit=views[0]["provenance"].get("commit", ""),
            dropped=dropped,
        )


def setting(config: dict, key: str) -> object:
    """The value that was simulated; empty where its machine has no such key."""
    if key == GROUP:
        return shape_of(config)
    value = value_at(config, key)
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else value
