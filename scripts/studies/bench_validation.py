"""Pictures out of codebooks and out of each arithmetic of blending, by benchmarks of scenes."""

from __future__ import annotations

import argparse
import pathlib
import tempfile

import tables
from runs.beside import beside, markdown_table, printed
from runs.scenes import Scene, find_scenes, program_provenance, shared_names
from tables import SCENE, VIEW, Column, Made, Spread

SCENES = ("truck", "playbot", "platform", "yard")


def benched(arguments: argparse.Namespace, name: str) -> tuple[str, Made]:
    """What a benchmark prints of the scenes. It tells no commit: it is of the command's build."""
    program = beside(arguments.streaminggs, name)
    here = [name for name in SCENES if name in shared_names()]
    scenes = find_scenes(arguments.scenes or here, arguments.cameras)
    with tempfile.TemporaryDirectory() as folder:
        text = printed(program, [with_cameras(scene, pathlib.Path(folder)) for scene in scenes])
    return text, tables.made(program, [program_provenance(arguments.streaminggs)], scenes)


def with_cameras(scene: Scene, folder: pathlib.Path) -> str:
    """The scene as benchmarks take it: its cameras beside it by the same name."""
    if not scene.cameras:
        return scene.spec
    spec = pathlib.Path(scene.spec).absolute()
    place = folder / f"{scene.name}{spec.suffix}"
    place.symlink_to(spec)
    place.with_suffix(".json").symlink_to(pathlib.Path(scene.cameras).absolute())
    return str(place)


QUANTISATION_COLUMNS = (
    SCENE,
    Column("SH degree", "of the scene"),
    Column("codebooks", "how they were made"),
    VIEW,
    Column("PSNR dB", "of the decoded scene's picture against the given scene's", "dB", ".1f"),
)


def quantisation_rows(text: str) -> list[tuple]:
    """Of each scene the picture of each view with each kind of codebooks. Raises ValueError."""
    rows = []
    head, lines = markdown_table(text, 10)
    kinds = [cell.removesuffix(", dB") for cell in head[2::2]]  # beside each its seconds
    for scene, degree, *found in lines:
        for kind, decibels in zip(kinds, found[::2]):
            for view, of_view in enumerate(decibels.split()):
                rows.append((scene, int(degree), kind, view, float(of_view)))
    return rows


def make_codebooks(arguments: argparse.Namespace) -> None:
    text, by = benched(arguments, "bench_quantisation")
    rows = quantisation_rows(text)
    spread = Spread("view", "{PSNR dB}")
    said = "Headings are views; cells are PSNR in dB."
    tables.write(
        arguments.out, "quantisation", by, QUANTISATION_COLUMNS, rows, said, spread=spread
    )


SUBTILES = ("all of the footprint", "reached by the ellipse")
PRECISION_COLUMNS = (
    SCENE,
    VIEW,
    Column("arithmetic", "of blending; without a word on it: float"),
    Column("sub-tiles", "that are blended: all of a footprint, or those that its ellipse reaches"),
    Column("PSNR dB", "of the view beside the same in double", "dB", ".1f"),
)


def precision_rows(text: str) -> list[tuple]:
    """Raises ValueError."""
    rows = []
    head, lines = markdown_table(text, 7)
    for view, *found in lines:
        scene, _, number = view.rpartition(" ")
        for arithmetic, both in zip(head[1:], found):
            for subtiles, decibels in zip(SUBTILES, both.split(", "), strict=True):
                rows.append((scene, int(number), arithmetic, subtiles, float(decibels)))
    return rows


def make_precision(arguments: argparse.Namespace) -> None:
    text, by = benched(arguments, "bench_precision")
    said = (
        "PSNR in dB beside the same views in double, 640 x 360 px, mean of all views, sub-tiles "
        "that the ellipse reaches."
    )
    spread = Spread("arithmetic", "{PSNR dB}", ("view", "sub-tiles"))
    tables.write(
        *(arguments.out, "blending_precision", by, PRECISION_COLUMNS, precision_rows(text), said),
        spread=spread,
        only={"sub-tiles": SUBTILES[1]},
    )
