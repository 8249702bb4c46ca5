"""Studies of what parts and sizes of a machine are worth, around its presets."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import sys
from collections.abc import Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import REPOSITORY, find_scenes
from runs.simulations import (
    MB,
    MJ,
    Run,
    asked_mb,
    binders,
    cycles,
    decibels,
    group_assignments,
    joules,
    mean,
    memory_known,
    region_bytes,
    resolved_config,
    shape_of,
    work,
)
from tables import PRESET, PSNR, SCENE, VIEW, Column, Spread, Study

Views = Sequence[dict]


def dram_joules(view: dict) -> float:
    return view["energy"]["dram_j"]


MEMSPECS = REPOSITORY / "modules" / "dram" / "memspecs"
MEMORY_COLUMNS = (
    Column("memory", "dram.memspec"),
    Column("channels", "dram.channels"),
    Column("GB/s", "peak of all channels", "GB/s", ".1f"),
    SCENE,
    Column("frames/s", "at the machine's clock, frames alone; mean cycles of the views", "", ".0f"),
    Column("of peak", "share of the peak that the frame's bus bytes take", "", ".0%"),
    Column("mJ", "of the frame, with DRAM and its I/O; empty: not known", "mJ", ".2f"),
    Column("of it DRAM", "energy of the DRAM and its I/O", "mJ", ".2f"),
    Column("binds", "busiest resource and its share; what holds the frame where it is another"),
)


def memory_row(run: Run, memory: str, channels: int, views: Views) -> tuple:
    known = all(map(memory_known, views))
    return (
        *(memory, channels, views[0]["dram"]["peak_gb_s"], run.scene.name),
        1 / mean(views, lambda v: v["frame"]["time_s"]),
        mean(views, lambda v: v["dram"]["of_peak"]),
        *(mean(views, of) / MJ if known else None for of in (joules, dram_joules)),
        binders(views),
    )


def add_memory_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, "640x360")
    to.add_argument("--config", default="exact", help="preset or JSON file")
    to.add_argument("--memspecs", nargs="+", metavar="NAME", help="default: all that are shipped")
    to.add_argument("--channels", type=int, nargs="+", default=[1, 2, 4], metavar="N", help="of each")
    run_arguments.add_settings(to, "the configuration")


def make_compare_memories(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--memspecs", arguments.memspecs or ())
    run_arguments.check_once("--channels", list(map(str, arguments.channels)))
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    memories = arguments.memspecs or sorted(path.stem for path in MEMSPECS.glob("*.json"))
    asked = list(itertools.product(memories, arguments.channels, scenes))
    runs = [
        Run(
            *(scene, arguments.view, arguments.size, arguments.config),
            (f"dram.memspec={memory}", f"dram.channels={channels}", *arguments.set),
        )
        for memory, channels, scene in asked
    ]
    views = [outcome.accepted() for outcome in swept(arguments, "compare_memories", runs)]
    by = tables.made_of(arguments.streaminggs, (v for of_run in views for v in of_run), scenes)
    rows = [
        memory_row(run, memory, channels, of_run)
        for run, (memory, channels, _), of_run in zip(runs, asked, views)
    ]
    about = f"Machine {arguments.config}, {arguments.size} px."
    tables.write(arguments.out, "compare_memories", by, MEMORY_COLUMNS, rows, about)


COMPARE_MEMORIES = Study(
    "compare_memories",
    """A machine with every memory: frames a second and energy of a frame over memories and channels.
Makes compare_memories.
""",
    ("results.py compare_memories truck yard",),
    add_memory_arguments,
    make_compare_memories,
)


CONFIGS = REPOSITORY / "testbench" / "configs"
SLOWER = (0, 1, 2)  # cycles that a lane takes more
SINGLE_CYCLES, HALF_CYCLES = 3, 2  # of a lane in each precision


def slower_lanes(by: int) -> tuple[str, str]:
    single, half = SINGLE_CYCLES + by, HALF_CYCLES + by
    return f"lane_latency_cycles={single}", f"half_lane_latency_cycles={half}"


def latency_columns(scenes: Sequence[str]) -> tuple[Column, ...]:
    of_scenes = [
        (
            Column(f"{scene}, M cycles", "of the frame", "10^6 cycles", ".3f"),
            *(
                Column(f"{scene}, lane +{by} cycles, %", "more than that", "%", "+.1f")
                for by in SLOWER[1:]
            ),
        )
        for scene in scenes
    ]
    return PRESET, *itertools.chain.from_iterable(of_scenes)


def add_latency_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, "640x360")


def slower_than_gscore(rows: Sequence[Sequence[object]], scenes: Sequence[str]) -> str:
    """Where the preset exact loses more by the slowest lanes than gscore does."""
    of = {row[0]: row[len(SLOWER) :: len(SLOWER)] for row in rows}
    lost = zip(scenes, of["exact"], of["gscore"])
    where = [scene for scene, ours, others in lost if ours > others]
    on = " and ".join(where) if where else "no scene"
    return f" By {SLOWER[-1]} cycles exact loses more than gscore on {on}."


def make_lane_latency(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    presets = sorted(path.stem for path in CONFIGS.glob("*.json"))
    size = (arguments.view, arguments.size)
    runs = [
        Run(scene, *size, preset, slower_lanes(by), fit_memories=True)
        for preset, scene, by in itertools.product(presets, scenes, SLOWER)
    ]
    outcomes = swept(arguments, "lane_latency", runs)
    taken = iter([mean(outcome.accepted(), cycles) for outcome in outcomes])
    rows = []
    for preset in presets:
        row: list[object] = [preset]
        for _ in scenes:
            first, *slower = (next(taken) for _ in SLOWER)
            row += [first / 1e6, *(100 * (each / first - 1) for each in slower)]
        rows.append(tuple(row))
    views = (view for outcome in outcomes for view in outcome.accepted())
    by = tables.made_of(arguments.streaminggs, views, scenes)
    about = (
        f"{arguments.size} px; lanes of {SINGLE_CYCLES} cycles in single precision, {HALF_CYCLES} in"
        " half, and both slower by one or two. Memories fitted."
        + slower_than_gscore(rows, [scene.name for scene in scenes])
    )
    columns = latency_columns([scene.name for scene in scenes])
    tables.write(arguments.out, "lane_latency", by, columns, rows, about)


LANE_LATENCY = Study(
    "lane_latency",
    """Every preset with lanes that are one and two cycles slower: cycles of a frame. Makes lane_latency.
""",
    ("results.py lane_latency truck yard",),
    add_latency_arguments,
    make_lane_latency,
)


# Stage: preset, and the keys that put it into half. Records of projected features and depth keys go
# through memory in the tile-centric machine alone.
HALF_STAGES = {
    "second halves as stored": ("exact", "storage.encoding=half"),
    "projected features": ("gscore_lossless", "tiles.features=fp16"),
    "depth keys": ("gscore_lossless", "tiles.keys=fp16"),
    "blending, where ellipses reach": ("exact", "rendering.precision=fp16"),
    "blending, everywhere in boxes": ("gscore_lossless", "rendering.precision=fp16"),
}
HALF_COLUMNS = (SCENE, VIEW, Column("stage", "the one that computes or stores in half"), PSNR)


def add_half_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to, "all")
    run_arguments.add_size(to, "640x360")


def make_half_by_stage(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    runs = [
        Run(
            scene,
            arguments.view,
            arguments.size,
            preset,
            ("framebuffer=rgb32f", setting),
            fit_memories=True,
        )
        for scene in scenes
        for preset, setting in HALF_STAGES.values()
    ]
    outcomes = iter(swept(arguments, "half_by_stage", runs))
    found = [
        (scene, stage, view)
        for scene in scenes
        for stage in HALF_STAGES
        for view in next(outcomes).accepted()
    ]
    by = tables.made_of(arguments.streaminggs, (view for _, _, view in found), scenes)
    rows = [(scene.name, view["view"], stage, decibels(view)) for scene, stage, view in found]
    spread = Spread("stage", "{PSNR dB}")
    tables.write(arguments.out, "half_by_stage", by, HALF_COLUMNS, rows, spread=spread)


HALF_BY_STAGE = Study(
    "half_by_stage",
    """What half precision costs the picture, one stage at a time: PSNR of each view against the
reference picture with one stage in half and all else lossless. Frames are written as floats, so
that nothing else is lost. Makes half_by_stage.
""",
    ("results.py half_by_stage truck platform yard park playbot garden --view 0",),
    add_half_arguments,
    make_half_by_stage,
)


MERGE_ENTRIES = (128, 256, 512, 1024, 2048, 4096)
ON_OVERFLOW = ("spill", "blend_early")
WORK_GROUPS = ("16", "32", "64", "128")
CHUNK_GAUSSIANS = (8, 16, 32, 64, 128, 256)

WORK_COLUMNS = (
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
        return list(itertools.product(WORK_GROUPS, CHUNK_GAUSSIANS, MERGE_ENTRIES, ON_OVERFLOW))
    shape, chunk = shape_of(preset), preset["storage"]["chunk_gaussians"]
    entries, on_overflow = preset["merge"]["entries"], preset["merge"]["on_overflow"]
    points = [
        (shape, chunk, n, policy) for policy, n in itertools.product(ON_OVERFLOW, MERGE_ENTRIES)
    ]
    points += [(group, chunk, entries, on_overflow) for group in WORK_GROUPS]
    points += [(shape, c, entries, on_overflow) for c in CHUNK_GAUSSIANS]
    return list(dict.fromkeys(points))


def work_overrides(point: tuple, preset: dict) -> tuple[str, ...]:
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


def work_row(scene: str, view: dict) -> tuple:
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


def add_work_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_settings(to, "the exact preset")
    to.add_argument("--cross", action="store_true", help="every combination: 240 a scene")


def make_work_precision(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    given = tuple(arguments.set)
    base = Run(scenes[0], overrides=given, fit_memories=True)
    preset = resolved_config(arguments.streaminggs, base)
    runs = [
        dataclasses.replace(
            base,
            scene=scene,
            view=arguments.view,
            overrides=(*given, *work_overrides(point, preset)),
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
    rows = [work_row(scene, view) for scene, view in found]
    tables.write(arguments.out, "work_precision", by, WORK_COLUMNS, rows)


WORK_PRECISION = Study(
    "work_precision",
    """Error against run time of exact order: what a smaller merge buffer (spilling, or blending early),
another pixel group or another chunk costs in quality, traffic and cycles. Makes work_precision.

Frames are written as floats (framebuffer=rgb32f), so that PSNR sees every error; that is 12 B a
pixel in DRAM. The coarse filters' FIFOs hold the survivors of as many whole chunks as in the
preset: with less room a larger chunk would be measured by its wait. Every combination gets the
shared on-chip memory that it needs; the column `shared SRAM B` says what that is.
""",
    ("results.py work_precision builtin:outdoor truck",),
    add_work_arguments,
    make_work_precision,
)
