"""Studies of machines that explorations found."""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib
import statistics
from collections.abc import Mapping, Sequence

import tables
from exploring.record import ENDS, SETTING
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import Scene, find_scenes
from runs.simulations import (
    MB,
    MJ,
    Outcome,
    Run,
    binders,
    decibels,
    numbers,
    pareto_front,
)
from tables import REQUIRED, SCENE, SIZE, VIEW, Column, Study, measure_of

PRESETS = ("exact", "exact_fast", "gscore_lossless_boxes", "paper_text")
BESIDE = "gscore_lossless_boxes"  # whose cycles those of all others are held against
ROUNDING_DB = 50  # above it the rounding to 8 bits decides
# Points that are this close in everything count as one; no picture in 8 bits is nearer than
# MOST_DB.
ALIKE, ALIKE_DB, MOST_DB = 1.05, 1.0, 59.0

MACHINE = Column("machine", "preset, or what was found for an order")
BUS = Column("bus bytes", "on the bus, a frame", "B", ",.0f")
CYCLES = Column("cycles", "of a frame", "cycles", ",.0f")
FPS = Column("fps", "frames a second; of several views the slowest", "1/s", ".1f")
JOULES = Column("joules", "of a frame", "J", ".4g")
MM2 = Column("mm2", "area, where it is largest", "mm2", ".2f")
DECIBELS = (
    Column("least dB", "PSNR of the worst view; inf: equal", "dB", ".1f"),
    Column("most dB", "PSNR of the best view; inf: equal", "dB", ".1f"),
)
VIEWS = (
    *(SIZE, SCENE, MACHINE, VIEW, BUS),
    Column("asked bytes", "that units asked for", "B", ",.0f"),
    Column("read once bytes", "if each Gaussian that contributes were read once", "B", ",.0f"),
    *(CYCLES, FPS, JOULES, MM2),
    Column("PSNR dB", "of the frame in 8 bits; inf: equal", "dB", ".2f"),
    Column("binds", "what holds the frame"),
    Column("key", "that would give it more"),
)
SCENES = (
    *(SIZE, SCENE, MACHINE, BUS),
    Column("asked / once", "bytes asked for over the least possible", "", ".2f"),
    Column("bus / asked", "bytes on the bus over those asked for", "", ".2f"),
    *(CYCLES, FPS, JOULES, MM2, *DECIBELS),
    Column("binds", "the busiest of the views, its share of the frame, and what holds it"),
)
SEARCH = (
    Column("judged", "machines that the search judged; empty: a preset", "", "d"),
    Column("ended", "how the search did; by time or trials: a longer one may find a better one"),
)
SUMMARY = (
    *(Column("size px", SIZE.meaning, "px"), MACHINE, MM2),
    Column("bus MB", "on the bus, a frame", "MB", ".1f"),
    Column("M cycles", "of a frame", "10^6 cycles", ".2f"),
    Column("mJ", "of a frame", "mJ", ".2f"),
    Column("fps, worst view", "frames a second of the slowest view", "1/s", ".0f"),
    Column("PSNR dB, least", DECIBELS[0].meaning, "dB", ".1f"),
    Column("PSNR dB, most", DECIBELS[1].meaning, "dB", ".1f"),
    Column(f"faster than {BESIDE}, least", "its cycles over these, of all views", "", ".2f"),
    Column(f"faster than {BESIDE}, most", "its cycles over these, of all views", "", ".2f"),
    *SEARCH,
)
FRONT = (
    Column("order", "of what it was found for"),
    *(Column("least dB", "PSNR of the worst view", "dB", ".1f"), BUS, CYCLES, JOULES, MM2),
    Column("setting", "by key"),
    Column("on the front", "whether no other one beats it"),
)
# Columns of explore.csv, as the recipes ask for them.
EXPLORED = ("min(psnr_db)", "geomean(dram.bus_bytes)", "geomean(cycles)", "geomean(joules)", "mm2")


@dataclasses.dataclass(frozen=True)
class Machine:
    """folder: of an exploration, which may have a configuration for each scene."""

    name: str
    preset: str = ""
    folder: pathlib.Path = pathlib.Path()

    def config(self, scene: Scene) -> str:
        """Raises ValueError."""
        own = self.folder / f"explore_best_{scene.name}.json"
        path = own if own.exists() else self.folder / "explore_best.json"
        if not self.preset and not path.exists():
            raise ValueError(f"--found {self.name}: {path} is not there; explore.py makes it")
        return self.preset or str(path)

    def search(self) -> tuple:
        """Cells of SEARCH. Raises ValueError, OSError."""
        return (None, "") if self.preset else search_of(self.folder)


def search_of(folder: pathlib.Path) -> tuple[int, str]:
    """How many the search of an exploration judged, and how it ended. Raises ValueError, OSError."""
    facts = tables.facts_of(folder, "explore")
    if facts.get("ended") not in ENDS:
        raise ValueError(
            f"{folder}/explore.json: got no 'ended', expected that of an exploration with --search"
        )
    return facts["judged"], facts["ended"]


def view_row(size: str, scene: str, machine: str, view: dict) -> tuple:
    dram, frame = view["dram"], view["frame"]
    return (
        *(size, scene, machine, view["view"], dram["bus_bytes"], dram["bytes"]),
        *(view["limit"]["bytes_read_once"], frame["cycles"], frame["fps"]),
        *(view["energy"]["total_j"], view["area_mm2"]["total"], decibels(view)),
        *(view["binding"]["holds"], view["binding"].get("key", "")),
    )


def scene_row(size: str, scene: str, machine: str, views: Sequence[dict], db: Sequence) -> tuple:
    bus, asked, wasted, cycles, fps, joules, mm2 = numbers(views)
    # Once what a quantised scene holds would be another once.
    quantised = any(v["config"]["storage"]["encoding"].startswith("vq") for v in views)
    return (
        *(size, scene, machine, bus, None if quantised else asked, wasted, cycles, fps, joules),
        *(mm2, min(db), max(db), binders(views)),
    )


def summary_row(size: str, machine: str, of: Sequence, beside: Sequence, db: Sequence) -> tuple:
    """of, beside: views of each scene, of the machine and of what it is held against."""
    found = [numbers(views) for views in of]
    bus, cycles, joules = (statistics.geometric_mean(n[i] for n in found) for i in (0, 3, 5))
    faster = [
        theirs["frame"]["cycles"] / ours["frame"]["cycles"]
        for views, others in zip(of, beside)
        for ours, theirs in zip(views, others)
    ]
    return (
        *(size, machine, max(n[6] for n in found), bus / MB, cycles / 1e6, joules / MJ),
        min(n[4] for n in found),
        *(min(db), max(db)),
        *((min(faster), max(faster)) if faster else (None, None)),
    )


def in_floats(outcome: Outcome) -> Run:
    """The views whose PSNR says what the order costs, not what 8 bits do."""
    return dataclasses.replace(outcome.run, overrides=("framebuffer=rgb32f",))


def tried(order: str, folder: pathlib.Path) -> list[tuple]:
    """What was drawn on all views, without the last column. Raises ValueError, OSError."""
    rows = tables.read_rows(folder, "explore")
    columns = tables.facts_of(folder, "explore")["columns"]
    keys = [column["name"] for column in columns if column["meaning"] == SETTING]
    for name in EXPLORED:
        if rows and name not in rows[0]:
            raise ValueError(f"{folder}/explore.csv: no column {name}; the recipe --show has it")
    return [
        (order, *(float(row[n]) for n in EXPLORED), " ".join(f"{k}={row[k]}" for k in keys))
        for row in rows
        if row[EXPLORED[0]]
    ]


def near_front(points: Sequence[tuple]) -> list[bool]:
    """For each point whether it is on the front; of those that are alike, the fastest is."""

    def box(point: tuple) -> tuple[int, ...]:
        least_db, *others = point[1:6]
        lost = -min(least_db, MOST_DB)
        steps = (math.floor(math.log(value) / math.log(ALIKE)) for value in others)
        return (math.floor(lost / ALIKE_DB), *steps)

    boxes = [box(point) for point in points]
    slowest_first = sorted(range(len(points)), key=lambda n: -points[n][3])
    first = {boxes[n]: n for n in slowest_first}
    return [best and first[of] == n for n, (best, of) in enumerate(zip(pareto_front(boxes), boxes))]


def add_fight_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_view(to, "all")
    run_arguments.add_side_by_side(to)
    to.add_argument(
        "--found",
        nargs="+",
        default=[],
        metavar="ORDER=FOLDER",
        help="--out of an exploration; the best of it is drawn",
    )
    to.add_argument("--presets", nargs="+", default=list(PRESETS), metavar="PRESET")
    to.add_argument("--sizes", nargs="+", default=["640x360", "1280x720"], metavar="WxH")


def make_fair_fight(arguments: argparse.Namespace) -> None:
    for option in ("found", "presets", "sizes"):
        run_arguments.check_once(f"--{option}", getattr(arguments, option))
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    folders = dict(text.partition("=")[::2] for text in arguments.found)
    machines = [Machine(f"preset {name}", preset=name) for name in arguments.presets]
    machines += [
        Machine(f"{order}, found", folder=pathlib.Path(folder)) for order, folder in folders.items()
    ]
    points = [
        point for order, folder in folders.items() for point in tried(order, pathlib.Path(folder))
    ]
    searches = {machine: machine.search() for machine in machines}
    asked = [(size, m, s) for size in arguments.sizes for m in machines for s in scenes]
    runs = [Run(s, arguments.view, size, m.config(s)) for size, m, s in asked]
    outcomes = swept(arguments, "fair_fight", runs)
    again = [o for o in outcomes if max(map(decibels, o.accepted())) >= ROUNDING_DB]
    floats = swept(arguments, "fair_fight", [in_floats(o) for o in again])
    views = {(size, m.name, s.name): o.views for (size, m, s), o in zip(asked, outcomes)}
    exact = {o.run: f.accepted() for o, f in zip(again, floats)}
    db = {
        key: [decibels(view) for view in exact.get(o.run, o.views)]
        for key, o in zip(views, outcomes)
    }
    every = [view for of in views.values() for view in of]
    by = tables.made_of(arguments.streaminggs, every, scenes)
    keys = [(size, s.name, m.name) for size in arguments.sizes for s in scenes for m in machines]
    rows = [view_row(*key, view) for key in keys for view in views[key[0], key[2], key[1]]]
    tables.write(arguments.out, "fair_fight_views", by, VIEWS, rows)
    rows = [scene_row(*k, views[k[0], k[2], k[1]], db[k[0], k[2], k[1]]) for k in keys]
    tables.write(arguments.out, "fair_fight_scenes", by, SCENES, rows)
    rows = []
    for size in arguments.sizes:
        for machine in machines:
            names = [(size, machine.name, s.name) for s in scenes]
            beside = [views.get((size, f"preset {BESIDE}", s.name), ()) for s in scenes]
            all_db = [value for name in names for value in db[name]]
            row = summary_row(size, machine.name, [views[n] for n in names], beside, all_db)
            rows.append((*row, *searches[machine]))
    tables.write(arguments.out, "fair_fight_summary", by, SUMMARY, rows)
    rows = [(*point, best) for point, best in zip(points, near_front(points))]
    only = {"on the front": "yes"}
    tables.write(arguments.out, "fair_fight_front", by, FRONT, rows, only=only)


SEARCHED = "park platform yard garden truck playbot"
FAIR_FIGHT = Study(
    "fair_fight",
    """Machines in one area, each found by explore.py in as long a search, beside presets. The recipes
come first:

  scripts/explore.py SCENE... --recipe exact_in_area --out out/exact
  scripts/explore.py SCENE... --recipe gscore_in_area --out out/gscore
  scripts/explore.py SCENE... --recipe paper_in_area --out out/paper
  scripts/results.py fair_fight SCENE... --found exact=out/exact gscore=out/gscore paper=out/paper

Makes

  fair_fight_views    of each size, scene, machine and view
  fair_fight_scenes   of each size, scene and machine: means over the views; the worst
                      frame rate
  fair_fight_summary  of each size and machine: geometric means over the scenes of these;
                      how many machines its search judged, and how that ended
  fair_fight_front    of all that was tried what no other one beats in picture,
                      bytes, time, energy and area, compared in steps of 5 % and 1 dB

Frames are of 8-bit pixels; the dB of scenes and of the summary are of frames in floats where 8 bits
would hide them.
""",
    (
        *(
            f"explore.py {SEARCHED} --recipe {order}_in_area --out out/{order}"
            for order in ("exact", "gscore", "paper")
        ),
        f"results.py fair_fight {SEARCHED} "
        "--found exact=out/exact gscore=out/gscore paper=out/paper",
    ),
    add_fight_arguments,
    make_fair_fight,
)


SHOWN = ("max(watts)", "max(joules)", "area_mm2.bands.total.low", "mm2_high")
RECIPE = "explore.py truck platform yard --recipe smallest"
SMALLEST_COLUMNS = (
    Column("size px", "width and height of a view", "px"),
    Column("fps wanted", "frames a second that every view holds", "1/s", "g"),
    Column("mm2", "area", "mm2", ".2f"),
    Column("mm2 of the band, least", "area by the low ends of its sources", "mm2", ".2f"),
    Column("mm2 of the band, most", "area by the high ends of its sources", "mm2", ".2f"),
    Column("W, most", "mean power of the view that takes most", "W", ".2f"),
    Column("mJ, most", "energy of the view that takes most", "mJ", ".2f"),
    Column("fps, worst view", "frames a second of the slowest view", "1/s", ".1f"),
    Column("which", "the slowest view"),
    Column("at the start: fps", "the same of the machine that the search began with", "1/s", ".0f"),
    Column("at the start: mm2", "its area", "mm2", ".2f"),
    *SEARCH,
    Column("setting", "by key"),
)


def required_rate(folder: pathlib.Path, row: Mapping[str, str]) -> str:
    """The column. Raises ValueError."""
    for column in row:
        if REQUIRED.fullmatch(column) and measure_of(column) == "fps":
            return column
    raise ValueError(f"{folder}/explore.csv: no bound on fps, expected --require 'min(fps) >= N'")


def smallest_row(size: str, folder: pathlib.Path) -> tuple:
    """Raises ValueError, OSError."""
    rows = tables.read_rows(folder, "explore")
    front = [row for row in rows if row["front"] == "yes"]
    if not front:
        raise ValueError(f"{folder}/explore.csv: no machine holds what was required")
    if missing := [name for name in ("mm2", *SHOWN) if name not in front[0]]:
        raise ValueError(f"{folder}/explore.csv: no column {', '.join(missing)}; --show has it")
    best = min(front, key=lambda row: float(row["mm2"]))
    rate = required_rate(folder, best)
    columns = tables.facts_of(folder, "explore")["columns"]
    keys = [column["name"] for column in columns if column["meaning"] == SETTING]
    watts, joules, low, high = (float(best[name]) for name in SHOWN)
    return (
        *(size, float(REQUIRED.fullmatch(rate)[3]), float(best["mm2"]), low, high, watts),
        *(1e3 * joules, float(best[rate]), best["slowest view"]),
        *(float(rows[0][rate]), float(rows[0]["mm2"])),
        *search_of(folder),
        " ".join(f"{key}={best[key]}" for key in keys),
    )


def add_smallest_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--found",
        nargs="+",
        default=[],
        metavar="WxH=FOLDER",
        help="--out of an exploration of frames of a size",
    )


def make_smallest_machine(arguments: argparse.Namespace) -> None:
    found = dict(text.partition("=")[::2] for text in arguments.found)
    if not found:
        raise ValueError("--found: expected WxH=FOLDER, explore.py makes it")
    folders = [pathlib.Path(folder) for folder in found.values()]
    facts = [tables.facts_of(folder, "explore") for folder in folders]
    by = tables.made_together(run_arguments.command_line(), facts)
    rows = [smallest_row(size, folder) for size, folder in zip(found, folders)]
    tables.write(arguments.out, "smallest_machine", by, SMALLEST_COLUMNS, rows)


SMALLEST_MACHINE = Study(
    "smallest_machine",
    """The smallest machine of exact order that holds a frame rate, for sizes of frames: the best of
explorations, and what they began with. For each size its exploration comes first:

  scripts/explore.py SCENE... --recipe smallest --size WxH --out FOLDER --show \
    max(watts),max(joules),area_mm2.bands.total.low,mm2_high
  scripts/results.py smallest_machine --found WxH=FOLDER...

Makes smallest_machine, a line for each size.
""",
    (
        *(
            f"{RECIPE} --size {size} --show '{','.join(SHOWN)}' --out out/smallest_{size}"
            for size in ("1280x720", "2560x1440")
        ),
        "results.py smallest_machine --found 1280x720=out/smallest_1280x720 "
        "2560x1440=out/smallest_2560x1440",
    ),
    add_smallest_arguments,
    make_smallest_machine,
)
