#!/usr/bin/env python3
"""What tuning gives back of quality, and what it does to the machine. For each scene: as given,
tuned at the boundaries of voxels (paper order), for fewer bytes (exact order), and for codebooks;
drawn by both machines. PSNR and SSIM are means over the test views of frames read back from the
modelled DRAM, 8 bits a channel, beside the photographs before black, or beside the reference
pictures of the scene as given where there are no photographs. A data set is trained first. Writes

  quality_table.md    a line for each scene and order, as the paper has it
  quality_machine.md  a line for each scene, order and tuning: quality, bytes, cycles, joules

and both as .csv. `packed` is the scene with codebooks as `pack` makes them, tuned for nothing
further. Steps alone bring a scene nearer to photographs. So a data set has one line more, of order
`reference`: reference pictures of the same scene after as many steps at the same rates in that
order, for no price and without codebooks. Everything is kept in fittings/ and targets/ of the
folder for tables, and goes on where it ended.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
from collections.abc import Sequence

from runs import run_arguments
import subjects
from results import tables
import tunings
from runs.fittings import Fitting, KeptFittings
from judged_frames import (
    MACHINE_HEAD,
    JudgedFrames,
    machine_cells,
    mean,
    misordered_text,
    psnr_text,
)
from subjects import Subject
from target_pictures import check_views, target_pictures
from tunings import EXACT, EXACT_VQ, PAPER, PAPER_VQ

GIVEN, BOUNDARY = "as given", "boundary-aware"
PACKED, QUANTISED = "packed", "quantisation-aware"

HEAD = (
    "scene",
    "held to",
    "order",
    "reference dB",
    "SSIM",
    "streamed dB",
    "SSIM ",
    "boundary-aware dB",
    "SSIM  ",
    "packed dB",
    "SSIM   ",
    "quantisation-aware dB",
    "SSIM    ",
)
MACHINE_TABLE_HEAD = (
    "scene",
    "order",
    "tuned",
    "preset",
    "PSNR dB",
    "SSIM",
    "misordered blends",
    *MACHINE_HEAD,
)


@dataclasses.dataclass(frozen=True)
class Stage:
    """A scene in one state, and what draws it."""

    order: str
    tuned: str
    config: str
    scene: str
    overrides: tuple[str, ...] = ()


def prices_of(subject: Subject, prices: Sequence[float]) -> list[float]:
    """Beside photographs also none: what the steps alone do."""
    return list(dict.fromkeys((0.0, *prices) if subject.dataset else prices))


def steps_alone(subject: Subject, calls: tunings.Tunings) -> dict[str, Fitting]:
    """By name. Own pictures need none: a scene shows them as it is."""
    if not subject.dataset:
        return {}
    return {
        as_long_as(BOUNDARY): calls.as_long_as_boundary(subject),
        as_long_as(QUANTISED): calls.as_long_as_quantised(subject),
    }


def as_long_as(tuning: str) -> str:
    return f"as long as {tuning}"


def stages_of(
    subject: Subject,
    kept: KeptFittings,
    calls: tunings.Tunings,
    voxel: float,
    arguments: argparse.Namespace,
) -> list[Stage]:
    """Tunes what is not tuned yet. What is packed already says its voxels itself."""
    given, voxels = subject.scene, calls.voxel_words(voxel)
    prices, alone = prices_of(subject, arguments.prices), steps_alone(subject, calls)
    first = [
        calls.boundary(subject, voxel, arguments.beta),
        calls.quantised(subject, given, EXACT_VQ, ()),
        *(calls.streaming(subject, price) for price in prices),
        *alone.values(),
    ]
    boundary, exact_vq, *others = (str(fitted.scene) for fitted in kept.all(first))
    settings = (*calls.tuned_in(), *tunings.set_words(voxels))
    (paper_vq,) = kept.all([calls.quantised(subject, boundary, PAPER_VQ, settings)])
    named = [*(f"for streaming, price {price:g}" for price in prices), *alone]
    in_reference_order = [
        Stage("exact", tuned, EXACT, scene) for tuned, scene in zip(named, others)
    ]
    return [
        Stage("paper", GIVEN, PAPER, given, voxels),
        Stage("paper", BOUNDARY, PAPER, boundary, voxels),
        Stage("paper", PACKED, PAPER_VQ, boundary, voxels),
        Stage("paper", QUANTISED, PAPER_VQ, str(paper_vq.scene), calls.paper_set),
        Stage("exact", GIVEN, EXACT, given),
        Stage("exact", BOUNDARY, EXACT, boundary),
        *in_reference_order,
        Stage("exact", PACKED, EXACT_VQ, given),
        Stage("exact", QUANTISED, EXACT_VQ, exact_vq),
    ]


def quality(views: Sequence[dict], of: str = "") -> tuple[str, str]:
    """PSNR and SSIM. of: `reference_` for the reference picture of the scene."""
    ssim = mean(views, lambda view: view["target"][f"{of}ssim"])
    return psnr_text(views, f"{of}psnr_db"), f"{ssim:.4f}"


def quality_row(subject: Subject, order: str, by_tuning: dict[str, Sequence[dict]]) -> tuple:
    cells = quality(by_tuning[GIVEN], "reference_")
    for tuned in (GIVEN, BOUNDARY, PACKED, QUANTISED):
        cells += quality(by_tuning[tuned])
    held_to = "photographs" if subject.dataset else "own pictures"
    return (subject.name, held_to, order, *cells)


def steps_alone_row(subject: Subject, exact: dict[str, Sequence[dict]]) -> tuple:
    """Each beside the tuning that it took as long as."""
    given, boundary, quantised = (
        quality(exact[tuned], "reference_")
        for tuned in (GIVEN, as_long_as(BOUNDARY), as_long_as(QUANTISED))
    )
    nothing = ("", "")
    cells = (*given, *nothing, *boundary, *nothing, *quantised)
    return (subject.name, "photographs", "reference", *cells)


def machine_row(subject: Subject, stage: Stage, views: Sequence[dict]) -> tuple:
    return (
        subject.name,
        stage.order,
        stage.tuned,
        stage.config,
        *quality(views),
        misordered_text(views),
        *machine_cells(views),
    )


def make_tables(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--prices", arguments.prices)
    binary, calls = arguments.streaminggs, tunings.tunings_of(arguments, arguments.quantised_steps)
    kept = KeptFittings(binary, arguments.out / "fittings", arguments.side_by_side)
    sources = subjects.find_sources(arguments.scenes or subjects.DEFAULT_SUBJECTS)
    tunings.check_settings(binary, calls, (PAPER, PAPER_VQ))
    check_views(binary, sources, arguments.view)
    rows, machine_rows, commits = [], [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        voxel = tunings.voxel_of_preset(binary, subject)
        targets = target_pictures(binary, kept.program, arguments.out / "targets", subject)
        stages = stages_of(subject, kept, calls, voxel, arguments)
        judged = JudgedFrames(binary, targets, arguments.side_by_side)
        runs = [
            judged.run(
                f"{subject.name} {s.tuned}", s.scene, arguments.view, s.config, s.overrides
            )
            for s in stages
        ]
        by_order: dict[str, dict[str, Sequence[dict]]] = {}
        for stage, views in zip(stages, judged.views(runs)):
            by_order.setdefault(stage.order, {})[stage.tuned] = views
            machine_rows.append(machine_row(subject, stage, views))
            commits += views
        rows += [quality_row(subject, order, of) for order, of in by_order.items()]
        if subject.dataset:
            rows.append(steps_alone_row(subject, by_order["exact"]))
    made = run_arguments.how_made(commits)
    tables.write(arguments.out, "quality_table", made, HEAD, rows)
    tables.write(arguments.out, "quality_machine", made, MACHINE_TABLE_HEAD, machine_rows)


def main() -> int:
    parser = tunings.study_parser(__doc__, subjects.SUBJECT_FORMS)
    tunings.add_beta(parser)
    parser.add_argument("--quantised-steps", type=int, default=5_000, metavar="N", help="of tune")
    parser.add_argument(
        "--prices",
        nargs="+",
        type=float,
        default=[0.003, 0.03],
        metavar="X",
        help="of what is fetched, as of tune: a scene for each; beside photographs also for 0",
    )
    parser.add_argument("--view", default="all", help="numbers of test views to draw, as in 0,2")
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
