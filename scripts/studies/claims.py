"""What the paper (StreamingGS, DAC 2025) claims of its machine, and when that holds of what was
measured here."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from runs.simulations import cycles, joules, mean, mm2, region_bytes, work

Views = Sequence[dict]

REAL_SIZE, SYNTHETIC_SIZE = "980x545", "800x800"
NO_VQ_CGF, NO_VQ, NO_CGF = "_no_vq_cgf", "_no_vq", "_no_cgf"
# Of a preset, and keys over it; FFUs are those of an HFU.
TWICE_CFUS, TWICE_FFUS = "twice the CFUs", "twice the FFUs"
VARIANTS: dict[str, tuple[str, tuple[str, ...]]] = {
    "": ("", ()),
    NO_CGF: (NO_CGF, ()),
    NO_VQ_CGF: (NO_VQ_CGF, ()),
    TWICE_CFUS: ("", ("hfu.cfus=8",)),
    TWICE_FFUS: ("", ("hfu.ffus=2",)),
}


@dataclasses.dataclass(frozen=True)
class Kind:
    """Scenes as the paper sorts them: size of a frame, keys of its machine, and the published frames
    a second of the GPU, of GSCore and of its machine, if the paper has such scenes."""

    name: str
    size: str
    keys: tuple[str, ...]
    rates: tuple[float, float, float] | None = None


REAL = Kind("real", REAL_SIZE, ("storage.voxel_rule=real",), (4.9, 106, 224))
SYNTHETIC = Kind("synthetic", SYNTHETIC_SIZE, ("storage.voxel_rule=synthetic",), (8.5, 184, 388))
OTHER_SCENES = Kind("other", REAL_SIZE, ())


@dataclasses.dataclass(frozen=True)
class SceneFound:
    """What a scene gave, by variant of a point's preset; GSCore, and the GPU as modelled."""

    kind: Kind
    of: Mapping[str, Views]
    other: Views
    gpu: Views

    def speed(self) -> float:
        return mean(self.other, cycles) / mean(self.of[""], cycles)


Found = Sequence[SceneFound]


def geometric(values: Iterator[float]) -> float:
    logarithms = [math.log(value) for value in values]
    return math.exp(math.fsum(logarithms) / len(logarithms))


def over_scenes(of_scene: Callable[[SceneFound], float]) -> Callable[[Found], float]:
    return lambda found: geometric(of_scene(each) for each in found)


def mean_over_scenes(of_scene: Callable[[SceneFound], float]) -> Callable[[Found], float]:
    return lambda found: math.fsum(map(of_scene, found)) / len(found)


def seconds(views: Views) -> float:
    return mean(views, lambda view: view["frame"]["time_s"])


def gain(
    without: str, with_it: str, value: Callable[[dict], float] = cycles
) -> Callable[[Found], float]:
    return over_scenes(lambda s: mean(s.of[without], value) / mean(s.of[with_it], value))


def gpu_seconds(of: SceneFound) -> float:
    return mean(of.gpu, lambda view: view["seconds"])


def gpu_joules(view: dict) -> float:
    return view["joules"]


def halves(views: Views) -> float:
    return mean(views, lambda view: region_bytes(view, "second_halves"))


def less_than_other(value: Callable[[dict], float]) -> Callable[[Found], float]:
    """How many times less than GSCore's."""
    return over_scenes(lambda s: mean(s.other, value) / mean(s.of[""], value))


def joules_as_stated(view: dict) -> float:
    """With clock and leakage in the share of the area that the paper states: our reading of its
    accounting. The other machine's are charged whole."""
    energy = view["energy"]
    of_area = energy["clock_j"] + energy["logic_leakage_j"] + energy["sram_leakage_j"]
    return joules(view) - of_area * (1 - view["config"]["stated_area_mm2"] / mm2(view))


def dropped_percent(view: dict) -> float:
    """By both filters: of the coarse tests of a Gaussian against what an HFU works for, those that
    make no splat."""
    counters = [unit["counters"] for unit in view["units"].values()]
    fine_splats = sum(of["splats"] for of in counters if "fine_tests" in of)
    return 100 * (1 - fine_splats / work(view, "coarse_tests_of_parts"))


@dataclasses.dataclass(frozen=True)
class Claim:
    """low, high: of what is measured, where the claim holds. published: as number or text. kind: of
    the scenes that it is of; None: of all that the paper has the like of. baseline: of what the
    paper compares with, not of its machine. again: the claim before it by another accounting."""

    name: str
    published: float | str
    low: float
    high: float
    measured: Callable[[Found], float]
    kind: Kind | None = None
    baseline: bool = False
    again: bool = False

    def among(self, found: Found) -> Found:
        kinds = (REAL, SYNTHETIC) if self.kind is None else (self.kind,)
        return [each for each in found if each.kind in kinds]

    def holds(self, found: Found) -> bool:
        return self.low <= self.measured(self.among(found)) <= self.high


def within(
    name: str,
    published: float,
    share: float,
    measured: Callable,
    kind: Kind | None = None,
    baseline: bool = False,
) -> Claim:
    low, high = published * (1 - share), published * (1 + share)
    return Claim(name, published, low, high, measured, kind, baseline)


def rate_claims(kind: Kind) -> tuple[Claim, ...]:
    """Bands are wide where the scenes are not the paper's."""
    gpu, other, own = kind.rates
    return (
        within(
            *(f"GPU, frames/s, {kind.name}", gpu, 0.2),
            *(over_scenes(lambda s: 1 / gpu_seconds(s)), kind, True),
        ),
        within(
            *(f"GSCore, frames/s, {kind.name}", other, 0.25),
            *(over_scenes(lambda s: 1 / seconds(s.other)), kind, True),
        ),
        within(
            *(f"frames/s, {kind.name}", own, 0.2),
            *(over_scenes(lambda s: 1 / seconds(s.of[""])), kind),
        ),
    )


CLAIMS = (
    *rate_claims(REAL),
    *rate_claims(SYNTHETIC),
    within("times as fast as GSCore", 2.1, 0.15, over_scenes(SceneFound.speed)),
    within(
        *("times as fast as the GPU", 45.7, 0.2),
        over_scenes(lambda s: gpu_seconds(s) / seconds(s.of[""])),
    ),
    within("times less energy than GSCore", 2.3, 0.25, less_than_other(joules)),
    dataclasses.replace(
        within(
            *("times less energy than GSCore, clock and leakage of the stated area", 2.3, 0.25),
            over_scenes(lambda s: mean(s.other, joules) / mean(s.of[""], joules_as_stated)),
        ),
        again=True,
    ),
    within(
        *("times less energy than the GPU", 62.9, 0.25),
        over_scenes(lambda s: mean(s.gpu, gpu_joules) / mean(s.of[""], joules)),
    ),
    within("gain of the coarse filter", 2.06, 0.15, gain(NO_CGF, "")),
    within("gain of the coarse filter in energy", 2.3, 0.25, gain(NO_CGF, "", joules)),
    Claim("gain of codebooks without it", "about 1", 0.9, 1.1, gain(NO_VQ_CGF, NO_CGF)),
    within("gain of codebooks without it, in energy", 1.27, 0.15, gain(NO_VQ_CGF, NO_CGF, joules)),
    Claim(
        *("fewer bytes of second halves by codebooks, %", 92.3, 90.3, 94.3),
        mean_over_scenes(lambda s: 100 * (1 - halves(s.of[NO_CGF]) / halves(s.of[NO_VQ_CGF]))),
    ),
    Claim(
        *("dropped by both filters, %", 76.3, 71.3, 81.3),
        mean_over_scenes(lambda s: mean(s.of[""], dropped_percent)),
    ),
    within("area, mm2", 5.37, 0.1, lambda found: max(mm2(v) for s in found for v in s.of[""])),
    Claim("gain of 8 CFUs over 4", "more than 1", 1.05, math.inf, gain("", TWICE_CFUS)),
    Claim("gain of 2 FFUs over 1", "1", 0.95, 1.05, gain("", TWICE_FFUS)),
)


def claims_of(found: Found) -> list[Claim]:
    """Those that have a scene."""
    return [claim for claim in CLAIMS if claim.among(found)]
