"""What the report page reads of a report.json and path.json, and of which kind it has to be."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping

NUMBER, TEXT, FLAG = (int, float), (str,), (bool,)
OBJECT, LIST = (dict,), (list,)
NAMES = {
    **{NUMBER: "a number", TEXT: "a text", FLAG: "true or false"},
    **{OBJECT: "an object", LIST: "a list", (type(None),): "null"},
}


class Each:
    """An object whose every value is of one shape, whatever their names."""

    def __init__(self, shape: object):
        self.shape = shape


class Or:
    """Of a shape, or null."""

    def __init__(self, shape: object):
        self.shape = shape


def numbers(*keys: str) -> dict[str, tuple]:
    return dict.fromkeys(keys, NUMBER)


# An object is a dictionary: keys that end with ? may be missing, others may be there. A list has one
# element: what all of it are.
WAIT = {"for": TEXT, "cycles": NUMBER, "on?": TEXT, "other_end?": TEXT, "key?": TEXT, "turn?": TEXT}
CAUSES = ("input", "reads", "writes", "room", "port", "loading", "phase", "idle")
ACTIVITY = {
    "resource": TEXT,
    "busy_cycles": NUMBER,
    "waited_cycles": numbers(*CAUSES),
    "waits": [WAIT],
}
BANDS = {"bands": Each(numbers("low", "high"))}
CONFIG = {"machine": TEXT, "clock_mhz": NUMBER, "rendering?": {"precision?": TEXT}}
VIEW = {
    "view": NUMBER,
    "scene": {"name": TEXT, **numbers("gaussians", "sh_degree")},
    "frame": numbers("width_px", "height_px", "cycles", "fps"),
    "image": {"psnr_db": Or(NUMBER), "ssim": NUMBER, "equals_streaming_renderer": FLAG},
    "limit": numbers("ratio"),
    "binding": {"unit": TEXT, "utilisation": NUMBER, "explanation": TEXT},
    "units": Each({"activities": Each(ACTIVITY), "counters": Each(NUMBER)}),
    "dram": {
        **numbers("bytes", "bus_bytes", "of_peak", "row_hits", "row_misses", "row_conflicts"),
        **numbers("bandwidth_gb_s", "peak_gb_s", "busy_bandwidth_gb_s"),
        **numbers("read_latency_mean_ns", "read_latency_p99_ns"),
        "bytes_by_region": Each(Each({"read?": NUMBER, "write?": NUMBER})),
        "bus_bytes_by_region": Each(NUMBER),
    },
    "energy": {**numbers("total_j", "mean_power_w"), **BANDS},
    "area_mm2": {**numbers("total"), **BANDS},
    "left_out": [{"what": TEXT, "count": NUMBER, "why": TEXT, "saves": TEXT}],
    "host": numbers("simulation_wall_s"),
    "config": CONFIG,
    "chosen?": [{"key": TEXT, "why": TEXT}],
    "provenance": {"version": TEXT, "commit": TEXT, "technology": TEXT, "command": TEXT},
}
SEVERAL_VIEWS = {"views": [VIEW], "failed?": [{"view": NUMBER, "why": TEXT}]}
PATH = {
    "summary": numbers(
        *("frames", "worst_fps", "worst_frame", "p99_fps", "median_fps"),
        *("late_frames", "frame_rate", "energy_a_second_j"),
    ),
    "path": {"name": TEXT},
    "scene": {"name": TEXT},
    "config": CONFIG,
    "provenance": {"commit": TEXT},
}


def kinds_of(shape: object) -> tuple:
    if isinstance(shape, tuple):
        return shape
    return LIST if isinstance(shape, list) else OBJECT


def check(file: pathlib.Path, found: object, shape: object, place: str = "") -> None:
    """Raises ValueError at the first place that is not of the shape."""
    if isinstance(shape, Or):
        if found is None:
            return
        shape = shape.shape
    kinds = kinds_of(shape)
    # To Python true is a number.
    if not isinstance(found, kinds) or isinstance(found, bool) != (shape == FLAG):
        got = NAMES[kinds_of_value(found)]
        raise ValueError(f"{file}: {place or 'all of it'}: got {got}, expected {NAMES[kinds]}")
    if isinstance(shape, list):
        for at, element in enumerate(found):
            check(file, element, shape[0], f"{place}[{at}]")
    elif isinstance(shape, Each):
        for key, value in found.items():
            check(file, value, shape.shape, below(place, key))
    elif isinstance(shape, dict):
        check_object(file, found, shape, place)


def check_object(
    file: pathlib.Path, found: Mapping[str, object], shape: Mapping[str, object], place: str
) -> None:
    for name, of_key in shape.items():
        key = name.removesuffix("?")
        if key in found:
            check(file, found[key], of_key, below(place, key))
        elif key == name:
            raise ValueError(f"{file}: no '{below(place, key)}', expected what `simulate` writes")
    if shape.get("bands") is BANDS["bands"]:  # of amounts that stand beside them
        check_object(file, found, numbers(*found["bands"]), place)


def kinds_of_value(found: object) -> tuple:
    return NUMBER if type(found) in NUMBER else (type(found),)


def below(place: str, key: str) -> str:
    return f"{place}.{key}" if place else key
