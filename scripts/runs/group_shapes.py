"""Sizes of pixel groups as scripts write them: 160x120 px, or 64 for 64 px x 64 px."""

from __future__ import annotations

from collections.abc import Sequence

NAME = "group"
KEYS = ("group_width_px", "group_height_px")


def assignments(shape: object) -> tuple[str, ...]:
    """Of both keys. Raises ValueError for what is no shape."""
    sides = str(shape).split("x")
    if len(sides) > 2 or not all(side.isdecimal() for side in sides):
        raise ValueError(f"{NAME}: '{shape}', expected px as in 64 or 160x120")
    return tuple(f"{key}={side}" for key, side in zip(KEYS, (sides[0], sides[-1])))


def expanded(settings: Sequence[str]) -> tuple[str, ...]:
    """With `group=SHAPE` as the two keys of the configuration. Raises ValueError."""
    out: list[str] = []
    for setting in settings:
        key, _, value = setting.partition("=")
        out.extend(assignments(value) if key == NAME else (setting,))
    return tuple(out)


def shape_text(width: object, height: object) -> str:
    return str(width) if width == height else f"{width}x{height}"


def shape_of(config: dict) -> str:
    """Of a resolved configuration."""
    return shape_text(*(config[key] for key in KEYS))


def setting_text(settings: Sequence[str]) -> str:
    """Assignments that go together by the first of them, a group's by its shape."""
    values = dict(setting.split("=", 1) for setting in settings)
    if set(values) == set(KEYS):
        return f"{NAME}={shape_text(*(values[key] for key in KEYS))}"
    return settings[0]
