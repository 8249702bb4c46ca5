"""Study of power at fixed frame rates: a frame, the rest until the next one, and what is known of both."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import statistics
from collections.abc import Iterable, Mapping, Sequence

import tables
from runs import run_arguments
from runs.scenes import find_scenes
from runs.simulations import MJ, Run, simulate_all
from studies.cases import MEMORIES, OTHER, components
from studies.frame_costs import COMPONENT_COLUMNS, joules_at_end, with_band
from tables import SCENE, Column, Study

OURS, OTHERS = "exact", "gscore_lossless_boxes"
RATED_SCENES = ("truck", "playbot", "yard", "park", "platform", "garden")
ALONE = "alone"
GAIN = f"{OTHERS} over {OURS}"
# Whose energy the first screen compares, but for what codebooks or searches made.
PAIRS = (
    ("exact_fast", "gscore_lossless_boxes"),
    ("exact", "gscore_lossless_boxes"),
    ("exact_fp16", "gscore_boxes"),
)
GAIN_COLUMNS = (
    Column("machine / baseline", "presets"),
    Column("energy, baseline over machine", "geometric mean over the scenes", "", ".2f"),
    Column("energy ratio, least", "each source of error at one end everywhere", "", ".2f"),
    Column("energy ratio, most", "likewise", "", ".2f"),
    Column("least of a scene", "the same of the scene that gains least", "", ".2f"),
)


def power_columns(machine: str) -> tuple[Column, ...]:
    return (
        Column(f"{machine} mJ", "of a frame and the rest until the next one", "mJ", ".3f"),
        Column(f"of it rest, {machine}", "share of the rest", "", ".1%"),
        Column(f"{machine} W", "empty: it does not hold this rate", "W", ".3f"),
        Column(f"{machine} W, least", "with the low ends of all sources", "W", ".3f"),
        Column(f"{machine} W, most", "with the high ends", "W", ".3f"),
        Column(f"{machine} W with PHY", "with the memory's PHY and controller", "W", ".3f"),
        Column(f"{machine} W with PHY, least", "with the low ends of all sources", "W", ".3f"),
        Column(f"{machine} W with PHY, most", "with the high ends", "W", ".3f"),
    )


POWER_COLUMNS = (
    SCENE,
    Column("frames/s", "fixed rate; alone: a frame begins when the one before it is done"),
    *(power_columns(OURS) + power_columns(OTHERS)),
    Column(GAIN, "energy of a frame and its rest", "", ".2f"),
    Column(f"{GAIN}, least", "each source of error at one end in both machines", "", ".2f"),
    Column(f"{GAIN}, most", "likewise", "", ".2f"),
    Column(f"{GAIN}, with PHY", "with the memory's PHY and controller in both", "", ".2f"),
    Column(f"{GAIN}, with PHY, least", "these are one more source of error", "", ".2f"),
    Column(f"{GAIN}, with PHY, most", "likewise", "", ".2f"),
)


@dataclasses.dataclass(frozen=True)
class AtRates(Run):
    """With power at fixed rates of frames."""

    rates: tuple[int, ...] = ()

    def arguments(self) -> list[str]:
        return [*super().arguments(), "--frame-rate", ",".join(map(str, self.rates))]


def sources_of_error(view: dict) -> list[tuple[str, ...]]:
    """Keys of energy whose constants are the same in every machine: of lanes and other parts, of
    on-chip memory, of the clock, of leakage, of the DRAM."""
    parts = components(view)
    logic = tuple(k for name, of in parts.items() if name not in (*MEMORIES, *OTHER) for k in of)
    memory = tuple(key for name in MEMORIES for key in parts[name])
    return [logic, memory, *(OTHER[name] for name in ("clock", "leakage", "DRAM"))]


@dataclasses.dataclass(frozen=True)
class Spent:
    """Joules of a frame and its rest at a rate. low, middle, high: of all. sources: at the low and
    the high end of each."""

    rate: float
    rest: float
    low: float
    middle: float
    high: float
    sources: tuple[tuple[float, float], ...]

    def watts(self) -> tuple[float, float, float]:
        return (self.rate * self.middle, self.rate * self.low, self.rate * self.high)


Both = tuple[Spent, Spent]  # without and with PHY and controller of the memory


def spent(view: dict, at_rate: dict | None, rate: float) -> Both:
    """at_rate: an entry of fixed_rates; None where the next frame begins at once."""
    rest = at_rate["rest"] if at_rate else None
    sections = [view["energy"], *([rest] if rest else [])]

    def at(keys: Iterable[str], end: str) -> float:
        return sum(joules_at_end(section, keys, end) for section in sections)

    def with_interface(end: str) -> float:
        if at_rate:
            return at_rate["with_memory_interface_w"][end] / rate
        return view["energy"]["with_memory_interface_j"][end]

    sources = tuple((at(keys, "low"), at(keys, "high")) for keys in sources_of_error(view))
    ends = ("low", "middle", "high")
    without, both = [at(OTHER["all"], end) for end in ends], list(map(with_interface, ends))
    rest_j = rest["total_j"] if rest else 0.0
    interface = (both[0] - without[0], both[2] - without[2])
    return (
        Spent(rate, rest_j, *without, sources),
        Spent(rate, rest_j, *both, (*sources, interface)),
    )


def spent_by_rate(view: dict) -> list[Both | None]:
    """Alone, and at each rate; None where it is not held."""
    held = (spent(view, of, of["per_s"]) if of["held"] else None for of in view["fixed_rates"])
    return [spent(view, None, view["frame"]["fps"]), *held]


def cells(both: Both) -> tuple:
    without, with_interface = both
    share = without.rest / without.middle
    return (without.middle / MJ, share, *without.watts(), *with_interface.watts())


def gains_by_ends(ours: Spent, others: Spent) -> list[float]:
    """The ratio for each choice of an end for each source, in both machines."""
    return [
        sum(of[end] for of, end in zip(others.sources, ends))
        / sum(of[end] for of, end in zip(ours.sources, ends))
        for ends in itertools.product((0, 1), repeat=len(ours.sources))
    ]


def gain_band(ours: Spent, others: Spent) -> tuple[float, float, float]:
    """The ratio, and its ends with each source at one end in both machines."""
    gains = gains_by_ends(ours, others)
    return others.middle / ours.middle, min(gains), max(gains)


def gain_row(pair: tuple[str, str], views: Mapping[str, Sequence[dict]]) -> tuple:
    """views: of each machine, a scene each."""
    alone = [
        [spent(view, None, view["frame"]["fps"])[0] for view in of_scene]
        for of_scene in zip(*(views[machine] for machine in pair))
    ]
    means = list(map(statistics.geometric_mean, zip(*(gains_by_ends(*of) for of in alone))))
    middle, least, _ = zip(*(gain_band(*of) for of in alone))
    mean = statistics.geometric_mean(middle)
    return (" / ".join(pair), mean, min(means), max(means), min(least))


def power_row(scene: str, rate: object, ours: Both | None, others: Both | None) -> tuple:
    empty = (None,) * len(power_columns(""))
    of_machines = [cell for of in (ours, others) for cell in (cells(of) if of else empty)]
    pairs = zip(ours, others) if ours and others else ()
    gains = [cell for pair in pairs for cell in gain_band(*pair)]
    return (scene, rate, *of_machines, *(gains or (None,) * 6))


def add_power_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, " ".join(RATED_SCENES))
    run_arguments.add_side_by_side(to)
    to.add_argument("--view", default="0", help="number of a camera")
    run_arguments.add_size(to, "640x360")
    to.add_argument(
        "--rates", nargs="+", type=int, default=[60, 72, 90, 120], metavar="N", help="frames/s"
    )


def make_power(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--rates", arguments.rates)
    scenes = find_scenes(arguments.scenes or list(RATED_SCENES), arguments.cameras)
    rates = tuple(arguments.rates)
    machines = list(dict.fromkeys(machine for pair in PAIRS for machine in pair))
    runs = [
        AtRates(scene, arguments.view, arguments.size, machine, rates=rates)
        for machine in machines
        for scene in scenes
    ]
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    views = {machine: [next(outcomes).accepted()[0] for _ in scenes] for machine in machines}
    by = tables.made_of(arguments.streaminggs, itertools.chain(*views.values()), scenes)
    about = f"View {arguments.view} at {arguments.size} px."
    rows = [
        (machine, name, scenes[0].name, *with_band(views[machine][0], keys))
        for machine in (OURS, OTHERS)
        for name, keys in components(views[machine][0]).items()
    ]
    tables.write(arguments.out, "frame_waterfall", by, COMPONENT_COLUMNS, rows, about)
    rows = [gain_row(pair, views) for pair in PAIRS]
    tables.write(
        arguments.out, "energy_gain_band", by, GAIN_COLUMNS, rows, f"{about} Frames alone."
    )
    rows, sides, apart = [], 0, 0
    for scene, ours, others in zip(scenes, views[OURS], views[OTHERS]):
        for rate, *both in zip((ALONE, *rates), spent_by_rate(ours), spent_by_rate(others)):
            rows.append(power_row(scene.name, rate, *both))
            if all(both):
                (ours_alone, _), (others_alone, _) = both
                _, least, most = gain_band(ours_alone, others_alone)
                sides += least < 1 < most
                apart += others_alone.low < ours_alone.high
    about += (
        " The memory refreshes itself between frames, at the high ends it is in power-down. "
        f"Within the band {sides} of {len(rows)} rows change sides; were the sources' errors each "
        f"machine's own, {apart} would."
    )
    tables.write(arguments.out, "power_at_rate", by, POWER_COLUMNS, rows, about)


POWER = Study(
    "power",
    f"""Power of {OURS} and {OTHERS} at fixed frame rates, the memory in self-refresh between frames, at the
high ends of all bands in power-down; without and with PHY and controller of the memory. Makes

  frame_waterfall   energy of a frame of the first scene by component
  power_at_rate     watts at each rate, and the gain, by scene
  energy_gain_band  the gain of these and other pairs, frames alone, over the scenes

In the band of the gain a source of error moves both machines: constants of logic, of on-chip memory,
of the clock, of leakage and of the DRAM each stand at one end.
""",
    ("results.py power",),
    add_power_arguments,
    make_power,
)
