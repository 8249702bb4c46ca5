"""What the size of a voxel is worth once the scene is tuned to it: quality, bytes, cycles and
energy of paper order with raw second halves, before and after boundary-aware tuning, for sizes from
half to four times the preset's. Frames are those of quality_table, and so is what they are compared
with. Makes voxel_study, and its figure, voxel_size."""

from __future__ import annotations

import argparse

import tables
from tables import SCENE, Column
from runs import run_arguments
from studies import subjects
from studies.subjects import FRAME_COLUMNS, JudgedFrames, frame_cells, target_pictures

JOBS = ("results.py voxel_study truck --size 240x135 --paper-set vsu.visit_gaussians=0",)

COLUMNS = (
    SCENE,
    Column("of the preset's", "side of a voxel over the preset's", "", "g"),
    Column("voxels", "side", "world units", ".4g"),
    Column("occupied", "voxels with a Gaussian in them", "", ","),
    Column("scene is", "as given, or tuned to this size"),
    *FRAME_COLUMNS,
)
STATES = ("as given", "tuned")


def add_arguments(to: run_arguments.Parser) -> None:
    subjects.add_arguments(to)
    subjects.add_beta(to)
    subjects.add_voxels(to, [0.5, 1, 2, 4])
    run_arguments.add_view(to, "all")


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    binary = arguments.streaminggs
    calls, kept, sources = subjects.begin(arguments, (subjects.PAPER,))
    subjects.check_views(binary, sources, arguments.view)
    rows, measured = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = subjects.voxel_of_preset(binary, subject.scene)
        voxels = [factor * preset for factor in arguments.voxels]
        tuned = kept.all([calls.boundary(subject, voxel, arguments.beta) for voxel in voxels])
        targets = target_pictures(arguments, subject)
        judged = JudgedFrames(arguments, targets, arguments.side_by_side)
        cases = [
            (factor, calls.voxel_words(voxel), state, scene)
            for factor, voxel, fitted in zip(arguments.voxels, voxels, tuned)
            for state, scene in zip(STATES, (subject.scene, str(fitted.scene)))
        ]
        runs = [
            judged.run(f"{subject.name} {state}", scene, arguments.view, subjects.PAPER, words)
            for _, words, state, scene in cases
        ]
        for (factor, _, state, _), views in zip(cases, judged.views(runs)):
            of = views[0]["scene"]
            head = (subject.name, factor, of["voxel_size"], of["voxels"], state)
            rows.append((*head, *frame_cells(views)))
            measured += views
    by = tables.made_of(binary, measured, sources)
    tables.write(arguments.out, "voxel_study", by, COLUMNS, rows)
    tables.draw_beside(arguments.out, "voxel_size")
