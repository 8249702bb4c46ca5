"""What machines are held against each other on: scenes at sizes, with memories."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import subprocess
from collections.abc import Sequence

from runs import run_arguments
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import said
from runs.view_numbers import view_numbers_there

OBJECTS = ("truck", "playbot", "builtin:object")  # whatever their parameters
SIZES, OBJECT_SIZES = ("640x360", "980x545"), ("640x360", "800x800")
BUILT_IN = ("builtin:object", "builtin:outdoor", "builtin:outdoor?n=1000000")


@dataclasses.dataclass(frozen=True)
class Case:
    scene: Scene
    size: str

    def cells(self) -> tuple[str, str]:
        return self.scene.name, self.size


def shows_object(name: str) -> bool:
    return any(name == text or name.startswith(f"{text}?") for text in OBJECTS)


def sizes_of(name: str, arguments: argparse.Namespace) -> list[str]:
    if shows_object(name):
        return arguments.object_sizes or OBJECT_SIZES
    return arguments.sizes or SIZES


def check_sizes(arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
    """Raises ValueError for what is no size or there twice, and where only the sizes of other
    scenes are given."""
    given = {"--sizes": arguments.sizes, "--object-sizes": arguments.object_sizes}
    for option, sizes in given.items():
        run_arguments.check_once(option, sizes or ())
        for size in sizes or ():
            run_arguments.check_size(option, size)
    asked = {option for option, sizes in given.items() if sizes}
    used = {"--object-sizes" if shows_object(scene.name) else "--sizes" for scene in scenes}
    if asked and not asked & used:
        names = ", ".join(scene.name for scene in scenes)
        objects = ", ".join(OBJECTS)
        raise ValueError(
            f"{asked.pop()}: got only this, expected {used.pop()} for {names} (objects: {objects})"
        )


def check_machines(arguments: argparse.Namespace) -> None:
    """Before hours of simulation. Raises ValueError for what the program refuses to be told of, and
    for what would count twice."""
    run_arguments.check_once("--machines", arguments.machines)
    run_arguments.check_once("--channels", arguments.channels)
    for machine, channels in itertools.product(arguments.machines, arguments.channels):
        asked = ("--config", machine, "--set", f"dram.channels={channels}")
        command = [str(arguments.streaminggs), "describe", *asked]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise ValueError(said(done))


def find_cases(arguments: argparse.Namespace) -> list[Case]:
    """Raises ValueError for what is no scene, size, machine or view, or there twice."""
    scenes = find_scenes(arguments.scenes or [*BUILT_IN, *shared_names()])
    check_sizes(arguments, scenes)
    check_machines(arguments)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    return [Case(scene, size) for scene in scenes for size in sizes_of(scene.name, arguments)]


def add_arguments(to: run_arguments.Parser, machines: Sequence[str], channels: list[int]) -> None:
    """Of cases and of the machines that draw them."""
    to.add_argument("--sizes", nargs="+", metavar="WxH", help=f"in px; default: {' '.join(SIZES)}")
    to.add_argument(
        "--object-sizes",
        nargs="+",
        metavar="WxH",
        help=f"of {', '.join(OBJECTS)}; default: {' '.join(OBJECT_SIZES)}",
    )
    to.add_argument(
        "--channels",
        nargs="+",
        type=int,
        default=channels,
        metavar="N",
        help="of LPDDR3-1600, 6.4 GB/s each",
    )
    to.add_argument(
        "--machines", nargs="+", default=list(machines), metavar="PRESET", help="to compare"
    )
