"""The points of a sweep on the report page: of each scene and view a diagram with its front, a
table, and each point's configuration with how to run it again."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import math
import pathlib
import shlex
from collections.abc import Callable, Collection, Sequence

from reporting import tables
from reporting.charts import details, escaped
from reporting.folder import Table, flat
from runs.files import read_csv, read_text
from runs.simulations import pareto_front, pictures_differ, value_at, with_pictures

DONE = "done"
STATUSES = (DONE, "refused", "failed")
# Memory that is built, by its name in a report and in a table.
MEMORIES = {
    f"sram.{memory}_bytes": f"sram.{memory}_needed_bytes"
    for memory in ("input", "codebook", "shared", "buffer")
}
WITH_PHY = "area_mm2.with_memory_interface.middle"  # results of earlier programs lack it
BINDING = "binding.unit"  # of PATHS the one that is no number
ENERGY, MEMORY_KNOWN = "energy.total_j", "energy.memory_known"
# Of a report, and columns of the table of the same names.
PATHS = (
    "frame.cycles",
    "frame.fps",
    ENERGY,
    "area_mm2.total",
    "image.psnr_db",
    "dram.bytes",
    "dram.bus_bytes",
    WITH_PHY,
    BINDING,
    *MEMORIES,
)
NEEDED = PATHS[:4]  # what every machine has; it takes time
FITTED = "fit_memories"
OF_POINT = ("scene", "cameras", "view", "size", "stereo", "config", FITTED)
NAMED = ("scene", "view", "config")  # of these, what every point has

Case = tuple[str, str, str, str, str]  # scene, view, size, stereo, cameras


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

    def case(self) -> Case:
        more = (self.asked.get(name, "") for name in ("size", "stereo", "cameras"))
        return self.asked["scene"], self.asked["view"], *more

    def machine(self) -> tuple:
        """Equal for points that have been asked for with the same configuration."""
        return self.asked["config"], FITTED in self.asked, *sorted(self.settings.items())

    def command(self) -> str:
        words = ["streaminggs", "simulate", self.asked["scene"], "--config", self.asked["config"]]
        for name in ("cameras", "view", "size", "stereo"):
            if value := self.asked.get(name):
                words += [f"--{name}", value]
        words += ["--fit-memories"] if FITTED in self.asked else []
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
        and (
            point.status != DONE
            or (all(path in point.told for path in NEEDED) and point.told["frame.fps"] > 0)
        )
    )


def with_known_energy(told: dict[str, object], memory_known: bool) -> dict[str, object]:
    """Joules without the memory's are no machine's: they count as more than any other's."""
    return told if memory_known or ENERGY not in told else {**told, ENERGY: math.inf}


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
            with_known_energy(
                {path: value for path in PATHS if (value := value_at(report, path)) is not None},
                value_at(report, MEMORY_KNOWN) is not False,
            ),
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


def is_fitted(key: str) -> bool:
    return key.startswith("sram.") and key != "sram.codebook_bytes"


def read_table(path: pathlib.Path) -> list[Point]:
    """Settings are those that the table shows, the model's choices among them, but no size of a
    fitted memory. Raises ValueError."""
    head, rows = read_csv(path)
    missing = [name for name in (*NAMED, "status", *NEEDED) if name not in head]
    if missing:
        raise ValueError(
            f"{path}: no column {', '.join(missing)}; expected a table of `streaminggs sweep --csv`"
        )
    keys = [key for key in head[head.index("config") + 1 : head.index("status")] if key != FITTED]
    points = []
    for number, row in enumerate(rows, start=2):
        cells = {name: cell for name, cell in zip(head, row) if cell}
        settings = {
            key: cells[key]
            for key in keys
            if key in cells and not (FITTED in cells and is_fitted(key))
        }
        point = Point(
            {name: cells[name] for name in OF_POINT if name in cells},
            settings,
            cells.get("status", ""),
            told=with_known_energy(
                {
                    path: number_in(cells[column])
                    for path, column in ((path, MEMORIES.get(path, path)) for path in PATHS)
                    if column in cells
                },
                cells.get(MEMORY_KNOWN) != "false",
            ),
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


BY_SCENE = "differs by scene"


def total(points: Sequence[Point], path: str) -> float:
    return sum(point.told[path] for point in points)


def psnr_db(point: Point) -> float:
    """Pictures that are equal have no number."""
    return float(point.told.get("image.psnr_db", math.inf))


def sram_kb(point: Point) -> float:
    return sum(point.told.get(path, 0) for path in MEMORIES) / 1e3


def binds(points: Sequence[Point]) -> str:
    return "+".join(sorted({str(point.told.get("binding.unit", "")) for point in points}))


# What a machine comes to on one case or on several: work is summed, of the rest the worst counts.
TIME = "ms"
PICTURE = "PSNR dB"
MEASURES: dict[str, Callable[[Sequence[Point]], float]] = {
    TIME: lambda points: sum(1e3 / point.told["frame.fps"] for point in points),
    "cycles": lambda points: total(points, "frame.cycles"),
    "fps": lambda points: min(point.told["frame.fps"] for point in points),
    "mJ": lambda points: 1e3 * total(points, ENERGY),
    "mm2": lambda points: max(point.told["area_mm2.total"] for point in points),
    "mm2 with PHY": lambda points: max(point.told.get(WITH_PHY, math.nan) for point in points),
    PICTURE: lambda points: min(map(psnr_db, points)),
    "DRAM MB": lambda points: sum(point.told.get("dram.bytes", 0) for point in points) / 1e6,
    "bus MB": lambda points: sum(point.told.get("dram.bus_bytes", math.nan) for point in points)
    / 1e6,
    "SRAM KB": lambda points: max(map(sram_kb, points)),
}
COSTS = (TIME, "mm2", "mJ")  # that the front is of, with the picture where pictures differ
MOST_REASONS = 200  # of points that were not done


@dataclasses.dataclass(frozen=True)
class Machine:
    """A configuration, with its points: one for each case."""

    points: tuple[Point, ...]

    @property
    def settings(self) -> dict[str, str]:
        asked = self.points[0].asked
        given = {name: asked[name] for name in ("config", FITTED) if name in asked}
        return {**given, **self.points[0].settings}

    def value(self, name: str) -> float:
        return MEASURES[name](self.points)

    def resolved(self) -> dict[str, str]:
        first, *others = (point.resolved for point in self.points)
        return {
            key: value if all(other.get(key) == value for other in others) else BY_SCENE
            for key, value in first.items()
        }


def cell(measure: str, value: float) -> str:
    if isinstance(value, int):
        return str(value)
    if math.isnan(value):
        return ""
    if value == math.inf:
        return "equal" if measure == PICTURE else "not known"
    return f"{value:.6g}"


def varying(machines: Sequence[Machine]) -> list[str]:
    """Settings that are not the same for all."""
    keys = dict.fromkeys(key for machine in machines for key in machine.settings)
    return [key for key in keys if len({machine.settings.get(key) for machine in machines}) > 1]


def table_of(machines: Sequence[Machine], best: Sequence[bool], name: str) -> Table:
    pictures = (PICTURE,) if pictures_differ([m.value(PICTURE) for m in machines]) else ()
    keys = varying(machines)
    head = ("point", *keys, *MEASURES, "binds", "front")
    rows = tuple(
        (
            str(number),
            *(machine.settings.get(key, "") for key in keys),
            *(cell(measure, machine.value(measure)) for measure in MEASURES),
            binds(machine.points),
            "yes" if kept else "",
        )
        for number, (machine, kept) in enumerate(zip(machines, best), start=1)
    )
    labels, costs = tuple(keys) or ("point",), (*COSTS, *pictures)
    return Table(name, head, rows, labels, costs, opens=True)


def configurations(machines: Sequence[Machine], table: Table) -> str:
    """What the page shows of one of them at a time: values by key, of each machine only those that
    are not the first one's."""
    resolved = [machine.resolved() for machine in machines]
    keys = list(dict.fromkeys(key for config in resolved for key in config))
    differing = {key for key in keys if len({config.get(key) for config in resolved}) > 1}
    first = resolved[0]
    facts = {
        "keys": keys,
        "first": [first.get(key) for key in keys],
        "differing": [at for at, key in enumerate(keys) if key in differing],
        "machines": [
            {
                "commands": [point.command() for point in machine.points],
                "other": {
                    at: config.get(key)
                    for at, key in enumerate(keys)
                    if config.get(key) != first.get(key)
                },
            }
            for machine, config in zip(machines, resolved)
        ],
        "names": tables.row_names(table),
    }
    return f'<div class=machine data-machines="{escaped(json.dumps(facts))}"></div>'


def section(machines: Sequence[Machine], title: str, most: int) -> str:
    """So many of them: those on the front first, the fastest at the top."""
    costs = [[machine.value(cost) for cost in COSTS] for machine in machines]
    best = pareto_front(with_pictures(costs, [machine.value(PICTURE) for machine in machines]))
    order = sorted(range(len(machines)), key=lambda at: (not best[at], machines[at].value(TIME)))
    shown = [machines[at] for at in order][:most]
    table = table_of(shown, [best[at] for at in order], title)
    left = len(machines) - len(shown)
    note = f"<p class=small>{left} points more are in the results.</p>" if left else ""
    return (
        f"<section class=wide><h3>{escaped(title)}</h3>{tables.content(table, title)}{note}"
        f"{configurations(shown, table)}</section>"
    )


def name_of(case: Case, all_cases: Collection[Case]) -> str:
    """Cameras only where others have all else."""
    scene, view, size, stereo, cameras = case
    alike = [other for other in all_cases if other[:4] == case[:4]]
    more = (size, stereo, cameras if len(alike) > 1 else "")
    return ", ".join([scene, f"view {view}", *filter(None, more)])


def technology_in_words(point: Point, all_points: Sequence[Point]) -> str:
    """Needs no word where there is but one."""
    if len({other.technology for other in all_points}) == 1:
        return ""
    return " ".join(filter(None, point.technology)) or "unknown technology"


def not_done(points: Sequence[Point]) -> str:
    """Why, a line each."""
    left = [point for point in points if point.status != DONE]
    lines = "".join(
        f"<li><code>{escaped(point.command())}</code><br>{escaped(point.status)}"
        f"{f': {escaped(point.reason)}' if point.reason else ''}</li>"
        for point in left[:MOST_REASONS]
    )
    if not left:
        return ""
    if len(left) > MOST_REASONS:
        lines += f"<li>{len(left) - MOST_REASONS} more</li>"
    return f"<section class=wide>{details(f'{len(left)} not done', f'<ul>{lines}</ul>')}</section>"


def panels(points: Sequence[Point]) -> list[tuple[str, str]]:
    """(name, text) of each tab; points of different technologies are not to be compared. Raises
    ValueError where no point was done."""
    done = [point for point in points if point.status == DONE]
    if not done:
        raise ValueError(f"no point was done: {points[0].reason or points[0].status}")
    technologies: dict[tuple, list[Point]] = {}
    for point in done:
        technologies.setdefault(point.technology, []).append(point)
    # The page has an end, however many views there are.
    tabs = sum(len({point.case() for point in of}) + 1 for of in technologies.values())
    most = tables.MOST_ROWS // tabs or 1
    made = [
        tab
        for of in technologies.values()
        for tab in panels_of_technology(of, technology_in_words(of[0], done), most)
    ]
    name, text = made[0]
    made[0] = (name, text + not_done(points))
    return [(name, f"<div class=grid>{text}</div>") for name, text in made]


def panels_of_technology(
    points: Sequence[Point], technology: str, most: int
) -> list[tuple[str, str]]:
    """Where there are several cases, first those machines that were simulated on all."""
    cases: dict[Case, list[Machine]] = {}
    by_machine: dict[tuple, list[Point]] = {}
    for point in points:
        cases.setdefault(point.case(), []).append(Machine((point,)))
        by_machine.setdefault(point.machine(), []).append(point)
    suffix = f", {technology}" if technology else ""
    made = []
    on_all = [Machine(tuple(of)) for of in by_machine.values() if len(of) == len(cases)]
    if len(cases) > 1 and on_all:
        title = f"Sums over {len(cases)} frames; fps and PSNR of the worst, area of the largest"
        made.append((f"all{suffix}", section(on_all, title + suffix, most)))
    names = {case: name_of(case, cases) + suffix for case in cases}
    return made + [(names[case], section(of, names[case], most)) for case, of in cases.items()]


def subtitle(points: Sequence[Point]) -> str:
    counts: dict[str, int] = {}
    for point in points:
        counts[point.status] = counts.get(point.status, 0) + 1
    words = [f"{len(points)} points", *(f"{count} {status}" for status, count in counts.items())]
    commits = sorted({point.commit for point in points} - {""})
    return " · ".join(words + ([f"commit {', '.join(commits)}"] if commits else []))
