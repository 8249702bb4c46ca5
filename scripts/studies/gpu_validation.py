"""The model of the GPU beside figures that authors of other accelerators and renderers publish."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

import tables
from runs.scenes import find_scene, find_scenes, program_provenance, shared_names
from runs.simulations import Run
from studies.cases import MODEL, model_all
from studies.published import TIME, shares
from tables import Column

REAL_SIZE = "980x545"
OUTDOOR = ("builtin:outdoor?n=2300000", "1160x800")
AS_GBU = ("builtin:outdoor?n=3300000", "1245x825")
GBU = ("GBU", "at most 1245 x 825 px, another power mode")
SPEEDY_SPLAT = ("Speedy-Splat's authors", "RTX A5000, mean of 13 scenes")
STAGES = {
    "projection": ("projection",),
    "duplication": ("duplication",),
    "sort and ranges": ("sort", "ranges"),
    "rendering": ("rendering",),
}
GPU_ABOUT = (
    "Least and most of the views. GSCore's Fig. 2b gives rendering 55 to 75 % of the time, sorting "
    "20 to 35, the rest 4 to 15."
)
GPU_COLUMNS = (
    Column("source", "who published the figure"),
    Column("published of", "what the source drew, and on what"),
    Column("quantity", "what is compared"),
    Column("unit", "of both figures"),
    Column("published", "as published"),
    Column("modelled, least", "over the views", "", ".3g"),
    Column("modelled, most", "over the views", "", ".3g"),
    Column("modelled scene", "and its size in px"),
)


def intermediate_percent(view: dict) -> float:
    kinds = ("scene_bytes", "intermediate_bytes", "frame_bytes")
    moved = [sum(stage[kind] for stage in view["stages"]) for kind in kinds]
    return 100 * moved[1] / sum(moved)


def gpu_rows(
    outdoor: Sequence[dict], as_gbu: Sequence[dict], real: Sequence[dict], scenes: str
) -> Iterator[tuple]:
    def row(source: Sequence[str], quantity: str, unit: str, published: float, of, where: str):
        return (*source, quantity, unit, published, min(of), max(of), where)

    percents = [intermediate_percent(view) for view in outdoor]
    streaminggs = ("StreamingGS", "real scenes, 1.1 to 3.3 million Gaussians")
    yield row(streaminggs, "intermediate bytes", "% of bytes", 85, percents, ", ".join(OUTDOOR))
    rates = [1 / view["seconds"] for view in as_gbu]
    yield row(GBU, "rate", "frames a second", 13, rates, ", ".join(AS_GBU))
    joules = [view["joules"] for view in as_gbu]
    yield row(GBU, "energy", "J a frame", 1.27, joules, ", ".join(AS_GBU))
    for name, stages in STAGES.items():
        of = shares(real, stages, "time")
        yield row(SPEEDY_SPLAT, f"time of {name}", "%", TIME[stages[0]], of, scenes)


def make_gpu(arguments: argparse.Namespace) -> None:
    """Without real scenes the outdoor one stands for them."""
    scenes = find_scenes(arguments.scenes or shared_names() or [OUTDOOR[0]], arguments.cameras)
    cases = [(find_scene(spec), size) for spec, size in (OUTDOOR, AS_GBU)]
    runs = [Run(scene, "all", size, MODEL) for scene, size in cases]
    runs += [Run(scene, "all", REAL_SIZE, MODEL) for scene in scenes]
    outdoor, as_gbu, *real = model_all(arguments, runs)
    where = f"{', '.join(scene.name for scene in scenes)}, {REAL_SIZE}"
    rows = gpu_rows(outdoor, as_gbu, [view for of in real for view in of], where)
    by = tables.made(arguments.streaminggs, [program_provenance(arguments.streaminggs)], scenes)
    tables.write(arguments.out, "gpu_checks", by, GPU_COLUMNS, rows, GPU_ABOUT)
