"""Studies of trainings and tunings as they go: over steps, over wall time, and from the first look at
the test views to the last."""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Sequence

import tables
from runs import run_arguments
from runs.files import content_digest
from runs.keeper import Fitted, Fitting
from runs.scenes import Failure, Scene
from studies import subjects
from studies.subjects import Subject
from tables import SCENE, Column, Study

DATASET = Column("data set", "its name")
SEED = Column("seed", "of the training", "", "d")
CURVE_COLUMNS = (
    DATASET,
    SEED,
    Column("step", "of the training", "", ","),
    Column("seconds", "since the beginning, with the looks", "s", ".0f"),
    Column("Gaussians", "of the scene then", "", ","),
    Column("loss", "of the last picture trained on", "", ".5f"),
    Column("PSNR dB", "of test views, mean", "dB", ".2f"),
    Column("SSIM", "of test views, mean", "", ".5f"),
)
TRAINING_COLUMNS = (
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


def training_row(name: str, seed: int, fitted: Fitted, same_bits: str) -> tuple:
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


def add_curve_arguments(to: run_arguments.Parser) -> None:
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


def make_training_curves(arguments: argparse.Namespace) -> None:
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
            summary.append(training_row(name, seed, fitted, same_bits if first else ""))
    by = tables.made(arguments.streaminggs, [kept.provenance], folders.values())
    tables.write(arguments.out, "training_curves", by, CURVE_COLUMNS, rows)
    tables.write(arguments.out, "training_summary", by, TRAINING_COLUMNS, summary)


TRAINING_CURVES = Study(
    "training_curves",
    """How a scene comes out of photographs: PSNR and SSIM of the test views over steps and wall time,
for several seeds. Makes training_curves, a line for each look at the test views, and
training_summary, a line for each training. One training at a time; its seconds have the looks in
them.
""",
    (
        "results.py training_curves lego --train-steps 5000 --gaussians 300000 --seeds 1 "
        "--same-bits 200",
    ),
    add_curve_arguments,
    make_training_curves,
)


BOUNDARY_CASE = (
    SCENE,
    Column("voxels", "side", "world units", ".4g"),
    Column("of the preset's", "side over the preset's", "", "g"),
    Column("beta", "weight of L_CBP", "", "g"),
)
LOOK_COLUMNS = (
    *BOUNDARY_CASE,
    Column("step", "of tuning", "", "d"),
    Column("PSNR dB", "of test views in paper order, mean", "dB", ".2f"),
    Column("SSIM", "of test views in paper order, mean", "", ".4f"),
    Column("reference order dB", "of test views in the order of depths", "dB", ".2f"),
    Column("misordered", "share of (group, Gaussian) pairs out of order", "", ".4f"),
    Column("in pixels", "share of blends out of order", "", ".4f"),
    Column("L_CBP", "penalty of the paper", "", ".3g"),
    Column("seconds", "since the beginning", "s", ".0f"),
)
LOOKED_AT = (
    *("test_psnr_db", "test_ssim", "reference_psnr_db", "misordered_gaussians"),
    *("misordered_pixels", "l_cbp", "seconds"),
)
BOUNDARY_COLUMNS = (
    *BOUNDARY_CASE,
    Column("steps", "of tuning", "", "d"),
    Column("unstreamed dB", "the scene as given in the order of depths", "dB", ".2f"),
    Column("before dB", "as given in paper order", "dB", ".2f"),
    Column("after dB", "tuned, in paper order", "dB", ".2f"),
    Column("after, reference order dB", "tuned, in the order of depths", "dB", ".2f"),
    Column("misordered before", "share of (group, Gaussian) pairs out of order", "", ".4f"),
    Column("misordered after", "the same, tuned", "", ".4f"),
    Column("in pixels before", "share of blends out of order", "", ".4f"),
    Column("in pixels after", "the same, tuned", "", ".4f"),
    Column("L_CBP before", "penalty of the paper", "", ".3g"),
    Column("L_CBP after", "the same, tuned", "", ".3g"),
)
# By --misordered-in: of the looks, and from the first to the last.
BOUNDARY_TABLES = {
    "group": ("boundary_study", "boundary_summary"),
    "pixel": ("boundary_pixel_study", "boundary_pixel"),
}

BoundaryCase = tuple[str, float, float, float]  # scene, size of voxels, of the preset's, beta


def look_rows(case: BoundaryCase, fitted: Fitted) -> list[tuple]:
    return [
        (*case, int(look["step"]), *(float(look[key]) for key in LOOKED_AT)) for look in fitted.log
    ]


def boundary_row(case: BoundaryCase, fitted: Fitted) -> tuple:
    """Unstreamed: the scene as given in the reference order."""
    first, last = (
        {key: float(look[key]) for key in LOOKED_AT if key in look}
        for look in (fitted.log[0], fitted.log[-1])
    )
    changes = ("misordered_gaussians", "misordered_pixels", "l_cbp")
    return (
        *(*case, fitted.steps(), first["reference_psnr_db"], first["test_psnr_db"]),
        *(last["test_psnr_db"], last["reference_psnr_db"]),
        *(look[key] for key in changes for look in (first, last)),
    )


def add_boundary_arguments(to: run_arguments.Parser) -> None:
    subjects.add_arguments(to)
    subjects.add_voxels(to, [1, 0.25])
    to.add_argument(
        "--betas", nargs="+", type=float, default=[0, 0.05, 0.5], metavar="X", help="of L_CBP"
    )


def make_boundary_study(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    run_arguments.check_once("--betas", arguments.betas)
    binary = arguments.streaminggs
    calls, kept, sources = subjects.begin(arguments, (subjects.PAPER,))
    cases, fittings = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = subjects.voxel_of(arguments, subject.scene)
        for factor in arguments.voxels:
            for beta in arguments.betas:
                cases.append((subject.name, factor * preset, factor, beta))
                fittings.append(calls.boundary(subject, factor * preset, beta))
    fitted = kept.all(fittings)
    by = tables.made(binary, [kept.provenance], sources)
    looks, ends = BOUNDARY_TABLES[arguments.misordered_in]
    rows = [row for case, each in zip(cases, fitted) for row in look_rows(case, each)]
    tables.write(arguments.out, looks, by, LOOK_COLUMNS, rows)
    summary = [boundary_row(case, each) for case, each in zip(cases, fitted)]
    tables.write(arguments.out, ends, by, BOUNDARY_COLUMNS, summary)


BOUNDARY_STUDY = Study(
    "boundary_study",
    """What boundary-aware tuning does to paper order as it goes: how much is out of order, and how near
the pictures come to their targets, every 500 steps, for sizes of voxels and weights of L_CBP. A
data set is trained first, and held to its photographs; a scene is held to its own reference
pictures. Makes boundary_study, a line for each look at the test views, and boundary_summary, from
the first step to the last. With --misordered-in pixel they are boundary_pixel_study and
boundary_pixel.
""",
    (
        "results.py boundary_study lego --train-steps 5000 --gaussians 300000 --voxel 0.4 "
        "--steps 1000 --voxels 1 --betas 0.05",
        "results.py boundary_study truck --size 400x225 --steps 1000 --voxels 1",
        "results.py boundary_study truck --size 400x225 --steps 1000 --voxels 1 "
        "--misordered-in pixel --betas 0.5 50",
    ),
    add_boundary_arguments,
    make_boundary_study,
)


SHORT_LOOKS = 8  # at the test views, while something is tuned or trained
TUNING_COLUMNS = (
    Column("what", "tuning, or training"),
    Column("of", "scene or data set"),
    Column("moved", "rate, or budget of Gaussians"),
    Column("to", "its value", "", "g"),
    Column("step", "of the fitting", "", "d"),
    Column("seconds", "since the beginning", "s", ".2f"),
    Column("Gaussians", "of the scene then", "", ","),
    Column("PSNR dB", "of test views, mean", "dB", ".3f"),
    Column("SSIM", "of test views, mean", "", ".5f"),
)


def looks_every(steps: int) -> tuple[str, ...]:
    return ("--steps", str(steps), "--test-every", str(max(1, steps // SHORT_LOOKS)))


def short_tuning(scene: Scene, rate: float, arguments: argparse.Namespace) -> Fitting:
    """To paper order in single precision; no L_CBP, which slows a step and gains no decibel."""
    size, between = arguments.tuning_size, arguments.between
    subject = Subject(scene.name, scene.spec, scene.cameras, size, between)
    words = (scene.spec, "--boundary", "--config", subjects.PAPER, "--beta", "0")
    words += subjects.tuned_in("fp32")
    words += (*subject.target_words(), "--rate", f"{rate:g}", *looks_every(arguments.steps))
    return Fitting(f"{scene.name} short rate {rate:g}", "tune", words)


def short_training(folder: pathlib.Path, budget: int, arguments: argparse.Namespace) -> Fitting:
    words = (str(folder), "--downscale", f"{arguments.downscale:g}", "--gaussians", str(budget))
    words += looks_every(arguments.train_steps)
    return Fitting(f"{folder.name} short of {budget}", "train", words)


def tuning_rows(fitted: Fitted, *facts: object) -> list[tuple]:
    return [
        (
            *(*facts, int(look["step"]), float(look["seconds"]), int(look["gaussians"])),
            *(float(look["test_psnr_db"]), float(look["test_ssim"])),
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


def make_error_tuning(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One fitting at a time, since their seconds count."""
    folders = dataset_folders(arguments)
    kept = subjects.kept_fittings(arguments, 1)
    asked = [
        (("tuning", scene.name, "rate", rate), short_tuning(scene, rate, arguments))
        for scene in scenes
        for rate in (arguments.rates if arguments.steps else ())
    ] + [
        (("training", folder.name, "budget", budget), short_training(folder, budget, arguments))
        for folder in folders
        for budget in arguments.budgets
    ]
    fitted = kept.all([fitting for _, fitting in asked])
    rows = [row for (facts, _), each in zip(asked, fitted) for row in tuning_rows(each, *facts)]
    by = tables.made(arguments.streaminggs, [kept.provenance], [*scenes, *folders])
    tables.write(arguments.out, "error_tuning", by, TUNING_COLUMNS, rows)
    tables.draw_beside(arguments.out, "error_tuning")
