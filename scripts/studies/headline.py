"""What is shown first, in the README.md of the project: machines over their baselines, from tables that
other studies made. Areas come from a short run of each preset. Makes

  headline         speed-up, energy and area of each pair, and what their pictures are
  headline_scenes  speed-up and energy by scene, which the figure headline shows

Scenes are trained, none is built in. `compare_machines_cases` has pairs of one precision; neither
machine asks for tuning. `quality_machine` has scenes that were tuned to either order, with codebooks.
"""

from __future__ import annotations

import argparse
import json
import pathlib
import statistics
import tempfile
from collections.abc import Mapping, Sequence

import tables
from runs import run_arguments
from runs.files import content_digest, read_json, write_text
from runs.scenes import REPOSITORY, answered, find_scene
from runs.simulations import Run
from tables import SCENE, Column, Made, Study

Pair = tuple[str, str]  # machine, baseline
Ratios = Mapping[str, tuple[float, float]]  # by scene: speed-up, energy

CASES, TUNED = "compare_machines_cases", "quality_machine"
# From CASES: what both pictures of a pair are.
PICTURES: Mapping[Pair, str] = {
    ("exact_fast", "gscore_lossless"): "both: the reference picture",
    ("exact", "gscore_lossless"): "both: the reference picture",
    ("exact_fp16", "gscore_fp32_keys"): "both: in half precision",
}
# From TUNED: both have codebooks, each of a scene that was tuned to it.
TUNED_PAIR = ("exact_vq", "paper")
TUNED_TO = "quantisation-aware"
GB_S = "25.6"
TECHNOLOGY = REPOSITORY / "testbench" / "cost" / "technology_32nm.json"
AREA_RUN = ("builtin:object?n=2000", "96x96")  # areas of presets hardly depend on the scene

PAIR = Column("machine / baseline", "presets")
COLUMNS = (
    PAIR,
    Column("speed-up", "time of the baseline over the machine's", "", ".2f"),
    Column("energy, baseline over machine", "joules of a frame", "", ".2f"),
    Column(
        "area ratio", "machine over baseline, without the memory's PHY and controller", "", ".2f"
    ),
    Column("area ratio with PHY and controller", "of the memory's channels", "", ".2f"),
    Column("picture", "8 bits a channel; dB beside photographs or the scene's own pictures"),
)
SCENE_COLUMNS = (
    PAIR,
    SCENE,
    Column("speed-up", "geometric mean over the sizes", "", ".2f"),
    Column("energy, baseline over machine", "geometric mean over the sizes", "", ".2f"),
)


def named(pair: Pair) -> str:
    return " / ".join(pair)


def compared(rows: Sequence[Mapping[str, str]], pair: Pair) -> Ratios:
    """Raises ValueError where no trained scene has this pair."""
    sizes: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        trained = not row["scene"].startswith("builtin:")
        if trained and row["GB/s"] == GB_S and (row["machine"], row["than"]) == pair:
            found = float(row["times as fast"]), float(row["times less energy"])
            sizes.setdefault(row["scene"], []).append(found)
    if not sizes:
        raise ValueError(f"{CASES}.csv: no trained scene of {named(pair)} at {GB_S} GB/s")
    return {scene: geometric(of) for scene, of in sizes.items()}


def geometric(pairs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    faster, frugal = (statistics.geometric_mean(values) for values in zip(*pairs))
    return faster, frugal


def tuned_rows(rows: Sequence[Mapping[str, str]], preset: str) -> dict[str, Mapping[str, str]]:
    """By scene. Raises ValueError where there are none."""
    found = {r["scene"]: r for r in rows if (r["preset"], r["tuned"]) == (preset, TUNED_TO)}
    if not found:
        raise ValueError(f"{TUNED}.csv: no scene of {preset} that is {TUNED_TO}")
    return found


def tuned(rows: Sequence[Mapping[str, str]]) -> tuple[Ratios, str]:
    """And both pictures."""
    own, other = (tuned_rows(rows, preset) for preset in TUNED_PAIR)
    ratios = {
        scene: tuple(float(other[scene][n]) / float(own[scene][n]) for n in ("M cycles", "mJ"))
        for scene in own
    }
    ends = [[float(row["PSNR dB"]) for row in of.values()] for of in (own, other)]
    text = [f"{min(of):.1f} .. {max(of):.1f} dB" for of in ends]
    return ratios, f"{text[0]}, baseline {text[1]}"


def area_mm2(program: pathlib.Path, preset: str, technology: pathlib.Path) -> tuple[float, dict]:
    """And the provenance."""
    scene, size = AREA_RUN
    run = Run(find_scene(scene), size=size, config=preset)
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as out:
        words = [*run.arguments(), "--technology", str(technology), "--out", out]
        answered(program, "simulate", words, run.label())
        (view,) = read_json(pathlib.Path(out) / "report.json")["views"]
    return view["area_mm2"]["total"], view["provenance"]


def area_ratios(program: pathlib.Path, pair: Pair) -> tuple[list[float], list[dict]]:
    """Without and with PHY and controller of the memory."""
    ratios, provenances = [], []
    for counted in (False, True):
        table = read_json(TECHNOLOGY)
        table["memory_interface"]["counted"] = counted
        with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
            technology = pathlib.Path(folder) / TECHNOLOGY.name
            write_text(technology, json.dumps(table))
            (own, of_own), (other, _) = (area_mm2(program, preset, technology) for preset in pair)
        ratios.append(own / other)
        provenances.append(of_own)
    return ratios, provenances


def about(compared_scenes: Sequence[str], tuned_scenes: Sequence[str]) -> str:
    return (
        f"Geometric means over trained scenes, frames alone, {GB_S} GB/s. First rows: "
        f"{', '.join(compared_scenes)}, two sizes each. Last row: {', '.join(tuned_scenes)}, small "
        "pictures, each tuned to either machine; dB beside photographs or own pictures."
    )


def add_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--from",
        dest="tables",
        type=pathlib.Path,
        default=REPOSITORY / "traces" / "results",
        metavar="FOLDER",
        help=f"with {CASES} and {TUNED}",
    )
    run_arguments.add_program(to)


def make(arguments: argparse.Namespace) -> None:
    cases, states = (tables.read_rows(arguments.tables, name) for name in (CASES, TUNED))
    ratios = {pair: compared(cases, pair) for pair in PICTURES}
    ratios[TUNED_PAIR], of_tuned = tuned(states)
    pictures = {**PICTURES, TUNED_PAIR: of_tuned}
    areas = {pair: area_ratios(arguments.streaminggs, pair) for pair in pictures}
    rows = [
        (named(pair), *geometric(list(ratios[pair].values())), *areas[pair][0], pictures[pair])
        for pair in pictures
    ]
    scenes = [(named(pair), scene, *of) for pair in ratios for scene, of in ratios[pair].items()]
    by = made_from(arguments, [p for _, provenances in areas.values() for p in provenances])
    first = next(iter(PICTURES))
    text = about(list(ratios[first]), list(ratios[TUNED_PAIR]))
    tables.write(arguments.out, "headline", by, COLUMNS, rows, text)
    tables.write(arguments.out, "headline_scenes", by, SCENE_COLUMNS, scenes, text)


def made_from(arguments: argparse.Namespace, provenances: Sequence[dict]) -> Made:
    """Of the tables that it is from as well. inputs: their digests."""
    own = tables.made(arguments.streaminggs, provenances)
    sources = {name: tables.facts_of(arguments.tables, name)["made"] for name in (CASES, TUNED)}

    def all_of(key: str, of_own: Sequence[str]) -> tuple[str, ...]:
        return tuple(sorted({*of_own, *(each for made in sources.values() for each in made[key])}))

    digests = {f"{name}.csv": content_digest(arguments.tables / f"{name}.csv") for name in sources}
    return Made(
        *(own.command, all_of("commits", own.commits), all_of("releases", own.releases)),
        *(own.program, digests),
    )


HEADLINE = Study("headline", __doc__, ("results.py headline",), add_arguments, make)
