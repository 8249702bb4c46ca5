"""Error against run time, a table for each question: what to choose when. Makes, of --diagrams,

  error_image      pictures of machines against frame time, bytes and energy: order, group, voxel,
                   chunk, merge buffer, encoding, precision, finishing, tuning
  error_tuning     quality of test views against wall time: rates of tuning on the scenes, budgets
                   of Gaussians in training on data sets; a step sees one picture
  error_renderers  pictures of the renderers in software, and of thresholds at which a pixel is
                   finished, against wall time, by threads

and their figures.

  results.py error_against_time truck yard platform park
  results.py error_against_time truck --diagrams image tuning
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import os
import pathlib
import sys
import tempfile
from collections.abc import Iterator, Sequence

import tables
from tables import SCENE, VIEW, Column
from runs import run_arguments, simulations
from runs.keeper import Fitted, Fitting, Keeper
from runs.scenes import Scene, find_scenes
from runs.simulations import (
    MJ,
    Failure,
    Outcome,
    Run,
    answered,
    asked_mb,
    cycles,
    decibels,
    joules,
    mm2,
    program_provenance,
    view_numbers_there,
)
from runs.sweep_server import swept
from studies import subjects
from studies.error_points import PAPER, PRESETS, Point, points
from studies.subjects import JudgedFrames, Subject, target_pictures

JOBS = (
    "results.py error_against_time truck yard platform park --diagrams image",
    "results.py error_against_time truck yard platform park --diagrams tuning "
    "--train-steps 3000",
    "results.py error_against_time truck yard platform park --diagrams renderers",
)

PROGRAM = simulations.BINARY.with_name("bench_renderers")
LOOKS = 8  # at the test views, while something is tuned or trained
PSNR_COLUMN = Column("PSNR dB", "beside the reference picture; inf: equal", "dB", ".2f")
IMAGE_COLUMNS = (
    SCENE,
    VIEW,
    Column("order", "exact, paper or tiles: of a machine's preset"),
    Column("moved", "what is not as in the preset"),
    Column("to", "its value"),
    PSNR_COLUMN,
    Column("SSIM", "beside the reference picture", "", ".6f"),
    Column("largest", "error of a channel, of 1", "", ".3g"),
    Column("missed", "(group, splat) pairs that are not blended", "", ","),
    Column("misordered", "share of the blends that are behind a farther splat", "", ".4f"),
    Column("ms", "of the frame", "ms", ".4f"),
    Column("MB", "requested by units", "MB", ".3f"),
    Column("mJ", "of the frame", "mJ", ".4f"),
    Column("mm2", "area of the machine", "mm2", ".3f"),
    Column("M cycles", "of the frame", "10^6 cycles", ".4f"),
)
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
RENDERER_COLUMNS = (
    SCENE,
    VIEW,
    Column("renderer", "in software, or machine's order"),
    Column("finished below", "light of a pixel that gets no more splats"),
    Column("threads", "that draw", "", "d"),
    Column("ms", "wall time of a picture", "ms"),
    Column("cpu ms", "processor time of a picture", "ms"),
    Column("beside", "renderer whose picture is the reference"),
    PSNR_COLUMN,
    Column("largest", "error of a channel, of 1"),
    Column("blends", "of all pixels", "", ","),
)


def image_row(scene: Scene, point: Point, view: dict, psnr_db: float, ssim: float) -> tuple:
    image = view["image"]
    return (
        *(scene.name, view["view"], point.order, point.knob, point.value, psnr_db, ssim),
        *(image["max_abs_error"], image["missed"], image["misordered"] / max(1, image["blends"])),
        *(1e3 * view["frame"]["time_s"], asked_mb(view), joules(view) / MJ, mm2(view)),
        cycles(view) / 1e6,
    )


def accepted(outcome: Outcome) -> Sequence[dict]:
    """What the command refuses is named and left out."""
    if outcome.refused:
        print(f"left out: {outcome.run.label()}: {outcome.refused}", file=sys.stderr)
    return outcome.views


def swept_frames(scene: Scene, arguments: argparse.Namespace) -> Iterator[tuple[tuple, dict]]:
    """Rows, and the reports that they are of."""
    cases = points(subjects.voxel_of_preset(arguments.streaminggs, scene.spec))
    runs = [
        Run(scene, arguments.view, arguments.size, p.config(), p.overrides(), fit_memories=True)
        for p in cases
    ]
    # A server for each scene: it holds all ways in which points want their scene stored.
    for point, outcome in zip(cases, swept(arguments, "error_image", runs)):
        for view in accepted(outcome):
            yield image_row(scene, point, view, decibels(view), view["image"]["ssim"]), view


def tuned_frames(scene: Scene, arguments: argparse.Namespace) -> Iterator[tuple[tuple, dict]]:
    """Paper order before and after the scene is tuned to it, PSNR and SSIM beside the pictures of
    the scene as given; the largest error is of the frame beside its own scene's. None of a scene
    that brings its own cameras: there is no file of them to tune on."""
    if not scene.cameras:
        print(f"{scene.name}: no file of cameras, not tuned", file=sys.stderr)
        return
    (fitted,) = subjects.kept_fittings(arguments, 1).all([tuning(scene, 1, arguments)])
    subject = Subject(scene.name, scene.spec, scene.cameras, arguments.size)
    judged = JudgedFrames(arguments, target_pictures(arguments, subject), 1)
    as_preset = Point(PAPER, "tuning", "before", ())
    states = (("before", scene.spec), ("after", str(fitted.scene)))
    runs = [
        dataclasses.replace(
            judged.run(
                f"{scene.name} {state}", spec, arguments.view, PRESETS[PAPER], as_preset.overrides()
            ),
            fit_memories=True,
        )
        for state, spec in states
    ]
    for (state, _), views in zip(states, judged.views(runs)):
        for view in views:
            psnr_db, ssim = view["target"]["psnr_db"], view["target"]["ssim"]
            psnr_db = float("inf") if psnr_db is None else psnr_db
            yield image_row(scene, Point(PAPER, "tuning", state, ()), view, psnr_db, ssim), view


def make_image(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    found = []
    for scene in scenes:
        found += swept_frames(scene, arguments)
    for scene in scenes if arguments.steps else ():
        found += tuned_frames(scene, arguments)
    if not found:
        raise ValueError("all points are refused")
    order = {scene.name: at for at, scene in enumerate(scenes)}
    rows = sorted((row for row, _ in found), key=lambda cells: order[cells[0]])
    by = tables.made_of(arguments.streaminggs, (view for _, view in found), scenes)
    tables.write(arguments.out, "error_image", by, IMAGE_COLUMNS, rows)
    tables.draw_beside(arguments.out, "error_image")


def looks_every(steps: int) -> tuple[str, ...]:
    return ("--steps", str(steps), "--test-every", str(max(1, steps // LOOKS)))


def tuning(scene: Scene, rate: float, arguments: argparse.Namespace) -> Fitting:
    """To paper order in single precision; no L_CBP, which slows a step and gains no decibel."""
    size, between = arguments.tuning_size, arguments.between
    subject = Subject(scene.name, scene.spec, scene.cameras, size, between)
    words = (scene.spec, "--boundary", "--config", subjects.PAPER, "--beta", "0")
    words += subjects.tuned_in("fp32")
    words += (*subject.target_words(), "--rate", f"{rate:g}", *looks_every(arguments.steps))
    return Fitting(f"{scene.name} short rate {rate:g}", "tune", words)


def training(folder: pathlib.Path, budget: int, arguments: argparse.Namespace) -> Fitting:
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


def make_tuning(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One fitting at a time, since their seconds count."""
    folders = dataset_folders(arguments)
    kept = subjects.kept_fittings(arguments, 1)
    asked = [
        (("tuning", scene.name, "rate", rate), tuning(scene, rate, arguments))
        for scene in scenes
        for rate in (arguments.rates if arguments.steps else ())
    ] + [
        (("training", folder.name, "budget", budget), training(folder, budget, arguments))
        for folder in folders
        for budget in arguments.budgets
    ]
    fitted = kept.all([fitting for _, fitting in asked])
    rows = [row for (facts, _), each in zip(asked, fitted) for row in tuning_rows(each, *facts)]
    by = tables.made(arguments.streaminggs, [kept.provenance], [*scenes, *folders])
    tables.write(arguments.out, "error_tuning", by, TUNING_COLUMNS, rows)
    tables.draw_beside(arguments.out, "error_tuning")


def laid_out(scene: Scene, folder: pathlib.Path) -> str:
    """As benchmarks find it: the cameras beside the scene, under its name."""
    if not scene.cameras:
        return scene.spec
    place = folder / f"{scene.name}.ply"
    os.symlink(os.path.abspath(scene.spec), place)
    os.symlink(os.path.abspath(scene.cameras), place.with_suffix(".json"))
    return str(place)


def timed(program: pathlib.Path, scene: Scene, words: list[str]) -> list[list[str]]:
    """Lines of RENDERER_COLUMNS. Raises ValueError for what the program refuses, Failure."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        spec = laid_out(scene, pathlib.Path(folder))
        head, *rows = list(csv.reader(run_program(program, [*words, spec]).splitlines())) or [[]]
    expected = [column.name for column in RENDERER_COLUMNS]
    if head != expected:
        raise Failure(f"{program}: columns {', '.join(head)}; expected {', '.join(expected)}")
    # The program names scenes of one kind alike, whatever their parameters.
    return [[scene.name, *cells] for _, *cells in rows]


def run_program(program: pathlib.Path, words: Sequence[str]) -> str:
    first, *others = words
    return answered(program, first, others, program.name)


def make_renderers(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One at a time, since their times count."""
    program = arguments.renderers
    keeper = Keeper(program, arguments.kept / "renderers")
    rows = []
    for threads in arguments.threads:
        for scene in scenes:
            for view in arguments.view.split(","):
                words = ["--threads", str(threads), "--size", arguments.size, "--view", view]
                facts = [*words, scene.name, scene.spec, scene.cameras]
                _, found = keeper.kept(
                    scene.name, facts, lambda *_: timed(program, scene, words)
                )
                rows += found
    by = tables.made(program, [program_provenance(arguments.streaminggs)], scenes)
    tables.write(arguments.out, "error_renderers", by, RENDERER_COLUMNS, rows)
    tables.draw_beside(arguments.out, "error_renderers")


DIAGRAMS = {"image": make_image, "tuning": make_tuning, "renderers": make_renderers}


def check(arguments: argparse.Namespace) -> None:
    """Before hours of frames. Raises ValueError for numbers that say nothing, and what is twice."""
    run_arguments.check_at_least("--steps", arguments.steps, 0)
    run_arguments.check_at_least("--between", arguments.between, 0)
    run_arguments.check_at_least("--train-steps", arguments.train_steps, 1)
    for budget in arguments.budgets:
        run_arguments.check_at_least("--budgets", budget, 1)
    for rate in arguments.rates:
        run_arguments.check_above_zero("--rates", rate)
    run_arguments.check_above_zero("--downscale", arguments.downscale)
    run_arguments.check_size("--size", arguments.size)
    run_arguments.check_size("--tuning-size", arguments.tuning_size)
    for option in ("diagrams", "rates", "budgets", "threads"):
        run_arguments.check_once(f"--{option}", getattr(arguments, option))


def views(text: str) -> str:
    if not all(number.isdecimal() for number in text.split(",")):
        raise argparse.ArgumentTypeError(f"got '{text}', expected numbers of cameras, as in 0,2")
    return text


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    to.add_argument(
        "--diagrams", nargs="+", choices=DIAGRAMS, default=list(DIAGRAMS), metavar="NAME",
        help="which of image, tuning and renderers",
    )  # fmt: skip
    to.add_argument("--view", type=views, default="0", help="as in 0,2")
    to.add_argument("--size", default="640x360", metavar="WxH", help="px of a view")
    run_arguments.add_side_by_side(to)
    to.add_argument("--steps", type=int, default=120, help="of tuning; 0: nothing is tuned")
    to.add_argument("--tuning-size", default="160x90", metavar="WxH", help="px, for tuning")
    to.add_argument(
        "--between",
        type=int,
        default=60,
        metavar="N",
        help="cameras between a scene's own to tune on",
    )
    to.add_argument(
        "--rates", nargs="+", type=float, default=[0.5, 2, 8], metavar="X", help="of tuning"
    )
    to.add_argument(
        "--datasets", nargs="*", default=["lego"], metavar="DATASET", help="to train on"
    )
    to.add_argument("--downscale", type=float, default=8, help="of their photographs")
    to.add_argument("--train-steps", type=int, default=1200, help="of training")
    to.add_argument(
        "--budgets", nargs="+", type=int, default=[1000, 4000, 16000], metavar="N",
        help="Gaussians that a training may have",
    )  # fmt: skip
    to.add_argument(
        "--renderers",
        type=pathlib.Path,
        default=PROGRAM,
        metavar="PROGRAM",
        help="that draws and times them",
    )
    to.add_argument("--threads", nargs="+", type=int, default=[1, 2], metavar="N")


def make(arguments: argparse.Namespace) -> None:
    check(arguments)
    scenes = find_scenes(arguments.scenes)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    if "tuning" in arguments.diagrams:
        dataset_folders(arguments)
    for name in arguments.diagrams:
        DIAGRAMS[name](scenes, arguments)
