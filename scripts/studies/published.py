"""Studies of what is published beside what is measured here."""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import Scene, find_scene, find_scenes, shared_names, view_numbers_there
from runs.simulations import (
    MB,
    Outcome,
    Run,
    bus_mb,
    mean,
    region_bytes,
)
from studies.cases import MODEL, model_all
from tables import SCENE, SIZE, Column, Spread, Study

BANDWIDTH = ("dram.channels=8",)  # 8 x LPDDR3-1600 x32 are the published 51.2 GB/s

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

# StreamingGS's GPU. What the model was set to says nothing of how good it is.
CALIBRATED_TO = 4.9
GPU_CASES = (
    ("builtin:outdoor?n=2300000", "1160x800", CALIBRATED_TO),
    ("builtin:object?n=334000", "800x800", 8.5),
)
# Shares in per cent. Speedy-Splat, of a desktop GPU; StreamingGS, of the mobile one.
TIME = {"projection": 9, "duplication": 8, "sort": 21, "ranges": None, "rendering": 60}
BYTES = {"projection": 41, "sorting": 49, "rendering": 10}
SORTING = ("duplication", "sort", "ranges")

BYTES_COLUMNS = (
    SCENE,
    Column("what", "that a frame reads or writes"),
    Column("counted by", "what its bytes are divided by"),
    Column("published count", "of these", "", ","),
    Column("MB", "published", "MB", ".1f"),
    Column("B each", "published bytes over published count", "B", ".2f"),
    Column("count here", "of these", "", ","),
    Column("MB asked for", "requested by units here", "MB", ".1f"),
    Column("B each here", "requested bytes over count here", "B", ".2f"),
    Column("B each, here over published", "less 1", "", "+.0%"),
    Column("what differs", "between the two"),
)
RATES_COLUMNS = (
    SCENE,
    Column("Gaussians", "of the scene", "", ","),
    SIZE,
    Column("pairs", "of a tile and a splat, mean over the views", "", ",.0f"),
    Column("passes", "most over the views, of the lister", "", "d"),
    Column("MB on the bus", "mean over the views", "MB", ".0f"),
    Column("MB, published", "of a frame", "MB", ".0f"),
    Column("frames/s", "mean over the views", "1/s", ".1f"),
    Column("frames/s, published", "mean over the scenes of the source", "1/s"),
    Column("over published", "frames/s here over the published", "", ".2f"),
)
GAIN_COLUMNS = (
    Column("gain of", "what is added"),
    Column("published", "times as fast"),
    SCENE,
    Column("times", "as fast here", "", ".2f"),
)
GPU_COLUMNS = (
    SCENE,
    SIZE,
    Column("what", "rate, or share in per cent of time or bytes by stage"),
    Column("published", "by its source"),
    Column("modelled, least", "of the views", "", ".3g"),
    Column("modelled, most", "of the views", "", ".3g"),
    Column("residual, least", "rates: over published, less 1; shares: points", "", "+.2g"),
    Column("residual, most", "the same of the most", "", "+.2g"),
)


def counted(view: dict, units: str, counter: str) -> int:
    """Sum over the units whose names begin so."""
    found = [unit for name, unit in view["units"].items() if name.startswith(units)]
    return sum(unit["counters"][counter] for unit in found)


def directed(view: dict, direction: str, *regions: str) -> int:
    by_region = view["dram"]["bytes_by_region"]
    requesters = [both for region in regions for both in by_region.get(region, {}).values()]
    return sum(both.get(direction, 0) for both in requesters)


def rate(views: Sequence[dict]) -> float:
    return 1 / mean(views, lambda view: view["frame"]["time_s"])


def bytes_rows(name: str, view: dict) -> list[tuple]:
    lists = ("tile_lists", "subsets")
    moved = {
        "features in": region_bytes(view, "first_halves") + region_bytes(view, "second_halves"),
        "lists out": directed(view, "write", *lists),
        "lists in": directed(view, "read", *lists),
        "pixels out": region_bytes(view, "frame_buffer"),
        "projected features out": directed(view, "write", "projected"),
        "projected features in": directed(view, "read", "projected"),
    }
    counts = {
        "Gaussians": view["scene"]["gaussians"],
        "pairs": counted(view, "lister", "pairs"),
        "pixels": view["frame"]["width_px"] * view["frame"]["height_px"],
        "records written": counted(view, "lister", "records"),
        "records read": counted(view, "rendering", "records"),
    }
    width, height = map(int, LEGO_SIZE.split("x"))
    of_published = {"Gaussians": LEGO_GAUSSIANS, "pairs": LEGO_PAIRS, "pixels": width * height}
    rows = []
    for what, by, published, differs in LEGO_BYTES:
        here = moved[what] / counts[by]
        each = published and published * MB / of_published[by]
        rows.append(
            (
                *(name, what, by, of_published[by] if each else None, published, each),
                *(counts[by], moved[what] / MB, here, here / each - 1 if each else None, differs),
            )
        )
    return rows


def rate_row(outcome: Outcome, published: tuple[float, float | None]) -> tuple:
    views, (rate_published, mb) = outcome.views, published
    return (
        outcome.run.scene.name,
        views[0]["scene"]["gaussians"],
        outcome.run.size,
        mean(views, lambda view: counted(view, "lister", "pairs")),
        max(counted(view, "lister", "passes") for view in views),
        *(mean(views, bus_mb), mb, rate(views), rate_published, rate(views) / rate_published),
    )


def shares(views: Sequence[dict], stages: Sequence[str], value: str) -> list[float]:
    """Of each view, in per cent of all its stages."""

    def of(stage: dict) -> float:
        kinds = ("scene_bytes", "intermediate_bytes", "frame_bytes")
        return stage["seconds"] if value == "time" else sum(stage[kind] for kind in kinds)

    all_of = [sum(map(of, view["stages"])) for view in views]
    some = [sum(of(s) for s in view["stages"] if s["name"] in stages) for view in views]
    return [100 * part / whole for part, whole in zip(some, all_of)]


def gpu_rows(spec: str, size: str, published: float, views: Sequence[dict]) -> list[tuple]:
    here = 1 / statistics.fmean(view["seconds"] for view in views)
    over = here / published - 1
    what = "frames/s, calibrated to" if published == CALIBRATED_TO else "frames/s"
    rows = [(spec, size, what, published, here, here, over, over)]
    for value, published_shares in (("time", TIME), ("bytes", BYTES)):
        for name, percent in published_shares.items():
            of = shares(views, SORTING if name == "sorting" else (name,), value)
            ends = (min(of), max(of))
            left = [None if percent is None else end - percent for end in ends]
            rows.append((spec, size, f"{value}, {name} %", percent, *ends, *left))
    return rows


def add_published_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "as said above")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)


def make_published_figures(arguments: argparse.Namespace) -> None:
    """Raises ValueError before the first simulation for what is no scene or view."""
    here = [name for name in ("park",) if name in shared_names()]
    scenes = find_scenes(arguments.scenes or [*here, *RATE_SCENES], arguments.cameras)
    ablated = [
        (find_scene(name), size)
        for name, size in ABLATION_CASES
        if name.startswith("builtin:") or name in shared_names()
    ]
    alike = [find_scene(name) for name in (ALIKE_IN_GAUSSIANS, ALIKE_IN_PAIRS)]
    used = list(dict.fromkeys([*scenes, *alike, *(scene for scene, _ in ablated)]))
    for scene in used:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)

    rated = [(alike[0], LEGO_SIZE, (LEGO_RATE, None))]
    rated += [(scene, size, published) for scene in scenes for size, published in RATES.items()]
    gained = [(s, size, keys) for s, size in ablated for keys in (NEITHER, ORIENTED, ())]
    runs = [
        gscore_run(arguments, scene, size, *keys)
        for scene, size, keys in (
            *((scene, LEGO_SIZE, ()) for scene in alike),
            *((scene, size, ()) for scene, size, _ in rated),
            *gained,
        )
    ]
    outcomes = swept(arguments, "published_figures", runs)
    views = [view for outcome in outcomes for view in outcome.accepted()]
    of_bytes, of_rates = outcomes[: len(alike)], outcomes[len(alike) : -len(gained) or None]
    of_gains = outcomes[len(alike) + len(rated) :]
    gpu_runs = [Run(find_scene(spec), "all", size, MODEL) for spec, size, _ in GPU_CASES]
    by_case = model_all(arguments, gpu_runs)

    out, by = arguments.out, tables.made_of(arguments.streaminggs, views, used)
    rows = [row for o in of_bytes for row in bytes_rows(o.run.scene.name, o.views[0])]
    tables.write(out, "published_bytes", by, BYTES_COLUMNS, rows)
    rows = [rate_row(o, published) for o, (_, _, published) in zip(of_rates, rated)]
    tables.write(out, "published_rates", by, RATES_COLUMNS, rows)
    rates = {(s.name, keys): rate(o.views) for (s, _, keys), o in zip(gained, of_gains)}
    rows = [
        (what, published, f"{s.name}, {size}", rates[s.name, more] / rates[s.name, base])
        for what, base, more, published in GAINS
        for s, size in ablated
    ]
    spread = Spread("scene", "{times}")
    tables.write(out, "published_ablations", by, GAIN_COLUMNS, rows, spread=spread)
    rows = [row for case, of in zip(GPU_CASES, by_case) for row in gpu_rows(*case, of)]
    tables.write(out, "published_gpu", by, GPU_COLUMNS, rows)


def gscore_run(arguments: argparse.Namespace, scene: Scene, size: str, *keys: str) -> Run:
    return Run(scene, arguments.view, size, "gscore", (*BANDWIDTH, *keys))


PUBLISHED_FIGURES = Study(
    "published_figures",
    """What is published of GSCore and of the mobile GPU beside what the preset `gscore` and the model
of the GPU give, where a workload can be matched in size. The published scenes are not these: each
gap stands beside what is known to differ, and nothing is fitted to close it. Makes

  published_bytes      bytes of a frame for an object of as many Gaussians as the published Lego
                       has, and for one of as many pairs; the two counts come from two sources
  published_rates      frames a second at three sizes, scenes of 1 to 2.5 M Gaussians
  published_ablations  gain of oriented boxes and of parts of tiles
  published_gpu        rates, shares of time and of bytes of the original rasteriser

The accelerator has 51.2 GB/s. Without SCENE: park, where it is there, and built-in scenes of 1 M
and 2.5 M Gaussians.
""",
    ("results.py published_figures",),
    add_published_arguments,
    make_published_figures,
)
