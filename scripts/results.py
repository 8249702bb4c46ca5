#!/usr/bin/env python3
"""Makes tables of results: a study each, whose table NAME.csv has a row a measurement and NAME.json
says what its columns mean and what made it; and puts tables into Markdown pages.

  results.py --list              names the studies, and minutes that each took where they are known
  results.py STUDY --help        what it measures and takes
  results.py STUDY [ARGUMENTS]   makes its tables in out/results, or below --out
  results.py --all [STUDY...]    makes those in traces/results: the stated job of these, or of all
  results.py --fill [PAGE...]    tables into places in Markdown pages; all of them without any
  results.py --pages             writes README.md beside the tables, and out/results.html
  results.py --check             says what of these is out of date, and tables of several releases

What was simulated, trained or tuned is kept in a folder: started again, a study goes on where it
ended, and takes what another one had made. A study's source states its job, and whose tables it
reads: those are made before it. Jobs that are done are not done again until program, scripts or what
they read change; one that fails keeps no other back.
"""

from __future__ import annotations

import argparse
import dataclasses
import graphlib
import hashlib
import importlib
import pathlib
import re
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import IO

import tables
from reporting import results_page
from runs import run_arguments
from runs.files import write_text
from runs.keeper import Keeper
from runs.scenes import (
    BINARY,
    REFUSED,
    REPOSITORY,
    Failure,
    program_provenance,
    shared_files,
)
from tables import Study, facts_of, markdown_of, said_by_hand

BEAT_SECONDS = 30  # what is lost of the minutes where this is killed
ENDS = (".csv", ".json")  # of a table's files


def named_inputs(parser: run_arguments.Parser, words: Sequence[str]) -> list[pathlib.Path]:
    """Programs, scenes and data sets that a call's arguments name, by default as well; all that
    ../shared has where they name no scene or library, since the call then takes what is there."""
    given = vars(parser.parse_args(words))
    values = [of for each in given.values() for of in (each if isinstance(each, list) else [each])]
    found = [of for of in values if isinstance(of, pathlib.Path) and of.is_file()]
    found += [path for of in values if of and isinstance(of, str) for path in shared_files(of)]
    takes_all = [] in (given.get("scenes"), given.get("libraries"))
    return [*found, *(shared_files() if takes_all else ())]


@dataclasses.dataclass(frozen=True)
class Called:
    """folder: with tables; none of explore.py. minutes: of wall time, of all its starts with this
    program together."""

    folder: pathlib.Path | None
    minutes: float


class Jobs:
    """scripts: their folder. kept: as of --kept. From the folder that they are run in outputs of
    explore.py are named."""

    def __init__(
        self, binary: pathlib.Path, scripts: pathlib.Path, kept: pathlib.Path, start: pathlib.Path
    ):
        """Raises ValueError when there is no such program."""
        self.keeper = Keeper(binary, kept / "jobs")
        self.scripts, self.kept, self.start = scripts, kept, start
        sources = sorted(path for end in ("py", "json") for path in scripts.rglob(f"*.{end}"))
        text = "".join(f"{path.relative_to(scripts)} {path.read_text()}" for path in sources)
        self.digest = hashlib.sha256(text.encode()).hexdigest()

    def make(self, study: Study, out: pathlib.Path) -> list[str]:
        """Writes the study's tables; returns their names. Raises Failure, ValueError."""
        done = [self.called(study, shlex.split(call), out) for call in study.jobs]
        minutes = sum(each.minutes for each in done)
        folders = [each.folder for each in done if each.folder]
        names = dict.fromkeys(p.stem for f in folders for p in sorted(f.glob("*.csv")))
        for name in names:
            of = [folder for folder in folders if (folder / f"{name}.csv").exists()]
            tables.join(out, name, of, minutes)
        return list(names)

    def called(self, study: Study, words: Sequence[str], out: pathlib.Path) -> Called:
        clock = self.keeper.place(f"{study.name} clock", words)
        if words[0] != "results.py":
            return Called(None, self.run(words, clock))

        def make(place: pathlib.Path, lock: IO) -> float:
            own = ["--out", str(place.absolute()), "--kept", str(self.kept.absolute())]
            return self.run([*words, *own], clock, lock)

        read = [out / f"{name}{end}" for of in study.reads.values() for name in of for end in ENDS]
        read += [*self.explored(words), *named_inputs(parser_of(study), words[2:])]
        facts = [self.digest, *words, *map(str, read)]
        return Called(*self.keeper.kept(study.name, facts, make))

    def explored(self, words: Sequence[str]) -> list[pathlib.Path]:
        """Folders that explore.py wrote, which a call names as NAME=FOLDER."""
        places = (self.start / word.partition("=")[2] for word in words if "=" in word)
        return [place for place in places if (place / "explore.json").exists()]

    def run(self, words: Sequence[str], clock: pathlib.Path, lock: IO | None = None) -> float:
        """Minutes, with those in the file of the clock. What it prints but for progress is in its
        tables."""
        earlier = float(clock.read_text()) if clock.exists() else 0.0
        began = time.monotonic()
        call = subprocess.Popen(
            [sys.executable, "-B", str(self.scripts / words[0]), *words[1:]],
            stdout=subprocess.DEVNULL,
            cwd=self.start,
            pass_fds=(lock.fileno(),) if lock else (),
        )
        status = None
        while status is None:
            try:
                status = call.wait(BEAT_SECONDS)
            except subprocess.TimeoutExpired:
                pass
            except KeyboardInterrupt:
                call.wait()  # it has heard it as well, and saves what is under way
                raise
            finally:
                minutes = earlier + (time.monotonic() - began) / 60
                write_text(clock, f"{minutes:.4f}\n")
        if status:
            kind = ValueError if status == REFUSED else Failure
            raise kind(f"{shlex.join(words)}: ended with exit status {status}")
        return minutes


SCRIPTS = pathlib.Path(__file__).resolve().parent
STUDIES = SCRIPTS / "studies"
TABLES = REPOSITORY / "traces" / "results"
OUT = REPOSITORY / "out" / "results"
PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
# What builds and runs leave behind.
NOT_SOURCES = ("build", "out")


def studies() -> dict[str, Study]:
    """By name."""
    modules = [importlib.import_module(f"studies.{path.stem}") for path in STUDIES.glob("*.py")]
    found = [of for module in modules for of in vars(module).values() if isinstance(of, Study)]
    return {study.name: study for study in sorted(found, key=lambda study: study.name)}


def minutes_of(study: str, folder: pathlib.Path) -> float | None:
    """That its tables took which are there; None: nobody has timed it."""
    for name in results_page.names(folder):
        made = facts_of(folder, name)["made"]
        if study in results_page.studies_of(made["command"]) and made.get("minutes") is not None:
            return made["minutes"]
    return None


def in_order(known: Mapping[str, Study], names: Iterable[str]) -> list[str]:
    """Each behind those whose tables it reads."""
    order = graphlib.TopologicalSorter({name: of.reads for name, of in known.items()})
    return [name for name in order.static_order() if name in set(names)]


def parser_of(study: Study) -> run_arguments.Parser:
    parser = run_arguments.Parser(study.about)
    parser.prog += f" {study.name}"
    study.add_arguments(parser)
    parser.add_argument(
        "--out", type=pathlib.Path, default=OUT, metavar="FOLDER", help="for tables"
    )
    add_kept(parser)
    return parser


def add_kept(to: argparse.ArgumentParser) -> None:
    to.add_argument(
        "--kept",
        type=pathlib.Path,
        default=REPOSITORY / "out" / "kept",
        metavar="FOLDER",
        help="for what need not be simulated, trained or tuned again",
    )


def run(study: Study, words: list[str]) -> int:
    arguments = parser_of(study).parse_args(words)
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
    commit = program_provenance(BINARY)["commit"]
    if results_page.CHANGED.fullmatch(commit):
        raise ValueError(f"{BINARY}: commit {commit}, expected one of committed sources")
    jobs = Jobs(BINARY, SCRIPTS, arguments.kept, REPOSITORY)
    by_hand = said_by_hand(arguments.tables)
    errors: list[Exception] = []
    for name in in_order(known, arguments.all or known):
        try:
            for made in jobs.make(known[name], arguments.tables):
                check_it = "; about.json speaks of it: check that" if made in by_hand else ""
                print(f"{arguments.tables / made}.csv, .json{check_it}", flush=True)
        except (Failure, ValueError) as error:
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


def markdown_files(repository: pathlib.Path) -> Iterator[pathlib.Path]:
    """Every one among the sources, sorted."""
    for path in sorted(repository.rglob("*.md")):
        top = path.relative_to(repository).parts[0]
        if top not in NOT_SOURCES and not top.startswith("."):
            yield path


def fill(arguments: argparse.Namespace) -> None:
    texts = {path: path.read_text() for path in arguments.fill or markdown_files(REPOSITORY)}
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
    """Pages that are not what the tables give."""
    texts = {path: filled(path.read_text(), tables) for path in markdown_files(REPOSITORY)}
    texts[tables / results_page.README] = results_page.readme(tables)
    return [
        f"{path}: not what its tables give, --fill or --pages writes it"
        for path, text in texts.items()
        if not path.exists() or path.read_text() != text
    ]


def gone(tables: pathlib.Path) -> Iterator[str]:
    """Tables whose command names a script or a study that is not there."""
    known = studies()
    for name in results_page.names(tables):
        for call in facts_of(tables, name)["made"]["command"].split("; "):
            script, *words = [word for word in call.split() if word != "--all"] or [""]
            there = not script.startswith("scripts/") or (REPOSITORY / script).exists()
            if not there or (script == "scripts/results.py" and words[0] not in known):
                yield f"{name}: its command is not there: {call}"


def check(tables: pathlib.Path) -> None:
    """Raises ValueError with all that is wrong."""
    if faults := [*out_of_date(tables), *gone(tables), *results_page.faults(tables)]:
        raise ValueError("\n  ".join(faults))


def list_studies(known: Mapping[str, Study], tables: pathlib.Path) -> int:
    """With how each begins what it says of itself."""
    for name, study in known.items():
        minutes = minutes_of(name, tables)
        took = "not timed" if minutes is None else f"{minutes:.0f} min"
        about = re.split(r"[.:] ", " ".join((study.about or "").split()))[0]
        print(f"{name:22}{took:>9}  {about}")
    return 0


def main() -> int:
    words, known = sys.argv[1:], studies()
    if words and words[0] in known:
        return run(known[words[0]], words[1:])
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "study", nargs="?", choices=known, metavar="STUDY", help="one that --list names"
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
        "--check", action="store_true", help="fail where pages or releases do not fit the tables"
    )
    parser.add_argument(
        "--fill",
        nargs="*",
        type=pathlib.Path,
        metavar="PAGE",
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
    return list_studies(known, arguments.tables)


if __name__ == "__main__":
    sys.exit(main())
