"""An exploration by a study: what workers do, in threads of one script or in many scripts."""

from __future__ import annotations

import concurrent.futures
import json
import random
import warnings

import optuna
from exploring.judging import Judged
from exploring.record import Work
from exploring.space import At
from exploring.study import JUDGED, SAME_AS, Study, locked, open_storage, sampler, unpacked
from runs.files import content_digest
from runs.front import dominates
from runs.simulations import Run, named_files

SAMPLED_EVERY = 4  # what the sampler proposes; between them what is next to the best
MOST_PROPOSED = 20  # for each to be judged: then nearly all that is proposed need not be judged
MOST_LISTED = 10_000  # configurations of a space in which what is left is looked for one by one
TRIALS = 200


class Searcher:
    """What a search looks at next, and what it need not look at."""

    def __init__(self, work: Work):
        self.work = work
        self.judge, self.space = work.judge, work.space
        self.of_the_machine = work.judge.task.of_the_machine()
        self.random = random.Random(work.arguments.seed)
        self.known_costs: dict[At, tuple[float, ...] | None] = {}

    def judged(self, at: At) -> Judged:
        return self.judge.judged(self.space.assignments(at))

    def costs(self, at: At) -> tuple[float, ...] | None:
        """Where any frame tells them; none where there is no such machine."""
        if at not in self.known_costs:
            self.known_costs[at] = self.judge.machine_costs(self.space.machine(at))
        return self.known_costs[at]

    def skips(self, at: At) -> str:
        """Why a configuration need not be judged; empty where it must be."""
        if not self.of_the_machine or (costs := self.costs(at)) is None:
            return ""  # judging tells why there is no such machine
        for best in self.work.made.cheapest():
            if best.costs == costs or dominates(best.costs, costs):
                return "another one that holds is as small"
        return ""

    def is_needless(self, at: At) -> bool:
        """Whether it would not be drawn: too large, or no smaller than another one that holds."""
        return bool(self.judge.lost_by_any_frame(self.space.machine(at)) or self.skips(at))

    def unseen(self, seen: set[At]) -> At | None:
        """Any that nobody has proposed yet, where there are few enough to look."""
        if self.space.size() > MOST_LISTED:
            return None
        left = [at for at in self.space.all() if at not in seen]
        return self.random.choice(left) if left else None

    def next_to_the_front(self, study: Study) -> At | None:
        """What no worker has looked at yet: one step on one axis from what is best, and not less of
        everything than one that did not hold. The largest saving first, where any frame tells
        it."""
        at_of = {self.space.assignments(at): at for at in study.done()}
        seen = {study.at_of(trial) for trial in study.trials()}
        lost = [
            at_of[judged.assignments]
            for judged in self.work.made.told()
            if judged.drawn and not judged.holds() and judged.assignments in at_of
        ]
        near = [
            at
            for best in self.work.made.cheapest()
            if best.assignments in at_of
            for at in self.space.neighbours(at_of[best.assignments])
            if at not in seen and not any(is_within(at, other) for other in lost)
        ]
        if not self.of_the_machine:
            return next((at for at in near if not self.is_needless(at)), None)
        saving = [at for at in near if self.costs(at) and not self.is_needless(at)]
        return min(saving, key=lambda at: self.costs(at), default=None)


def explore(work: Work, program: str) -> None:
    """Into work.made. program: its digest. Raises Failure, ValueError."""
    arguments, task = work.arguments, work.judge.task
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
    storage = arguments.storage or f"sqlite:///{(arguments.out / 'explore.db').absolute()}"
    if not arguments.study:
        storage = ""
    lock = locked(storage)
    searcher = Searcher(work)
    study = Study(
        optuna.create_study(
            storage=open_storage(storage, arguments.lost_after) if storage else None,
            study_name=arguments.study or None,
            directions=["minimize"] * len(task.objectives),
            sampler=sampler(arguments.search or "random", arguments.seed, bool(task.requirements)),
            load_if_exists=True,
        ),
        work.space,
        described(work, program),
        searcher.judged,
        searcher.skips if arguments.search else (lambda at: ""),
        whole=not arguments.search,
        alone=not storage or lock is not None,
    )
    study.join(list(work.space.all()) if study.whole else [work.judge.start(work.space)])
    taken: set[int] = set()  # trials
    said_of = 0  # configurations
    under_way = 0  # of a search, in the threads of this script: they count as drawn
    of = work.space.size() if study.whole else min(arguments.trials or TRIALS, work.space.size())

    def take_in() -> int:
        """What all workers have judged; returns how many of it count."""
        trials = sorted(study.done().values(), key=lambda trial: trial.number)
        for trial in trials:
            if trial.number not in taken and not is_skipped(trial):
                work.made.add(unpacked(trial.user_attrs[JUDGED]))
            taken.add(trial.number)
        return sum(study.whole or counts(trial) for trial in trials)

    def before() -> bool:
        """Whether there is more to do; if so what is next may be in the queue, else the sampler
        proposes it."""
        nonlocal under_way
        if not work.has_time():
            return False
        if study.whole:
            return True
        with work.reporting:
            trials = study.trials()
            seen = {study.at_of(trial) for trial in trials}
            drawn = under_way + sum(map(counts, study.done().values()))
            if drawn >= of or len(seen) >= work.space.size() or len(trials) >= MOST_PROPOSED * of:
                return False
            under_way += 1
            if len(trials) % SAMPLED_EVERY and (near := searcher.next_to_the_front(study)):
                study.enqueue(near)
            elif is_repeated(trials) and (unseen := searcher.unseen(seen)):
                study.enqueue(unseen)
        return True

    def after() -> None:
        nonlocal under_way, said_of
        with work.reporting:
            under_way -= not study.whole
            before_that, done = said_of, take_in()
            if done > before_that:
                work.progress(done, max(of, done))
                said_of = done

    with concurrent.futures.ThreadPoolExecutor(arguments.j) as pool:
        waiting = [pool.submit(study.work, before, after) for _ in range(arguments.j)]
        try:
            for each in concurrent.futures.as_completed(waiting):
                each.result()
        finally:
            study.stopped.set()
    take_in()


def is_repeated(trials: list[optuna.trial.FrozenTrial]) -> bool:
    """Whether the sampler proposed last what was judged before."""
    return bool(trials) and SAME_AS in trials[-1].user_attrs


def is_skipped(trial: optuna.trial.FrozenTrial) -> bool:
    return "skipped" in trial.user_attrs.get(JUDGED, {"skipped": ""})


def counts(trial: optuna.trial.FrozenTrial) -> bool:
    """Whether it was drawn or refused: what any frame shows to be too large takes no time."""
    judged = trial.user_attrs.get(JUDGED, {})
    return any(judged.get(key) for key in ("drawn", "refused", "failed"))


def is_within(at: At, other: At) -> bool:
    return all(a <= b for a, b in zip(at, other))


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
        "config": task.config,
        "base": list(task.base),
        "objectives": [o.name for o in task.objectives],
        "requirements": [r.text for r in task.requirements],
        "shown": [measure.text for measure in task.shown],
    }
    return json.dumps(facts)
