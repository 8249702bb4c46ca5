"""What a search has found, as tables and as configurations."""

from __future__ import annotations

import json
import math
import pathlib
from collections.abc import Sequence

from results import tables
from machine_axes import Machine
from machine_search import OBJECTIVES, Point
from measures import pareto_front
from runs.run_digest import data_folder
from runs.view_numbers import decibels, psnr_span

# Points that are this close in everything count as one.
ALIKE = 1.05
ALIKE_DB = 1.0
# Rounded to 8 bits no picture is nearer to the reference.
MOST_DB = 59.0

FRONT_HEAD = (
    "order",
    "PSNR dB",
    "bus MB",
    "M cycles",
    "mJ",
    "mm2",
    "setting",
    "stored",
    "on the front",
)


def values(point: Point) -> tuple[float, ...]:
    """To be small: what is lost of the picture, cycles, bytes on the bus, joules, mm2."""
    worst_db = min(min(map(decibels, point.views)), MOST_DB)
    return (-worst_db, *(point.mean(of) for of in OBJECTIVES.values()), point.area_mm2())


def near_front(points: Sequence[Point]) -> list[bool]:
    """For each point whether it is on the front; of those that are alike, the fastest is."""

    def box(of: tuple[float, ...]) -> tuple[int, ...]:
        lost, *others = of
        return (
            math.floor(lost / ALIKE_DB),
            *(math.floor(math.log(v) / math.log(ALIKE)) for v in others),
        )

    boxes = [box(values(point)) for point in points]
    slowest_first = sorted(range(len(points)), key=lambda n: -values(points[n])[1])
    first = {boxes[n]: n for n in slowest_first}
    return [best and first[of] == n for n, (best, of) in enumerate(zip(pareto_front(boxes), boxes))]


def settings_text(machine: Machine) -> str:
    """Without the units' names, which the keys do not need to be told apart."""
    assignments = [setting.partition("=") for setting in machine.settings()]
    return " ".join(f"{key.rpartition('.')[2]}={value}" for key, _, value in assignments)


def stored(point: Point) -> str:
    """Of each scene, in their order."""
    texts = [point.stored(n).partition("=")[2] for n in range(len(point.scenes))]
    name = point.machine.order.storage.name.partition(".")[2]
    return f"{name} {texts[0] if len(set(texts)) == 1 else ' '.join(texts)}"


def front_row(point: Point, on_front: bool) -> tuple:
    cycles, bus, joules = (point.mean(of) for of in OBJECTIVES.values())
    return (
        point.machine.order.name,
        psnr_span(point.views),
        f"{bus / 1e6:.2f}",
        f"{cycles / 1e6:.3f}",
        f"{joules * 1e3:.2f}",
        f"{point.area_mm2():.2f}",
        settings_text(point.machine),
        stored(point),
        "yes" if on_front else "",
    )


def front_rows(points: Sequence[Point], on_front: Sequence[bool]) -> list[tuple]:
    """By order, then the fastest first."""
    rows = [front_row(point, best) for point, best in zip(points, on_front)]
    return sorted(dict.fromkeys(rows), key=lambda row: (row[0], float(row[3])))


FOUND_HEAD = ("order", "area allowed", "best for", *FRONT_HEAD[1:-1])


def found_table(best: dict[tuple[str, float, str], Point]) -> str:
    rows = [
        (order, f"{budget:g} x paper", objective, *front_row(point, False)[1:-1])
        for (order, budget, objective), point in best.items()
    ]
    return tables.markdown(FOUND_HEAD, rows)


def json_value(text: str) -> object:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def assigned_document(binary: pathlib.Path, machine: Machine, views: Sequence[dict]) -> dict:
    """A machine as a configuration, its memory as large as the views need. How a scene is stored
    is as in the preset: that may be another for each."""
    preset = data_folder(binary) / "presets" / f"{machine.order.preset}.json"
    document: dict = json.loads(preset.read_text())
    for assignment in machine.overrides():
        key, _, value = assignment.partition("=")
        *parents, last = key.split(".")
        part = document
        for parent in parents:
            part = part.setdefault(parent, {})
        part[last] = json_value(value)
    for memory in ("input_bytes", "shared_bytes"):
        document["sram"][memory] = max(view["config"]["sram"][memory] for view in views)
    return document
