"""Which of several configurations no other one beats: in all costs, and in the picture where their
pictures differ."""

from __future__ import annotations

import math
from collections.abc import Sequence

ALIKE_DB = 0.1  # pictures that are nearer to each other count as one


def dominates(a: Sequence[float], b: Sequence[float]) -> bool:
    """a is nowhere worse than b, and somewhere better. Costs, all to be small."""
    return all(x <= y for x, y in zip(a, b)) and any(x < y for x, y in zip(a, b))


def pareto_front(points: Sequence[Sequence[float]]) -> list[bool]:
    """For each point, whether no other one dominates it."""
    return [not any(dominates(other, point) for other in points) for point in points]


def pictures_differ(psnr_db: Sequence[float]) -> bool:
    """Infinite PSNR is that of an equal picture; NaN that of one that nobody measured."""
    known = [value for value in psnr_db if not math.isnan(value)]
    return bool(known) and max(known) > min(known) and max(known) - min(known) >= ALIKE_DB


def with_pictures(
    points: Sequence[Sequence[float]], psnr_db: Sequence[float]
) -> list[tuple[float, ...]]:
    """The costs of each point and, where pictures differ, what its picture loses, in steps of
    ALIKE_DB."""
    if not pictures_differ(psnr_db):
        return [tuple(point) for point in points]
    return [(*point, lost(value)) for point, value in zip(points, psnr_db)]


def lost(psnr_db: float) -> float:
    """To be small. A picture that nobody measured is the worst."""
    if math.isnan(psnr_db):
        return math.inf
    return -psnr_db if math.isinf(psnr_db) else -math.floor(psnr_db / ALIKE_DB)
