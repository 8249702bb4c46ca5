"""The smallest machine of exact order that holds a frame rate, for sizes of frames: the best of
explorations, and what they began with. For each size its exploration comes first:

  scripts/explore.py SCENE... --recipe smallest --size WxH --out FOLDER --show \\
    max(watts),max(joules),area_mm2.bands.total.low,mm2_high
  scripts/results.py smallest_machine --found WxH=FOLDER...

Makes smallest_machine, a line for each size.
"""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Mapping

import tables
from exploring.record import SETTING
from runs import run_arguments
from tables import REQUIRED, Column, Made, measure_of

SHOWN = ("max(watts)", "max(joules)", "area_mm2.bands.total.low", "mm2_high")
RECIPE = "explore.py truck platform yard --recipe smallest"
JOBS = (
    *(
        f"{RECIPE} --size {size} --show '{','.join(SHOWN)}' --out out/smallest_{size}"
        for size in ("1280x720", "2560x1440")
    ),
    "results.py smallest_machine --found 1280x720=out/smallest_1280x720 "
    "2560x1440=out/smallest_2560x1440",
)
COLUMNS = (
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
    Column("setting", "by key"),
)


def required_rate(folder: pathlib.Path, row: Mapping[str, str]) -> str:
    """The column. Raises ValueError."""
    for column in row:
        if REQUIRED.fullmatch(column) and measure_of(column) == "fps":
            return column
    raise ValueError(f"{folder}/explore.csv: no bound on fps, expected --require 'min(fps) >= N'")


def row_of(size: str, folder: pathlib.Path) -> tuple:
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
        " ".join(f"{key}={best[key]}" for key in keys),
    )


def add_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--found",
        nargs="+",
        default=[],
        metavar="WxH=FOLDER",
        help="--out of an exploration of frames of a size",
    )


def make(arguments: argparse.Namespace) -> None:
    found = dict(text.partition("=")[::2] for text in arguments.found)
    if not found:
        raise ValueError("--found: expected WxH=FOLDER, explore.py makes it")
    folders = [pathlib.Path(folder) for folder in found.values()]
    made = [Made(**tables.facts_of(folder, "explore")["made"]) for folder in folders]
    by = Made(
        run_arguments.command_line(),
        tuple(sorted({commit for each in made for commit in each.commits})),
        tuple(sorted({release for each in made for release in each.releases})),
        made[0].program,
        {name: digest for each in made for name, digest in each.inputs.items()},
    )
    rows = [row_of(size, folder) for size, folder in zip(found, folders)]
    tables.write(arguments.out, "smallest_machine", by, COLUMNS, rows)
