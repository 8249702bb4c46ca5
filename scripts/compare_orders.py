#!/usr/bin/env python3
"""Exact order beside paper order, every view of the given scenes: quality, traffic by region,
cycles, and the unit that binds. For each size writes compare_orders_SIZE.md and .csv, a line each
view, and compare_orders_SIZE_summary.md with the means of each scene.

Traffic and time are of frames stored as rgb8 (3 B a pixel). Their PSNR would be that of 8-bit
pixels, so quality is taken from a second simulation of each view that stores floats.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import statistics
import sys
from collections.abc import Sequence

import run_arguments
import tables
from scenes import Scene, find_scenes
from simulations import Run, psnr_text, region_bytes, simulate_all

# Second halves as they are in both: what codebooks cost is compare_variants.py's business.
PRESETS = {"exact": "exact", "paper": "paper_no_vq"}
# Megabytes a view at 640x360, mean of four: exact order with 64x64 groups and an unlimited merge
# buffer, measured with a functional prototype without timing. A yardstick, not a result.
YARDSTICK_MB = {
    "truck": 13.3,
    "playbot": 20.1,
    "platform": 15.6,
    "yard": 57.8,
    "garden": 21.9,
    "park": 56.9,
}
YARDSTICK_SIZE = "640x360"
MB = 1e6


@dataclasses.dataclass(frozen=True)
class Measured:
    """A view in one order."""

    scene: str
    size: str
    order: str
    traffic: dict  # report of the rgb8 frame
    quality: dict  # report of the rgb32f frame

    def regions(self) -> dict[str, int]:
        names = self.traffic["dram"]["bytes_by_region"]
        return {name: count for name in names if (count := region_bytes(self.traffic, name))}


def measure(arguments: argparse.Namespace, scenes: Sequence[Scene], size: str) -> list[Measured]:
    cases = list(itertools.product(scenes, PRESETS))
    runs = []
    for scene, order in cases:
        run = Run(scene, arguments.view, size, PRESETS[order], tuple(arguments.set))
        floats = (*run.overrides, "framebuffer=rgb32f")
        runs += [run, dataclasses.replace(run, overrides=floats)]
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    measured = []
    for scene, order in cases:
        traffic, quality = next(outcomes).accepted(), next(outcomes).accepted()
        measured += [Measured(scene.name, size, order, t, q) for t, q in zip(traffic, quality)]
    return measured


HEAD = (
    "scene",
    "view",
    "order",
    "PSNR dB",
    "DRAM MB",
    "x once",
    "k cycles",
    "fps",
    "binding unit",
    "MB by region",
)


def text_row(m: Measured) -> tuple:
    t = m.traffic
    regions = ", ".join(f"{name} {count / MB:.2f}" for name, count in m.regions().items())
    return (
        m.scene,
        t["view"],
        m.order,
        psnr_text(m.quality),
        f"{t['dram']['bytes'] / MB:.2f}",
        f"{t['limit']['ratio']:.2f}",
        round(t["frame"]["cycles"] / 1e3),
        f"{t['frame']['fps']:.0f}",
        f"{t['binding']['unit']} {t['binding']['utilisation']:.0%}",
        regions,
    )


def csv_rows(measured: Sequence[Measured]) -> tuple[list[str], list[list]]:
    regions = sorted({name for m in measured for name in m.traffic["dram"]["bytes_by_region"]})
    head = ["size_px", "scene", "view", "order", "psnr_db", "ssim", "missed", "misordered"]
    head += ["blends", "dram_bytes", "bytes_read_once", "limit_ratio", "cycles", "fps"]
    head += ["binding_unit", "binding_utilisation", "next_unit", "next_utilisation"]
    head += ["simulation_wall_s", *(f"{name}_bytes" for name in regions)]
    rows = []
    for m in measured:
        t, image, binding = m.traffic, m.quality["image"], m.traffic["binding"]
        psnr_db = "inf" if image["psnr_db"] is None else image["psnr_db"]
        row = [m.size, m.scene, t["view"], m.order, psnr_db, image["ssim"]]
        row += [image["missed"], image["misordered"], image["blends"]]
        row += [t["dram"]["bytes"], t["limit"]["bytes_read_once"], t["limit"]["ratio"]]
        row += [t["frame"]["cycles"], t["frame"]["fps"]]
        row += [binding["unit"], binding["utilisation"]]
        row += [binding["next"], binding["next_utilisation"]]
        row += [t["host"]["simulation_wall_s"]]
        row += [region_bytes(t, name) for name in regions]
        rows.append(row)
    return head, rows


SUMMARY_HEAD = (
    "scene",
    "exact MB",
    "yardstick MB",
    "paper MB",
    "exact / once",
    "exact M cycles",
    "paper M cycles",
    "exact fps",
    "paper fps",
    "exact PSNR dB",
    "paper PSNR dB",
    "misordered blends, paper",
    "exact binds",
)


def summary_row(size: str, scene: str, of: dict[str, list[Measured]]) -> tuple:
    """Means over the views of a scene, frames a second of the mean time; PSNR as a range."""

    def mean(order: str, *path: str) -> float:
        return statistics.fmean(value_at(m.traffic, path) for m in of[order])

    def psnr(order: str) -> str:
        values = [m.quality["image"]["psnr_db"] for m in of[order]]
        finite = [value for value in values if value is not None]
        if not finite:
            return "equal"
        return span(
            f"{min(finite):.1f}",
            "equal" if len(finite) < len(values) else f"{max(finite):.1f}",
        )

    yardstick = YARDSTICK_MB.get(scene) if size == YARDSTICK_SIZE else None
    blends = sum(m.quality["image"]["blends"] for m in of["paper"])
    misordered = sum(m.quality["image"]["misordered"] for m in of["paper"])
    binders = [m.traffic["binding"] for m in of["exact"]]
    units = sorted({b["unit"] for b in binders})
    lowest, highest = (pick(b["utilisation"] for b in binders) for pick in (min, max))
    return (
        scene,
        f"{mean('exact', 'dram', 'bytes') / MB:.1f}",
        "" if yardstick is None else f"{yardstick:.1f}",
        f"{mean('paper', 'dram', 'bytes') / MB:.1f}",
        f"{mean('exact', 'limit', 'ratio'):.2f}",
        f"{mean('exact', 'frame', 'cycles') / 1e6:.2f}",
        f"{mean('paper', 'frame', 'cycles') / 1e6:.2f}",
        f"{1 / mean('exact', 'frame', 'time_s'):.0f}",
        f"{1 / mean('paper', 'frame', 'time_s'):.0f}",
        psnr("exact"),
        psnr("paper"),
        f"{misordered / max(1, blends):.0%}",
        f"{', '.join(units)} {span(f'{lowest:.0%}', f'{highest:.0%}')}",
    )


def span(low: str, high: str) -> str:
    return low if low == high else f"{low} .. {high}"


def value_at(report: dict, path: Sequence[str]) -> float:
    for key in path:
        report = report[key]
    return report


def summary_rows(measured: Sequence[Measured]) -> list[tuple]:
    grouped: dict[tuple[str, str], dict[str, list[Measured]]] = {}
    for m in measured:
        grouped.setdefault((m.size, m.scene), {}).setdefault(m.order, []).append(m)
    return [summary_row(size, scene, of) for (size, scene), of in grouped.items()]


def make_tables(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes)
    for size in arguments.sizes:
        measured = measure(arguments, scenes, size)
        made = run_arguments.how_made(m.traffic for m in measured)
        summary = made + tables.markdown(SUMMARY_HEAD, summary_rows(measured))
        views = made + tables.markdown(HEAD, [text_row(m) for m in measured])
        name = f"compare_orders_{size}"
        tables.write_text(arguments.out / f"{name}.md", views)
        tables.write_text(arguments.out / f"{name}.csv", tables.csv_text(*csv_rows(measured)))
        tables.write_text(arguments.out / f"{name}_summary.md", summary)
        print(f"{size} px\n\n{views}\n{summary}")


def main() -> int:
    parser = run_arguments.parser(__doc__)
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    parser.add_argument(
        "--sizes", nargs="+", default=["640x360", "1280x720"], metavar="WxH", help="in px"
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over both presets"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
