#!/usr/bin/env python3
"""Puts the tables that the other scripts have made into the README.md files of the repository: what
stands between `<!-- table: NAME -->` and `<!-- end -->` becomes out/NAME.md. Tables that are not
there yet are named and their places left as they are."""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
from collections.abc import Iterator

import run_arguments
import tables
from simulations import REPOSITORY

PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def filled(text: str, folder: pathlib.Path) -> str:
    """The text with each place filled from folder/NAME.md."""

    def content(place: re.Match[str]) -> str:
        source = folder / f"{place.group(2)}.md"
        if not source.exists():
            print(f"{source}: not there, its place is left as it is", file=sys.stderr)
            return place.group(0)
        return place.group(1) + source.read_text() + place.group(3)

    return PLACE.sub(content, text)


def readmes(repository: pathlib.Path) -> Iterator[pathlib.Path]:
    """Every README.md among the sources, sorted."""
    for path in sorted(repository.rglob("README.md")):
        top = path.relative_to(repository).parts[0]
        if top not in NOT_SOURCES and not top.startswith("."):
            yield path


def fill(arguments: argparse.Namespace) -> None:
    for path in arguments.readmes or readmes(REPOSITORY):
        text = path.read_text()
        if (new := filled(text, arguments.tables)) != text:
            tables.write_text(path, new)
            print(path.relative_to(REPOSITORY) if path.is_relative_to(REPOSITORY) else path)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "readmes", nargs="*", type=pathlib.Path, metavar="README", help="default: all of them"
    )
    parser.add_argument("--tables", type=pathlib.Path, default=REPOSITORY / "out")
    arguments = parser.parse_args()
    return run_arguments.main(lambda: fill(arguments))


if __name__ == "__main__":
    sys.exit(main())
