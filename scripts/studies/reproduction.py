"""The study that holds the paper's claims (StreamingGS, DAC 2025) against its two presets."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import Scene, answered, find_scenes
from runs.simulations import (
    MJ,
    Run,
    asked_mb,
    cycles,
    decibels,
    group_assignments,
    joules,
    mean,
    mm2,
    read_config,
)
from studies.cases import check_channels, model_all
from studies.claims import (
    NO_CGF,
    NO_VQ,
    NO_VQ_CGF,
    OTHER_SCENES,
    REAL,
    SYNTHETIC,
    VARIANTS,
    Found,
    Kind,
    SceneFound,
    Views,
    claims_of,
    geometric,
    seconds,
)
from studies.synthetic import add_synthetic, synthetic_scenes
from tables import PRESET, PSNR, SCENE, SIZE, Column, Study

TEXT, IDEAL, OTHER = "paper_text", "paper_ideal", "gscore"
CFUS, FFUS = ("1", "2", "4", "8"), ("1", "2", "4")  # of the map, each in an HFU
GROUPS = ("64", "80", "96", "128")
CAPTURE = "builtin:capture?n=2000000"  # whose statistics the study matched_scenes accepts
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


@dataclasses.dataclass(frozen=True)
class Point:
    """A machine that is held against the claims."""

    preset: str
    group: str
    channels: int

    def cells(self) -> tuple:
        return self.preset, self.group, self.channels * CHANNEL_GB_S


POINT = (
    PRESET,
    Column("group px", "side of a pixel group", "px"),
    Column("GB/s", "peak of the memory, of all machines", "GB/s", ".1f"),
)
CLAIM_COLUMNS = (
    Column("claim", "of the paper; means over the scenes, geometric but for percentages"),
    Column("published", "by the paper"),
    Column("least", "that passes", "", ".3g"),
    Column("most", "that passes; inf: no limit", "", ".3g"),
    *POINT,
    Column("measured", "of the scenes that are of the paper's kind", "", ".3g"),
    Column("passes", "measured lies between least and most"),
    Column("other scenes", "the same of scenes that are not", "", ".3g"),
    Column("dB, least", "PSNR of the preset's worst view of the scenes measured", "dB", ".1f"),
    Column("GSCore's dB, least", "PSNR of its worst view of them", "dB", ".1f"),
)
SERVES_COLUMNS = (
    *POINT,
    Column("baselines", "claims of the GPU and of GSCore that pass, of all of them"),
    Column("pass", "other claims that pass with this one machine", "", "d"),
    Column("of", "of so many", "", "d"),
    Column("times as fast as GSCore", "geometric mean over scenes of the paper's kind", "", ".2f"),
    Column("fail", "the others, and of the baselines"),
    Column("mm2", "area of the machine, the largest of the views", "mm2", ".2f"),
)
SCENE_COLUMNS = (
    SCENE,
    SIZE,
    *POINT,
    Column("frames/s", "mean over the views", "1/s", ".1f"),
    Column("times as fast", "as GSCore", "", ".2f"),
    Column("times less energy", "than GSCore", "", ".2f"),
    PSNR,
    Column("GSCore's dB", "PSNR of its worst view", "dB", ".2f"),
    Column("mm2", "area of the machine, the largest of the views", "mm2", ".2f"),
)
MAP_COLUMNS = (
    PRESET,
    Column("CFUs", "of an HFU", "", "d"),
    Column("FFUs", "of an HFU", "", "d"),
    Column(
        *("times as fast", "as with one of each; geometric mean over scenes of the paper's kind"),
        *("", ".2f"),
    ),
    Column("dB, least", "PSNR of the worst view", "dB", ".1f"),
)
AS_PUBLISHED, PUBLISHED_SPEED = "as published", 2.1  # over GSCore
WITH_PARTS = {NO_VQ_CGF: "neither", NO_CGF: "codebooks", NO_VQ: "coarse filter", "": "both"}
WHOLE = "both, voxels whole"  # as the text has them: long lists are spilled
VARIANT_COLUMNS = (
    SCENE,
    PRESET,
    Column("with", "what there is of codebooks and the coarse filter, or both and voxels never cut"),
    Column("asked MB", "requested by units, mean over the views", "MB", ".2f"),
    Column("M cycles", "of the frame, mean over the views", "10^6 cycles", ".3f"),
    Column("mJ", "of the frame, mean over the views", "mJ", ".3f"),
    Column("times as fast", "as with neither", "", ".2f"),
    Column("times less energy", "than with neither", "", ".2f"),
    Column("dB, least", "PSNR of the worst view", "dB", ".1f"),
)
WATERFALL_COLUMNS = (
    Column("order", "from the ideal to the text, each part taken away; or the parts reversed"),
    Column("step", "what is taken away"),
    Column(
        "times as fast as GSCore",
        *("with what is left; geometric mean over scenes of the paper's kind", "", ".2f"),
    ),
    Column("factor", "of the step before over this one", "", ".3f"),
    Column("dB, least", "PSNR of the worst view", "dB", ".1f"),
)


def worst_db(found: Found, views_of: Callable[[SceneFound], Views]) -> float:
    return min(decibels(view) for each in found for view in views_of(each))


def claim_rows(point: Point, found: Found) -> list[tuple]:
    others = [each for each in found if each.kind is OTHER_SCENES]
    return [
        (
            *(claim.name, claim.published, claim.low, claim.high, *point.cells()),
            *(claim.measured(claim.among(found)), "yes" if claim.holds(found) else "no"),
            claim.measured(others) if others and claim.kind is None else None,
            worst_db(claim.among(found), lambda s: s.of[""]),
            worst_db(claim.among(found), lambda s: s.other),
        )
        for claim in claims_of(found)
    ]


def serves_row(point: Point, found: Found) -> tuple:
    """It is a reproduction where the baselines and all else pass; no claim counts twice."""
    claims = [claim for claim in claims_of(found) if not claim.again]
    fail = [claim for claim in claims if not claim.holds(found)]
    baselines, failing = (
        [claim.name for claim in among if claim.baseline] for among in (claims, fail)
    )
    of, lost = len(claims) - len(baselines), len(fail) - len(failing)
    area = max(mm2(view) for each in found for view in each.of[""])
    return (
        *(*point.cells(), f"{len(baselines) - len(failing)} of {len(baselines)}"),
        *(of - lost, of, geometric(s.speed() for s in found if s.kind is not OTHER_SCENES)),
        *("; ".join(claim.name for claim in fail), area),
    )


def scene_rows(point: Point, scenes: Sequence[Scene], found: Found) -> list[tuple]:
    return [
        (
            *(scene.name, s.kind.size, *point.cells(), 1 / seconds(s.of[""]), s.speed()),
            mean(s.other, joules) / mean(s.of[""], joules),
            *(min(map(decibels, s.of[""])), min(map(decibels, s.other))),
            max(map(mm2, s.of[""])),
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
    """steps: name, speed over GSCore, dB. The first factor is what no assumption explains; all of
    them lead from what is published to the last row."""
    rows: list[tuple] = [(order, AS_PUBLISHED, PUBLISHED_SPEED, None, None)]
    for name, speed, db in steps:
        rows.append((order, name, speed, rows[-1][2] / speed, db))
    return rows


def map_rows(preset: str, by_units: Mapping[tuple[str, str], Sequence[Views]]) -> list[tuple]:
    """by_units: views of each scene by CFUs and FFUs."""
    one = by_units[CFUS[0], FFUS[0]]
    return [
        (
            *(preset, int(cfus), int(ffus)),
            geometric(mean(a, cycles) / mean(b, cycles) for a, b in zip(one, of_scenes)),
            min(decibels(view) for views in of_scenes for view in views),
        )
        for (cfus, ffus), of_scenes in by_units.items()
    ]


def variant_rows(scene: Scene, preset: str, by_parts: Mapping[str, Views]) -> list[tuple]:
    neither = by_parts[WITH_PARTS[NO_VQ_CGF]]
    return [
        (
            *(scene.name, preset, parts, mean(views, asked_mb)),
            *(mean(views, cycles) / 1e6, mean(views, joules) / MJ),
            mean(neither, cycles) / mean(views, cycles),
            mean(neither, joules) / mean(views, joules),
            min(map(decibels, views)),
        )
        for parts, views in by_parts.items()
    ]


def add_reproduction_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "none")
    to.add_argument(
        "--real",
        action="append",
        metavar="SCENE",
        help=f"as the paper's real ones, drawn at {REAL.size}, in voxels of 2; default: {CAPTURE}",
    )
    add_synthetic(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    to.add_argument("--groups", nargs="+", default=list(GROUPS), metavar="PX", help="sides")
    to.add_argument(
        "--channels", nargs="+", type=int, default=[4, 8], metavar="N", help="of memory"
    )
    to.add_argument(
        "--waterfall-group", default="96", metavar="PX", help="of waterfall, map and variants"
    )


def settings_of(group: str, channels: int) -> tuple[str, ...]:
    return (*group_assignments(group), f"dram.channels={channels}")


@dataclasses.dataclass(frozen=True)
class Plan:
    """What is run of each scene."""

    points: Sequence[Point]
    orders: Sequence[tuple[str, list]]  # of the waterfall
    group: str  # of the waterfall, the map and the variants
    channels: int  # of all three

    def runs(self, kind: Kind, run: Run) -> dict[object, Run]:
        """Of a scene, by what they are of. run: its scene, view and size."""
        out: dict[object, Run] = {
            channels: dataclasses.replace(
                run, config=OTHER, overrides=(f"dram.channels={channels}",)
            )
            for channels in {point.channels for point in self.points}
        }

        def put(name: object, config: str, *keys: str) -> None:
            out[name] = dataclasses.replace(run, config=config, overrides=(*kind.keys, *keys))

        for point, (name, (suffix, keys)) in itertools.product(self.points, VARIANTS.items()):
            at = settings_of(point.group, point.channels)
            put((point, name), point.preset + suffix, *at, *keys)
        at = settings_of(self.group, self.channels)
        for order, steps in self.orders:
            for step, gone in steps:
                put((order, step), IDEAL, *at, *gone)
        for preset in (TEXT, IDEAL):
            for suffix, parts in WITH_PARTS.items():
                put((preset, parts), preset + suffix, *at)
            put((preset, WHOLE), preset, *at, "vsu.visit_gaussians=0")
        for preset, cfus, ffus in itertools.product((TEXT, IDEAL), CFUS, FFUS):
            put((preset, cfus, ffus), preset, *at, f"hfu.cfus={cfus}", f"hfu.ffus={ffus}")
        return out


@dataclasses.dataclass(frozen=True)
class Measured:
    """Views of a scene by what they are of, as in Plan.runs."""

    kind: Kind
    views: Mapping[object, Views]
    gpu: Views

    def found(self, channels: int, of: Mapping[str, object]) -> SceneFound:
        """of: what each variant's views are of."""
        by_variant = {variant: self.views[what] for variant, what in of.items()}
        return SceneFound(self.kind, by_variant, self.views[channels], self.gpu)


def measure(arguments: argparse.Namespace, of: Sequence[tuple[Kind, Run]], plan: Plan):
    """Measured of each scene."""
    by_scene = [plan.runs(kind, run) for kind, run in of]
    asked = list(dict.fromkeys(run for runs in by_scene for run in runs.values()))
    views = {
        run: outcome.accepted()
        for run, outcome in zip(asked, swept(arguments, "reproduction", asked))
    }
    gpu = model_all(arguments, [run for _, run in of])
    return [
        Measured(
            kind,
            {what: views[each] for what, each in runs.items()},
            modelled,
        )
        for (kind, _), runs, modelled in zip(of, by_scene, gpu)
    ]


def check_points(arguments: argparse.Namespace) -> None:
    """Before hours of training and simulation. Raises ValueError."""
    check_channels(arguments, (TEXT, IDEAL, OTHER))
    run_arguments.check_once("--groups", arguments.groups)
    for group in (*arguments.groups, arguments.waterfall_group):
        words = ["--config", TEXT, *(w for s in group_assignments(group) for w in ("--set", s))]
        answered(arguments.streaminggs, "describe", words, TEXT)


def make_reproduction(arguments: argparse.Namespace) -> None:
    check_points(arguments)
    by_kind = {
        REAL: find_scenes(arguments.real or (CAPTURE,)),
        SYNTHETIC: synthetic_scenes(arguments),
        OTHER_SCENES: find_scenes(arguments.scenes, arguments.cameras) if arguments.scenes else (),
    }
    of = [
        (kind, Run(scene, arguments.view, kind.size))
        for kind, scenes in by_kind.items()
        for scene in scenes
    ]
    text, ideal = (
        read_config(arguments.streaminggs, dataclasses.replace(of[0][1], config=preset))
        for preset in (TEXT, IDEAL)
    )
    points = [
        Point(*each)
        for each in itertools.product((TEXT, IDEAL), arguments.groups, arguments.channels)
    ]
    orders = list(waterfall_orders(settings_by_part(text, ideal)))
    plan = Plan(points, orders, arguments.waterfall_group, arguments.channels[0])
    measured = measure(arguments, of, plan)
    scenes = [run.scene for _, run in of]
    every = (view for each in measured for views in each.views.values() for view in views)
    by = tables.made_of(arguments.streaminggs, every, scenes)

    def write(name: str, columns: Sequence[Column], rows: list[tuple], about: str = "") -> None:
        tables.write(arguments.out, name, by, columns, rows, about)

    found = {
        point: [each.found(point.channels, {v: (point, v) for v in VARIANTS}) for each in measured]
        for point in points
    }
    write(
        *("reproduction_claims", CLAIM_COLUMNS),
        [row for point, of_point in found.items() for row in claim_rows(point, of_point)],
    )
    rows = [serves_row(point, of_point) for point, of_point in found.items()]
    write("reproduction", SERVES_COLUMNS, rows, ABOUT)
    write(
        *("reproduction_scenes", SCENE_COLUMNS),
        [row for point, of_point in found.items() for row in scene_rows(point, scenes, of_point)],
    )

    paper_kind = [each for each in measured if each.kind is not OTHER_SCENES]

    def steps_of(order: str, names: Sequence[str]) -> Iterator[tuple[str, float, float]]:
        for name in names:
            of_step = [each.found(plan.channels, {"": (order, name)}) for each in paper_kind]
            speed = geometric(s.speed() for s in of_step)
            yield name, speed, worst_db(of_step, lambda s: s.of[""])

    rows = [
        row
        for order, steps in orders
        for row in waterfall_rows(order, list(steps_of(order, [name for name, _ in steps])))
    ]
    write("reproduction_waterfall", WATERFALL_COLUMNS, rows)
    rows = [
        row
        for scene, each in zip(scenes, measured)
        for preset in (TEXT, IDEAL)
        for row in variant_rows(
            scene, preset, {of: each.views[preset, of] for of in (*WITH_PARTS.values(), WHOLE)}
        )
    ]
    write("reproduction_variants", VARIANT_COLUMNS, rows)
    rows = [
        row
        for preset in (TEXT, IDEAL)
        for row in map_rows(
            preset,
            {
                units: [each.views[(preset, *units)] for each in paper_kind]
                for units in itertools.product(CFUS, FFUS)
            },
        )
    ]
    write("reproduction_map", MAP_COLUMNS, rows)
    for figure in ("reproduction", "variants"):
        tables.draw_beside(arguments.out, figure)


ABOUT = (
    "It is a reproduction only where one machine passes all claims, the baselines first: one preset, "
    "one group, one memory. The scenes are not the paper's. The modelled GPU was fitted to its real "
    "rate. With a fine test a cycle, as `paper_ideal` has, more FFUs gain nothing by construction."
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
  reproduction_variants   both presets without codebooks, coarse filter, both
  reproduction_map        speed by CFUs and FFUs, the paper's heat map

and their figures, reproduction and variants. Claims, waterfall and map are of scenes of the paper's
kind: those of --real and --synthetic. What other scenes give stands beside them; SCENE are such.
""",
    (
        "results.py reproduction truck playbot platform yard garden park --synthetic lego "
        "--train-steps 5000 --gaussians 300000",
    ),
    add_reproduction_arguments,
    make_reproduction,
)
