"""What an exploration may choose from: axes of settings, or a list of configurations, which is one
axis of whole settings."""

from __future__ import annotations

import dataclasses
import itertools
import math
import pathlib
import re
from collections.abc import Iterator, Sequence

from runs.given_files import read_text
from runs.group_shapes import KEYS, NAME, expanded
from machine_axes import Assignments, Axis

At = tuple[int, ...]  # for each axis the number of its setting
LIST = "point"  # name of the axis that a list of configurations is


@dataclasses.dataclass(frozen=True)
class Space:
    axes: tuple[Axis, ...]

    def assignments(self, at: At) -> Assignments:
        return tuple(s for axis, i in zip(self.axes, at) for s in axis.settings[i])

    def all(self) -> Iterator[At]:
        """The last axis is the fastest."""
        return itertools.product(*(range(len(axis.settings)) for axis in self.axes))

    def size(self) -> int:
        return math.prod(len(axis.settings) for axis in self.axes)

    def keys(self) -> tuple[str, ...]:
        """That its settings have, in their order; a group's two as one."""
        keys = [s.partition("=")[0] for a in self.axes for setting in a.settings for s in setting]
        return tuple(dict.fromkeys(NAME if key in KEYS else key for key in keys))

    def neighbours(self, at: At) -> Iterator[At]:
        """One step on one axis: less first, since settings stand from little to much."""
        for step in (-1, 1):
            for which, axis in enumerate(self.axes):
                if 0 <= at[which] + step < len(axis.settings):
                    yield (*at[:which], at[which] + step, *at[which + 1 :])

    def described(self) -> list:
        """For a study that others join: two spaces are one where this is equal."""
        return [[axis.name, [list(setting) for setting in axis.settings]] for axis in self.axes]


def parse_axis(text: str) -> Axis:
    """Of `KEY=V1,V2`. Raises ValueError."""
    key, equals, values = text.partition("=")
    if not key or not equals or not all(values.split(",")):
        raise ValueError(f"--axis: '{text}', expected KEY=VALUE,VALUE,...")
    settings = tuple(expanded((f"{key}={value}",)) for value in values.split(","))
    if len(set(settings)) < len(settings):
        raise ValueError(f"--axis: '{text}', expected different values")
    return Axis(key, settings)


def parse_axes(texts: Sequence[str], machine: Sequence[Axis] = ()) -> tuple[Axis, ...]:
    """machine: axes that come before, but for those that a text replaces. Raises ValueError, also
    where two texts set one key: the later would win unseen."""
    own = [parse_axis(text) for text in texts]
    keys = [key for axis in own for key in keys_of(axis)]
    for key in keys:
        if keys.count(key) > 1:
            raise ValueError(f"--axis: {key}: there are two")
    return (*(axis for axis in machine if not set(keys_of(axis)) & set(keys)), *own)


def keys_of(axis: Axis) -> list[str]:
    return [s.partition("=")[0] for s in axis.settings[0]]


def parse_point(text: str, place: str) -> Assignments:
    """Of `KEY=VALUE KEY=VALUE ...`. Raises ValueError."""
    for assignment in text.split():
        if "=" not in assignment:
            raise ValueError(f"{place}: '{assignment}', expected KEY=VALUE")
    return expanded(text.split())


def parse_named(text: str, number: int, place: str) -> tuple[str, Assignments]:
    """Of `NAME: KEY=VALUE ...`, where the name may be left out. number: which one of several it is.
    Raises ValueError."""
    name, point = re.fullmatch(r"(?:([^=:]+):(?:\s|$))?(.*)", text, re.DOTALL).groups()
    return (name or f"beside {number}").strip(), parse_point(point, place)


def read_points(path: pathlib.Path) -> tuple[Axis, ...]:
    """Configurations of a file, one a line; `#` begins a comment. Raises ValueError."""
    points: list[Assignments] = []
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if assignments := parse_point(line.partition("#")[0], f"{path}:{number}"):
            points.append(assignments)
    if not points:
        raise ValueError(f"{path}: no configurations, expected KEY=VALUE ... on each line")
    return (Axis(LIST, tuple(points)),)
