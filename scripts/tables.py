"""Tables as Markdown and CSV."""

from __future__ import annotations

import csv
import io
import os
import pathlib
from collections.abc import Sequence

Row = Sequence[object]


def markdown(head: Sequence[str], rows: Sequence[Row]) -> str:
    """A Markdown table; numbers stand at the right."""

    def numeric(column: int) -> bool:
        return all(isinstance(row[column], (int, float)) for row in rows)

    rule = ["---:" if rows and numeric(column) else "---" for column in range(len(head))]
    lines = [head, rule, *([cell_text(cell) for cell in row] for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def cell_text(cell: object) -> str:
    """Integers with thousands marked; floats as given by their caller's rounding."""
    if isinstance(cell, int) and not isinstance(cell, bool):
        return f"{cell:,}"
    return str(cell).replace("|", "\\|")


def csv_text(head: Sequence[str], rows: Sequence[Row]) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return out.getvalue()


def write_text(path: pathlib.Path, text: str) -> None:
    """Writes a whole file or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_text(text)
    os.replace(part, path)
