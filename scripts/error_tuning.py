"""Quality of test views against wall time: scenes tuned to paper order at several rates of
learning, data sets trained with several budgets of Gaussians. A step sees one picture: `tune` and
`train` have no batch."""

from __future__ import annotations

import argparse
import pathlib

from runs import run_arguments
import subjects
from results import tables
from runs.fittings import Fitted
from runs.scenes import Scene
from tuning_points import kept_fittings, training, tuning

HEAD = ("what", "of", "moved", "to", "step", "seconds", "Gaussians", "PSNR dB", "SSIM")


def rows_of(what: str, of: str, knob: str, value: float, fitted: Fitted) -> list[tuple]:
    return [
        (
            what,
            of,
            knob,
            f"{value:g}",
            int(look["step"]),
            f"{float(look['seconds']):.2f}",
            int(look["gaussians"]),
            f"{float(look['test_psnr_db']):.3f}",
            f"{float(look['test_ssim']):.5f}",
        )
        for look in fitted.log
    ]


def dataset_folders(arguments: argparse.Namespace) -> list[pathlib.Path]:
    """Raises ValueError for what is no data set or there twice, and for nothing to fit."""
    folders = []
    for name in arguments.datasets:
        folder = subjects.dataset_folder(name)
        if not folder:
            raise ValueError(f"{name}: no data set; expected {subjects.DATASET_FORMS}")
        folders.append(folder)
    if not folders and not arguments.steps:
        raise ValueError("--steps: 0 and no --datasets: nothing to fit")
    run_arguments.check_once("--datasets", [folder.resolve() for folder in folders])
    return folders


def make(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One fitting at a time, since their seconds count. Raises Failure, ValueError."""
    folders = dataset_folders(arguments)
    kept = kept_fittings(arguments)
    asked = [
        (("tuning", scene.name, "rate", rate), tuning(scene, rate, arguments))
        for scene in scenes
        for rate in (arguments.rates if arguments.steps else ())
    ] + [
        (("training", folder.name, "budget", budget), training(folder, budget, arguments))
        for folder in folders
        for budget in arguments.budgets
    ]
    rows = []
    for (facts, _), fitted in zip(asked, kept.all([fitting for _, fitting in asked])):
        rows += rows_of(*facts, fitted)
    made = run_arguments.how_made_at([kept.commit])
    tables.write(arguments.out, "error_tuning", made, HEAD, rows)
