"""Pictures of the renderers in software against the wall time that they take, by threads; and of
thresholds of light at which a pixel counts as finished. The program bench_renderers draws and times
them."""

from __future__ import annotations

import argparse
import csv
import os
import pathlib
import subprocess
import tempfile

import run_arguments
import simulations
import tables
from scenes import Scene
from simulations import REFUSED, Failure, program_version

PROGRAM = simulations.BINARY.with_name("bench_renderers")
HEAD = (
    "scene", "renderer", "finished below", "threads", "ms", "cpu ms", "beside", "PSNR dB",
    "largest", "blends",
)  # fmt: skip


def laid_out(scene: Scene, folder: pathlib.Path) -> str:
    """As benchmarks find it: the cameras beside the scene, under its name."""
    if not scene.cameras:
        return scene.spec
    place = folder / f"{scene.name}.ply"
    os.symlink(os.path.abspath(scene.spec), place)
    os.symlink(os.path.abspath(scene.cameras), place.with_suffix(".json"))
    return str(place)


def timed(program: pathlib.Path, threads: int, specs: list[str]) -> list[list[str]]:
    """Lines of HEAD. Raises ValueError for what the program refuses, Failure."""
    words = [str(program.absolute()), "--threads", str(threads), *specs]
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except OSError as error:
        raise ValueError(f"{program}: cannot be run: {error.strerror}") from error
    if done.returncode == REFUSED:
        raise ValueError(" ".join(done.stderr.split()))
    if done.returncode != 0:
        raise Failure(f"{program.name}: {simulations.said(done)}")
    head, *rows = list(csv.reader(done.stdout.splitlines())) or [[]]
    if tuple(head) != HEAD:
        raise Failure(f"{program}: columns {', '.join(head)}; expected {', '.join(HEAD)}")
    return rows


def make(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """Raises Failure, ValueError."""
    if not arguments.renderers.is_file():
        raise ValueError(f"{arguments.renderers}: not there; scripts/setup.sh builds it")
    rows: list[list[str]] = []
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        specs = [laid_out(scene, pathlib.Path(folder)) for scene in scenes]
        for threads in arguments.threads:
            rows += timed(arguments.renderers, threads, specs)
    made = run_arguments.how_made_at([program_version(arguments.streaminggs)])
    tables.write(arguments.out, "error_renderers", made, HEAD, rows)
