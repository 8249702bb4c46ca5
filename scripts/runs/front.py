"""Which of several configurations no other one beats."""

from __future__ import annotations

from collections.abc import Sequence


def dominates(a: Sequence[float], b: Sequence[float]) -> bool:
    """a is nowhere worse than b, and somewhere better. Costs, all to be small."""
    return all(x <= y for x, y in zip(a, b)) and any(x < y for x, y in zip(a, b))


def pareto_front(points: Sequence[Sequence[float]]) -> list[bool]:
    """For each point, whether no other one dominates it."""
    return [not any(dominates(other, point) for other in points) for point in points]
