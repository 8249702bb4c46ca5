"""What an exploration may choose from: axes of settings, or a list of configurations, which is one
axis of whole settings."""

from __future__ import annotations

import dataclasses
import itertools
import math
import pathlib
import re
from collections.abc import Iterator, Sequence

from runs.files import read_text
from runs.simulations import GROUP, GROUP_KEYS, expanded
from exploring.axes import EACH, Assignments, Axis, scoped, unscoped

At = tuple[int, ...]  # for each axis the number of its setting
LIST = "point"  # name of the axis that a list of configurations is


@dataclasses.dataclass(frozen=True)
class Space:
    axes: tuple[Axis, ...]

    def assignments(self, at: At) -> Assignments:
        return tuple(s for axis, i in zip(self.axes, at) for s in axis.settings[i])

    def machine(self, at: At) -> Assignments:
        """Where what is chosen for each scene takes least."""
        settings = [a.settings[0 if a.scope else i] for a, i in zip(self.axes, at)]
        return tuple(
            dict.fromkeys(
                unscoped(s) if a.scope else s
                for a, setting in zip(self.axes, settings)
                for s in setting
            )
        )

    def all(self) -> Iterator[At]:
        """The last axis is the fastest."""
        return itertools.product(*(range(len(axis.settings)) for axis in self.axes))

    def size(self) -> int:
        return math.prod(len(axis.settings) for axis in self.axes)

    def keys(self) -> tuple[str, ...]:
        """That its settings have, in their order; a group's two as one."""
        keys = [s.partition("=")[0] for a in self.axes for setting in a.settings for s in setting]
        return tuple(dict.fromkeys(GROUP if key in GROUP_KEYS else key for key in keys))

    def moved(self, at: At, which: int, step: int) -> At | None:
        """Along one axis; None beyond its end."""
        if not 0 <= at[which] + step < len(self.axes[which].settings):
            return None
        return (*at[:which], at[which] + step, *at[which + 1 :])

    def neighbours(self, at: At) -> Iterator[At]:
        """One step on one axis: less first, since settings stand from little to much."""
        for step in (-1, 1):
            for which in range(len(self.axes)):
                if moved := self.moved(at, which, step):
                    yield moved

    def described(self) -> list:
        """For a study that others join: two spaces are one where this is equal."""
        return [[axis.name, [list(setting) for setting in axis.settings]] for axis in self.axes]


def parse_axis(text: str, scopes: Sequence[str] = ()) -> list[Axis]:
    """Of `KEY=V1,V2`, or of `KEY@SCENE=V1,V2`; scopes: what SCENE may be. Raises ValueError."""
    key, equals, values = text.partition("=")
    if not key or not equals or not all(values.split(",")):
        raise ValueError(f"--axis: '{text}', expected KEY=VALUE,VALUE,...")
    key, at, scope = key.partition("@")
    settings = tuple(expanded((f"{key}={value}",)) for value in values.split(","))
    if len(set(settings)) < len(settings):
        raise ValueError(f"--axis: '{text}', expected different values")
    if not at:
        return [Axis(key, settings)]
    return [
        Axis(f"{key}@{one}", tuple(tuple(scoped(s, one) for s in setting) for setting in settings))
        for one in (scopes if scope == EACH else [scope])
    ]


def parse_axes(
    texts: Sequence[str], machine: Sequence[Axis] = (), scopes: Sequence[str] = ()
) -> tuple[Axis, ...]:
    """machine: axes that come before, but for those that a text replaces. Raises ValueError, also
    where two texts set one key: the later would win unseen."""
    own = [axis for text in texts for axis in parse_axis(text, scopes)]
    keys = [key for axis in own for key in keys_of(axis)]
    for key in keys:
        if keys.count(key) > 1 or ("@" in key and key.partition("@")[0] in keys):
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
