"""Machines that the table of image errors is made of: around the presets of three orders one
thing moved at a time, and a few that combine what paid."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from runs.simulations import group_assignments

EXACT, PAPER, TILES = "exact", "paper", "tiles"
PRESETS = {EXACT: "exact", PAPER: "paper_no_vq", TILES: "gscore_fp32_keys"}
FLOATS = "framebuffer=rgb32f"  # so that errors below those of 8 bits are seen
VQ = ("storage.encoding=vq", "sram.codebook_bytes=256000")
GROUPS = ("32", "48", "64", "96", "128", "160x120")
GROUP_OF_PRESET = {EXACT: "96", PAPER: "64"}
VOXELS = (0.25, 0.5, 2, 4)  # times the preset's side
AS_PRESET = "as the preset"


@dataclasses.dataclass(frozen=True)
class Point:
    """knob: what is moved, value: where to. settings: over preset and base; memories are fitted."""

    order: str
    knob: str
    value: str
    settings: tuple[str, ...]
    preset: str = ""

    def config(self) -> str:
        return self.preset or PRESETS[self.order]

    def overrides(self) -> tuple[str, ...]:
        return (FLOATS, *self.settings)


def blended(precision: str) -> str:
    return f"rendering.precision={precision}"


def moved(order: str, knob: str, key: str, *values: object) -> Iterator[Point]:
    for value in values:
        yield Point(order, knob, str(value), (f"{key}={value}",))


def grouped(order: str) -> Iterator[Point]:
    for shape in GROUPS:
        if shape != GROUP_OF_PRESET[order]:
            yield Point(order, "group px", shape, group_assignments(shape))


def merged() -> Iterator[Point]:
    for policy, name, entries in (
        ("spill", "", (128, 2048)),
        ("blend_early", ", early", (128, 256, 512, 1024)),
    ):
        for n in entries:
            settings = (f"merge.entries={n}", f"merge.on_overflow={policy}")
            yield Point(EXACT, "merge", f"{n}{name}", settings)


def chunked() -> Iterator[Point]:
    """FIFOs of the coarse filters hold two chunks, as in the preset: with less room a larger chunk
    would be measured by its wait."""
    for n in (4, 16, 32, 64):
        settings = (f"storage.chunk_gaussians={n}", f"hfu.candidate_fifo_entries={2 * n}")
        yield Point(EXACT, "chunk", str(n), settings)


def exact_points() -> Iterator[Point]:
    yield Point(EXACT, AS_PRESET, "", ())
    yield from grouped(EXACT)
    yield from chunked()
    yield from merged()
    yield Point(EXACT, "encoding", "half", ("storage.encoding=half",))
    yield Point(EXACT, "encoding", "vq", VQ)
    yield from (Point(EXACT, "precision", p, (blended(p),)) for p in ("fp16", "fixed16"))
    yield Point(EXACT, "finishing", "off", ("rendering.saturation_feedback=false",))
    yield Point(EXACT, "pixels", "rgb8", ("framebuffer=rgb8",))
    half = (blended("fp16"), "storage.encoding=half")
    yield Point(EXACT, "combined", "fp16, half", half)
    yield Point(EXACT, "combined", "fp16, half, rgb8", (*half, "framebuffer=rgb8"))
    yield Point(
        EXACT, "combined", "fixed16, half", (blended("fixed16"), "storage.encoding=half")
    )
    early = ("merge.entries=512", "merge.on_overflow=blend_early")
    yield Point(EXACT, "combined", "fp16, half, early", (*half, *early))
    yield Point(EXACT, "combined", "fp16, vq", (blended("fp16"), *VQ))
    yield Point(EXACT, "combined", "exact_fp16", (), "exact_fp16")
    yield Point(EXACT, "combined", "exact_wide", (), "exact_wide")


def paper_points(voxel: float) -> Iterator[Point]:
    """voxel: side that the preset takes for the scene, world units."""
    yield Point(PAPER, AS_PRESET, "", ())
    yield from grouped(PAPER)
    for factor in VOXELS:
        side = f"storage.voxel_size={factor * voxel:g}"
        yield Point(PAPER, "voxel", f"x {factor:g}", (side,))
    yield from moved(PAPER, "rays", "vsu.ray_step_px", 1, 4)
    whole = ("vsu.visit_gaussians=0", "sorting.buffer_entries=1024")
    yield Point(PAPER, "voxels cut", "never", whole)
    yield Point(PAPER, "encoding", "half", ("storage.encoding=half",))
    yield Point(PAPER, "encoding", "vq", VQ)
    yield Point(PAPER, "precision", "fp32", (blended("fp32"), "rendering.cluster_lanes=190"))
    yield Point(PAPER, "finishing", "off", ("rendering.saturation_feedback=false",))
    yield Point(PAPER, "pixels", "rgb8", ("framebuffer=rgb8",))
    fast = (*group_assignments("160x120"), "hfus=6", "vsu.ray_step_px=4")
    yield Point(PAPER, "combined", "160x120, 6 HFUs, rays 4", fast)
    larger = (*fast, f"storage.voxel_size={2 * voxel:g}")
    yield Point(PAPER, "combined", "the same, voxels x 2", larger)


def tile_points() -> Iterator[Point]:
    yield Point(TILES, AS_PRESET, "", ())
    yield Point(TILES, "precision", "fixed16", (blended("fixed16"),))
    yield Point(TILES, "precision", "fp32", (), "gscore_lossless")
    yield Point(TILES, "combined", "gscore", (), "gscore")
    yield Point(TILES, "pixels", "rgb8", ("framebuffer=rgb8",))


def points(voxel: float) -> list[Point]:
    return [*exact_points(), *paper_points(voxel), *tile_points()]
