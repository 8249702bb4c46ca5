"""What the studies of quality are made on, how it is tuned and what it is held to: trained scenes
with their cameras, held to their own reference pictures; data sets, of which the scene is trained
here, held to their photographs. Calls of `train` and `tune` stand here word for word, so that what
one study has made the others find."""

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

from tables import Column
from runs import run_arguments
from runs.files import read_json
from runs.keeper import Fitting, Keeper, KeptFittings
from runs.scenes import Scene, find_scene, shared_folder
from runs.simulations import (
    FIT_MEMORIES,
    MJ,
    Run,
    answered,
    asked_mb,
    bus_mb,
    cycles,
    joules,
    mean,
    simulate_into,
)

DEFAULT_SUBJECTS = ("lego", "desk", "truck", "platform", "yard")
DATASET_FORMS = "a data set of ../shared by name, or the folder of one"
SUBJECT_FORMS = (
    f"{DATASET_FORMS}; a real scene of ../shared by name, or a .ply file with its cameras beside it"
)
LOOKS = 20  # at the test views, while a scene is trained
PAPER, PAPER_VQ = "paper_no_vq", "paper"
EXACT, EXACT_VQ = "exact", "exact_vq"
TEST_EVERY = "500"  # steps
OWN_RATE = 0.2  # of `tune --quantise` and `--streaming`, where none is given

Source = pathlib.Path | Scene  # the folder of a data set, or a scene


@dataclasses.dataclass(frozen=True)
class Subject:
    """dataset: its folder; empty for a scene with cameras. scene: what the command takes.
    downscale: of the photographs."""

    name: str
    scene: str
    cameras: str = ""
    size: str = ""
    between: int = 0
    dataset: str = ""
    downscale: float = 1

    def photograph_words(self) -> tuple[str, ...]:
        return downscale_words(self.downscale)

    def target_words(self, given: str = "") -> tuple[str, ...]:
        """Arguments of `tune` that say what to compare with. given: what is tuned, where it is not
        the scene itself."""
        if self.dataset:
            return ("--data", self.dataset, *self.photograph_words())
        words = ("--cameras", self.cameras) if self.cameras else ()
        words += ("--size", self.size, "--between", str(self.between))
        return (*words, "--target", self.scene) if given not in ("", self.scene) else words


def datasets_there() -> list[str]:
    """Names of the data sets of ../shared, sorted."""
    return sorted(path.name for path in (shared_folder() / "data").glob("*") if path.is_dir())


def dataset_folder(text: str) -> pathlib.Path | None:
    """That a name or a path means, if any."""
    if text in datasets_there():
        return shared_folder() / "data" / text
    return pathlib.Path(text) if pathlib.Path(text).is_dir() else None


def downscale_words(downscale: float) -> tuple[str, ...]:
    return () if downscale == 1 else ("--downscale", f"{downscale:g}")


def training(
    folder: pathlib.Path, seed: int, steps: int, arguments: argparse.Namespace, seconds: float = 0
) -> Fitting:
    """seconds: it is stopped then; 0: never."""
    words = (str(folder), "--seed", str(seed), "--steps", str(steps))
    words += ("--gaussians", str(arguments.gaussians), *downscale_words(arguments.downscale))
    words += ("--test-every", str(max(1, steps // LOOKS)))
    return Fitting(f"{folder.name} seed {seed}", "train", words, most_seconds=seconds)


@dataclasses.dataclass(frozen=True)
class Tunings:
    """precision: that paper order is drawn in while it is tuned for. paper_set: KEY=VALUE over the
    presets of paper order."""

    steps: int
    quantised_steps: int
    misordered_in: str
    penalty_mean: str
    rate: float
    precision: str
    paper_set: tuple[str, ...]

    def voxel_words(self, voxel: float) -> tuple[str, ...]:
        """For --set of paper order."""
        return (f"storage.voxel_size={voxel:g}", *self.paper_set)

    def tuned_in(self) -> tuple[str, ...]:
        """Of a tuning for paper order: a precision, and the memory that it needs."""
        return tuned_in(self.precision)

    def boundary(self, subject: Subject, voxel: float, beta: float) -> Fitting:
        words = (subject.scene, "--boundary", "--config", PAPER)
        words += (*self.tuned_in(), *set_words(self.voxel_words(voxel)), *subject.target_words())
        words += ("--steps", str(self.steps), "--beta", f"{beta:g}", "--rate", f"{self.rate:g}")
        words += ("--misordered-in", self.misordered_in, "--penalty-mean", self.penalty_mean)
        label = f"{subject.name} boundary voxels {voxel:g} beta {beta:g}"
        return Fitting(label, "tune", (*words, "--test-every", TEST_EVERY))

    def quantised(
        self, subject: Subject, given: str, config: str, settings: tuple[str, ...]
    ) -> Fitting:
        """given: the scene to begin with. settings: words for the command."""
        words = (given, "--quantise", "--config", config, *settings)
        words += (*subject.target_words(given), "--steps", str(self.quantised_steps))
        label = f"{subject.name} quantise {config}"
        return Fitting(label, "tune", (*words, "--test-every", TEST_EVERY), ".sgs")

    def streaming(self, subject: Subject, price: float) -> Fitting:
        return in_reference_order(subject, price, self.steps, OWN_RATE)

    def as_long_as_boundary(self, subject: Subject) -> Fitting:
        """What its steps alone do, seen in the reference order."""
        return in_reference_order(subject, 0, self.steps, self.rate)

    def as_long_as_quantised(self, subject: Subject) -> Fitting:
        return in_reference_order(subject, 0, self.quantised_steps, OWN_RATE)


def in_reference_order(subject: Subject, price: float, steps: int, rate: float) -> Fitting:
    """Without codebooks; with a price of 0 it is for no machine at all."""
    words = (subject.scene, "--streaming", "--config", EXACT, *subject.target_words())
    words += ("--steps", str(steps), "--price", f"{price:g}", "--test-every", TEST_EVERY)
    label = f"{subject.name} streaming price {price:g}"
    if rate != OWN_RATE:
        words += ("--rate", f"{rate:g}")
        label += f" rate {rate:g}"
    return Fitting(label, "tune", words)


def tuned_in(precision: str) -> tuple[str, ...]:
    return (FIT_MEMORIES, *set_words((f"rendering.precision={precision}",)))


def set_words(settings: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word for setting in settings for word in ("--set", setting))


def voxel_of_preset(binary: pathlib.Path, scene: str) -> float:
    """World units that the preset of paper order takes for the scene as given. Tuned, a scene would
    get others by the preset's rule."""
    lines = answered(binary, "info", [scene], f"info {scene}").splitlines()
    (voxel,) = (line.split()[2] for line in lines if line.startswith("voxel size "))
    return float(voxel)


def add_training_arguments(to: argparse.ArgumentParser) -> None:
    to.add_argument("--train-steps", type=int, default=20_000, metavar="N", help="of data sets")
    to.add_argument(
        "--gaussians", type=int, default=100_000, metavar="N", help="that data sets may have"
    )
    to.add_argument(
        "--downscale",
        type=float,
        default=1,
        metavar="N",
        help="photographs so many times smaller, as of train",
    )


def add_arguments(to: run_arguments.Parser, forms: str = SUBJECT_FORMS) -> None:
    """Of a study that tunes. forms: what its subjects may be."""
    run_arguments.add_scenes(to, " ".join(DEFAULT_SUBJECTS), forms=forms)
    run_arguments.add_fittings_side_by_side(to)
    to.add_argument("--size", default="640x360", metavar="WxH", help="in px, of scenes")
    to.add_argument(
        "--between",
        type=int,
        default=60,
        metavar="N",
        help="cameras between those of a scene, to tune on; 0: test with every eighth of them",
    )
    add_training_arguments(to)
    to.add_argument("--seed", type=int, default=1, help="of the training of data sets")
    to.add_argument("--steps", type=int, default=3_000, help="of tuning for an order")
    to.add_argument(
        "--misordered-in", choices=("group", "pixel"), default="group", help="as of tune"
    )
    to.add_argument(
        "--penalty-mean", choices=("rendered", "scene"), default="rendered", help="as of tune"
    )
    to.add_argument("--rate", type=float, default=1, help="of boundary-aware tuning")
    to.add_argument(
        "--precision",
        choices=("fp32", "fp16"),
        default="fp32",
        help="that paper order is drawn in while it is tuned for; fp16, as its presets have it, "
        "takes half as long again to draw",
    )
    to.add_argument(
        "--paper-set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="over the presets of paper order, where a scene is tuned and where it is drawn",
    )


def add_beta(to: run_arguments.Parser) -> None:
    to.add_argument("--beta", type=float, default=0.05, help="of L_CBP; the paper's")


def add_voxels(to: run_arguments.Parser, default: list[float]) -> None:
    to.add_argument(
        "--voxels",
        nargs="+",
        type=float,
        default=default,
        metavar="FACTOR",
        help="sizes, times the preset's",
    )


def tunings_of(arguments: argparse.Namespace, quantised_steps: int) -> Tunings:
    return Tunings(
        arguments.steps,
        quantised_steps,
        arguments.misordered_in,
        arguments.penalty_mean,
        arguments.rate,
        arguments.precision,
        tuple(arguments.paper_set),
    )


def kept_fittings(arguments: argparse.Namespace, side_by_side: int) -> KeptFittings:
    return KeptFittings(arguments.streaminggs, arguments.kept / "fittings", side_by_side)


def begin(
    arguments: argparse.Namespace, configs: Sequence[str], quantised_steps: int = 5_000
) -> tuple[Tunings, KeptFittings, list[Source]]:
    """Of a study that tunes, before anything is trained. configs: presets of paper order that it
    draws with. Raises ValueError."""
    calls = tunings_of(arguments, quantised_steps)
    kept = kept_fittings(arguments, arguments.side_by_side)
    sources = find_sources(arguments.scenes or DEFAULT_SUBJECTS)
    check_settings(arguments.streaminggs, calls, configs)
    return calls, kept, sources


def find_sources(texts: Sequence[str]) -> list[Source]:
    """By name of a data set or of a scene, or by path. Raises ValueError."""
    return [dataset_folder(text) or find_scene(text) for text in texts]


def check_settings(binary: pathlib.Path, calls: Tunings, configs: Sequence[str]) -> None:
    """Whether these presets of paper order take --paper-set, before anything is trained. Raises
    ValueError."""
    for config in configs:
        words = ["builtin:object?n=1", "--config", config, *set_words(calls.paper_set)]
        answered(binary, "simulate", [*words, "--print-config"], f"simulate {' '.join(words)}")


def find_subjects(
    sources: Sequence[Source], arguments: argparse.Namespace, kept: KeptFittings
) -> list[Subject]:
    """Data sets are trained now. Raises Failure, ValueError."""
    trainings = [
        training(source, arguments.seed, arguments.train_steps, arguments)
        for source in sources
        if not isinstance(source, Scene)
    ]
    trained = iter(kept.all(trainings))
    subjects = []
    for source in sources:
        if isinstance(source, Scene):
            own = (source.spec, source.cameras, arguments.size, arguments.between)
            subjects.append(Subject(source.name, *own))
        else:
            scene = str(next(trained).scene)
            of = {"dataset": str(source), "downscale": arguments.downscale}
            subjects.append(Subject(source.name, scene, **of))
    return subjects


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


def camera_count(path: pathlib.Path) -> int:
    """Of any form of JSON that the program reads. Raises ValueError."""
    found = read_json(path)
    if isinstance(found, dict):
        lists = [found[key] for key in ("cameras", "frames", "camera_path") if key in found]
        found = lists[0] if lists else None
    if not isinstance(found, list):
        raise ValueError(f"{path}: got no list, expected cameras of a form that render takes")
    return len(found)


def test_views(binary: pathlib.Path, source: Source) -> int:
    if isinstance(source, Scene):
        if not source.cameras:
            raise ValueError(f"{source.name}: brings its own cameras, expected a file of them")
        return camera_count(pathlib.Path(source.cameras))
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
        for view in range(camera_count(pathlib.Path(subject.cameras))):
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


def quality(views: Sequence[dict], of: str = "") -> tuple[float, float]:
    """PSNR and SSIM. of: `reference_` for the reference picture of the scene."""
    ssim = mean(views, lambda view: view["target"][f"{of}ssim"])
    return mean_psnr(views, f"{of}psnr_db"), ssim


def frame_cells(views: Sequence[dict]) -> tuple[float, ...]:
    """Of FRAME_COLUMNS."""
    blends = sum(view["image"]["blends"] for view in views)
    return (
        *quality(views),
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
