"""What an exploration has judged so far, and its tables."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import pathlib
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence

import tables
from exploring.axes import Assignments, Space, label, scope_of
from exploring.judging import Judge, Judged, Task
from exploring.measures import NAMES
from runs.files import content_digest
from runs.simulations import Run, named_files, pareto_front, pictures_differ, with_pictures
from tables import Column

NOT_DRAWN = "not all views drawn"
PICTURE = "min(psnr_db)"
SETTING = "what was simulated, by its key"
# How a search ends; of a grid all is judged.
BY_ITSELF, BY_TIME, BY_TRIALS = "by itself", "by time", "by trials"
LONGER = "a longer search may find a better machine"
ENDS = {
    BY_ITSELF: "The search ended by itself.",
    BY_TIME: f"Time ended the search (--minutes): {LONGER}.",
    BY_TRIALS: f"Trials ended the search (--trials): {LONGER}.",
}


class Record:
    """For several threads."""

    def __init__(self, task: Task, names: Mapping[Assignments, str]):
        """names: of configurations that were given by name. remarks: what is to be said of all.
        ended: how a search did; empty: it goes on, or is none."""
        self.task, self.names = task, names
        self.ended = ""
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

    def held(self) -> list[Judged]:
        return [judged for judged in self.told() if judged.holds()]

    def open_yet(self) -> list[Judged]:
        """What holds so far and was not judged on all views: those with most views first, of these
        the best by costs."""
        found = [j for j in self.told() if j.dropped and max(j.violations, default=0) <= 0]
        return sorted(found, key=lambda judged: (-judged.drawn, judged.costs))

    def front(self) -> list[Judged]:
        """What holds and no other one that holds beats in what is to be small, nor in its picture
        where pictures differ. By costs."""
        held = self.held()
        pictures = [judged.psnr_db for judged in held]
        return on_front(held, with_pictures([judged.costs for judged in held], pictures))

    def cheapest(self) -> list[Judged]:
        """The same by what is to be small alone, which is what a search follows."""
        held = self.held()
        return on_front(held, [judged.costs for judged in held])

    def best(self) -> Judged | None:
        """For one objective."""
        return next(iter(self.cheapest()), None) if len(self.task.objectives) == 1 else None

    def shows_pictures(self) -> bool:
        """Whether they differ, and no column that was asked for says it."""
        asked = [*(o.measure for o in self.task.objectives), *self.task.shown]
        asked += [required.measure for required in self.task.requirements]
        told = NAMES["psnr_db"] in (measure.path for measure in asked)
        return not told and pictures_differ([judged.psnr_db for judged in self.held()])

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
        if self.shows_pictures():
            told.append(Column(PICTURE, "PSNR of the worst view; inf: equal", "dB", ".2f"))
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
            *(("" if judged.dropped else judged.psnr_db,) if self.shows_pictures() else ()),
            judged.slowest,
            judged.binding,
            *((self.names.get(judged.assignments, ""),) if self.names else ()),
            holds if self.task.requirements else "",
            "yes" if judged in front else "",
        )

    def about(self) -> str:
        required = " and ".join(r.text for r in self.task.requirements)
        held = len(self.held())
        text = f"{len(self.told())} configurations"
        text += f", of which {how_many_hold(held)} {required}" if required else ""
        said = [f"{text}; {len(self.front())} of them no other one beats." if held else f"{text}."]
        if self.ended:
            said[0] += f" {ENDS[self.ended]}"
        if held and required and (left := len(self.open_yet())):
            said.append(f"Not judged on all views, though none is missed so far: {left}.")
        if self.shows_pictures():
            said.append("Pictures differ, so that PSNR decides as well.")
        if none := self.none_holds():
            said.append(f"{none[:1].upper()}{none[1:]}.")
        return "\n\n".join(filter(None, [*said, *self.remarks, *self.not_told()]))

    def none_holds(self) -> str:
        """How many miss what is required, and by how much the nearest does; empty where one holds."""
        if self.held() or not self.task.requirements:
            return ""
        nearest = self.nearest()
        settings = f": {self.what_differs(nearest)}" if nearest else ""
        return f"none of {len(self.told())} holds: {self.why_none_holds()}{settings}"

    def write(self, out: pathlib.Path, name: str, program: pathlib.Path, remark: str = "") -> None:
        front = self.front()
        rows = [self.row(judged, front) for judged in self.told()]
        scenes = dict.fromkeys(scene for scene, _ in self.task.views)
        by = tables.made(program, [judged.provenance for judged in self.told()], scenes)
        only = {"holds": "yes" if self.task.requirements else "", "front": "yes"}
        search = {"judged": len(rows), "ended": self.ended}
        about = remark + self.about()
        tables.write(out, name, by, self.columns(rows), rows, about, only=only, more=search)

    def nearest(self) -> Judged | None:
        """Of those that miss what is required the one that misses it least."""
        missed = [judged for judged in self.told() if max(judged.violations, default=0) > 0]
        return min(missed, key=lambda judged: max(judged.violations), default=None)

    def missed(self) -> str:
        """How many miss what, and how many are open yet."""
        told, said = self.told(), []
        for n, required in enumerate(self.task.requirements):
            count = sum(judged.violations[n] > 0 for judged in told)
            if count:
                said.append(f"{count} {required.missed_in_words()} ({required.text})")
        if open_yet := len(self.open_yet()):
            said.append(f"{open_yet} not judged on all views")
        return ", ".join(said)

    def why_none_holds(self) -> str:
        """The same, and by how much the nearest one misses it."""
        words = self.missed()
        if not (nearest := self.nearest()):
            return words
        missed = max(nearest.violations)
        of = self.task.requirements[nearest.violations.index(missed)]
        more = " or more, not judged on all views" if nearest.dropped else ""
        more = "" if of in self.task.of_machines() else more
        return f"{words}; the nearest misses {of.text} by {missed:.1%}{more}"

    def so_far(self) -> str:
        """How many hold, and what the best of them comes to; else what holds so far, or what is
        missed."""
        if best := self.front():
            text = f"{len(best)} on the front, {self.objectives_of(best[0])}"
            if not self.task.requirements:
                return text
            held, left = len(self.held()), len(self.open_yet())
            more = f", {left} not judged on all views" if left else ""
            return f"{how_many_hold(held)}{more}; {text}"
        if open_yet := self.open_yet():
            most = open_yet[0]
            on = f"holds so far on {most.drawn} of {len(self.task.views)} views"
            words = filter(None, [self.objectives_of(most), self.what_differs(most)])
            return f"{on}: {', '.join(words)}; of {len(self.told())} {self.missed()}"
        return f"none of {len(self.told())} holds yet: {self.why_none_holds()}"

    def objectives_of(self, judged: Judged) -> str:
        """What it comes to in each, as far as that is known."""
        numbers = zip((o.name for o in self.task.objectives), self.numbers(judged))
        return ", ".join(f"{name} {value:.6g}" for name, value in numbers if value != "")

    def what_differs(self, judged: Judged) -> str:
        """Its settings that are not the same in all."""
        told = self.told()
        keys = [k for k in self.task.keys if len({str(j.settings[k]) for j in told}) > 1]
        return " ".join(f"{key}={judged.settings[key]}" for key in keys or self.task.keys)


def how_many_hold(count: int) -> str:
    return f"{count} {'holds' if count == 1 else 'hold'}"


def on_front(held: Sequence[Judged], points: Sequence[Sequence[float]]) -> list[Judged]:
    kept = (judged for judged, best in zip(held, pareto_front(points)) if best)
    return sorted(kept, key=lambda judged: judged.costs)


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

    def may_look(self, looked: float, most: float) -> bool:
        """Whether there are time and trials for another one; else that is what ends the search."""
        minutes = self.arguments.minutes
        if minutes and time.monotonic() - self.began >= 60 * minutes:
            self.made.ended = BY_TIME
            return False
        if looked >= most:
            self.made.ended = BY_TRIALS
            return False
        return True

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
        words.append(self.made.so_far())
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


def digests_of_files(work: Work) -> list[str]:
    """Of the contents of scenes, cameras, configuration and memspecs. Not of their paths, which may
    be others on another machine."""
    task = work.judge.task
    scenes = list(dict.fromkeys(scene for scene, _ in task.views))
    settings = [s for axis in work.space.axes for setting in axis.settings for s in setting]
    runs = [Run(scene, "", "", task.config, (*task.base, *settings)) for scene in scenes]
    runs += [Run(scenes[0], config=r.reference) for r in task.requirements if r.reference]
    return [content_digest(path) for run in runs for path in named_files(run)]


def described(work: Work, program: str) -> str:
    """All that a result depends on, but for the place in the space."""
    task = work.judge.task
    facts = {
        "program": program,
        "files": digests_of_files(work),
        "configurations": "proposed" if work.arguments.search else "all",
        "views": [[scene.name, number] for scene, number in task.views],
        "size": task.size,
        "stereo": task.stereo,
        "config": task.config,
        "base": list(task.base),
        "objectives": [o.name for o in task.objectives],
        "requirements": [r.text for r in task.requirements],
        "shown": [measure.text for measure in task.shown],
    }
    return json.dumps(facts)
