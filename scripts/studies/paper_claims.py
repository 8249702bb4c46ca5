"""The paper's claims (StreamingGS, DAC 2025) beside what the preset `paper` measures: frame rates,
the share of Gaussians that the filters drop, what codebooks and the coarse filter gain, which
filter units pay, area and power. Makes paper_claims: means over the views of a scene, the worst
PSNR of them.

Without SCENE: built-in scenes of the sizes that the paper names, 1 M Gaussians at 980x545 as real
and 0.3 M at 800x800 as synthetic, and the real ones at 980x545. The paper's own scenes are not
these: a rate that is near its own says that the machine is of its kind, not more.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence

import tables
from tables import SCENE, Column, Spread
from runs import run_arguments
from runs.scenes import find_scene, find_scenes, shared_names
from runs.simulations import Run, cycles, decibels, mean, mm2, work
from runs.sweep_server import swept

JOBS = ("results.py paper_claims truck playbot platform yard garden park",)

REAL_SIZE, SYNTHETIC_SIZE = "980x545", "800x800"
BUILT_IN = {"builtin:outdoor?n=1000000": REAL_SIZE, "builtin:object?n=300000": SYNTHETIC_SIZE}

# What each claim compares: a name, the preset, and keys over it.
VARIANTS = {
    "paper": ("paper", ()),
    "no_vq": ("paper_no_vq", ()),
    "no_cgf": ("paper_no_cgf", ()),
    "neither": ("paper_no_vq_cgf", ()),
    "twice_the_cfus": ("paper", ("hfu.cfus=8",)),
    "twice_the_ffus": ("paper", ("hfu.ffu_lanes=32",)),
    "shared": (
        "paper",
        (
            "fetch=shared",
            "hfu.slice_gaussians=512",
            "vsu.visit_gaussians=128",
            "sorting.buffer_entries=128",
        ),
    ),
    "whole_voxels": ("paper", ("vsu.visit_gaussians=0",)),
}

Views = Mapping[str, Sequence[dict]]  # by variant
Measure = Callable[[Views], float]


def of_paper(value: Callable[[dict], float]) -> Measure:
    return lambda views: mean(views["paper"], value)


def faster(variant: str, than: str) -> Measure:
    """How many times as fast one variant is as another."""
    return lambda views: mean(views[than], cycles) / mean(views[variant], cycles)


def worst_psnr(variant: str) -> Measure:
    return lambda views: min(map(decibels, views[variant]))


def dropped_percent(view: dict) -> float:
    """By both filters: of the coarse tests of a Gaussian against what an HFU works for, those that
    make no splat."""
    counters = [unit["counters"] for unit in view["units"].values()]
    fine_splats = sum(of["splats"] for of in counters if "fine_tests" in of)
    return 100 * (1 - fine_splats / work(view, "coarse_tests_of_parts"))


def not_fetched_percent(view: dict) -> float:
    """By the coarse filter: of the Gaussians that are streamed, those whose second half nobody
    wants."""
    return 100 * (1 - work(view, "second_halves") / work(view, "first_halves"))


# Claim, what the paper says, how it is measured.
CLAIMS: tuple[tuple[str, str, Measure], ...] = (
    (
        "frames a second",
        "224 real, 388 synthetic",
        of_paper(lambda view: 1 / view["frame"]["time_s"]),
    ),
    ("dropped by both filters, % of coarse tests", "76.3", of_paper(dropped_percent)),
    ("dropped by the coarse filter, % of Gaussians", "76.3", of_paper(not_fetched_percent)),
    ("gain of the coarse filter", "2.06", faster("paper", "no_cgf")),
    ("gain of codebooks without it", "about 1", faster("no_cgf", "neither")),
    ("twice the CFUs", "gain", faster("twice_the_cfus", "paper")),
    ("FFUs twice as fast", "none", faster("twice_the_ffus", "paper")),
    ("area, mm2", "5.37", of_paper(mm2)),
    ("power, W", "about 4", of_paper(lambda view: view["energy"]["mean_power_w"])),
    (
        "rate with a part of the group for each HFU and lists of 128, over the preset's",
        "",
        faster("shared", "paper"),
    ),
    (
        "rate with voxels whole, long lists spilled, over the preset's",
        "",
        faster("whole_voxels", "paper"),
    ),
    ("picture of the preset, dB", "", worst_psnr("paper")),
    ("picture with voxels whole, dB", "", worst_psnr("whole_voxels")),
)
COLUMNS = (
    Column("claim", "what is compared, and its unit"),
    Column("paper", "what StreamingGS (DAC 2025) states"),
    SCENE,
    Column("measured", "of the scene, means over its views; dB: the worst", "", ".2f"),
)


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "two built-in scenes and all real ones")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    to.add_argument(
        "--size",
        default=REAL_SIZE,
        metavar="WxH",
        help="of the scenes given, but for the two that stand in by default",
    )
    run_arguments.add_settings(to, "every preset")


def make(arguments: argparse.Namespace) -> None:
    if arguments.scenes:
        scenes = find_scenes(arguments.scenes)
        chosen = {scene: BUILT_IN.get(scene.spec, arguments.size) for scene in scenes}
    else:
        chosen = {find_scene(spec): size for spec, size in BUILT_IN.items()}
        chosen |= {find_scene(name): REAL_SIZE for name in shared_names()}
    runs = [
        Run(scene, arguments.view, size, config, (*keys, *arguments.set))
        for scene, size in chosen.items()
        for config, keys in VARIANTS.values()
    ]
    outcomes = iter(swept(arguments, "paper_claims", runs))
    found = [{name: next(outcomes).accepted() for name in VARIANTS} for _ in chosen]
    rows = [
        (claim, says, f"{scene.name}, {size}", measure(views))
        for (scene, size), views in zip(chosen.items(), found)
        for claim, says, measure in CLAIMS
    ]
    by = tables.made_of(arguments.streaminggs, (v for of in found for v in of["paper"]), chosen)
    spread = Spread("scene", "{measured}")
    tables.write(arguments.out, "paper_claims", by, COLUMNS, rows, spread=spread)
