"""Results of `streaminggs sweep`: its JSON lines, or the table of its --csv."""

from __future__ import annotations

import contextlib
import csv
import dataclasses
import json
import pathlib
import shlex

from runs.given_files import read_text
from measures import value_at
from reporting.report_folder import flat

DONE = "done"
STATUSES = (DONE, "refused", "failed")
MEMORIES = ("input", "codebook", "shared", "buffer")
BINDING = "binding.unit"  # of PATHS the one that is no number
# Of a report, and columns of the table of the same names.
PATHS = (
    "frame.cycles",
    "frame.fps",
    "energy.total_j",
    "area_mm2.total",
    "image.psnr_db",
    "dram.bytes",
    BINDING,
    *(f"sram.{memory}_available_bytes" for memory in MEMORIES),
)
NEEDED = PATHS[:4]  # what every machine has
OF_POINT = ("scene", "cameras", "view", "size", "config")
NAMED = ("scene", "view", "config")  # of these, what every point has


@dataclasses.dataclass(frozen=True)
class Point:
    """What was asked for, in its words, and what came of it. settings: over those of `config`;
    told: of PATHS, those that the report has; resolved: every key that is known of the
    configuration. technology: the cost table's name and digest, as far as they are known."""

    asked: dict[str, str]
    settings: dict[str, str]
    status: str
    reason: str = ""
    told: dict[str, object] = dataclasses.field(default_factory=dict)
    resolved: dict[str, str] = dataclasses.field(default_factory=dict)
    commit: str = ""
    technology: tuple[str, str] = ("", "")

    def case(self) -> tuple[str, str, str, str]:
        size, cameras = self.asked.get("size", ""), self.asked.get("cameras", "")
        return self.asked["scene"], self.asked["view"], size, cameras

    def machine(self) -> tuple:
        """Equal for points that have been asked for with the same configuration."""
        return self.asked["config"], *sorted(self.settings.items())

    def command(self) -> str:
        words = ["streaminggs", "simulate", self.asked["scene"], "--config", self.asked["config"]]
        for name in ("cameras", "view", "size"):
            if value := self.asked.get(name):
                words += [f"--{name}", value]
        for key, value in self.settings.items():
            words += ["--set", f"{key}={value}"]
        return shlex.join(words)


def text_of(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def no_result(place: str, text: str) -> ValueError:
    return ValueError(f"{place}: got {text[:40]!r}, expected a result of `streaminggs sweep`")


def is_result(point: Point) -> bool:
    """Whether it says what was asked for and what came of it, in numbers where these are due."""
    numbers = [value for path, value in point.told.items() if path != BINDING]
    return (
        point.status in STATUSES
        and all(name in point.asked for name in NAMED)
        and all(isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers)
        and (point.status != DONE or all(path in point.told for path in NEEDED))
    )


def point_of_line(line: str, place: str) -> Point:
    """Raises ValueError where it is no result."""
    try:
        result = json.loads(line)
        asked = result["point"]
        report = result.get("report", {})
        provenance = report.get("provenance", {})
        point = Point(
            {name: text_of(asked[name]) for name in OF_POINT if name in asked},
            {key: text_of(value) for key, value in asked["set"].items()},
            result["status"],
            text_of(result.get("reason", "")),
            {path: value for path in PATHS if (value := value_at(report, path)) is not None},
            {key: text_of(value) for key, value in flat(report.get("config", {}))},
            text_of(provenance.get("commit", "")),
            tuple(text_of(provenance.get(f"technology{of}", "")) for of in ("", "_xxh64")),
        )
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise no_result(place, line) from error
    if not is_result(point):
        raise no_result(place, line)
    return point


def read_lines(path: pathlib.Path) -> list[Point]:
    """Raises ValueError. What a killed sweep has left of its last line does not count."""
    *whole, last = read_text(path).split("\n")
    points = [point_of_line(line, f"{path}:{n}") for n, line in enumerate(whole, start=1)]
    with contextlib.suppress(ValueError):
        points.append(point_of_line(last, str(path)))
    return points


def number_in(text: str) -> object:
    """Of a cell; words as they are."""
    try:
        return float(text) if set(text) & set(".enif") else int(text)
    except ValueError:
        return text


def read_table(path: pathlib.Path) -> list[Point]:
    """Settings are those that the table shows, the model's choices among them. Raises
    ValueError."""
    head, *rows = list(csv.reader(read_text(path).splitlines())) or [[]]
    missing = [name for name in (*NAMED, "status", *NEEDED) if name not in head]
    if missing:
        raise ValueError(
            f"{path}: no column {', '.join(missing)}; expected a table of `streaminggs sweep --csv`"
        )
    keys = head[head.index("config") + 1 : head.index("status")]
    points = []
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            raise ValueError(f"{path}:{number}: got {len(row)} cells, expected {len(head)}")
        cells = {name: cell for name, cell in zip(head, row) if cell}
        settings = {key: cells[key] for key in keys if key in cells}
        point = Point(
            {name: cells[name] for name in OF_POINT if name in cells},
            settings,
            cells.get("status", ""),
            told={name: number_in(cells[name]) for name in PATHS if name in cells},
            resolved=settings,
        )
        if not is_result(point):
            raise no_result(f"{path}:{number}", ",".join(row))
        points.append(point)
    return points


def read_sweep(path: pathlib.Path) -> list[Point]:
    """Of each point what came last, of each technology. Raises ValueError where there is none."""
    points = read_table(path) if path.suffix == ".csv" else read_lines(path)
    if not points:
        raise ValueError(f"{path}: no results, expected those of `streaminggs sweep`")
    last: dict[tuple, Point] = {}
    for point in points:
        asked = (point.case(), point.machine())
        if point.status == DONE:
            last.pop((*asked, None), None)
        last[(*asked, point.technology if point.status == DONE else None)] = point
    return list(last.values())
