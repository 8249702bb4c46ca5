"""Machines beside each other: the same scenes, views, DRAM and ledger, each with the scene stored
as it reads it; and the original rasteriser on a mobile GPU, which is modelled, not simulated. A
case is a scene at a size. Machines are held against those of their own precision: exact_fp16 and
paper_text blend in half as gscore and gscore_boxes do, exact and exact_fast in single as
gscore_lossless and gscore_lossless_boxes; exact against gscore as well, and marked. Makes

  compare_machines         a line for each case, memory and machine: means over the views; frames a
                           second of frames alone, and at most if frames overlapped
  compare_machines_ratios  times as fast, of both, and times less energy; by size and over all; dB
                           and published figures beside them
  compare_machines_cases   the same for each case, of the pairs of one precision and loss
  compare_machines_bytes   MB by region of DRAM, on the bus; of the GPU by kind, as its kernels ask
                           for them
  compare_machines_joules  mJ by component
  compare_machines_busy    share of the frame that each resource works; of the GPU's time, by kernel
  characterisation         what the GPU and the tile-centric machine move, and what they would have
                           to move at 90 frames a second

and draws compare_machines_rates, _traffic and _ratios from them.

Without SCENE: the real scenes that there are, at --sizes, or at --object-sizes those that show an
object; built-in ones where there are none.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
import statistics
from collections.abc import Callable, Mapping, Sequence

import tables
from runs import run_arguments
from runs.keeper import swept
from runs.simulations import MB, MJ, Run
from studies import cases
from studies.cases import (
    ALL_SIZES,
    GPU,
    KINDS,
    MODEL,
    WAYS,
    Case,
    Entry,
    Found,
    Measured,
    decibel_ends,
    model_all,
    modelled,
    over_scenes,
    simulated,
    size_groups,
)
from tables import SCENE, SIZE, Column, Made, Spread, Study

PAIR = (
    Column("machine", "preset"),
    Column("than", "preset, or the modelled GPU, that it is held against"),
)
MEMORY = Column("GB/s", "peak of the machine's DRAM; the GPU has its own", "GB/s", ".1f")


def ratio_columns(name: str, meaning: str) -> tuple[Column, ...]:
    """A geometric mean, and the least and most of single views."""
    return (
        Column(name, meaning, "", ".2f"),
        Column(f"{name}, least", "of single views", "", ".2f"),
        Column(f"{name}, most", "of single views", "", ".2f"),
    )


RATIO_COLUMNS = (
    MEMORY,
    Column("sizes", "of the cases that the row is over"),
    *PAIR,
    Column("precision", "that both blend in, or each"),
    *(
        Column(f"{whose}dB, {end}", f"PSNR, {end} of the views; empty: not measured", "dB", ".1f")
        for whose in ("", "its ")
        for end in ("least", "most")
    ),
    Column("scenes", "of the row; each counts once", "", "d"),
    Column("cases", "of the row: scenes at sizes", "", "d"),
    *ratio_columns("times as fast", "time of the other over the machine's, frames alone"),
    *ratio_columns("both overlapped", "the same, frames begun as fast as the busiest part lets"),
    *ratio_columns("only the other overlapped", "the machine's frames alone"),
    Column("published speed", "of the same pair; derived: out of published ratios"),
    *ratio_columns("times less energy", "joules of the other over the machine's"),
    Column("published energy", "of the same pair; derived: out of published ratios"),
    Column("mm2 over mm2", "area of the machine over the other's, mean over the cases", "", ".2f"),
    Column("the other is", "where its numbers come from"),
)
RATIO_ABOUT = (
    "*times as fast*: of frames alone. *Overlapped*: frames are begun as fast as the busiest "
    "resource lets them, others under way. That is a bound, which no machine here is built to "
    "reach, and generous to one with a barrier (gscore): it would need memory for two frames, and "
    "a resource that never waits. A ratio of two bounds is no bound. *Only the other*: what is "
    "left if it alone reaches its own. *least*, *most*: of single views. A scene counts once in "
    "the geometric mean; a pair of two precisions has a row of its own, and is in no other mean. "
    "GB/s are those of the machine; the GPU's memory is its own, and the same beside all. "
    "*derived*: not published itself, but out of published ratios."
)

# Of these pairs each case has a line as well: of one precision, encoding and loss, with the strongest
# tile-centric machine.
OF_CASES = (
    ("exact", "gscore_lossless_boxes"),
    ("exact_fast", "gscore_lossless_boxes"),
    ("exact_fp16", "gscore_boxes"),
)
CASE_COLUMNS = (
    SCENE,
    SIZE,
    MEMORY,
    *PAIR,
    Column("times as fast", "frames alone", "", ".2f"),
    Column("both overlapped", "frames begun as fast as the busiest part lets", "", ".2f"),
    Column("only the other overlapped", "the machine's frames alone", "", ".2f"),
    Column("times less energy", "joules of the other over the machine's", "", ".2f"),
    Column("bus MB", "moved in whole bursts by the machine", "MB", ".2f"),
    Column("its bus MB", "by the other", "MB", ".2f"),
    Column("binds", "busiest resource of the machine and its share; what holds the frame"),
    Column("the other's", "the same of the other"),
)
CASES_ABOUT = "Means over the views of each; columns as those of the ratios over all."

DERIVED = " derived"
# StreamingGS (DAC 2025): means over its scenes, with its GPU (4.9 and 8.5 frames a second) and its
# own model of GSCore. Its energy of GSCore is 62.9 over 2.3.
PUBLISHED = {
    ("paper_text", GPU): ("45.7", "62.9"),
    ("gscore", GPU): ("21.6", "27.3" + DERIVED),
    ("paper_text", "gscore"): ("2.1", "2.3"),
}
# Held against each other in spite of what they blend in, since one is the default and the other
# what is published.
ACROSS_PRECISIONS = (("exact", "gscore"),)


def what_it_is(own: Measured, name: str, other: Measured) -> str:
    """Where the other's numbers come from."""
    if name == GPU:
        watts = statistics.fmean(other.joules) / statistics.fmean(other.seconds)
        return f"modelled; joules derived: {watts:.3g} W x its time"
    if own.precision != other.precision:
        return "simulated, in another precision"
    return "simulated"


def ratio_row(memory: float, sizes: str, found: Found, own: str, other: str) -> tuple:
    cases = [case for of_scene in found.values() for case in of_scene]
    ours, theirs = cases[0][own], cases[0][other]
    # Published means are over all that was drawn.
    speed, joules = PUBLISHED.get((own, other), ("", "")) if sizes == ALL_SIZES else ("", "")
    areas = [c[own].mm2 / c[other].mm2 for c in cases if c[own].mm2 and c[other].mm2]
    draws = dict.fromkeys((ours.draws(), theirs.draws()))
    *faster, frugal = (over_scenes(found, own, other, *way) for way in WAYS)
    return (
        *(memory, sizes, own, other, ", its ".join(draws)),
        *(*decibel_ends(cases, own), *decibel_ends(cases, other), len(found), len(cases)),
        *(number for way in faster for number in way),
        *(speed, *frugal, joules),
        math.fsum(areas) / len(areas) if areas else None,
        what_it_is(ours, other, theirs),
    )


def comparable(own: Measured, other: Measured) -> bool:
    """Of one precision; and in single, where the other loses nothing, from the same encoding."""
    lossless = other.precision == "fp32"
    return own.precision == other.precision and (not lossless or own.encoding == other.encoding)


def pairs_of(of: Mapping[str, Measured], machines: Sequence[str]) -> list[tuple[str, str]]:
    """Every machine over the GPU, whatever its picture; and over each tile-centric machine that it
    is comparable to. of: what each took for one case."""
    tiled = [name for name in machines if name.startswith("gscore")]
    pairs = [(own, GPU) for own in machines]
    pairs += [
        (own, other)
        for other in tiled
        for own in machines
        if own not in tiled[: tiled.index(other) + 1] and comparable(of[own], of[other])
    ]
    return pairs + [pair for pair in ACROSS_PRECISIONS if set(pair) <= set(machines)]


def case_rows(entries: Sequence[Entry], cases: Sequence[Case]) -> list[tuple]:
    """A line for each case, memory and pair of OF_CASES that was measured."""
    made = []
    for case in cases:
        of_case = [e for e in entries if e.case == case and e.machine != GPU]
        for memory in dict.fromkeys(e.memory for e in of_case):
            of = {e.machine: e.of for e in of_case if e.memory == memory}
            made += [
                (*case.cells(), memory, own, other, *pair_cells(of, own, other))
                for own, other in OF_CASES
                if own in of and other in of
            ]
    return made


def pair_cells(of: Mapping[str, Measured], own: str, other: str) -> tuple:
    return (
        *(over_scenes({"": [of]}, own, other, *way)[0] for way in WAYS),
        *(of[name].bytes() / MB for name in (own, other)),
        *(of[name].binds for name in (own, other)),
    )


def found_with(entries: Sequence[Entry], cases: Sequence[Case], memory: float) -> Found:
    found: dict[str, list[dict[str, Measured]]] = {}
    for case in cases:
        of_case = [e for e in entries if e.case == case]
        here = {e.machine: e.of for e in of_case if e.machine == GPU or e.memory == memory}
        found.setdefault(case.scene.name, []).append(here)
    return found


def ratio_rows(
    entries: Sequence[Entry], groups: Mapping[str, Sequence[Case]], machines: Sequence[str]
) -> list[tuple]:
    """groups: cases by what their sizes are called, of which ALL_SIZES is one."""
    made = []
    for memory in dict.fromkeys(e.memory for e in entries if e.machine != GPU):
        found = {sizes: found_with(entries, cases, memory) for sizes, cases in groups.items()}
        first = next(iter(found[ALL_SIZES].values()))[0]
        for own, other in pairs_of(first, machines):
            made += [ratio_row(memory, sizes, of, own, other) for sizes, of in found.items()]
    return made


MACHINES = (
    *("gscore", "gscore_boxes", "gscore_lossless", "gscore_lossless_boxes"),
    *("paper_text", "exact_fp16", "exact", "exact_fast", "exact_vq"),
)
FIGURES = ("compare_machines_rates", "compare_machines_traffic", "compare_machines_ratios")
WISHED_FPS = 90

CASE = (SCENE, SIZE, MEMORY, Column("machine", "preset, or the modelled GPU"))
COLUMNS = (
    *CASE,
    Column("precision", "that it blends in"),
    Column("frames/s", "of frames alone, mean over the views", "1/s", ".1f"),
    Column(
        "frames/s at most, overlapped",
        "if the busiest resource never waited: a bound",
        "1/s",
        ".1f",
    ),
    *(Column(f"{kind} MB", f"bytes on the bus that are {kind}", "MB", ".2f") for kind in KINDS),
    Column("mJ", "of a frame, from counts; of the GPU watts times time", "mJ", ".2f"),
    Column("of it DRAM", "energy of the DRAM; empty: not told apart", "mJ", ".2f"),
    Column("mm2", "area, the largest of the views", "mm2", ".2f"),
    Column("least dB", "PSNR of the worst view; empty: not measured", "dB", ".1f"),
    Column("binds", "busiest resource and its share; what holds the frame where it is another"),
)
ABOUT = (
    "Simulated: frames a second, bytes, dB of all but the GPU. From what the simulation counts and "
    "the technology's energies and areas: mJ, mm2. Modelled from counted work: the GPU's frames a "
    "second and bytes. Derived: its mJ, watts times modelled time. *At most*: if frames overlapped "
    "until the busiest resource never waited, which is a bound."
)
CHARACTER_COLUMNS = (
    *CASE,
    Column("frames/s", "of frames alone", "1/s", ".1f"),
    Column("MB a frame", "on the bus, or that the GPU's kernels ask for", "MB", ".1f"),
    Column(f"GB/s at {WISHED_FPS} frames/s", "that the same bytes would take", "GB/s", ".2f"),
    *(Column(f"{kind} %", f"share of the bytes that is {kind}", "%", ".0f") for kind in KINDS),
)


@dataclasses.dataclass(frozen=True)
class Parts:
    """A table of what a frame has by part. scale: of the SI unit in the table's."""

    name: str
    head: str
    scale: float
    unit: str
    of_gpu: str
    of: Callable[[Measured], Mapping[str, float]]

    def write(self, arguments: argparse.Namespace, by: Made, entries: Sequence[Entry]) -> None:
        columns = (*CASE, Column(self.head, "part"), Column("value", self.unit, self.unit, ".3f"))
        rows = [
            (*e.case.cells(), e.memory, e.machine, part, value / self.scale)
            for e in entries
            for part, value in self.of(e.of).items()
        ]
        about = (
            f"In {self.unit}: means over the scenes of the means over their cases; each case is in "
            f"the .csv. Of the GPU: {self.of_gpu}."
        )
        spread = Spread("machine", "{value}", ("scene", "size"))
        name = f"compare_machines_{self.name}"
        tables.write(arguments.out, name, by, columns, rows, about, spread)


PARTS = (
    Parts(
        *("bytes", "region", MB, "MB a frame", "modelled, what its kernels ask for"),
        lambda m: m.bytes_by_region,
    ),
    Parts(
        *("joules", "component", MJ, "mJ a frame", "derived, watts times modelled time"),
        lambda m: m.joules_by_component,
    ),
    Parts(
        *("busy", "resource", 1, "shares of the frame", "of its modelled time, by kernel"),
        lambda m: m.busy,
    ),
)


def row(e: Entry) -> tuple:
    m, dram = e.of, e.of.joules_by_component.get("DRAM")
    return (
        *(*e.case.cells(), e.memory, e.machine, m.precision),
        *(m.frames_a_second(), m.most_frames_a_second()),
        *(m.bytes(kind) / MB for kind in KINDS),
        *(m.mean_joules() / MJ, None if dram is None else dram / MJ, m.mm2),
        *(min(m.decibels, default=None), m.binds),
    )


def character_row(e: Entry) -> tuple:
    moved = e.of.bytes()
    return (
        *(*e.case.cells(), e.memory, e.machine, e.of.frames_a_second(), moved / MB),
        WISHED_FPS * moved / 1e9,
        *(100 * e.of.bytes(kind) / moved for kind in KINDS),
    )


def measure(arguments: argparse.Namespace, of: Sequence[Case]) -> tuple[list[Entry], list[dict]]:
    """What every machine took for every case, memory by memory, the GPU last; and the views."""
    entries, measured = [], []
    # A server for each scene: it holds all ways in which the machines want their scene stored.
    for _, of_scene in itertools.groupby(of, key=lambda case: case.scene):
        asked = list(itertools.product(of_scene, arguments.machines, arguments.channels))
        runs = [
            Run(case.scene, arguments.view, case.size, machine, (f"dram.channels={channels}",))
            for case, machine, channels in asked
        ]
        for (case, machine, _), outcome in zip(asked, swept(arguments, "compare_machines", runs)):
            entries.append(Entry(case, machine, simulated(outcome.accepted())))
            measured += outcome.views
    gpu_runs = [Run(case.scene, arguments.view, case.size, MODEL) for case in of]
    for case, views in zip(of, model_all(arguments, gpu_runs)):
        entries.append(Entry(case, GPU, modelled(views)))
    place = {case: at for at, case in enumerate(of)}
    entries.sort(key=lambda e: (place[e.case], e.machine == GPU, e.of.peak_gb_s))
    return entries, measured


def add_arguments(to: run_arguments.Parser) -> None:
    cases.add_arguments(to, MACHINES, [4, 8])
    run_arguments.add_side_by_side(to)
    run_arguments.add_view(to, "all")


def make(arguments: argparse.Namespace) -> None:
    found = cases.find_cases(arguments)
    entries, measured = measure(arguments, found)
    by = tables.made_of(arguments.streaminggs, measured, [case.scene for case in found])

    def write(name: str, columns: Sequence[Column], rows: list[tuple], about: str = "") -> None:
        tables.write(arguments.out, name, by, columns, rows, about)

    write("compare_machines", COLUMNS, list(map(row, entries)), ABOUT)
    ratios = ratio_rows(entries, size_groups(found, arguments), arguments.machines)
    write("compare_machines_ratios", RATIO_COLUMNS, ratios, RATIO_ABOUT)
    of_cases = case_rows(entries, found)
    write(
        *("compare_machines_cases", CASE_COLUMNS, of_cases),
        CASES_ABOUT,
    )
    for parts in PARTS:
        parts.write(arguments, by, entries)
    shown = [e for e in entries if e.machine in (GPU, "gscore")]
    write("characterisation", CHARACTER_COLUMNS, list(map(character_row, shown)))
    tables.draw_beside(arguments.out, *FIGURES)


COMPARE_MACHINES = Study(
    "compare_machines", __doc__, ("results.py compare_machines",), add_arguments, make
)
