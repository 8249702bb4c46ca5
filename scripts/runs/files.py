"""Files that a user names, or that lie in a folder so named: lists, reports, tables, pictures;
files that are written whole or not at all; digests of files, and of the program with the data it
reads."""

from __future__ import annotations

import csv
import functools
import hashlib
import json
import os
import pathlib

MOST_LEVELS = 100  # of JSON: what walks through it later is not to run out of stack


def read_bytes(path: pathlib.Path) -> bytes:
    """Raises ValueError for a device, pipe or folder, which may have no end; OSError."""
    if path.exists() and not path.is_file():
        raise ValueError(f"{path}: not a regular file, expected one")
    return path.read_bytes()


def read_text(path: pathlib.Path) -> str:
    """The same of a text; bytes that are none are replaced."""
    return read_bytes(path).decode("utf-8", errors="replace")


def read_csv(path: pathlib.Path, killed_writer: bool = False) -> tuple[list[str], list[list[str]]]:
    """Head and rows. Raises ValueError for a row of more or fewer cells than the head.
    killed_writer: what one has left of its last line does not count."""
    text = read_text(path)
    head, *rows = list(csv.reader(text.splitlines())) or [[]]
    if killed_writer and rows and len(rows[-1]) != len(head) and not text.endswith("\n"):
        rows.pop()
    for number, row in enumerate(rows, start=2):
        if len(row) != len(head):
            raise ValueError(f"{path}:{number}: got {len(row)} cells, expected {len(head)}")
    return head, rows


def read_json(path: pathlib.Path) -> object:
    """Raises ValueError also where it is no JSON, or of more than MOST_LEVELS levels."""
    too_deep = f"{path}: got JSON of more than {MOST_LEVELS} levels, expected fewer"
    try:
        found = json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise ValueError(f"{path}:{error.lineno}: {error.msg}, expected JSON") from error
    except RecursionError as error:
        raise ValueError(too_deep) from error
    if levels(found) > MOST_LEVELS:
        raise ValueError(too_deep)
    return found


def levels(found: object) -> int:
    """Of lists and objects in each other, counted up to one more than MOST_LEVELS; 0 of a number
    or text."""
    count, level = 0, [found]
    while count <= MOST_LEVELS:
        within = [x for x in level if isinstance(x, (dict, list))]
        if not within:
            break
        count += 1
        level = [y for x in within for y in (x.values() if isinstance(x, dict) else x)]
    return count


def write_text(path: pathlib.Path, text: str) -> None:
    """Writes a whole file or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


# Where the program finds presets, memspecs and technology, from its own folder, links resolved
# (algorithm/files/data_files.h).
DATA_FROM_BIN = pathlib.Path("..", "share", "streaminggs")
# Beside the program: what it becomes for any command but `simulate`.
OTHER_COMMANDS = "streaminggs-commands"


def data_folder(binary: pathlib.Path) -> pathlib.Path:
    return binary.resolve().parent / DATA_FROM_BIN


def program_digest(binary: pathlib.Path) -> str:
    """Of the program, the one that has its other commands, and their data files. Raises ValueError
    when there is no program."""
    if not binary.is_file():
        raise ValueError(f"{binary}: not there; scripts/setup.sh builds it")
    data = data_folder(binary)
    digest = hashlib.sha256(binary.read_bytes())
    others = binary.resolve().with_name(OTHER_COMMANDS)
    if others.is_file():
        digest.update(others.read_bytes())
    # Folders of a build tree are links to the sources, which a recursive glob does not follow; what
    # is written there for readers the program does not read.
    files = (p for pattern in ("*", "*/*") for p in data.glob(pattern) if p.is_file())
    for path in sorted(p for p in files if p.suffix != ".md"):
        digest.update(f"{path.relative_to(data)} {path.stat().st_size} ".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def files_of(path: pathlib.Path) -> list[pathlib.Path]:
    """The file of that name, or all below the folder; none for what is neither."""
    if path.is_dir():
        return sorted(below for below in path.rglob("*") if below.is_file())
    return [path] if path.is_file() else []


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
