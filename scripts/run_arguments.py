"""How scripts take their command line and how they end; arguments that those which make tables
share."""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import shlex
import sys
from collections.abc import Callable, Iterable
from typing import NoReturn

import simulations

FAILED = 1
BAD_INPUT = 2
INTERRUPTED = 130

# What made a table, where it was put and at what pace: no number of it depends on them.
NOT_IN_TABLES = (
    *("--streaminggs", "--stability", "--renderers"),
    *("--out", "--side-by-side", "--storage", "-j"),
)


class Help(argparse.RawDescriptionHelpFormatter, argparse.ArgumentDefaultsHelpFormatter):
    """Text as it stands in the script, and the default of each argument that has one."""

    def _get_help_string(self, action: argparse.Action) -> str | None:
        if action.default in (None, "", []) or isinstance(action.default, bool):
            return action.help
        if isinstance(action.default, list):
            return f"{action.help} (default: {' '.join(map(str, action.default))})"
        return super()._get_help_string(action)


class Parser(argparse.ArgumentParser):
    """Of every script: what it does not take is one line on stderr and exit status 2."""

    def __init__(self, about: str | None):
        super().__init__(description=about, formatter_class=Help, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        sys.exit(ended(message.removeprefix("argument "), BAD_INPUT))


SCENE_FORMS = (
    "builtin:NAME?n=COUNT, a real scene of ../shared by name, or a .ply file with its cameras "
    "beside it (NAME.json)"
)


def parser(
    about: str,
    without_scenes: str = "the built-in scenes and all real ones",
    what: str = "SCENE",
    forms: str = SCENE_FORMS,
) -> Parser:
    """SCENE..., the program to run them with, and a folder for tables. without_scenes: what is
    taken where no scene is named, in words. what, forms: what is named, and how it may be."""
    made = Parser(about)
    made.add_argument(
        "scenes",
        nargs="*",
        metavar=what,
        help=f"{forms}; default: {without_scenes}",
    )
    made.add_argument(
        "--streaminggs",
        type=pathlib.Path,
        default=simulations.BINARY,
        metavar="PROGRAM",
        help="the command",
    )
    made.add_argument(
        "--out",
        type=pathlib.Path,
        default=simulations.REPOSITORY / "out",
        metavar="FOLDER",
        help="for tables",
    )
    return made


def add_side_by_side(to: Parser) -> None:
    to.add_argument(
        "--side-by-side",
        type=int,
        choices=range(1, simulations.MOST_SIDE_BY_SIDE + 1),
        default=simulations.MOST_SIDE_BY_SIDE,
        help="simulations at a time; 1 for wall times that nothing disturbs",
    )


def add_fittings_side_by_side(to: Parser) -> None:
    to.add_argument(
        "--side-by-side",
        type=int,
        choices=range(1, simulations.MOST_SIDE_BY_SIDE + 1),
        default=1,
        help="trainings, tunings or simulations at a time; each of the former takes all cores",
    )


def how_made(views: Iterable[dict]) -> str:
    """A paragraph that says where a table comes from: the command, and the commit that the reports
    of the views name."""
    return how_made_at(view["provenance"].get("commit", "") for view in views)


def how_made_at(commits: Iterable[str]) -> str:
    """The same of commits; those without a name do not count."""
    words = iter(sys.argv[1:])
    kept = []
    for word in words:
        if word in NOT_IN_TABLES:
            next(words, None)
        elif word.partition("=")[0] not in NOT_IN_TABLES:
            kept.append(word)
    command = shlex.join([f"scripts/{pathlib.Path(sys.argv[0]).name}", *kept])
    commits = sorted(set(commits) - {""})
    return f"Made by `{command}`; commit {', '.join(commits) or 'unknown'}.\n\n"


def check_size(option: str, text: str) -> None:
    """Raises ValueError for what is no size of a picture."""
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", text):
        raise ValueError(f"{option}: got {text}, expected WIDTHxHEIGHT in px")


def check_once(option: str, given: Iterable[object]) -> None:
    """Raises ValueError for what would count twice."""
    met: set[object] = set()
    for value in given:
        if value in met:
            raise ValueError(f"{option}: got {value} twice, expected each once")
        met.add(value)


def make_folder(out: pathlib.Path) -> None:
    """Makes the folder for tables, before an hour of simulations is spent. Raises ValueError."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"--out: {out}: {error.strerror}, expected a folder") from error
    if not os.access(out, os.W_OK):
        raise ValueError(f"--out: {out}: cannot be written to")


def ended(text: object, status: int) -> int:
    """Says why in a line; the status."""
    print(f"{sys.argv[0]}: {text}", file=sys.stderr)
    return status


def main(work: Callable[[], None]) -> int:
    """Exit status: 0 done, 1 a simulation failed, 2 bad arguments or input, 130 interrupted."""
    try:
        work()
    except simulations.Failure as failure:
        return ended(failure, FAILED)
    except ValueError as error:
        return ended(error, BAD_INPUT)
    except OSError as error:
        return ended(f"{error.filename or 'error'}: {error.strerror or error}", BAD_INPUT)
    except KeyboardInterrupt:
        return ended("interrupted", INTERRUPTED)
    return 0


def main_of_tables(
    make: Callable[[argparse.Namespace], None], arguments: argparse.Namespace
) -> int:
    """Exit status of a script that makes tables in the folder of --out."""

    def work() -> None:
        make_folder(arguments.out)
        make(arguments)

    return main(work)
