"""The study of numerical error: of each formula of a Gaussian, in each arithmetic."""

from __future__ import annotations

import argparse
import json
import math
import pathlib
from collections.abc import Sequence

import tables
from runs import run_arguments
from runs.scenes import BINARY, answered, program_provenance
from tables import Column, Study

STABILITY = BINARY.with_name("stability")

KINDS = (
    Column("formula", "what is computed of a Gaussian"),
    Column("form", "how it is written"),
    Column("in", "arithmetic"),
)
STABILITY_COLUMNS = (
    *KINDS,
    Column("over", "axis of the sweep, from its first place to its last"),
    Column("largest error", "of the places before it breaks", "as in the next column", ".1e"),
    Column("error of", "what the error is relative to or measured in"),
    Column("proven at most", "bound of that error; empty: nothing is proven", "", ".1e"),
    Column("by analysis", "law that the error follows"),
    Column("breaks at", "place from which on it is wrong altogether"),
    Column("what breaks, why, what to do", "in words"),
)
PLACE_COLUMNS = (
    *KINDS,
    Column("axis", "what makes it hard"),
    Column("unit", "of the error"),
    Column("place", "on the axis"),
    Column("error", "largest of the samples"),
    Column("bound", "that is proven"),
    Column("error over bound", "largest of the samples"),
    Column("law", "what the analysis says"),
)


def place_text(place: float) -> str:
    """A power of ten as such."""
    power = round(math.log10(place)) if place > 0 else 0
    if place > 0 and (power > 3 or power < -2) and math.isclose(place, 10.0**power):
        return f"10^{power}"
    return f"{place:.4g}"


def before_it_breaks(study: dict) -> Sequence[dict]:
    """The places of a sweep at which it is whole; the first where it never is."""
    places = study["places"]
    whole = [p["place"] for p in places].index(study["breaks_at"]) if broken(study) else len(places)
    return places[: max(whole, 1)]


def broken(study: dict) -> bool:
    return study["breaks_at"] is not None


def kind(study: dict) -> tuple:
    return (study["formula"], study["form"], study["arithmetic"])


def stability_row(study: dict) -> tuple:
    worst = max(before_it_breaks(study), key=lambda place: place["error"] or 0)
    first, last = study["places"][0]["place"], study["places"][-1]["place"]
    return (
        *kind(study),
        f"{study['axis']} {place_text(first)} .. {place_text(last)}",
        worst["error"],
        study["unit"],
        worst["bound"],
        study["law"],
        place_text(study["breaks_at"]) if broken(study) else "nowhere",
        study["why"],
    )


def place_rows(study: dict) -> list[tuple]:
    measured = ("place", "error", "bound", "error_over_bound", "law")
    return [
        (*kind(study), study["axis"], study["unit"], *(place[key] for key in measured))
        for place in study["places"]
    ]


def measured_stability(program: pathlib.Path, samples: int, seed: int) -> list[dict]:
    """Its studies. Raises ValueError when the program refuses or is another one, Failure
    when it fails."""
    out = answered(program, f"--samples={samples}", ["--seed", str(seed)], program.name)
    try:
        return json.loads(out)["studies"]
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{program}: got no studies, expected those of `stability`") from error


def add_stability_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--stability", type=pathlib.Path, default=STABILITY, metavar="PROGRAM", help="that measures"
    )
    to.add_argument("--samples", type=int, default=300, help="random cases at each place")
    to.add_argument("--seed", type=int, default=1, help="of the random cases")


def make_stability_table(arguments: argparse.Namespace) -> None:
    studies = measured_stability(arguments.stability, arguments.samples, arguments.seed)
    by = tables.made(arguments.stability, [program_provenance(arguments.stability)])
    tables.write(arguments.out, "stability", by, STABILITY_COLUMNS, map(stability_row, studies))
    rows = [row for study in studies for row in place_rows(study)]
    tables.save(arguments.out, "stability_places", by, PLACE_COLUMNS, rows)


STABILITY_TABLE = Study(
    "stability_table",
    """How far off every formula of one Gaussian is in float and in half, as the units compute it,
beside 100 decimal digits: the program `stability` measured, each row swept along what makes it
hard. Makes stability, a line a sweep, and stability_places, with every place of every sweep.
""",
    ("results.py stability_table",),
    add_stability_arguments,
    make_stability_table,
)
