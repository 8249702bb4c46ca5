#!/usr/bin/env python3
"""Whether the tests find faults: plants one at a time in a copy of the product's sources, builds
what it changes, and runs the tests of the normal suite that cover it, nearest first, until one
fails. Which faults, the seed decides: of each kind in turn, operators, constants, conditions,
dropped waits and counts, swapped counters. Writes

  planted_faults.md    each fault, and the test that found it; and .csv
  planted_faults.jsonl the same as it goes: what is interrupted goes on where it ended. A fault that
                       was found is not tried again as long as its file is the same, one that
                       survived as long as all sources are, and there is no more time for it.

A fault after which the programs are the same, byte for byte, is none, and counted apart, as is one
that does not compile. Run it at low priority (`nice`) beside other work, and with ccache, which
brings back what a fault has changed.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import pathlib
import signal
import sys
import time
from collections.abc import Iterator

import run_arguments
import tables
from covering_tests import covering, includers
from fault_kinds import Fault, drawn, faults_in
from fault_tree import DoesNotBuild, DoesNotCompile, FaultTree, only_one
from simulations import REPOSITORY

PRODUCT = ("algorithm", "modules", "testbench", "tlm")
# Testbenches of single units and benchmarks are no part of the product.
NO_PRODUCT = ("testbench/bench/", "testbench/units/")
CODE = (".cpp", ".h")
FOUND, SURVIVED, UNFINISHED = "found", "survived", "survived so far"
SAME, NO_CODE = "same programs", "does not compile"
COUNTED = (FOUND, SURVIVED, UNFINISHED)


@dataclasses.dataclass
class Verdict:
    outcome: str
    by: str = ""  # the test that found it
    tests: int = 0  # that passed before
    seconds: float = 0


class Trial:
    """One fault after the other in one tree."""

    def __init__(self, tree: FaultTree, seconds_each: float):
        self.tree, self.seconds_each = tree, seconds_each
        files = [name for name in tree.files if name.endswith(CODE)]
        self.including = includers(tree.folder, files)
        self.targets = tree.executables()

    def verdict(self, fault: Fault) -> Verdict:
        verdict = Verdict(SAME)
        for target in covering(self.targets, fault.path, self.including):
            without = self.tree.programs_of(target)  # and its tests pass, or are not asked again
            if not self.tree.tests_of(target):
                continue
            began = time.monotonic()
            try:
                failed, passed = self.with_fault(fault, target, without)
            except DoesNotCompile:
                return Verdict(NO_CODE)
            finally:
                verdict.seconds += time.monotonic() - began
            if passed or failed:
                verdict.outcome = SURVIVED
            verdict.tests += passed
            if failed:
                return dataclasses.replace(verdict, outcome=FOUND, by=failed)
            if verdict.seconds > self.seconds_each:
                return dataclasses.replace(verdict, outcome=UNFINISHED)
        return verdict

    def with_fault(self, fault: Fault, target, without: str) -> tuple[str, int]:
        """The test of a target that finds it, or "", and how many passed before. without: digest
        of the programs as they are without the fault."""
        while True:
            self.tree.plant(fault)
            try:
                try:
                    same = self.tree.programs_of(target) == without
                except DoesNotBuild as step:
                    return f"build: {step}", 0
                if same:
                    return "", 0
                failed, passed = self.tree.first_failure(target)
            finally:
                self.tree.restore(fault)
            if not failed or self.tree.passes_without(failed, target):
                return failed and failed.name, passed


class Kept:
    """Verdicts, in a file of a line each."""

    def __init__(self, path: pathlib.Path):
        self.path = path
        self.known: dict[str, dict] = {}
        for line in path.read_text().splitlines() if path.exists() else []:
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:  # the last line of a run that was killed
                continue
            self.known[entry["fault"]] = entry

    def verdict(self, fault: Fault, tree: FaultTree, seconds_each: float) -> Verdict | None:
        """None where it is to be tried."""
        entry = self.known.get(fault.name())
        if entry is None or entry["file"] != tree.digests[fault.path]:
            return None
        verdict = Verdict(**entry["verdict"])
        if verdict.outcome not in (SURVIVED, UNFINISHED):
            return verdict
        again = entry["sources"] != tree.digest
        again = again or verdict.outcome == UNFINISHED and verdict.seconds < seconds_each
        return None if again else verdict

    def keep(self, fault: Fault, verdict: Verdict, tree: FaultTree) -> None:
        entry = {
            "fault": fault.name(),
            "file": tree.digests[fault.path],
            "sources": tree.digest,
            "verdict": dataclasses.asdict(verdict),
        }
        self.known[fault.name()] = entry
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a") as file:
            file.write(json.dumps(entry) + "\n")


def all_faults(tree: FaultTree) -> Iterator[Fault]:
    for name in tree.files:
        if name.startswith(tuple(f"{p}/" for p in PRODUCT)) and name.endswith(CODE):
            if not name.startswith(NO_PRODUCT):
                yield from faults_in(name, (tree.folder / name).read_text())


HEAD = ("#", "place", "kind", "change", "outcome", "found by", "tests passed before", "s")


def row(number: int, fault: Fault, verdict: Verdict) -> tuple:
    place = f"{fault.path}:{fault.line}"
    seconds = f"{verdict.seconds:.0f}"
    return (
        number,
        place,
        fault.kind,
        fault.change(),
        verdict.outcome,
        verdict.by,
        verdict.tests,
        seconds,
    )


def summary(verdicts: list[Verdict]) -> str:
    count = {o: sum(v.outcome == o for v in verdicts) for o in (*COUNTED, SAME, NO_CODE)}
    planted = sum(count[outcome] for outcome in COUNTED)
    return (
        f"{planted} faults: {count[FOUND]} found, {count[SURVIVED]} survived, "
        f"{count[UNFINISHED]} survived as far as there was time; besides these {count[SAME]} that "
        f"leave the programs the same, and {count[NO_CODE]} that do not compile.\n\n"
    )


def check(arguments: argparse.Namespace) -> None:
    """Before anything is built. Raises ValueError for numbers that say nothing."""
    run_arguments.check_at_least("--faults", arguments.faults, 1)
    run_arguments.check_at_least("--seed", arguments.seed, 0)
    run_arguments.check_above_zero("--minutes-each", arguments.minutes_each)
    run_arguments.check_above_zero("--patience", arguments.patience)
    run_arguments.check_at_least("--side-by-side", arguments.side_by_side, 1)


def make(arguments: argparse.Namespace) -> None:
    check(arguments)
    kept = Kept(arguments.out / "planted_faults.jsonl")
    rows, verdicts = [], []
    of_tree = (arguments.project, arguments.work, arguments.side_by_side, arguments.patience)
    with only_one(arguments.work):
        tree = FaultTree(*of_tree)
        trial = Trial(tree, 60 * arguments.minutes_each)
        for fault in drawn(all_faults(tree), arguments.seed):
            if sum(verdict.outcome in COUNTED for verdict in verdicts) == arguments.faults:
                break
            verdict = kept.verdict(fault, tree, trial.seconds_each)
            if verdict is None:
                verdict = trial.verdict(fault)
                kept.keep(fault, verdict, tree)
            verdicts.append(verdict)
            rows.append(row(len(rows) + 1, fault, verdict))
            print(*rows[-1], file=sys.stderr, flush=True)
        made = run_arguments.how_made_at([tree.commit()])
    tables.write(arguments.out, "planted_faults", made + summary(verdicts), HEAD, rows)


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument("--faults", type=int, default=10, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="which")
    parser.add_argument(
        "--minutes-each",
        type=float,
        default=10,
        help="of building and testing a fault; then it has survived so far",
    )
    parser.add_argument(
        "--patience", type=float, default=120, help="seconds that a test may take before it fails"
    )
    parser.add_argument("--side-by-side", type=int, default=2, help="compilers and tests at a time")
    parser.add_argument(
        "--project", type=pathlib.Path, default=REPOSITORY, metavar="FOLDER", help="what is tested"
    )
    parser.add_argument(
        "--work",
        type=pathlib.Path,
        default=REPOSITORY / "build" / "planted_faults",
        metavar="FOLDER",
        help="for the copy and its build",
    )
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=REPOSITORY / "out",
        metavar="FOLDER",
        help="for tables",
    )
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends what it has started
    return run_arguments.main_of_tables(make, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
