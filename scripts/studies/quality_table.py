"""What tuning gives back of quality, and what it does to the machine. For each scene: as given,
tuned at the boundaries of voxels (paper order), for fewer bytes (exact order), and for codebooks;
drawn by both machines. PSNR and SSIM are means over the test views of frames read back from the
modelled DRAM, 8 bits a channel, beside the photographs before black, or beside the reference
pictures of the scene as given where there are no photographs. A data set is trained first. Makes

  quality_table    quality by scene, order and tuning, as the paper has it
  quality_machine  a line for each scene, order and tuning: quality, bytes, cycles, joules

`packed` is the scene with codebooks as `pack` makes them, tuned for nothing further. Steps alone
bring a scene nearer to photographs. So a data set has one line more, of order `reference`:
reference pictures of the same scene after as many steps at the same rates in that order, for no
price and without codebooks.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence

import tables
from tables import PRESET, SCENE, Column, Spread
from runs import run_arguments
from runs.keeper import Fitting, KeptFittings
from studies import subjects
from studies.subjects import (
    EXACT,
    EXACT_VQ,
    FRAME_COLUMNS,
    PAPER,
    PAPER_VQ,
    JudgedFrames,
    Subject,
    Tunings,
    frame_cells,
    quality,
    target_pictures,
)

JOBS = (
    "results.py quality_table lego truck --size 400x225 --train-steps 8000 --prices 0.03 "
    "--paper-set vsu.visit_gaussians=0",
    "results.py quality_table desk --size 240x135 --train-steps 8000 --prices 0.03 "
    "--downscale 2 --gaussians 50000 --paper-set vsu.visit_gaussians=0",
    "results.py quality_table platform yard --size 240x135 --prices 0.03 "
    "--paper-set vsu.visit_gaussians=0",
)

REFERENCE, STREAMED, BOUNDARY = "reference", "streamed", "boundary-aware"
GIVEN, PACKED, QUANTISED = "as given", "packed", "quantisation-aware"

COLUMNS = (
    SCENE,
    Column("held to", "photographs, or its own reference pictures"),
    Column("order", "of the machine; reference: reference pictures after as many steps"),
    Column("picture", "reference picture as given, or frame of the scene so tuned"),
    Column("PSNR dB", "beside the target, mean of the views that differ", "dB", ".2f"),
    Column("SSIM", "beside the target, mean over the views", "", ".4f"),
)
MACHINE_COLUMNS = (
    SCENE,
    Column("order", "of the machine"),
    Column("tuned", "for what, or for how long without"),
    PRESET,
    *FRAME_COLUMNS,
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


def steps_alone(subject: Subject, calls: Tunings) -> dict[str, Fitting]:
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
    calls: Tunings,
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
    settings = (*calls.tuned_in(), *subjects.set_words(voxels))
    (paper_vq,) = kept.all([calls.quantised(subject, boundary, PAPER_VQ, settings)])
    named = [*(f"for streaming, price {price:g}" for price in prices), *alone]
    return [
        Stage("paper", GIVEN, PAPER, given, voxels),
        Stage("paper", BOUNDARY, PAPER, boundary, voxels),
        Stage("paper", PACKED, PAPER_VQ, boundary, voxels),
        Stage("paper", QUANTISED, PAPER_VQ, str(paper_vq.scene), calls.paper_set),
        Stage("exact", GIVEN, EXACT, given),
        Stage("exact", BOUNDARY, EXACT, boundary),
        *(Stage("exact", tuned, EXACT, scene) for tuned, scene in zip(named, others)),
        Stage("exact", PACKED, EXACT_VQ, given),
        Stage("exact", QUANTISED, EXACT_VQ, exact_vq),
    ]


def quality_rows(
    subject: Subject, order: str, by_tuning: dict[str, Sequence[dict]]
) -> list[tuple]:
    head = (subject.name, "photographs" if subject.dataset else "own pictures", order)
    found = [(REFERENCE, quality(by_tuning[GIVEN], "reference_"))]
    for tuned in (GIVEN, BOUNDARY, PACKED, QUANTISED):
        found.append((STREAMED if tuned == GIVEN else tuned, quality(by_tuning[tuned])))
    return [(*head, picture, *numbers) for picture, numbers in found]


def steps_alone_rows(subject: Subject, exact: dict[str, Sequence[dict]]) -> list[tuple]:
    """Each beside the tuning that it took as long as."""
    pictures = ((REFERENCE, GIVEN), *((of, as_long_as(of)) for of in (BOUNDARY, QUANTISED)))
    return [
        (subject.name, "photographs", "reference", name, *quality(exact[tuned], "reference_"))
        for name, tuned in pictures
    ]


def add_arguments(to: run_arguments.Parser) -> None:
    subjects.add_arguments(to)
    subjects.add_beta(to)
    to.add_argument("--quantised-steps", type=int, default=5_000, metavar="N", help="of tune")
    to.add_argument(
        "--prices",
        nargs="+",
        type=float,
        default=[0.003, 0.03],
        metavar="X",
        help="of what is fetched, as of tune: a scene for each; beside photographs also for 0",
    )
    run_arguments.add_view(to, "all")


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--prices", arguments.prices)
    binary = arguments.streaminggs
    presets = (PAPER, PAPER_VQ)
    calls, kept, sources = subjects.begin(arguments, presets, arguments.quantised_steps)
    subjects.check_views(binary, sources, arguments.view)
    rows, machine_rows, measured = [], [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        voxel = subjects.voxel_of_preset(binary, subject.scene)
        stages = stages_of(subject, kept, calls, voxel, arguments)
        judged = JudgedFrames(
            arguments, target_pictures(arguments, subject), arguments.side_by_side
        )
        runs = [
            judged.run(
                f"{subject.name} {s.tuned}", s.scene, arguments.view, s.config, s.overrides
            )
            for s in stages
        ]
        by_order: dict[str, dict[str, Sequence[dict]]] = {}
        for stage, views in zip(stages, judged.views(runs)):
            by_order.setdefault(stage.order, {})[stage.tuned] = views
            head = (subject.name, stage.order, stage.tuned, stage.config)
            machine_rows.append((*head, *frame_cells(views)))
            measured += views
        rows += [row for order, of in by_order.items() for row in quality_rows(subject, order, of)]
        if subject.dataset:
            rows += steps_alone_rows(subject, by_order["exact"])
    by = tables.made_of(binary, measured, sources)
    spread = Spread("picture", "{PSNR dB} dB, {SSIM}")
    tables.write(arguments.out, "quality_table", by, COLUMNS, rows, spread=spread)
    tables.write(arguments.out, "quality_machine", by, MACHINE_COLUMNS, machine_rows)
