#!/usr/bin/env python3
"""What boundary-aware tuning does to paper order as it goes: how much is out of order, and how near
the pictures come to their targets, every 500 steps, for sizes of voxels and weights of L_CBP. A
data set is trained first, and held to its photographs; a scene is held to its own reference
pictures. Writes boundary_study.md, a line for each look at the test views, and
boundary_summary.md, from the first step to the last; and both as .csv. A tuning that was
interrupted goes on where it was; what is done is kept in fittings/ of the folder for tables. With
--misordered-in pixel the tables are boundary_pixel_study and boundary_pixel.
"""

from __future__ import annotations

import argparse
import sys

from runs import run_arguments
import subjects
from results import tables
import tunings
from runs.fittings import Fitted, KeptFittings

HEAD = (
    "scene",
    "voxels",
    "of the preset's",
    "beta",
    "step",
    "PSNR dB",
    "SSIM",
    "reference order dB",
    "misordered",
    "in pixels",
    "L_CBP",
    "seconds",
)
SUMMARY_HEAD = (
    "scene",
    "voxels",
    "of the preset's",
    "beta",
    "steps",
    "unstreamed dB",
    "before dB",
    "after dB",
    "after, reference order dB",
    "misordered",
    "times less",
    "in pixels",
    "times less ",
    "L_CBP",
    "times less  ",
)

# By --misordered-in: of the looks, and from the first to the last.
TABLES = {
    "group": ("boundary_study", "boundary_summary"),
    "pixel": ("boundary_pixel_study", "boundary_pixel"),
}

Case = tuple[str, float, float, float]  # scene, size of voxels, of the preset's, beta


def rows_of(case: Case, fitted: Fitted) -> list[tuple]:
    name, voxel, factor, beta = case
    return [
        (
            name,
            f"{voxel:g}",
            f"{factor:g}",
            f"{beta:g}",
            int(look["step"]),
            f"{float(look['test_psnr_db']):.2f}",
            f"{float(look['test_ssim']):.4f}",
            f"{float(look['reference_psnr_db']):.2f}",
            f"{float(look['misordered_gaussians']):.4f}",
            f"{float(look['misordered_pixels']):.4f}",
            f"{float(look['l_cbp']):.3g}",
            f"{float(look['seconds']):.0f}",
        )
        for look in fitted.log
    ]


def summary_row(case: Case, fitted: Fitted) -> tuple:
    """Unstreamed: the scene as given in the reference order."""
    name, voxel, factor, beta = case
    first, last = fitted.log[0], fitted.log[-1]

    def change(key: str, form: str) -> tuple[str, str]:
        before, after = float(first[key]), float(last[key])
        times = f"{before / after:.2f}" if after > 0 else ""
        return f"{before:{form}} .. {after:{form}}", times

    return (
        name,
        f"{voxel:g}",
        f"{factor:g}",
        f"{beta:g}",
        fitted.steps(),
        f"{float(first['reference_psnr_db']):.2f}",
        f"{float(first['test_psnr_db']):.2f}",
        f"{float(last['test_psnr_db']):.2f}",
        f"{float(last['reference_psnr_db']):.2f}",
        *change("misordered_gaussians", ".4f"),
        *change("misordered_pixels", ".4f"),
        *change("l_cbp", ".3g"),
    )


def make_tables(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    run_arguments.check_once("--betas", arguments.betas)
    kept = KeptFittings(arguments.streaminggs, arguments.out / "fittings", arguments.side_by_side)
    sources = subjects.find_sources(arguments.scenes or subjects.DEFAULT_SUBJECTS)
    calls = tunings.tunings_of(arguments)
    tunings.check_settings(arguments.streaminggs, calls, (tunings.PAPER,))
    cases, fittings = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = tunings.voxel_of_preset(arguments.streaminggs, subject)
        for factor in arguments.voxels:
            for beta in arguments.betas:
                cases.append((subject.name, factor * preset, factor, beta))
                fittings.append(calls.boundary(subject, factor * preset, beta))
    fitted = kept.all(fittings)
    made = run_arguments.how_made([{"provenance": {"commit": kept.commit}}])
    rows = [row for case, each in zip(cases, fitted) for row in rows_of(case, each)]
    summary = [summary_row(case, each) for case, each in zip(cases, fitted)]
    looks, ends = TABLES[arguments.misordered_in]
    tables.write(arguments.out, looks, made, HEAD, rows)
    tables.write(arguments.out, ends, made, SUMMARY_HEAD, summary)


def main() -> int:
    parser = tunings.study_parser(
        __doc__, f"{subjects.DATASET_FORMS}; {run_arguments.SCENE_FORMS}"
    )
    parser.add_argument(
        "--voxels",
        nargs="+",
        type=float,
        default=[1, 0.25],
        metavar="FACTOR",
        help="sizes, times the preset's",
    )
    parser.add_argument(
        "--betas", nargs="+", type=float, default=[0, 0.05, 0.5], metavar="X", help="of L_CBP"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
