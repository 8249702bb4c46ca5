"""Frames of the original rasteriser on a mobile GPU, as `streaminggs gpu` models them."""

from __future__ import annotations

import json
import pathlib
import tempfile

from scenes import Scene
from simulations import REFUSED, Failure, call, said


def gpu_views(binary: pathlib.Path, scene: Scene, view: str, size: str) -> tuple[dict, ...]:
    """A dictionary for each view. Raises ValueError when the command refuses, Failure when it
    fails."""
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        report = pathlib.Path(folder) / "gpu.json"
        words = [scene.spec, "--view", view, "--out", str(report)]
        words += ["--cameras", scene.cameras] if scene.cameras else []
        words += ["--size", size] if size else []
        done = call(binary, words, "gpu")
        if done.returncode == REFUSED:
            raise ValueError(f"{scene.name}: {said(done)}")
        if done.returncode != 0:
            raise Failure(f"{scene.name}: {said(done)}")
        return tuple(json.loads(report.read_text())["views"])
