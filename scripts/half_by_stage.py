#!/usr/bin/env python3
"""What half precision costs the picture, stage by stage: PSNR of each view against the reference
picture with one stage in half and all else lossless. Frames are written as floats, so that nothing
else is lost. Writes half_by_stage.md and .csv."""

from __future__ import annotations

import argparse
import sys

from runs import run_arguments
from results import tables
from runs.scenes import Scene, find_scenes
from runs.simulations import SRAM_AS_NEEDED, Run, psnr_text, simulate_all

# Stage: preset, and the keys that put it into half. Records of projected features and depth keys go
# through memory in the tile-centric machine alone.
STAGES = {
    "second halves as stored": ("exact", "storage.encoding=half"),
    "projected features": ("gscore_lossless", "tiles.features=fp16"),
    "depth keys": ("gscore_lossless", "tiles.keys=fp16"),
    "blending, where ellipses reach": ("exact", "rendering.precision=fp16"),
    "blending, everywhere in boxes": ("gscore_lossless", "rendering.precision=fp16"),
}
HEAD = ("scene", "view", *STAGES)


def runs_of(scene: Scene, arguments: argparse.Namespace) -> list[Run]:
    return [
        Run(
            scene,
            arguments.view,
            arguments.size,
            preset,
            ("framebuffer=rgb32f", *(SRAM_AS_NEEDED if preset == "exact" else ()), setting),
        )
        for preset, setting in STAGES.values()
    ]


def make_table(arguments: argparse.Namespace) -> None:
    rows, measured = [], []
    for scene in find_scenes(arguments.scenes):
        runs = runs_of(scene, arguments)
        outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
        of_stage = [outcome.accepted() for outcome in outcomes]
        for views in zip(*of_stage):
            measured += views
            rows.append((scene.name, views[0]["view"], *map(psnr_text, views)))
    tables.write(arguments.out, "half_by_stage", run_arguments.how_made(measured), HEAD, rows)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="px of a view")
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
