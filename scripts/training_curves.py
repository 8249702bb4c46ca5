#!/usr/bin/env python3
"""How a scene comes out of photographs: PSNR and SSIM of the test views over steps and wall time,
for several seeds. Writes training_curves.md, a line for each look at the test views, and
training_summary.md, a line for each data set; and both as .csv. One training at a time; its
seconds have the looks in them. A training that was interrupted goes on where it was; what is done
is kept in fittings/ of the folder for tables.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from runs import run_arguments
import subjects
from results import tables
from runs.fittings import Fitted, Fitting, KeptFittings
from runs.run_digest import content_digest
from runs.simulations import Failure

HEAD = ("data set", "seed", "step", "seconds", "Gaussians", "loss", "PSNR dB", "SSIM")
SUMMARY_HEAD = (
    "data set",
    "seeds",
    "steps",
    "Gaussians",
    "minutes",
    "steps/s",
    "PSNR dB",
    "SSIM",
    "same seed, same bits",
)


def span(values: Sequence[float], digits: int) -> str:
    low, high = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return low if low == high else f"{low} .. {high}"


def curve_rows(name: str, seed: int, fitted: Fitted) -> list[tuple]:
    return [
        (
            name,
            seed,
            int(look["step"]),
            f"{float(look['seconds']):.0f}",
            int(look["gaussians"]),
            f"{float(look['loss']):.5f}",
            f"{float(look['test_psnr_db']):.2f}",
            f"{float(look['test_ssim']):.5f}",
        )
        for look in fitted.log
    ]


def summary_row(name: str, of_seeds: Sequence[Fitted], same_bits: str) -> tuple:
    if not all(fitted.log for fitted in of_seeds):
        raise ValueError(f"--minutes: {name} was stopped before its first look at the test views")
    last = [fitted.log[-1] for fitted in of_seeds]
    speeds = [fitted.steps() / fitted.seconds for fitted in of_seeds]
    return (
        name,
        len(of_seeds),
        span([fitted.steps() for fitted in of_seeds], 0),
        span([int(look["gaussians"]) for look in last], 0),
        span([fitted.seconds / 60 for fitted in of_seeds], 1),
        span(speeds, 1),
        span([float(look["test_psnr_db"]) for look in last], 2),
        span([float(look["test_ssim"]) for look in last], 4),
        same_bits,
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


def make_tables(arguments: argparse.Namespace) -> None:
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
    kept = KeptFittings(arguments.streaminggs, arguments.out / "fittings", side_by_side=1)
    rows, summary = [], []
    for name, folder in folders.items():

        def trained(seed: int, steps: int, most_seconds: float) -> Fitting:
            return subjects.training(folder, seed, steps, arguments, most_seconds)

        steps, most_seconds = arguments.train_steps, 60 * arguments.minutes
        of_seeds = kept.all([trained(seed, steps, most_seconds) for seed in arguments.seeds])
        for seed, fitted in zip(arguments.seeds, of_seeds):
            rows += curve_rows(name, seed, fitted)
        same_bits = ""
        if arguments.same_bits:
            short = trained(arguments.seeds[0], arguments.same_bits, 0)
            same_bits = compared_bits(kept.all(copies(short)))
        summary.append(summary_row(name, of_seeds, same_bits))
    made = run_arguments.how_made([{"provenance": {"commit": kept.commit}}])
    tables.write(arguments.out, "training_curves", made, HEAD, rows)
    tables.write(arguments.out, "training_summary", made, SUMMARY_HEAD, summary)


def main() -> int:
    parser = run_arguments.parser(
        __doc__,
        "the data sets of ../shared",
        what="DATASET",
        forms=subjects.DATASET_FORMS,
    )
    subjects.add_training_arguments(parser)
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3], metavar="N", help="each")
    parser.add_argument(
        "--minutes",
        type=float,
        default=0,
        help="each training is stopped then, wherever it is; 0: never",
    )
    parser.add_argument(
        "--same-bits",
        type=int,
        default=0,
        metavar="STEPS",
        help="train the first seed twice for so many steps, and compare the scenes; 0: not",
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
