"""What lies in a result folder: views of `streaminggs simulate`, runs below it, tables."""

from __future__ import annotations

import csv
import dataclasses
import pathlib
from collections.abc import Iterator

from reporting import png_pictures, report_shape
from runs.given_files import read_bytes, read_json, read_text

REPORT = "report.json"
PATH = "path.json"
DEEPEST = 3  # folders below the one that is named: out/SCENE/CONFIG and one more
# Pictures of a view by file name: what they show.
PICTURES = {
    "frame.png": "frame",
    "reference.png": "reference",
    "error.png": "error",
    "missed.png": "missed",
    "misordered.png": "misordered",
}


@dataclasses.dataclass(frozen=True)
class Picture:
    """A PNG file."""

    path: pathlib.Path
    png: bytes

    def halved(self, times: int) -> bytes:
        """The file, its sides halved so often. Raises ValueError for what `simulate` does not
        write."""
        png = self.png
        try:
            for _ in range(times):
                png = png_pictures.halved(png)
        except ValueError as error:
            raise ValueError(f"{self.path}: {error}") from error
        return png


@dataclasses.dataclass(frozen=True)
class ViewFiles:
    """A view's report and what lies beside it. pictures: by what they show; groups: columns of
    groups.csv, by name."""

    report: dict
    pictures: dict[str, Picture]
    groups: dict[str, list[int]]


@dataclasses.dataclass(frozen=True)
class Run:
    """Views of one `simulate`. name: of its folder, below the one that was named."""

    name: str
    views: tuple[ViewFiles, ...]
    failed: tuple[dict, ...] = ()  # views without a report: `view` and `why`


@dataclasses.dataclass(frozen=True)
class Table:
    """labels: the columns that name a row; where there are none, those that are not numbers. costs:
    of which the front is, drawn at first up, across and as the size of points; none: any. opens:
    the first column numbers what the page can show more of."""

    name: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    labels: tuple[str, ...] = ()
    costs: tuple[str, ...] = ()
    opens: bool = False


def read_object(path: pathlib.Path) -> dict:
    """Raises ValueError where it is no object of JSON."""
    found = read_json(path)
    if not isinstance(found, dict):
        raise ValueError(f"{path}: {type(found).__name__}, expected an object")
    return found


def flat(config: dict, path: str = "") -> list[tuple[str, object]]:
    """(key.path, value) of every leaf."""
    found: list[tuple[str, object]] = []
    for key, value in config.items():
        below = flat(value, f"{path}{key}.") if isinstance(value, dict) else [(path + key, value)]
        found += below
    return found


def read_groups(path: pathlib.Path) -> dict[str, list[int]]:
    """Raises ValueError where a line is not whole numbers, as many as there are names."""
    if not path.exists():
        return {}
    head, *rows = list(csv.reader(read_text(path).splitlines())) or [[]]
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head) or not all(cell.isdecimal() for cell in row):
            raise ValueError(f"{path}:{number}: got {','.join(row)}, expected {len(head)} counts")
    return {name: [int(row[at]) for row in rows] for at, name in enumerate(head)}


def read_picture(path: pathlib.Path) -> Picture:
    """Raises ValueError where it is no whole PNG."""
    png = read_bytes(path)
    if not png_pictures.is_whole(png):
        raise ValueError(f"{path}: got no whole PNG, expected one")
    return Picture(path, png)


def view_files(report: dict, folder: pathlib.Path) -> ViewFiles:
    """Raises ValueError."""
    found = {
        what: read_picture(folder / name)
        for name, what in PICTURES.items()
        if (folder / name).exists()
    }
    return ViewFiles(report, found, read_groups(folder / "groups.csv"))


def read_path(folder: pathlib.Path) -> dict:
    """What `simulate --path` says of all frames. Raises ValueError."""
    report = read_object(folder / PATH)
    report_shape.check(folder / PATH, report, report_shape.PATH)
    return report


def read_run(folder: pathlib.Path, name: str) -> Run | None:
    """The run whose report.json the folder holds; None where it is of another kind."""
    file = folder / REPORT
    report = read_object(file)
    if "views" not in report:
        if "frame" not in report:
            return None
        report_shape.check(file, report, report_shape.VIEW)
        return Run(name, (view_files(report, folder),))
    report_shape.check(file, report, report_shape.SEVERAL_VIEWS)
    views = tuple(view_files(view, folder / f"view_{view['view']}") for view in report["views"])
    return Run(name, views, tuple(report.get("failed", ())))


def find_runs(folder: pathlib.Path, name: str = "", depth: int = 0) -> Iterator[Run]:
    """Raises ValueError."""
    if (folder / REPORT).exists():
        run = read_run(folder, name)
        if run is not None:
            yield run
            return
    if depth == DEEPEST:
        return
    for below in sorted(path for path in folder.iterdir() if path.is_dir()):
        yield from find_runs(below, f"{name}/{below.name}".lstrip("/"), depth + 1)


def find_tables(folder: pathlib.Path) -> list[Table]:
    """CSV files with a head and at least one row. Raises ValueError."""
    paths = [path for path in sorted(folder.glob("*.csv")) if path.name != "groups.csv"]
    return [table for table in map(read_table, paths) if table.rows]


def read_table(path: pathlib.Path) -> Table:
    """Raises ValueError for a row of more or fewer cells than the head. What a killed writer has
    left of its last line does not count."""
    text = read_text(path)
    head, *rows = list(csv.reader(text.splitlines())) or [[]]
    if rows and len(rows[-1]) != len(head) and not text.endswith("\n"):
        rows.pop()
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            raise ValueError(f"{path}:{number}: got {len(row)} cells, expected {len(head)}")
    return Table(path.stem, tuple(head), tuple(map(tuple, rows)))
