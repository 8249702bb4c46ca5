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
import pathlib
import sys
from collections.abc import Iterator, Sequence

import tables
from runs import run_arguments
from runs.keeper import Keeper, swept
from runs.scenes import (
    BINARY,
    Failure,
    Scene,
    answered,
    find_scenes,
    program_provenance,
    view_numbers_there,
)
from runs.simulations import (
    MJ,
    Outcome,
    Run,
    asked_mb,
    cycles,
    decibels,
    group_assignments,
    joules,
    mm2,
)
from studies import subjects
from studies.fitting import dataset_folders, make_error_tuning, short_tuning
from studies.quality import JudgedFrames, target_pictures
from studies.subjects import Subject
from tables import SCENE, VIEW, Column, Study

EXACT, PAPER, TILES = "exact", "paper", "tiles"
PRESETS = {EXACT: "exact", PAPER: "paper_no_vq", TILES: "gscore_fp32_keys"}
FLOATS = "framebuffer=rgb32f"  # so that errors below those of 8 bits are seen
VQ = ("storage.encoding=vq", "sram.codebook_bytes=256000")
GROUPS = {
    EXACT: ("32", "48", "64", "96", "160x120"),
    PAPER: ("32", "48", "96", "128", "160x120"),
}
VOXELS = (0.25, 0.5, 2, 4)  # times the preset's side
AS_PRESET = "as the preset"


@dataclasses.dataclass(frozen=True)
class Point:
    """knob: what is moved, value: where to. settings: over preset and base; memories are fitted."""

    order: str
    knob: str
    value: str
    settings: tuple[str, ...]
    preset: str = ""

    def config(self) -> str:
        return self.preset or PRESETS[self.order]

    def overrides(self) -> tuple[str, ...]:
        return (FLOATS, *self.settings)


def blended(precision: str) -> str:
    return f"rendering.precision={precision}"


def moved(order: str, knob: str, key: str, *values: object) -> Iterator[Point]:
    for value in values:
        yield Point(order, knob, str(value), (f"{key}={value}",))


def grouped(order: str) -> Iterator[Point]:
    for shape in GROUPS[order]:
        yield Point(order, "group px", shape, group_assignments(shape))


def merged() -> Iterator[Point]:
    for policy, name, entries in (
        ("spill", "", (128, 2048)),
        ("blend_early", ", early", (128, 256, 512, 1024)),
    ):
        for n in entries:
            settings = (f"merge.entries={n}", f"merge.on_overflow={policy}")
            yield Point(EXACT, "merge", f"{n}{name}", settings)


def chunked() -> Iterator[Point]:
    """FIFOs of the coarse filters hold two chunks, as in the preset: with less room a larger chunk
    would be measured by its wait."""
    for n in (4, 16, 32, 64):
        settings = (f"storage.chunk_gaussians={n}", f"hfu.candidate_fifo_entries={2 * n}")
        yield Point(EXACT, "chunk", str(n), settings)


def exact_points() -> Iterator[Point]:
    yield Point(EXACT, AS_PRESET, PRESETS[EXACT], ())
    yield from grouped(EXACT)
    yield from chunked()
    yield from merged()
    yield Point(EXACT, "encoding", "half", ("storage.encoding=half",))
    yield Point(EXACT, "encoding", "vq", VQ)
    yield from (Point(EXACT, "precision", p, (blended(p),)) for p in ("fp16", "fixed16"))
    yield Point(EXACT, "finishing", "off", ("rendering.saturation_feedback=false",))
    yield Point(EXACT, "pixels", "rgb8", ("framebuffer=rgb8",))
    half = (blended("fp16"), "storage.encoding=half")
    yield Point(EXACT, "combined", "fp16, half", half)
    yield Point(EXACT, "combined", "fp16, half, rgb8", (*half, "framebuffer=rgb8"))
    yield Point(EXACT, "combined", "fixed16, half", (blended("fixed16"), "storage.encoding=half"))
    early = ("merge.entries=512", "merge.on_overflow=blend_early")
    yield Point(EXACT, "combined", "fp16, half, early", (*half, *early))
    yield Point(EXACT, "combined", "fp16, vq", (blended("fp16"), *VQ))
    yield Point(EXACT, "combined", "exact_fp16", (), "exact_fp16")
    yield Point(EXACT, "combined", "exact_wide", (), "exact_wide")


def paper_points(voxel: float) -> Iterator[Point]:
    """voxel: side that the preset takes for the scene, world units."""
    yield Point(PAPER, AS_PRESET, PRESETS[PAPER], ())
    yield from grouped(PAPER)
    for factor in VOXELS:
        side = f"storage.voxel_size={factor * voxel:g}"
        yield Point(PAPER, "voxel", f"x {factor:g}", (side,))
    yield from moved(PAPER, "rays", "vsu.ray_step_px", 1, 4)
    whole = ("vsu.visit_gaussians=0", "sorting.buffer_entries=1024")
    yield Point(PAPER, "voxels cut", "never", whole)
    yield Point(PAPER, "encoding", "half", ("storage.encoding=half",))
    yield Point(PAPER, "encoding", "vq", VQ)
    yield Point(PAPER, "precision", "fp32", (blended("fp32"), "rendering.cluster_lanes=167"))
    yield Point(PAPER, "finishing", "off", ("rendering.saturation_feedback=false",))
    yield Point(PAPER, "pixels", "rgb8", ("framebuffer=rgb8",))
    fast = (*group_assignments("160x120"), "hfus=6", "vsu.ray_step_px=4")
    yield Point(PAPER, "combined", "160x120, 6 HFUs, rays 4", fast)
    larger = (*fast, f"storage.voxel_size={2 * voxel:g}")
    yield Point(PAPER, "combined", "the same, voxels x 2", larger)


def tile_points() -> Iterator[Point]:
    yield Point(TILES, AS_PRESET, PRESETS[TILES], ())
    yield Point(TILES, "precision", "fixed16", (blended("fixed16"),))
    yield Point(TILES, "precision", "fp32", (), "gscore_lossless")
    yield Point(TILES, "combined", "gscore", (), "gscore")
    yield Point(TILES, "pixels", "rgb8", ("framebuffer=rgb8",))


def points(voxel: float) -> list[Point]:
    return [*exact_points(), *paper_points(voxel), *tile_points()]


PROGRAM = BINARY.with_name("bench_renderers")
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
    (fitted,) = subjects.kept_fittings(arguments, 1).all([short_tuning(scene, 1, arguments)])
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


def timed(program: pathlib.Path, scene: Scene, words: Sequence[str]) -> list[list[str]]:
    """Lines of RENDERER_COLUMNS. Raises ValueError for what the program refuses, Failure."""
    out = answered(program, scene.spec, words, program.name)
    head, *rows = list(csv.reader(out.splitlines())) or [[]]
    expected = [column.name for column in RENDERER_COLUMNS]
    if head != expected:
        raise Failure(f"{program}: columns {', '.join(head)}; expected {', '.join(expected)}")
    # The program names scenes of one kind alike, whatever their parameters.
    return [[scene.name, *cells] for _, *cells in rows]


def make_renderers(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One at a time, since their times count."""
    program = arguments.renderers
    keeper = Keeper(program, arguments.kept / "renderers")
    rows = []
    for threads in arguments.threads:
        for scene in scenes:
            words = ["--threads", str(threads), "--size", arguments.size, "--view", arguments.view]
            words += ["--cameras", scene.cameras] if scene.cameras else []
            facts = [*words, scene.name, scene.spec]
            _, found = keeper.kept(scene.name, facts, lambda *_: timed(program, scene, words))
            rows += found
    by = tables.made(program, [program_provenance(arguments.streaminggs)], scenes)
    tables.write(arguments.out, "error_renderers", by, RENDERER_COLUMNS, rows)
    tables.draw_beside(arguments.out, "error_renderers")


DIAGRAMS = {"image": make_image, "tuning": make_error_tuning, "renderers": make_renderers}


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
    scenes = find_scenes(arguments.scenes, arguments.cameras)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    if "tuning" in arguments.diagrams:
        dataset_folders(arguments)
    for name in arguments.diagrams:
        DIAGRAMS[name](scenes, arguments)


ERROR_AGAINST_TIME = Study(
    "error_against_time",
    __doc__,
    (
        "results.py error_against_time truck yard platform park --diagrams image",
        "results.py error_against_time truck yard platform park --diagrams tuning "
        "--train-steps 3000",
        "results.py error_against_time truck yard platform park --diagrams renderers",
    ),
    add_arguments,
    make,
)
