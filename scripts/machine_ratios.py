"""How many times as fast as another, and at how many times less energy, with what is published of
the same pair: over the cases of a size, over all, and case by case."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence

from machine_measures import GPU, Measured
from machine_tables import MB, Case, Entry
from runs.view_numbers import decibels_span

# By scene, the cases of each: what every machine took.
Found = Mapping[str, Sequence[Mapping[str, Measured]]]
OfViews = Callable[[Measured], Sequence[float]]

ALL = "all"  # sizes
HEAD = (
    "GB/s",
    "sizes",
    "machine",
    "than",
    "precision",
    "dB",
    "its dB",
    "scenes",
    "cases",
    "times as fast",
    "of views",
    "both overlapped",
    "of views, both overlapped",
    "only the other overlapped",
    "of views, only the other overlapped",
    "published speed",
    "times less energy",
    "of views, energy",
    "published energy",
    "mm2 over mm2",
    "the other is",
)
ABOUT = (
    "*times as fast*: of frames alone. *Overlapped*: frames are begun as fast as the busiest "
    "resource lets them, others under way. That is a bound, which no machine here is built to "
    "reach, and generous to one with a barrier (gscore): it would need memory for two frames, and "
    "a resource that never waits. A ratio of two bounds is no bound. *Only the other*: what is "
    "left if it alone reaches its own. *of views*: least and most. A scene counts once in the "
    "geometric mean; a pair of two precisions has a row of its own, and is in no other mean. GB/s "
    "are those of the machine; the GPU's memory is its own, and the same beside all. *derived*: "
    "not published itself, but out of published ratios.\n\n"
)

# Of these pairs each case has a line as well: of one precision, encoding and loss.
OF_CASES = (
    ("exact", "gscore_lossless"),
    ("exact_fast", "gscore_lossless"),
    ("exact_fp16", "gscore_fp32_keys"),
)
CASE_HEAD = (
    "scene",
    "size",
    "GB/s",
    "machine",
    "than",
    "times as fast",
    "both overlapped",
    "only the other overlapped",
    "times less energy",
    "bus MB",
    "its bus MB",
    "binds",
    "the other's",
)
CASES_ABOUT = "Means over the views of each; columns as those of the ratios over all.\n\n"

DERIVED = " derived"
# StreamingGS (DAC 2025): means over its scenes, with its GPU (4.9 and 8.5 frames a second) and its
# own model of GSCore. Its energy of GSCore is 62.9 over 2.3; without both parts it states only that
# codebooks change the speed little.
PUBLISHED = {
    ("paper", GPU): ("45.7", "62.9"),
    ("paper_no_cgf", GPU): ("22.2", "27.3"),
    ("paper_no_vq_cgf", GPU): ("22.2" + DERIVED, "21.5"),
    ("gscore", GPU): ("21.6", "27.3" + DERIVED),
    ("paper", "gscore"): ("2.1", "2.3"),
}
# Held against each other in spite of what they blend in, since one is the default and the other
# what is published.
ACROSS_PRECISIONS = (("exact", "gscore"),)


def alone(m: Measured) -> Sequence[float]:
    return m.seconds


def overlapped(m: Measured) -> Sequence[float]:
    return m.busiest_seconds


def energy(m: Measured) -> Sequence[float]:
    return m.joules


def over_scenes(
    found: Found, own: str, other: str, ours: OfViews, theirs: OfViews
) -> tuple[str, str]:
    """Each scene counts once: the geometric mean over its cases of what the means over their views
    are to each other, then that over the scenes. Least and most: of single views."""
    pairs = [[(ours(case[own]), theirs(case[other])) for case in of] for of in found.values()]
    mean = statistics.geometric_mean(
        statistics.geometric_mean(statistics.fmean(b) / statistics.fmean(a) for a, b in of_scene)
        for of_scene in pairs
    )
    single = [b / a for of_scene in pairs for views in of_scene for a, b in zip(*views)]
    return f"{mean:.2f}", f"{min(single):.2f} .. {max(single):.2f}"


def decibels(cases: Sequence[Mapping[str, Measured]], machine: str) -> str:
    values = [value for case in cases for value in case[machine].decibels]
    return decibels_span(values) if values else "not measured"


def draws(m: Measured) -> str:
    """In which precision, and from codebooks or records as they are."""
    return f"{m.precision} from codebooks" if "vq" in m.encoding else m.precision


def what_it_is(own: Measured, name: str, other: Measured) -> str:
    """Where the other's numbers come from."""
    if name == GPU:
        watts = statistics.fmean(other.joules) / statistics.fmean(other.seconds)
        return f"modelled; joules derived: {watts:.3g} W x its time"
    if own.precision != other.precision:
        return "simulated, in another precision"
    return "simulated"


def row(memory: str, sizes: str, found: Found, own: str, other: str) -> tuple:
    cases = [case for of_scene in found.values() for case in of_scene]
    ours, theirs = cases[0][own], cases[0][other]
    # Published means are over all that was drawn.
    speed, joules = PUBLISHED.get((own, other), ("", "")) if sizes == ALL else ("", "")
    areas = [c[own].mm2 / c[other].mm2 for c in cases if c[own].mm2 and c[other].mm2]
    return (
        memory,
        sizes,
        own,
        other,
        draws(ours) if draws(ours) == draws(theirs) else f"{draws(ours)}, its {draws(theirs)}",
        decibels(cases, own),
        decibels(cases, other),
        len(found),
        len(cases),
        *over_scenes(found, own, other, alone, alone),
        *over_scenes(found, own, other, overlapped, overlapped),
        *over_scenes(found, own, other, alone, overlapped),
        speed,
        *over_scenes(found, own, other, energy, energy),
        joules,
        f"{math.fsum(areas) / len(areas):.2f}" if areas else "",
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
            for own, other in OF_CASES:
                if own in of and other in of:
                    made.append((*case.cells(), memory, *pair_cells(of, own, other)))
    return made


def pair_cells(of: Mapping[str, Measured], own: str, other: str) -> tuple[str, ...]:
    found = {"": [of]}
    ways = ((alone, alone), (overlapped, overlapped), (alone, overlapped), (energy, energy))
    return (
        own,
        other,
        *(over_scenes(found, own, other, *way)[0] for way in ways),
        *(f"{of[name].bytes() / MB:.2f}" for name in (own, other)),
        of[own].binds,
        of[other].binds,
    )


def found_with(entries: Sequence[Entry], cases: Sequence[Case], memory: str) -> Found:
    found: dict[str, list[dict[str, Measured]]] = {}
    for case in cases:
        of_case = [e for e in entries if e.case == case]
        here = {e.machine: e.of for e in of_case if e.machine == GPU or e.memory == memory}
        found.setdefault(case.scene.name, []).append(here)
    return found


def rows(
    entries: Sequence[Entry], groups: Mapping[str, Sequence[Case]], machines: Sequence[str]
) -> list[tuple]:
    """groups: cases by what their sizes are called, of which ALL is one."""
    made = []
    for memory in dict.fromkeys(e.memory for e in entries if e.machine != GPU):
        found = {sizes: found_with(entries, cases, memory) for sizes, cases in groups.items()}
        first = next(iter(found[ALL].values()))[0]
        for own, other in pairs_of(first, machines):
            made += [row(memory, sizes, of, own, other) for sizes, of in found.items()]
    return made
