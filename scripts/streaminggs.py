"""The command from Python, without a build step: `run()` simulates, `load()` reads what lies in a
folder, both as dictionaries, one a view with the keys of report.json; `table()` makes a data frame
of them, `diff()` says where two differ. `sweep()` simulates many configurations, with scenes and
their pictures prepared once, and makes a data frame of them.

  import sys; sys.path.insert(0, "scripts")
  import streaminggs
  small, large = (
      streaminggs.run("builtin:object?n=20000", settings={"hfus": hfus}, fit_memories=True)[0]
      for hfus in (2, 8)
  )
  print(small["frame"]["cycles"], large["frame"]["cycles"])
  for key, before, after, change in streaminggs.diff(small, large)[:10]:
      print(f"{key}: {before} -> {after}")
  frame = streaminggs.table([small, large], more=["config"])  # pandas
  frame[["config.hfus", *streaminggs.COLUMNS["frame"], "binding.holds"]]
  points = streaminggs.grid({"hfus": [2, 4, 8], "hfu.ffu_lanes": [8, 16]})
  streaminggs.sweep(points, ["builtin:object"], fit_memories=True)
"""

from __future__ import annotations

import importlib.util
import itertools
import math
import os
import pathlib
import tempfile
from collections.abc import Iterator, Mapping, Sequence

from reporting.folder import find_runs
from runs import simulations
from runs.keeper import SweepServer
from runs.scenes import (
    BINARY,
    Failure,  # what callers catch
    Scene,
    find_scene,
    find_scenes,
    view_numbers,
)

Settings = Mapping[str, object]  # keys of the configuration

# Columns of every data frame, by group, in this order: paths of report.json, which REPORT.md beside
# the command explains. A machine that has no such number leaves its column empty.
COLUMNS: dict[str, tuple[str, ...]] = {
    "scene": ("scene.name", "scene.gaussians", "scene.stored_by", "scene.stored_bytes"),
    "machine": (
        *("config.machine", "config.clock_mhz", "config.storage.encoding"),
        *("config.rendering.precision", "config.dram.memspec", "config.dram.channels"),
    ),
    "frame": (*("frame.cycles", "frame.time_s", "frame.fps", "frame.width_px", "frame.height_px"),),
    "image": (
        *("image.psnr_db", "image.ssim", "image.max_abs_error"),
        *("image.missed", "image.misordered"),
    ),
    "bottleneck": (
        *("binding.unit", "binding.utilisation", "binding.holds", "binding.key", "binding.turn"),
        *("binding.next", "binding.next_utilisation", "binding.explanation"),
    ),
    "dram": (
        *("dram.bytes", "dram.bus_bytes", "dram.row_hits", "dram.row_misses"),
        *("dram.row_conflicts", "dram.refreshes", "dram.bandwidth_gb_s", "dram.peak_gb_s"),
        *("dram.of_peak", "dram.read_latency_mean_ns", "dram.read_latency_p99_ns"),
    ),
    "limit": ("limit.bytes_read_once", "limit.ratio"),
    "energy": (
        *("energy.total_j", "energy.mean_power_w", "energy.dram_j", "energy.clock_j"),
        *("energy.logic_leakage_j", "energy.sram_leakage_j", "energy.memory_known"),
    ),
    "area": (
        *("area_mm2.total", "area_mm2.bands.total.low", "area_mm2.bands.total.high"),
        *("area_mm2.sram", "area_mm2.with_memory_interface.middle"),
    ),
    "provenance": (
        *("provenance.version", "provenance.commit", "provenance.technology"),
        "host.simulation_wall_s",
    ),
}
PSNR = "image.psnr_db"


def run(
    scene: str | pathlib.Path,
    *,
    cameras: str | pathlib.Path = "",
    view: str | int = 0,
    size: str = "",
    config: str | pathlib.Path = "exact",
    settings: Settings | None = None,
    fit_memories: bool = False,
    stereo: str = "",
    out: str | pathlib.Path | None = None,
    program: str | pathlib.Path = BINARY,
) -> list[dict]:
    """Simulates and gives the report of each view.

    scene: builtin:NAME?n=COUNT, a real scene of ../shared by name, or a file or folder of any form
    that the command reads, with `cameras`, or with NAME.json beside it. view: a number, "0,2" or
    "all". size: "WxH". settings: keys of the configuration over those of `config`. fit_memories: as
    the option, on-chip memories as large as all else needs. stereo: "ipd=DISTANCE" as the option, a
    second eye beside each camera. out: a folder that keeps pictures and reports.

    Raises ValueError for what the command refuses, Failure where a simulation ends badly or a frame
    is not the model's.
    """
    check_text("size", size)
    check_text("stereo", stereo)
    if cameras:
        found = Scene(pathlib.Path(scene).stem, str(scene), str(cameras))
    else:
        found = find_scene(str(scene))
    own = assignments(settings or {})
    job = simulations.Run(found, str(view), size, str(config), own, fit_memories, stereo)
    if out is None:
        outcome = simulations.simulate(pathlib.Path(program), job)
    else:
        outcome = simulations.simulate_into(pathlib.Path(out), pathlib.Path(program), job)
    return list(outcome.accepted())


def assignments(settings: Settings) -> tuple[str, ...]:
    """As --set takes them."""
    return tuple(
        f"{key}={str(value).lower() if isinstance(value, bool) else value}"
        for key, value in settings.items()
    )


def grid(axes: Mapping[str, Sequence[object]]) -> list[dict[str, object]]:
    """Points for `sweep()`: every combination of the values of each key, the last one fastest.
    Raises ValueError for values that are no list."""
    for key, values in axes.items():
        check_list(key, values)
    return [dict(zip(axes, values)) for values in itertools.product(*axes.values())]


def check_list(place: str, given: object) -> None:
    """Raises ValueError for one of what there should be several of: a text would be taken letter by
    letter, a dictionary key by key."""
    if isinstance(given, (str, pathlib.Path, Mapping)):
        raise ValueError(f"{place}: got {given!r}, expected a list")


def check_text(place: str, given: object) -> None:
    """Raises ValueError for a number, as 0.064 in place of "ipd=0.064"."""
    if not isinstance(given, str):
        raise ValueError(f"{place}: got {given!r}, expected a text")


def sweep(
    points: Sequence[Settings],
    scenes: Sequence[str | pathlib.Path],
    views: str | int = 0,
    *,
    cameras: str | pathlib.Path = "",
    size: str = "",
    config: str | pathlib.Path = "exact",
    settings: Settings | None = None,
    fit_memories: bool = False,
    stereo: str = "",
    jobs: int = os.cpu_count() or 1,
    results: str | pathlib.Path | None = None,
    more: Sequence[str] = (),
    program: str | pathlib.Path = BINARY,
):
    """Simulates each point on each view of each scene and gives a line for each, in that order: its
    scene, view and settings, `status` (done, refused or failed), `reason` where it is not done, then
    COLUMNS and `more` as of table(). A pandas data frame where there is pandas (Debian's
    python3-pandas), else a list of dictionaries with these columns.

    points: settings over `settings`, which are over those of `config`; scenes, views, size,
    fit_memories, stereo: as run() has them. cameras: of all scenes that are files or folders. jobs:
    simulations side by side. results: a file of JSON lines, which keeps what was simulated and of
    which nothing is simulated again; without it nothing is kept.

    Raises ValueError for arguments that are none, Failure where the command itself fails.
    """
    if jobs < 1:
        raise ValueError(f"jobs: {jobs}, expected at least 1")
    check_list("points", points)
    check_list("scenes", scenes)
    check_list("more", more)
    check_text("size", size)
    check_text("stereo", stereo)
    binary = pathlib.Path(program)
    found = find_scenes([str(scene) for scene in scenes], [str(cameras)] if cameras else [])
    cases = [
        (point, simulations.Run(scene, str(view), size, str(config), own, fit_memories, stereo))
        for scene in found
        for point in points
        for own in [assignments(settings or {}) + assignments(point)]
        for view in view_numbers(binary, scene, str(views))
    ]
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        kept = pathlib.Path(results or f"{folder}/sweep.jsonl")
        with SweepServer(binary, kept, jobs) as server:
            outcomes = server.outcomes([job for _, job in cases])
    rows = [swept(point, outcome, more) for (point, _), outcome in zip(cases, outcomes)]
    return frame(rows) if importlib.util.find_spec("pandas") else rows


def swept(point: Settings, outcome: simulations.Outcome, more: Sequence[str]) -> dict[str, object]:
    """A line of `sweep()`."""
    job = outcome.run
    status = "failed" if outcome.failure else "refused" if outcome.refused else "done"
    line = {"scene": job.scene.name, "view": int(job.view), **point}
    line |= {"status": status, "reason": outcome.refused}
    return line | {path: value for view in outcome.views for path, value in cells(view, more)}


def load(folder: str | pathlib.Path) -> list[dict]:
    """The reports of all views, or frames of a path, of a result folder, or of those at most three
    folders below. Raises ValueError where there are none."""
    if not pathlib.Path(folder).is_dir():
        raise ValueError(f"{folder}: no folder, expected one with results")
    runs = list(find_runs(pathlib.Path(folder)))
    reports = [files.report for run_of in runs for files in run_of.views]
    if not reports and runs:
        raise ValueError(
            f"{folder}: got frames back to back, expected views or a path without --stream; `stream` "
            "of report.json tells of these"
        )
    if not reports:
        raise ValueError(f"{folder}: no report.json of `streaminggs simulate` in it or below")
    return reports


def leaves(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    """(key.path, value) of everything in a report that is no dictionary; entries of lists by their
    place."""
    if isinstance(value, Mapping):
        entries = value.items()
    elif isinstance(value, list):
        entries = enumerate(value)
    else:
        yield path, value
        return
    for key, below in entries:
        yield from leaves(below, f"{path}.{key}" if path else str(key))


def numbers(view: dict) -> dict[str, float]:
    """Every number of a report by its path, such as `dram.bus_bytes`."""
    return {
        path: value
        for path, value in leaves(view)
        if isinstance(value, (int, float)) and not isinstance(value, bool)
    }


def cells(view: dict, more: Sequence[str]) -> Iterator[tuple[str, object]]:
    """(path, value) of COLUMNS, then of every leaf below the paths of `more`. A picture that equals
    the reference has infinite PSNR."""
    found = dict(leaves(view))
    chosen = [path for of_group in COLUMNS.values() for path in of_group]
    chosen += [path for of in more for path in found if f"{path}.".startswith(f"{of}.")]
    for path in dict.fromkeys(chosen):
        equal = path == PSNR and path in found and found[path] is None
        yield path, math.inf if equal else found.get(path)


def table(views: Sequence[dict], more: Sequence[str] = ()):
    """A pandas data frame: a line a view with COLUMNS. more: paths of whose leaves there are columns
    as well, such as "config", "units.merge" or "energy". Raises ValueError without pandas."""
    check_list("more", more)
    return frame([dict(cells(view, more)) for view in views])


def frame(rows: Sequence[dict]):
    """Raises ValueError without pandas."""
    try:
        import pandas
    except ImportError as error:
        raise ValueError("pandas: not there; apt-get install python3-pandas") from error
    return pandas.DataFrame(rows)


Difference = tuple[str, object, object, float]  # path, before, after, (after - before) / |before|


def diff(before: dict, after: dict) -> list[Difference]:
    """Where the reports of two views differ but for the host and the command: what is no number, or
    is in one of them only (None in the other), first, with an infinite change; then what changed
    most of itself."""
    one, other = (
        {k: v for k, v in leaves(view) if not k.startswith(("host.", "provenance."))}
        for view in (before, after)
    )
    found = []
    for path in dict.fromkeys([*one, *other]):
        a, b = one.get(path), other.get(path)
        if a != b:
            found.append((path, a, b, change(a, b)))
    return sorted(found, key=lambda difference: -abs(difference[3]))


def change(a: object, b: object) -> float:
    counts = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (a, b))
    return (b - a) / abs(a) if counts and a != 0 else float("inf")
