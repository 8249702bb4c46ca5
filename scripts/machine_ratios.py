"""How many times as fast as another, and at how many times less energy: over all cases of a memory,
with what is published of the same pair."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence

from machine_measures import GPU, Measured

# By scene, the cases of each: what every machine took.
Found = Mapping[str, Sequence[Mapping[str, Measured]]]

HEAD = (
    "GB/s",
    "machine",
    "precision",
    "than",
    "its precision",
    "scenes",
    "cases",
    "times as fast",
    "least",
    "most",
    "published",
    "times less energy",
    "least ",
    "most ",
    "published ",
    "mm2 over mm2",
)

# StreamingGS (DAC 2025): means over its scenes, with its GPU (4.9 and 8.5 frames a second) and its
# own model of GSCore. 27.3 is 62.9 over 2.3; without both of its parts "about": it states that
# codebooks alone change the speed little.
PUBLISHED = {
    ("paper", GPU): ("45.7", "62.9"),
    ("paper_no_cgf", GPU): ("22.2", "27.3"),
    ("paper_no_vq_cgf", GPU): ("about 22.2", "21.5"),
    ("gscore", GPU): ("21.6", "27.3"),
    ("paper", "gscore"): ("2.1", "2.3"),
}


def over_scenes(
    found: Found, own: str, other: str, value: Callable[[Measured], Sequence[float]]
) -> tuple[str, str, str]:
    """Each scene counts once: the geometric mean over its cases of what the means over their views
    are to each other, then that over the scenes. Least and most: of single views."""
    pairs = {
        name: [(value(case[own]), value(case[other])) for case in cases]
        for name, cases in found.items()
    }
    mean = statistics.geometric_mean(
        statistics.geometric_mean(
            statistics.fmean(theirs) / statistics.fmean(ours) for ours, theirs in of_scene
        )
        for of_scene in pairs.values()
    )
    single = [
        theirs / ours
        for of_scene in pairs.values()
        for all_ours, all_theirs in of_scene
        for ours, theirs in zip(all_ours, all_theirs)
    ]
    return f"{mean:.2f}", f"{min(single):.2f}", f"{max(single):.2f}"


def row(memory: str, found: Found, own: str, other: str) -> tuple:
    cases = [case for of_scene in found.values() for case in of_scene]
    ours, theirs = cases[0][own], cases[0][other]
    speed, energy = PUBLISHED.get((own, other), ("", ""))
    areas = [c[own].mm2 / c[other].mm2 for c in cases if c[own].mm2 and c[other].mm2]
    return (
        memory,
        own,
        ours.precision,
        other,
        theirs.precision,
        len(found),
        len(cases),
        *over_scenes(found, own, other, lambda m: m.seconds),
        speed,
        *over_scenes(found, own, other, lambda m: m.joules),
        energy,
        f"{math.fsum(areas) / len(areas):.2f}" if areas else "",
    )


def rows(memory: str, found: Found, machines: Sequence[str]) -> list[tuple]:
    """Every machine over the GPU; and over each tile-centric machine of its own precision."""
    first = next(iter(found.values()))[0]
    tiled = [name for name in machines if name.startswith("gscore")]
    pairs = [(own, GPU) for own in machines]
    pairs += [
        (own, other)
        for other in tiled
        for own in machines
        if own not in tiled[: tiled.index(other) + 1]
        and first[own].precision == first[other].precision
    ]
    return [row(memory, found, own, other) for own, other in pairs]
