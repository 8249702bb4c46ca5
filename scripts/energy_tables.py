#!/usr/bin/env python3
"""Where the energy of a frame goes in both orders, and what the size of the pixel group does to it.

Writes energy_components.md: energy by component with the band that the sources leave, a column for
each scene; and energy_groups.md and .csv: energy, bytes, cycles and area against the group's size,
arithmetic means over the scenes, so that the columns of a row add up. Rows carry the name of the
preset that was run. Both orders are charged what was counted on our filters (hfu.cost=counted).
On-chip memory is as large as each group needs. The ordering table of paper order has the preset's
bytes and, in groups of more pixels than the preset's, as many times more. What was simulated is
kept in energy_runs.jsonl.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
from collections.abc import Callable, Sequence

from runs import run_arguments
from results import tables
from energy_components import OTHER, components, joules, joules_at_end
from runs.group_shapes import assignments
from runs.kept_runs import KeptRuns
from measures import value_at
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import SRAM_AS_NEEDED, Run

RUNS_FILE = "energy_runs.jsonl"
# Second halves raw in both: codebooks are compare_variants.py's business.
PRESETS = ("exact", "paper_no_vq")
# One rule for both: paper order's presets charge a test what the paper states of its filters.
SAME_COST = "hfu.cost=counted"
GROUPS = ["16", "32", "48", "64", "96", "128", "160x120", "160x180"]
MJ = 1e-3

def with_band(view: dict, keys: Sequence[str]) -> str:
    """The memory's band is that of the published sets of currents; the total's has none of it."""
    middle = joules(view, keys)
    if keys == OTHER["DRAM"]:
        ends = [*view["energy"]["dram_by_current_set_j"].values(), middle]
    else:
        ends = [joules_at_end(view, keys, end) for end in ("low", "high")]
    return f"{middle / MJ:.3f} ({min(ends) / MJ:.3f} .. {max(ends) / MJ:.3f})"


def component_rows(by_preset: dict[str, Sequence[dict]]) -> list[tuple]:
    rows = []
    for preset, views in by_preset.items():
        for name, keys in components(views[0]).items():
            rows.append((preset, name, *(with_band(view, keys) for view in views)))
    return rows


def table_bytes(config: dict, shape: Sequence[str]) -> tuple[str, ...]:
    """The ordering table, where the machine has one, for groups of this shape."""
    if (bytes_of_preset := value_at(config, "vsu.table_bytes")) is None:
        return ()
    sides = [int(assignment.partition("=")[2]) for assignment in shape]
    pixels_of_preset = config["group_width_px"] * config["group_height_px"]
    times = max(1.0, math.prod(sides) / pixels_of_preset)
    return (f"vsu.table_bytes={math.ceil(bytes_of_preset * times)}",)


GROUP_HEAD = (
    "preset",
    "group px",
    "DRAM mJ",
    "SRAM mJ",
    "logic mJ",
    "clock and leakage mJ",
    "all mJ",
    "bus MB",
    "asked MB",
    "M cycles",
    "mm2",
    "SRAM KiB",
    "ordering table B",
)


def group_row(preset: str, shape: str, views: Sequence[dict]) -> tuple:
    """Means over the scenes; area and memory of the scene that needs most."""

    def mean(value: Callable[[dict], float]) -> float:
        return statistics.fmean(value(view) for view in views)

    def of(view: dict, wanted: Callable[[str], bool]) -> float:
        keys = [key for name, some in components(view).items() if wanted(name) for key in some]
        return joules(view, keys) / MJ

    memories = ("SRAM: pixels", "SRAM: all else")
    logic = [name for name in components(views[0]) if name not in (*memories, *OTHER)]
    sram = max(sum(v["sram"][f"{m}_bytes"] for m in ("input", "codebook", "shared")) for v in views)
    return (
        preset,
        shape,
        f"{mean(lambda v: of(v, lambda name: name == 'DRAM')):.3f}",
        f"{mean(lambda v: of(v, memories.__contains__)):.3f}",
        f"{mean(lambda v: of(v, logic.__contains__)):.3f}",
        f"{mean(lambda v: of(v, ('clock', 'leakage').__contains__)):.3f}",
        f"{mean(lambda v: of(v, lambda name: name == 'all')):.3f}",
        f"{mean(lambda v: v['dram']['bus_bytes']) / 1e6:.2f}",
        f"{mean(lambda v: v['dram']['bytes']) / 1e6:.2f}",
        f"{mean(lambda v: v['frame']['cycles']) / 1e6:.3f}",
        f"{max(v['area_mm2']['total'] for v in views):.2f}",
        f"{sram / 1024:.0f}",
        value_at(views[0]["config"], "vsu.table_bytes") or "",
    )


class Measuring:
    def __init__(self, arguments: argparse.Namespace, scenes: Sequence[Scene]):
        path = arguments.out / RUNS_FILE
        self.kept = KeptRuns(arguments.streaminggs, path, arguments.side_by_side)
        self.arguments, self.scenes = arguments, scenes

    def views(self, preset: str, overrides: Sequence[str] = ()) -> list[dict]:
        """Of all scenes. Raises ValueError where one is refused."""
        arguments = self.arguments
        words = (*SRAM_AS_NEEDED, SAME_COST, *overrides, *arguments.set)
        runs = [
            Run(scene, arguments.view, arguments.size, preset, words) for scene in self.scenes
        ]
        return [outcome.accepted()[0] for outcome in self.kept.outcomes(runs)]


def make_tables(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--groups", arguments.groups)
    groups = {shape: assignments(shape) for shape in arguments.groups}
    scenes = find_scenes(arguments.scenes or shared_names())
    measuring = Measuring(arguments, scenes)
    shipped = {preset: measuring.views(preset) for preset in PRESETS}
    made = run_arguments.how_made(view for views in shipped.values() for view in views)
    made += f"View {arguments.view} at {arguments.size} px, {SAME_COST}.\n\n"
    head = ("preset", "mJ of", *(scene.name for scene in scenes))
    tables.write(arguments.out, "energy_components", made, head, component_rows(shipped))
    rows = []
    for preset in PRESETS:
        config = shipped[preset][0]["config"]
        for shape, keys in groups.items():
            views = measuring.views(preset, (*keys, *table_bytes(config, keys)))
            rows.append(group_row(preset, shape, views))
    made += "Arithmetic means over the scenes; area and memory of the scene that needs most.\n\n"
    tables.write(arguments.out, "energy_groups", made, GROUP_HEAD, rows)
    measuring.kept.end()


def main() -> int:
    parser = run_arguments.parser(__doc__, "all real scenes")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="number of a camera")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="in px")
    parser.add_argument(
        "--groups", nargs="+", default=GROUPS, metavar="SHAPE", help="in px: SIDE or WxH"
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over both presets"
    )
    return run_arguments.main_of_tables(make_tables, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
