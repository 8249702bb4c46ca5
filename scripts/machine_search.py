"""The search for the machine of an order that does best on several scenes within an area."""

from __future__ import annotations

import dataclasses
import math
import statistics
from collections.abc import Callable, Iterator, Sequence

from machine_areas import Areas, area_mm2
from machine_axes import Machine
from runs.scenes import Scene
from runs.simulations import Outcome, Run
from runs.view_numbers import decibels

OBJECTIVES: dict[str, Callable[[dict], float]] = {
    "cycles": lambda view: view["frame"]["cycles"],
    "bus bytes": lambda view: view["dram"]["bus_bytes"],
    "energy": lambda view: view["energy"]["total_j"],
}
BETTER = 0.001  # of the logarithm of the mean, to be taken for a gain
FREED = 0.003  # of the area allowed, to be taken where nothing is lost
UNKNOWN_HARM = 0.02


@dataclasses.dataclass(frozen=True)
class Point:
    """A machine on every scene, storage chosen for each."""

    machine: Machine
    storage: tuple[int, ...]
    scenes: tuple[Scene, ...]
    views: tuple[dict, ...]

    def mean(self, value: Callable[[dict], float]) -> float:
        return statistics.geometric_mean(max(value(view), 1e-30) for view in self.views)

    def area_mm2(self) -> float:
        return max(map(area_mm2, self.views))

    def stored(self, scene: int) -> str:
        return self.machine.order.storage.settings[self.storage[scene]][0]

    def overrides(self, scene: int) -> tuple[str, ...]:
        return (*self.machine.overrides(), self.stored(scene))


class Search:
    """Moves along one axis at a time, from a machine that fits. What takes too much area is paid
    for by steps back on other axes, those first that were seen to harm least for the area they
    free. Scenes are simulated two at a time, and a move is given up once it is clearly worse.
    points: every machine that was simulated on all scenes. harm: of a step back on each axis, as an
    earlier search has seen it. least_db: what the picture of each scene must have."""

    def __init__(
        self,
        areas: Areas,
        scenes: Sequence[Scene],
        size: str,
        budget_mm2: float,
        objective: str,
        most_runs: int,
        harm: dict[int, float] | None = None,
        least_db: Sequence[float] | None = None,
    ):
        self.areas, self.kept = areas, areas.kept
        self.scenes, self.size = tuple(scenes), size
        self.budget_mm2, self.value = budget_mm2, OBJECTIVES[objective]
        self.runs_left = most_runs
        self.least_db = least_db
        self.points: list[Point] = []
        self.harm = dict(harm or {})
        self.seen: set[tuple] = set()

    def fitted(self, machine: Machine, raised: int = -1) -> Machine | None:
        """The machine with steps back until it fits; None where that is not enough."""
        area = self.areas.of(machine)
        while area is not None and area > self.budget_mm2:
            # More than what is needed is worth nothing.
            too_much = area - self.budget_mm2
            prices: list[tuple[float, int, Machine]] = []
            for which in range(len(machine.at)):
                back = self.areas.step_back(machine, which) if which != raised else None
                if back and back[1] > 0:
                    harm = max(self.harm.get(which, UNKNOWN_HARM), BETTER)
                    prices.append((harm / min(back[1], too_much), which, back[0]))
            if not prices:
                return None
            machine = min(prices, key=lambda price: price[:2])[2]
            area = self.areas.of(machine)
        return None if area is None else machine

    def run(self, machine: Machine, storage: Sequence[int], scene: int) -> Run:
        stored = machine.order.storage.settings[storage[scene]]
        overrides = (*machine.overrides(), *stored)
        return Run(self.scenes[scene], "0", self.size, machine.order.preset, overrides)

    def as_stored(
        self, machine: Machine, storage: Sequence[int], scene: int, outcome: Outcome
    ) -> tuple[int, dict] | None:
        """How the scene is stored, and its view: as it was simulated or, where its picture is not
        good enough so, as near to that as it is."""
        if outcome.refused or not self.small(outcome.views[0]):
            return None
        at, views = storage[scene], outcome.views
        others = sorted(
            range(len(machine.order.storage.settings)), key=lambda to: abs(to - storage[scene])
        )
        while not views or not self.allowed(views[0], scene):
            others.pop(0)
            if not others or self.runs_left <= 0:
                return None
            at = others[0]
            trial = [at if n == scene else s for n, s in enumerate(storage)]
            self.runs_left -= 1
            views = self.kept.outcome(self.run(machine, trial, scene)).views
        return at, views[0]

    def measure(
        self, machine: Machine, storage: Sequence[int], against: Point | None
    ) -> tuple[float, Point | None]:
        """How much worse it is than another point: the mean logarithm of the ratio, over the scenes
        simulated before it was given up; and the point, if it was not. Infinite where a scene
        is refused, the machine is larger on a scene than it may be, or no storage gives the picture
        that there must be."""
        views: list[dict] = []
        chosen = list(storage)
        worse = 0.0
        for first in range(0, len(self.scenes), 2):
            numbers = range(first, min(first + 2, len(self.scenes)))
            self.runs_left -= len(numbers)
            outcomes = self.kept.outcomes([self.run(machine, storage, n) for n in numbers])
            for n, outcome in zip(numbers, outcomes):
                if not (found := self.as_stored(machine, storage, n, outcome)):
                    return math.inf, None
                chosen[n] = found[0]
                views.append(found[1])
            if against:
                pairs = zip(views, against.views)
                worse = statistics.fmean(math.log(self.value(a) / self.value(b)) for a, b in pairs)
                # Others may still make up for these.
                if len(views) < len(self.scenes) and worse > 0.06 / len(views):
                    return worse, None
        point = Point(machine, tuple(chosen), self.scenes, tuple(views))
        self.points.append(point)
        return worse, point

    def small(self, view: dict) -> bool:
        return area_mm2(view) <= self.budget_mm2 * 1.0001

    def allowed(self, view: dict, scene: int) -> bool:
        good = not self.least_db or decibels(view) >= self.least_db[scene]
        return good and self.small(view)

    def frees(self, machine: Machine, best: Point) -> bool:
        area = self.areas.of(machine)
        return area is not None and best.area_mm2() - area > FREED * self.budget_mm2

    def taken(self, machine: Machine, best: Point) -> tuple[float, Point | None]:
        """A machine that is better, or as good and smaller; it is not looked at twice."""
        key = (machine.at, best.storage)
        if key in self.seen or self.runs_left <= 0:
            return math.inf, None
        self.seen.add(key)
        worse, point = self.measure(machine, best.storage, best)
        if point is None:
            return worse, None
        if worse < -BETTER or (worse < BETTER and self.frees(machine, best)):
            return worse, point
        return worse, None

    def moves(self, point: Point) -> Iterator[tuple[int, int]]:
        """Axes and steps: back where that was seen to gain; on, what holds most scenes first; then
        back."""
        axes = range(len(point.machine.at))
        gains = [which for which in axes if self.harm.get(which, 0) < -BETTER]
        yield from ((which, -1) for which in sorted(gains, key=lambda w: self.harm[w]))
        held_by = [view["binding"].get("key", "") for view in point.views]
        named = {which: held_by.count(point.machine.order.axes[which].name) for which in axes}
        yield from ((which, 1) for which in sorted(axes, key=lambda w: -named[w]))
        yield from ((which, -1) for which in axes)

    def look_back(self, machine: Machine, storage: Sequence[int]) -> None:
        """What a step back on each axis harms, on the first two scenes."""
        few = range(min(2, len(self.scenes)))

        def costs(of: Machine) -> list[float]:
            self.runs_left -= len(few)
            outcomes = self.kept.outcomes([self.run(of, storage, n) for n in few])
            return [self.value(o.views[0]) if o.views else math.inf for o in outcomes]

        now = costs(machine)
        for which in range(len(machine.at)):
            if back := self.areas.step_back(machine, which):
                ratios = [math.log(a / b) for a, b in zip(costs(back[0]), now)]
                self.harm[which] = statistics.fmean(ratios)

    def descend(self, best: Point) -> Point:
        """The point from which no move is better, or where the runs end."""
        improved = True
        while improved and self.runs_left > 0:
            improved = False
            for which, step in self.moves(best):
                while moved := self.areas.neighbour(best.machine, which, step):
                    fits = self.fitted(moved, which)
                    worse, point = self.taken(fits, best) if fits else (math.inf, None)
                    if step < 0 and math.isfinite(worse):
                        self.harm[which] = worse
                    if point is None:
                        break
                    best, improved = point, True
            chosen = self.stored_better(best)
            improved = improved or chosen is not best
            best = chosen
        return best

    def stored_better(self, best: Point) -> Point:
        """Each scene stored as it does best on this machine. Each way it is given up where two
        settings in a row are no better."""
        settings = best.machine.order.storage.settings
        storage, views = list(best.storage), list(best.views)
        for step in (-1, 1):
            trial = list(storage)
            misses = dict.fromkeys(range(len(self.scenes)), 0)
            while misses and self.runs_left > 0:
                trial = [s + step if n in misses else s for n, s in enumerate(trial)]
                misses = {n: of for n, of in misses.items() if 0 <= trial[n] < len(settings)}
                self.runs_left -= len(misses)
                runs = [self.run(best.machine, trial, n) for n in misses]
                for n, outcome in zip(list(misses), self.kept.outcomes(runs)):
                    if self.is_better(outcome, views[n], n):
                        storage[n], views[n], misses[n] = trial[n], outcome.views[0], 0
                    else:
                        misses[n] += 1
                misses = {n: of for n, of in misses.items() if of < 2}
        if tuple(storage) == best.storage:
            return best
        point = Point(best.machine, tuple(storage), self.scenes, tuple(views))
        self.points.append(point)
        return point

    def is_better(self, outcome: Outcome, than: dict, scene: int) -> bool:
        if outcome.refused or not self.allowed(outcome.views[0], scene):
            return False
        return self.value(outcome.views[0]) < self.value(than) * (1 - BETTER)

    def best_from(self, machine: Machine, storage: Sequence[int]) -> Point | None:
        """The best point found from a start; None where nothing on the way to the area draws all
        scenes."""
        point = None
        if not self.harm:
            self.look_back(machine, storage)
            point = self.best_of_first_axis(machine, storage)
        elif start := self.fitted(machine):
            _, point = self.measure(start, storage, None)
        return self.descend(self.stored_better(point)) if point else None

    def best_of_first_axis(self, machine: Machine, storage: Sequence[int]) -> Point | None:
        """The machine within the area that does best, of one for each setting of the first axis:
        the memory that a group takes decides what is left for all else, so that single steps do not
        lead from one to another."""
        best: Point | None = None
        settings = range(len(machine.order.axes[0].settings))
        # From the start's own outward, so that what is hopeless is given up early.
        for to in sorted(settings, key=lambda at: abs(at - machine.at[0])):
            moved = machine.moved(0, to - machine.at[0])
            fits = moved and self.fitted(moved, 0)
            if fits:
                worse, point = self.measure(fits, storage, best)
                best = point if point and (best is None or worse < 0) else best
        return best
