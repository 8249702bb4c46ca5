"""What is published of accelerators for a headset, and how what is measured here stands beside it."""

from __future__ import annotations

import dataclasses

from tables import SIZE, Column


@dataclasses.dataclass(frozen=True)
class Setting:
    """What a published rate is of."""

    eyes: int
    size: str
    channels: int  # of LPDDR3-1600, 6.4 GB/s each


@dataclasses.dataclass(frozen=True)
class Published:
    """mb: moved for a frame; None: not stated. differs: from what is measured here."""

    machine: str
    rate: float
    mb: float | None
    differs: str


HEADSET, DISPLAY = Setting(2, "2064x2208", 4), Setting(1, "2560x1440", 8)
SCENES = "their scenes"
# Nebula: arXiv 2512.20495, on the same memory. Neo: ASPLOS 2026, and its model of GSCore, with
# LPDDR4 of this bandwidth.
PUBLISHED: dict[Setting, tuple[Published, ...]] = {
    HEADSET: (
        Published(
            *("Nebula", 70.1, None),
            f"{SCENES}, of levels of detail; both eyes as its own order draws them",
        ),
        Published("Nebula, 256 units", 90, None, "the same"),
    ),
    DISPLAY: (
        Published("Neo", 99.3, 327, f"{SCENES}; depths a frame old, at most 0.1 dB off"),
        Published("GSCore, by Neo", 15.8, 1743, f"{SCENES}; a trace, colours take no time"),
    ),
}
STEREO_COLUMNS = (
    SIZE,
    Column("GB/s", "peak of the DRAM", "GB/s", ".1f"),
    Column("machine", "preset, or as published"),
    Column("speed-up", "two eyes over two frames of one eye, frames alone", "", ".2f"),
    Column("speed-up, back to back", "likewise", "", ".2f"),
    Column("mm2 more", "area that two eyes add", "mm2", ".2f"),
    Column("what differs", "of what is published: what is not comparable"),
)
STEREO = (
    *(HEADSET.size, HEADSET.channels * 6.4, "Nebula's, on GSCore", 1.7, None, 0.25),
    f"{SCENES}, of levels of detail; both pictures as drawn alone, as here",
)
COLUMNS = (
    Column("eyes", "that a frame is drawn for", "", "d"),
    SIZE,
    Column("GB/s", "peak of the DRAM", "GB/s", ".1f"),
    Column("machine", "preset, or as published"),
    Column("frames/s", "back to back; mean over the scenes, of ours geometric", "1/s", ".1f"),
    Column("frames/s, least", "of a scene", "1/s", ".1f"),
    Column("frames/s, most", "of a scene", "1/s", ".1f"),
    Column("MB", "moved for a frame, mean over the scenes", "MB", ".0f"),
    Column("mm2", "area, the largest of the scenes", "mm2", ".2f"),
    Column("what differs", "of published rates: what is not comparable"),
)
