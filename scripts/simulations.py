"""Runs of `streaminggs simulate` and what they report; used by the scripts that make tables."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence

from scenes import Scene

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
BINARY = REPOSITORY / "build" / "release" / "bin" / "streaminggs"
# The machine the model is meant for has two cores, and wall times are read off these runs.
MOST_SIDE_BY_SIDE = 2
# Exit status of the command for arguments, a configuration or an input that it does not take.
REFUSED = 2
# On-chip memory as large as the rest of the configuration needs, neither more nor less; the
# report's config says what that came to. Beside it a group has to have a size.
SRAM_AS_NEEDED = ("sram.input_bytes=0", "sram.shared_bytes=0")


def sram_as_needed(config: dict) -> tuple[str, ...]:
    """The same for any machine, of all its keys. What codebooks have is a choice: 0 is none of
    them."""
    return tuple(f"sram.{key}=0" for key in config["sram"] if key != "codebook_bytes")


class Failure(Exception):
    """A simulation that ended badly; the text is what it said."""


@dataclasses.dataclass(frozen=True)
class Run:
    """One call of the command. overrides: `key.path=value`, as for --set; the last one counts."""

    scene: Scene
    view: str = "0"
    size: str = ""
    config: str = "exact"
    overrides: tuple[str, ...] = ()

    def configuration_arguments(self) -> list[str]:
        return ["--config", self.config] + [a for o in self.overrides for a in ("--set", o)]

    def arguments(self) -> list[str]:
        arguments = [self.scene.spec, *self.configuration_arguments()]
        if self.scene.cameras:
            arguments += ["--cameras", self.scene.cameras]
        if self.size:
            arguments += ["--size", self.size]
        return [*arguments, "--view", self.view]

    def label(self) -> str:
        return " ".join(filter(None, [self.scene.name, self.size, self.config, *self.overrides]))


@dataclasses.dataclass(frozen=True)
class Outcome:
    """Reports of the views of a run, or why there are none."""

    run: Run
    views: tuple[dict, ...] = ()
    refused: str = ""  # what the command said about the arguments or the configuration
    failure: Failure | None = None  # the simulation ended badly, and `refused` says how
    seconds: float = 0  # wall time of the call, the scene read and prepared

    def accepted(self) -> tuple[dict, ...]:
        """The views. Raises ValueError when the run was refused, Failure when it failed."""
        if self.failure:
            raise self.failure
        if self.refused:
            raise ValueError(f"{self.run.label()}: {self.refused}")
        return self.views


def call(
    binary: pathlib.Path, arguments: Sequence[str], command: str = "simulate"
) -> subprocess.CompletedProcess[str]:
    """Raises ValueError when the program cannot be run."""
    if not binary.exists():
        raise ValueError(f"{binary}: not there; scripts/setup.sh builds it")
    words = [str(binary.absolute()), command, *arguments]
    try:
        return subprocess.run(
            words, capture_output=True, text=True, errors="replace", check=False
        )
    except OSError as error:
        raise ValueError(f"{binary}: cannot be run: {error.strerror}") from error


def said(done: subprocess.CompletedProcess[str]) -> str:
    """What a call that went wrong has to say, in one line. Where it is not an error message, it
    stands below the table of views."""
    verdict = done.stderr or done.stdout.rstrip().rpartition("\n")[2]
    return " ".join(verdict.split()) or f"exit status {done.returncode}"


def program_version(binary: pathlib.Path) -> str:
    """The commit that the program was made of. Raises ValueError."""
    return said(call(binary, [], "--version")).rpartition("(")[2].rstrip(")")


def simulate(binary: pathlib.Path, run: Run) -> Outcome:
    """Simulates a run. Raises Failure when it fails, or when the frame that the accelerator wrote
    is not the streaming renderer's, bit for bit."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as out:
        return simulate_into(pathlib.Path(out), binary, run)


def simulate_into(out: pathlib.Path, binary: pathlib.Path, run: Run) -> Outcome:
    """The same, with the pictures left in a folder."""
    began = time.monotonic()
    done = call(binary, [*run.arguments(), "--out", str(out)])
    seconds = time.monotonic() - began
    if done.returncode == REFUSED:
        return Outcome(run, refused=said(done), seconds=seconds)
    if done.returncode != 0:
        raise Failure(f"{run.label()}: {said(done)}")
    report = json.loads((out / "report.json").read_text())
    return Outcome(run, views=tuple(report["views"]), seconds=seconds)


def read_config(binary: pathlib.Path, run: Run) -> dict:
    """Every key of the run's configuration, without simulation: what is left open (0) stays so.
    Raises ValueError when it is refused, Failure when it fails."""
    done = call(binary, [*run.arguments(), "--print-config"])
    if done.returncode == REFUSED:
        raise ValueError(f"{run.label()}: {said(done)}")
    if done.returncode != 0:
        raise Failure(f"{run.label()}: {said(done)}")
    return json.loads(done.stdout)


def resolved_config(binary: pathlib.Path, run: Run) -> dict:
    """Every key of the run's configuration, with what was chosen where it leaves one open: as the
    report of its first view has it. Raises ValueError when it is refused, Failure when it fails."""
    return simulate(binary, run).accepted()[0]["config"]


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
    """Sum of a counter over all units that have it."""
    return sum(unit["counters"].get(counter, 0) for unit in view["units"].values())


def sram_bytes(view: dict) -> int:
    """On-chip memory that the accelerator has, whether or not this configuration fills it."""
    return sum(count for key, count in view["sram"].items() if key.endswith("_available_bytes"))


def psnr_text(view: dict) -> str:
    psnr_db = view["image"]["psnr_db"]
    return "equal" if psnr_db is None else f"{psnr_db:.2f}"
