#!/usr/bin/env python3
"""How far off every formula of one Gaussian is in float and in half, in the form that the units
compute and in those that were tried, beside 100 decimal digits: the program `stability` measured,
each row swept along what makes it hard. Writes stability.md and stability.csv, the latter with
every place of every sweep."""

from __future__ import annotations

import argparse
import json
import math
import pathlib
import sys
from collections.abc import Sequence

from runs import run_arguments, simulations
from results import tables

PROGRAM = simulations.BINARY.with_name("stability")
REFUSED = 2

HEAD = (
    "formula",
    "form",
    "taken",
    "in",
    "over",
    "largest error",
    "proven at most",
    "by analysis",
    "breaks at",
    "operations",
    "what breaks, why, what to do",
)
CSV_HEAD = (
    "formula",
    "form",
    "taken",
    "arithmetic",
    "axis",
    "unit",
    "place",
    "error",
    "bound",
    "error_over_bound",
    "law",
)


def short(number: float) -> str:
    """Two digits of an error, whatever its size."""
    return f"{number:.1e}" if number and math.isfinite(number) else f"{number:g}"


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


def row_of(study: dict) -> tuple:
    worst = max(before_it_breaks(study), key=lambda place: place["error"] or 0)
    first, last = study["places"][0]["place"], study["places"][-1]["place"]
    bound = worst["bound"]
    return (
        study["formula"],
        study["form"],
        "yes" if study["taken"] else "no",
        study["arithmetic"],
        f"{study['axis']} {place_text(first)} .. {place_text(last)}",
        f"{short(worst['error'])} {study['unit']}",
        "nothing" if bound is None else short(bound),
        study["law"],
        place_text(study["breaks_at"]) if broken(study) else "nowhere",
        study["operations"],
        study["why"],
    )


def csv_rows(study: dict) -> list[tuple]:
    keys = ("formula", "form", "taken", "arithmetic", "axis", "unit")
    measured = ("place", "error", "bound", "error_over_bound", "law")
    return [
        (*(study[key] for key in keys), *(place[key] for key in measured))
        for place in study["places"]
    ]


def measured(program: pathlib.Path, samples: int, seed: int) -> dict:
    """Commit and studies. Raises ValueError when the program refuses or is another one, Failure
    when it fails."""
    done = simulations.call(program, ["--seed", str(seed)], f"--samples={samples}")
    if done.returncode == REFUSED:
        raise ValueError(simulations.said(done))
    if done.returncode != 0:
        raise simulations.Failure(f"{program.name}: {simulations.said(done)}")
    try:
        answer = json.loads(done.stdout)
        return {"commit": answer["commit"], "studies": answer["studies"]}
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{program}: got no studies, expected those of `stability`") from error


def make_table(arguments: argparse.Namespace) -> None:
    answer = measured(arguments.stability, arguments.samples, arguments.seed)
    made = run_arguments.how_made_at([answer["commit"]])
    studies = answer["studies"]
    text = made + tables.markdown(HEAD, [row_of(study) for study in studies])
    tables.write_text(arguments.out / "stability.md", text)
    rows = [row for study in studies for row in csv_rows(study)]
    tables.write_text(arguments.out / "stability.csv", tables.csv_text(CSV_HEAD, rows))
    print(text)


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "--stability", type=pathlib.Path, default=PROGRAM, metavar="PROGRAM", help="that measures"
    )
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=simulations.REPOSITORY / "out",
        metavar="FOLDER",
        help="for tables",
    )
    parser.add_argument("--samples", type=int, default=300, help="random cases at each place")
    parser.add_argument("--seed", type=int, default=1, help="of the random cases")
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
