"""Tables as Markdown and CSV."""

from __future__ import annotations

import csv
import io
import os
import pathlib
import re
from collections.abc import Sequence

Row = Sequence[object]

NUMBER = re.compile(r"-?[\d,]+(\.\d+)?(e[-+]\d+|%)?")


def markdown(head: Sequence[str], rows: Sequence[Row]) -> str:
    """A Markdown table; columns of numbers stand at the right."""

    def numeric(column: int) -> bool:
        filled = [text for row in rows if (text := cell_text(row[column]))]
        return bool(filled) and all(NUMBER.fullmatch(text) for text in filled)

    rule = ["---:" if numeric(column) else "---" for column in range(len(head))]
    lines = [head, rule, *([cell_text(cell) for cell in row] for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def cell_text(cell: object) -> str:
    """Integers with thousands marked, six digits of a fraction; anything else as its caller
    formatted it."""
    if isinstance(cell, int) and not isinstance(cell, bool):
        return f"{cell:,}"
    if isinstance(cell, float):
        return f"{cell:.6g}"
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
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)


def write(
    folder: pathlib.Path, name: str, made: str, head: Sequence[str], rows: Sequence[Row]
) -> None:
    """A table as NAME.md, with what stands above it, and as NAME.csv; and on the terminal."""
    text = made + markdown(head, rows)
    write_text(folder / f"{name}.md", text)
    write_text(folder / f"{name}.csv", csv_text(head, rows))
    print(f"{text}\n", flush=True)
