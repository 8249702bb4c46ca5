"""What half precision costs the picture, one stage at a time: PSNR of each view against the
reference picture with one stage in half and all else lossless. Frames are written as floats, so
that nothing else is lost. Makes half_by_stage."""

from __future__ import annotations

import argparse

import tables
from tables import PSNR, SCENE, VIEW, Column, Spread
from runs import run_arguments
from runs.scenes import find_scenes
from runs.simulations import Run, decibels
from runs.sweep_server import swept

JOBS = ("results.py half_by_stage truck platform yard park playbot garden --view 0",)

# Stage: preset, and the keys that put it into half. Records of projected features and depth keys go
# through memory in the tile-centric machine alone.
STAGES = {
    "second halves as stored": ("exact", "storage.encoding=half"),
    "projected features": ("gscore_lossless", "tiles.features=fp16"),
    "depth keys": ("gscore_lossless", "tiles.keys=fp16"),
    "blending, where ellipses reach": ("exact", "rendering.precision=fp16"),
    "blending, everywhere in boxes": ("gscore_lossless", "rendering.precision=fp16"),
}
COLUMNS = (SCENE, VIEW, Column("stage", "the one that computes or stores in half"), PSNR)


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to, "all")
    run_arguments.add_size(to, "640x360")


def make(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
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
        for preset, setting in STAGES.values()
    ]
    outcomes = iter(swept(arguments, "half_by_stage", runs))
    found = [
        (scene, stage, view)
        for scene in scenes
        for stage in STAGES
        for view in next(outcomes).accepted()
    ]
    by = tables.made_of(arguments.streaminggs, (view for _, _, view in found), scenes)
    rows = [(scene.name, view["view"], stage, decibels(view)) for scene, stage, view in found]
    spread = Spread("stage", "{PSNR dB}")
    tables.write(arguments.out, "half_by_stage", by, COLUMNS, rows, spread=spread)
