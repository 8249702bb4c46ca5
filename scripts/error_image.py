"""Image error against frame time, bytes and energy, a line for each machine, scene and view."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from runs import run_arguments
from results import tables
import tunings
from image_points import PAPER, PRESETS, Point, points
from runs.scenes import Scene
from runs.simulations import Outcome, Run
from subjects import Subject
from runs.sweep_server import SweepServer
from tuning_points import tuned_frames

KEPT = "error_image_runs.jsonl"
HEAD = (
    "scene", "view", "order", "moved", "to", "PSNR dB", "SSIM", "largest", "missed", "misordered",
    "ms", "MB", "mJ", "mm2", "M cycles",
)  # fmt: skip


def row(scene: Scene, point: Point, view: dict, psnr_db: float | None, ssim: float) -> tuple:
    """missed: (group, splat) pairs; misordered: a share of blends."""
    image = view["image"]
    share = image["misordered"] / max(1, image["blends"])
    return (
        scene.name,
        view["view"],
        point.order,
        point.knob,
        point.value,
        "equal" if psnr_db is None else f"{psnr_db:.2f}",
        f"{ssim:.6f}",
        f"{image['max_abs_error']:.3g}",
        image["missed"],
        f"{share:.4f}",
        f"{1e3 * view['frame']['time_s']:.4f}",
        f"{view['dram']['bytes'] / 1e6:.3f}",
        f"{1e3 * view['energy']['total_j']:.4f}",
        f"{view['area_mm2']['total']:.3f}",
        f"{view['frame']['cycles'] / 1e6:.4f}",
    )


def swept_rows(
    scene: Scene, arguments: argparse.Namespace, server: SweepServer
) -> tuple[list[tuple], list[dict]]:
    """And the reports that they are of. What the command refuses is named and left out."""
    voxel = tunings.voxel_of_preset(arguments.streaminggs, Subject(scene.name, scene.spec))
    cases = [(p, view) for p in points(voxel) for view in arguments.views]
    outcomes = server.outcomes(
        [Run(scene, view, arguments.size, p.config(), p.overrides()) for p, view in cases]
    )
    rows, measured = [], []
    for (point, _), outcome in zip(cases, outcomes):
        for view in accepted(outcome):
            image = view["image"]
            rows.append(row(scene, point, view, image["psnr_db"], image["ssim"]))
            measured.append(view)
    return rows, measured


def accepted(outcome: Outcome) -> Sequence[dict]:
    if outcome.refused:
        print(f"left out: {outcome.run.label()}: {outcome.refused}", file=sys.stderr)
    return outcome.views


def tuned_rows(scene: Scene, arguments: argparse.Namespace) -> tuple[list[tuple], list[dict]]:
    """Paper order before and after the scene is tuned to it, PSNR and SSIM beside the pictures of
    the scene as given; the largest error is of the frame beside its own scene's."""
    rows, measured = [], []
    as_preset = Point(PAPER, "tuning", "before", ())
    for state, views in tuned_frames(scene, arguments, PRESETS[PAPER], as_preset.overrides()):
        point = Point(PAPER, "tuning", state, ())
        for view in views:
            target = view["target"]
            rows.append(row(scene, point, view, target["psnr_db"], target["ssim"]))
            measured.append(view)
    return rows, measured


def make(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """Raises Failure, ValueError."""
    rows, measured = [], []
    kept = arguments.out / KEPT
    for scene in scenes:
        # A server of its own: it holds all ways in which points want their scene stored.
        with SweepServer(arguments.streaminggs, kept, arguments.jobs) as server:
            more, views = swept_rows(scene, arguments, server)
            server.end()
        rows, measured = rows + more, measured + views
        print(f"{scene.name}: {len(more)} frames", file=sys.stderr, flush=True)
    for scene in scenes if arguments.steps else ():
        more, views = tuned_rows(scene, arguments)
        rows, measured = rows + more, measured + views
    if not measured:
        raise ValueError("all points are refused")
    order = {scene.name: at for at, scene in enumerate(scenes)}
    rows.sort(key=lambda cells: order[cells[0]])
    tables.write(arguments.out, "error_image", run_arguments.how_made(measured), HEAD, rows)
