#!/usr/bin/env python3
"""usage: preset_digits.py FRAMES [--write]

Holds the frames of the presets to the digits in presets.csv beside it. FRAMES has a folder per
preset with its report.json. --write takes the reports as the table: for a change that is meant to
move a machine, whose message says why."""

import csv
import json
import pathlib
import sys

TABLE = pathlib.Path(__file__).with_name("presets.csv")
COLUMNS = ["preset", "cycles", "dram_bytes", "joules", "mm2", "psnr_db"]


def row_of(report: pathlib.Path) -> list[str]:
    view = json.loads(report.read_text(encoding="utf-8"))["views"][0]
    frame, dram = view["frame"], view["dram"]
    real = [view["energy"]["total_j"], view["area_mm2"]["total"], view["image"]["psnr_db"]]
    # Nine digits, since the last ones of a sum are the library's.
    digits = ["" if number is None else f"{number:.9g}" for number in real]
    return [report.parent.name, str(frame["cycles"]), str(dram["bytes"]), *digits]


def main() -> int:
    frames = pathlib.Path(sys.argv[1])
    got = {row[0]: row for row in map(row_of, sorted(frames.glob("*/report.json")))}
    if "--write" in sys.argv:
        with TABLE.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *got.values()])
        return 0
    with TABLE.open(encoding="utf-8", newline="") as file:
        wanted = {row[0]: row for row in list(csv.reader(file))[1:]}
    moved = [name for name in sorted(got | wanted) if got.get(name) != wanted.get(name)]
    for name in moved:
        print(f"{name}: got {got.get(name, 'no frame')}, expected {wanted.get(name, 'no row')}")
    return 1 if moved else 0


if __name__ == "__main__":
    sys.exit(main())
