"""The pictures that a subject of the study is held to, as files: photographs of the test views, or
the scene's own reference pictures of its cameras."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pathlib
from collections.abc import Sequence

from runs.given_files import write_text
from runs.keeper import files_of
from runs.run_digest import content_digest
from runs.scenes import Scene
from runs.simulations import REFUSED, Failure, call, said
from subjects import Source, Subject

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
        if not source.cameras:
            raise ValueError(f"{source.name}: brings its own cameras, expected a file of them")
        return len(json.loads(pathlib.Path(source.cameras).read_text()))
    lines = make(binary, "info", [str(source)]).splitlines()
    (count,) = (line.split()[3] for line in lines if line.startswith("to test with "))
    return int(count)


def target_pictures(
    binary: pathlib.Path, program: str, folder: pathlib.Path, subject: Subject
) -> TargetPictures:
    """Made below the folder, once, of a subject that check_views() takes. Raises ValueError,
    Failure."""
    sources = [subject.dataset] if subject.dataset else [subject.scene, subject.cameras]
    facts = [program, subject.dataset, subject.size, *subject.photograph_words()]
    facts += [content_digest(file) for text in sources for file in files_of(pathlib.Path(text))]
    digest = hashlib.sha256("\n".join(facts).encode()).hexdigest()[:16]
    place = folder / f"{subject.name}_{digest}"
    cameras = str(place / "cameras.json") if subject.dataset else subject.cameras
    targets = TargetPictures(place, cameras, subject.size)
    if not (place / DONE).exists():
        place.mkdir(parents=True, exist_ok=True)
        if subject.dataset:
            words = [subject.dataset, *subject.photograph_words(), "--out", str(place)]
            make(binary, "photographs", words)
        else:
            draw_own(binary, subject, targets)
        write_text(place / DONE, json.dumps({"of": sources}) + "\n")
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
