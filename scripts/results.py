#!/usr/bin/env python3
"""Makes tables of results: a study each, whose table NAME.csv has a row a measurement and NAME.json
says what its columns mean and what made it; and puts tables into the README.md files.

  results.py --list              names the studies
  results.py STUDY --help        what it measures and takes
  results.py STUDY [ARGUMENTS]   makes its tables
  results.py --fill [README...]  tables into places in READMEs; all of them without any

What was simulated, trained or tuned is kept in a folder: started again, a study goes on where it
ended, and takes what another one had made.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import pathlib
import re
import sys
from collections.abc import Iterator

from results import facts_of, markdown_of
from runs import run_arguments
from runs.files import write_text
from runs.scenes import REPOSITORY

STUDIES = pathlib.Path(__file__).resolve().parent / "studies"
TABLES = REPOSITORY / "traces" / "results"
PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# The commit of a program whose sources no commit has.
CHANGED = re.compile(r"\w+-dirty\b")
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def studies() -> dict[str, str]:
    """By name, how what each says of itself begins; without what they share."""
    found = {}
    for path in sorted(STUDIES.glob("*.py")):
        source = ast.parse(path.read_text())
        functions = {node.name for node in source.body if isinstance(node, ast.FunctionDef)}
        if {"add_arguments", "make"} <= functions:
            about = " ".join((ast.get_docstring(source) or "").split())
            found[path.stem] = re.split(r"[.:] ", about)[0]
    return found


def run(name: str, words: list[str]) -> int:
    study = importlib.import_module(f"studies.{name}")
    parser = run_arguments.Parser(study.__doc__)
    parser.prog += f" {name}"
    study.add_arguments(parser)
    parser.add_argument(
        "--out", type=pathlib.Path, default=TABLES, metavar="FOLDER", help="for tables"
    )
    parser.add_argument(
        "--kept",
        type=pathlib.Path,
        default=REPOSITORY / "out" / "kept",
        metavar="FOLDER",
        help="for what need not be simulated, trained or tuned again",
    )
    return run_arguments.main_of_tables(study.make, parser.parse_args(words))


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


def list_studies() -> int:
    for name, sentence in studies().items():
        print(f"{name:22}{sentence}")
    return 0


def main() -> int:
    words = sys.argv[1:]
    if words and words[0] in studies():
        return run(words[0], words[1:])
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "study", nargs="?", choices=studies(), metavar="STUDY", help="one that --list names"
    )
    parser.add_argument("--list", action="store_true", help="name the studies")
    parser.add_argument(
        "--fill",
        nargs="*",
        type=pathlib.Path,
        metavar="README",
        help="put tables into these, or into all; refused is what was made from changed sources",
    )
    parser.add_argument(
        "--tables", type=pathlib.Path, default=TABLES, metavar="FOLDER", help="where they lie"
    )
    arguments = parser.parse_args()
    if arguments.fill is not None:
        return run_arguments.main(lambda: fill(arguments))
    return list_studies()


if __name__ == "__main__":
    sys.exit(main())
