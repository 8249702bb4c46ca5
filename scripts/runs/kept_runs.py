"""Simulations that are kept in a file, so that a script which is interrupted, or run again, does
not repeat them."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import pathlib
import sys
import threading
from collections.abc import Callable, Sequence

from runs.run_digest import program_digest, run_name
from runs.simulations import Failure, Outcome, Run, simulate

# Parts of a view's report that no table asks for; they are most of its size.
NOT_KEPT = ("ledger", "left_out", "chosen")


def view_to_keep(view: dict) -> dict:
    kept = {name: part for name, part in view.items() if name not in NOT_KEPT}
    kept["sram"] = {name: n for name, n in view.get("sram", {}).items() if name != "uses"}
    kept["units"] = {
        path: {
            "activities": {name: sums(a) for name, a in unit["activities"].items()},
            "counters": unit["counters"],
        }
        for path, unit in view.get("units", {}).items()
    }
    return kept


def sums(activity: dict) -> dict:
    """What an activity worked and waited, without the places where."""
    return {name: part for name, part in activity.items() if name != "waits"}


class KeptRuns:
    """Outcomes of runs, from the file where it has them. A file of another program is left alone:
    each line names what it was made with
    (run_digest.py). simulate: what makes an outcome of a run; a file is of one such.
    failures: what ended badly, which is not kept."""

    def __init__(
        self,
        binary: pathlib.Path,
        path: pathlib.Path,
        side_by_side: int,
        simulate: Callable[[pathlib.Path, Run], Outcome] = simulate,
    ):
        self.binary, self.path, self.simulate = binary, path, simulate
        self.workers = max(1, side_by_side)
        self.program = program_digest(binary)
        self.known: dict[str, dict] = {}
        self.failures: list[Failure] = []
        self.simulated = 0
        self.writing = threading.Lock()
        self.running = threading.Semaphore(self.workers)
        for line in path.read_text().splitlines() if path.exists() else []:
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:  # the last line of a run that was killed
                continue
            if entry["program"] == self.program:
                self.known[entry["run"]] = entry

    def outcomes(self, runs: Sequence[Run]) -> list[Outcome]:
        """In the order of the runs. A run that ends badly has no views, and says why."""
        with concurrent.futures.ThreadPoolExecutor(self.workers) as pool:
            waiting = [pool.submit(self.outcome, run) for run in runs]
            try:
                return [each.result() for each in waiting]
            finally:
                pool.shutdown(cancel_futures=True)

    def outcome(self, run: Run) -> Outcome:
        name = run_name(run)
        if name in self.known:
            entry = self.known[name]
            return Outcome(
                run, tuple(entry["views"]), entry["refused"], seconds=entry.get("seconds", 0)
            )
        try:
            with self.running:
                outcome = self.simulate(self.binary, run)
        except Failure as failure:
            with self.writing:
                self.failures.append(failure)
            return Outcome(run, refused=str(failure), failure=failure)
        outcome = dataclasses.replace(outcome, views=tuple(map(view_to_keep, outcome.views)))
        self.keep(name, outcome)
        return outcome

    def keep(self, name: str, outcome: Outcome) -> None:
        entry = {
            "program": self.program,
            "run": name,
            "refused": outcome.refused,
            "seconds": outcome.seconds,
            "views": outcome.views,
        }
        with self.writing:
            self.known[name] = entry
            self.simulated += 1
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("a") as file:
                file.write(json.dumps(entry) + "\n")
            print(f"[{self.simulated}] {outcome.run.label()}", file=sys.stderr, flush=True)

    def end(self) -> None:
        """To be called when all tables are written. Raises the first Failure there was."""
        if self.failures:
            raise self.failures[0]
