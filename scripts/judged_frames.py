"""Frames out of the modelled DRAM, beside the pictures that a scene is held to."""

from __future__ import annotations

import math
import pathlib
import statistics
import tempfile
from collections.abc import Callable, Sequence

from runs.kept_runs import KeptRuns
from runs.scenes import Scene
from runs.simulations import Outcome, Run, simulate_into
from target_pictures import TargetPictures, make


class JudgedFrames:
    """Views of runs, each with `target`: `psnr_db` and `ssim` of its frame beside the target
    picture, `reference_psnr_db` and `reference_ssim` of the scene's reference picture (null:
    equal). Kept beside the target pictures."""

    def __init__(self, binary: pathlib.Path, targets: TargetPictures, side_by_side: int):
        self.binary, self.targets = binary, targets
        path = targets.folder / "judged_runs.jsonl"
        self.kept = KeptRuns(binary, path, side_by_side, self.simulated)

    def run(self, name: str, scene: str, view: str, config: str, overrides: Sequence[str]) -> Run:
        of = Scene(name, scene, self.targets.cameras)
        return Run(of, view, self.targets.size, config, tuple(overrides))

    def views(self, runs: Sequence[Run]) -> list[tuple[dict, ...]]:
        """Of each run. Raises Failure, and ValueError for what is refused."""
        return [outcome.accepted() for outcome in self.kept.outcomes(runs)]

    def simulated(self, binary: pathlib.Path, run: Run) -> Outcome:
        with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
            out = pathlib.Path(folder)
            outcome = simulate_into(out, binary, run)
            for view in outcome.views:
                view["target"] = self.beside_target(out / f"view_{view['view']}", view["view"])
        return outcome

    def beside_target(self, folder: pathlib.Path, view: int) -> dict:
        target = self.targets.picture(view)
        psnr_db, ssim = compared(self.binary, folder / "frame.exr", target)
        reference_psnr_db, reference_ssim = compared(self.binary, folder / "reference.exr", target)
        return {
            "psnr_db": psnr_db,
            "ssim": ssim,
            "reference_psnr_db": reference_psnr_db,
            "reference_ssim": reference_ssim,
        }


def compared(
    binary: pathlib.Path, picture: pathlib.Path, target: pathlib.Path
) -> tuple[float | None, float]:
    """PSNR in dB, None where both are equal, and SSIM."""
    lines = make(binary, "compare", [str(picture), str(target)]).splitlines()
    values = {name: float(text) for name, text in (line.split() for line in lines)}
    psnr_db = values["psnr_db"]
    return (psnr_db if math.isfinite(psnr_db) else None), values["ssim"]


def mean(views: Sequence[dict], value: Callable[[dict], float]) -> float:
    return statistics.fmean(value(view) for view in views)


def mean_psnr(views: Sequence[dict], key: str = "psnr_db") -> float:
    """In dB, of the views that differ from their targets; infinite where none does."""
    found = [view["target"][key] for view in views]
    return statistics.fmean([psnr_db for psnr_db in found if psnr_db is not None] or [math.inf])


def psnr_text(views: Sequence[dict], key: str = "psnr_db") -> str:
    psnr_db = mean_psnr(views, key)
    return f"{psnr_db:.2f}" if math.isfinite(psnr_db) else "equal"


def misordered_text(views: Sequence[dict]) -> str:
    """Share of the blends of all views that are behind a splat which is farther away."""
    blends = sum(view["image"]["blends"] for view in views)
    return f"{sum(view['image']['misordered'] for view in views) / max(1, blends):.4f}"


MACHINE_HEAD = ("asked MB", "bus MB", "M cycles", "mJ")


def machine_cells(views: Sequence[dict]) -> tuple[str, ...]:
    """What a frame takes, means over the views."""
    return (
        f"{mean(views, lambda v: v['dram']['bytes']) / 1e6:.2f}",
        f"{mean(views, lambda v: v['dram']['bus_bytes']) / 1e6:.2f}",
        f"{mean(views, lambda v: v['frame']['cycles']) / 1e6:.3f}",
        f"{mean(views, lambda v: v['energy']['total_j']) / 1e-3:.3f}",
    )
