#!/usr/bin/env python3
"""What vector quantisation and the coarse filter are worth: every view of the given scenes in the
paper's variants and in exact order with each encoding of second halves. Writes, all of means over
the views of a scene:

  compare_variants.md          traffic by region, cycles, energy, quality, binding unit; and .csv
  compare_variants_effects.md  cycles and energy without a feature over those with it, beside the
                               factors that the paper states
  compare_variants_filters.md  share of the Gaussians that each filter removes, by group size
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Callable, Sequence

import run_arguments
import tables
from scenes import Scene, find_scenes
from simulations import SRAM_AS_NEEDED, Run, region_bytes, simulate_all, work

PAPER_VARIANTS = ("paper", "paper_no_vq", "paper_no_cgf", "paper_no_vq_cgf")
EXACT_VARIANTS = ("exact", "exact_half", "exact_vq", "exact_vq_packed")
VARIANTS = PAPER_VARIANTS + EXACT_VARIANTS
# Preset and overrides. The ordering table of a group of 128 px does not fit what the preset has for
# it.
FILTER_ORDERS = {
    "paper": ("paper_no_vq", ("vsu.table_bytes=65536",)),
    "exact": ("exact", ()),
}
GROUPS_PX = (16, 32, 64, 128)
PAPER_REMOVED = "76.3%"
# StreamingGS, DAC 2025: speed 45.7 with both, 22.2 without the coarse filter, times the GPU's; "VQ
# hardly changes speed"; energy 62.9, 27.3 without the coarse filter, 21.5 without either.
PAPER_EFFECTS = ("StreamingGS", "about 1", "", "2.06", "", "1.27", "", "2.30", "", "")
MB = 1e6
MJ = 1e-3

Views = Sequence[dict]


def mean(views: Views, value: Callable[[dict], float]) -> float:
    return statistics.fmean(value(view) for view in views)


def cycles(view: dict) -> float:
    return view["frame"]["cycles"]


def energy(view: dict) -> float:
    return view["energy"]["total_j"]


def bus_bytes(view: dict, region: str) -> int:
    return view["dram"]["bus_bytes_by_region"][region]


def binders(views: Views) -> str:
    units = sorted({view["binding"]["unit"] for view in views})
    shares = [view["binding"]["utilisation"] for view in views]
    low, high = f"{min(shares):.0%}", f"{max(shares):.0%}"
    return f"{', '.join(units)} {low if low == high else f'{low} .. {high}'}"


def encoding_psnr(views: Views) -> str:
    values = [view["image"]["encoding_psnr_db"] for view in views]
    finite = [value for value in values if value is not None]
    return f"{min(finite):.1f} .. {max(finite):.1f}" if finite else "equal"


VARIANT_HEAD = (
    "scene",
    "variant",
    "group px",
    "tables MB",
    "first halves MB",
    "second halves MB",
    "codebooks MB",
    "spill MB",
    "pixels MB",
    "all MB",
    "second halves on the bus MB",
    "all on the bus MB",
    "M cycles",
    "energy mJ",
    "of it DRAM mJ",
    "encoding dB",
    "binds",
)
TABLE_REGIONS = ("voxel_table", "chunk_table")


def variant_row(scene: str, variant: str, views: Views) -> tuple:
    def megabytes(*regions: str) -> str:
        return f"{mean(views, lambda v: sum(region_bytes(v, r) for r in regions)) / MB:.2f}"

    return (
        scene,
        variant,
        views[0]["config"]["group_px"],
        megabytes(*TABLE_REGIONS),
        megabytes("first_halves"),
        megabytes("second_halves"),
        megabytes("codebooks"),
        megabytes("spill"),
        megabytes("frame_buffer"),
        f"{mean(views, lambda v: v['dram']['bytes']) / MB:.2f}",
        f"{mean(views, lambda v: bus_bytes(v, 'second_halves')) / MB:.2f}",
        f"{mean(views, lambda v: v['dram']['bus_bytes']) / MB:.2f}",
        f"{mean(views, cycles) / 1e6:.2f}",
        f"{mean(views, energy) / MJ:.2f}",
        f"{mean(views, lambda v: v['energy']['dram_j']) / MJ:.2f}",
        encoding_psnr(views),
        binders(views),
    )


EFFECT_HEAD = (
    "scene",
    "cycles without / with VQ",
    "the same without coarse filter",
    "cycles without / with coarse filter",
    "the same without VQ",
    "energy without / with VQ",
    "DRAM energy",
    "energy without / with coarse filter",
    "DRAM energy",
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


def removed(views: Views) -> str:
    """Coarse filter, fine filter of what is left, both: shares of the Gaussians tested."""
    passed = sum(work(v, "coarse_passed") for v in views) / sum(
        work(v, "coarse_tests_of_parts") for v in views
    )
    # Other units count the splats that they were given.
    counters = (unit["counters"] for v in views for unit in v["units"].values())
    splats = sum(of_unit["splats"] for of_unit in counters if "fine_tests" in of_unit)
    reached = splats / sum(work(v, "fine_tests") for v in views)
    return f"{1 - passed:.0%} / {1 - reached:.0%} / {1 - passed * reached:.1%}"


def simulated(arguments: argparse.Namespace, runs: Sequence[Run]) -> list[Views]:
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    return [outcome.accepted() for outcome in outcomes]


def compare_variants(arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
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
    write(arguments, "compare_variants", made, VARIANT_HEAD, rows)
    write(arguments, "compare_variants_effects", made, EFFECT_HEAD, effects)


def compare_filters(arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
    cases = [(scene, order) for scene in scenes for order in FILTER_ORDERS]
    runs = [
        Run(
            scene,
            arguments.view,
            arguments.size,
            FILTER_ORDERS[order][0],
            (*SRAM_AS_NEEDED, *FILTER_ORDERS[order][1], *arguments.set, f"group_px={px}"),
        )
        for scene, order in cases
        for px in GROUPS_PX
    ]
    results = simulated(arguments, runs)
    rows = []
    for number, (scene, order) in enumerate(cases):
        of_groups = results[number * len(GROUPS_PX) : (number + 1) * len(GROUPS_PX)]
        rows.append((scene.name, order, *map(removed, of_groups)))
    rows.append(("StreamingGS", "paper", *[f"both {PAPER_REMOVED}; group not stated"] * 4))
    head = ("scene", "order", *(f"{px} px: coarse / fine / both" for px in GROUPS_PX))
    made = run_arguments.how_made(v for views in results for v in views)
    write(arguments, "compare_variants_filters", made, head, rows)


def write(
    arguments: argparse.Namespace, name: str, made: str, head: Sequence[str], rows: list[tuple]
) -> None:
    text = made + tables.markdown(head, rows)
    tables.write_text(arguments.out / f"{name}.md", text)
    tables.write_text(arguments.out / f"{name}.csv", tables.csv_text(head, rows))
    print(f"{text}\n", flush=True)


def make_tables(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    for make in {"variants": [compare_variants], "filters": [compare_filters]}.get(
        arguments.only, [compare_variants, compare_filters]
    ):
        make(arguments, scenes)


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="in px")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over all presets"
    )
    parser.add_argument(
        "--only", choices=("variants", "filters"), help="the first two tables, or the third"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
