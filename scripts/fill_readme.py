#!/usr/bin/env python3
"""Puts the tables that the other scripts have made into README.md: what stands between
`<!-- table: NAME -->` and `<!-- end -->` becomes out/NAME.md. Tables that are not there yet are
named and their places left as they are."""

from __future__ import annotations

import argparse
import pathlib
import re
import sys

import tables
from simulations import REPOSITORY

PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def filled(text: str, folder: pathlib.Path) -> str:
    """The text with each place filled from folder/NAME.md."""

    def content(place: re.Match[str]) -> str:
        source = folder / f"{place.group(2)}.md"
        if not source.exists():
            print(f"{source}: not there, its place is left as it is", file=sys.stderr)
            return place.group(0)
        return place.group(1) + source.read_text() + place.group(3)

    return PLACE.sub(content, text)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--readme", type=pathlib.Path, default=REPOSITORY / "README.md")
    parser.add_argument("--tables", type=pathlib.Path, default=REPOSITORY / "out")
    arguments = parser.parse_args()
    tables.write_text(arguments.readme, filled(arguments.readme.read_text(), arguments.tables))
    return 0


if __name__ == "__main__":
    sys.exit(main())
