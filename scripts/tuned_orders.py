#!/usr/bin/env python3
"""Exact order as shipped and with a single rendering cluster, which is about the area of the paper's
machine, beside three paper orders of the same on-chip memory: the shipped preset, groups of 128 px,
and voxel and group size chosen for each scene. View 0, second halves raw in all. Writes
tuned_orders.md.

The chosen sizes are the best of twelve by bytes times cycles: groups of 64, 96 and 128 px, voxels
of 0.05, 0.1, 0.2 and 0.4 world units (truck, playbot) or 0.25, 0.5, 1 and 2. Those whose ordering
table outgrows 16 KiB are not among them.
"""

from __future__ import annotations

import argparse
import itertools
import sys

import run_arguments
import tables
from scenes import Scene, find_scene
from simulations import Outcome, Run, psnr_text, simulate_all

PAPER = "paper_no_vq"
# The codebook buffer is idle with raw second halves; one group's pixels on chip leave room for
# larger groups and longer sort buffers.
SAME_SRAM = ("sram.codebook_bytes=0", "sram.shared_bytes=347136", "rendering.pixel_buffers=1")
# The points were searched with a fetch for each HFU, which is the faster reading, two lists of whole
# voxels being sorted, and its input buffers.
SPLIT = ("fetch=split", "hfu.slice_gaussians=128", "vsu.visit_gaussians=0")
WIDE = (*SAME_SRAM, *SPLIT, "vsu.table_bytes=16384", "group_px=128")
# VSU four times as fast; the largest sort buffers that fit beside a group of so many px.
FASTER_VSU = ("vsu.step_lanes=512", "vsu.edges_per_cycle=4", "vsu.table_bytes=16384")
SORT_BUFFER = {64: 2400, 96: 1550, 128: 367}
CHOSEN = {  # scene: world units of a voxel, px of a group
    "truck": (0.05, 96),
    "playbot": (0.05, 128),
    "platform": (2, 128),
    "yard": (0.5, 96),
    "garden": (1, 128),
    "park": (0.5, 96),
}
HEAD = ("scene", "exact", "exact, 1 cluster", "paper", "paper, 128 px", "paper, chosen")


def chosen(scene: str) -> tuple[str, ...]:
    voxel, group_px = CHOSEN[scene]
    return (
        *SAME_SRAM,
        *SPLIT,
        *FASTER_VSU,
        f"storage.voxel_size={voxel}",
        f"group_px={group_px}",
        f"sorting.buffer_entries={SORT_BUFFER[group_px]}",
    )


def runs_of(scene: Scene) -> list[Run]:
    """Each machine twice: as it stores pixels, and storing floats, for the picture's quality."""
    machines = [
        ("exact", ()),
        ("exact", ("rendering.clusters=1",)),
        (PAPER, ()),
        (PAPER, WIDE),
        (PAPER, chosen(scene.name)),
    ]
    return [
        Run(scene, config=config, overrides=(*overrides, f"framebuffer={pixels}"))
        for config, overrides in machines
        for pixels in ("rgb8", "rgb32f")
    ]


def cell(traffic: Outcome, quality: Outcome) -> str:
    """MB / M cycles / mJ / mm2 / dB."""
    view = traffic.accepted()[0]
    megabytes, cycles = view["dram"]["bytes"] / 1e6, view["frame"]["cycles"] / 1e6
    millijoules = view["energy"]["total_j"] * 1e3
    area = view["area_mm2"]["total"]
    psnr = psnr_text(quality.accepted()[0])
    decibels = psnr if psnr == "equal" else f"{float(psnr):.1f}"
    return f"{megabytes:.1f} / {cycles:.2f} / {millijoules:.2f} / {area:.1f} / {decibels}"


def make_table(arguments: argparse.Namespace) -> None:
    scenes = [find_scene(name) for name in arguments.scenes or CHOSEN]
    if unknown := [scene.name for scene in scenes if scene.name not in CHOSEN]:
        raise ValueError(f"{unknown[0]}: nothing is chosen for it; expected {', '.join(CHOSEN)}")
    runs = [run for scene in scenes for run in runs_of(scene)]
    outcomes = list(simulate_all(arguments.streaminggs, runs, arguments.side_by_side))
    cells = iter([cell(*pair) for pair in zip(outcomes[0::2], outcomes[1::2])])
    rows = [(scene.name, *itertools.islice(cells, len(HEAD) - 1)) for scene in scenes]
    made = run_arguments.how_made(o.views[0] for o in outcomes)
    table = made + tables.markdown(HEAD, rows)
    tables.write_text(arguments.out / "tuned_orders.md", table)
    print(table)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
