"""Tables of results. A table is two files: NAME.csv has a row a measurement, with numbers as they
were measured; NAME.json says what made them, of what, and what each column means. The Markdown of a
README comes from these two, and from about.json beside them: what a person says of a table, by its
name, so that a table made again leaves it as it is."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import io
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence

from runs.files import content_digest, program_digest, read_json, read_text, write_text
from runs.run_arguments import command_line
from runs.scenes import Scene

ABOUT = "about.json"
FIGURES = pathlib.Path(__file__).resolve().parents[1] / "figures.py"

Row = Sequence[object]
Cells = Mapping[str, str]

# A column of what is required, and of what is measured with or without an aggregate.
REQUIRED = re.compile(r"(.+) (>=|<=) ([-+.\de]+)")
MEASURE = re.compile(r"(?:\w+\()?([\w.]+)\)?")
NUMBER = re.compile(r"[-+]?[\d,]+(\.\d+)?(e[-+]\d+|%)?")


@dataclasses.dataclass(frozen=True)
class Column:
    """form: of its numbers in Markdown, as of format(); without, they stand there as measured."""

    name: str
    meaning: str
    unit: str = ""
    form: str = ""

    def shown(self, text: str) -> str:
        if not text or not self.form:
            return text.replace("|", "\\|")
        try:
            value = float(text)
        except ValueError:
            return text
        if math.isinf(value):
            return "equal" if self.unit == "dB" else text
        return format(int(value) if self.form[-1] in ",d" else value, self.form)


SCENE = Column("scene", "name of the scene")
VIEW = Column("view", "number of the camera")
SIZE = Column("size", "width and height of a view", "px")
PRESET = Column("preset", "configuration that was run, by its file in testbench/configs")
PSNR = Column("PSNR dB", "of the frame against the reference picture; inf: equal", "dB", ".2f")


@dataclasses.dataclass(frozen=True)
class Spread:
    """Markdown with a heading for each value of a column. cell: what stands below it, other columns
    in braces. mean_over: columns without a place there; of what they tell apart stands the mean
    over the values of the first, each the mean over those of the second, and so on."""

    across: str
    cell: str
    mean_over: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Made:
    """What made a table. program, inputs: digests, of scenes and data sets by name. minutes: of
    wall time, of all tables that one job makes, its interrupted starts included."""

    command: str
    commits: tuple[str, ...]
    releases: tuple[str, ...] = ()
    program: str = ""
    inputs: Mapping[str, str] = dataclasses.field(default_factory=dict)
    minutes: float | None = None

    def sentence(self) -> str:
        commits = f"; commit {', '.join(self.commits)}" if self.commits else ""
        return f"Made by `{self.command}`{commits}.\n\n"


def measure_of(column: str) -> str:
    """What a column is of, without aggregate and bound: fps of `min(fps) >= 90`."""
    required = REQUIRED.fullmatch(column)
    found = MEASURE.fullmatch(required[1] if required else column)
    return found[1] if found else column


def made(
    program: pathlib.Path, provenances: Iterable[dict], scenes: Iterable[Scene | pathlib.Path] = ()
) -> Made:
    """By this script. provenances: of the reports, as they have it."""
    told = list(provenances)
    inputs = {}
    for scene in scenes:
        paths = (scene.spec, scene.cameras) if isinstance(scene, Scene) else (scene,)
        inputs |= {path.name: tree_digest(path) for path in map(pathlib.Path, paths) if path.name}
    return Made(
        command_line(),
        *(tuple(sorted({p.get(key, "") for p in told} - {""})) for key in ("commit", "version")),
        program_digest(program),
        inputs,
    )


def tree_digest(path: pathlib.Path) -> str:
    """Of a file, of all files below a folder; empty for what is neither, as a built-in scene."""
    if path.is_dir():
        below = (file for file in sorted(path.rglob("*")) if file.is_file())
        text = "".join(f"{file.relative_to(path)} {content_digest(file)}\n" for file in below)
        return hashlib.sha256(text.encode()).hexdigest()[:16]
    return content_digest(path) if path.is_file() else ""


def made_of(program: pathlib.Path, views: Iterable[dict], scenes: Iterable[Scene] = ()) -> Made:
    """The same of reports of views."""
    return made(program, (view["provenance"] for view in views), scenes)


def write(folder: pathlib.Path, name: str, *table: object, **more: object) -> None:
    """What save() does, and the Markdown of the table on the terminal."""
    save(folder, name, *table, **more)
    print(f"{markdown_of(folder, name)}\n", flush=True)


def save(
    folder: pathlib.Path,
    name: str,
    by: Made,
    columns: Sequence[Column],
    rows: Iterable[Row],
    about: str = "",
    spread: Spread | None = None,
    only: Mapping[str, str] | None = None,
) -> None:
    """Both files of a table. about: what else a reader has to know. only: values of columns, which
    rows of the Markdown have."""
    names = [column.name for column in columns]
    if len(set(names)) < len(names):
        raise AssertionError(f"{name}: two columns of one name in {names}")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(names)
    for row in rows:
        writer.writerow([csv_cell(cell) for cell in check_row(name, names, row)])
    facts = {
        "about": about.strip(),
        "made": dataclasses.asdict(by),
        "columns": [dataclasses.asdict(column) for column in columns],
        "spread": spread and dataclasses.asdict(spread),
        "only": only or {},
    }
    write_text(folder / f"{name}.csv", out.getvalue())
    write_text(folder / f"{name}.json", json.dumps(facts, indent=1) + "\n")


def check_row(name: str, names: Sequence[str], row: Row) -> Row:
    if len(row) != len(names):
        raise AssertionError(f"{name}: {len(row)} cells {row} for columns {names}")
    return row


def csv_cell(cell: object) -> object:
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return "" if cell is None else cell


def facts_of(folder: pathlib.Path, name: str) -> dict:
    """What NAME.json says. Raises ValueError where it is of something else, OSError."""
    path = folder / f"{name}.json"
    facts = read_json(path)
    if not isinstance(facts, dict) or not {"made", "columns", "spread", "only"} <= facts.keys():
        raise ValueError(f"{path}: expected what says how a table was made")
    return facts


def about_of(folder: pathlib.Path, name: str) -> str:
    """What to know of a table: what its study says, then what a person says. Raises ValueError,
    OSError."""
    of_study, by_hand = facts_of(folder, name)["about"], said_by_hand(folder).get(name, "")
    return "\n\n".join(filter(None, [of_study, by_hand]))


def said_by_hand(folder: pathlib.Path) -> dict[str, str]:
    """By the names of tables. Raises ValueError, OSError."""
    path = folder / ABOUT
    found = read_json(path) if path.exists() else {}
    if not isinstance(found, dict):
        raise ValueError(f"{path}: expected texts by the names of tables")
    return found


def join(
    folder: pathlib.Path, name: str, parts: Sequence[pathlib.Path], minutes: float
) -> None:
    """Writes the table with the rows of the parts, which are folders that have one of its name.
    Raises ValueError where their columns differ, OSError."""
    facts = [facts_of(part, name) for part in parts]
    first = facts[0]
    if any(of["columns"] != first["columns"] for of in facts):
        raise ValueError(f"{name}: its calls made tables of different columns")
    rows = [row for part in parts for row in read_rows(part, name)]
    made = [Made(**of["made"]) for of in facts]
    by = Made(
        "; ".join(each.command for each in made),
        tuple(sorted({commit for each in made for commit in each.commits})),
        tuple(sorted({release for each in made for release in each.releases})),
        ", ".join(dict.fromkeys(each.program for each in made)),
        {name: digest for each in made for name, digest in each.inputs.items()},
        minutes,
    )
    save(
        *(folder, name, by, [Column(**of) for of in first["columns"]]),
        [list(row.values()) for row in rows],
        "\n\n".join(dict.fromkeys(of["about"] for of in facts)),
        first["spread"] and Spread(**first["spread"]),
        first["only"],
    )


def made_sentence(facts: dict) -> str:
    return Made(**facts["made"]).sentence()


def read_rows(folder: pathlib.Path, name: str) -> list[dict[str, str]]:
    """Raises ValueError for a row of more or fewer cells than the head."""
    path = folder / f"{name}.csv"
    head, *rows = list(csv.reader(read_text(path).splitlines())) or [[]]
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            raise ValueError(f"{path}:{number}: got {len(row)} cells, expected {len(head)}")
    return [dict(zip(head, row)) for row in rows]


def markdown_of(folder: pathlib.Path, name: str) -> str:
    """What a README has of a table: who made it, what to know, its rows. Raises ValueError,
    OSError."""
    about = about_of(folder, name)
    said = f"{about}\n\n" if about else ""
    return made_sentence(facts_of(folder, name)) + said + table_of(folder, name)


def table_of(
    folder: pathlib.Path,
    name: str,
    chosen: Mapping[str, Sequence[str]] | None = None,
    shown: Sequence[str] = (),
) -> str:
    """Its rows alone. chosen: values of columns, which rows that are shown have. shown: columns;
    without, all of them. Raises ValueError, OSError."""
    facts = facts_of(folder, name)
    columns = {of["name"]: Column(**of) for of in facts["columns"]}
    wanted = {key: (value,) for key, value in facts["only"].items()} | dict(chosen or {})
    if unknown := {*wanted, *shown} - columns.keys():
        raise ValueError(f"{folder / name}.csv: no column {', '.join(sorted(unknown))}")
    rows = [
        row
        for row in read_rows(folder, name)
        if all(row[key] in values for key, values in wanted.items())
    ]
    if facts["spread"]:
        return spread_out(columns, rows, Spread(**facts["spread"]))
    named = shown or [name for name in columns if name not in facts["only"]]
    return markdown(*ranges(named, [[columns[n].shown(r[n]) for n in named] for r in rows]))


def ranges(
    head: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[list[str], list[list[str]]]:
    """With a column `X, least` and `X, most` behind it as one: `1 .. 2`."""
    pairs = {
        at
        for at, (name, after) in enumerate(zip(head, head[1:]))
        if name.endswith(", least") and after == name.removesuffix("least") + "most"
    }

    def joined(cells: Sequence[str], between: Callable[[str, str], str]) -> list[str]:
        return [
            between(cell, cells[at + 1]) if at in pairs else cell
            for at, cell in enumerate(cells)
            if at - 1 not in pairs
        ]

    return (
        joined(head, lambda least, _: f"{least} .. most"),
        [joined(row, lambda a, b: a if a == b else f"{a} .. {b}") for row in rows],
    )


def spread_out(columns: Mapping[str, Column], rows: Sequence[Cells], how: Spread) -> str:
    measured = [name for name in columns if f"{{{name}}}" in how.cell]
    hidden = {how.across, *measured, *how.mean_over}
    named = [name for name in columns if name not in hidden]
    headings = list(dict.fromkeys(row[how.across] for row in rows))
    lines: dict[tuple, dict[str, list[Cells]]] = {}
    for row in rows:
        line = lines.setdefault(tuple(row[name] for name in named), {})
        line.setdefault(row[how.across], []).append(row)

    def cell(of: Sequence[Cells]) -> str:
        if not of:
            return ""
        values = of[0] if not how.mean_over else mean_cells(of, measured, how.mean_over)
        return how.cell.format_map({n: columns[n].shown(values[n]) for n in measured})

    body = [
        [
            *(columns[name].shown(value) for name, value in zip(named, key)),
            *(cell(of.get(heading, ())) for heading in headings),
        ]
        for key, of in lines.items()
    ]
    return markdown([*named, *headings], body)


def mean_cells(rows: Sequence[Cells], names: Sequence[str], over: Sequence[str]) -> Cells:
    def mean(of: Sequence[Cells], name: str, over: Sequence[str]) -> float:
        if not over:
            return statistics.fmean(float(row[name]) for row in of)
        groups = [
            [row for row in of if row[over[0]] == value]
            for value in dict.fromkeys(row[over[0]] for row in of)
        ]
        return statistics.fmean(mean(group, name, over[1:]) for group in groups)

    return {name: repr(mean(rows, name, over)) for name in names}


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table; columns of numbers stand at the right."""

    def rule(column: int) -> str:
        filled = [row[column] for row in rows if row[column]]
        return "---:" if filled and all(map(NUMBER.fullmatch, filled)) else "---"

    lines = [head, [rule(column) for column in range(len(head))], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def draw_beside(tables: pathlib.Path, *names: str) -> None:
    """Those of these figures that the folder's tables have something for, by a script of its own,
    which may need another Python. Where there are none, or no Matplotlib, a line says why: the
    tables are what counts. No figure of earlier tables stays beside them."""
    for name in names:
        for suffix in ("svg", "png"):
            (tables / f"{name}.{suffix}").unlink(missing_ok=True)
    words = [sys.executable, "-B", str(FIGURES), *names]
    words += ["--from", str(tables), "--out", str(tables)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"no figure: {(done.stdout or done.stderr).splitlines()[0]}", file=sys.stderr)
