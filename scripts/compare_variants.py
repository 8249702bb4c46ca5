#!/usr/bin/env python3
"""What vector quantisation and the coarse filter are worth: the paper's variants, and exact order
with each encoding of second halves. Writes, all of means over the views of a scene:

  compare_variants.md          traffic, cycles, energy, area, quality, binding unit; and .csv
  compare_variants_effects.md  cycles and energy without a feature over those with it, beside the
                               factors that the paper states
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Callable, Sequence

from runs import run_arguments
from results import tables
from runs.group_shapes import shape_of
from runs.scenes import find_scenes
from runs.simulations import Run, region_bytes, simulate_all
from runs.view_numbers import binders

PAPER_VARIANTS = ("paper", "paper_no_vq", "paper_no_cgf", "paper_no_vq_cgf")
EXACT_VARIANTS = ("exact", "exact_half", "exact_vq", "exact_vq_packed")
VARIANTS = PAPER_VARIANTS + EXACT_VARIANTS
# StreamingGS, DAC 2025: speed 45.7 with both, 22.2 without the coarse filter, times the GPU's; "VQ
# hardly changes speed"; energy 62.9, 27.3 without the coarse filter, 21.5 without either.
PAPER_EFFECTS = ("StreamingGS", "", "about 1", "2.06", "", "1.27", "", "2.30", "", "")
MB = 1e6
MJ = 1e-3

Views = Sequence[dict]


def mean(views: Views, value: Callable[[dict], float]) -> float:
    return statistics.fmean(value(view) for view in views)


def cycles(view: dict) -> float:
    return view["frame"]["cycles"]


def energy(view: dict) -> float:
    return view["energy"]["total_j"]


def encoding_psnr(views: Views) -> str:
    values = [view["image"]["encoding_psnr_db"] for view in views]
    finite = [value for value in values if value is not None]
    return f"{min(finite):.1f} .. {max(finite):.1f}" if finite else "equal"


VARIANT_HEAD = (
    "scene",
    "variant",
    "group px",
    "first halves MB",
    "second halves MB",
    "all MB",
    "all on the bus MB",
    "M cycles",
    "mJ",
    "of it DRAM",
    "mm2",
    "encoding dB",
    "binds",
)


def variant_row(scene: str, variant: str, views: Views) -> tuple:
    def megabytes(region: str) -> str:
        return f"{mean(views, lambda v: region_bytes(v, region)) / MB:.2f}"

    return (
        scene,
        variant,
        shape_of(views[0]["config"]),
        megabytes("first_halves"),
        megabytes("second_halves"),
        f"{mean(views, lambda v: v['dram']['bytes']) / MB:.2f}",
        f"{mean(views, lambda v: v['dram']['bus_bytes']) / MB:.2f}",
        f"{mean(views, cycles) / 1e6:.2f}",
        f"{mean(views, energy) / MJ:.2f}",
        f"{mean(views, lambda v: v['energy']['dram_j']) / MJ:.2f}",
        f"{max(v['area_mm2']['total'] for v in views):.2f}",
        encoding_psnr(views),
        binders(views),
    )


EFFECT_HEAD = (
    "scene",
    "cycles without / with VQ",
    "the same without coarse filter",
    "cycles without / with coarse filter",
    "the same without VQ",
    "energy without / with VQ, both without coarse filter",
    "of the DRAM",
    "energy without / with coarse filter",
    "of the DRAM",
    "binds: paper; no VQ; no coarse filter; neither",
)


def effect_row(scene: str, of: dict[str, Views]) -> tuple:
    def ratio(without: str, with_it: str, value: Callable[[dict], float]) -> str:
        return f"{mean(of[without], value) / mean(of[with_it], value):.2f}"

    def dram(view: dict) -> float:
        return view["energy"]["dram_j"]

    return (
        scene,
        ratio("paper_no_vq", "paper", cycles),
        ratio("paper_no_vq_cgf", "paper_no_cgf", cycles),
        ratio("paper_no_cgf", "paper", cycles),
        ratio("paper_no_vq_cgf", "paper_no_vq", cycles),
        # As the paper adds its features: quantisation first, without the coarse filter.
        ratio("paper_no_vq_cgf", "paper_no_cgf", energy),
        ratio("paper_no_vq_cgf", "paper_no_cgf", dram),
        ratio("paper_no_cgf", "paper", energy),
        ratio("paper_no_cgf", "paper", dram),
        "; ".join(binders(of[variant]) for variant in PAPER_VARIANTS),
    )


def simulated(arguments: argparse.Namespace, runs: Sequence[Run]) -> list[Views]:
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    return [outcome.accepted() for outcome in outcomes]


def make_tables(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    cases = [(scene, variant) for scene in scenes for variant in VARIANTS]
    runs = [
        Run(scene, arguments.view, arguments.size, variant, tuple(arguments.set))
        for scene, variant in cases
    ]
    results = simulated(arguments, runs)
    rows = [variant_row(s.name, variant, v) for (s, variant), v in zip(cases, results)]
    by_scene: dict[str, dict[str, Views]] = {}
    for (scene, variant), views in zip(cases, results):
        by_scene.setdefault(scene.name, {})[variant] = views
    effects = [effect_row(name, of) for name, of in by_scene.items()] + [PAPER_EFFECTS]
    made = run_arguments.how_made(v for views in results for v in views)
    tables.write(arguments.out, "compare_variants", made, VARIANT_HEAD, rows)
    tables.write(arguments.out, "compare_variants_effects", made, EFFECT_HEAD, effects)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="in px")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over all presets"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
