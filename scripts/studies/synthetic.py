"""Scenes as the paper's synthetic ones (StreamingGS, DAC 2025): data sets that are trained here, or
what stands in."""

from __future__ import annotations

import argparse

from runs import run_arguments
from runs.scenes import Scene
from studies import subjects
from studies.claims import SYNTHETIC
from studies.quality import target_pictures
from studies.subjects import Subject

STAND_IN = "builtin:object?n=300000"  # as many Gaussians as the paper's synthetic scenes


def add_synthetic(to: run_arguments.Parser) -> None:
    to.add_argument(
        *("--synthetic", "-s"),
        action="append",
        metavar="SCENE",
        help=f"scene, or data set to train, drawn at {SYNTHETIC.size}, in voxels of 0.4; default: "
        f"{STAND_IN}",
    )
    subjects.add_training_arguments(to)
    subjects.add_seed(to)


def synthetic_scenes(arguments: argparse.Namespace) -> list[Scene]:
    """Data sets are trained now, and drawn at their test views."""
    sources = subjects.find_sources(arguments.synthetic or (STAND_IN,))
    folders = [source for source in sources if not isinstance(source, Scene)]
    kept = subjects.kept_fittings(arguments, side_by_side=1)
    trained = iter(subjects.find_subjects(folders, arguments, kept))

    def of_subject(subject: Subject) -> Scene:
        return Scene(subject.name, subject.scene, target_pictures(arguments, subject).cameras)

    return [s if isinstance(s, Scene) else of_subject(next(trained)) for s in sources]
