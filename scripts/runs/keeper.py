"""Runs of commands other than `simulate`, kept in folders, so that a script that is interrupted, or
run again, goes on where it ended: of `train` and `tune` also what is under way. `sweep` keeps
simulations (sweep_server.py)."""

from __future__ import annotations

import concurrent.futures
import csv
import dataclasses
import fcntl
import hashlib
import json
import pathlib
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import IO

from runs.files import content_digest, program_digest, write_text
from runs.simulations import MOST_SIDE_BY_SIDE, REFUSED, Failure, program_provenance, said

MOST_OF_LABEL = 100  # that stands in the name of a folder
DONE = "made.json"  # written last: a folder that has it is whole


def files_of(path: pathlib.Path) -> list[pathlib.Path]:
    """The file of that name, or all below the folder; none for what is neither."""
    if path.is_dir():
        return sorted(below for below in path.rglob("*") if below.is_file())
    return [path] if path.is_file() else []


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
