"""Error against run time of exact order: what a smaller merge buffer (spilling, or blending early),
another pixel group or another chunk costs in quality, traffic and cycles. Makes work_precision.

Frames are written as floats (framebuffer=rgb32f), so that PSNR sees every error; that is 12 B a
pixel in DRAM. The coarse filters' FIFOs hold the survivors of as many whole chunks as in the
preset: with less room a larger chunk would be measured by its wait. Every combination gets the
shared on-chip memory that it needs; the column `shared SRAM B` says what that is.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import sys

import tables
from tables import PSNR, SCENE, VIEW, Column
from runs import run_arguments
from runs.scenes import find_scenes
from runs.simulations import (
    MB,
    Run,
    asked_mb,
    cycles,
    decibels,
    group_assignments,
    region_bytes,
    resolved_config,
    shape_of,
    work,
)
from runs.sweep_server import swept

JOBS = ("results.py work_precision builtin:outdoor truck",)

MERGE_ENTRIES = (128, 256, 512, 1024, 2048, 4096)
ON_OVERFLOW = ("spill", "blend_early")
GROUPS = ("16", "32", "64", "128")
CHUNK_GAUSSIANS = (8, 16, 32, 64, 128, 256)

COLUMNS = (
    SCENE,
    VIEW,
    Column("group px", "side, or width and height, of a pixel group", "px"),
    Column("chunk", "storage.chunk_gaussians", "Gaussians"),
    Column("merge entries", "merge.entries: keys that a list of a group has room for", "", ","),
    Column("on overflow", "merge.on_overflow: what is done with the keys beyond"),
    PSNR,
    Column("DRAM MB", "requested by units, both directions", "MB", ".2f"),
    Column("spill MB", "of them for keys that left the merge unit", "MB", ".2f"),
    Column("forced early", "keys blended before all nearer ones were known", "keys", ","),
    Column("k cycles", "of the frame", "1000 cycles", ",.0f"),
    Column("shared SRAM B", "shared on-chip memory that the combination needs", "B", ","),
    Column("simulation s", "wall time of the simulation", "s", ".2f"),
)


def combinations(preset: dict, cross: bool) -> list[tuple]:
    """(group, chunk, entries, on_overflow). Without `cross` one axis is moved at a time, around
    the preset, but for the merge buffer, whose size and overflow policy go together."""
    if cross:
        return list(itertools.product(GROUPS, CHUNK_GAUSSIANS, MERGE_ENTRIES, ON_OVERFLOW))
    shape, chunk = shape_of(preset), preset["storage"]["chunk_gaussians"]
    entries, on_overflow = preset["merge"]["entries"], preset["merge"]["on_overflow"]
    points = [
        (shape, chunk, n, policy) for policy, n in itertools.product(ON_OVERFLOW, MERGE_ENTRIES)
    ]
    points += [(group, chunk, entries, on_overflow) for group in GROUPS]
    points += [(shape, c, entries, on_overflow) for c in CHUNK_GAUSSIANS]
    return list(dict.fromkeys(points))


def overrides(point: tuple, preset: dict) -> tuple[str, ...]:
    shape, chunk, entries, on_overflow = point
    chunks_waiting = preset["hfu"]["candidate_fifo_entries"] / preset["storage"]["chunk_gaussians"]
    return (
        *group_assignments(shape),
        f"storage.chunk_gaussians={chunk}",
        f"hfu.candidate_fifo_entries={max(1, round(chunks_waiting * chunk))}",
        f"merge.entries={entries}",
        f"merge.on_overflow={on_overflow}",
        "framebuffer=rgb32f",
    )


def row(scene: str, view: dict) -> tuple:
    config = view["config"]
    return (
        scene,
        view["view"],
        shape_of(config),
        config["storage"]["chunk_gaussians"],
        config["merge"]["entries"],
        config["merge"]["on_overflow"],
        decibels(view),
        asked_mb(view),
        region_bytes(view, "spill") / MB,
        work(view, "forced_early"),
        cycles(view) / 1e3,
        config["sram"]["shared_bytes"],
        view["host"]["simulation_wall_s"],
    )


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_settings(to, "the exact preset")
    to.add_argument("--cross", action="store_true", help="every combination: 240 a scene")


def make(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    given = tuple(arguments.set)
    base = Run(scenes[0], overrides=given, fit_memories=True)
    preset = resolved_config(arguments.streaminggs, base)
    runs = [
        dataclasses.replace(
            base, scene=scene, view=arguments.view, overrides=(*given, *overrides(point, preset))
        )
        for scene in scenes
        for point in combinations(preset, arguments.cross)
    ]
    outcomes = swept(arguments, "work_precision", runs)
    for outcome in outcomes:
        if outcome.refused:
            print(f"left out: {outcome.run.label()}: {outcome.refused}", file=sys.stderr)
    found = [(outcome.run.scene.name, view) for outcome in outcomes for view in outcome.views]
    if not found:
        outcomes[0].accepted()
    by = tables.made_of(arguments.streaminggs, (view for _, view in found), scenes)
    rows = [row(scene, view) for scene, view in found]
    tables.write(arguments.out, "work_precision", by, COLUMNS, rows)
