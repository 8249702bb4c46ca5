"""The study that says whether a scene loads machines as the paper's did."""

from __future__ import annotations

import argparse
import dataclasses
import statistics
from collections.abc import Callable, Mapping

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.scenes import find_scenes, view_numbers_there
from runs.simulations import Run, mean
from studies.cases import Measured, model_all, modelled, simulated
from studies.claims import REAL, SYNTHETIC, Kind, Views, dropped_percent
from studies.synthetic import add_synthetic, synthetic_scenes
from tables import SCENE, Column, Spread, Study

CAPTURES = tuple(f"builtin:capture?n={millions}000000" for millions in (1, 2, 3))
PAPER = "paper_text_no_vq"  # what the filters drop depends on no codebooks, which take long to make
MEAN = "mean of the captures"


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


def of_kind(kind: Kind) -> tuple[Statistic, ...]:
    """What a scene of that kind is accepted by."""
    gpu, gscore, _ = kind.rates
    real = kind is REAL
    return (
        Statistic(
            *("GPU, frames/s", f"{gpu:g}"),
            lambda found: modelled(found.gpu).frames_a_second(),
            *(0.8 * gpu, 1.2 * gpu),
        ),
        Statistic(
            *("GSCore, frames/s", f"{gscore:g}"),
            lambda found: simulated(found.gscore).frames_a_second(),
            *(0.75 * gscore, 1.25 * gscore),
        ),
        Statistic(
            *("GPU, intermediate bytes, %", "85" if real else ""),
            lambda found: intermediate_percent(modelled(found.gpu)),
            *((80, 90) if real else ()),
        ),
        Statistic(
            *("voxels with a Gaussian", ""),
            lambda found: found.paper[0]["scene"]["voxels"],
            *((500, 3000) if real else ()),
        ),
        *OF_ALL,
    )


OF_ALL = (
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


def rows_of(kind: Kind, by_scene: Mapping[str, Found]) -> list[tuple]:
    return [
        of.row(name, of.measured(found))
        for name, found in by_scene.items()
        for of in of_kind(kind)
    ]


def mean_rows(by_scene: Mapping[str, Found]) -> list[tuple]:
    """Beside what is published, which is a mean; it accepts no scene."""
    rows = [
        of.row(MEAN, statistics.fmean(map(of.measured, by_scene.values()))) for of in of_kind(REAL)
    ]
    return [(*row[:-1], None) for row in rows]


def add_matched_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, "the built-in captures of 1, 2 and 3 M Gaussians")
    add_synthetic(to)
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to)
    to.add_argument("--size", metavar="WxH", help="of a view; without: the paper's, by kind of scene")


def make_matched_scenes(arguments: argparse.Namespace) -> None:
    real = find_scenes(arguments.scenes or list(CAPTURES), arguments.cameras)
    for scene in real:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    scenes = {scene: REAL for scene in real}
    scenes |= {scene: SYNTHETIC for scene in synthetic_scenes(arguments)}
    on_gpu = [Run(scene, arguments.view, arguments.size or kind.size) for scene, kind in scenes.items()]
    runs = [
        dataclasses.replace(run, config=config, overrides=overrides)
        for run, kind in zip(on_gpu, scenes.values())
        for config, overrides in (("gscore", ()), (PAPER, kind.keys))
    ]
    views = [outcome.accepted() for outcome in swept(arguments, "matched_scenes", runs)]
    gpu = model_all(arguments, on_gpu)
    found = [Found(*of) for of in zip(gpu, views[::2], views[1::2])]
    by = tables.made_of(arguments.streaminggs, (view for of in views for view in of), scenes)
    by_kind: dict[Kind, dict[str, Found]] = {REAL: {}, SYNTHETIC: {}}
    for (scene, kind), of in zip(scenes.items(), found):
        by_kind[kind][scene.name] = of
    rows = [row for kind, by_scene in by_kind.items() for row in rows_of(kind, by_scene)]
    rows += mean_rows(by_kind[REAL])
    spread = Spread("scene", "{measured} {matches}")
    tables.write(arguments.out, "matched_scenes", by, COLUMNS, rows, ABOUT, spread)


ABOUT = (
    "Memory of 25.6 GB/s, of the accelerators. The published rates are means over scenes, the real "
    "ones of 1.1 to 3.3 M Gaussians. Captures stand beside the real ones, other scenes here beside "
    "the synthetic ones. `yes` and `no` say whether what is measured matches."
)

MATCHED_SCENES = Study(
    "matched_scenes",
    """Whether a scene loads machines as the scenes of StreamingGS (DAC 2025) did: rates of the
modelled GPU and of GSCore, the share of intermediate bytes on the GPU, the number of voxels, and what
a frame works on. Nothing is fitted to a machine. Makes matched_scenes.
""",
    ("results.py matched_scenes --synthetic lego --train-steps 5000 --gaussians 300000",),
    add_matched_arguments,
    make_matched_scenes,
)
