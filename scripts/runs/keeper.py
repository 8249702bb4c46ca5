"""Runs that are kept, so that a script that is interrupted, or run again, goes on where it ended.
`streaminggs sweep` keeps simulations: as a server it prepares scenes and their pictures once. Of
other commands each run has a folder: of `train` and `tune` also what is under way."""

from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import csv
import dataclasses
import fcntl
import functools
import hashlib
import itertools
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import IO

from runs.files import content_digest, files_of, program_digest, write_text
from runs.scenes import REFUSED, Failure, program_provenance, said, view_numbers
from runs.simulations import MOST_SIDE_BY_SIDE, Outcome, Run

MOST_OF_LABEL = 100  # that stands in the name of a folder
DONE = "made.json"  # written last: a folder that has it is whole


def digests_of(words: Iterable[str]) -> Iterator[str]:
    """Of the files that words or the values of KEY=VALUE name."""
    for word in words:
        for text in dict.fromkeys((word, word.partition("=")[2])):
            yield from map(content_digest, files_of(pathlib.Path(text)) if text else ())


class Keeper:
    """A folder for each run, below one. stopping: nothing is begun any more."""

    def __init__(self, binary: pathlib.Path, folder: pathlib.Path):
        """Raises ValueError when there is no such program."""
        self.folder, self.program = folder, program_digest(binary)
        self.stopping = False

    def place(self, label: str, words: Iterable[str]) -> pathlib.Path:
        """Of a run of the program with these words, given what the files that they name hold."""
        words = list(words)
        facts = "\n".join([self.program, *words, *digests_of(words)])
        digest = hashlib.sha256(facts.encode()).hexdigest()[:16]
        name = "".join(c if c.isalnum() or c in ".-" else "_" for c in label)
        return self.folder / f"{name[:MOST_OF_LABEL]}_{digest}"

    def kept(
        self,
        label: str,
        words: Iterable[str],
        make: Callable[[pathlib.Path, IO], object],
    ) -> tuple[pathlib.Path, object]:
        """The folder of a run, and its answer in JSON: of make(folder, lock), where it is not there
        yet. The lock is to be held by what make() starts, too, should this script be killed."""
        words = list(words)
        place = self.place(label, words)
        if not (place / DONE).exists():
            place.mkdir(parents=True, exist_ok=True)
            with (place / "lock").open("w") as lock:
                self.wait_for(lock, label)
                if not (place / DONE).exists():
                    entry = {"words": words, "answer": make(place, lock)}
                    write_text(place / DONE, json.dumps(entry) + "\n")
        return place, json.loads((place / DONE).read_text())["answer"]

    def wait_for(self, lock: IO, label: str) -> None:
        """Until no other script has it under way, nor a call that such a one left behind."""
        told = False
        while not self.stopping:
            try:
                return fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if not told:
                    print(f"{label}: waits for another script", file=sys.stderr, flush=True)
                told = True
                time.sleep(0.5)
        raise Failure("interrupted")


CHECKPOINT_EVERY = "500"  # steps; what is lost where a computer stops
INTERRUPTED = 130  # exit status of the command: saved, to be resumed


@dataclasses.dataclass(frozen=True)
class Fitting:
    """One call of the command. words: without --out, --log, --checkpoint and --resume.
    most_seconds: stopped there, as Ctrl-C does; 0: never. copy: another one is another run."""

    label: str
    command: str  # train, tune
    words: tuple[str, ...]
    extension: str = ".ply"
    most_seconds: float = 0
    copy: int = 0

    def facts(self) -> tuple[str, ...]:
        """Of which any other one makes it another run."""
        return (self.command, *self.words, self.extension, str(self.most_seconds), str(self.copy))


@dataclasses.dataclass(frozen=True)
class Fitted:
    """What a fitting left: the scene that it wrote, its log, seconds at work in all its parts."""

    fitting: Fitting
    scene: pathlib.Path
    log: list[dict[str, str]]
    seconds: float

    def steps(self) -> int:
        return int(self.log[-1]["step"]) if self.log else 0


class KeptFittings:
    """Fittings below a folder. Each takes all cores; two side by side share them."""

    def __init__(self, binary: pathlib.Path, folder: pathlib.Path, side_by_side: int):
        self.binary, self.keeper = binary, Keeper(binary, folder)
        self.workers = max(1, min(MOST_SIDE_BY_SIDE, side_by_side))
        self.provenance = program_provenance(binary)
        self.calls: set[subprocess.Popen] = set()
        self.lock = threading.Lock()

    def all(self, fittings: Sequence[Fitting]) -> list[Fitted]:
        """In their order; one that is asked for twice is made once. Raises Failure, and ValueError
        for what the command refuses. Whatever ends it, those under way are stopped and saved."""
        pool = concurrent.futures.ThreadPoolExecutor(self.workers)
        try:
            waiting = {each: pool.submit(self.made, each) for each in dict.fromkeys(fittings)}
            return [waiting[fitting].result() for fitting in fittings]
        except BaseException:
            self.stop()
            raise
        finally:
            pool.shutdown(cancel_futures=True)

    def stop(self) -> None:
        with self.lock:
            self.keeper.stopping = True
            for call in self.calls:
                call.send_signal(signal.SIGINT)

    def made(self, fitting: Fitting) -> Fitted:
        def make(place: pathlib.Path, lock: IO) -> float:
            print(f"{fitting.label}: in {place}", file=sys.stderr, flush=True)
            scene = scene_of(fitting, place)
            seconds = self.run(fitting, scene, place / "seconds", lock)
            checkpoint_of(scene).unlink(missing_ok=True)
            return seconds

        place, seconds = self.keeper.kept(fitting.label, fitting.facts(), make)
        with (place / "log.csv").open() as log:
            return Fitted(fitting, scene_of(fitting, place), list(csv.DictReader(log)), seconds)

    def run(self, fitting: Fitting, scene: pathlib.Path, clock: pathlib.Path, lock: IO) -> float:
        """Until its end. clock: file of the seconds that earlier parts took, which a script that
        was killed could not write. Returns the sum."""
        words = [str(self.binary.absolute()), fitting.command, *fitting.words]
        words += ["--out", str(scene), "--log", str(scene.parent / "log.csv")]
        words += ["--checkpoint", CHECKPOINT_EVERY]
        earlier = 0.0
        if checkpoint_of(scene).exists():
            words += ["--resume", str(checkpoint_of(scene))]
            told = float(clock.read_text()) if clock.exists() else 0.0
            earlier = max(told, logged_seconds(scene.parent / "log.csv"))
        began = time.monotonic()
        done, timed_out = self.call(words, fitting.most_seconds, earlier, lock)
        seconds = earlier + time.monotonic() - began
        if done.returncode == 0 or (timed_out and done.returncode == INTERRUPTED):
            return seconds
        if checkpoint_of(scene).exists():
            write_text(clock, f"{seconds:.1f}\n")
        kind = ValueError if done.returncode == REFUSED else Failure
        raise kind(f"{fitting.label}: {said(done)}")

    def call(
        self, words: Sequence[str], most_seconds: float, earlier: float, lock: IO
    ) -> tuple[subprocess.CompletedProcess[str], bool]:
        """How it ended, and whether that was for its time. In a session of its own: of Ctrl-C it
        hears once, from stop()."""
        with self.lock:
            if self.keeper.stopping:
                raise Failure("interrupted")
            try:
                call = subprocess.Popen(
                    words,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    text=True,
                    errors="replace",
                    start_new_session=True,
                    pass_fds=(lock.fileno(),),
                )
            except OSError as error:
                raise ValueError(f"{words[0]}: cannot be run: {error.strerror}") from error
            self.calls.add(call)
        timed_out = False
        left = max(1.0, most_seconds - earlier) if most_seconds else None
        try:
            out, err = call.communicate(timeout=left)
        except subprocess.TimeoutExpired:
            timed_out = True
            call.send_signal(signal.SIGINT)
            out, err = call.communicate()
        finally:
            with self.lock:
                self.calls.discard(call)
        return subprocess.CompletedProcess(words, call.returncode, out, err), timed_out


def scene_of(fitting: Fitting, place: pathlib.Path) -> pathlib.Path:
    return place / f"scene{fitting.extension}"


def checkpoint_of(scene: pathlib.Path) -> pathlib.Path:
    return scene.with_name(scene.name + ".checkpoint")


def logged_seconds(log: pathlib.Path) -> float:
    """Of the last look, whatever looks a checkpoint is behind; 0 where there was none yet."""
    if not log.exists():
        return 0.0
    with log.open(newline="") as file:
        return max((float(look["seconds"]) for look in csv.DictReader(file)), default=0.0)


Answer = dict


class SweepServer:
    """For any number of threads. jobs: simulations side by side. failures: what ended badly."""

    def __init__(self, binary: pathlib.Path, results: pathlib.Path, jobs: int):
        """Raises ValueError when there is no such program."""
        self.binary, self.program = binary, program_digest(binary)
        self.failures: list[Failure] = []
        self.simulated = 0
        self.ended: Failure | ValueError | None = None
        self.numbers = itertools.count()
        self.lock = threading.Lock()
        self.asking = threading.Lock()  # not `lock`: what blocks the writer waits for the reader
        self.waiting: dict[int, concurrent.futures.Future[Answer]] = {}
        self.said = tempfile.TemporaryFile("w+")
        results.parent.mkdir(parents=True, exist_ok=True)
        words = [str(binary.absolute()), "sweep", "--points", "-", "--out", str(results)]
        try:
            self.process = subprocess.Popen(
                [*words, "--jobs", str(jobs)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self.said,
                text=True,
                errors="replace",
                start_new_session=True,  # Ctrl-C is for the script, which ends it
            )
        except OSError as error:
            self.said.close()
            raise ValueError(f"{binary}: cannot be run: {error.strerror}") from error
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def __enter__(self) -> SweepServer:
        return self

    def __exit__(self, *_: object) -> None:
        """Those under way are given up; what is done is in the file."""
        self.process.terminate()
        self.reader.join()
        with contextlib.suppress(OSError):  # of what it did not read any more
            self.process.stdin.close()
        self.process.stdout.close()
        self.said.close()

    def read(self) -> None:
        try:
            for line in self.process.stdout:
                self.take(json.loads(line))
            ended = self.how_it_ended()
        except (ValueError, KeyError, TypeError):
            self.process.terminate()
            ended = ValueError(f"{self.binary}: got no answers, expected those of `sweep`")
        with self.lock:
            self.ended = ended
            for asked in self.waiting.values():
                asked.set_exception(self.ended)
            self.waiting.clear()

    def take(self, answer: Answer) -> None:
        """Raises KeyError, TypeError for what is no answer of `sweep`."""
        with self.lock:
            self.simulated += not answer["kept"]
            asked = self.waiting.pop(answer["id"])
        asked.set_result(answer)

    def how_it_ended(self) -> Failure | ValueError:
        status = self.process.wait()
        self.said.seek(0)
        ended = subprocess.CompletedProcess([], status, "", self.said.read())
        kind = ValueError if status == REFUSED else Failure
        return kind(f"sweep: {said(ended)}")

    def outcome(self, run: Run) -> Outcome:
        """Of a run of one view. Raises Failure when the server has ended,
        ValueError when it did not take its arguments."""
        return self.answered(run, self.ask(run))

    def ask(self, run: Run) -> concurrent.futures.Future[Answer]:
        asked: concurrent.futures.Future[Answer] = concurrent.futures.Future()
        with self.lock:
            if self.ended:
                raise self.ended
            number = next(self.numbers)
            self.waiting[number] = asked
        try:
            with self.asking:
                self.process.stdin.write(json.dumps({"id": number, **point_of(run)}) + "\n")
                self.process.stdin.flush()
        except (BrokenPipeError, ValueError):
            pass  # the reader says how it ended
        return asked

    def answered(self, run: Run, asked: concurrent.futures.Future[Answer]) -> Outcome:
        answer = asked.result()
        if answer["status"] == "done":
            return Outcome(run, views=(answer["report"],))
        if answer["status"] == "refused":
            return Outcome(run, refused=answer["reason"])
        failure = Failure(f"{run.label()}: {answer['reason']}")
        self.failures.append(failure)
        return Outcome(run, refused=str(failure), failure=failure)

    def outcomes(self, runs: Sequence[Run]) -> list[Outcome]:
        """In the order of the runs, which are of one view each. The server has all of them to
        choose from: it draws those one after the other that share most."""
        asked = [self.ask(run) for run in runs]
        return [self.answered(run, answer) for run, answer in zip(runs, asked)]

    def end(self) -> None:
        """To be called when all tables are written. Raises the first Failure there was."""
        if self.failures:
            raise self.failures[0]


def point_of(run: Run) -> dict:
    """As `sweep` takes it; of two settings of one key the last one counts."""
    point = {"scene": run.scene.spec, "view": run.view, "config": run.config}
    point |= {"cameras": run.scene.cameras} if run.scene.cameras else {}
    point |= {"size": run.size} if run.size else {}
    point |= {"stereo": run.stereo} if run.stereo else {}
    point |= {"fit_memories": True} if run.fit_memories else {}
    settings = (override.split("=", 1) for override in run.overrides)
    return {**point, "set": {key: json_value(text) for key, text in settings}}


def json_value(text: str) -> object:
    """A number or a truth where it is one, else text."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def swept(arguments: argparse.Namespace, study: str, runs: Sequence[Run]) -> list[Outcome]:
    """In the order of the runs, which may be of several views each; with the program, the folder of
    what is kept and the pace of the arguments. Raises the first Failure when all else is simulated
    and kept, ValueError for views that are none."""
    numbers = functools.cache(functools.partial(view_numbers, arguments.streaminggs))
    single = [
        [dataclasses.replace(run, view=str(view)) for view in numbers(run.scene, run.view)]
        for run in runs
    ]
    kept = arguments.kept / f"{study}.jsonl"
    with SweepServer(arguments.streaminggs, kept, arguments.side_by_side) as server:
        asked = [(each, server.ask(each)) for of_run in single for each in of_run]
        answered = []
        for number, (run, answer) in enumerate(asked, start=1):
            answered.append(server.answered(run, answer))
            print(f"[{number}/{len(asked)}] {run.label()}", file=sys.stderr, flush=True)
        server.end()
    outcomes = iter(answered)
    return [together(run, [next(outcomes) for _ in of_run]) for run, of_run in zip(runs, single)]


def together(run: Run, outcomes: Sequence[Outcome]) -> Outcome:
    """Of one run, what each of its views came to."""
    refused = next((outcome.refused for outcome in outcomes if outcome.refused), "")
    views = () if refused else tuple(view for outcome in outcomes for view in outcome.views)
    return Outcome(run, views, refused)
