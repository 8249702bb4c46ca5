"""`streaminggs sweep` as a server: scenes and their pictures are prepared once, and what its file
of results holds is not simulated again."""

from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import dataclasses
import functools
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence

from runs.files import program_digest
from runs.simulations import REFUSED, Failure, Outcome, Run, said, view_numbers

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
