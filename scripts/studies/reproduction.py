"""The study that holds the paper's claims (StreamingGS, DAC 2025) against its two presets."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import (
    Run,
    cycles,
    decibels,
    group_assignments,
    joules,
    mean,
    mm2,
    read_config,
)
from studies.cases import model_all
from studies.published import REAL_SIZE, dropped_percent
from tables import PRESET, PSNR, SCENE, Column, Study

TEXT, IDEAL, OTHER = "paper_text", "paper_ideal", "gscore"
NO_VQ_CGF, NO_CGF = "_no_vq_cgf", "_no_cgf"
VARIANTS = ("", NO_CGF, NO_VQ_CGF)
GROUPS = ("64", "80", "96", "128")
CHANNEL_GB_S = 6.4  # of LPDDR3-1600 x32

# What lies between the two presets, in parts: keys by how they begin, the first that fits.
PARTS = {
    "rays, samples and their tables": ("vsu.",),
    "a coarse test a cycle": ("hfu.cfu_",),
    "a fine test a cycle": ("hfu.ffu_",),
    "deep queues": ("hfu.", "sorting.", "memory_port.", "sram.", "rendering.input_fifo_entries"),
    "spans and a second pixel buffer": ("rendering.",),
    "no refresh, codebooks kept": ("dram.", "codebook."),
}

Views = Sequence[dict]


@dataclasses.dataclass(frozen=True)
class Point:
    """A machine that is held against the claims."""

    preset: str
    group: str
    channels: int

    def cells(self) -> tuple:
        return self.preset, self.group, self.channels * CHANNEL_GB_S


@dataclasses.dataclass(frozen=True)
class SceneFound:
    """What a scene gave, by variant of a point's preset. gpu: seconds of its frame."""

    of: Mapping[str, Views]
    other: Views
    gpu: float

    def speed(self) -> float:
        return mean(self.other, cycles) / mean(self.of[""], cycles)


Found = Sequence[SceneFound]


def geometric(values: Iterator[float]) -> float:
    logarithms = [math.log(value) for value in values]
    return math.exp(math.fsum(logarithms) / len(logarithms))


def over_scenes(of_scene: Callable[[SceneFound], float]) -> Callable[[Found], float]:
    return lambda found: geometric(of_scene(each) for each in found)


def seconds(views: Views) -> float:
    return mean(views, lambda view: view["frame"]["time_s"])


def gain(slower: str, faster: str) -> Callable[[Found], float]:
    return over_scenes(lambda s: mean(s.of[slower], cycles) / mean(s.of[faster], cycles))


@dataclasses.dataclass(frozen=True)
class Claim:
    """low, high: of what is measured, where the claim holds."""

    name: str
    published: float
    low: float
    high: float
    measured: Callable[[Found], float]

    def holds(self, found: Found) -> bool:
        return self.low <= self.measured(found) <= self.high


def within(name: str, published: float, share: float, measured: Callable) -> Claim:
    return Claim(name, published, published * (1 - share), published * (1 + share), measured)


# Rates are those of its real scenes. Bands are wide where the scenes are not the paper's.
CLAIMS = (
    within("GPU, frames/s", 4.9, 0.2, over_scenes(lambda s: 1 / s.gpu)),
    within("GSCore, frames/s", 106, 0.25, over_scenes(lambda s: 1 / seconds(s.other))),
    within("frames/s", 224, 0.2, over_scenes(lambda s: 1 / seconds(s.of[""]))),
    within("times as fast as GSCore", 2.1, 0.15, over_scenes(SceneFound.speed)),
    within("times as fast as the GPU", 45.7, 0.2, over_scenes(lambda s: s.gpu / seconds(s.of[""]))),
    within(
        *("times less energy than GSCore", 2.3, 0.25),
        over_scenes(lambda s: mean(s.other, joules) / mean(s.of[""], joules)),
    ),
    within("gain of the coarse filter", 2.06, 0.15, gain(NO_CGF, "")),
    Claim("gain of codebooks without it", 1.0, 0.9, 1.1, gain(NO_VQ_CGF, NO_CGF)),
    Claim(
        *("dropped by both filters, %", 76.3, 71.3, 81.3),
        lambda found: math.fsum(mean(s.of[""], dropped_percent) for s in found) / len(found),
    ),
)

POINT = (
    PRESET,
    Column("group px", "side of a pixel group", "px"),
    Column("GB/s", "peak of the memory, of all machines", "GB/s", ".1f"),
)
CLAIM_COLUMNS = (
    Column("claim", "of the paper; means over the scenes, geometric but for percentages"),
    Column("published", "by the paper"),
    Column("least", "that passes", "", ".3g"),
    Column("most", "that passes", "", ".3g"),
    *POINT,
    Column("measured", "of the scenes here", "", ".3g"),
    Column("passes", "measured lies between least and most"),
    Column("dB, least", "PSNR of the preset's worst view", "dB", ".1f"),
    Column("GSCore's dB, least", "PSNR of its worst view", "dB", ".1f"),
)
SERVES_COLUMNS = (
    *POINT,
    Column("pass", "claims that pass with this one machine", "", "d"),
    Column("of", "claims in all", "", "d"),
    Column("fail", "the others"),
    Column("mm2", "area of the machine, the largest of the views", "mm2", ".2f"),
)
SCENE_COLUMNS = (
    SCENE,
    *POINT,
    Column("frames/s", "mean over the views", "1/s", ".1f"),
    Column("times as fast", "as GSCore", "", ".2f"),
    Column("times less energy", "than GSCore", "", ".2f"),
    PSNR,
    Column("GSCore's dB", "PSNR of its worst view", "dB", ".2f"),
)
WATERFALL_COLUMNS = (
    Column("order", "from the ideal to the text, each part taken away; or the parts reversed"),
    Column("step", "what is taken away"),
    Column("times as fast as GSCore", "with what is left", "", ".2f"),
    Column("factor", "of the step before over this one", "", ".3f"),
    Column("dB, least", "PSNR of the worst view", "dB", ".1f"),
)


def worst_db(found: Found, views_of: Callable[[SceneFound], Views]) -> float:
    return min(decibels(view) for each in found for view in views_of(each))


def claim_rows(point: Point, found: Found) -> list[tuple]:
    pictures = worst_db(found, lambda s: s.of[""]), worst_db(found, lambda s: s.other)
    return [
        (
            *(claim.name, claim.published, claim.low, claim.high, *point.cells()),
            *(claim.measured(found), "yes" if claim.holds(found) else "no", *pictures),
        )
        for claim in CLAIMS
    ]


def serves_row(point: Point, found: Found) -> tuple:
    fail = [claim.name for claim in CLAIMS if not claim.holds(found)]
    area = max(mm2(view) for each in found for view in each.of[""])
    passed = len(CLAIMS) - len(fail)
    return (*point.cells(), passed, len(CLAIMS), "; ".join(fail), area)


def scene_rows(point: Point, scenes: Sequence[Scene], found: Found) -> list[tuple]:
    return [
        (
            *(scene.name, *point.cells(), 1 / seconds(s.of[""]), s.speed()),
            mean(s.other, joules) / mean(s.of[""], joules),
            *(min(map(decibels, s.of[""])), min(map(decibels, s.other))),
        )
        for scene, s in zip(scenes, found)
    ]


def flat(config: Mapping, path: str = "") -> dict[str, object]:
    """Values of a configuration by their paths."""
    out: dict[str, object] = {}
    for key, value in config.items():
        if isinstance(value, Mapping):
            out |= flat(value, f"{path}{key}.")
        else:
            out[f"{path}{key}"] = value
    return out


def part_of(key: str) -> str:
    """Raises ValueError for a key of no part."""
    for part, beginnings in PARTS.items():
        if key.startswith(beginnings):
            return part
    raise ValueError(
        f"{key}: differs between {TEXT} and {IDEAL}, expected it in {', '.join(PARTS)}"
    )


def settings_by_part(text: Mapping, ideal: Mapping) -> dict[str, tuple[str, ...]]:
    """Assignments that take each part of the ideal back to the text."""
    of_text, of_ideal = flat(text), flat(ideal)
    out: dict[str, list[str]] = {part: [] for part in PARTS}
    for key, value in of_text.items():
        if of_ideal[key] == value:
            continue
        shown = str(value).lower() if isinstance(value, bool) else str(value)
        out[part_of(key)].append(f"{key}={shown}")
    return {part: tuple(settings) for part, settings in out.items()}


def waterfall_orders(by_part: Mapping[str, tuple[str, ...]]) -> Iterator[tuple[str, list]]:
    """Name of an order; of each step its name and all settings up to it."""
    for order, parts in (("forwards", list(by_part)), ("backwards", list(by_part)[::-1])):
        gone = list(itertools.accumulate((by_part[part] for part in parts), lambda a, b: a + b))
        yield order, [("all assumptions", ()), *zip(parts, gone)]


def waterfall_rows(order: str, steps: Sequence[tuple[str, float, float]]) -> list[tuple]:
    """steps: name, speed over GSCore, dB. The last row closes the sum."""
    rows, before = [], None
    for name, speed, db in steps:
        rows.append((order, name, speed, before / speed if before else None, db))
        before = speed
    return rows


def add_reproduction_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "all real scenes")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, REAL_SIZE)
    to.add_argument("--groups", nargs="+", default=list(GROUPS), metavar="PX", help="sides")
    to.add_argument(
        "--channels", nargs="+", type=int, default=[4, 8], metavar="N", help="of memory"
    )
    to.add_argument("--waterfall-group", default="96", metavar="PX", help="of the waterfall")


def settings_of(group: str, channels: int) -> tuple[str, ...]:
    return (*group_assignments(group), f"dram.channels={channels}")


def make_reproduction(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or shared_names(), arguments.cameras)
    base = [Run(scene, arguments.view, arguments.size) for scene in scenes]
    memory = [f"dram.channels={channels}" for channels in arguments.channels]
    points = [
        Point(*each)
        for each in itertools.product((TEXT, IDEAL), arguments.groups, arguments.channels)
    ]
    text, ideal = (
        read_config(arguments.streaminggs, dataclasses.replace(base[0], config=preset))
        for preset in (TEXT, IDEAL)
    )
    orders = list(waterfall_orders(settings_by_part(text, ideal)))
    at = settings_of(arguments.waterfall_group, arguments.channels[0])

    def runs_of(run: Run) -> dict[object, Run]:
        """Of a scene, by what they are of."""
        runs: dict[object, Run] = {
            channels: dataclasses.replace(run, config=OTHER, overrides=(of,))
            for channels, of in zip(arguments.channels, memory)
        }
        for point, variant in itertools.product(points, VARIANTS):
            over = settings_of(point.group, point.channels)
            runs[point, variant] = dataclasses.replace(
                run, config=point.preset + variant, overrides=over
            )
        for order, steps in orders:
            for step, gone in steps:
                runs[order, step] = dataclasses.replace(run, config=IDEAL, overrides=(*at, *gone))
        return runs

    by_scene = [runs_of(run) for run in base]
    asked = list(dict.fromkeys(run for of in by_scene for run in of.values()))
    views = {
        run: outcome.accepted()
        for run, outcome in zip(asked, swept(arguments, "reproduction", asked))
    }
    gpu = [mean(each, lambda view: view["seconds"]) for each in model_all(arguments, base)]

    def found_at(point: Point) -> Found:
        return [
            SceneFound(
                {variant: views[runs[point, variant]] for variant in VARIANTS},
                views[runs[point.channels]],
                of_gpu,
            )
            for runs, of_gpu in zip(by_scene, gpu)
        ]

    def steps_of(order: str, names: Sequence[str]) -> Iterator[tuple[str, float, float]]:
        for name in names:
            found = [
                SceneFound(
                    {"": views[runs[order, name]]}, views[runs[arguments.channels[0]]], of_gpu
                )
                for runs, of_gpu in zip(by_scene, gpu)
            ]
            yield name, geometric(s.speed() for s in found), worst_db(found, lambda s: s.of[""])

    by = tables.made_of(
        arguments.streaminggs, (view for of in views.values() for view in of), scenes
    )
    found = {point: found_at(point) for point in points}
    out = arguments.out
    rows = [row for point, of in found.items() for row in claim_rows(point, of)]
    tables.write(out, "reproduction_claims", by, CLAIM_COLUMNS, rows)
    rows = [serves_row(point, of) for point, of in found.items()]
    tables.write(out, "reproduction", by, SERVES_COLUMNS, rows, ABOUT)
    rows = [row for point, of in found.items() for row in scene_rows(point, scenes, of)]
    tables.write(out, "reproduction_scenes", by, SCENE_COLUMNS, rows)
    rows = [
        row
        for order, steps in orders
        for row in waterfall_rows(order, list(steps_of(order, [name for name, _ in steps])))
    ]
    tables.write(out, "reproduction_waterfall", by, WATERFALL_COLUMNS, rows)


ABOUT = (
    "It is a reproduction only where one machine passes all claims: one preset, one group, one "
    "memory. The scenes are not the paper's."
)

REPRODUCTION = Study(
    "reproduction",
    """The paper's claims (StreamingGS, DAC 2025) beside what its two presets give: `paper_text`, the
most faithful reading, and `paper_ideal`, with the assumptions under which its numbers come out. GPU
(modelled) and GSCore first, then both presets and their variants by group and memory. Makes

  reproduction            how many claims pass with one preset, group and memory, and which fail
  reproduction_claims     each claim: published, band, measured, passes or not, with its dB
  reproduction_scenes     rate, speed, energy and dB by scene
  reproduction_waterfall  from the ideal to the text, part by part, in two orders
""",
    ("results.py reproduction truck playbot platform yard garden park",),
    add_reproduction_arguments,
    make_reproduction,
)
