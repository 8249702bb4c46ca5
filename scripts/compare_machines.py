#!/usr/bin/env python3
"""Machines beside each other: the same scenes, views, DRAM, ledger and precision of scenes; and the
original rasteriser on a mobile GPU, which is modelled, not simulated. Writes

  compare_machines.md         a line for each scene, memory and machine: means over the views
  compare_machines_ratios.md  times as fast and times less energy: geometric means over the scenes,
                              with the range
  characterisation.md         what the GPU and the tile-centric machine move, and what they would
                              have to move at 90 frames a second

and all as .csv. Without SCENE: the real scenes that there are at --sizes, or at --object-sizes those
that show an object, the built-in ones, and a built-in one of a million Gaussians.
"""

from __future__ import annotations

import argparse
import dataclasses
import statistics
import sys
from collections.abc import Callable, Sequence

import run_arguments
import tables
from gpu_views import gpu_views
from scenes import Scene, find_scene, shared_names
from simulations import Run, simulate_all
from view_numbers import binders, decibels

MACHINES = (
    "gscore",
    "gscore_lossless",
    "paper",
    "paper_no_vq",
    "paper_no_cgf",
    "paper_no_vq_cgf",
    "exact",
    "exact_vq",
)
GPU = "GPU, modelled"
OBJECTS = ("truck", "playbot", "builtin:object")  # by the beginning of their names
BUILT_IN = ("builtin:object", "builtin:outdoor", "builtin:outdoor?n=1000000")
PIXELS = ("frame_buffer",)
# What a machine writes and reads again within a frame.
INTERMEDIATE = ("projected", "tile_lists", "subsets", "spill")
MB, MJ = 1e6, 1e-3
WISHED_FPS = 90

Views = Sequence[dict]


@dataclasses.dataclass(frozen=True)
class Case:
    scene: Scene
    size: str
    channels: int


@dataclasses.dataclass(frozen=True)
class Measured:
    """Means over the views of a case; bytes on the bus of the GPU are those that it asks for."""

    seconds: float
    scene_bytes: float
    intermediate_bytes: float
    pixel_bytes: float
    joules: float
    dram_joules: float | None
    mm2: float | None
    quality: str
    binds: str

    def bytes(self) -> float:
        return self.scene_bytes + self.intermediate_bytes + self.pixel_bytes


def mean(views: Views, value: Callable[[dict], float]) -> float:
    return statistics.fmean(value(view) for view in views)


def bus_bytes(view: dict, regions: Sequence[str]) -> int:
    by_region = view["dram"]["bus_bytes_by_region"]
    return sum(count for region, count in by_region.items() if region in regions)


def measured(views: Views) -> Measured:
    def of(regions: Sequence[str]) -> float:
        return mean(views, lambda v: bus_bytes(v, regions))

    everything = mean(views, lambda v: v["dram"]["bus_bytes"])
    worst = min(map(decibels, views))
    return Measured(
        seconds=mean(views, lambda v: v["frame"]["time_s"]),
        scene_bytes=everything - of(INTERMEDIATE) - of(PIXELS),
        intermediate_bytes=of(INTERMEDIATE),
        pixel_bytes=of(PIXELS),
        joules=mean(views, lambda v: v["energy"]["total_j"]),
        dram_joules=mean(views, lambda v: v["energy"]["dram_j"]),
        mm2=max(v["area_mm2"]["total"] for v in views),
        quality="equal" if worst == float("inf") else f"{worst:.1f}",
        binds=binders(views),
    )


def modelled(views: Views) -> Measured:
    def of(kind: str) -> float:
        return mean(views, lambda v: sum(stage[f"{kind}_bytes"] for stage in v["stages"]))

    return Measured(
        seconds=mean(views, lambda v: v["seconds"]),
        scene_bytes=of("scene"),
        intermediate_bytes=of("intermediate"),
        pixel_bytes=of("frame"),
        joules=mean(views, lambda v: v["joules"]),
        dram_joules=None,
        mm2=None,
        quality="",
        binds="",
    )


HEAD = (
    "scene",
    "size",
    "GB/s",
    "machine",
    "frames/s",
    "scene MB",
    "intermediate MB",
    "pixels MB",
    "mJ",
    "of it DRAM",
    "mm2",
    "least dB",
    "binds",
)


def row(case: Case, memory: str, machine: str, m: Measured) -> tuple:
    return (
        case.scene.name,
        case.size,
        memory,
        machine,
        f"{1 / m.seconds:.1f}",
        f"{m.scene_bytes / MB:.2f}",
        f"{m.intermediate_bytes / MB:.2f}",
        f"{m.pixel_bytes / MB:.2f}",
        f"{m.joules / MJ:.2f}",
        "" if m.dram_joules is None else f"{m.dram_joules / MJ:.2f}",
        "" if m.mm2 is None else f"{m.mm2:.2f}",
        m.quality,
        m.binds,
    )


RATIO_HEAD = (
    "GB/s",
    "machine",
    "than",
    "cases",
    "times as fast",
    "range",
    "times less energy",
    "range ",
    "mm2 over",
)


def spread(values: Sequence[float]) -> tuple[str, str]:
    return f"{statistics.geometric_mean(values):.2f}", f"{min(values):.2f} .. {max(values):.2f}"


def ratio_row(memory: str, machine: str, than: str, pairs: Sequence[tuple]) -> tuple:
    """pairs: of the machine and of the other one, for each case."""
    faster = spread([other.seconds / own.seconds for own, other in pairs])
    cheaper = spread([other.joules / own.joules for own, other in pairs])
    areas = [own.mm2 / other.mm2 for own, other in pairs if own.mm2 and other.mm2]
    area = f"{statistics.geometric_mean(areas):.2f}" if areas else ""
    return (memory, machine, than, len(pairs), *faster, *cheaper, area)


CHARACTER_HEAD = (
    "scene",
    "size",
    "machine",
    "frames/s",
    "MB a frame",
    f"GB/s at {WISHED_FPS} frames/s",
    "scene %",
    "intermediate %",
    "pixels %",
)


def character_row(case: Case, machine: str, m: Measured) -> tuple:
    parts = (m.scene_bytes, m.intermediate_bytes, m.pixel_bytes)
    return (
        case.scene.name,
        case.size,
        machine,
        f"{1 / m.seconds:.1f}",
        f"{m.bytes() / MB:.1f}",
        f"{WISHED_FPS * m.bytes() / 1e9:.2f}",
        *(f"{100 * part / m.bytes():.0f}" for part in parts),
    )


def sizes_of(name: str, arguments: argparse.Namespace) -> list[str]:
    is_object = any(name == text or name.startswith(f"{text}?") for text in OBJECTS)
    return arguments.object_sizes if is_object else arguments.sizes


def find_cases(arguments: argparse.Namespace) -> list[Case]:
    scenes = [find_scene(text) for text in arguments.scenes or [*BUILT_IN, *shared_names()]]
    return [
        Case(scene, size, channels)
        for scene in scenes
        for size in sizes_of(scene.name, arguments)
        for channels in arguments.channels
    ]


def memory_of(views: Views) -> str:
    return f"{views[0]['dram']['peak_gb_s']:.1f}"


def make_tables(arguments: argparse.Namespace) -> None:
    cases = find_cases(arguments)
    runs = [
        Run(case.scene, arguments.view, case.size, machine, (f"dram.channels={case.channels}",))
        for case in cases
        for machine in arguments.machines
    ]
    outcomes = simulate_all(arguments.streaminggs, runs, arguments.side_by_side)
    views_of = iter([outcome.accepted() for outcome in outcomes])
    modelled_of: dict[tuple[str, str], Measured] = {}
    rows, characters, all_views = [], [], []
    by_memory: dict[str, list[dict[str, Measured]]] = {}
    for case in cases:
        found: dict[str, Measured] = {}
        for machine in arguments.machines:
            views = next(views_of)
            all_views += views
            memory = memory_of(views)
            found[machine] = measured(views)
            rows.append(row(case, memory, machine, found[machine]))
        key = (case.scene.spec, case.size)
        if key not in modelled_of:
            frames = gpu_views(arguments.streaminggs, case.scene, arguments.view, case.size)
            modelled_of[key] = modelled(frames)
            rows.append(row(case, "", GPU, modelled_of[key]))
            characters.append(character_row(case, GPU, modelled_of[key]))
            if "gscore" in found:
                characters.append(character_row(case, "gscore", found["gscore"]))
        by_memory.setdefault(memory, []).append({**found, GPU: modelled_of[key]})
    ratios = [
        ratio_row(memory, machine, than, [(of[machine], of[than]) for of in found])
        for memory, found in by_memory.items()
        for than in (GPU, *(name for name in ("gscore", "gscore_lossless") if name in found[0]))
        for machine in arguments.machines
        if machine != than
    ]
    made = run_arguments.how_made(all_views)
    tables.write(arguments.out, "compare_machines", made, HEAD, rows)
    tables.write(arguments.out, "compare_machines_ratios", made, RATIO_HEAD, ratios)
    tables.write(arguments.out, "characterisation", made, CHARACTER_HEAD, characters)


def main() -> int:
    parser = run_arguments.parser(__doc__, "as said above")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="all", help="number of a camera, or all")
    parser.add_argument(
        "--sizes", nargs="+", default=["640x360", "980x545"], metavar="WxH", help="in px"
    )
    parser.add_argument(
        "--object-sizes",
        nargs="+",
        default=["640x360", "800x800"],
        metavar="WxH",
        help="of scenes that show an object, in px",
    )
    parser.add_argument(
        "--channels",
        nargs="+",
        type=int,
        default=[4, 8],
        metavar="N",
        help="of LPDDR3-1600, 6.4 GB/s each",
    )
    parser.add_argument(
        "--machines", nargs="+", default=list(MACHINES), metavar="PRESET", help="to compare"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
