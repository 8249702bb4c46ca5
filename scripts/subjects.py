"""What the study of quality is made on: trained scenes with their cameras, and data sets, of which
the scene is trained here. The first are held to their own reference pictures, the others to their
photographs."""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
from collections.abc import Sequence

from runs.fittings import Fitting, KeptFittings
from runs.scenes import Scene, find_scene, shared_folder

DEFAULT_SUBJECTS = ("lego", "desk", "truck", "platform", "yard")
DATASET_FORMS = "a data set of ../shared by name, or the folder of one"
SUBJECT_FORMS = (
    f"{DATASET_FORMS}; a real scene of ../shared by name, or a .ply file with its cameras beside it"
)
LOOKS = 20  # at the test views, while a scene is trained

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


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of what the subjects are and how their scenes come about."""
    parser.add_argument("--size", default="640x360", metavar="WxH", help="in px, of scenes")
    parser.add_argument(
        "--between",
        type=int,
        default=60,
        metavar="N",
        help="cameras between those of a scene, to tune on; 0: test with every eighth of them",
    )
    add_training_arguments(parser)
    parser.add_argument("--seed", type=int, default=1, help="of the training of data sets")


def add_training_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--train-steps", type=int, default=20_000, metavar="N", help="of data sets")
    parser.add_argument(
        "--gaussians", type=int, default=100_000, metavar="N", help="that data sets may have"
    )
    parser.add_argument(
        "--downscale",
        type=float,
        default=1,
        metavar="N",
        help="photographs so many times smaller, as of train",
    )


def find_sources(texts: Sequence[str]) -> list[Source]:
    """By name of a data set or of a scene, or by path. Raises ValueError."""
    return [dataset_folder(text) or find_scene(text) for text in texts]


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
