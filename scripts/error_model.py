"""Error of the model's numbers against the wall time that they take: estimates of seeded random
machines beside simulations of the same, which are what counts as right here."""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable, Sequence

import run_arguments
import tables
from estimate_error import MEASURES, SIDES, Frame, compared_frames
from scenes import Scene

FIDELITIES = ("accurate", "estimate")
HEAD = ("scene", "fidelity", "frames", "seconds", "most seconds") + tuple(
    f"{name} {what} %" for name, _ in MEASURES for what in ("median", "worst")
)
CSV_HEAD = ("scene", "machine", "fidelity", "seconds", *(f"{name} %" for name, _ in MEASURES))
MACHINES = "exact"  # estimates are of this order alone


def seconds(frame: Frame, fidelity: str) -> float:
    return SIDES[FIDELITIES.index(fidelity)](frame)["host"]["simulation_wall_s"]


def error(frame: Frame, fidelity: str, of: Callable[[dict], float]) -> float:
    """In per cent, with its sign."""
    return 100 * frame.error(of) if fidelity == "estimate" else 0.0


def csv_rows(frames: Sequence[Frame]) -> list[tuple]:
    return [
        (f.scene, f.machine, fidelity, seconds(f, fidelity))
        + tuple(error(f, fidelity, of) for _, of in MEASURES)
        for fidelity in FIDELITIES
        for f in frames
    ]


def summary_rows(frames: Sequence[Frame], scenes: Sequence[str]) -> list[tuple]:
    rows = []
    for scene in scenes:
        of_scene = [f for f in frames if f.scene == scene]
        for fidelity in FIDELITIES if of_scene else ():
            took = [seconds(f, fidelity) for f in of_scene]
            numbers = []
            for _, of in MEASURES:
                sizes = [abs(error(f, fidelity, of)) for f in of_scene]
                numbers += [f"{statistics.median(sizes):.2f}", f"{max(sizes):.2f}"]
            times = (f"{statistics.median(took):.2f}", f"{max(took):.2f}")
            rows.append((scene, fidelity, len(of_scene), *times, *numbers))
    return rows


def make(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    """Raises Failure, ValueError."""
    asked = {**vars(arguments), "machine": MACHINES, "view": arguments.views[0]}
    frames, refused = compared_frames(scenes, argparse.Namespace(**asked))
    made = run_arguments.how_made(f.accurate for f in frames)
    rows = summary_rows(frames, [scene.name for scene in scenes])
    text = made + f"{refused} frames were refused.\n\n" + tables.markdown(HEAD, rows)
    tables.write_text(arguments.out / "error_model.md", text)
    told = tables.csv_text(CSV_HEAD, csv_rows(frames))
    tables.write_text(arguments.out / "error_model.csv", told)
    print(text)
