"""The table of machines beside each other on all views of several scenes."""

from __future__ import annotations

import dataclasses
import statistics
from collections.abc import Sequence

from runs import run_arguments
from results import tables
from runs.kept_runs import KeptRuns
from runs.scenes import Scene
from runs.simulations import Outcome, Run
from runs.view_numbers import binders, decibels, numbers, psnr_span, vsu_waits

# Above this the rounding to 8 bits decides: such views are drawn once more, in floats.
ROUNDING_DB = 50

HEAD = (
    "scene",
    "machine",
    "bus MB",
    "asked / once",
    "bus / asked",
    "M cycles",
    "fps, worst view",
    "mJ",
    "mm2",
    "PSNR dB",
    "binds",
    "VSU waits for reads",
)


@dataclasses.dataclass(frozen=True)
class Contender:
    """overrides: for each scene its own, or none for any."""

    name: str
    preset: str
    overrides: tuple[tuple[str, ...], ...]

    def run(self, scene: Scene, number: int, view: str, size: str) -> Run:
        overrides = self.overrides[number] if self.overrides else ()
        return Run(scene, view, size, self.preset, overrides)


def in_floats(kept: KeptRuns, outcome: Outcome) -> Sequence[dict]:
    """The views whose PSNR says what the order costs, not what 8 bits do."""
    if max(map(decibels, outcome.views)) < ROUNDING_DB:
        return outcome.views
    overrides = (*outcome.run.overrides, "framebuffer=rgb32f")
    return kept.outcome(dataclasses.replace(outcome.run, overrides=overrides)).accepted()


def quantised(views: Sequence[dict]) -> bool:
    return any(view["config"]["storage"]["encoding"].startswith("vq") for view in views)


def text_row(kept: KeptRuns, scene: str, name: str, outcome: Outcome) -> tuple:
    if outcome.refused:
        return (scene, name, *[""] * (len(HEAD) - 4), f"refused: {outcome.refused}", "")
    views = outcome.views
    bus, asked, wasted, cycles, fps, joules, mm2, waits = numbers(views)
    return (
        scene,
        name,
        f"{bus / 1e6:.1f}",
        # Once what a quantised scene holds would be another once.
        "" if quantised(views) else f"{asked:.2f}",
        f"{wasted:.2f}",
        f"{cycles / 1e6:.2f}",
        f"{fps:.0f}",
        f"{joules * 1e3:.2f}",
        f"{mm2:.2f}",
        psnr_span(in_floats(kept, outcome)),
        binders(views),
        f"{waits:.0%}",
    )


CSV_HEAD = (
    "size_px",
    "scene",
    "machine",
    "view",
    "bus_bytes",
    "asked_bytes",
    "bytes_read_once",
    "cycles",
    "fps",
    "energy_j",
    "area_mm2",
    "psnr_db",
    "binds",
    "binding_key",
    "vsu_waits_for_reads",
)


def csv_row(size: str, scene: str, name: str, view: dict) -> tuple:
    return (
        size,
        scene,
        name,
        view["view"],
        view["dram"]["bus_bytes"],
        view["dram"]["bytes"],
        view["limit"]["bytes_read_once"],
        view["frame"]["cycles"],
        view["frame"]["fps"],
        view["energy"]["total_j"],
        view["area_mm2"]["total"],
        decibels(view),
        view["binding"]["holds"],
        view["binding"].get("key", ""),
        vsu_waits(view),
    )


SUMMARY_HEAD = (
    "size px",
    "machine",
    "mm2",
    "bus MB",
    "M cycles",
    "mJ",
    "fps, worst view",
    "PSNR dB",
    "VSU waits for reads, most",
    "faster than paper",
)


def summary_row(
    size: str, name: str, by_scene: Sequence[Outcome], paper: Sequence[Outcome], in_float: Sequence
) -> tuple:
    """Geometric means over the scenes of the means over their views; worst cases of all views."""
    if refused := [o.run.scene.name for o in by_scene if o.refused]:
        return (size, name, *[""] * 5, f"refused on {', '.join(refused)}", "", "")
    of = [numbers(outcome.views) for outcome in by_scene]
    bus, cycles, joules = (statistics.geometric_mean(n[i] for n in of) for i in (0, 3, 5))
    faster = [
        theirs["frame"]["cycles"] / ours["frame"]["cycles"]
        for outcome, b in zip(by_scene, paper)
        for ours, theirs in zip(outcome.views, b.views)
    ]
    times = [f"{ratio:.2f}" for ratio in (min(faster), max(faster))] if faster else []
    return (
        size,
        name,
        f"{max(n[6] for n in of):.2f}",
        f"{bus / 1e6:.1f}",
        f"{cycles / 1e6:.2f}",
        f"{joules * 1e3:.2f}",
        f"{min(n[4] for n in of):.0f}",
        psnr_span([view for views in in_float for view in views]),
        f"{max(n[7] for n in of):.0%}",
        " .. ".join(times),
    )


@dataclasses.dataclass(frozen=True)
class ViewsTables:
    """views: a table for each size with a line for each scene and machine; csv: a line for each
    view, as it was drawn in 8 bits; summary: a line for each size and machine."""

    views: str
    csv: str
    summary: str


def views_tables(
    kept: KeptRuns,
    contenders: Sequence[Contender],
    scenes: Sequence[Scene],
    view: str,
    sizes: Sequence[str],
) -> ViewsTables:
    """`faster than paper` is over the second contender."""
    parts, csv_rows, summary, measured = [], [], [], []
    for size in sizes:
        by_machine = {
            c.name: kept.outcomes([c.run(scene, n, view, size) for n, scene in enumerate(scenes)])
            for c in contenders
        }
        rows = [
            text_row(kept, scene.name, name, outcomes[n])
            for n, scene in enumerate(scenes)
            for name, outcomes in by_machine.items()
        ]
        parts.append(f"{size} px:\n\n{tables.markdown(HEAD, rows)}")
        for name, outcomes in by_machine.items():
            in_float = [in_floats(kept, outcome) for outcome in outcomes if outcome.views]
            paper = by_machine[contenders[1].name]
            summary.append(summary_row(size, name, outcomes, paper, in_float))
            for outcome in outcomes:
                name_of = outcome.run.scene.name
                csv_rows += [csv_row(size, name_of, name, v) for v in outcome.views]
                measured += outcome.views
    made = run_arguments.how_made(measured)
    return ViewsTables(
        made + "\n".join(parts),
        tables.csv_text(CSV_HEAD, csv_rows),
        made + tables.markdown(SUMMARY_HEAD, summary),
    )
