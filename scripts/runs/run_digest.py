"""What a simulation depends on: the program with the data that it reads, and the contents of the
files that its arguments name."""

from __future__ import annotations

import functools
import hashlib
import json
import pathlib
from collections.abc import Iterator

from runs.simulations import Run

# Where the program finds presets, memspecs and technology, from its own folder, links resolved
# (algorithm/data_files.h).
DATA_FROM_BIN = pathlib.Path("..", "share", "streaminggs")


def data_folder(binary: pathlib.Path) -> pathlib.Path:
    return binary.resolve().parent / DATA_FROM_BIN


def program_digest(binary: pathlib.Path) -> str:
    """Of the program and its data files. Raises ValueError when there is no program."""
    if not binary.is_file():
        raise ValueError(f"{binary}: not there; scripts/setup.sh builds it")
    data = data_folder(binary)
    digest = hashlib.sha256(binary.read_bytes())
    # Folders of a build tree are links to the sources, which a recursive glob does not follow; what
    # is written there for readers the program does not read.
    files = (p for pattern in ("*", "*/*") for p in data.glob(pattern) if p.is_file())
    for path in sorted(p for p in files if p.suffix != ".md"):
        digest.update(f"{path.relative_to(data)} {path.stat().st_size} ".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def run_name(run: Run) -> str:
    """The arguments of a run, and a digest of each file that they name."""
    digests = [content_digest(path) for path in named_files(run)]
    return " ".join([*run.arguments(), *digests])


def named_files(run: Run) -> Iterator[pathlib.Path]:
    """Scene, cameras, configuration with its memspec, and what keys are set to, as far as these
    are files."""
    values = [override.partition("=")[2] for override in run.overrides]
    values.append(memspec_of(pathlib.Path(run.config)))
    for text in (run.scene.spec, run.scene.cameras, run.config, *values):
        path = pathlib.Path(text)
        if text and path.is_file():
            yield path


def memspec_of(config: pathlib.Path) -> str:
    """The memspec that a configuration file asks for; empty for what the program will refuse."""
    try:
        return str(json.loads(config.read_text())["dram"]["memspec"])
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def content_digest(path: pathlib.Path) -> str:
    """Read once for as long as size and time of change stay."""
    facts = path.stat()
    return file_digest(path.absolute(), facts.st_size, facts.st_mtime_ns)


@functools.lru_cache(maxsize=None)
def file_digest(path: pathlib.Path, size: int, changed_ns: int) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()[:16]
