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

import ast
import importlib
import pathlib
import sys

from results import readmes
from runs import run_arguments
from runs.simulations import REPOSITORY

STUDIES = pathlib.Path(__file__).resolve().parent / "studies"
TABLES = REPOSITORY / "traces" / "results"


def studies() -> dict[str, str]:
    """By name, the first sentence that each says of itself; without what they share."""
    found = {}
    for path in sorted(STUDIES.glob("*.py")):
        source = ast.parse(path.read_text())
        functions = {node.name for node in source.body if isinstance(node, ast.FunctionDef)}
        if {"add_arguments", "make"} <= functions:
            sentence = " ".join((ast.get_docstring(source) or "").split()).partition(". ")[0]
            found[path.stem] = sentence.removesuffix(".")
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
    readmes.add_arguments(parser, TABLES)
    arguments = parser.parse_args()
    if arguments.fill is not None:
        return run_arguments.main(lambda: readmes.fill(arguments))
    return list_studies()


if __name__ == "__main__":
    sys.exit(main())
