"""Tables of machines beside each other."""

from __future__ import annotations

import dataclasses
import statistics
from collections.abc import Callable, Mapping, Sequence

from machine_cases import Case
from machine_measures import MJ, Measured
from runs.view_numbers import decibels_text

MB = 1e6
WISHED_FPS = 90


@dataclasses.dataclass(frozen=True)
class Entry:
    """What a machine took for a case with a memory. The GPU has its own one."""

    case: Case
    machine: str
    of: Measured

    @property
    def memory(self) -> str:
        return f"{self.of.peak_gb_s:.1f}"


ABOUT = (
    "Simulated: frames a second, bytes, dB of all but the GPU. From what the simulation counts and "
    "the technology's energies and areas: mJ, mm2. Modelled from counted work: the GPU's frames a "
    "second and bytes. Derived: its mJ, watts times modelled time. *At most*: if frames overlapped "
    "until the busiest resource never waited, which is a bound.\n\n"
)
HEAD = (
    "scene",
    "size",
    "GB/s",
    "machine",
    "precision",
    "frames/s",
    "frames/s at most, overlapped",
    "scene MB",
    "intermediate MB",
    "pixels MB",
    "mJ",
    "of it DRAM",
    "mm2",
    "least dB",
    "binds",
)


def row(e: Entry) -> tuple:
    m, dram = e.of, e.of.joules_by_component.get("DRAM")
    return (
        *e.case.cells(),
        e.memory,
        e.machine,
        m.precision,
        f"{m.frames_a_second():.1f}",
        f"{m.most_frames_a_second():.1f}",
        *(f"{m.bytes(kind) / MB:.2f}" for kind in ("scene", "intermediate", "pixels")),
        f"{m.mean_joules() / MJ:.2f}",
        "" if dram is None else f"{dram / MJ:.2f}",
        "" if m.mm2 is None else f"{m.mm2:.2f}",
        decibels_text(min(m.decibels)) if m.decibels else "not measured",
        m.binds,
    )


CHARACTER_HEAD = (
    "scene",
    "size",
    "machine",
    "GB/s",
    "frames/s",
    "MB a frame",
    f"GB/s at {WISHED_FPS} frames/s",
    "scene %",
    "intermediate %",
    "pixels %",
)


def character_row(e: Entry) -> tuple:
    all_bytes = e.of.bytes()
    return (
        *e.case.cells(),
        e.machine,
        e.memory,
        f"{e.of.frames_a_second():.1f}",
        f"{all_bytes / MB:.1f}",
        f"{WISHED_FPS * all_bytes / 1e9:.2f}",
        *(
            f"{100 * e.of.bytes(kind) / all_bytes:.0f}"
            for kind in ("scene", "intermediate", "pixels")
        ),
    )


Parts = Callable[[Measured], Mapping[str, float]]


@dataclasses.dataclass(frozen=True)
class PartsTable:
    """What stands in a table by parts. scale: of the SI unit in the table's."""

    name: str
    head: str
    scale: float
    unit: str
    of_gpu: str

    def about(self) -> str:
        return (
            f"In {self.unit}: means over the scenes of the means over their cases; each case is in "
            f"the .csv. Of the GPU: {self.of_gpu}.\n\n"
        )


PARTS_TABLES = (
    PartsTable("bytes", "region", MB, "MB a frame", "modelled, what its kernels ask for"),
    PartsTable("joules", "component", MJ, "mJ a frame", "derived, watts times modelled time"),
    PartsTable("busy", "resource", 1, "shares of the frame", "of its modelled time, by kernel"),
)


def mean_part(entries: Sequence[Entry], part: str, of: Parts) -> float | None:
    """Over the scenes of the means over their cases; None where the machine has no such part."""
    by_scene: dict[str, list[float]] = {}
    for e in entries:
        if part in of(e.of):
            by_scene.setdefault(e.case.scene.name, []).append(of(e.of)[part])
    return statistics.fmean(map(statistics.fmean, by_scene.values())) if by_scene else None


def parts_rows(entries: Sequence[Entry], machines: Sequence[str], of: Parts, unit: float) -> list:
    """A line for each memory and part, a column for each machine."""
    rows = []
    for memory in dict.fromkeys(e.memory for e in entries):
        here = [e for e in entries if e.memory == memory]
        for part in dict.fromkeys(part for e in here for part in of(e.of)):
            means = (
                mean_part([e for e in here if e.machine == machine], part, of)
                for machine in machines
            )
            rows.append((memory, part, *("" if m is None else f"{m / unit:.3f}" for m in means)))
    return rows
