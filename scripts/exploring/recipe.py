"""Recipes: what to explore, as options of explore.py by name in a JSON file. What the command line
says of an option counts in place of what the recipe says."""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Iterator, Sequence

from runs.files import read_json

FOLDER = pathlib.Path(__file__).resolve().parent / "recipes"


def names() -> list[str]:
    return sorted(path.stem for path in FOLDER.glob("*.json"))


def parsed(parser: argparse.ArgumentParser, words: Sequence[str]) -> argparse.Namespace:
    """The words, and before them those of the recipe that --recipe names."""
    if not (name := parser.parse_known_args(words)[0].recipe):
        return parser.parse_args(words)
    try:
        return parser.parse_args([*recipe_words(name, words), *words])
    except (ValueError, OSError) as error:
        parser.error(f"--recipe: {error}")


def recipe_words(name: str, given: Sequence[str]) -> Iterator[str]:
    """Raises ValueError, OSError."""
    path = FOLDER / f"{name}.json" if name in names() else pathlib.Path(name)
    if not path.exists():
        raise ValueError(f"got {name}, expected a JSON file or one of {', '.join(names())}")
    options = read_json(path)
    if not isinstance(options, dict):
        raise ValueError(f"{path}: expected options by name")
    said = {word.partition("=")[0] for word in given}
    for option, values in options.items():
        for value in values if isinstance(values, list) else [values]:
            if not isinstance(value, str):
                raise ValueError(
                    f"{path}: {option}: got {value!r}, expected a text or a list of them"
                )
            if f"--{option}" not in said:
                yield f"--{option}={value}"
