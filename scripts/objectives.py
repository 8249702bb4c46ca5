"""What an exploration makes small, and which configurations no other one beats in all of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from simulations import sram_bytes

Objectives = Sequence[float]


def filter_lanes(view: dict) -> int:
    """Multiply-accumulate lanes of coarse and fine filters."""
    hfu = view["config"]["hfu"]
    return view["config"]["hfus"] * (hfu["cfus"] * hfu["cfu_lanes"] + hfu["ffu_lanes"])


# Counts add up over views; what a configuration costs does not.
COUNTS: dict[str, Callable[[dict], float]] = {
    "cycles": lambda view: view["frame"]["cycles"],
    "dram_bytes": lambda view: view["dram"]["bytes"],
}
COSTS: dict[str, Callable[[dict], float]] = {
    "sram_bytes": sram_bytes,
    "filter_lanes": filter_lanes,
}
COST_SECTIONS = ("config", "sram", "area_mm2")


def value_at(report: object, path: str) -> object:
    """What the report has at a path; None when there is nothing."""
    for key in path.split("."):
        report = report.get(key) if isinstance(report, dict) else None
    return report


def report_number(view: dict, path: str) -> float:
    """A number of the report. Raises ValueError when there is none at the path."""
    value = value_at(view, path)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"--objectives: report.json has no number at '{path}'")
    return value


def objective(name: str, views: Sequence[dict]) -> float:
    if name in COSTS:
        return COSTS[name](views[0])
    if name.partition(".")[0] in COST_SECTIONS:
        return report_number(views[0], name)
    count = COUNTS.get(name, lambda view: report_number(view, name))
    return sum(count(view) for view in views)


def dominates(a: Objectives, b: Objectives) -> bool:
    """a is nowhere worse than b, and somewhere better."""
    return all(x <= y for x, y in zip(a, b)) and any(x < y for x, y in zip(a, b))


def pareto_front(points: Sequence[Objectives]) -> list[bool]:
    """For each point, whether no other one dominates it."""
    return [not any(dominates(other, point) for other in points) for point in points]
