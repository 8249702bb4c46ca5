"""What an exploration has judged so far, and its tables."""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence

import tables
from exploring.axes import Assignments, label, scope_of
from exploring.judging import Judge, Judged, Task
from exploring.space import Space
from tables import Column
from runs.front import pareto_front
from runs.simulations import Run

NOT_DRAWN = "not all views drawn"
SETTING = "what was simulated, by its key"


class Record:
    """For several threads."""

    def __init__(self, task: Task, names: Mapping[Assignments, str]):
        """names: of configurations that were given by name. remarks: what is to be said of all."""
        self.task, self.names = task, names
        self.remarks: list[str] = []
        self.lock = threading.Lock()
        self.judged: dict[Assignments, Judged] = {}

    def add(self, judged: Judged) -> None:
        with self.lock:
            self.judged[judged.assignments] = judged

    def add_last(self, judged: Judged) -> None:
        """Behind all others."""
        with self.lock:
            self.judged.pop(judged.assignments, None)
            self.judged[judged.assignments] = judged

    def told(self) -> list[Judged]:
        """Those that have numbers."""
        with self.lock:
            return [judged for judged in self.judged.values() if judged.is_told()]

    def not_told(self) -> list[str]:
        """What was refused or failed, a line each."""
        with self.lock:
            refused = [f"Refused: {j.refused}" for j in self.judged.values() if j.refused]
            return refused + [f"Failed: {j.failed}" for j in self.judged.values() if j.failed]

    def front(self) -> list[Judged]:
        """What holds and no other one that holds beats: of equal ones the first. By costs."""
        held = [judged for judged in self.told() if judged.holds()]
        best = pareto_front([judged.costs for judged in held])
        return sorted((j for j, kept in zip(held, best) if kept), key=lambda j: j.costs)

    def best(self) -> Judged | None:
        """For one objective."""
        return next(iter(self.front()), None) if len(self.task.objectives) == 1 else None

    def numbers(self, judged: Judged) -> list[object]:
        """Objectives, then what else is shown, then what is required; of what was not drawn to the
        end only the last, since the others are not what they are elsewhere."""
        costs = zip(self.task.objectives, judged.costs)
        measured = [(o.measure, -cost if o.large else cost) for o, cost in costs]
        measured += zip(self.task.shown, judged.shown)
        numbers = [
            "" if judged.dropped and not measure.is_of_the_machine() else whole(value)
            for measure, value in measured
        ]
        return [*numbers, *("" if math.isnan(value) else whole(value) for value in judged.values)]

    def columns(self, rows: Sequence[Sequence[object]]) -> list[Column]:
        task = self.task
        told = [Column(key, SETTING) for key in task.keys]
        told += [
            Column(o.name, f"objective, to be {'large' if o.large else 'small'}, over all views")
            for o in task.objectives
        ]
        told += [Column(measure.text, "over all views") for measure in task.shown]
        told += [Column(r.name, "required, and what it came to") for r in task.requirements]
        for n in range(len(task.keys), len(told)):
            counts = all(isinstance(row[n], int) for row in rows if row[n] != "")
            told[n] = dataclasses.replace(told[n], form="," if counts else ".6g")
        told.append(Column("slowest view", "of those that were drawn"))
        told.append(Column("binding", "units that bind, of all views"))
        if self.names:
            told.append(Column("beside", "its name, where it was given beside"))
        told.append(Column("holds", "whether all that is required holds on all views"))
        told.append(Column("front", "whether it holds and no other one that holds beats it"))
        return told

    def row(self, judged: Judged, front: Sequence[Judged]) -> tuple:
        holds = "yes" if judged.holds() else (judged.dropped and NOT_DRAWN) or "no"
        return (
            *(judged.settings[key] for key in self.task.keys),
            *self.numbers(judged),
            judged.slowest,
            judged.binding,
            *((self.names.get(judged.assignments, ""),) if self.names else ()),
            holds if self.task.requirements else "",
            "yes" if judged in front else "",
        )

    def about(self) -> str:
        required = " and ".join(r.text for r in self.task.requirements)
        held = sum(judged.holds() for judged in self.told())
        text = f"{len(self.told())} configurations"
        text += f", of which {held} hold {required}" if required else ""
        said = [f"{text}; {len(self.front())} of them no other one beats."]
        if not held and (miss := self.nearest_miss()):
            said.append(f"None holds: {miss}.")
        return "\n\n".join(filter(None, [*said, *self.remarks, *self.not_told()]))

    def write(self, out: pathlib.Path, name: str, program: pathlib.Path, remark: str = "") -> None:
        front = self.front()
        rows = [self.row(judged, front) for judged in self.told()]
        scenes = dict.fromkeys(scene for scene, _ in self.task.views)
        by = tables.made(program, [judged.provenance for judged in self.told()], scenes)
        only = {"holds": "yes" if self.task.requirements else "", "front": "yes"}
        tables.write(out, name, by, self.columns(rows), rows, remark + self.about(), only=only)

    def nearest_miss(self) -> str:
        """Where none holds: what those that miss least miss, and by how much."""
        missed = [j.violations for j in self.told() if max(j.violations, default=0) > 0]
        if not missed:
            return ""
        least = min(missed, key=max)
        required = self.task.requirements[least.index(max(least))]
        return f"the nearest misses {required.text} by {max(least):.1%}"


def whole(value: float) -> float | int:
    """Counts without a fraction."""
    return int(value) if float(value).is_integer() and abs(value) < 2**53 else value


@dataclasses.dataclass
class Work:
    """What there is to explore, and what was found of it. began: on the clock of monotonic();
    reporting: held by the thread that says or writes something."""

    arguments: argparse.Namespace
    space: Space
    judge: Judge
    made: Record
    began: float = dataclasses.field(default_factory=time.monotonic)
    reporting: threading.Lock = dataclasses.field(default_factory=threading.Lock)

    def has_time(self) -> bool:
        minutes = self.arguments.minutes
        return not minutes or time.monotonic() - self.began < 60 * minutes

    def most(self) -> float:
        """How many configurations are looked at."""
        return self.arguments.trials or math.inf

    def progress(self, done: int, of: float) -> None:
        """A line: how many, the best, the time left as far as one can tell."""
        if not self.made.told():
            return
        gone = time.monotonic() - self.began
        left = gone * (of - done) / max(done, 1)
        if self.arguments.minutes:
            left = min(left, 60 * self.arguments.minutes - gone)
        words = [f"[{done}/{of}]" if math.isfinite(of) else f"[{done}]"]
        if best := self.made.front():
            numbers = zip((o.name for o in self.judge.task.objectives), self.made.numbers(best[0]))
            words.append(
                f"{len(best)} on the front, " + ", ".join(f"{n} {v:.6g}" for n, v in numbers)
            )
        else:
            words.append(", ".join(filter(None, ["none holds yet", self.made.nearest_miss()])))
        if math.isfinite(left):
            words[-1] += f"; {max(left, 0) / 60:.1f} min left"
        print(*words, file=sys.stderr, flush=True)

    def best_configurations(self, read: Callable[[Run], dict]) -> dict[str, dict]:
        """The best for one objective as configurations, by what tells their names apart: one for
        each scene where something is chosen for each. Memory is as large as all views need; what
        else a configuration leaves open stays so. read: every key of a run's configuration."""
        if not (best := self.made.best()):
            return {}
        task = self.judge.task
        views = self.judge.draw(best.assignments, task.views).views
        memories = [view["config"]["sram"] for view in views]
        sram = {key: max(memory[key] for memory in memories) for key in memories[0]}
        own = {scope_of(assignment) for assignment in best.assignments}
        runs = {
            f"_{scene.name}" if label(scene.name) in own else "": (scene, number)
            for scene, number in task.views
        }
        return {
            name: {**read(task.run(*view, best.assignments)), "sram": sram}
            for name, view in runs.items()
        }
