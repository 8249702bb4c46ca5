#!/usr/bin/env python3
"""What the size of a voxel is worth once the scene is tuned to it: quality, bytes, cycles and
energy of paper order with raw second halves, before and after boundary-aware tuning, for sizes from
half to four times the preset's. Frames are those of quality_table.py, and so is what they are
compared with. Writes voxel_study.md and .csv, and their figure, voxel_size.svg and .png.
Everything is kept in fittings/ and targets/ of the folder for tables, and goes on where it ended.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from runs import run_arguments
import subjects
from results import tables
import tunings
from drawing.figures_beside import draw_beside
from runs.fittings import KeptFittings
from judged_frames import (
    MACHINE_HEAD,
    JudgedFrames,
    machine_cells,
    mean,
    misordered_text,
    psnr_text,
)
from target_pictures import check_views, target_pictures

HEAD = (
    "scene",
    "of the preset's",
    "voxels",
    "occupied",
    "scene is",
    "PSNR dB",
    "SSIM",
    "misordered blends",
    *MACHINE_HEAD,
)
STATES = ("as given", "tuned")


def row(name: str, factor: float, state: str, views: Sequence[dict]) -> tuple:
    return (
        name,
        f"{factor:g}",
        f"{views[0]['scene']['voxel_size']:.4g}",
        views[0]["scene"]["voxels"],
        state,
        psnr_text(views),
        f"{mean(views, lambda v: v['target']['ssim']):.4f}",
        misordered_text(views),
        *machine_cells(views),
    )


def make_table(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    binary, calls = arguments.streaminggs, tunings.tunings_of(arguments)
    kept = KeptFittings(binary, arguments.out / "fittings", arguments.side_by_side)
    sources = subjects.find_sources(arguments.scenes or subjects.DEFAULT_SUBJECTS)
    tunings.check_settings(binary, calls, (tunings.PAPER,))
    check_views(binary, sources, arguments.view)
    rows, commits = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = tunings.voxel_of_preset(binary, subject)
        targets = target_pictures(binary, kept.program, arguments.out / "targets", subject)
        voxels = [factor * preset for factor in arguments.voxels]
        tuned = kept.all([calls.boundary(subject, voxel, arguments.beta) for voxel in voxels])
        judged = JudgedFrames(binary, targets, arguments.side_by_side)
        runs = [
            judged.run(
                f"{subject.name} {state}", scene, arguments.view, tunings.PAPER, voxel_words
            )
            for voxel_words, fitted in zip(map(calls.voxel_words, voxels), tuned)
            for state, scene in zip(STATES, (subject.scene, str(fitted.scene)))
        ]
        cases = [(factor, state) for factor in arguments.voxels for state in STATES]
        for (factor, state), views in zip(cases, judged.views(runs)):
            rows.append(row(subject.name, factor, state, views))
            commits += views
    made = run_arguments.how_made(commits)
    tables.write(arguments.out, "voxel_study", made, HEAD, rows)
    draw_beside(arguments.out, "voxel_size")


def main() -> int:
    parser = tunings.study_parser(__doc__, subjects.SUBJECT_FORMS)
    tunings.add_beta(parser)
    parser.add_argument(
        "--voxels",
        nargs="+",
        type=float,
        default=[0.5, 1, 2, 4],
        metavar="FACTOR",
        help="sizes, times the preset's",
    )
    parser.add_argument("--view", default="all", help="numbers of test views to draw, as in 0,2")
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
