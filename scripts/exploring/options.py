"""Options of explore.py; recipes, which are options by name in a JSON file, and what is refused
before anything is judged."""

from __future__ import annotations

import argparse
import os
import pathlib
import re
from collections.abc import Iterable, Iterator, Sequence

from exploring.axes import EACH, ORDERS, Assignments, Axis, Order, key_of, parse_named, scope_of
from exploring.judging import Judge, Task
from exploring.measures import check_there
from runs import run_arguments
from runs.files import read_json
from runs.scenes import REPOSITORY
from runs.simulations import expanded, value_at

CONFIG = "exact"
STEPS = "steps"
SAMPLERS = ("tpe", "nsga2", "random")
OBJECTIVES = "cycles,dram_bytes,sram_bytes,filter_lanes,mm2"
MOST_MINUTES = 60 * 24 * 365
RECIPES = pathlib.Path(__file__).resolve().parent / "recipes"


def parser(about: str | None) -> run_arguments.Parser:
    parser = run_arguments.Parser(about)
    run_arguments.add_scenes(parser)
    parser.add_argument(
        "--out", type=pathlib.Path, default=REPOSITORY / "out", metavar="FOLDER", help="for tables"
    )
    parser.add_argument(
        "-j", type=int, default=os.cpu_count(), metavar="N", help="simulations at a time"
    )
    parser.add_argument(
        "--recipe",
        default="",
        metavar="NAME",
        help=f"{', '.join(recipes())}, or a JSON file of options by name; what the command line "
        "says of one counts in its place",
    )
    parser.add_argument("--machine", choices=list(ORDERS), help="axes of an order's machine")
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "--axis", action="append", default=[], metavar="KEY=V1,V2,...", help="any number of them"
    )
    which.add_argument(
        "--points", type=pathlib.Path, metavar="FILE", help="a list in place of a grid"
    )
    parser.add_argument(
        "--beside",
        action="append",
        default=[],
        metavar="'NAME: KEY=VALUE ...'",
        help="judged as well and named in the figure; the name may be left out",
    )
    parser.add_argument("--view", default="0", help="numbers of cameras, as in 0,2, or all")
    parser.add_argument("--size", default="", metavar="WxH", help="in px; default: the camera's")
    parser.add_argument(
        "--stereo",
        type=said_eyes,
        default=None,
        metavar="ipd=DISTANCE",
        help="a second eye beside each camera, in world units: a frame is two pictures",
    )
    parser.add_argument(
        "--config",
        default="",
        help="preset or JSON file to start from; default: --machine's preset, else exact",
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="for every configuration"
    )
    parser.add_argument(
        "--objectives",
        default="",
        metavar="MEASURE,...",
        help="numbers to make small, or large with max: before; default: " + OBJECTIVES,
    )
    parser.add_argument(
        "--require", action="append", default=[], metavar="'MEASURE >= NUMBER'", help="to be held"
    )
    parser.add_argument(
        "--show", default="", metavar="MEASURE,...", help="further columns of the tables"
    )
    parser.add_argument(
        "--search",
        choices=(STEPS, *SAMPLERS),
        help="steps along the axes, or Optuna's sampler; default: all there is",
    )
    parser.add_argument(
        "--trials",
        type=int,
        metavar="N",
        help="configurations that a search judges or that are refused, at most; default: 200, by "
        "steps as many as it takes. Those of a --study's earlier runs and other workers count; "
        "without one each run counts anew, also what is kept and not simulated again. What is "
        "--beside, too large, skipped or proposed twice does not count; each other worker of a "
        "study may add what it has under way",
    )
    parser.add_argument("--minutes", type=float, default=0, help="then it ends; 0: no limit")
    parser.add_argument("--seed", type=int, default=1, help="of the sampler")
    parser.add_argument("--study", default="", metavar="NAME", help="kept in --storage")
    parser.add_argument(
        "--storage", default="", metavar="URL", help="default: sqlite, explore.db in --out"
    )
    parser.add_argument(
        "--lost-after",
        type=int,
        default=60,
        metavar="SECONDS",
        help="a worker of a study that was not heard of for so long counts as dead",
    )
    return parser


def said_eyes(text: str) -> str:
    """An empty one would drop those of a recipe unseen."""
    if not text:
        raise argparse.ArgumentTypeError("got nothing, expected ipd=DISTANCE")
    return text


def recipes() -> list[str]:
    return sorted(path.stem for path in RECIPES.glob("*.json"))


def parsed(parser: run_arguments.Parser, words: Sequence[str]) -> argparse.Namespace:
    """The words, and before them those of the recipe that --recipe names; of_recipe: its options."""
    name, of_recipe = parser.parse_known_args(words)[0].recipe, []
    if name:
        try:
            of_recipe = list(recipe_words(name, words))
        except (ValueError, OSError) as error:
            parser.error(f"--recipe: {error}")
        parser.place = f"--recipe {name}: "
        parser.parse_args(of_recipe)
        parser.place = ""
    arguments = parser.parse_args([*of_recipe, *words])
    arguments.of_recipe = {word.partition("=")[0] for word in of_recipe}
    arguments.config = arguments.config or default_config(arguments.machine)
    arguments.stereo = arguments.stereo or ""
    return arguments


def in_its_recipe(arguments: argparse.Namespace, refused: str) -> str:
    """What is refused, with the recipe where it is an option of that."""
    of_recipe = re.match(r"--[\w-]+", refused)
    if of_recipe and of_recipe[0] in arguments.of_recipe:
        return f"--recipe {arguments.recipe}: {refused}"
    return refused


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
    if arguments.minutes > MOST_MINUTES:
        raise ValueError(f"--minutes: got {arguments.minutes:g}, expected at most {MOST_MINUTES}")
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


def check_measures(task: Task, judge: Judge) -> None:
    """Raises ValueError for a measure that no report of the machine has, by the smallest frame."""
    asked = [("--objectives", o.measure) for o in task.objectives]
    asked += [("--require", required.measure) for required in task.requirements]
    asked += [("--show", measure) for measure in task.shown]
    asked = [(option, measure.path) for option, measure in asked if measure.is_by_its_path()]
    for view in judge.machine(()) if asked else ():
        for option, path in asked:
            try:
                check_there(view, path)
            except ValueError as error:
                raise ValueError(f"{option}: {error}") from error


def check_search(search: str, task: Task) -> None:
    """Raises ValueError where it is not made for the objectives."""
    if search == STEPS and len(task.objectives) > 1:
        raise ValueError(f"--search {STEPS}: got {len(task.objectives)} objectives, expected one")
