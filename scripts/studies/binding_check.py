"""Whether the resource that a view's `binding` names is the one whose doubling gains most: the
answers of `streaminggs what-if`, a line for each view. Makes binding_check."""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import pathlib
import sys
import tempfile

import tables
from tables import SCENE, VIEW, Column
from runs import run_arguments
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import Run, answered, program_provenance

JOBS = ("results.py binding_check",)

COLUMNS = (
    SCENE,
    VIEW,
    Column("M cycles", "of the frame", "10^6 cycles", ".3f"),
    Column("binding names", "key of the resource that `binding` says holds the frame"),
    Column("its doubling saves", "share of the frame's cycles; empty: not doubled", "", ".1%"),
    Column("gains most", "key whose doubling saves most"),
    Column("that saves", "share of the frame's cycles", "", ".1%"),
    Column("named gains most", "whether the two are one, or save the same but for noise"),
    Column("noise", "those of the two that save no more than the noise of a frame"),
    Column("why not", "verdict of what-if"),
)


def row(scene: str, answer: dict) -> tuple:
    """Of what-if on one view."""
    doubled = [each for each in answer.get("doubled", []) if "refused" not in each]
    gains = {each["key"]: each["time_saved"] for each in doubled}
    best = max(gains, key=gains.get, default="")
    right = answer["named_gains_most"]
    base = answer["base"]
    noise = {each["key"] for each in doubled if each["time_below_noise"]}
    noisy = [key for key in dict.fromkeys((base["holds_key"], best)) if key in noise]
    return (
        *(scene, answer["view"], base["cycles"] / 1e6),
        *(base["holds_key"], gains.get(base["holds_key"]), best, gains.get(best)),
        *(right, ", ".join(noisy), "" if right else answer["verdict"]),
    )


def ask(arguments: argparse.Namespace, scene: Scene) -> list[tuple]:
    """Raises Failure, and ValueError where the command refuses."""
    run = Run(scene, arguments.view, arguments.size, arguments.config, tuple(arguments.set))
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        out = pathlib.Path(folder) / "what_if.json"
        words = [*run.arguments(), "--out", str(out)]
        answered(arguments.streaminggs, "what-if", words, run.label())
        print(run.label(), file=sys.stderr, flush=True)
        return [row(scene.name, answer) for answer in json.loads(out.read_text())]


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "all real scenes")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to, "640x360")
    to.add_argument("--config", default="exact", help="preset or JSON file")
    run_arguments.add_settings(to, "the configuration")


def make(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or shared_names())
    with concurrent.futures.ThreadPoolExecutor(arguments.side_by_side) as pool:
        waiting = [pool.submit(ask, arguments, scene) for scene in scenes]
        try:
            rows = [row for each in waiting for row in each.result()]
        finally:
            pool.shutdown(cancel_futures=True)
    by = tables.made(arguments.streaminggs, [program_provenance(arguments.streaminggs)], scenes)
    right = sum(row[-3] for row in rows)
    about = f"The resource named gains most on {right} of {len(rows)} views."
    tables.write(arguments.out, "binding_check", by, COLUMNS, rows, about)
