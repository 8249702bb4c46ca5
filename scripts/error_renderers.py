"""Pictures of the renderers in software against the wall time that they take, by threads; and of
thresholds of light at which a pixel counts as finished. The program bench_renderers draws and times
them."""

from __future__ import annotations

import argparse
import contextlib
import csv
import dataclasses
import json
import os
import pathlib
import subprocess
import tempfile
from collections.abc import Sequence

from runs import run_arguments, simulations
from results import tables
from runs.run_digest import content_digest
from runs.scenes import Scene
from runs.simulations import REFUSED, Failure, program_version

PROGRAM = simulations.BINARY.with_name("bench_renderers")
HEAD = (
    "scene", "view", "renderer", "finished below", "threads", "ms", "cpu ms", "beside", "PSNR dB",
    "largest", "blends",
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Timing:
    """What is asked of the program at a time. size: WxH in px."""

    scene: Scene
    view: str
    size: str
    threads: int

    def words(self) -> list[str]:
        return ["--threads", str(self.threads), "--size", self.size, "--view", self.view]


def laid_out(scene: Scene, folder: pathlib.Path) -> str:
    """As benchmarks find it: the cameras beside the scene, under its name."""
    if not scene.cameras:
        return scene.spec
    place = folder / f"{scene.name}.ply"
    os.symlink(os.path.abspath(scene.spec), place)
    os.symlink(os.path.abspath(scene.cameras), place.with_suffix(".json"))
    return str(place)


def timed(program: pathlib.Path, timing: Timing) -> list[list[str]]:
    """Lines of HEAD. Raises ValueError for what the program refuses, Failure."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        spec = laid_out(timing.scene, pathlib.Path(folder))
        rows = answered(program, [*timing.words(), spec])
    # The program names scenes of one kind alike, whatever their parameters.
    return [[timing.scene.name, *cells] for _, *cells in rows]


def answered(program: pathlib.Path, arguments: Sequence[str]) -> list[list[str]]:
    words = [str(program.absolute()), *arguments]
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


class KeptTimes:
    """Lines of what was asked, from the file where it has them of this program."""

    def __init__(self, program: pathlib.Path, path: pathlib.Path):
        """Raises ValueError when there is no such program."""
        if not program.is_file():
            raise ValueError(f"{program}: not there; scripts/setup.sh builds it")
        self.program, self.path = program, path
        self.known: dict[str, list[list[str]]] = {}
        for line in path.read_text().splitlines() if path.exists() else []:
            with contextlib.suppress(json.JSONDecodeError):  # the last line of one that was killed
                entry = json.loads(line)
                self.known[entry["of"]] = entry["rows"]

    def rows(self, timing: Timing) -> list[list[str]]:
        """Raises ValueError, Failure."""
        scene = timing.scene
        paths = [self.program, *map(pathlib.Path, (scene.spec, scene.cameras))]
        digests = [content_digest(path) for path in paths if path.is_file()]
        of = " ".join([scene.name, scene.spec, *timing.words(), *digests])
        if of not in self.known:
            self.known[of] = timed(self.program, timing)
            with self.path.open("a") as file:
                file.write(json.dumps({"of": of, "rows": self.known[of]}) + "\n")
        return self.known[of]


def make(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """One at a time, since their times count. Raises Failure, ValueError."""
    kept = KeptTimes(arguments.renderers, arguments.out / "error_renderers_runs.jsonl")
    rows = [
        row
        for threads in arguments.threads
        for scene in scenes
        for view in arguments.views
        for row in kept.rows(Timing(scene, view, arguments.size, threads))
    ]
    made = run_arguments.how_made_at([program_version(arguments.streaminggs)])
    tables.write(arguments.out, "error_renderers", made, HEAD, rows)
