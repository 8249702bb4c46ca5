"""Study of single keys and sizes of a machine: the tables that choices.json beside this file lists,
each of presets on scenes with some keys set otherwise."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import itertools
import pathlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence

import tables
from runs import run_arguments
from runs.files import read_json
from runs.keeper import swept
from runs.scenes import Scene, find_scene, find_scenes
from runs.simulations import (
    MB,
    Run,
    binders,
    cycles,
    decibels,
    expanded,
    read_config,
    region_bytes,
    shape_of,
    simulate_all,
    value_at,
    work,
)
from tables import Column, Spread, Study

LISTED = pathlib.Path(__file__).with_suffix(".json")


@dataclasses.dataclass(frozen=True)
class Runs:
    """Every preset on every scene with every row of settings over `set`. Settings stand in a text,
    KEY=VALUE side by side. at: a datapath's path in the report, from which columns go on whose own
    begins with a dot. Such runs are simulated one by one: reports of a sweep have no datapaths."""

    presets: Sequence[str]
    scenes: Sequence[str]
    rows: Sequence[str] = ("",)
    set: str = ""
    view: str = "0"
    size: str = "640x360"
    at: str = ""


@dataclasses.dataclass(frozen=True)
class Table:
    """columns: what VALUES say or paths of the report, by the columns that they fill. over: what
    these are divided by. Braces in about hold keys of the first preset, for their values."""

    name: str
    about: str
    columns: Mapping[Column, str]
    over: Mapping[str, float]
    runs: Sequence[Runs]
    spread: Spread | None


@dataclasses.dataclass(frozen=True)
class Measured:
    """view: its report. preset: that of the same view where no row sets anything."""

    run: Run
    settings: str
    at: str
    view: dict
    preset: dict


def value(of: Measured, text: str) -> object:
    """Raises ValueError for what the report has not."""
    what, _, argument = text.partition(":")
    if what in VALUES:
        return VALUES[what](of, argument)
    path = of.at + text if text.startswith(".") else text
    found = value_at(of.view, path)
    if found is None:
        raise ValueError(f"{LISTED.name}: {path}: not in the report of {of.run.label()}")
    return found


def number(of: Measured, text: str) -> float:
    found = value(of, text)
    if isinstance(found, bool) or not isinstance(found, (int, float)):
        raise ValueError(f"{LISTED.name}: {text}: got {found}, expected a number")
    return found


def of_preset(of: Measured, text: str) -> object:
    return value(dataclasses.replace(of, view=of.preset), text)


def change_percent(of: Measured, text: str) -> float:
    before = number(dataclasses.replace(of, view=of.preset), text)
    return 100 * (number(of, text) / before - 1)


def percent_of_frame(of: Measured, text: str) -> float:
    return 100 * number(of, text) / cycles(of.view)


def bus_mb(of: Measured, region: str) -> float:
    return of.view["dram"]["bus_bytes_by_region"].get(region, 0) / MB


def over_limit(of: Measured, region: str) -> float:
    """Bytes asked for in a region but for those that the limit has of it, over the limit."""
    view, limit = of.view, of.view["limit"]
    once, gaussians = limit["bytes_read_once"], limit["contributing_gaussians"]
    second = view["scene"]["second_half_bytes"] * gaussians
    needed = {
        "second_halves": second,
        "first_halves": once - region_bytes(view, "frame_buffer") - second,
    }
    return (region_bytes(view, region) - needed.get(region, 0)) / once


def row_hit_percent(of: Measured, _: str) -> float:
    dram = of.view["dram"]
    hits = dram["row_hits"]
    return 100 * hits / (hits + dram["row_misses"] + dram["row_conflicts"])


VALUES: Mapping[str, Callable[[Measured, str], object]] = {
    "scene": lambda of, _: of.run.scene.name,
    "preset": lambda of, _: of.run.config,
    "size": lambda of, _: of.run.size,
    "settings": lambda of, _: of.settings or "none",
    "part": lambda of, _: of.at.rpartition(".")[2],
    "group": lambda of, _: shape_of(of.view["config"]),
    "psnr": lambda of, _: decibels(of.view),
    "binds": lambda of, _: binders([of.view]),
    "culled": lambda of, _: 100 * work(of.view, "culled") / work(of.view, "first_halves"),
    "row_hits": row_hit_percent,
    "of_preset": of_preset,
    "change": change_percent,
    "of_frame": percent_of_frame,
    "bus_mb": bus_mb,
    "over_limit": over_limit,
}
AGAINST_PRESET = ("of_preset:", "change:")


@functools.cache
def listed() -> Mapping[str, Table]:
    """By name."""
    found = read_json(LISTED)
    known = found["columns"]

    def column(of: str | dict) -> tuple[Column, dict]:
        name, own = (of, {}) if isinstance(of, str) else (of["name"], of)
        said = {**known[name], **own}
        shown = (said.get(of, "") for of in ("meaning", "unit", "form"))
        return Column(name, *shown), said

    def table(of: dict) -> Table:
        columns = dict(map(column, of["columns"]))
        return Table(
            of["name"],
            of["about"],
            {column: said["from"] for column, said in columns.items()},
            {column.name: said["over"] for column, said in columns.items() if "over" in said},
            [Runs(**runs) for runs in of["runs"]],
            Spread(**of["spread"]) if "spread" in of else None,
        )

    return {of["name"]: table(of) for of in found["tables"]}


@dataclasses.dataclass(frozen=True)
class Asked:
    """A row of a table. preset: the same without the row's settings; None: no column needs it."""

    settings: str
    at: str
    run: Run
    preset: Run | None


def asked(
    table: Table, scenes: Sequence[Scene] = (), view: str = "", size: str = ""
) -> Iterator[Asked]:
    """What is given in place of the table's own."""
    compares = any(text.startswith(AGAINST_PRESET) for text in table.columns.values())
    for runs in table.runs:
        on = scenes or [find_scene(name) for name in runs.scenes]
        for scene, preset, settings in itertools.product(on, runs.presets, runs.rows):
            where = (scene, view or runs.view, size or runs.size)
            run = Run(*where, preset, expanded(runs.set.split()))
            overrides = (*run.overrides, *expanded(settings.split()))
            yield Asked(
                settings,
                runs.at,
                dataclasses.replace(run, overrides=overrides),
                run if compares else None,
            )


def about(table: Table, rows: Sequence[Asked], binary: pathlib.Path) -> str:
    """With what all rows have in common and no column has, and with the preset's values."""
    runs, columns = [row.run for row in rows], table.columns.values()
    common = {
        "Scene ": {run.scene.name for run in runs} if "scene" not in columns else (),
        "view ": {run.view for run in runs},
        "": {f"{run.size} px" for run in runs} if "size" not in columns else (),
    }
    where = ", ".join(what + next(iter(of)) for what, of in common.items() if len(of) == 1)
    config = read_config(binary, dataclasses.replace(runs[0], overrides=()))
    said = re.sub(r"{([\w.]+)}", lambda key: str(value_at(config, key[1])), table.about)
    return f"{where[0].upper()}{where[1:]}. {said}" if where else said


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "those of each table")
    run_arguments.add_side_by_side(to)
    to.add_argument("--view", default="", help="number of a camera, in place of each table's")
    to.add_argument("--size", default="", metavar="WxH", help="in px, in place of each table's")
    to.add_argument("--tables", nargs="+", choices=listed(), metavar="NAME", help="default: all")


def make(arguments: argparse.Namespace) -> None:
    if arguments.view and not arguments.view.isdecimal():
        raise ValueError(f"--view: got {arguments.view}, expected the number of a camera")
    if arguments.size:
        run_arguments.check_size("--size", arguments.size)
    given = find_scenes(arguments.scenes, arguments.cameras) if arguments.scenes else []
    chosen = [listed()[name] for name in arguments.tables or listed()]
    where = (given, arguments.view, arguments.size)
    rows = {table.name: list(asked(table, *where)) for table in chosen}
    runs = dict.fromkeys(
        run for of in rows.values() for row in of for run in (row.run, row.preset) if run
    )
    alone = list(dict.fromkeys(row.run for of in rows.values() for row in of if row.at))
    together = [run for run in runs if run not in alone]
    outcomes = dict(zip(together, swept(arguments, "choices", together)))
    outcomes |= zip(alone, simulate_all(arguments.streaminggs, alone, arguments.side_by_side))
    for table in chosen:
        write(arguments, table, [(row, *views_of(row, outcomes)) for row in rows[table.name]])


def views_of(row: Asked, outcomes: Mapping) -> tuple[dict, dict]:
    (view,) = outcomes[row.run].accepted()
    (preset,) = outcomes[row.preset].accepted() if row.preset else (view,)
    return view, preset


def write(
    arguments: argparse.Namespace, table: Table, found: Sequence[tuple[Asked, dict, dict]]
) -> None:
    scenes = list(dict.fromkeys(row.run.scene for row, _, _ in found))
    by = tables.made_of(arguments.streaminggs, (view for _, view, _ in found), scenes)

    def cell(of: Measured, column: Column, text: str) -> object:
        over = table.over.get(column.name)
        return number(of, text) / over if over else value(of, text)

    cells = [
        [
            cell(Measured(row.run, row.settings, row.at, view, preset), *column)
            for column in table.columns.items()
        ]
        for row, view, preset in found
    ]
    said = about(table, [row for row, _, _ in found], arguments.streaminggs)
    tables.write(
        arguments.out, table.name, by, list(table.columns), cells, said, spread=table.spread
    )


CHOICES = Study(
    "choices",
    """Single keys and sizes of machines: what the frame takes with another value of them. Makes the
tables that choices.json lists, beside the study's source; another table needs no code.
""",
    ("results.py choices",),
    add_arguments,
    make,
)
