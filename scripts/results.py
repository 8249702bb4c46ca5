#!/usr/bin/env python3
"""Makes tables of results: a study each, whose table NAME.csv has a row a measurement and NAME.json
says what its columns mean and what made it; and puts tables into the README.md files.

  results.py --list              names the studies, and minutes that each took where they are known
  results.py STUDY --help        what it measures and takes
  results.py STUDY [ARGUMENTS]   makes its tables in out/results, or below --out
  results.py --all [STUDY...]    makes those in traces/results: the stated job of these, or of all
  results.py --fill [README...]  tables into places in READMEs; all of them without any
  results.py --pages             writes README.md beside the tables, and out/results.html
  results.py --check             says what of these is out of date, and tables of several releases

What was simulated, trained or tuned is kept in a folder: started again, a study goes on where it
ended, and takes what another one had made. A stated job is the JOBS of a study's source. Jobs that
are done are not done again until program or scripts change; one that fails keeps no other back.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import pathlib
import re
import sys
from collections.abc import Iterator
from types import ModuleType

from tables import facts_of, markdown_of, said_by_hand
from tables.jobs import Jobs
from reporting import results_page
from runs import run_arguments, simulations
from runs.files import write_text
from runs.scenes import REPOSITORY

SCRIPTS = pathlib.Path(__file__).resolve().parent
STUDIES = SCRIPTS / "studies"
TABLES = REPOSITORY / "traces" / "results"
OUT = REPOSITORY / "out" / "results"
PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def studies() -> dict[str, str]:
    """How what each says of itself begins, by its name; without what they share."""
    found = {}
    for path in sorted(STUDIES.glob("*.py")):
        source = ast.parse(path.read_text())
        functions = {node.name for node in source.body if isinstance(node, ast.FunctionDef)}
        if {"add_arguments", "make"} <= functions:
            about = " ".join((ast.get_docstring(source) or "").split())
            found[path.stem] = re.split(r"[.:] ", about)[0]
    return found


def minutes_of(study: str, folder: pathlib.Path) -> float | None:
    """That its tables took which are there; None: nobody has timed it."""
    for name in results_page.names(folder):
        made = facts_of(folder, name)["made"]
        if re.search(rf"\b{study}\b", made["command"]) and made.get("minutes") is not None:
            return made["minutes"]
    return None


def parser_of(name: str) -> tuple[run_arguments.Parser, ModuleType]:
    study = importlib.import_module(f"studies.{name}")
    parser = run_arguments.Parser(study.__doc__)
    parser.prog += f" {name}"
    study.add_arguments(parser)
    parser.add_argument(
        "--out", type=pathlib.Path, default=OUT, metavar="FOLDER", help="for tables"
    )
    add_kept(parser)
    return parser, study


def add_kept(to: argparse.ArgumentParser) -> None:
    to.add_argument(
        "--kept",
        type=pathlib.Path,
        default=REPOSITORY / "out" / "kept",
        metavar="FOLDER",
        help="for what need not be simulated, trained or tuned again",
    )


def run(name: str, words: list[str]) -> int:
    parser, study = parser_of(name)
    arguments = parser.parse_args(words)
    status = run_arguments.main_of_tables(study.make, arguments)
    if status == 0 and arguments.out == OUT:
        print(f"tables are in {OUT.relative_to(REPOSITORY)}", file=sys.stderr)
    return status


def make_all(arguments: argparse.Namespace) -> None:
    """Into arguments.tables. Raises the first error when all else is made."""
    known = studies()
    for name in arguments.all:
        if name not in known:
            raise ValueError(f"--all: got {name}, expected some of {', '.join(known)}")
    commit = simulations.program_provenance(simulations.BINARY)["commit"]
    if results_page.CHANGED.fullmatch(commit):
        raise ValueError(
            f"{simulations.BINARY}: commit {commit}, expected one of committed sources"
        )
    jobs = Jobs(simulations.BINARY, SCRIPTS, arguments.kept, REPOSITORY)
    by_hand = said_by_hand(arguments.tables)
    errors: list[Exception] = []
    for name in arguments.all or known:
        calls = importlib.import_module(f"studies.{name}").JOBS
        try:
            for made in jobs.make(name, calls, arguments.tables):
                check_it = "; about.json speaks of it: check that" if made in by_hand else ""
                print(f"{arguments.tables / made}.csv, .json{check_it}", flush=True)
        except (simulations.Failure, ValueError) as error:
            print(error, file=sys.stderr)
            errors.append(error)
    if errors:
        raise errors[0]


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
            if results_page.CHANGED.fullmatch(commit):
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


def write_pages(tables: pathlib.Path) -> None:
    for path, text in (
        (tables / results_page.README, results_page.readme(tables)),
        (REPOSITORY / "out" / "results.html", results_page.html(tables)),
    ):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_text(path, text)
        print(path.relative_to(REPOSITORY) if path.is_relative_to(REPOSITORY) else path)


def out_of_date(tables: pathlib.Path) -> list[str]:
    """READMEs that are not what the tables give."""
    texts = {path: filled(path.read_text(), tables) for path in readmes(REPOSITORY)}
    texts[tables / results_page.README] = results_page.readme(tables)
    return [
        f"{path}: not what its tables give, --fill or --pages writes it"
        for path, text in texts.items()
        if not path.exists() or path.read_text() != text
    ]


def check(tables: pathlib.Path) -> None:
    """Raises ValueError with all that is wrong."""
    if faults := [*out_of_date(tables), *results_page.faults(tables)]:
        raise ValueError("\n  ".join(faults))


def list_studies(tables: pathlib.Path) -> int:
    for name, about in studies().items():
        minutes = minutes_of(name, tables)
        took = "not timed" if minutes is None else f"{minutes:.0f} min"
        print(f"{name:22}{took:>9}  {about}")
    return 0


def main() -> int:
    words = sys.argv[1:]
    if words and words[0] in studies():
        return run(words[0], words[1:])
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "study", nargs="?", choices=studies(), metavar="STUDY", help="one that --list names"
    )
    parser.add_argument("--list", action="store_true", help="name the studies, and their minutes")
    parser.add_argument(
        "--all",
        nargs="*",
        metavar="STUDY",
        help="make the tables of --tables, all of them or those of some studies; interrupted and "
        "started again it goes on",
    )
    parser.add_argument(
        "--pages", action="store_true", help="write README.md beside the tables and the page of all"
    )
    parser.add_argument(
        "--check", action="store_true", help="fail where READMEs or releases do not fit the tables"
    )
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
    add_kept(parser)
    arguments = parser.parse_args()
    if arguments.all is not None:
        return run_arguments.main(lambda: make_all(arguments))
    if arguments.fill is not None:
        return run_arguments.main(lambda: fill(arguments))
    if arguments.pages or arguments.check:
        work = write_pages if arguments.pages else check
        return run_arguments.main(lambda: work(arguments.tables))
    return list_studies(arguments.tables)


if __name__ == "__main__":
    sys.exit(main())
