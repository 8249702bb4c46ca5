"""What boundary-aware tuning does to paper order as it goes: how much is out of order, and how near
the pictures come to their targets, every 500 steps, for sizes of voxels and weights of L_CBP. A
data set is trained first, and held to its photographs; a scene is held to its own reference
pictures. Makes boundary_study, a line for each look at the test views, and boundary_summary, from
the first step to the last. With --misordered-in pixel they are boundary_pixel_study and
boundary_pixel.
"""

from __future__ import annotations

import argparse

import tables
from tables import SCENE, Column
from runs import run_arguments
from runs.keeper import Fitted
from studies import subjects

JOBS = (
    "results.py boundary_study lego truck --size 400x225 --train-steps 8000 "
    "--paper-set vsu.visit_gaussians=0",
    "results.py boundary_study platform yard --size 240x135 "
    "--paper-set vsu.visit_gaussians=0",
    "results.py boundary_study truck --size 400x225 --paper-set vsu.visit_gaussians=0 "
    "--misordered-in pixel --betas 0.5 5 50 500 --voxels 1",
)

CASE = (
    SCENE,
    Column("voxels", "side", "world units", ".4g"),
    Column("of the preset's", "side over the preset's", "", "g"),
    Column("beta", "weight of L_CBP", "", "g"),
)
COLUMNS = (
    *CASE,
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
SUMMARY_COLUMNS = (
    *CASE,
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
TABLES = {
    "group": ("boundary_study", "boundary_summary"),
    "pixel": ("boundary_pixel_study", "boundary_pixel"),
}

Case = tuple[str, float, float, float]  # scene, size of voxels, of the preset's, beta


def rows_of(case: Case, fitted: Fitted) -> list[tuple]:
    return [
        (*case, int(look["step"]), *(float(look[key]) for key in LOOKED_AT)) for look in fitted.log
    ]


def summary_row(case: Case, fitted: Fitted) -> tuple:
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


def add_arguments(to: run_arguments.Parser) -> None:
    forms = f"{subjects.DATASET_FORMS}; {run_arguments.SCENE_FORMS}"
    subjects.add_arguments(to, forms)
    subjects.add_voxels(to, [1, 0.25])
    to.add_argument(
        "--betas", nargs="+", type=float, default=[0, 0.05, 0.5], metavar="X", help="of L_CBP"
    )


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    run_arguments.check_once("--betas", arguments.betas)
    binary = arguments.streaminggs
    calls, kept, sources = subjects.begin(arguments, (subjects.PAPER,))
    cases, fittings = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = subjects.voxel_of_preset(binary, subject.scene)
        for factor in arguments.voxels:
            for beta in arguments.betas:
                cases.append((subject.name, factor * preset, factor, beta))
                fittings.append(calls.boundary(subject, factor * preset, beta))
    fitted = kept.all(fittings)
    by = tables.made(binary, [kept.provenance], sources)
    looks, ends = TABLES[arguments.misordered_in]
    rows = [row for case, each in zip(cases, fitted) for row in rows_of(case, each)]
    tables.write(arguments.out, looks, by, COLUMNS, rows)
    summary = [summary_row(case, each) for case, each in zip(cases, fitted)]
    tables.write(arguments.out, ends, by, SUMMARY_COLUMNS, summary)
