"""Numbers that an exploration reads off the reports of a configuration's views: what it makes small
or large, what it requires and what it shows beside.

  MEASURE      PATH or AGGREGATE(PATH)
  AGGREGATE    sum, mean, min, max, or p99: the value that 99 of 100 views are below or at
  PATH         of a number in a view's report.json, such as dram.row_conflicts, or a name of NAMES
  OBJECTIVE    MEASURE, min:MEASURE or max:MEASURE
  REQUIREMENT  MEASURE >= NUMBER or MEASURE <= NUMBER

A PATH alone is the sum over the views, but for what an accelerator has or is (`config`, `sram`,
`area_mm2`), which is as large for each scene as that scene's storage makes it: the largest counts.
worst(PATH) in an objective is the largest of what should be small, the smallest of what should be
large.
"""

from __future__ import annotations

import dataclasses
import math
import re
import statistics
from collections.abc import Callable, Sequence

from runs.simulations import sram_bytes

Views = Sequence[dict]


def filter_lanes(view: dict) -> int:
    """Multiply-accumulate lanes of coarse and fine filters."""
    hfu = view["config"]["hfu"]
    return view["config"]["hfus"] * (hfu["cfus"] * hfu["cfu_lanes"] + hfu["ffu_lanes"])


# Names of what is asked for most, and of what no number of the report says.
NAMES = {
    "fps": "frame.fps",
    "cycles": "frame.cycles",
    "seconds": "frame.time_s",
    "dram_bytes": "dram.bytes",
    "joules": "energy.total_j",
    "watts": "energy.mean_power_w",
    "mm2": "area_mm2.total",
    "psnr_db": "image.psnr_db",
}
COMPUTED: dict[str, Callable[[dict], float]] = {
    "sram_bytes": sram_bytes,
    "filter_lanes": filter_lanes,
}
OF_THE_MACHINE = ("config", "sram", "area_mm2")


def nearest_rank_99(values: Sequence[float]) -> float:
    return sorted(values)[math.ceil(0.99 * len(values)) - 1]


AGGREGATES: dict[str, Callable[[Sequence[float]], float]] = {
    "sum": math.fsum,
    "mean": statistics.fmean,
    "min": min,
    "max": max,
    "p99": nearest_rank_99,
}
WORST = "worst"


def value_at(report: object, path: str) -> object:
    """What the report has at a path; None when there is nothing."""
    for key in path.split("."):
        report = report.get(key) if isinstance(report, dict) else None
    return report


def number_at(view: dict, path: str) -> float:
    """A number of the report; a picture that is equal has PSNR without end. Raises ValueError."""
    if path in COMPUTED:
        return COMPUTED[path](view)
    value = value_at(view, path)
    if value is None and path == NAMES["psnr_db"] and "image" in view:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"report.json has no number at '{path}'")
    return value


@dataclasses.dataclass(frozen=True)
class Measure:
    text: str
    aggregate: str
    path: str

    def of(self, views: Views) -> float:
        """Raises ValueError where the reports have no such number."""
        return AGGREGATES[self.aggregate]([number_at(view, self.path) for view in views])

    def is_of_the_machine(self) -> bool:
        """Whether any frame tells it."""
        return self.path in COMPUTED or self.path.partition(".")[0] in OF_THE_MACHINE


FORM = re.compile(r"\s*(?:([a-z0-9]+)\(\s*([\w.]+)\s*\)|([\w.]+))\s*")


def measure(text: str, worst: str = "") -> Measure:
    """worst: the aggregate that worst() stands for; none where it has no meaning. Raises
    ValueError."""
    found = FORM.fullmatch(text)
    if not found:
        raise ValueError(f"'{text.strip()}', expected PATH or AGGREGATE(PATH)")
    aggregate, inner, alone = found.groups()
    path = NAMES.get(inner or alone, inner or alone)
    if alone:
        machine = path in COMPUTED or path.partition(".")[0] in OF_THE_MACHINE
        aggregate = "max" if machine else "sum"
    elif aggregate == WORST and worst:
        aggregate = worst
    elif aggregate not in AGGREGATES:
        known = ", ".join([*AGGREGATES, *([WORST] if worst else [])])
        raise ValueError(f"'{text.strip()}': {aggregate}, expected one of {known}")
    return Measure(text.strip(), aggregate, path)


@dataclasses.dataclass(frozen=True)
class Objective:
    measure: Measure
    large: bool  # to be made large

    @property
    def name(self) -> str:
        return self.measure.text

    def cost(self, views: Views) -> float:
        """What is to be made small."""
        return -self.measure.of(views) if self.large else self.measure.of(views)


def objective(text: str) -> Objective:
    """Raises ValueError."""
    direction, colon, rest = text.partition(":")
    if colon and direction.strip() not in ("min", "max"):
        raise ValueError(f"--objectives: '{text}', expected min:MEASURE or max:MEASURE")
    large = bool(colon) and direction.strip() == "max"
    try:
        return Objective(measure(rest if colon else text, "min" if large else "max"), large)
    except ValueError as error:
        raise ValueError(f"--objectives: {error}") from error


def shown(text: str) -> tuple[Measure, ...]:
    """Of --show; none of an empty text. Raises ValueError."""
    try:
        return tuple(map(measure, text.split(","))) if text else ()
    except ValueError as error:
        raise ValueError(f"--show: {error}") from error


@dataclasses.dataclass(frozen=True)
class Requirement:
    text: str
    measure: Measure
    least: bool  # a lower bound
    bound: float

    @property
    def name(self) -> str:
        """Of the column with what was measured: it says what was required, too."""
        return f"{self.measure.text} {'>=' if self.least else '<='} {self.bound:g}"

    def violation(self, views: Views) -> float:
        """By how much of the bound it is missed; 0 or less where it holds."""
        value = self.measure.of(views)
        missed = self.bound - value if self.least else value - self.bound
        return missed / abs(self.bound) if self.bound else missed

    def is_lost(self, views: Views) -> bool:
        """Whether no further view can mend it."""
        one_way = ("min",) if self.least else ("max", "sum")
        return self.measure.aggregate in one_way and self.violation(views) > 0


def finite(text: str) -> float:
    """Raises ValueError."""
    try:
        if math.isfinite(value := float(text)):
            return value
    except ValueError:
        pass
    raise ValueError(f"'{text.strip()}', expected a number")


def requirement(text: str) -> Requirement:
    """Raises ValueError."""
    left, relation, right = re.fullmatch(r"(.*?)(>=|<=|$)(.*)", text, re.DOTALL).groups()
    try:
        if not relation:
            raise ValueError(f"'{text}', expected MEASURE >= NUMBER or MEASURE <= NUMBER")
        bound = finite(right)
        return Requirement(text.strip(), measure(left), relation == ">=", bound)
    except ValueError as error:
        raise ValueError(f"--require: {error}") from error


def dominates(a: Sequence[float], b: Sequence[float]) -> bool:
    """a is nowhere worse than b, and somewhere better. Costs, all to be small."""
    return all(x <= y for x, y in zip(a, b)) and any(x < y for x, y in zip(a, b))


def pareto_front(points: Sequence[Sequence[float]]) -> list[bool]:
    """For each point, whether no other one dominates it."""
    return [not any(dominates(other, point) for other in points) for point in points]
