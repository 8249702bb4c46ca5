#!/usr/bin/env python3
"""Puts the tables that the other scripts have made into the README.md files of the repository: what
stands between `<!-- table: NAME -->` and `<!-- end -->` becomes out/NAME.md. Tables that are not
there yet are named and their places left as they are. A table of a program that was built from
changed sources (commit ...-dirty) is refused, before anything is written: nobody could make it
again."""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
from collections.abc import Iterator

from runs import run_arguments
from results import tables
from runs.simulations import REPOSITORY

PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# What a table says of a program whose sources no commit has (run_arguments.how_made).
CHANGED = re.compile(r"commit (.*, )?\w+-dirty\b")
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def filled(text: str, folder: pathlib.Path) -> str:
    """The text with each place filled from folder/NAME.md. Raises ValueError where one was made
    from changed sources."""

    def content(place: re.Match[str]) -> str:
        source = folder / f"{place.group(2)}.md"
        if not source.exists():
            print(f"{source}: not there, its place is left as it is", file=sys.stderr)
            return place.group(0)
        made = source.read_text()
        if changed := CHANGED.search(made):
            raise ValueError(f"{source}: {changed.group(0)}, expected a commit without changes")
        return place.group(1) + made + place.group(3)

    return PLACE.sub(content, text)


def readmes(repository: pathlib.Path) -> Iterator[pathlib.Path]:
    """Every README.md among the sources, sorted."""
    for path in sorted(repository.rglob("README.md")):
        top = path.relative_to(repository).parts[0]
        if top not in NOT_SOURCES and not top.startswith("."):
            yield path


def fill(arguments: argparse.Namespace) -> None:
    texts = {path: path.read_text() for path in arguments.readmes or readmes(REPOSITORY)}
    new = {path: filled(text, arguments.tables) for path, text in texts.items()}
    for path in texts:
        if new[path] != texts[path]:
            tables.write_text(path, new[path])
            print(path.relative_to(REPOSITORY) if path.is_relative_to(REPOSITORY) else path)


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "readmes", nargs="*", type=pathlib.Path, metavar="README", help="default: all of them"
    )
    parser.add_argument(
        "--tables",
        type=pathlib.Path,
        default=REPOSITORY / "out",
        metavar="FOLDER",
        help="where the tables lie",
    )
    arguments = parser.parse_args()
    return run_arguments.main(lambda: fill(arguments))


if __name__ == "__main__":
    sys.exit(main())
