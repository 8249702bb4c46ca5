"""Tables in the README.md files of the repository: what stands between `<!-- table: NAME -->` and
`<!-- end -->` is the Markdown of table NAME."""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
from collections.abc import Iterator

from results import facts_of, markdown_of
from runs.given_files import write_text
from runs.simulations import REPOSITORY

PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# The commit of a program whose sources no commit has.
CHANGED = re.compile(r"\w+-dirty\b")
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def filled(text: str, folder: pathlib.Path) -> str:
    """The text with each place filled from the folder's tables; one of a table that is not there is
    named and left as it is. Raises ValueError where a table was made from changed sources: nobody
    could make it again."""

    def content(place: re.Match[str]) -> str:
        name = place.group(2)
        if not (folder / f"{name}.json").exists():
            print(f"{folder / name}.json: not there, its place is left as it is", file=sys.stderr)
            return place.group(0)
        for commit in facts_of(folder, name)["made"]["commits"]:
            if CHANGED.fullmatch(commit):
                raise ValueError(
                    f"{folder / name}.json: commit {commit}, expected one without changes"
                )
        return place.group(1) + markdown_of(folder, name) + place.group(3)

    return PLACE.sub(content, text)


def readmes(repository: pathlib.Path) -> Iterator[pathlib.Path]:
    """Every README.md among the sources, sorted."""
    for path in sorted(repository.rglob("README.md")):
        top = path.relative_to(repository).parts[0]
        if top not in NOT_SOURCES and not top.startswith("."):
            yield path


def fill(arguments: argparse.Namespace) -> None:
    texts = {path: path.read_text() for path in arguments.fill or readmes(REPOSITORY)}
    new = {path: filled(text, arguments.tables) for path, text in texts.items()}
    for path in texts:
        if new[path] != texts[path]:
            write_text(path, new[path])
            print(path.relative_to(REPOSITORY) if path.is_relative_to(REPOSITORY) else path)


def add_arguments(to: argparse.ArgumentParser, tables: pathlib.Path) -> None:
    to.add_argument(
        "--fill",
        nargs="*",
        type=pathlib.Path,
        metavar="README",
        help="put tables into these, or into all; refused is what was made from changed sources",
    )
    to.add_argument(
        "--tables", type=pathlib.Path, default=tables, metavar="FOLDER", help="where they lie"
    )
