"""Frames of the original rasteriser on a mobile GPU, as `streaminggs gpu` models them."""

from __future__ import annotations

import json
import pathlib
import tempfile
import time

from runs.simulations import REFUSED, Failure, Outcome, Run, call, said

# What a run of the model has in the place of a preset.
MODEL = "gpu"


def model_gpu(binary: pathlib.Path, run: Run) -> Outcome:
    """The views of a run, each as the model's report has it, with `peak_gb_s`. Raises Failure when
    it fails."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        report = pathlib.Path(folder) / "gpu.json"
        words = [run.scene.spec, "--view", run.view, "--out", str(report)]
        words += ["--cameras", run.scene.cameras] if run.scene.cameras else []
        words += ["--size", run.size] if run.size else []
        words += [word for override in run.overrides for word in ("--set", override)]
        began = time.monotonic()
        done = call(binary, words, "gpu")
        seconds = time.monotonic() - began
        if done.returncode == REFUSED:
            return Outcome(run, refused=said(done), seconds=seconds)
        if done.returncode != 0:
            raise Failure(f"{run.label()}: {said(done)}")
        made = json.loads(report.read_text())
        peak = {"peak_gb_s": made["gpu"]["bandwidth_gb_s"]}
        return Outcome(run, views=tuple(v | peak for v in made["views"]), seconds=seconds)
