"""Runs of `streaminggs simulate` and what they report; used by the scripts that make tables."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import pathlib
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence

from scenes import Scene

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
BINARY = REPOSITORY / "build" / "release" / "bin" / "streaminggs"
# The machine the model is meant for has two cores, and wall times are read off these runs.
MOST_SIDE_BY_SIDE = 2

# "streaminggs: sram.shared_bytes: 347136 bytes are there, 412672 are needed: ..."
SRAM_REFUSAL = re.compile(r"(sram\.\w+): (\d+) bytes are there, (\d+) are needed")


class Failure(Exception):
    """A simulation that ended badly; the text is what it said."""


@dataclasses.dataclass(frozen=True)
class Run:
    """One call of the command. overrides: `key.path=value`, as for --set."""

    scene: Scene
    view: str = "0"
    size: str = ""
    config: str = "exact"
    overrides: tuple[str, ...] = ()
    timing: str = "accurate"

    def configuration_arguments(self) -> list[str]:
        return ["--config", self.config] + [a for o in self.overrides for a in ("--set", o)]

    def arguments(self) -> list[str]:
        arguments = [self.scene.spec, *self.configuration_arguments()]
        if self.scene.cameras:
            arguments += ["--cameras", self.scene.cameras]
        if self.size:
            arguments += ["--size", self.size]
        return arguments + ["--view", self.view, "--timing", self.timing]

    def label(self) -> str:
        return " ".join([self.scene.name, self.size, self.config, self.timing, *self.overrides])


@dataclasses.dataclass(frozen=True)
class Outcome:
    """Reports of the views of a run, or why there are none."""

    run: Run
    views: tuple[dict, ...] = ()
    refused: str = ""  # what the command said about the configuration
    raised: tuple[tuple[str, int], ...] = ()  # SRAM keys and the bytes they were raised to


def call(binary: pathlib.Path, arguments: Sequence[str]) -> subprocess.CompletedProcess[str]:
    if not binary.exists():
        raise Failure(f"{binary}: not there; scripts/setup.sh builds it")
    return subprocess.run(
        [str(binary), "simulate", *arguments], capture_output=True, text=True, check=False
    )


def refusal(binary: pathlib.Path, run: Run) -> str:
    """What the command has against the configuration; empty when it can be built."""
    done = call(binary, [run.scene.spec, *run.configuration_arguments(), "--print-config"])
    return "" if done.returncode == 0 else done.stderr.strip()


def resolved_config(binary: pathlib.Path, run: Run) -> dict:
    """Every key of the run's configuration. Raises Failure when it is refused."""
    done = call(binary, [run.scene.spec, *run.configuration_arguments(), "--print-config"])
    if done.returncode != 0:
        raise Failure(done.stderr.strip())
    return json.loads(done.stdout)


def with_enough_sram(binary: pathlib.Path, run: Run) -> tuple[Run, tuple[tuple[str, int], ...]]:
    """The run with those SRAM sizes raised that its configuration does not fit into, and which."""
    raised: dict[str, int] = {}
    while match := SRAM_REFUSAL.search(refusal(binary, run)):
        key, needed = match.group(1), int(match.group(3))
        if raised.get(key, 0) >= needed:
            raise Failure(f"{run.label()}: {key} stays too small at {needed} bytes")
        raised[key] = needed
        run = dataclasses.replace(run, overrides=(*run.overrides, f"{key}={needed}"))
    return run, tuple(raised.items())


def simulate(binary: pathlib.Path, run: Run) -> Outcome:
    """Simulates a run. Raises Failure when it fails, or when the frame that the accelerator wrote
    is not the streaming renderer's, bit for bit."""
    run, raised = with_enough_sram(binary, run)
    if said := refusal(binary, run):
        return Outcome(run, refused=said, raised=raised)
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as out:
        done = call(binary, [*run.arguments(), "--out", out])
        if done.returncode != 0:
            said = (done.stderr or done.stdout).strip() or f"exit status {done.returncode}"
            raise Failure(f"{run.label()}: {said}")
        report = json.loads((pathlib.Path(out) / "report.json").read_text())
    return Outcome(run, views=tuple(report["views"]), raised=raised)


def simulate_all(binary: pathlib.Path, runs: Sequence[Run], side_by_side: int) -> Iterator[Outcome]:
    """Outcomes in the order of the runs; progress goes to stderr."""
    workers = max(1, min(MOST_SIDE_BY_SIDE, side_by_side))
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        outcomes = [pool.submit(simulate, binary, run) for run in runs]
        try:
            for number, (run, outcome) in enumerate(zip(runs, outcomes), start=1):
                print(f"[{number}/{len(runs)}] {run.label()}", file=sys.stderr, flush=True)
                yield outcome.result()
        finally:
            pool.shutdown(cancel_futures=True)


def region_bytes(view: dict, region: str) -> int:
    """Bytes that units asked for in a region of DRAM, both directions."""
    by_requester = view["dram"]["bytes_by_region"].get(region, {})
    return sum(count for both in by_requester.values() for count in both.values())


def work(view: dict, counter: str) -> int:
    """Sum of a work counter over all units that have it."""
    return sum(unit.get(counter, 0) for unit in view["units"].values())


def sram_bytes(view: dict) -> int:
    """On-chip memory that the configuration uses, codebook buffer included."""
    return (
        view["sram"]["input_bytes"]
        + view["sram"]["shared_bytes"]
        + view["config"]["sram"]["codebook_bytes"]
    )


def psnr_text(view: dict) -> str:
    psnr_db = view["image"]["psnr_db"]
    return "equal" if psnr_db is None else f"{psnr_db:.2f}"
