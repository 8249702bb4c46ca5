"""Command-line arguments that the scripts which make tables share, and how they end."""

from __future__ import annotations

import argparse
import pathlib
import shlex
import sys
from collections.abc import Callable, Iterable

import simulations

BAD_INPUT = 2


def add_scenes(to: argparse.ArgumentParser) -> None:
    """SCENE..., and the program to run them with."""
    to.add_argument(
        "scenes",
        nargs="*",
        metavar="SCENE",
        help="builtin:NAME?n=COUNT, a real scene of ../shared by name, or a .ply file with its "
        "cameras beside it (NAME.json); default: the built-in scenes and all real ones",
    )
    to.add_argument("--streaminggs", type=pathlib.Path, default=simulations.BINARY)


def parser(about: str, default_timing: str) -> argparse.ArgumentParser:
    """For scripts that run many simulations in one timing mode."""
    made = argparse.ArgumentParser(description=about)
    add_scenes(made)
    made.add_argument("--timing", choices=("accurate", "fast"), default=default_timing)
    made.add_argument(
        "--side-by-side",
        type=int,
        choices=range(1, simulations.MOST_SIDE_BY_SIDE + 1),
        default=simulations.MOST_SIDE_BY_SIDE,
        help="simulations at a time; 1 for wall times that nothing disturbs",
    )
    return made


def how_made(arguments: argparse.Namespace, views: Iterable[dict]) -> str:
    """A paragraph that says where a table comes from: the command, without where it found the
    program and put the table, and the commit that the reports of the views name."""
    words = iter(sys.argv[1:])
    kept = []
    for word in words:
        if word in ("--streaminggs", "--out"):
            next(words, None)
        elif not word.startswith(("--streaminggs=", "--out=")):
            kept.append(word)
    command = shlex.join([f"scripts/{pathlib.Path(sys.argv[0]).name}", *kept])
    timing = f", {arguments.timing} timing" if "timing" in arguments else ""
    commits = sorted({view["provenance"].get("commit", "") for view in views} - {""})
    return f"Made by `{command}`{timing}; commit {', '.join(commits) or 'unknown'}.\n\n"


def main(work: Callable[[], None]) -> int:
    """Exit status: 0 done, 1 a simulation failed, 2 bad arguments."""
    try:
        work()
    except simulations.Failure as failure:
        print(f"{sys.argv[0]}: {failure}", file=sys.stderr)
        return 1
    except ValueError as error:
        print(f"{sys.argv[0]}: {error}", file=sys.stderr)
        return BAD_INPUT
    return 0
