"""What figures are made from: tables that scripts wrote, and reports of `simulate`."""

from __future__ import annotations

import csv
import dataclasses
import pathlib
from collections.abc import Iterable

from runs.given_files import read_text
from reporting.report_folder import Run, find_runs


class Missing(Exception):
    """An input that is not there, or holds nothing to draw; the text says which."""


@dataclasses.dataclass(frozen=True)
class Data:
    """A CSV table: its rows by column, and the sentence of who made it."""

    rows: tuple[dict[str, str], ...]
    made: str

    def different(self, column: str) -> list[str]:
        """Values of a column, in the order in which they come."""
        return list(dict.fromkeys(row[column] for row in self.rows))

    def where(self, **wanted: str) -> list[dict[str, str]]:
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]


def number(text: str) -> float | None:
    """None where it is none, as `equal`."""
    try:
        return float(text.replace(",", "").removesuffix("%"))
    except ValueError:
        return None


class Results:
    """The folder of --from."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder

    def table(self, name: str, maker: str, columns: Iterable[str]) -> Data:
        """Raises Missing; ValueError where the table has not these columns."""
        path = self.folder / f"{name}.csv"
        if not path.exists():
            raise Missing(f"{path} is not there; scripts/{maker} makes it")
        head, *rows = list(csv.reader(read_text(path).splitlines())) or [[]]
        for column in columns:
            if column not in head:
                raise ValueError(f"{path}: columns {', '.join(head)}; expected {column}")
        for number_of_line, row in enumerate(rows, start=2):
            if len(row) != len(head):
                raise ValueError(
                    f"{path}:{number_of_line}: got {len(row)} cells, expected {len(head)}"
                )
        if not rows:
            raise Missing(f"{path} has no rows")
        return Data(tuple(dict(zip(head, row)) for row in rows), f"{path}. {self.made(name)}")

    def made(self, name: str) -> str:
        """The sentence above the same table in Markdown, which names command and commit."""
        path = self.folder / f"{name}.md"
        lines = path.read_text().splitlines() if path.exists() else []
        return next((line.replace("`", "") for line in lines if line.startswith("Made by ")), "")

    def runs(self) -> list[Run]:
        """Raises Missing."""
        found = [run for run in find_runs(self.folder) if run.views]
        if not found:
            raise Missing(f"{self.folder} has no report.json of `streaminggs simulate` below it")
        return found


def how_simulated(runs: Iterable[Run]) -> str:
    """Commits and commands of the runs' first views."""
    facts = [run.views[0].report["provenance"] for run in runs]
    commits = ", ".join(dict.fromkeys(fact["commit"] for fact in facts))
    commands = "; ".join(dict.fromkeys(fact["command"] for fact in facts))
    return f"Made by {commands}; commit {commits}."
