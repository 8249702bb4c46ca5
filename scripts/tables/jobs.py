"""The stated job of a study: the calls of scripts that make its tables in traces/results, its JOBS.
Each call of results.py has a folder of its own, so that one which is done is not done again; a call
of explore.py goes on by itself. Tables of one name, of several calls, become one."""

from __future__ import annotations

import dataclasses
import hashlib
import pathlib
import shlex
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import IO

import tables
from runs.files import write_text
from runs.keeper import Keeper
from runs.simulations import REFUSED, Failure

BEAT_SECONDS = 30  # what is lost of the minutes where this is killed


@dataclasses.dataclass(frozen=True)
class Called:
    """folder: with tables; none of explore.py. minutes: of wall time, of all its starts with this
    program together."""

    folder: pathlib.Path | None
    minutes: float


class Jobs:
    """scripts: their folder. kept: as of --kept. From the folder that they are run in outputs of
    explore.py are named."""

    def __init__(
        self, binary: pathlib.Path, scripts: pathlib.Path, kept: pathlib.Path, start: pathlib.Path
    ):
        """Raises ValueError when there is no such program."""
        self.keeper = Keeper(binary, kept / "jobs")
        self.scripts, self.kept, self.start = scripts, kept, start
        sources = sorted(path for path in scripts.rglob("*.py"))
        text = "".join(f"{path.relative_to(scripts)} {path.read_text()}" for path in sources)
        self.digest = hashlib.sha256(text.encode()).hexdigest()

    def make(self, study: str, calls: Sequence[str], out: pathlib.Path) -> list[str]:
        """Writes the study's tables; returns their names. Raises Failure, ValueError."""
        done = [self.called(study, shlex.split(call)) for call in calls]
        minutes = sum(each.minutes for each in done)
        folders = [each.folder for each in done if each.folder]
        names = dict.fromkeys(p.stem for f in folders for p in sorted(f.glob("*.csv")))
        for name in names:
            of = [folder for folder in folders if (folder / f"{name}.csv").exists()]
            tables.join(out, name, of, minutes)
        return list(names)

    def called(self, study: str, words: Sequence[str]) -> Called:
        script, *more = words
        clock = self.keeper.place(f"{study} clock", words)
        if script != "results.py":
            return Called(None, self.run(words, clock))

        def make(place: pathlib.Path, lock: IO) -> float:
            own = ["--out", str(place.absolute()), "--kept", str(self.kept.absolute())]
            return self.run([*words, *own], clock, lock)

        facts = [self.digest, *words, *map(str, self.explored(words))]
        return Called(*self.keeper.kept(study, facts, make))

    def explored(self, words: Sequence[str]) -> list[pathlib.Path]:
        """Folders that explore.py wrote, which a call names as NAME=FOLDER."""
        places = (self.start / word.partition("=")[2] for word in words if "=" in word)
        return [place for place in places if (place / "explore.json").exists()]

    def run(self, words: Sequence[str], clock: pathlib.Path, lock: IO | None = None) -> float:
        """Minutes, with those in the file of the clock. What it prints but for progress is in its
        tables."""
        earlier = float(clock.read_text()) if clock.exists() else 0.0
        began = time.monotonic()
        call = subprocess.Popen(
            [sys.executable, "-B", str(self.scripts / words[0]), *words[1:]],
            stdout=subprocess.DEVNULL,
            cwd=self.start,
            pass_fds=(lock.fileno(),) if lock else (),
        )
        status = None
        while status is None:
            try:
                status = call.wait(BEAT_SECONDS)
            except subprocess.TimeoutExpired:
                pass
            except KeyboardInterrupt:
                call.wait()  # it has heard it as well, and saves what is under way
                raise
            finally:
                minutes = earlier + (time.monotonic() - began) / 60
                write_text(clock, f"{minutes:.4f}\n")
        if status:
            kind = ValueError if status == REFUSED else Failure
            raise kind(f"{shlex.join(words)}: ended with exit status {status}")
        return minutes
