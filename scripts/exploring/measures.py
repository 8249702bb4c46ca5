"""Numbers that an exploration reads off the reports of a configuration's views: what it makes small
or large (--objectives), what it requires (--require) and what it shows beside, by which nothing is
judged (--show).

  MEASURE      PATH or AGGREGATE(PATH)
  AGGREGATE    sum, mean, min, max, p99: the value that 99 of 100 views are below or at; geomean:
               the geometric mean over the scenes of the means over their views
  PATH         of a number in a view's report.json, such as dram.row_conflicts, or one of the names
               fps, cycles, seconds, dram_bytes, joules, watts, mm2, mm2_high (the upper end of its
               band), mm2_with_phy, psnr_db; sram_bytes; filter_lanes, the multiply-accumulate lanes
               of coarse and fine filters; joules_mean is mean(joules)
  OBJECTIVE    MEASURE, min:MEASURE or max:MEASURE
  REQUIREMENT  MEASURE >= BOUND or MEASURE <= BOUND; each(PATH): the mean over the views of each
               scene
  BOUND        NUMBER, or so many times what a preset or file comes to on the same views, and some
               more or less: NUMBER x CONFIG, NUMBER x CONFIG - NUMBER

A PATH alone is the sum over the views, and is shown as `sum(PATH)`, but for what an accelerator has
or is (`config`, `sram`, `area_mm2`), which is as large for each scene as that scene's storage makes
it: the largest counts. Rates and ratios (fps, watts, psnr_db) have no sum: an aggregate is needed.
worst(PATH) in an objective is the largest of what should be small, the smallest of what should be
large.
"""

from __future__ import annotations

import dataclasses
import math
import re
import statistics
from collections.abc import Callable, Mapping, Sequence

from runs.simulations import check_memory_known, sram_bytes, value_at

Views = Sequence[dict]


def filter_lanes(view: dict) -> int:
    """Multiply-accumulate lanes of coarse and fine filters."""
    hfu = view["config"]["hfu"]
    return view["config"]["hfus"] * (hfu["cfus"] * hfu["cfu_lanes"] + hfu["ffu_lanes"])


AREA_BAND = "area_mm2.bands.total"  # low, middle and high, by the sources
# Names of what is asked for most, and of what no number of the report says.
NAMES = {
    "fps": "frame.fps",
    "cycles": "frame.cycles",
    "seconds": "frame.time_s",
    "dram_bytes": "dram.bytes",
    "joules": "energy.total_j",
    "watts": "energy.mean_power_w",
    "mm2": "area_mm2.total",
    "mm2_high": f"{AREA_BAND}.high",
    "mm2_with_phy": "area_mm2.with_memory_interface.middle",
    "psnr_db": "image.psnr_db",
}
# Names of whole measures: their aggregate and path.
WHOLE = {"joules_mean": ("mean", NAMES["joules"])}
# A sum of these says nothing.
WITHOUT_SUM = ("fps", "watts", "psnr_db")
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
GEOMEAN, EACH, WORST = "geomean", "each", "worst"


def number_at(view: dict, path: str) -> float:
    """A number of the report; a picture that is equal has PSNR without end. Raises ValueError."""
    if path in COMPUTED:
        return computed(view, path)
    if path.startswith("energy."):
        check_memory_known(view)
    value = value_at(view, path)
    if value is None and path == NAMES["psnr_db"] and "image" in view:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"report.json has no number at '{path}'")
    return value


def computed(view: dict, name: str) -> float:
    """Raises ValueError where the machine has no such parts."""
    try:
        return COMPUTED[name](view)
    except KeyError as error:
        raise ValueError(f"report.json has nothing to count '{name}' of") from error


# What a frame has here depends on what it draws.
OF_THE_FRAME = ("dram.bytes_by_region.", "dram.bus_bytes_by_region.")


def check_there(view: dict, path: str) -> None:
    """Raises ValueError where reports have no number there; this one may have none yet (null)."""
    if path in COMPUTED:
        computed(view, path)
        return
    value: object = view
    for key in path.split("."):
        if not isinstance(value, dict) or key not in value:
            break
        value = value[key]
    else:
        if value is None or isinstance(value, (int, float)) and not isinstance(value, bool):
            return
    if not path.startswith(OF_THE_FRAME):
        known = ", ".join([*NAMES, *COMPUTED, *WHOLE])
        raise ValueError(f"got {path}, expected a number's path in report.json, or one of {known}")


def by_scene(views: Views) -> dict[str, list[dict]]:
    found: dict[str, list[dict]] = {}
    for view in views:
        found.setdefault(view["scene_name"], []).append(view)
    return found


@dataclasses.dataclass(frozen=True)
class Measure:
    text: str
    aggregate: str
    path: str

    def of(self, views: Views) -> float:
        """Raises ValueError where the reports have no such number."""
        if self.aggregate == GEOMEAN:
            return statistics.geometric_mean(self.of_scenes(views).values())
        return AGGREGATES[self.aggregate]([number_at(view, self.path) for view in views])

    def of_scenes(self, views: Views) -> dict[str, float]:
        return {
            scene: statistics.fmean(number_at(view, self.path) for view in of_scene)
            for scene, of_scene in by_scene(views).items()
        }

    def is_by_its_path(self) -> bool:
        """Whether a report has to be asked that there is such a number."""
        return self.path not in NAMES.values() and self.path != "sram_bytes"

    def is_of_the_machine(self) -> bool:
        """Whether any frame tells it."""
        return self.path in COMPUTED or self.path.partition(".")[0] in OF_THE_MACHINE


FORM = re.compile(r"\s*(?:([a-z0-9]+)\(\s*([\w.]+)\s*\)|([\w.]+))\s*")


def measure(text: str, more: Mapping[str, str] = {}) -> Measure:
    """more: aggregates by names that have a meaning only where it stands. Its text says what is
    taken of the views. Raises ValueError."""
    found = FORM.fullmatch(text)
    if not found:
        raise ValueError(f"'{text.strip()}', expected PATH or AGGREGATE(PATH)")
    aggregate, inner, alone = found.groups()
    path = NAMES.get(inner or alone, inner or alone)
    if alone in WHOLE:
        return Measure(alone, *WHOLE[alone])
    if alone:
        if path in COMPUTED or path.partition(".")[0] in OF_THE_MACHINE:
            return Measure(alone, "max", path)
        for name in WITHOUT_SUM:
            if path == NAMES[name]:
                expected = f"min({alone}), mean({alone}) or max({alone})"
                raise ValueError(f"'{alone}': its sum over views says nothing, expected {expected}")
        return Measure(f"sum({alone})", "sum", path)
    if aggregate in more:
        aggregate = more[aggregate]
    elif aggregate not in AGGREGATES and aggregate != GEOMEAN:
        known = ", ".join([*AGGREGATES, GEOMEAN, *more])
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

    def worse(self, views: Views, than: Views) -> float:
        """The logarithm of how many times worse it is; of values that have none the difference."""
        a, b = self.cost(views), self.cost(than)
        return math.copysign(math.log(a / b), a - b) if a * b > 0 else a - b


def objective(text: str) -> Objective:
    """Raises ValueError."""
    direction, colon, rest = text.partition(":")
    if colon and direction.strip() not in ("min", "max"):
        raise ValueError(f"--objectives: '{text}', expected min:MEASURE or max:MEASURE")
    large = bool(colon) and direction.strip() == "max"
    try:
        return Objective(
            measure(rest if colon else text, {WORST: "min" if large else "max"}), large
        )
    except ValueError as error:
        raise ValueError(f"--objectives: {error}") from error


def shown(text: str) -> tuple[Measure, ...]:
    """Of --show; none of an empty text. Raises ValueError."""
    try:
        return tuple(map(measure, text.split(","))) if text else ()
    except ValueError as error:
        raise ValueError(f"--show: {error}") from error


# By how a path begins: what misses an upper bound, and what misses a lower one.
MISSED = {
    "frame.fps": ("too fast", "too slow"),
    "frame.": ("too slow", "too fast"),
    "area_mm2": ("too large", "too small"),
    "sram": ("too large", "too small"),
    NAMES["psnr_db"]: ("too good a picture", "too bad a picture"),
}


@dataclasses.dataclass(frozen=True)
class Requirement:
    """reference: the configuration that the bound is relative to; by_view: what that comes to,
    where each scene has a bound of its own."""

    text: str
    measure: Measure
    least: bool  # a lower bound
    bound: float
    reference: str = ""
    times: float = 1
    by_view: Mapping[tuple[str, int], float] = dataclasses.field(default_factory=dict)

    @property
    def name(self) -> str:
        """Of the column with what was measured: it says what was required, too."""
        if self.by_view:
            return self.text
        return f"{self.measure.text} {'>=' if self.least else '<='} {self.bound:g}"

    def relative_to(self, views: Views) -> Requirement:
        """With its bound, by what the reference came to."""
        if self.measure.aggregate == EACH:
            path = self.measure.path
            found = {(v["scene_name"], v["view"]): number_at(v, path) for v in views}
            return dataclasses.replace(self, by_view=found)
        bound = self.times * self.measure.of(views) + self.bound
        return dataclasses.replace(self, bound=bound)

    def pairs(self, views: Views) -> list[tuple[float, float]]:
        """What was measured and what it is to keep to, of each scene where each is asked for."""
        if self.measure.aggregate != EACH:
            return [(self.measure.of(views), self.bound)]
        measured = self.measure.of_scenes(views)
        bounds = dict.fromkeys(measured, self.bound)
        if self.by_view:
            for scene, of_scene in by_scene(views).items():
                of_views = [self.by_view[scene, view["view"]] for view in of_scene]
                bounds[scene] = self.times * statistics.fmean(of_views) + self.bound
        return [(measured[scene], bounds[scene]) for scene in measured]

    def missed(self, value: float, bound: float) -> float:
        """By how much of the bound; 0 or less where it holds."""
        if value == bound:
            return 0
        missed = bound - value if self.least else value - bound
        return missed / abs(bound) if bound and math.isfinite(bound) else missed

    def missed_in_words(self) -> str:
        """What a configuration is that misses it."""
        for start, words in MISSED.items():
            if self.measure.path.startswith(start):
                return words[self.least]
        return "too little" if self.least else "too much"

    def worst(self, views: Views) -> tuple[float, float]:
        return max(self.pairs(views), key=lambda pair: self.missed(*pair))

    def value(self, views: Views) -> float:
        return self.worst(views)[0]

    def violation(self, views: Views) -> float:
        return self.missed(*self.worst(views))

    def room(self, views: Views) -> float:
        """What is left until it is missed, as the logarithm of a ratio where there is one."""
        value, bound = self.worst(views)
        if value == bound or value * bound <= 0 or math.isinf(bound):
            return -self.missed(value, bound)
        ratio = math.log(abs(value / bound))
        return ratio if self.least == (bound > 0) else -ratio

    def is_of_single_views(self) -> bool:
        """Whether it holds for several views where it holds for each of them."""
        return self.measure.aggregate == ("min" if self.least else "max")

    def is_a_rate(self) -> bool:
        """Whether it asks of every view so many frames a second, one at least."""
        asked = (self.measure.aggregate, self.measure.path)
        return asked == ("min", NAMES["fps"]) and self.least and self.bound >= 1

    def is_lost(self, views: Views) -> bool:
        """Whether no further view can mend it; of each scene's mean all views are there."""
        one_way = ("min", EACH) if self.least else ("max", "sum", EACH)
        return self.measure.aggregate in one_way and self.violation(views) > 0


def number(text: str) -> float:
    """Raises ValueError."""
    if math.isfinite(value := float(text)):
        return value
    raise ValueError


RELATIVE = re.compile(r"(\S+)\s+x\s+(\S+)(?:\s+([+-])\s+(\S+))?")


def bound_of(text: str) -> dict[str, object]:
    """Raises ValueError."""
    text = text.strip()
    try:
        if not (found := RELATIVE.fullmatch(text)):
            return {"bound": number(text)}
        times, reference, sign, more = found.groups()
        bound = number(f"{sign or ''}{more or 0}")
        return {"bound": bound, "reference": reference, "times": number(times)}
    except ValueError as error:
        expected = "a number, or one x CONFIG, also + or - another one"
        raise ValueError(f"'{text}', expected {expected}") from error


def requirement(text: str) -> Requirement:
    """Raises ValueError."""
    left, relation, right = re.fullmatch(r"(.*?)(>=|<=|$)(.*)", text, re.DOTALL).groups()
    try:
        if not relation:
            raise ValueError(f"'{text}', expected MEASURE >= NUMBER or MEASURE <= NUMBER")
        of = measure(left, {EACH: EACH})
        return Requirement(text.strip(), of, relation == ">=", **bound_of(right))
    except ValueError as error:
        raise ValueError(f"--require: {error}") from error
