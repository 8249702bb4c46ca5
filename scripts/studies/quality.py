"""Studies of pictures and machines once a scene is tuned, and what both are judged by: frames beside
target pictures."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import math
import pathlib
import statistics
import tempfile
from collections.abc import Sequence
from typing import IO

import tables
from runs import run_arguments
from runs.keeper import Fitting, Keeper, KeptFittings
from runs.scenes import Scene, answered, camera_count
from runs.simulations import MJ, Run, asked_mb, bus_mb, cycles, joules, mean, simulate_into
from studies import subjects
from studies.subjects import EXACT, EXACT_VQ, PAPER, PAPER_VQ, Source, Subject, Tunings
from tables import PRESET, SCENE, Column, Spread, Study


@dataclasses.dataclass(frozen=True)
class TargetPictures:
    """folder: has view_N.exr, before black. cameras, size: the arguments of `simulate` that draw
    the same views."""

    folder: pathlib.Path
    cameras: str
    size: str

    def picture(self, view: int) -> pathlib.Path:
        return self.folder / f"view_{view}.exr"


def check_views(binary: pathlib.Path, sources: Sequence[Source], view: str) -> None:
    """Whether each has these test views, before anything is trained. Raises ValueError."""
    for source in sources:
        last = test_views(binary, source) - 1
        seen: set[int] = set()
        for word in view.split(",") if view != "all" else ():
            number = int(word) if word.isdecimal() else -1
            if not 0 <= number <= last or number in seen:
                raise ValueError(
                    f"--view: got '{word}', expected all, or numbers from 0 to {last}, each once, "
                    f"as in 0,2: test views of {source.name}"
                )
            seen.add(number)


def test_views(binary: pathlib.Path, source: Source) -> int:
    if isinstance(source, Scene):
        return camera_count(binary, source)
    lines = answered(binary, "info", [str(source)], f"info {source}").splitlines()
    (count,) = (line.split()[3] for line in lines if line.startswith("to test with "))
    return int(count)


def target_pictures(arguments: argparse.Namespace, subject: Subject) -> TargetPictures:
    """Made once, of a subject that check_views() takes. Raises ValueError, Failure."""
    binary = arguments.streaminggs

    def make(place: pathlib.Path, _: IO) -> None:
        if subject.dataset:
            words = [subject.dataset, *subject.photograph_words(), "--out", str(place)]
            answered(binary, "photographs", words, f"photographs of {subject.name}")
            return
        views = camera_count(binary, Scene(subject.name, subject.scene, subject.cameras))
        for view in range(views):
            words = [subject.scene, "--cameras", subject.cameras, "--view", str(view)]
            words += ["--size", subject.size, "--out", str(place / f"view_{view}.exr")]
            answered(binary, "render", words, f"render {subject.name}")

    sources = [subject.dataset] if subject.dataset else [subject.scene, subject.cameras]
    keeper = Keeper(binary, arguments.kept / "targets")
    words = [*sources, subject.size, *subject.photograph_words()]
    place, _ = keeper.kept(subject.name, words, make)
    cameras = str(place / "cameras.json") if subject.dataset else subject.cameras
    return TargetPictures(place, cameras, subject.size)


class JudgedFrames:
    """Views of runs, each with `target`: `psnr_db` and `ssim` of its frame beside the target
    picture, `reference_psnr_db` and `reference_ssim` of the scene's reference picture (null:
    equal)."""

    def __init__(self, arguments: argparse.Namespace, targets: TargetPictures, side_by_side: int):
        self.binary, self.targets, self.workers = arguments.streaminggs, targets, side_by_side
        self.keeper = Keeper(self.binary, arguments.kept / "judged")

    def run(self, name: str, scene: str, view: str, config: str, overrides: Sequence[str]) -> Run:
        of = Scene(name, scene, self.targets.cameras)
        return Run(of, view, self.targets.size, config, tuple(overrides))

    def views(self, runs: Sequence[Run]) -> list[tuple[dict, ...]]:
        """Of each run. Raises Failure, and ValueError for what is refused."""
        with concurrent.futures.ThreadPoolExecutor(self.workers) as pool:
            return list(pool.map(self.views_of, runs))

    def views_of(self, run: Run) -> tuple[dict, ...]:
        def make(_: pathlib.Path, __: IO) -> tuple[dict, ...]:
            with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
                out = pathlib.Path(folder)
                views = simulate_into(out, self.binary, run).accepted()
                for view in views:
                    view["target"] = self.beside_target(out / f"view_{view['view']}", view["view"])
            return views

        words = [*run.arguments(), str(self.targets.folder)]
        return tuple(self.keeper.kept(run.label(), words, make)[1])

    def beside_target(self, folder: pathlib.Path, view: int) -> dict:
        target = self.targets.picture(view)
        psnr_db, ssim = compared(self.binary, folder / "frame.exr", target)
        reference_psnr_db, reference_ssim = compared(self.binary, folder / "reference.exr", target)
        return {
            "psnr_db": psnr_db,
            "ssim": ssim,
            "reference_psnr_db": reference_psnr_db,
            "reference_ssim": reference_ssim,
        }


def compared(
    binary: pathlib.Path, picture: pathlib.Path, target: pathlib.Path
) -> tuple[float | None, float]:
    """PSNR in dB, None where both are equal, and SSIM."""
    words = [str(picture), str(target)]
    lines = answered(binary, "compare", words, f"compare {' '.join(words)}").splitlines()
    values = {name: float(text) for name, text in (line.split() for line in lines)}
    psnr_db = values["psnr_db"]
    return (psnr_db if math.isfinite(psnr_db) else None), values["ssim"]


def mean_psnr(views: Sequence[dict], key: str = "psnr_db") -> float:
    """In dB, of the views that differ from their targets; infinite where none does."""
    found = [view["target"][key] for view in views]
    return statistics.fmean([psnr_db for psnr_db in found if psnr_db is not None] or [math.inf])


def quality_of(views: Sequence[dict], of: str = "") -> tuple[float, float]:
    """PSNR and SSIM. of: `reference_` for the reference picture of the scene."""
    ssim = mean(views, lambda view: view["target"][f"{of}ssim"])
    return mean_psnr(views, f"{of}psnr_db"), ssim


def frame_cells(views: Sequence[dict]) -> tuple[float, ...]:
    """Of FRAME_COLUMNS."""
    blends = sum(view["image"]["blends"] for view in views)
    return (
        *quality_of(views),
        sum(view["image"]["misordered"] for view in views) / max(1, blends),
        *(mean(views, asked_mb), mean(views, bus_mb)),
        *(mean(views, cycles) / 1e6, mean(views, joules) / MJ),
    )


FRAME_COLUMNS = (
    Column("PSNR dB", "beside the target, mean of the views that differ", "dB", ".2f"),
    Column("SSIM", "beside the target, mean over the views", "", ".4f"),
    Column("misordered blends", "share that is behind a splat which is farther away", "", ".4f"),
    Column("asked MB", "requested by units, mean over the views", "MB", ".2f"),
    Column("bus MB", "moved in whole bursts, mean over the views", "MB", ".2f"),
    Column("M cycles", "of the frame, mean over the views", "10^6 cycles", ".3f"),
    Column("mJ", "of the frame, mean over the views", "mJ", ".3f"),
)


REFERENCE, STREAMED, BOUNDARY = "reference", "streamed", "boundary-aware"
GIVEN, PACKED, QUANTISED = "as given", "packed", "quantisation-aware"

QUALITY_COLUMNS = (
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


def quality_rows(subject: Subject, order: str, by_tuning: dict[str, Sequence[dict]]) -> list[tuple]:
    head = (subject.name, "photographs" if subject.dataset else "own pictures", order)
    found = [(REFERENCE, quality_of(by_tuning[GIVEN], "reference_"))]
    for tuned in (GIVEN, BOUNDARY, PACKED, QUANTISED):
        found.append((STREAMED if tuned == GIVEN else tuned, quality_of(by_tuning[tuned])))
    return [(*head, picture, *numbers) for picture, numbers in found]


def steps_alone_rows(subject: Subject, exact: dict[str, Sequence[dict]]) -> list[tuple]:
    """Each beside the tuning that it took as long as."""
    pictures = ((REFERENCE, GIVEN), *((of, as_long_as(of)) for of in (BOUNDARY, QUANTISED)))
    return [
        (subject.name, "photographs", "reference", name, *quality_of(exact[tuned], "reference_"))
        for name, tuned in pictures
    ]


def add_quality_arguments(to: run_arguments.Parser) -> None:
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


def make_quality_table(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--prices", arguments.prices)
    binary = arguments.streaminggs
    presets = (PAPER, PAPER_VQ)
    calls, kept, sources = subjects.begin(arguments, presets, arguments.quantised_steps)
    check_views(binary, sources, arguments.view)
    rows, machine_rows, measured = [], [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        voxel = subjects.voxel_of(arguments, subject.scene)
        stages = stages_of(subject, kept, calls, voxel, arguments)
        judged = JudgedFrames(
            arguments, target_pictures(arguments, subject), arguments.side_by_side
        )
        runs = [
            judged.run(f"{subject.name} {s.tuned}", s.scene, arguments.view, s.config, s.overrides)
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
    tables.write(arguments.out, "quality_table", by, QUALITY_COLUMNS, rows, spread=spread)
    tables.write(arguments.out, "quality_machine", by, MACHINE_COLUMNS, machine_rows)


QUALITY_TABLE = Study(
    "quality_table",
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
""",
    (
        "results.py quality_table lego --train-steps 5000 --gaussians 300000 --voxel 0.4 "
        "--steps 1000 --quantised-steps 1000 --prices 0.03 --view 0,10,20,30,40",
        "results.py quality_table 'builtin:capture?n=1000000' truck --size 400x225 --steps 1000 "
        "--quantised-steps 1000 --prices 0.03",
    ),
    add_quality_arguments,
    make_quality_table,
)


VOXEL_COLUMNS = (
    SCENE,
    Column("of the preset's", "side of a voxel over the preset's", "", "g"),
    Column("voxels", "side", "world units", ".4g"),
    Column("occupied", "voxels with a Gaussian in them", "", ","),
    Column("scene is", "as given, or tuned to this size"),
    *FRAME_COLUMNS,
)
VOXEL_STATES = ("as given", "tuned")


def add_voxel_arguments(to: run_arguments.Parser) -> None:
    subjects.add_arguments(to)
    subjects.add_beta(to)
    subjects.add_voxels(to, [0.5, 1, 2, 4])
    run_arguments.add_view(to, "all")


def make_voxel_study(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--voxels", arguments.voxels)
    binary = arguments.streaminggs
    calls, kept, sources = subjects.begin(arguments, (subjects.PAPER,))
    check_views(binary, sources, arguments.view)
    rows, measured = [], []
    for subject in subjects.find_subjects(sources, arguments, kept):
        preset = subjects.voxel_of(arguments, subject.scene)
        voxels = [factor * preset for factor in arguments.voxels]
        tuned = kept.all([calls.boundary(subject, voxel, arguments.beta) for voxel in voxels])
        targets = target_pictures(arguments, subject)
        judged = JudgedFrames(arguments, targets, arguments.side_by_side)
        cases = [
            (factor, calls.voxel_words(voxel), state, scene)
            for factor, voxel, fitted in zip(arguments.voxels, voxels, tuned)
            for state, scene in zip(VOXEL_STATES, (subject.scene, str(fitted.scene)))
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
    tables.write(arguments.out, "voxel_study", by, VOXEL_COLUMNS, rows)
    tables.draw_beside(arguments.out, "voxel_size")


VOXEL_STUDY = Study(
    "voxel_study",
    """What the size of a voxel is worth once the scene is tuned to it: quality, bytes, cycles and
energy of paper order with raw second halves, before and after boundary-aware tuning, for sizes from
half to four times the preset's. Frames are those of quality_table, and so is what they are compared
with. Makes voxel_study, and its figure, voxel_size.
""",
    ("results.py voxel_study truck --size 240x135 --steps 1000",),
    add_voxel_arguments,
    make_voxel_study,
)
