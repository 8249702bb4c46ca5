"""A configuration judged: what it costs, by how much it misses what is required, and which of its
views told."""

from __future__ import annotations

import dataclasses
import functools
import math
import threading
from collections.abc import Callable, Mapping, Sequence

from exploring.axes import (
    STRUCTURE,
    Assignments,
    At,
    Axis,
    Space,
    key_of,
    label,
    nearest,
    of_scene,
    scope_of,
    sizes_memory,
)
from exploring.measures import EACH, NAMES, Measure, Objective, Requirement, number_at
from runs.scenes import Scene
from runs.simulations import GROUP, Outcome, Run, shape_of, value_at

Simulate = Callable[[Sequence[Run]], Sequence[Outcome]]  # called from several threads
View = tuple[Scene, int]

# Area is that of the machine, whatever it draws: the smallest frame there is tells it.
SMALL = Scene("area", "builtin:object?n=500")
SMALL_SIZE = "64x36"
NOT_DRAWN = "is lost by any frame"


@dataclasses.dataclass(frozen=True)
class Judged:
    """costs: of the objectives, each to be small; values: of the measures that the requirements are
    about, and violations of these, as far as the views that were drawn tell; shown: of what else is
    to be shown. psnr_db: of the worst view; NaN: not known. settings: what was simulated, by key.
    dropped: why not all views were drawn; refused, failed: what the command said. Nothing but what
    JSON can hold, since others read it out of a study."""

    assignments: Assignments
    costs: tuple[float, ...] = ()
    values: tuple[float, ...] = ()
    violations: tuple[float, ...] = ()
    shown: tuple[float, ...] = ()
    psnr_db: float = math.nan
    settings: dict[str, object] = dataclasses.field(default_factory=dict)
    drawn: int = 0
    slowest: str = ""  # view of those drawn
    binding: str = ""
    provenance: dict[str, str] = dataclasses.field(default_factory=dict)
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
    may set anew; so it may what the beginning's memories decided, by label of a scene, and "" for
    the first one's machine. open_memories: settings that size none. stereo: as the option."""

    views: tuple[View, ...]
    keys: tuple[str, ...]  # of the settings to be shown
    size: str
    config: str
    base: Assignments
    objectives: tuple[Objective, ...]
    requirements: tuple[Requirement, ...]
    shown: tuple[Measure, ...] = ()  # that nothing is judged by
    decided: Mapping[str, Assignments] = dataclasses.field(default_factory=dict)
    open_memories: Assignments = ()
    stereo: str = ""

    def run(self, scene: Scene, view: int, assignments: Assignments) -> Run:
        own = of_scene(assignments, label(scene.name))
        run = Run(scene, str(view), self.size, self.config, stereo=self.stereo)
        return self.with_memories(run, self.decided.get(label(scene.name), ()), own)

    def small_run(self, assignments: Assignments) -> Run:
        run = Run(SMALL, "0", SMALL_SIZE, self.config, stereo=self.stereo)
        return self.with_memories(run, self.decided.get("", ()), assignments)

    def with_memories(self, run: Run, decided: Assignments, own: Assignments) -> Run:
        """As large as the configuration needs; but where it sizes one itself, which then decides
        what is left open."""
        if sizes_memory(self.base) or sizes_memory(own):
            sized = (*self.open_memories, *self.base, *own)
            return dataclasses.replace(run, overrides=sized)
        fitted = (*self.base, *decided, *own)
        return dataclasses.replace(run, overrides=fitted, fit_memories=True)

    def of_the_machine(self) -> bool:
        """Whether everything that is to be made small is known without a frame."""
        return all(o.measure.is_of_the_machine() for o in self.objectives)

    def of_machines(self) -> list[Requirement]:
        """Bounds that any frame may show to be missed: no other frame has less."""
        return [
            r
            for r in self.requirements
            if r.measure.is_of_the_machine() and not r.least and r.measure.aggregate != EACH
        ]


def relative_to(task: Task, simulate: Simulate) -> Task:
    """With the bounds of requirements that are relative to a configuration. Raises ValueError where
    that is refused, Failure."""

    def resolved(required: Requirement) -> Requirement:
        if not required.reference:
            return required
        # The memories of a preset are for one eye.
        eyes = {"fit_memories": bool(task.stereo), "stereo": task.stereo}
        runs = [Run(s, str(n), task.size, required.reference, **eyes) for s, n in task.views]
        drawn = zip(task.views, simulate(runs))
        return required.relative_to([named(o.accepted()[0], scene) for (scene, _), o in drawn])

    return dataclasses.replace(task, requirements=tuple(map(resolved, task.requirements)))


def named(view: dict, scene: Scene) -> dict:
    return {**view, "scene_name": scene.name}


@dataclasses.dataclass(frozen=True)
class Drawn:
    """Reports of views, in the order in which they were asked for; refused, failed: why there are
    not all."""

    views: tuple[dict, ...] = ()
    refused: str = ""
    failed: str = ""


class Judge:
    """Draws a configuration's views until one shows that a requirement is lost: those first which
    took longest of the configurations before. For several threads."""

    def __init__(self, task: Task, simulate: Simulate):
        self.task, self.simulate = task, simulate
        self.lock = threading.Lock()
        self.seconds = {(scene.name, view): math.inf for scene, view in task.views}

    def hardest_first(self) -> list[View]:
        with self.lock:
            return sorted(self.task.views, key=lambda v: -self.seconds[v[0].name, v[1]])

    def machine(self, assignments: Assignments) -> tuple[dict, ...]:
        """The smallest frame that there is, once for each way of storing scenes; none where there
        is no such machine."""
        scopes = dict.fromkeys([*filter(None, map(scope_of, assignments))] or [""])
        ways = dict.fromkeys(of_scene(assignments, scope) for scope in scopes)
        outcomes = self.simulate([self.task.small_run(way) for way in ways])
        found = [named(view, SMALL) for outcome in outcomes for view in outcome.views]
        return tuple(found) if len(found) == len(ways) else ()

    def machine_costs(self, assignments: Assignments) -> tuple[float, ...] | None:
        """What the objectives come to where any frame tells them; none where there is no such
        machine."""
        views = self.machine(assignments)
        return tuple(o.cost(views) for o in self.task.objectives) if views else None

    def lost_by_any_frame(self, assignments: Assignments) -> str:
        """What is required of a machine and this one has not; empty where there is none."""
        required = self.task.of_machines()
        views = self.machine(assignments) if required else ()
        return next((r.text for r in required if views and r.violation(views) > 0), "")

    def draw(self, assignments: Assignments, views: Sequence[View]) -> Drawn:
        """Views side by side, and all of them."""
        return self.draw_each([assignments], views)[0]

    def draw_each(
        self, configurations: Sequence[Assignments], views: Sequence[View]
    ) -> list[Drawn]:
        """The same of several configurations, all of them side by side."""
        runs = [self.task.run(*view, each) for each in configurations for view in views]
        outcomes = iter(self.simulate(runs))
        return [self.drawn(views, [next(outcomes) for _ in views]) for _ in configurations]

    def drawn(self, views: Sequence[View], outcomes: Sequence[Outcome]) -> Drawn:
        found: list[dict] = []
        for (scene, number), outcome in zip(views, outcomes):
            if outcome.failure:
                return Drawn(failed=str(outcome.failure))
            if outcome.refused:
                return Drawn(refused=f"{outcome.run.label()}: {outcome.refused}")
            found += [named(view, scene) for view in outcome.views]
            with self.lock:
                self.seconds[scene.name, number] = outcome.views[0]["frame"]["time_s"]
        return Drawn(tuple(found))

    def lost(self, views: Sequence[dict]) -> str:
        """What is required and no further view can mend; empty where there is none. A scene's mean
        is told by all its views together."""
        names = [scene.name for scene, _ in self.task.views]
        drawn = [view["scene_name"] for view in views]
        whole = [v for v in views if drawn.count(v["scene_name"]) == names.count(v["scene_name"])]
        for required in self.task.requirements:
            of = whole if required.measure.aggregate == EACH else views
            if of and required.is_lost(of):
                return required.text
        return ""

    def judged(self, assignments: Assignments) -> Judged:
        """Raises ValueError where a report has no number that is asked for."""
        if lost := self.lost_by_any_frame(assignments):
            return self.not_drawn(assignments, f"{lost}: {NOT_DRAWN}")
        views: list[dict] = []
        for scene, number in self.hardest_first():
            drawn = self.draw(assignments, [(scene, number)])
            if not drawn.views:
                return Judged(assignments, refused=drawn.refused, failed=drawn.failed)
            views += drawn.views
            lost = self.lost(views)
            if lost and len(views) < len(self.task.views):
                return self.summed(assignments, views, f"{lost}: lost on {scene.name} {number}")
        return self.summed(assignments, views)

    def not_drawn(self, assignments: Assignments, why: str) -> Judged:
        """With what any frame tells; what only frames tell has no number."""
        views = self.machine(assignments)

        def told(measure: Measure) -> float:
            return measure.of(views) if measure.is_of_the_machine() else math.nan

        required, bounds = self.task.requirements, self.task.of_machines()
        return Judged(
            assignments,
            costs=tuple(
                -told(o.measure) if o.large else told(o.measure) for o in self.task.objectives
            ),
            values=tuple(r.value(views) if r in bounds else math.nan for r in required),
            violations=tuple(r.violation(views) if r in bounds else 0.0 for r in required),
            shown=tuple(map(told, self.task.shown)),
            settings=self.settings(views),
            provenance=provenance(views[0]),
            dropped=why,
        )

    def summed(self, assignments: Assignments, views: Sequence[dict], dropped: str = "") -> Judged:
        # Sums are the same however views were drawn.
        order = {(scene.name, n): i for i, (scene, n) in enumerate(self.task.views)}
        views = sorted(views, key=lambda view: order[view["scene_name"], view["view"]])
        slowest = max(views, key=lambda view: view["frame"]["time_s"])
        return Judged(
            assignments,
            costs=tuple(o.cost(views) for o in self.task.objectives),
            values=tuple(r.value(views) for r in self.task.requirements),
            violations=tuple(r.violation(views) for r in self.task.requirements),
            shown=tuple(measure.of(views) for measure in self.task.shown),
            psnr_db=worst_psnr_db(views),
            settings=self.settings(views),
            drawn=len(views),
            slowest=f"{slowest['scene_name']} {slowest['view']}",
            binding="+".join(sorted({view["binding"]["unit"] for view in views})),
            provenance=provenance(views[0]),
            dropped=dropped,
        )

    def settings(self, views: Sequence[dict]) -> dict[str, object]:
        """A scene's own off a view of it."""
        of = {label(view["scene_name"]): view["config"] for view in views}
        of[""] = views[0]["config"]
        return {key: setting(of.get(scope_of(key), {}), key_of(key)) for key in self.task.keys}

    def start(self, space: Space) -> At:
        """The configuration that the preset is nearest to. A view tells how its scene is stored and
        what memory it takes, any frame the rest."""
        first = {label(scene.name): (scene, number) for scene, number in reversed(self.task.views)}

        @functools.cache
        def config(scope: str) -> dict:
            if not scope:
                (outcome,) = self.simulate([self.task.small_run(())])
                return outcome.accepted()[0]["config"]
            (outcome,) = self.simulate([self.task.run(*first[scope], ())])
            (view,) = outcome.accepted()
            stored = {
                k: v for k, v in view["scene"].items() if v and k in view["config"]["storage"]
            }
            return {**view["config"], "storage": {**view["config"]["storage"], **stored}}

        def scope(axis: Axis) -> str:
            memory = any(s.startswith("sram.") for setting in axis.settings for s in setting)
            return axis.scope or (label(self.task.views[0][0].name) if memory else "")

        return tuple(nearest(axis, config(scope(axis))) for axis in space.axes)


Amount = Callable[[At], float]  # of a machine that there is


class Machines:
    """What machines of a space take of the one objective, where any frame tells it, and of what is
    allowed; each is asked for once."""

    def __init__(self, space: Space, judge: Judge):
        self.space, self.judge, self.task = space, judge, judge.task
        (self.objective,) = self.task.objectives
        self.taken: dict[Assignments, tuple[float, float] | None] = {}
        self.backs: dict[tuple, tuple[int, float] | None] = {}

    def machine(self, at: At) -> tuple[float, float] | None:
        """What it takes, and how much of what is allowed; None: there is no such machine."""
        machine = self.space.machine(at)
        if machine not in self.taken:
            views = self.judge.machine(machine)
            self.taken[machine] = self.taken_by(views) if views else None
        return self.taken[machine]

    def taken_by(self, views: Sequence[dict]) -> tuple[float, float]:
        share = 1 + max((r.violation(views) for r in self.task.of_machines()), default=-1)
        return self.objective.cost(views) if self.task.of_the_machine() else share, share

    def size(self, at: At) -> float | None:
        machine = self.machine(at)
        return machine and machine[0]

    def share(self, at: At) -> float | None:
        """More than 1: too large."""
        machine = self.machine(at)
        return machine and machine[1]

    def neighbour(self, at: At, which: int, step: int) -> At | None:
        """The next one along an axis that there can be."""
        moved = self.space.moved(at, which, step)
        while moved and self.size(moved) is None:
            moved = self.space.moved(moved, which, step)
        return moved

    def back(self, at: At, which: int, of: Amount) -> tuple[At, float] | None:
        """The next one with less on an axis, and about how much that frees of size or share: as
        much as it did for the last one that was alike in structure."""
        alike = [n for axis, n in zip(self.space.axes, at) if axis.name in STRUCTURE]
        key = (of.__name__, which, at[which], *alike)
        if key not in self.backs:
            back = self.neighbour(at, which, -1)
            self.backs[key] = back and (back[which], of(at) - of(back))
        if not (known := self.backs[key]):
            return None
        return self.space.moved(at, which, known[0] - at[which]), known[1]


def worst_psnr_db(views: Sequence[dict]) -> float:
    """NaN where a report says nothing of its picture."""
    if not all("image" in view for view in views):
        return math.nan
    return min(number_at(view, NAMES["psnr_db"]) for view in views)


def provenance(view: dict) -> dict[str, str]:
    return {key: view["provenance"].get(key, "") for key in ("commit", "version")}


def setting(config: dict, key: str) -> object:
    """The value that was simulated; empty where its machine has no such key."""
    if key == GROUP and config:
        return shape_of(config)
    value = value_at(config, key)
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else value
