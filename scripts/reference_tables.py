#!/usr/bin/env python3
"""Writes the tables of keys, activities and counters that stand beside the sources as KEYS.md, the
table of entries of report.json, and the block diagram of the preset `exact`, from what `streaminggs
describe` prints. With --check nothing is written, and what differs from the program is an error."""

from __future__ import annotations

import argparse
import dataclasses
import difflib
import json
import os
import pathlib
import re
import subprocess
import sys
from typing import NoReturn

from drawing import block_diagram

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
KEY = re.compile(r"(?P<key>[\w.]+) = (?P<value>.*?)  \((?P<allowed>[^()]*)\)  (?P<meaning>.*)")
WRITTEN_BY = "<!-- Written by scripts/reference_tables.py from `streaminggs describe`. -->\n\n"
# Keys with pages of their own.
MEMORY, STORAGE = "dram.", "storage."
# Parts of an entry's path that stand for keys of many names, and for which.
NAMES = {
    "CODEBOOK": "`scale`, `rotation`, `dc`, `sh`: those that the scene has",
    "STEP": "a step of [the loss](README.md#maps-of-errors); only of orders and precisions that lose",
    "PATH": "a unit, with its number; "
    "[streaming machines](../../modules/streaminggs/KEYS.md), [gscore](../../modules/gscore/KEYS.md)",
    "ACTIVITY": "what the unit does, in the same tables",
    "COUNTER": "what the unit counts: the same tables have units and meanings",
    "REGION": "a [region](../../algorithm/memory/README.md#regions) of memory",
    "REQUESTER": "the path of a unit",
    "COMPONENT": "a part of the machine or a use of memory: [cost](../cost/README.md#in-the-report)",
    "OWNER": "a kind of unit, `between_units`, `memory_path` or `memory_interface`",
    "SET": "a published set of currents, by its name in the memory's specification",
    "MEMORY": "`input`, `codebook`, `shared`",
    "DATAPATH": "a filter's test, a chunk test, a step of a ray, a blend and the like",
    "CLASS": "`multiplies`; `adds`, subtractions too; `fused`, those of the adds that follow a "
    "multiply; `divisions`; `divisors`, the different ones; `square_roots`; `logarithms`; "
    "`exponentials`; `comparisons`; `roundings`; `splits` into whole steps and the rest; `scalings` "
    "by a power of two that is computed; `look_ups` of a table's row; `conversions` of whole "
    "numbers; `index_adds`, sums of indices",
    "KIND": "a part beside the lanes: a row of the technology table; between the lanes "
    "`register_bit`, `select_bit`",
}
NAME = re.compile(r"[A-Z]{2,}")


@dataclasses.dataclass
class Described:
    """What `describe` prints of one configuration: rows of its tables, in their order."""

    keys: dict[str, tuple[str, str, str]]  # value, allowed, meaning
    tables: list[tuple[tuple[str, ...], list[tuple[str, ...]]]]  # head, rows

    def rows_with(self, column: str) -> list[tuple[str, ...]]:
        """Of the table that has this column."""
        return next(rows for head, rows in self.tables if column in head)

    def named_rows_with(self, column: str) -> list[dict[str, str]]:
        head = next(head for head, _ in self.tables if column in head)
        return [dict(zip(head, row)) for row in self.rows_with(column)]


def described(command: str, configuration: str) -> Described:
    run = subprocess.run(
        [command, "describe", "--config", configuration], capture_output=True, text=True, check=True
    )
    out = Described({}, [])
    before = ""
    for line in run.stdout.splitlines():
        if found := KEY.fullmatch(line):
            out.keys[found["key"]] = (found["value"], found["allowed"], found["meaning"])
        elif line.startswith("| "):
            cells = tuple(cell.strip() for cell in line.strip("| ").split(" | "))
            if not before.startswith("|"):
                out.tables.append((cells, []))
            elif set(cells) != {"---"}:
                out.tables[-1][1].append(cells)
        before = line
    if not out.keys or not out.tables or not all(rows for _, rows in out.tables):
        raise ValueError(f"{command} describe --config {configuration}: a table is empty")
    return out


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines) + "\n"


def union(of: list[list]) -> list:
    """All rows once. What the first lists lack stands before the row that follows it in its own."""
    merged: list = []
    for rows in of:
        at = len(merged)
        for row in reversed(rows):
            if row in merged:
                at = merged.index(row)
            else:
                merged.insert(at, row)
    return merged


def key_table(presets: dict[str, Described], belongs) -> str:
    rows = []
    for key in union([[k for k in d.keys if belongs(k)] for d in presets.values()]):
        of = {name: d.keys[key] for name, d in presets.items() if key in d.keys}
        (allowed, meaning), *others = dict.fromkeys(row[1:] for row in of.values())
        if others:
            raise ValueError(f"{key}: {allowed}, {meaning} in one machine, {others} in another")
        values = [f"`{of[name][0]}`" if name in of and of[name][0] else "" for name in presets]
        rows.append([f"`{key}`", *values, allowed, meaning])
    return table(["key", *presets, "allowed", "meaning"], rows)


def unit_table(presets: dict[str, Described], rows_of, head: list[str]) -> str:
    rows = []
    for row in union([rows_of(d) for d in presets.values()]):
        within = [name for name, d in presets.items() if row in rows_of(d)]
        rows.append([*([", ".join(within)] if len(presets) > 1 else []), *row])
    return table([*(["machine"] if len(presets) > 1 else []), *head], rows)


def machine_page(title: str, presets: dict[str, Described]) -> str:
    named = " and ".join(f"`{name}`" for name in presets)
    return (
        f"# {title}: keys, activities and counters\n\n{WRITTEN_BY}## Keys\n\n"
        f"Values are those of {named}; 0 is left to the model where the meaning says so.\n"
        "Of the memory: [dram](../dram/KEYS.md). How scenes are stored:\n"
        "[storage](../../algorithm/memory/KEYS.md).\n\n"
        + key_table(presets, lambda key: not key.startswith((MEMORY, STORAGE)))
        + "## Activities\n\nA resource is as busy as its busiest activity.\n\n"
        + unit_table(
            presets, lambda d: d.rows_with("activity"), ["unit", "activity", "resource", "what it does"]
        )
        + "## Counters\n\n"
        + unit_table(
            presets, lambda d: d.rows_with("counter"), ["unit", "counter", "unit of measure", "meaning"]
        )
    ).rstrip("\n") + "\n"


# A line of a commented memspec: a key, what opens or its value, and what is said of it.
MEMSPEC_LINE = re.compile(r'\s*"(?P<key>[\w.]+)": (?P<value>.*?),?(?:  // (?P<said>.*))?')
MEMSPEC = "lpddr3_1600_4gb"
# Units stand at the ends of keys.
UNITS = {
    "_bits": "bit",
    "_ns": "ns",
    "_pj_per_bit": "pJ",
    "_cycles": "clock cycles",
    "_ma": "mA",
    "_v": "V",
}


def unit_of(path: str) -> str:
    """Of the last part of a key's path that has one."""
    for part in reversed(path.split(".")):
        for end, unit in UNITS.items():
            if f"_{part}".endswith(end):
                return unit
    return ""


def memspec_table(command: str) -> str:
    """Every key of a memspec: of the sets of currents one, of sources those that stand for all."""
    run = subprocess.run(
        [command, "describe", "--memspec", MEMSPEC], capture_output=True, text=True, check=True
    )
    rows: list[list[str]] = []
    path: list[str] = []
    for line in run.stdout.splitlines():
        if line.strip(" ,") == "}" and path:
            path.pop()
        elif found := MEMSPEC_LINE.fullmatch(line):
            at = ".".join([*path, found["key"]])
            if found["value"] == "{":
                path.append("NAME" if path == ["currents"] else found["key"])
                if found["key"] == "sources":
                    rows.append(["`sources.KEY`", "", "text", "", found["said"]])
            elif found["said"] and all(row[0] != f"`{at}`" for row in rows):
                allowed, meaning = found["said"].split(": ", 1)
                rows.append([f"`{at}`", f"`{found['value']}`", allowed, unit_of(at), meaning])
    if not rows:
        raise ValueError(f"{command} describe --memspec {MEMSPEC}: the table is empty")
    return table(["key", MEMSPEC, "allowed", "unit", "meaning"], rows)


def shipped_memspecs() -> str:
    """What dram.memspec may name."""
    rows = []
    for path in sorted((REPOSITORY / "modules/dram/memspecs").glob("*.json")):
        memspec = json.loads(path.read_text())
        of = {"beats_per_clock": 2, "pseudo_channels": 1, "bank_groups": 1, "banks_per_refresh": 1}
        of |= memspec["organisation"]
        bits_per_ns = of["width_bits"] * of["beats_per_clock"] / memspec["clock_period_ns"]
        burst_bytes = of["burst_length"] * of["width_bits"] // 8
        numbers = (of["pseudo_channels"], of["width_bits"], burst_bytes)
        numbers += (of["banks"], of["bank_groups"], of["banks_per_refresh"])
        gb_s = f"{of['pseudo_channels'] * bits_per_ns / 8:.2f}"
        named = [f"`{path.stem}`", memspec["description"], gb_s]
        rows.append([*named, *map(str, numbers), f"`{memspec['default_currents']}`"])
    return table(
        [
            *("memspec", "device", "GB/s a channel", "data buses", "bits each", "burst, bytes"),
            *("banks", "bank groups", "banks refreshed together", "currents"),
        ],
        rows,
    )


def memory_page(command: str, exact: Described) -> str:
    return (
        f"# The memory: keys\n\n{WRITTEN_BY}"
        + key_table({"default": exact}, lambda key: key.startswith(MEMORY))
        + "## Shipped memspecs\n\n"
        + shipped_memspecs()
        + "## Keys of a memspec\n\n"
        f"`streaminggs describe --memspec {MEMSPEC}` prints them as a template with comments.\n\n"
        + memspec_table(command)
    ).rstrip("\n") + "\n"


def report_page(described: Described) -> str:
    """Raises ValueError where a path has a name that NAMES lacks, and the other way round."""
    of_view = described.rows_with("entry of a view's report.json")
    of_all = described.rows_with("entry of report.json of all views")
    named = {name for path, *_ in of_view for name in NAME.findall(path)}
    if wrong := named ^ NAMES.keys():
        raise ValueError(f"{', '.join(sorted(wrong))}: either in an entry's path or in NAMES")
    head = ["entry", "unit", "meaning"]
    return (
        f"# Entries of report.json\n\n{WRITTEN_BY}"
        "Each view has a report under `view_N/`. `report.json` above them holds all views.\n"
        "Integers are counts. Ratios are derived once, from counts. A table of\n"
        "[what is left out](../cost/README.md#what-is-left-out) belongs to `left_out`.\n\n"
        "## A view\n\n"
        + table(head, [list(row) for row in of_view])
        + "## Names in capitals\n\n"
        + table(["name", "stands for"], [[f"`{name}`", what] for name, what in NAMES.items()])
        + "## All views\n\n"
        + table(head, [list(row) for row in of_all])
    ).rstrip("\n") + "\n"


def pages(command: str) -> dict[str, str]:
    """[path below the repository] what stands there."""
    names = ("exact", "paper", "gscore", "gscore_boxes")
    exact, paper, gscore, boxes = (described(command, name) for name in names)
    return {
        "modules/streaminggs/KEYS.md": machine_page(
            "The streaming machines", {"exact": exact, "paper": paper}
        ),
        "modules/gscore/KEYS.md": machine_page(
            "The tile-centric machine", {"gscore": gscore, "gscore_boxes": boxes}
        ),
        "modules/dram/KEYS.md": memory_page(command, exact),
        "algorithm/memory/KEYS.md": f"# How scenes are stored: keys\n\n{WRITTEN_BY}"
        + key_table(
            {"exact": exact, "paper": paper, "gscore": gscore},
            lambda key: key.startswith(STORAGE),
        ).rstrip("\n")
        + "\n",
        "traces/pictures/block_diagram.svg": block_diagram.svg(
            "exact",
            {key: value for key, (value, *_) in exact.keys.items()},
            *(exact.named_rows_with(column) for column in ("datapath", "use", "channels")),
        ),
        "testbench/streaminggs/REPORT.md": report_page(exact),
    }


def outdated(made: dict[str, str]) -> dict[str, list[str]]:
    """[path] what differs from the page that is there, as lines."""
    out = {}
    for name, text in made.items():
        path = REPOSITORY / name
        there = path.read_text() if path.exists() else ""
        if there != text:
            out[name] = list(
                difflib.unified_diff(
                    there.splitlines(), text.splitlines(), name, "describe", lineterm="", n=0
                )
            )
    return out


class Parser(argparse.ArgumentParser):
    """Refuses in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def main() -> int:
    parser = Parser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, only compare")
    parser.add_argument(
        "--streaminggs",
        default=os.environ.get("STREAMINGGS") or str(REPOSITORY / "build/release/bin/streaminggs"),
        help="the command; default: $STREAMINGGS, or what a release build makes",
    )
    arguments = parser.parse_args()
    try:
        made = pages(arguments.streaminggs)
    except subprocess.CalledProcessError as error:
        print(f"reference_tables.py: {error.stderr.strip()}", file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(f"reference_tables.py: {error}", file=sys.stderr)
        return 2
    differences = outdated(made)
    if not arguments.check:
        for name in differences:
            (REPOSITORY / name).write_text(made[name])
            print(name)
        return 0
    for lines in differences.values():
        print("\n".join(lines), file=sys.stderr)
    if differences:
        print("reference_tables.py: run it without --check", file=sys.stderr)
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
