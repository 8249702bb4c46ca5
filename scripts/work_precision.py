#!/usr/bin/env python3
"""Error against run time of exact order, one table: what a smaller merge buffer (spilling, or
blending early), another pixel group or another chunk costs in quality, traffic and cycles.

Frames are written as floats (framebuffer=rgb32f), so that PSNR sees every error; that is 12 B a
pixel in DRAM. The coarse filters' FIFOs hold the survivors of as many whole chunks as in the
preset: with less room a larger chunk would be measured by its wait. Every combination gets the
shared on-chip memory that it needs; the column `shared SRAM B` says what that is.
"""

from __future__ import annotations

import argparse
import itertools
import sys

from runs import run_arguments
from results import tables
from runs.group_shapes import assignments, shape_of
from runs.scenes import find_scenes
from runs.simulations import (
    SRAM_AS_NEEDED,
    Outcome,
    Run,
    psnr_text,
    region_bytes,
    resolved_config,
    simulate_all,
    work,
)

MERGE_ENTRIES = (128, 256, 512, 1024, 2048, 4096)
ON_OVERFLOW = ("spill", "blend_early")
GROUPS = ("16", "32", "64", "128")
CHUNK_GAUSSIANS = (8, 16, 32, 64, 128, 256)

HEAD = (
    "scene",
    "view",
    "group px",
    "chunk",
    "merge entries",
    "on overflow",
    "PSNR dB",
    "DRAM MB",
    "spill MB",
    "forced early",
    "k cycles",
    "shared SRAM B",
)
CSV_HEAD = (
    "scene",
    "view",
    "group",
    "chunk_gaussians",
    "merge_entries",
    "on_overflow",
    "psnr_db",
    "dram_bytes",
    "spill_bytes",
    "keys_forced_early",
    "cycles",
    "simulation_wall_s",
    "sram_shared_bytes",
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
        *assignments(shape),
        f"storage.chunk_gaussians={chunk}",
        f"hfu.candidate_fifo_entries={max(1, round(chunks_waiting * chunk))}",
        f"merge.entries={entries}",
        f"merge.on_overflow={on_overflow}",
        "framebuffer=rgb32f",
    )


def rows_of(outcome: Outcome) -> tuple[list[tuple], list[tuple]]:
    """Rows of the Markdown table and of the CSV file, a view each."""
    text_rows, csv_rows = [], []
    for view in outcome.views:
        config = view["config"]
        point = (
            outcome.run.scene.name,
            view["view"],
            shape_of(config),
            config["storage"]["chunk_gaussians"],
            config["merge"]["entries"],
            config["merge"]["on_overflow"],
        )
        shared = config["sram"]["shared_bytes"]
        dram, spill = view["dram"]["bytes"], region_bytes(view, "spill")
        forced, cycles = work(view, "forced_early"), view["frame"]["cycles"]
        wall_s = view["host"]["simulation_wall_s"]
        text_rows.append(
            (
                *point,
                psnr_text(view),
                f"{dram / 1e6:.2f}",
                f"{spill / 1e6:.2f}",
                forced,
                round(cycles / 1e3),
                shared,
            )
        )
        psnr_db = view["image"]["psnr_db"]
        csv_rows.append(
            (
                *point,
                "inf" if psnr_db is None else psnr_db,
                dram,
                spill,
                forced,
                cycles,
                wall_s,
                shared,
            )
        )
    return text_rows, csv_rows


def make_table(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    base = (*SRAM_AS_NEEDED, *arguments.set)
    preset = resolved_config(arguments.streaminggs, Run(scenes[0], overrides=base))
    runs = [
        Run(scene, arguments.view, overrides=(*base, *overrides(point, preset)))
        for scene in scenes
        for point in combinations(preset, arguments.cross)
    ]
    text_rows, csv_rows, measured, refused = [], [], [], []
    for outcome in simulate_all(arguments.streaminggs, runs, arguments.side_by_side):
        if outcome.refused:
            print(f"left out: {outcome.run.label()}: {outcome.refused}", file=sys.stderr)
            refused.append(outcome)
        more_text, more_csv = rows_of(outcome)
        measured += outcome.views
        text_rows += more_text
        csv_rows += more_csv
    if not measured:
        refused[0].accepted()
    text = run_arguments.how_made(measured) + tables.markdown(HEAD, text_rows)
    tables.write_text(arguments.out / "work_precision.md", text)
    tables.write_text(arguments.out / "work_precision.csv", tables.csv_text(CSV_HEAD, csv_rows))
    print(text)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over the exact preset"
    )
    parser.add_argument("--cross", action="store_true", help="every combination: 240 a scene")
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
