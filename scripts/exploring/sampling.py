"""A study that Optuna keeps: in a file, for one worker at a time, since SQLite cannot hand a trial
to one of two; or in a database that any number of workers on any number of machines share. Needs
Debian's python3-optuna; for postgresql:// python3-psycopg2 as well.

A worker that is killed leaves its trial running. Each worker that goes on looks for trials whose
worker has not been heard of for some time, and puts their configurations back in the queue. A
configuration that was judged already is never judged again: whoever takes it up ends its trial as
the same as the other one.
"""

from __future__ import annotations

import concurrent.futures
import dataclasses
import fcntl
import json
import random
import threading
import time
import uuid
import warnings
from collections.abc import Callable
from typing import IO

import optuna
from exploring.axes import At, Space
from exploring.judging import Judged
from exploring.record import Work, described
from runs.simulations import dominates

BEATS = 4  # of a worker, in the time after which it counts as lost
POLL_SECONDS = 1.0
MOST_ATTEMPTS = 5
MOST_IDLE = 5  # polls, until what is missing counts as given up
CLAIM_SECONDS = 300  # more than a queue of thousands takes
MOST_RETRIES = 3  # of a configuration whose worker was lost
VIOLATIONS, JUDGED, SAME_AS = "violations", "judged", "same_as"
SPACE, TASK, CLAIM, FILLED = "space", "task", "claim", "filled"
States = optuna.trial.TrialState


def open_storage(url: str, lost_after: int) -> optuna.storages.RDBStorage:
    """lost_after: seconds of silence. Raises ValueError."""
    if lost_after < BEATS:
        raise ValueError(f"--lost-after: {lost_after}, expected at least {BEATS} seconds")
    attempts = MOST_ATTEMPTS
    while True:
        try:
            return made_storage(url, lost_after)
        except Exception as error:  # of whatever database driver it is
            attempts -= 1
            # Another worker makes the same tables at this moment.
            meanwhile = any(word in str(error).lower() for word in ("exist", "unique", "duplicate"))
            if not meanwhile or not attempts:
                raise ValueError(f"--storage: {url}: {str(error).splitlines()[0]}") from error
            time.sleep(POLL_SECONDS)


def locked(url: str) -> IO | None:
    """The lock of a storage that one worker has for itself; none of a server's. Raises
    ValueError."""
    if not url.startswith("sqlite:"):
        return None
    try:
        lock = open(url.removeprefix("sqlite:///") + ".lock", "w")
    except OSError as error:
        raise ValueError(f"--storage: {url}: cannot be written to: {error.strerror}") from error
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        lock.close()
        raise ValueError(
            f"--storage: {url}: another worker has it, expected postgresql:// for several"
        ) from error
    return lock


def made_storage(url: str, lost_after: int) -> optuna.storages.RDBStorage:
    sqlite = url.startswith("sqlite:")
    return optuna.storages.RDBStorage(
        url,
        engine_kwargs={"connect_args": {"timeout": 60}} if sqlite else {"pool_pre_ping": True},
        heartbeat_interval=lost_after // BEATS,
        grace_period=lost_after,
        failed_trial_callback=optuna.storages.RetryFailedTrialCallback(max_retry=MOST_RETRIES),
    )


def sampler(name: str, seed: int, required: bool) -> optuna.samplers.BaseSampler:
    constraints = (lambda trial: trial.user_attrs[VIOLATIONS]) if required else None
    if name == "random":
        return optuna.samplers.RandomSampler(seed=seed)
    if name == "nsga2":
        return optuna.samplers.NSGAIISampler(
            population_size=24, seed=seed, constraints_func=constraints
        )
    return optuna.samplers.TPESampler(
        seed=seed, multivariate=True, constraints_func=constraints, constant_liar=True
    )


@dataclasses.dataclass
class Study:
    """task: everything but the space that a result depends on. skips: why a configuration need not
    be judged; empty where it must be. whole: all that were put in the queue, each once, in place of
    a search."""

    study: optuna.Study
    space: Space
    task: str
    judge: Callable[[At], Judged]
    skips: Callable[[At], str]
    whole: bool
    alone: bool  # no other script has it
    asking: threading.Lock = dataclasses.field(default_factory=threading.Lock)
    worker: str = dataclasses.field(default_factory=lambda: uuid.uuid4().hex)
    stopped: threading.Event = dataclasses.field(default_factory=threading.Event)

    def join(self, first: list[At]) -> None:
        """Fills a new study's queue; or checks that one which is there is the same. Raises
        ValueError."""
        attributes = self.study.user_attrs
        own = {SPACE: self.space.described(), TASK: self.task}
        for name, value in own.items():
            there = attributes.get(name)
            if there is not None and json.dumps(there) != json.dumps(value):
                raise ValueError(f"--study {self.study.study_name}: there is one of another {name}")
        for name, value in own.items():
            self.study.set_user_attr(name, value)
        if self.alone:
            for trial in self.trials(States.RUNNING):
                self.enqueue(self.at_of(trial))
                self.study.tell(trial.number, state=States.FAIL)
        while not self.study.user_attrs.get(FILLED):
            if self.may_fill():
                there = {self.at_of(trial) for trial in self.trials()}
                for at in dict.fromkeys(first):
                    if at not in there:
                        self.enqueue(at)
                self.study.set_user_attr(FILLED, True)

    def may_fill(self) -> bool:
        """Whether it is this worker that fills the queue: the last one to claim it of those that
        began at once. A claim that was not made good in time is void."""
        name, since = self.study.user_attrs.get(CLAIM, ("", 0.0))
        if name != self.worker and time.time() - since < CLAIM_SECONDS:
            time.sleep(POLL_SECONDS)
            return False
        if name == self.worker:
            return True
        self.study.set_user_attr(CLAIM, (self.worker, time.time()))
        time.sleep(2 * POLL_SECONDS)
        return False

    def enqueue(self, at: At) -> None:
        self.study.enqueue_trial({a.name: i for a, i in zip(self.space.axes, at)})

    def at_of(self, trial: optuna.trial.FrozenTrial) -> At:
        given = {**trial.system_attrs.get("fixed_params", {}), **trial.params}
        return tuple(given.get(axis.name, -1) for axis in self.space.axes)

    def trials(self, *states: States) -> list[optuna.trial.FrozenTrial]:
        return self.study.get_trials(deepcopy=False, states=states or None)

    def done(self) -> dict[At, optuna.trial.FrozenTrial]:
        """Each configuration that was judged, by its first trial."""
        out: dict[At, optuna.trial.FrozenTrial] = {}
        for trial in self.trials(States.COMPLETE, States.PRUNED):
            if SAME_AS not in trial.user_attrs:
                out.setdefault(self.at_of(trial), trial)
        return out

    def objective(self, trial: optuna.Trial) -> tuple[float, ...]:
        at = tuple(
            trial.suggest_int(axis.name, 0, len(axis.settings) - 1) for axis in self.space.axes
        )
        if other := self.done().get(at):
            trial.set_user_attr(SAME_AS, other.number)
            trial.set_user_attr(VIOLATIONS, other.user_attrs.get(VIOLATIONS, [1.0]))
            if other.state == States.PRUNED:
                raise optuna.TrialPruned
            return tuple(other.values)
        if reason := self.skips(at):
            trial.set_user_attr(JUDGED, {"skipped": reason})
            trial.set_user_attr(VIOLATIONS, [1.0])
            raise optuna.TrialPruned
        judged = self.judge(at)
        trial.set_user_attr(VIOLATIONS, list(judged.violations) or [0.0])
        trial.set_user_attr(JUDGED, dataclasses.asdict(judged))
        if not judged.is_told() or not judged.drawn:
            trial.set_user_attr(VIOLATIONS, [1.0])
            raise optuna.TrialPruned
        return judged.costs

    def work(self, before: Callable[[], bool], after: Callable[[], None]) -> None:
        """One worker: until there is nothing left to take up, or before() says so; after() behind
        each that it took up. Whatever judging raises ends it."""
        idle = 0
        while not self.stopped.is_set() and before():
            if self.whole and not self.trials(States.WAITING):
                # What a lost worker had is for a moment neither running nor waiting.
                idle = 0 if self.trials(States.RUNNING) else idle + 1
                if len(self.done()) == self.space.size() or idle == MOST_IDLE:
                    return
                self.take_up_lost()
                time.sleep(POLL_SECONDS)
                continue
            idle = 0
            try:
                self.judge_next()
            except RuntimeError as error:
                # Another worker was first to take up a lost trial (optuna#4862).
                if "updat" not in str(error).lower():
                    raise
            after()

    def judge_next(self) -> None:
        if not self.alone:
            self.study.optimize(self.objective, n_trials=1)
            return
        with self.asking:
            trial = self.study.ask()
        try:
            self.study.tell(trial, self.objective(trial))
        except optuna.TrialPruned:
            self.study.tell(trial, state=States.PRUNED)

    def take_up_lost(self) -> None:
        if self.alone:
            return
        try:
            optuna.storages.fail_stale_trials(self.study)
        except RuntimeError:  # another worker was first
            pass


def unpacked(document: dict) -> Judged:
    """Of what a trial keeps."""
    lists = ("assignments", "costs", "values", "violations", "shown")
    return Judged(**{k: tuple(v) if k in lists else v for k, v in document.items()})


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
        if study.whole:
            return True
        with work.reporting:
            trials = study.trials()
            seen = {study.at_of(trial) for trial in trials}
            drawn = under_way + sum(map(counts, study.done().values()))
            if len(seen) >= work.space.size():
                return False
            proposed = len(trials) / MOST_PROPOSED
            if not work.may_look(max(drawn, proposed), of):
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
