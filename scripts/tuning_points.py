"""Short tunings and trainings that the diagrams of errors share: scenes tuned to paper order at
several rates, data sets trained with several budgets of Gaussians."""

from __future__ import annotations

import argparse
import pathlib
import sys
from collections.abc import Iterator

import tunings
from runs.fittings import Fitted, Fitting, KeptFittings
from judged_frames import JudgedFrames
from runs.scenes import Scene
from subjects import Subject
from target_pictures import target_pictures

LOOKS = 8  # at the test views on the way


def kept_fittings(arguments: argparse.Namespace) -> KeptFittings:
    return KeptFittings(arguments.streaminggs, arguments.out / "fittings", 1)


def tuning(scene: Scene, rate: float, arguments: argparse.Namespace) -> Fitting:
    """To paper order in single precision; no L_CBP, which slows a step and gains no decibel."""
    facts = (scene.name, scene.spec, scene.cameras, arguments.tuning_size, arguments.between)
    subject = Subject(*facts)
    words = (scene.spec, "--boundary", "--config", tunings.PAPER, "--beta", "0")
    words += tunings.set_words(("rendering.precision=fp32", "sram.shared_bytes=0"))
    words += (*subject.target_words(), "--rate", f"{rate:g}")
    words += ("--steps", str(arguments.steps), "--test-every", looks_every(arguments.steps))
    return Fitting(f"{scene.name} short rate {rate:g}", "tune", words)


def training(folder: pathlib.Path, budget: int, arguments: argparse.Namespace) -> Fitting:
    words = (str(folder), "--downscale", f"{arguments.downscale:g}", "--gaussians", str(budget))
    steps = arguments.train_steps
    words += ("--steps", str(steps), "--test-every", looks_every(steps))
    return Fitting(f"{folder.name} short of {budget}", "train", words)


def looks_every(steps: int) -> str:
    return str(max(1, steps // LOOKS))


def tuned_frames(
    scene: Scene, arguments: argparse.Namespace, config: str, overrides: tuple[str, ...]
) -> Iterator[tuple[str, tuple[dict, ...]]]:
    """`before` and `after` with the views of each frame, judged beside the pictures of the scene as
    given. None of a scene that brings its own cameras: `target` needs a file of them."""
    if not scene.cameras:
        print(f"{scene.name}: no file of cameras, not tuned", file=sys.stderr)
        return
    fittings = kept_fittings(arguments)
    fitted: Fitted = fittings.all([tuning(scene, 1, arguments)])[0]
    subject = Subject(scene.name, scene.spec, scene.cameras, arguments.size)
    targets = target_pictures(
        arguments.streaminggs, fittings.program, arguments.out / "targets", subject
    )
    judged = JudgedFrames(arguments.streaminggs, targets, 1)
    view = ",".join(arguments.views)
    states = (("before", scene.spec), ("after", str(fitted.scene)))
    runs = [
        judged.run(f"{scene.name} {state}", spec, view, config, overrides) for state, spec in states
    ]
    for (state, _), views in zip(states, judged.views(runs)):
        yield state, views
