"""Programs that are built beside the command and print tables."""

from __future__ import annotations

import pathlib
import subprocess
from collections.abc import Sequence

from runs.scenes import REFUSED, Failure


def beside(streaminggs: pathlib.Path, name: str) -> pathlib.Path:
    """Raises ValueError where it is not built."""
    program = streaminggs.with_name(name)
    if not program.is_file():
        raise ValueError(f"{program}: not there; scripts/setup.sh release {name} builds it")
    return program


def printed(program: pathlib.Path, words: Sequence[str]) -> str:
    """Raises ValueError for what it refuses, Failure where it ends badly."""
    done = subprocess.run(
        [str(program.absolute()), *words], capture_output=True, text=True, check=False
    )
    last_said, last_printed = (
        text.rstrip().rpartition("\n")[2] for text in (done.stderr, done.stdout)
    )
    if done.returncode == REFUSED:
        raise ValueError(last_said)
    if done.returncode:
        raise Failure(f"{program.name}: exit status {done.returncode}: {last_printed} {last_said}")
    return done.stdout


def markdown_table(text: str, cells: int) -> tuple[list[str], list[list[str]]]:
    """Head and rows of the table in it. Raises ValueError for another count of cells, and where
    there is no row."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    head, *rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines] or [[]]
    if len(rows) < 2 or any(len(row) != cells for row in (head, *rows[1:])):
        raise ValueError(f"got {lines[:1] or text[:80]}, expected a table of {cells} columns")
    return head, rows[1:]  # without the rule
