"""Runs of commands other than `simulate`, kept in folders, so that a script that is interrupted, or
run again, goes on where it ended. `sweep` keeps simulations (sweep_server.py)."""

from __future__ import annotations

import fcntl
import hashlib
import json
import pathlib
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from typing import IO

from runs.given_files import write_text
from runs.run_digest import content_digest, program_digest
from runs.simulations import Failure

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
        return self.folder / f"{name}_{digest}"

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
