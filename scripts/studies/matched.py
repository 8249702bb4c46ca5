"""The study that says whether a made scene loads machines as the paper's captured ones did."""

from __future__ import annotations

import argparse
import dataclasses
import statistics
from collections.abc import Callable, Mapping, Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import find_scenes, view_numbers_there
from runs.simulations import Run, mean
from studies.cases import Measured, model_all, modelled, simulated
from studies.claims import Views
from studies.claims import dropped_percent
from tables import SCENE, Column, Spread, Study

CAPTURES = tuple(f"builtin:capture?n={millions}000000" for millions in (1, 2, 3))
# Shares of what the filters drop do not depend on codebooks, which take long to make.
PAPER = ("paper_text_no_vq", ("storage.voxel_rule=real",))


MEAN = "mean of these"


@dataclasses.dataclass(frozen=True)
class Found:
    """What the original rasteriser, GSCore and the paper's machine took for a scene."""

    gpu: Views
    gscore: Views
    paper: Views

    def work(self, of: Callable[[dict], float]) -> float:
        return mean(self.gpu, lambda view: of(view["work"]))


def intermediate_percent(of: Measured) -> float:
    return 100 * of.bytes("intermediate") / of.bytes()


@dataclasses.dataclass(frozen=True)
class Statistic:
    """published: as text, empty where nothing is. least, most: where it matches, if that is
    asked."""

    name: str
    published: str
    measured: Callable[[Found], float]
    least: float | None = None
    most: float | None = None

    def row(self, name: str, measured: float) -> tuple:
        matches = None
        if self.least is not None and self.most is not None:
            matches = self.least <= measured <= self.most
        return (name, self.name, self.published, self.least, self.most, measured, matches)


STATISTICS = (
    Statistic(
        "GPU, frames/s", "4.9", lambda found: modelled(found.gpu).frames_a_second(), 3.92, 5.88
    ),
    Statistic(
        *("GSCore, frames/s", "106"),
        lambda found: simulated(found.gscore).frames_a_second(),
        *(79.5, 132.5),
    ),
    Statistic(
        *("GPU, intermediate bytes, %", "85"),
        lambda found: intermediate_percent(modelled(found.gpu)),
        *(80, 90),
    ),
    Statistic(
        *("voxels of 2 with a Gaussian", ""),
        lambda found: found.paper[0]["scene"]["voxels"],
        *(500, 3000),
    ),
    Statistic(
        "Gaussians on the screen, %",
        "",
        lambda found: 100 * found.work(lambda w: w["listed"] / w["gaussians"]),
    ),
    Statistic(
        "tiles of a Gaussian on the screen",
        "6.2 Bicycle, 9.4 Lego",
        lambda found: found.work(lambda w: w["pairs"] / w["listed"]),
    ),
    Statistic(
        "Gaussians of a tile", "", lambda found: found.work(lambda w: w["pairs"] / w["tiles"])
    ),
    Statistic(
        "Gaussians of a tile until it is finished",
        "",
        lambda found: found.work(lambda w: w["entries_fetched"] / w["tiles"]),
    ),
    Statistic(
        "blends of a pixel", "", lambda found: found.work(lambda w: w["blends"] / w["pixels"])
    ),
    Statistic(
        *("paper, dropped by both filters, %", "76.3"),
        lambda found: mean(found.paper, dropped_percent),
    ),
    Statistic(
        *("paper, intermediate bytes, %", "0"),
        lambda found: intermediate_percent(simulated(found.paper)),
    ),
)

COLUMNS = (
    SCENE,
    Column("statistic", "of a frame, mean over the views; a rate is of the mean time"),
    Column("published", "of the paper's real scenes, or of the scene that is named"),
    Column("matches from", "least that does", "", "g"),
    Column("to", "most that does", "", "g"),
    Column("measured", "of the scene here", "", ".4g"),
    Column("matches", "whether measured lies there"),
)


def rows_of(by_scene: Mapping[str, Found]) -> list[tuple]:
    measured = {
        of: {name: of.measured(found) for name, found in by_scene.items()} for of in STATISTICS
    }
    rows = [of.row(name, measured[of][name]) for name in by_scene for of in STATISTICS]
    return rows + [of.row(MEAN, statistics.fmean(measured[of].values())) for of in STATISTICS]


def add_matched_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "the built-in captures of 1, 2 and 3 M Gaussians")
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    run_arguments.add_size(to)


def make_matched_scenes(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or list(CAPTURES), arguments.cameras)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    on_gpu = [Run(scene, arguments.view, arguments.size) for scene in scenes]
    machines: Sequence[tuple] = (("gscore", ()), PAPER)
    runs = [dataclasses.replace(run, config=c, overrides=o) for run in on_gpu for c, o in machines]
    views = [outcome.accepted() for outcome in swept(arguments, "matched_scenes", runs)]
    gpu = model_all(arguments, on_gpu)
    found = [Found(*of) for of in zip(gpu, views[::2], views[1::2])]
    by = tables.made_of(arguments.streaminggs, (view for of in views for view in of), scenes)
    rows = rows_of({scene.name: of for scene, of in zip(scenes, found)})
    spread = Spread("scene", "{measured} {matches}")
    tables.write(arguments.out, "matched_scenes", by, COLUMNS, rows, ABOUT, spread)


ABOUT = (
    "Memory of 25.6 GB/s, of the accelerators. The published rates are means over scenes of 1.1 to "
    "3.3 M Gaussians. "
    "`yes` and `no` say whether what is measured matches."
)

MATCHED_SCENES = Study(
    "matched_scenes",
    """Whether a scene loads machines as the real scenes of StreamingGS (DAC 2025) did: rates of the
modelled GPU and of GSCore, the share of intermediate bytes on the GPU, the number of voxels, and what
a frame works on. Nothing is fitted to a machine. Makes matched_scenes.
""",
    ("results.py matched_scenes",),
    add_matched_arguments,
    make_matched_scenes,
)
