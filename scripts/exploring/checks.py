"""What explore.py refuses before it judges anything."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

from runs import run_arguments
from runs.simulations import expanded
from exploring.axes import EACH, ORDERS, Assignments, Axis, Order, key_of, scope_of
from exploring.judging import Task
from exploring.measures import value_at
from exploring.space import parse_named

CONFIG = "exact"
STEPS = "steps"


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
