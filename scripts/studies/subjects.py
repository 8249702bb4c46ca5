"""What the studies of quality are made on, how it is tuned and what it is held to: trained scenes
with their cameras, held to their own reference pictures; data sets, of which the scene is trained
here, held to their photographs. Calls of `train` and `tune` stand here word for word, so that what
one study has made the others find."""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
from collections.abc import Sequence
from typing import IO

from runs import run_arguments
from runs.keeper import Fitting, Keeper, KeptFittings
from runs.scenes import Scene, answered, find_scenes, shared_folder
from runs.simulations import FIT_MEMORIES

DEFAULT_SUBJECTS = ("lego", "desk", "truck", "platform", "yard")
DATASET_FORMS = "a data set of ../shared by name, or the folder of one"
SUBJECT_FORMS = f"{DATASET_FORMS}; {run_arguments.SCENE_FORMS}"
SCENE_IN_FOLDER = ("meta.json", "lod-meta.json")  # of SOG
LOOKS = 20  # at the test views, while a scene is trained
PAPER, PAPER_VQ = "paper_text_no_vq", "paper_text"
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
    """That a name or a path means, if any; of a scene there are folders as well."""
    if text in datasets_there():
        return shared_folder() / "data" / text
    path = pathlib.Path(text)
    is_scene = any((path / name).exists() for name in SCENE_IN_FOLDER)
    return path if path.is_dir() and not is_scene else None


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


def voxel_of(arguments: argparse.Namespace, scene: str) -> float:
    return arguments.voxel or voxel_of_preset(arguments.streaminggs, scene)


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


def add_seed(to: argparse.ArgumentParser) -> None:
    to.add_argument("--seed", type=int, default=1, help="of the training of data sets")


def add_arguments(to: run_arguments.Parser) -> None:
    """Of a study that tunes."""
    run_arguments.add_scenes(to, " ".join(DEFAULT_SUBJECTS), forms=SUBJECT_FORMS)
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
    add_seed(to)
    to.add_argument(
        "--voxel",
        type=float,
        default=0,
        metavar="SIDE",
        help="of paper order, world units; 0: as its preset has it for the scene as given",
    )
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
    sources = find_sources(arguments.scenes or DEFAULT_SUBJECTS, arguments.cameras)
    check_settings(arguments.streaminggs, calls, configs)
    return calls, kept, sources


def find_sources(texts: Sequence[str], cameras: Sequence[str] = ()) -> list[Source]:
    """By name of a data set or of a scene, or by path. cameras: of the scenes that are paths. Raises
    ValueError."""
    scenes = [text for text in texts if not dataset_folder(text)]
    found = iter(find_scenes(scenes, cameras) if scenes or cameras else ())
    return [dataset_folder(text) or next(found) for text in texts]


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
            spec, cameras = in_files(source, arguments)
            subjects.append(
                Subject(source.name, spec, cameras, arguments.size, arguments.between)
            )
        else:
            scene = str(next(trained).scene)
            of = {"dataset": str(source), "downscale": arguments.downscale}
            subjects.append(Subject(source.name, scene, **of))
    return subjects


def in_files(scene: Scene, arguments: argparse.Namespace) -> tuple[str, str]:
    """What the command takes for the scene and its cameras. A built-in one is written, since what
    is tuned of it brings no cameras. Raises Failure."""
    if scene.cameras:
        return scene.spec, scene.cameras
    binary = arguments.streaminggs

    def make(place: pathlib.Path, _: IO) -> None:
        words = [scene.spec, str(place / "scene.ply"), "--cameras-out", str(place / "cameras.json")]
        answered(binary, "convert", words, f"convert {scene.spec}")

    place, _ = Keeper(binary, arguments.kept / "scenes").kept(scene.name, [scene.spec], make)
    return str(place / "scene.ply"), str(place / "cameras.json")
