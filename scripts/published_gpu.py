"""What is published of the original rasteriser on a GPU beside what its model gives."""

from __future__ import annotations

import statistics
from collections.abc import Sequence

HEAD = ("scene", "size", "what", "published", "modelled", "residual")

# StreamingGS. What the model was set to says nothing of how good it is.
CALIBRATED_TO = 4.9
CASES = (
    ("builtin:outdoor?n=2300000", "1160x800", CALIBRATED_TO),
    ("builtin:object?n=334000", "800x800", 8.5),
)
# Speedy-Splat, of a desktop GPU; StreamingGS, of the mobile one.
TIME = {"projection": 9, "duplication": 8, "sort": 21, "ranges": None, "rendering": 60}
BYTES = {"projection": 41, "sorting": 49, "rendering": 10}
SORTING = ("duplication", "sort", "ranges")


def span(values: Sequence[float]) -> str:
    return f"{min(values):.0f} .. {max(values):.0f}"


def shares(views: Sequence[dict], stages: Sequence[str], value: str) -> list[float]:
    """Of each view, in per cent of all its stages."""

    def of(stage: dict) -> float:
        kinds = ("scene_bytes", "intermediate_bytes", "frame_bytes")
        return stage["seconds"] if value == "time" else sum(stage[kind] for kind in kinds)

    all_of = [sum(map(of, view["stages"])) for view in views]
    some = [sum(of(s) for s in view["stages"] if s["name"] in stages) for view in views]
    return [100 * part / whole for part, whole in zip(some, all_of)]


def residuals(values: Sequence[float], published: float | None) -> str:
    if published is None:
        return ""
    return f"{min(values) - published:+.0f} .. {max(values) - published:+.0f}"


def rows_of(by_case: Sequence[Sequence[dict]]) -> list[tuple]:
    """by_case: the views of each of CASES."""
    rows = []
    for (spec, size, published), views in zip(CASES, by_case):
        here = 1 / statistics.fmean(view["seconds"] for view in views)
        over = f"{100 * (here / published - 1):+.0f} %"
        what = "frames/s, calibrated to" if published == CALIBRATED_TO else "frames/s"
        rows.append((spec, size, what, published, f"{here:.1f}", over))
        for value, published_shares in (("time", TIME), ("bytes", BYTES)):
            for name, percent in published_shares.items():
                of = shares(views, SORTING if name == "sorting" else (name,), value)
                what, left = f"{value}, {name} %", residuals(of, percent)
                rows.append((spec, size, what, percent or "", span(of), left))
    return rows
