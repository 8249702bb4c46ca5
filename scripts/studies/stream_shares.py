"""Study of what frames of a head that moves have in common in the memory."""

from __future__ import annotations

import argparse
import json
import math
import pathlib
import tempfile
from collections.abc import Iterable, Mapping

import tables
from runs import run_arguments
from runs.files import read_json, write_text
from runs.scenes import Scene, answered, find_scenes
from runs.simulations import MB
from tables import PRESET, SCENE, Column, Study

SCENES = ("truck", "playbot", "yard", "park", "platform", "garden")
# Of a head between two frames at 90 a second: 30 degrees and half a metre a second, where the unit
# of the scene is a metre.
DEGREES, DISTANCE = 1 / 3, 0.006
APART = (0, 1, 9)  # frames
READS, WRITES = ("RD", "RDA"), ("WR", "WRA")

COLUMNS = (
    SCENE,
    PRESET,
    Column("read MB", "by a frame, in whole bursts", "MB", ".2f"),
    Column("distinct MB", "each burst once: what on-chip memory would hold", "MB", ".2f"),
    *(
        Column(f"read again, {n} later", "share of the distinct that this frame reads", "", ".1%")
        for n in APART[1:]
    ),
)

Burst = tuple[str, str, str, str, str]  # channel, rank, bank, row, column


def turned(camera: Mapping, frames: int) -> dict:
    """Where the head is so many frames later: turned about its own vertical, moved along its own
    horizontal axis. rotation: axes of the camera in its columns."""
    angle = math.radians(DEGREES * frames)
    c, s = math.cos(angle), math.sin(angle)
    rotation = [[x * c - z * s, y, x * s + z * c] for x, y, z in camera["rotation"]]
    across = [row[0] for row in camera["rotation"]]
    position = [p + DISTANCE * frames * x for p, x in zip(camera["position"], across)]
    return {**camera, "id": frames, "rotation": rotation, "position": position}


def first_camera(scene: Scene) -> dict:
    """Raises ValueError where its cameras are no list of positions and rotations, OSError."""
    cameras = read_json(pathlib.Path(scene.cameras)) if scene.cameras else None
    first = cameras[0] if isinstance(cameras, list) and cameras else {}
    if not isinstance(first, dict) or not {"position", "rotation"} <= first.keys():
        raise ValueError(
            f"{scene.cameras or scene.name}: got no list of cameras with position and rotation, "
            "expected one, whose first moves"
        )
    return first


def read_bursts(lines: Iterable[str]) -> tuple[list[Burst], int]:
    """Of a command trace: bursts read, in their order, and how many were moved either way."""
    rows: dict[tuple[str, str, str], str] = {}
    found: list[Burst] = []
    moved = 0
    for line in lines:
        if line.startswith("#"):
            continue
        _, channel, command, rank, bank, argument = line.split()
        if command == "ACT":
            rows[channel, rank, bank] = argument
        elif command in READS:
            found.append((channel, rank, bank, rows[channel, rank, bank], argument))
        moved += command in READS + WRITES
    return found, moved


def drawn(
    arguments: argparse.Namespace, scene: Scene, camera: Mapping, preset: str
) -> tuple[list[Burst], dict]:
    """What a frame reads, and its view's report. Raises ValueError, Failure."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        cameras, trace, out = (pathlib.Path(folder, name) for name in ("c.json", "trace", "out"))
        write_text(cameras, json.dumps([camera]))
        words = [scene.spec, "--cameras", str(cameras), "--view", "0", "--size", arguments.size]
        words += ["--config", preset, "--dram-trace", str(trace), "--out", str(out)]
        answered(arguments.streaminggs, "simulate", words, scene.name)
        (view,) = read_json(out / "report.json")["views"]
        with trace.open() as lines:
            bursts, moved = read_bursts(lines)
    view["burst_bytes"] = view["dram"]["bus_bytes"] / moved
    return bursts, view


def row_of(scene: str, preset: str, frames: list[tuple[list[Burst], dict]]) -> tuple:
    (first, view), *later = frames
    distinct = set(first)
    size = view["burst_bytes"] / MB
    again = (len(distinct & set(bursts)) / len(distinct) for bursts, _ in later)
    return (scene, preset, len(first) * size, len(distinct) * size, *again)


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, " ".join(SCENES))
    run_arguments.add_size(to, "640x360")
    to.add_argument("--presets", nargs="+", default=["exact"], metavar="PRESET")


def make(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or list(SCENES), arguments.cameras)
    rows, views = [], []
    for scene in scenes:
        first = first_camera(scene)
        for preset in arguments.presets:
            frames = [drawn(arguments, scene, turned(first, apart), preset) for apart in APART]
            rows.append(row_of(scene.name, preset, frames))
            views += [view for _, view in frames]
    by = tables.made_of(arguments.streaminggs, views, scenes)
    about = (
        f"View 0, and the same head {' and '.join(map(str, APART[1:]))} frames later, "
        f"{DEGREES:.2g} degrees and {DISTANCE:g} of the scene's units a frame."
    )
    tables.write(arguments.out, "stream_shares", by, COLUMNS, rows, about)


STREAM_SHARES = Study(
    "stream_shares",
    """What frames of a head that moves have in common: bursts that a frame reads, how many of them are
distinct, and which a later frame reads again. Makes stream_shares.
""",
    ("results.py stream_shares",),
    add_arguments,
    make,
)
