"""What lies in a result folder: views of `streaminggs simulate`, runs below it, tables; and of
which kind what the page reads of a report.json has to be."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Iterator, Mapping

from reporting import charts
from runs.files import read_bytes, read_csv, read_json

REPORT = "report.json"
DEEPEST = 3  # folders below the one that is named: out/SCENE/CONFIG and one more
# Pictures of a view by file name: what they show.
PICTURES = {
    "frame.png": "frame",
    "reference.png": "reference",
    "error.png": "error",
    "missed.png": "missed",
    "misordered.png": "misordered",
    "right_frame.png": "right eye",
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
                png = charts.halved(png)
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
class Stream:
    """Frames back to back. report: of them one by one; all: machine and memory over all of them,
    and the sheet of pictures."""

    report: dict
    all: ViewFiles


@dataclasses.dataclass(frozen=True)
class Run:
    """Views of one `simulate`, or frames of its --path. name: of its folder, below the one that was
    named."""

    name: str
    views: tuple[ViewFiles, ...]
    failed: tuple[dict, ...] = ()  # views without a report: `view` and `why`
    path: str = ""  # name of the camera path; empty: views
    summary: dict = dataclasses.field(default_factory=dict)  # of a path
    stream: Stream | None = None  # of a path: then there are no views

    def shown(self) -> tuple[ViewFiles, ...]:
        """Views with a place of their own: of a path the slowest frame."""
        return (self.views[self.summary["worst_frame"]],) if self.summary else self.views


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
    head, rows = read_csv(path)
    for number, row in enumerate(rows, start=2):
        if not all(cell.isdecimal() for cell in row):
            raise ValueError(f"{path}:{number}: got {','.join(row)}, expected {len(head)} counts")
    return {name: [int(row[at]) for row in rows] for at, name in enumerate(head)}


def read_picture(path: pathlib.Path) -> Picture:
    """Raises ValueError where it is no whole PNG."""
    png = read_bytes(path)
    if not charts.is_whole(png):
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


def path_run(report: dict, folder: pathlib.Path, name: str) -> Run:
    """With the picture of the slowest frame. Raises ValueError."""
    views, slowest = report["views"], report["summary"]["worst_frame"]
    if slowest not in range(len(views)):
        got = f"got {slowest} of {len(views)} frames"
        raise ValueError(f"{folder / REPORT}: summary.worst_frame: {got}, expected one of them")
    pictures = {"frame": f"{slowest:04}.png", "right eye": f"{slowest:04}_right.png"}
    paths = {what: folder / "frames" / name for what, name in pictures.items()}
    found = {what: read_picture(path) for what, path in paths.items() if path.exists()}
    frames = tuple(ViewFiles(of, found if at == slowest else {}, {}) for at, of in enumerate(views))
    return Run(name, frames, path=report["path"]["name"], summary=report["summary"])


def stream_run(report: dict, folder: pathlib.Path, name: str) -> Run:
    """With the sheet of its pictures. Raises ValueError."""
    sheet = folder / "contact_sheet.png"
    found = {"frames": read_picture(sheet)} if sheet.exists() else {}
    whole = ViewFiles({**report["stream"]["all"], "config": report["config"]}, found, {})
    return Run(name, (), path=report["path"]["name"], stream=Stream(report["stream"], whole))


def read_run(folder: pathlib.Path, name: str) -> Run | None:
    """The run whose report.json the folder holds; None where it is of another kind."""
    file = folder / REPORT
    report = read_object(file)
    if "views" not in report:
        if "frame" not in report:
            return None
        check(file, report, VIEW)
        return Run(name, (view_files(report, folder),))
    if "stream" in report:
        check(file, report, STREAM)
        return stream_run(report, folder, name)
    if "path" in report:
        check(file, report, FRAMES)
        return path_run(report, folder, name)
    check(file, report, SEVERAL_VIEWS)
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
    head, rows = read_csv(path, killed_writer=True)
    return Table(path.stem, tuple(head), tuple(map(tuple, rows)))


# What the memory's energy in a stream is told by.
MEMORY_STATES = ("active", "precharged", "power_down", "self_refresh")
MEMORY_COMMANDS = ("activate", "read", "write", "refresh", "io")
NUMBER, TEXT, FLAG = (int, float), (str,), (bool,)
OBJECT, LIST = (dict,), (list,)
NAMES = {
    **{NUMBER: "a number", TEXT: "a text", FLAG: "true or false"},
    **{OBJECT: "an object", LIST: "a list", (type(None),): "null"},
}


class Each:
    """An object whose every value is of one shape, whatever their names."""

    def __init__(self, shape: object):
        self.shape = shape


class Or:
    """Of a shape, or null."""

    def __init__(self, shape: object):
        self.shape = shape


def numbers(*keys: str) -> dict[str, tuple]:
    return dict.fromkeys(keys, NUMBER)


# An object is a dictionary: keys that end with ? may be missing, others may be there. A list has one
# element: what all of it are.
WAIT = {"for": TEXT, "cycles": NUMBER, "on?": TEXT, "other_end?": TEXT, "key?": TEXT, "turn?": TEXT}
CAUSES = ("input", "reads", "writes", "room", "port", "loading", "phase", "idle")
ACTIVITY = {
    "resource": TEXT,
    "busy_cycles": NUMBER,
    "waited_cycles": numbers(*CAUSES),
    "waits": [WAIT],
}
BANDS = {"bands": Each(numbers("low", "high"))}
CONFIG = {"machine": TEXT, "clock_mhz": NUMBER, "rendering?": {"precision?": TEXT}}
VIEW = {
    "view": NUMBER,
    "scene": {"name": TEXT, **numbers("gaussians", "sh_degree")},
    "frame": numbers("width_px", "height_px", "cycles", "fps"),
    "image": {
        **{"psnr_db": Or(NUMBER), "ssim": NUMBER, "equals_streaming_renderer": FLAG},
        "right_eye?": {"psnr_db": Or(NUMBER)},
    },
    "limit": numbers("ratio"),
    "binding": {"unit": TEXT, "utilisation": NUMBER, "explanation": TEXT},
    "units": Each({"activities": Each(ACTIVITY), "counters": Each(NUMBER)}),
    "dram": {
        **numbers("bytes", "bus_bytes", "of_peak", "row_hits", "row_misses", "row_conflicts"),
        **numbers("bandwidth_gb_s", "peak_gb_s", "busy_bandwidth_gb_s"),
        **numbers("read_latency_mean_ns", "read_latency_p99_ns"),
        "bytes_by_region": Each(Each({"read?": NUMBER, "write?": NUMBER})),
        "bus_bytes_by_region": Each(NUMBER),
    },
    "energy": {
        **{**numbers("total_j", "mean_power_w"), "memory_known?": FLAG, **BANDS},
        "with_memory_interface_j?": numbers("low", "middle", "high"),
    },
    "fixed_rates?": [{**numbers("per_s"), "held": FLAG, "power_w?": numbers("middle")}],
    "area_mm2": {
        **{**numbers("total"), **BANDS},
        "with_memory_interface?": numbers("low", "middle", "high"),
        "by_owner?": Each(NUMBER),
    },
    "left_out": [{"what": TEXT, "count": NUMBER, "why": TEXT, "saves": TEXT}],
    "host": numbers("simulation_wall_s"),
    "config": CONFIG,
    "chosen?": [{"key": TEXT, "why": TEXT}],
    "provenance": {"version": TEXT, "commit": TEXT, "technology": TEXT, "command": TEXT},
}
SEVERAL_VIEWS = {"views": [VIEW], "failed?": [{"view": NUMBER, "why": TEXT}]}
FRAMES = {
    "views": [VIEW],
    "path": {"name": TEXT},
    "summary": numbers(
        *("frames", "worst_fps", "worst_frame", "p99_fps", "median_fps"),
        *("late_frames", "empty_frames", "frame_rate", "energy_a_second_j"),
    ),
}
OF_ONE_FRAME = ("view", "frame", "image", "limit", "config")  # and not of all frames of a stream
BAND = numbers("low", "middle", "high")
STREAM = {
    "config": CONFIG,
    "path": {"name": TEXT},
    "stream": {
        **numbers("frame_rate", "frames_per_s", "worst_frame", "missed_frames"),
        **numbers("pictures", "repeated_pictures", "rows_late"),
        "frame_time": numbers("median_s", "p99_s", "worst_s"),
        **dict.fromkeys(("latency", "latched_late"), numbers("median_s", "worst_s")),
        "flow": {
            **numbers("time_s", "frames", "bytes", "bus_bytes"),
            "energy": {**numbers("total_j"), **BANDS},
            **dict.fromkeys(("power_w", "with_memory_interface_w"), BAND),
            "memory": {
                **{f"{state}?": numbers("time_s", "energy_j") for state in MEMORY_STATES},
                **dict.fromkeys((f"{command}_j?" for command in MEMORY_COMMANDS), NUMBER),
            },
        },
        "frames": [numbers("frame")],
        "all": {
            **{key: shape for key, shape in VIEW.items() if key not in OF_ONE_FRAME},
            "frame": numbers("cycles"),
        },
    },
}


def kinds_of(shape: object) -> tuple:
    if isinstance(shape, tuple):
        return shape
    return LIST if isinstance(shape, list) else OBJECT


def check(file: pathlib.Path, found: object, shape: object, place: str = "") -> None:
    """Raises ValueError at the first place that is not of the shape."""
    if isinstance(shape, Or):
        if found is None:
            return
        shape = shape.shape
    kinds = kinds_of(shape)
    # To Python true is a number.
    if not isinstance(found, kinds) or isinstance(found, bool) != (shape == FLAG):
        got = NAMES[kinds_of_value(found)]
        raise ValueError(f"{file}: {place or 'all of it'}: got {got}, expected {NAMES[kinds]}")
    if isinstance(shape, list):
        for at, element in enumerate(found):
            check(file, element, shape[0], f"{place}[{at}]")
    elif isinstance(shape, Each):
        for key, value in found.items():
            check(file, value, shape.shape, below(place, key))
    elif isinstance(shape, dict):
        check_object(file, found, shape, place)


def check_object(
    file: pathlib.Path, found: Mapping[str, object], shape: Mapping[str, object], place: str
) -> None:
    for name, of_key in shape.items():
        key = name.removesuffix("?")
        if key in found:
            check(file, found[key], of_key, below(place, key))
        elif key == name:
            raise ValueError(f"{file}: no '{below(place, key)}', expected what `simulate` writes")
    if shape.get("bands") is BANDS["bands"]:  # of amounts that stand beside them
        check_object(file, found, numbers(*found["bands"]), place)


def kinds_of_value(found: object) -> tuple:
    return NUMBER if type(found) in NUMBER else (type(found),)


def below(place: str, key: str) -> str:
    return f"{place}.{key}" if place else key
