#!/usr/bin/env python3
"""One HTML page of results, to be opened from disk: it needs nothing beside it and no network.

  report.py out/first_frame
  report.py out/builtin_object
  report.py out/sweep.jsonl

A folder is what `streaminggs simulate --out` wrote, with one view or several, or the frames of a
--path, with --stream or without; or a folder that holds several runs at most three folders below, and the CSV tables that
scripts wrote there (explore.csv): the page then begins with all of them in one table and a diagram.
Pictures are halved until the page is small enough, then left out from the last view on; it says so.

A file is what `streaminggs sweep --out` wrote, or with fewer keys of each configuration its --csv:
of each scene and view all points in a diagram and a table, with the front, and of a point that is
chosen there the configuration and the command that runs it again.
"""

from __future__ import annotations

import pathlib
import sys
from collections.abc import Sequence

from reporting import sweep, tables
from runs import run_arguments
from runs.files import write_text
from reporting.charts import escaped, rate
from reporting.folder import (
    Run,
    Table,
    ViewFiles,
    find_runs,
    find_tables,
)
from reporting.page import Panel, page
from reporting.stream import held
from reporting.sweep import read_sweep

FRAMES = "frames back to back"


def title_of(run: Run, files: ViewFiles, several_runs: bool) -> str:
    view = files.report
    of_run = run.name if several_runs else view["scene"]["name"]
    if run.path:
        return f"{of_run}, frame {view['view']}, the slowest"
    return f"{of_run}, view {view['view']}"


def panels_of(runs: Sequence[Run], found: Sequence[Table]) -> list[Panel]:
    views = [(run, files) for run in runs for files in run.shown()]
    panels = []
    text = ""
    if len(views) > 1:
        text += tables.sections(runs)
    text += "".join(tables.section(table, f"{table.name}.csv") for table in found)
    failed = [(run, failure) for run in runs for failure in run.failed]
    text += "".join(
        f"<p class=note><b>{escaped(run.name)} view {failure['view']} failed.</b> "
        f"{escaped(failure['why'])}</p>"
        for run, failure in failed
    )
    if text:
        panels.append(Panel("overview", text=f"<div class=grid>{text}</div>"))
    several_runs = len(runs) > 1
    panels += [Panel(title_of(run, files, several_runs), run, files) for run, files in views]
    for run in runs:
        if run.stream:
            of_run = run.name if several_runs else run.stream.all.report["scene"]["name"]
            panels.append(Panel(f"{of_run}, {FRAMES}", run, run.stream.all))
    return panels


def heading_of_stream(run: Run) -> tuple[str, str]:
    """Of `simulate --path --stream`."""
    whole = run.stream.all.report
    words = (
        f"{len(run.stream.report['frames'])} frames along {run.path}, {FRAMES}",
        held(run.stream.report),
        f"machine {whole['config']['machine']}",
        f"commit {whole['provenance']['commit']}",
    )
    return whole["scene"]["name"], " · ".join(words)


def heading_of_path(run: Run) -> tuple[str, str]:
    """Of the frames of `simulate --path`."""
    summary, first = run.summary, run.views[0].report
    words = (
        f"{summary['frames']} frames along {run.path}",
        f"frames a second: worst {rate(summary['worst_fps'])} (frame {summary['worst_frame']}), "
        f"p99 {rate(summary['p99_fps'])}, median {rate(summary['median_fps'])}",
        f"{summary['late_frames']} late at {summary['frame_rate']:g} a second",
        *(f"{empty} hold no Gaussian" for empty in [summary["empty_frames"]] if empty),
        f"{summary['energy_a_second_j']:.3g} J a second"
        + ("" if summary.get("memory_known", True) else " without the memory"),
        f"machine {first['config']['machine']}",
        f"commit {first['provenance']['commit']}",
    )
    return first["scene"]["name"], " · ".join(words)


def heading(runs: Sequence[Run], found: Sequence[Table], folder: pathlib.Path) -> tuple[str, str]:
    """Title and the line below it."""
    if len(runs) == 1 and runs[0].stream:
        return heading_of_stream(runs[0])
    if len(runs) == 1 and runs[0].path:
        return heading_of_path(runs[0])
    if not runs:
        return folder.resolve().name, f"tables: {', '.join(table.name for table in found)}"
    views = [files.report for run in runs for files in run.views]
    if len(runs) != 1:
        return folder.resolve().name, f"{len(runs)} runs, {len(views)} views"
    view = views[0]
    frames = [v["frame"] for v in views]
    sizes = dict.fromkeys(f"{f['width_px']} × {f['height_px']} px" for f in frames)
    words = (
        f"{view['scene']['gaussians']:,} Gaussians",
        f"SH degree {view['scene']['sh_degree']}",
        ", ".join(sizes),
        *filter(None, [view["provenance"].get("configuration")]),
        f"machine {view['config']['machine']}",
        *(f"blends in {p}" for p in [view["config"].get("rendering", {}).get("precision")] if p),
        f"{view['config']['clock_mhz']:g} MHz",
        f"commit {view['provenance']['commit']}",
    )
    return view["scene"]["name"], " · ".join(words)


def page_of_folder(folder: pathlib.Path) -> str:
    """Raises ValueError where there is nothing to show."""
    runs, found = list(find_runs(folder)), find_tables(folder)
    panels = panels_of(runs, found)
    if not panels:
        raise ValueError(
            f"{folder}: no results, expected report.json of `streaminggs simulate`, folders with "
            "one, or CSV tables"
        )
    return page(*heading(runs, found, folder), panels)


def page_of_sweep(results: pathlib.Path) -> str:
    """Raises ValueError where there is nothing to show."""
    points = read_sweep(results)
    panels = [Panel(name, text=text) for name, text in sweep.panels(points)]
    return page(results.stem, sweep.subtitle(points), panels)


def check_page(out: pathlib.Path, results: pathlib.Path) -> None:
    """Raises ValueError for a name that results could have."""
    if out.is_dir():
        raise ValueError(f"{out}: got a folder, expected a file to write the page to")
    if out.suffix.lower() not in (".html", ".htm") or out.resolve() == results.resolve():
        raise ValueError(
            f"{out}: expected the name of a page, as in report.html: it would be written over"
        )


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument(
        "results", type=pathlib.Path, metavar="RESULTS", help="a folder, or a file of a sweep"
    )
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        metavar="FILE",
        help="the page; default: report.html in the folder, or beside the file with its name",
    )
    arguments = parser.parse_args()

    def work() -> None:
        results = arguments.results
        if results.is_dir():
            made, out = page_of_folder(results), results / "report.html"
        elif results.exists():
            made, out = page_of_sweep(results), results.with_suffix(".html")
        else:
            raise ValueError(f"{results}: no folder, expected one with results or those of a sweep")
        out = arguments.out or out
        check_page(out, results)
        write_text(out, made)
        print(f"written to {out}")

    return run_arguments.main(work)


if __name__ == "__main__":
    sys.exit(main())
