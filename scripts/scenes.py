"""Scenes by name: built-in ones, .ply files, and the real scenes of ../shared."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import subprocess

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
UNPACKED = REPOSITORY / "build" / "scenes"
BUILT_IN = ("builtin:object", "builtin:outdoor")


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    spec: str  # what the command takes as SCENE
    cameras: str = ""  # file; empty: the scene brings its own


def shared_folder() -> pathlib.Path:
    """Where real scenes may lie: $SGS_SHARED, else ../shared."""
    return pathlib.Path(os.environ.get("SGS_SHARED", REPOSITORY.parent / "shared"))


def shared_names() -> list[str]:
    """Real scenes that are there, sorted; none when the folder is missing."""
    packed = sorted((shared_folder() / "scenes").glob("*.ply.xz"))
    return [path.name.removesuffix(".ply.xz") for path in packed]


def find_scene(text: str) -> Scene:
    """The scene of a command-line argument: `builtin:...`, the name of a real scene (unpacked to
    build/scenes), or a .ply file with its cameras beside it (NAME.json). Raises ValueError."""
    if text.startswith("builtin:"):
        return Scene(text, text)
    if text in shared_names():
        unpack = [str(shared_folder() / "scenes" / "expand.sh"), str(UNPACKED), text]
        done = subprocess.run(["sh", *unpack], stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise ValueError(f"{text}: cannot be unpacked: {' '.join(done.stderr.split())}")
        cameras = shared_folder() / "cameras" / f"{text}.json"
        return Scene(text, str(UNPACKED / f"{text}.ply"), str(cameras))
    path = pathlib.Path(text)
    cameras = path.with_suffix(".json")
    if path.suffix == ".ply" and path.exists():
        if not cameras.exists():
            raise ValueError(f"{text}: expected its cameras in {cameras}")
        return Scene(path.stem, text, str(cameras))
    known = ", ".join([*BUILT_IN, *shared_names()])
    raise ValueError(f"{text}: no scene; expected a .ply file or one of {known}")


def find_scenes(texts: list[str]) -> list[Scene]:
    """The scenes of the arguments; without any, the built-in ones and all real ones there are."""
    return [find_scene(text) for text in texts or [*BUILT_IN, *shared_names()]]
