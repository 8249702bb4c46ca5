"""What vector quantisation and the coarse filter are worth: the paper's variants, and exact order
with each encoding of second halves. All of means over the views of a scene. Makes

  compare_variants          traffic, cycles, energy, area, quality, bottleneck
  compare_variants_effects  cycles and energy without a feature over those with it, beside the
                            factors that the paper states
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

import tables
from tables import SCENE, Column, Spread
from runs import run_arguments
from runs.scenes import find_scenes
from runs.simulations import (
    MB,
    MJ,
    Run,
    asked_mb,
    binders,
    bus_mb,
    cycles,
    joules,
    mean,
    mm2,
    region_bytes,
    shape_of,
)
from runs.sweep_server import swept

JOBS = ("results.py compare_variants truck playbot platform yard garden park",)

VARIANTS = (
    *("paper", "paper_no_vq", "paper_no_cgf", "paper_no_vq_cgf"),
    *("exact", "exact_half", "exact_vq", "exact_vq_packed"),
)

Views = Sequence[dict]


def dram_joules(view: dict) -> float:
    return view["energy"]["dram_j"]


# As the paper adds its features: quantisation first, without the coarse filter. StreamingGS, DAC
# 2025: speed 45.7 with both, 22.2 without the coarse filter, times the GPU's; "VQ hardly changes
# speed"; energy 62.9, 27.3 without the coarse filter, 21.5 without either.
EFFECTS: tuple[tuple[str, str, str, Callable[[dict], float], str], ...] = (
    ("cycles without / with VQ", "paper_no_vq", "paper", cycles, ""),
    ("the same without coarse filter", "paper_no_vq_cgf", "paper_no_cgf", cycles, "about 1"),
    ("cycles without / with coarse filter", "paper_no_cgf", "paper", cycles, "2.06"),
    ("the same without VQ", "paper_no_vq_cgf", "paper_no_vq", cycles, ""),
    (
        *("energy without / with VQ, both without coarse filter", "paper_no_vq_cgf"),
        *("paper_no_cgf", joules, "1.27"),
    ),
    ("of the DRAM, VQ", "paper_no_vq_cgf", "paper_no_cgf", dram_joules, ""),
    ("energy without / with coarse filter", "paper_no_cgf", "paper", joules, "2.30"),
    ("of the DRAM, coarse filter", "paper_no_cgf", "paper", dram_joules, ""),
)
EFFECT_COLUMNS = (
    Column("effect", "what of which variants is compared"),
    Column("StreamingGS", "what the paper states"),
    SCENE,
    Column("times", "means over the views, without over with", "", ".2f"),
)
COLUMNS = (
    SCENE,
    Column("variant", "preset: the paper's variants, then exact order by encoding"),
    Column("group px", "side, or width and height, of a pixel group", "px"),
    Column("first halves MB", "requested of positions and extents", "MB", ".2f"),
    Column("second halves MB", "requested of all else of a Gaussian", "MB", ".2f"),
    Column("all MB", "requested by units, both directions", "MB", ".2f"),
    Column("all on the bus MB", "moved in whole bursts", "MB", ".2f"),
    Column("M cycles", "of the frame", "10^6 cycles", ".2f"),
    Column("mJ", "of the frame", "mJ", ".2f"),
    Column("of it DRAM", "energy of the DRAM", "mJ", ".2f"),
    Column("mm2", "area of the machine, the largest of the views", "mm2", ".2f"),
    Column("encoding dB, least", "PSNR that the encoding alone leaves, worst view", "dB", ".1f"),
    Column("encoding dB, most", "the same, best view that differs", "dB", ".1f"),
    Column("binds", "busiest resource and its share; what holds the frame where it is another"),
)


def encoding_psnr(views: Views) -> tuple[float, float]:
    """Least and most, of views that differ."""
    values = [view["image"]["encoding_psnr_db"] for view in views]
    finite = [value for value in values if value is not None] or [float("inf")]
    return min(finite), max(finite)


def row(scene: str, variant: str, views: Views) -> tuple:
    return (
        scene,
        variant,
        shape_of(views[0]["config"]),
        mean(views, lambda v: region_bytes(v, "first_halves")) / MB,
        mean(views, lambda v: region_bytes(v, "second_halves")) / MB,
        mean(views, asked_mb),
        mean(views, bus_mb),
        mean(views, cycles) / 1e6,
        mean(views, joules) / MJ,
        mean(views, dram_joules) / MJ,
        max(map(mm2, views)),
        *encoding_psnr(views),
        binders(views),
    )


def effect_rows(scene: str, of: dict[str, Views]) -> list[tuple]:
    return [
        (effect, stated, scene, mean(of[without], value) / mean(of[with_it], value))
        for effect, without, with_it, value, stated in EFFECTS
    ]


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, "640x360")
    run_arguments.add_settings(to, "all presets")


def make(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    runs = [
        Run(scene, arguments.view, arguments.size, variant, tuple(arguments.set))
        for scene in scenes
        for variant in VARIANTS
    ]
    views = [outcome.accepted() for outcome in swept(arguments, "compare_variants", runs)]
    by_scene: dict[str, dict[str, Views]] = {}
    for run, of_run in zip(runs, views):
        by_scene.setdefault(run.scene.name, {})[run.config] = of_run
    by = tables.made_of(arguments.streaminggs, (v for of_run in views for v in of_run), scenes)
    rows = [row(scene, variant, v) for scene, of in by_scene.items() for variant, v in of.items()]
    tables.write(arguments.out, "compare_variants", by, COLUMNS, rows)
    effects = [line for scene, of in by_scene.items() for line in effect_rows(scene, of)]
    spread = Spread("scene", "{times}")
    tables.write(
        arguments.out, "compare_variants_effects", by, EFFECT_COLUMNS, effects, spread=spread
    )
