"""The energy of a frame by what takes it."""

from __future__ import annotations

from collections.abc import Iterable

# Components of energy that are neither logic nor on-chip memory.
OTHER = {
    "clock": ("clock_j",),
    "leakage": ("logic_leakage_j", "sram_leakage_j"),
    "DRAM": ("dram_j",),
    "all": ("total_j",),
}


def components(view: dict) -> dict[str, tuple[str, ...]]:
    """Name of a row: the keys of the report's energy that it sums."""
    logic = [name for name in view["area_mm2"] if name not in ("sram", "total", "bands")]
    rows = {name: (f"{name}_j",) for name in logic if f"{name}_j" in view["energy"]}
    elsewhere = {key for keys in [*rows.values(), *OTHER.values()] for key in keys}
    # Numbers, not what is split up once more, such as dram_by_region_j.
    taken = [k for k, of in view["energy"].items() if k.endswith("_j") and not isinstance(of, dict)]
    memories = sorted(key for key in taken if key not in elsewhere)
    pixels = tuple(key for key in memories if key == "pixel_state_j")
    rest = tuple(key for key in memories if key != "pixel_state_j")
    return {**rows, "SRAM: pixels": pixels, "SRAM: all else": rest, **OTHER}


def joules(view: dict, keys: Iterable[str]) -> float:
    return sum(view["energy"].get(key, 0) for key in keys)


def joules_at_end(view: dict, keys: Iterable[str], end: str) -> float:
    """With the technology's energies at an end of their bands: low or high."""
    bands = view["energy"]["bands"]
    return sum(bands[key][end] for key in keys if key in bands)
