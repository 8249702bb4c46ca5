"""How a scene comes out of photographs: PSNR and SSIM of the test views over steps and wall time,
for several seeds. Makes training_curves, a line for each look at the test views, and
training_summary, a line for each training. One training at a time; its seconds have the looks in
them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import tables
from tables import Column
from runs import run_arguments
from runs.files import content_digest
from runs.keeper import Fitted, Fitting
from runs.simulations import Failure
from studies import subjects

JOBS = (
    "results.py training_curves lego --train-steps 8000 --same-bits 1000",
    "results.py training_curves desk --train-steps 8000 --seeds 1",
)

DATASET = Column("data set", "its name")
SEED = Column("seed", "of the training", "", "d")
COLUMNS = (
    DATASET,
    SEED,
    Column("step", "of the training", "", ","),
    Column("seconds", "since the beginning, with the looks", "s", ".0f"),
    Column("Gaussians", "of the scene then", "", ","),
    Column("loss", "of the last picture trained on", "", ".5f"),
    Column("PSNR dB", "of test views, mean", "dB", ".2f"),
    Column("SSIM", "of test views, mean", "", ".5f"),
)
SUMMARY_COLUMNS = (
    DATASET,
    SEED,
    Column("steps", "of the training", "", ","),
    Column("Gaussians", "of the scene at its end", "", ","),
    Column("minutes", "of wall time, with the looks", "min", ".1f"),
    Column("steps/s", "of all of them", "1/s", ".1f"),
    Column("PSNR dB", "of test views at the end, mean", "dB", ".2f"),
    Column("SSIM", "of test views at the end, mean", "", ".4f"),
    Column("same seed, same bits", "steps after which a second training had written the same"),
)


def curve_rows(name: str, seed: int, fitted: Fitted) -> list[tuple]:
    measured = ("loss", "test_psnr_db", "test_ssim")
    return [
        (
            *(name, seed, int(look["step"]), float(look["seconds"]), int(look["gaussians"])),
            *(float(look[key]) for key in measured),
        )
        for look in fitted.log
    ]


def summary_row(name: str, seed: int, fitted: Fitted, same_bits: str) -> tuple:
    if not fitted.log:
        raise ValueError(f"--minutes: {name} was stopped before its first look at the test views")
    last = fitted.log[-1]
    return (
        *(name, seed, fitted.steps(), int(last["gaussians"])),
        *(fitted.seconds / 60, fitted.steps() / fitted.seconds),
        *(float(last["test_psnr_db"]), float(last["test_ssim"]), same_bits),
    )


def compared_bits(twice: Sequence[Fitted]) -> str:
    """Raises Failure where two trainings alike wrote different scenes."""
    first, second = (content_digest(fitted.scene) for fitted in twice)
    label = f"{twice[0].fitting.label}: {twice[0].steps()} steps"
    if first != second:
        raise Failure(f"{label}, twice: {twice[0].scene} and {twice[1].scene} differ")
    return f"after {twice[0].steps():,} steps"


def copies(fitting: Fitting) -> list[Fitting]:
    again = Fitting(f"{fitting.label} again", fitting.command, fitting.words, copy=1)
    return [fitting, again]


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(
        to, "the data sets of ../shared", what="DATASET", forms=subjects.DATASET_FORMS
    )
    subjects.add_training_arguments(to)
    to.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3], metavar="N", help="each")
    to.add_argument(
        "--minutes",
        type=float,
        default=0,
        help="each training is stopped then, wherever it is; 0: never",
    )
    to.add_argument(
        "--same-bits",
        type=int,
        default=0,
        metavar="STEPS",
        help="train the first seed twice for so many steps, and compare the scenes; 0: not",
    )


def make(arguments: argparse.Namespace) -> None:
    if arguments.minutes < 0 or arguments.same_bits < 0:
        raise ValueError("--minutes, --same-bits: expected 0 or more")
    run_arguments.check_once("--seeds", arguments.seeds)
    folders = {}
    for text in arguments.scenes or subjects.datasets_there():
        folder = subjects.dataset_folder(text)
        if folder is None:
            there = ", ".join(subjects.datasets_there())
            raise ValueError(f"{text}: no data set; expected a folder or one of: {there}")
        folders[folder.name] = folder
    if not folders:
        raise ValueError("no data set is there, expected the folder of one")
    kept = subjects.kept_fittings(arguments, side_by_side=1)
    rows, summary = [], []
    for name, folder in folders.items():

        def trained(seed: int, steps: int, most_seconds: float) -> Fitting:
            return subjects.training(folder, seed, steps, arguments, most_seconds)

        steps, most_seconds = arguments.train_steps, 60 * arguments.minutes
        of_seeds = kept.all([trained(seed, steps, most_seconds) for seed in arguments.seeds])
        same_bits = ""
        if arguments.same_bits:
            short = trained(arguments.seeds[0], arguments.same_bits, 0)
            same_bits = compared_bits(kept.all(copies(short)))
        for seed, fitted in zip(arguments.seeds, of_seeds):
            rows += curve_rows(name, seed, fitted)
            first = seed == arguments.seeds[0]
            summary.append(summary_row(name, seed, fitted, same_bits if first else ""))
    by = tables.made(arguments.streaminggs, [kept.provenance], folders.values())
    tables.write(arguments.out, "training_curves", by, COLUMNS, rows)
    tables.write(arguments.out, "training_summary", by, SUMMARY_COLUMNS, summary)
