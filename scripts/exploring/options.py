"""Options of explore.py: recipes, which are options by name in a JSON file, and what is refused
before anything is judged."""

from __future__ import annotations

import argparse
import pathlib
from collections.abc import Iterable, Iterator, Sequence

from exploring.axes import EACH, ORDERS, Assignments, Axis, Order, key_of, parse_named, scope_of
from exploring.judging import Task
from runs import run_arguments
from runs.files import read_json
from runs.simulations import expanded, value_at

CONFIG = "exact"
STEPS = "steps"
RECIPES = pathlib.Path(__file__).resolve().parent / "recipes"


def recipes() -> list[str]:
    return sorted(path.stem for path in RECIPES.glob("*.json"))


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
    path = RECIPES / f"{name}.json" if name in recipes() else pathlib.Path(name)
    if not path.exists():
        raise ValueError(f"got {name}, expected a JSON file or one of {', '.join(recipes())}")
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


def default_config(machine: str) -> str:
    """The preset whose machine has the axes of --machine; with none of these the exact order's."""
    return ORDERS[machine].preset if machine else CONFIG


def check_arguments(arguments: argparse.Namespace) -> None:
    """Raises ValueError for numbers that say nothing, and for what has no effect."""
    run_arguments.check_at_least("-j", arguments.j, 1)
    if arguments.trials is not None:
        run_arguments.check_at_least("--trials", arguments.trials, 1)
    run_arguments.check_at_least("--minutes", arguments.minutes, 0)
    if arguments.minutes and not arguments.search:
        raise ValueError("--minutes: has no effect without --search")
    if arguments.trials is not None and not arguments.search:
        raise ValueError("--trials: has no effect without --search")
    if arguments.study and arguments.search == STEPS:
        raise ValueError(f"--study: has no effect with --search {STEPS}")
    if arguments.storage and not arguments.study:
        raise ValueError("--storage: has no effect without --study NAME")
    if arguments.size:
        run_arguments.check_size("--size", arguments.size)


def keys_of(settings: Iterable[str]) -> list[str]:
    return [key_of(setting) for setting in settings]


def check_keys(
    place: str, settings: Sequence[str], scopes: Sequence[str], config: dict, name: str
) -> None:
    """config: with all keys that its machine has; scopes: labels of scenes. Raises ValueError for
    another key: with it every configuration would be refused; and for another scene."""
    for setting in settings:
        if value_at(config, key_of(setting)) is None:
            raise ValueError(f"{place}: got {key_of(setting)}, expected a key of --config {name}")
        if scope_of(setting) not in ("", *scopes):
            raise ValueError(
                f"{place}: got {setting.partition('=')[0]}, expected one of "
                f"{', '.join(scopes)}, or {EACH}, behind the @"
            )


def check_machine(order: Order, config: dict, name: str) -> None:
    """Raises ValueError where the configuration is of a machine that has not the order's axes."""
    chosen = [s for axis in order.axes for setting in axis.settings for s in setting]
    for key in keys_of([*order.fixed, *chosen]):
        if value_at(config, key) is None:
            raise ValueError(
                f"--machine {order.name}: got --config {name}, which has no {key}; "
                f"expected {order.preset} or another one of its machine"
            )


def check_set(given: Sequence[str], axes: Sequence[Axis]) -> None:
    """Raises ValueError for a key of --set that every configuration sets itself."""
    for key in keys_of(expanded(given)):
        for axis in axes:
            if not axis.scope and all(key in keys_of(setting) for setting in axis.settings):
                raise ValueError(
                    f"--set: got {key}, expected a key that not every configuration sets: "
                    f"by --axis, --points or --machine"
                )


def parse_beside(texts: Sequence[str]) -> dict[Assignments, str]:
    """Configurations of --beside with their names. Raises ValueError, also for two of one name or
    of the same settings."""
    found: dict[Assignments, str] = {}
    for number, text in enumerate(texts, start=1):
        name, assignments = parse_named(text, number, "--beside")
        for other, its_name in found.items():
            if name == its_name:
                raise ValueError(f"--beside: got the name {name} twice, expected each once")
            if values_of(assignments) == values_of(other):
                raise ValueError(
                    f"--beside: got {name} with the settings of {its_name}, expected others"
                )
        found[assignments] = name
    return found


def values_of(assignments: Assignments) -> dict[str, str]:
    """By key; the last one counts."""
    return dict(assignment.split("=", 1) for assignment in assignments)


def check_search(search: str, task: Task) -> None:
    """Raises ValueError where it is not made for the objectives."""
    if search == STEPS and len(task.objectives) > 1:
        raise ValueError(f"--search {STEPS}: got {len(task.objectives)} objectives, expected one")
