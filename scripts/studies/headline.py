"""What is shown first, in the README.md of the project: machines over their baselines, from tables that
other studies made. Areas come from a short run of each preset. Makes

  headline         speed-up, energy and area of each pair, and what their pictures are
  headline_scenes  speed-up and energy by scene of frames alone, which the figure headline shows

Scenes are trained, none is built in. `compare_machines_cases` has pairs of one precision; neither
machine asks for tuning. `compare_machines_ratios` tells what their pictures are, over all that was
compared. `fair_fight_summary` has what a search found for each order in one area.
"""

from __future__ import annotations

import argparse
import dataclasses
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
from studies.cases import ALL_SIZES
from studies.found import ROUNDING_DB
from tables import SCENE, Column, Made, Study

Pair = tuple[str, str]  # machine, baseline
Ratio = tuple[float, float | None]  # speed-up; energy, None: not measured
Ratios = Mapping[str, Ratio]  # by scene
Cells = Mapping[str, str]

CASES, RATIOS, SEARCHED = "compare_machines_cases", "compare_machines_ratios", "fair_fight_summary"
READS = {"compare_machines": [CASES, RATIOS], "fair_fight": [SEARCHED]}
TABLES = tuple(name for names in READS.values() for name in names)


@dataclasses.dataclass(frozen=True)
class Frames:
    """How frames follow each other and with which memory; columns of CASES with the ratios."""

    text: str
    channels: int
    gb_s: str
    speed: str
    energy: str = ""


ALONE = Frames("alone, 25.6 GB/s", 4, "25.6", "times as fast", "times less energy")
OVERLAPPED = Frames("overlapped, 51.2 GB/s", 8, "51.2", "both overlapped")
BASELINE = "gscore_lossless_boxes"
PAIRS: Sequence[Pair] = (
    ("exact_fast", BASELINE),
    ("exact", BASELINE),
    ("exact_fp16", "gscore_boxes"),
)
# From SEARCHED: what was found for each, in one area.
SEARCHED_PAIRS: Mapping[Pair, str] = {
    ("exact", "gscore"): "exact order / GSCore, both searched",
    ("exact", "paper"): "exact order / paper order in half precision, both searched",
}
TECHNOLOGY = REPOSITORY / "testbench" / "cost" / "technology_32nm.json"
AREA_RUN = ("builtin:object?n=2000", "96x96")  # areas of presets hardly depend on the scene

PAIR = Column("machine / baseline", "presets, or what a search found for an order")
COLUMNS = (
    PAIR,
    Column("frames", "one after the other, or begun as fast as the busiest part lets: a bound"),
    Column("speed-up", "time of the baseline over the machine's", "", ".2f"),
    Column(
        "energy, baseline over machine", "joules of a frame alone; empty: overlapped", "", ".2f"
    ),
    Column(
        "area ratio", "machine over baseline, without the memory's PHY and controller", "", ".2f"
    ),
    Column(
        "area ratio with PHY and controller", "of the memory's channels; empty: unknown", "", ".2f"
    ),
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


def compared(rows: Sequence[Cells], pair: Pair, frames: Frames) -> Ratios:
    """Raises ValueError where no trained scene has this pair."""
    sizes: dict[str, list[Ratio]] = {}
    for row in rows:
        trained = not row["scene"].startswith("builtin:")
        if trained and row["GB/s"] == frames.gb_s and (row["machine"], row["than"]) == pair:
            energy = float(row[frames.energy]) if frames.energy else None
            sizes.setdefault(row["scene"], []).append((float(row[frames.speed]), energy))
    if not sizes:
        raise ValueError(f"{CASES}.csv: no trained scene of {named(pair)} at {frames.gb_s} GB/s")
    return {scene: geometric(of) for scene, of in sizes.items()}


def geometric(ratios: Sequence[Ratio]) -> Ratio:
    speeds, energies = zip(*ratios)
    energy = None if None in energies else statistics.geometric_mean(energies)
    return statistics.geometric_mean(speeds), energy


def picture(own: Sequence[float], other: Sequence[float], single: bool) -> str:
    """What two pictures are, by ends of their PSNR. single: both in single precision, of which what
    is above ROUNDING_DB is the reference picture in 8 bits."""
    if single and min(*own, *other) >= ROUNDING_DB:
        return "both: the reference picture"
    whose = ("", ", baseline ")
    said = (f"{name}{between(ends, single)}" for name, ends in zip(whose, (own, other)))
    return ("" if single else "in half precision, ") + "".join(said)


def between(ends: Sequence[float], single: bool) -> str:
    if single and min(ends) >= ROUNDING_DB:
        return "the reference picture"
    return f"{min(ends):.1f} .. {max(ends):.1f} dB"


def compared_picture(rows: Sequence[Cells], pair: Pair, frames: Frames) -> str:
    """By RATIOS, over all sizes. Raises ValueError where it has no such row, or one of two
    precisions."""
    wanted = (*pair, frames.gb_s, ALL_SIZES)
    for row in rows:
        if (row["machine"], row["than"], row["GB/s"], row["sizes"]) == wanted:
            if row["precision"] not in ("fp32", "fp16"):
                break
            own, other = (
                [float(row[f"{whose}dB, {end}"]) for end in ("least", "most")]
                for whose in ("", "its ")
            )
            return picture(own, other, row["precision"] == "fp32")
    raise ValueError(
        f"{RATIOS}.csv: got no row of {named(pair)} at {frames.gb_s} GB/s, sizes {ALL_SIZES}, in one "
        "precision"
    )


def searched_row(rows: Sequence[Cells], pair: Pair) -> tuple:
    """Of what was found for either, over the sizes. Its area is without PHY and controller. Raises
    ValueError where a search is missing."""
    own, other = (
        {row["size px"]: row for row in rows if row["machine"].startswith(f"{order}, ")}
        for order in pair
    )
    if not own or own.keys() != other.keys():
        raise ValueError(
            f"{SEARCHED}.csv: got no machine of each size that was found for {' and '.join(pair)}"
        )

    def over(column: str) -> float:
        return statistics.geometric_mean(
            float(other[size][column]) / float(own[size][column]) for size in own
        )

    ends = (
        [float(row[f"PSNR dB, {end}"]) for row in of.values() for end in ("least", "most")]
        for of in (own, other)
    )
    ratios = (over("M cycles"), over("mJ"), 1 / over("mm2"), None)
    return (SEARCHED_PAIRS[pair], ALONE.text, *ratios, picture(*ends, single=True))


def area_mm2(
    program: pathlib.Path, preset: str, channels: int, technology: pathlib.Path
) -> tuple[float, dict]:
    """And the provenance."""
    scene, size = AREA_RUN
    run = Run(find_scene(scene), size=size, config=preset, overrides=(f"dram.channels={channels}",))
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as out:
        words = [*run.arguments(), "--technology", str(technology), "--out", out]
        answered(program, "simulate", words, run.label())
        (view,) = read_json(pathlib.Path(out) / "report.json")["views"]
    return view["area_mm2"]["total"], view["provenance"]


def area_ratios(program: pathlib.Path, pair: Pair, channels: int) -> tuple[list[float], list[dict]]:
    """Without and with PHY and controller of the memory."""
    ratios, provenances = [], []
    for counted in (False, True):
        table = read_json(TECHNOLOGY)
        table["memory_interface"]["counted"] = counted
        with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
            technology = pathlib.Path(folder) / TECHNOLOGY.name
            write_text(technology, json.dumps(table))
            (own, of_own), (other, _) = (
                area_mm2(program, preset, channels, technology) for preset in pair
            )
        ratios.append(own / other)
        provenances.append(of_own)
    return ratios, provenances


def searches(rows: Sequence[Cells]) -> str:
    """How many machines each judged, and how it ended."""
    found = {row["machine"].partition(",")[0]: row for row in rows if row["judged"]}
    return "; ".join(f"{name} {row['judged']}, ended {row['ended']}" for name, row in found.items())


def about(scenes: Sequence[str], searched: Sequence[Cells]) -> str:
    return (
        "Geometric means over trained scenes; below 1 the baseline is ahead. Alone: a frame begins "
        "when the one before it has ended. Overlapped: when the busiest part is free, a bound that no "
        f"machine here reaches. Beside presets: {', '.join(scenes)}, two sizes each. Both searched: "
        f"each with the fastest machine that a search found in the area of {BASELINE}, on untuned "
        f"scenes; machines judged: {searches(searched)}. Splats at one depth blend in the order in "
        "which a machine stores them."
    )


def add_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--from",
        dest="tables",
        type=pathlib.Path,
        default=REPOSITORY / "traces" / "results",
        metavar="FOLDER",
        help=f"with {', '.join(TABLES)}",
    )
    run_arguments.add_program(to)


def make(arguments: argparse.Namespace) -> None:
    read = {name: tables.read_rows(arguments.tables, name) for name in TABLES}
    ratios = {
        (pair, frames): compared(read[CASES], pair, frames)
        for frames in (ALONE, OVERLAPPED)
        for pair in PAIRS
    }
    rows, provenances = [], []
    for (pair, frames), of_scenes in ratios.items():
        areas, told = area_ratios(arguments.streaminggs, pair, frames.channels)
        means = geometric(list(of_scenes.values()))
        pictures = compared_picture(read[RATIOS], pair, frames)
        rows.append((named(pair), frames.text, *means, *areas, pictures))
        provenances += told
    rows += [searched_row(read[SEARCHED], pair) for pair in SEARCHED_PAIRS]
    scenes = [
        (named(pair), scene, *of)
        for (pair, frames), of_scenes in ratios.items()
        if frames is ALONE
        for scene, of in of_scenes.items()
    ]
    by = made_from(arguments, provenances)
    text = about(list(ratios[PAIRS[0], ALONE]), read[SEARCHED])
    tables.write(arguments.out, "headline", by, COLUMNS, rows, text)
    tables.write(arguments.out, "headline_scenes", by, SCENE_COLUMNS, scenes, text)


def made_from(arguments: argparse.Namespace, provenances: Sequence[dict]) -> Made:
    """Of the tables that it is from as well. inputs: their digests."""
    own = tables.made(arguments.streaminggs, provenances)
    sources = {name: tables.facts_of(arguments.tables, name)["made"] for name in TABLES}

    def all_of(key: str, of_own: Sequence[str]) -> tuple[str, ...]:
        return tuple(sorted({*of_own, *(each for made in sources.values() for each in made[key])}))

    digests = {f"{name}.csv": content_digest(arguments.tables / f"{name}.csv") for name in sources}
    return Made(
        *(own.command, all_of("commits", own.commits), all_of("releases", own.releases)),
        *(own.program, digests),
    )


HEADLINE = Study("headline", __doc__, ("results.py headline",), add_arguments, make, READS)
