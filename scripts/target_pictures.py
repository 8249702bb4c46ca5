"""The pictures that a subject of the study is held to, as files: photographs of the test views, or
the scene's own reference pictures of its cameras."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pathlib
from collections.abc import Sequence

import tables
from fittings import files_of
from run_digest import content_digest
from simulations import REFUSED, Failure, call, said
from subjects import Subject

DONE = "made.json"  # written last


@dataclasses.dataclass(frozen=True)
class TargetPictures:
    """folder: has view_N.exr, before black. cameras, size: the arguments of `simulate` that draw
    the same views."""

    folder: pathlib.Path
    cameras: str
    size: str

    def picture(self, view: int) -> pathlib.Path:
        return self.folder / f"view_{view}.exr"


def target_pictures(
    binary: pathlib.Path, program: str, folder: pathlib.Path, subject: Subject
) -> TargetPictures:
    """Made below the folder, once. Raises ValueError, Failure."""
    if not subject.dataset and not subject.cameras:
        raise ValueError(f"{subject.name}: brings its own cameras, expected a file of them")
    sources = [subject.dataset] if subject.dataset else [subject.scene, subject.cameras]
    facts = [program, subject.dataset, subject.size]
    facts += [content_digest(file) for text in sources for file in files_of(pathlib.Path(text))]
    digest = hashlib.sha256("\n".join(facts).encode()).hexdigest()[:16]
    place = folder / f"{subject.name}_{digest}"
    cameras = str(place / "cameras.json") if subject.dataset else subject.cameras
    targets = TargetPictures(place, cameras, subject.size)
    if not (place / DONE).exists():
        place.mkdir(parents=True, exist_ok=True)
        if subject.dataset:
            make(binary, "photographs", [subject.dataset, "--out", str(place)])
        else:
            draw_own(binary, subject, targets)
        tables.write_text(place / DONE, json.dumps({"of": sources}) + "\n")
    return targets


def draw_own(binary: pathlib.Path, subject: Subject, targets: TargetPictures) -> None:
    for view in range(len(json.loads(pathlib.Path(subject.cameras).read_text()))):
        words = [subject.scene, "--cameras", subject.cameras, "--view", str(view)]
        words += ["--size", subject.size, "--out", str(targets.picture(view))]
        make(binary, "render", words)


def make(binary: pathlib.Path, command: str, words: Sequence[str]) -> str:
    """What it printed."""
    done = call(binary, words, command)
    if done.returncode == REFUSED:
        raise ValueError(said(done))
    if done.returncode != 0:
        raise Failure(f"{command} {' '.join(words)}: {said(done)}")
    return done.stdout
