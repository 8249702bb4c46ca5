"""What an exploration has judged so far, and its tables."""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
import sys
import threading
import time
from collections.abc import Mapping, Sequence

from runs import run_arguments
from results import tables
from judging import Assignments, Judge, Judged, Task
from measures import pareto_front
from search_space import Space

NOT_DRAWN = "not all views drawn"


class Exploration:
    """For several threads."""

    def __init__(self, task: Task, names: Mapping[Assignments, str]):
        """names: of configurations that were given by name."""
        self.task, self.names = task, names
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
        return [*numbers, *map(whole, judged.values)]

    def head(self) -> tuple[str, ...]:
        objectives = (o.name for o in self.task.objectives)
        shown = (measure.text for measure in self.task.shown)
        required = (r.name for r in self.task.requirements)
        names = ("beside",) if self.names else ()
        told = ("slowest view", "binding", *names, "holds", "front")
        return (*self.task.keys, *objectives, *shown, *required, *told)

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

    def markdown(self) -> str:
        front = self.front()
        shown = [self.row(judged, front)[:-2] for judged in front]
        text = run_arguments.how_made_at(judged.commit for judged in self.told())
        required = " and ".join(r.text for r in self.task.requirements)
        held = sum(judged.holds() for judged in self.told())
        text += f"{len(self.told())} configurations"
        text += f", of which {held} hold {required}" if required else ""
        text += f"; {len(front)} of them no other one beats.\n\n"
        text += tables.markdown(self.head()[:-2], shown) if front else ""
        return text + "".join(f"\n{line}\n" for line in self.not_told())

    def write(self, out: pathlib.Path, name: str, remark: str = "") -> None:
        front = self.front()
        rows = [self.row(judged, front) for judged in self.told()]
        text = remark + self.markdown()
        tables.write_text(out / f"{name}.csv", tables.csv_text(self.head(), rows))
        tables.write_text(out / f"{name}.md", text)
        print(text)


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
    made: Exploration
    began: float = dataclasses.field(default_factory=time.monotonic)
    reporting: threading.Lock = dataclasses.field(default_factory=threading.Lock)

    def has_time(self) -> bool:
        minutes = self.arguments.minutes
        return not minutes or time.monotonic() - self.began < 60 * minutes

    def progress(self, done: int, of: int) -> None:
        """A line: how many, the best, the time left as far as one can tell."""
        gone = time.monotonic() - self.began
        left = gone * (of - done) / max(done, 1)
        if self.arguments.minutes:
            left = min(left, 60 * self.arguments.minutes - gone)
        best = self.made.front()
        names = [o.name for o in self.judge.task.objectives]
        if not self.made.told():
            return
        text = "none holds yet"
        if best:
            numbers = zip(names, self.made.numbers(best[0]))
            text = f"{len(best)} on the front, " + ", ".join(f"{n} {v:.6g}" for n, v in numbers)
        print(
            f"[{done}/{of}] {text}; {max(left, 0) / 60:.1f} min left", file=sys.stderr, flush=True
        )
