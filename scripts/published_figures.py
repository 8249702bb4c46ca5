#!/usr/bin/env python3
"""What is published of GSCore and of the mobile GPU beside what the preset `gscore` and the model
of the GPU give, where a workload can be matched in size. The published scenes are not these: each
gap stands beside what is known to differ, and nothing is fitted to close it.

  published_bytes.md      bytes of a frame for an object of as many Gaussians as the published Lego
                          has, and for one of as many pairs; the two counts come from two sources
  published_rates.md      frames a second at three sizes, scenes of 1 to 2.5 M Gaussians
  published_ablations.md  gain of oriented boxes and of parts of tiles
  published_gpu.md        rates, shares of time and of bytes of the original rasteriser

The accelerator has 51.2 GB/s. Without SCENE: park, where it is there, and built-in scenes of 1 M
and 2.5 M Gaussians. What was simulated is kept in published_runs.jsonl and
published_gpu_runs.jsonl.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Sequence

import published_gpu
from runs import run_arguments
from results import tables
from runs.gpu_views import MODEL, model_gpu
from runs.kept_runs import KeptRuns
from runs.scenes import Scene, find_scene, find_scenes, shared_names
from runs.simulations import Outcome, Run, region_bytes
from runs.view_numbers import view_numbers_there

RUNS_FILE, GPU_RUNS_FILE = "published_runs.jsonl", "published_gpu_runs.jsonl"
BANDWIDTH = ("dram.channels=8",)  # 8 x LPDDR3-1600 x32 are the published 51.2 GB/s
MB = 1e6

# NeRArch-Sim (ISCA 2026), Tables VII and VIII: Lego at 800 x 800 px, 190 frames a second. 334,000
# Gaussians are its features over 236 B; 1.57 M pairs are of a script that explores designs, for
# 168,000 Gaussians with boxes along the screen.
LEGO_SIZE, LEGO_GAUSSIANS, LEGO_PAIRS, LEGO_RATE = "800x800", 334_000, 1_570_804, 190
ALIKE_IN_GAUSSIANS = f"builtin:object?n={LEGO_GAUSSIANS}"
ALIKE_IN_PAIRS = "builtin:object?n=850000"
# Of what: counted by what, published MB, what differs.
LEGO_BYTES = (
    ("features in", "Gaussians", 78.8, "of 236 B a Gaussian that is not in the frame costs 16"),
    ("lists out", "pairs", 9.5, "links; lines that leave before they are full; long lists twice"),
    ("lists in", "pairs", 9.5, "finished tiles are not read to the end; long lists go twice"),
    ("pixels out", "pixels", 3.1, "3 B a pixel here; the published 4.8 are of no usual format"),
    ("projected features out", "records written", None, "not in the published table"),
    ("projected features in", "records read", None, "not in the published table"),
)

# Neo (ASPLOS 2026): means over six scenes; at 1440 lines 104.6 GB in 60 frames.
RATES = {"1280x720": (66.7, None), "1920x1080": (31.1, None), "2560x1440": (15.8, 1743)}
RATE_SCENES = ("builtin:outdoor?n=1000000", "builtin:outdoor?n=2500000")

# GSCore's gains as FlashGS quotes them.
ABLATION_CASES = (("truck", "980x545"), (ALIKE_IN_GAUSSIANS, LEGO_SIZE))
NEITHER = ("tiles.test=box", "tiles.subtiles_across=1")
ORIENTED = ("tiles.subtiles_across=1",)
GAINS = (
    ("oriented boxes", NEITHER, ORIENTED, 1.71),
    ("parts of tiles, beside them", ORIENTED, (), 1.15),
    ("both", NEITHER, (), 1.86),
)


class Measuring:
    def __init__(self, arguments: argparse.Namespace):
        out, pace = arguments.out, arguments.side_by_side
        self.view = arguments.view
        self.kept = KeptRuns(arguments.streaminggs, out / RUNS_FILE, pace)
        self.gpu = KeptRuns(arguments.streaminggs, out / GPU_RUNS_FILE, pace, model_gpu)
        self.made_of: list[dict] = []

    def gscore(self, cases: Sequence[tuple[Scene, str, tuple[str, ...]]]) -> list[Outcome]:
        """Raises ValueError for what is refused, Failure for what failed, behind all others."""
        runs = [Run(s, self.view, size, "gscore", (*BANDWIDTH, *keys)) for s, size, keys in cases]
        outcomes = self.kept.outcomes(runs)
        self.made_of += [view for outcome in outcomes for view in outcome.accepted()]
        return outcomes

    def of_gpu(self) -> list[tuple[dict, ...]]:
        cases = published_gpu.CASES
        runs = [Run(find_scene(spec), "all", size, MODEL) for spec, size, _ in cases]
        return [outcome.accepted() for outcome in self.gpu.outcomes(runs)]


def counted(view: dict, units: str, counter: str) -> int:
    """Sum over the units whose names begin so."""
    found = [unit for name, unit in view["units"].items() if name.startswith(units)]
    return sum(unit["counters"][counter] for unit in found)


def directed(view: dict, region: str, direction: str) -> int:
    by_requester = view["dram"]["bytes_by_region"].get(region, {})
    return sum(both.get(direction, 0) for both in by_requester.values())


def rate(views: Sequence[dict]) -> float:
    return 1 / statistics.fmean(view["frame"]["time_s"] for view in views)


def change(here: float, published: float | None) -> str:
    return "" if published is None else f"{100 * (here / published - 1):+.0f} %"


BYTES_HEAD = (
    "scene",
    "what",
    "counted by",
    "published count",
    "MB",
    "B each",
    "count here",
    "MB asked for",
    "B each here",
    "B each, here over published",
    "what differs",
)


def lego_rows(name: str, view: dict) -> list[tuple]:
    moved = {
        "features in": region_bytes(view, "first_halves") + region_bytes(view, "second_halves"),
        "lists out": directed(view, "tile_lists", "write") + directed(view, "subsets", "write"),
        "lists in": directed(view, "tile_lists", "read") + directed(view, "subsets", "read"),
        "pixels out": region_bytes(view, "frame_buffer"),
        "projected features out": directed(view, "projected", "write"),
        "projected features in": directed(view, "projected", "read"),
    }
    counts = {
        "Gaussians": view["scene"]["gaussians"],
        "pairs": counted(view, "lister", "pairs"),
        "pixels": view["frame"]["width_px"] * view["frame"]["height_px"],
        "records written": counted(view, "lister", "records"),
        "records read": counted(view, "rendering", "records"),
    }
    sides = LEGO_SIZE.split("x")
    published_counts = {
        "Gaussians": LEGO_GAUSSIANS,
        "pairs": LEGO_PAIRS,
        "pixels": int(sides[0]) * int(sides[1]),
    }
    rows = []
    for what, by, published, differs in LEGO_BYTES:
        here = moved[what] / counts[by]
        each = published and published * MB / published_counts[by]
        rows.append(
            (
                name,
                what,
                by,
                "" if each is None else published_counts[by],
                "" if each is None else f"{published:.1f}",
                "" if each is None else f"{each:.2f}",
                counts[by],
                f"{moved[what] / MB:.1f}",
                f"{here:.2f}",
                change(here, each),
                differs,
            )
        )
    return rows


def bytes_table(measuring: Measuring) -> list[tuple]:
    """Of the first view."""
    names = (ALIKE_IN_GAUSSIANS, ALIKE_IN_PAIRS)
    outcomes = measuring.gscore([(find_scene(name), LEGO_SIZE, ()) for name in names])
    return [row for name, o in zip(names, outcomes) for row in lego_rows(name, o.views[0])]


RATES_HEAD = (
    "scene",
    "Gaussians",
    "size",
    "pairs",
    "passes",
    "MB on the bus",
    "published ",
    "frames/s",
    "published",
    "here over published",
)


def rate_row(outcome: Outcome, published: tuple[float, float | None]) -> tuple:
    views, (rate_published, mb) = outcome.views, published
    here = rate(views)
    return (
        outcome.run.scene.name,
        views[0]["scene"]["gaussians"],
        outcome.run.size,
        round(statistics.fmean(counted(view, "lister", "pairs") for view in views)),
        max(counted(view, "lister", "passes") for view in views),
        f"{statistics.fmean(view['dram']['bus_bytes'] for view in views) / MB:.0f}",
        "" if mb is None else f"{mb}",
        f"{here:.1f}",
        f"{rate_published}",
        f"{here / rate_published:.2f}",
    )


def rates_table(measuring: Measuring, scenes: Sequence[Scene]) -> list[tuple]:
    cases = [(find_scene(ALIKE_IN_GAUSSIANS), LEGO_SIZE, (LEGO_RATE, None))]
    cases += [(scene, size, published) for scene in scenes for size, published in RATES.items()]
    outcomes = measuring.gscore([(scene, size, ()) for scene, size, _ in cases])
    return [rate_row(o, published) for o, (_, _, published) in zip(outcomes, cases)]


def ablation_table(measuring: Measuring, cases: Sequence[tuple[Scene, str]]) -> list[tuple]:
    kinds = (NEITHER, ORIENTED, ())
    outcomes = iter(measuring.gscore([(s, size, keys) for s, size in cases for keys in kinds]))
    rates = {(s.name, keys): rate(next(outcomes).views) for s, _ in cases for keys in kinds}
    return [
        (name, published, *(f"{rates[s.name, gained] / rates[s.name, base]:.2f}" for s, _ in cases))
        for name, base, gained, published in GAINS
    ]


def make_tables(arguments: argparse.Namespace) -> None:
    """Raises ValueError before the first simulation for what is no scene or view."""
    here = [name for name in ("park",) if name in shared_names()]
    scenes = find_scenes(arguments.scenes or [*here, *RATE_SCENES])
    ablated = [
        (find_scene(name), size)
        for name, size in ABLATION_CASES
        if name.startswith("builtin:") or name in shared_names()
    ]
    alike = [find_scene(name) for name in (ALIKE_IN_GAUSSIANS, ALIKE_IN_PAIRS)]
    for scene in dict.fromkeys([*scenes, *alike, *(scene for scene, _ in ablated)]):
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    measuring = Measuring(arguments)
    bytes_rows = bytes_table(measuring)
    rate_rows = rates_table(measuring, scenes)
    gain_rows = ablation_table(measuring, ablated)
    gpu_rows = published_gpu.rows_of(measuring.of_gpu())
    made = run_arguments.how_made(measuring.made_of)
    out = arguments.out
    tables.write(out, "published_bytes", made, BYTES_HEAD, bytes_rows)
    tables.write(out, "published_rates", made, RATES_HEAD, rate_rows)
    head = ("gain of", "published", *(f"{scene.name}, {size}" for scene, size in ablated))
    tables.write(out, "published_ablations", made, head, gain_rows)
    tables.write(out, "published_gpu", made, published_gpu.HEAD, gpu_rows)


def main() -> int:
    parser = run_arguments.parser(__doc__, "as said above")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="number of a camera, or all")
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
