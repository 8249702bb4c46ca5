#!/usr/bin/env python3
"""The paper's claims (StreamingGS, DAC 2025) beside what the preset `paper` measures: frame rates,
the share of Gaussians that the filters drop, what codebooks and the coarse filter gain, which
filter units pay, area and power. Writes paper_claims.md, a column for each scene: means over its
views, the worst PSNR of them.

Without SCENE: built-in scenes of the sizes that the paper names, 1 M Gaussians at 980x545 as real
and 0.3 M at 800x800 as synthetic, and the real ones at 980x545. The paper's own scenes are not
these: a rate that is near its own says that the machine is of its kind, not more.
"""

from __future__ import annotations

import argparse
import dataclasses
import statistics
import sys
from collections.abc import Callable, Sequence

from runs import run_arguments
from results import tables
from runs import view_numbers
from runs.scenes import Scene, find_scene, find_scenes, shared_names
from runs.simulations import Run, simulate_all, work

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


@dataclasses.dataclass(frozen=True)
class Measured:
    """One scene at one size: the views of each variant."""

    scene: Scene
    size: str
    views: dict[str, tuple[dict, ...]]

    def mean(self, value: Callable[[dict], float], variant: str = "paper") -> float:
        return statistics.fmean(value(view) for view in self.views[variant])

    def worst_psnr(self, variant: str) -> str:
        """Against the reference picture, in dB."""
        psnr_db = min(map(view_numbers.decibels, self.views[variant]))
        return "equal" if psnr_db == float("inf") else f"{psnr_db:.1f} dB"

    def faster(self, variant: str, than: str) -> str:
        """How many times as fast one variant is as another."""
        return f"{self.mean(cycles, than) / self.mean(cycles, variant):.2f}"


def cycles(view: dict) -> float:
    return view["frame"]["cycles"]


def frames_a_second(view: dict) -> float:
    return 1 / view["frame"]["time_s"]


def dropped_percent(view: dict) -> float:
    """By both filters: of the coarse tests of a Gaussian against what an HFU works for, those that
    make no splat."""
    return 100 * (1 - fine_splats(view) / work(view, "coarse_tests_of_parts"))


def not_fetched_percent(view: dict) -> float:
    """By the coarse filter: of the Gaussians that are streamed, those whose second half nobody
    wants."""
    return 100 * (1 - work(view, "second_halves") / work(view, "first_halves"))


def fine_splats(view: dict) -> int:
    counters = (unit["counters"] for unit in view["units"].values())
    return sum(of["splats"] for of in counters if "fine_tests" in of)


# Claim, what the paper says, how it is measured.
def claims(m: Measured) -> list[tuple[str, str, str]]:
    return [
        ("frames a second", "224 real, 388 synthetic", f"{m.mean(frames_a_second):.0f}"),
        ("dropped by both filters, % of coarse tests", "76.3", f"{m.mean(dropped_percent):.1f}"),
        (
            "dropped by the coarse filter, % of Gaussians",
            "76.3",
            f"{m.mean(not_fetched_percent):.1f}",
        ),
        ("gain of the coarse filter", "2.06", m.faster("paper", "no_cgf")),
        ("gain of codebooks without it", "about 1", m.faster("no_cgf", "neither")),
        ("twice the CFUs", "gain", m.faster("twice_the_cfus", "paper")),
        ("FFUs twice as fast", "none", m.faster("twice_the_ffus", "paper")),
        ("area, mm2", "5.37", f"{m.mean(lambda view: view['area_mm2']['total']):.2f}"),
        ("power, W", "about 4", f"{m.mean(lambda view: view['energy']['mean_power_w']):.2f}"),
        (
            "rate with a part of the group for each HFU and lists of 128, over the preset's",
            "",
            m.faster("shared", "paper"),
        ),
        (
            "rate with voxels whole, long lists spilled, over the preset's",
            "",
            m.faster("whole_voxels", "paper"),
        ),
        (
            "picture of the preset; with voxels whole",
            "",
            f"{m.worst_psnr('paper')}; {m.worst_psnr('whole_voxels')}",
        ),
    ]


def measure(arguments: argparse.Namespace) -> list[Measured]:
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
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    views = iter([outcome.accepted() for outcome in outcomes])
    return [
        Measured(scene, size, {name: next(views) for name in VARIANTS})
        for scene, size in chosen.items()
    ]


def rows(measured: Sequence[Measured]) -> list[tuple]:
    by_claim = [claims(m) for m in measured]
    return [
        (name, says, *(of[at][2] for of in by_claim))
        for at, (name, says, _) in enumerate(by_claim[0])
    ]


def make_tables(arguments: argparse.Namespace) -> None:
    measured = measure(arguments)
    head = ("claim", "paper", *(f"{m.scene.name}, {m.size}" for m in measured))
    made = run_arguments.how_made(view for m in measured for view in m.views["paper"])
    text = made + tables.markdown(head, rows(measured))
    tables.write_text(arguments.out / "paper_claims.md", text)
    print(text)


def main() -> int:
    parser = run_arguments.parser(__doc__, "two built-in scenes and all real ones")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    parser.add_argument(
        "--size",
        default=REAL_SIZE,
        metavar="WxH",
        help="of the scenes given, but for the two that stand in by default",
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over every preset"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
