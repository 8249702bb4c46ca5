#!/usr/bin/env python3
"""Figures of results that lie on disk, as SVG and PNG, one function each: the paper's, with its own
numbers where it has any, and ours. Captions name the file, the command and the commit that the
numbers are from. A figure whose input is not there is skipped by name, with the script that makes
it.

  figures.py                      all that traces/results and out/ have, into out/figures/
  figures.py variants roofline    these two

The paper's: characterisation, dram_by_stage, tuning_curve, variants, voxel_size, filter_units,
reproduction. Ours: headline; waterfall; compare_memories; training_curve; exploration,
fronts_of_orders, equal_area, group_size; compare_machines_rates, _traffic and _ratios; error_image,
error_tuning and error_renderers; and of the runs of `simulate` below the folder roofline, waits,
traffic.

Needs Debian's python3-matplotlib, which scripts/tools.sh installs.
"""

from __future__ import annotations

import argparse
import pathlib
import sys

from runs import run_arguments
from runs.scenes import REPOSITORY


def make_figures(arguments: argparse.Namespace) -> None:
    """Raises ValueError where nothing could be made, and for a table that is none."""
    run_arguments.need("matplotlib", "python3-matplotlib")
    from drawing import exploration, machines, quality, reproduced  # these need it
    from drawing.figure import OF_FRAMES, Missing, Results, save

    known = {
        **machines.FIGURES,
        **quality.FIGURES,
        **exploration.FIGURES,
        **reproduced.FIGURES,
        **OF_FRAMES,
    }
    for name in arguments.names:
        if name not in known:
            raise ValueError(f"{name}: no figure, expected {', '.join(known)}")
    runs = arguments.folder or REPOSITORY / "out"
    results = Results(arguments.folder or REPOSITORY / "traces" / "results", runs)
    if arguments.folder and not runs.is_dir():
        raise ValueError(f"--from: {runs}: no folder, expected one with results")
    out = arguments.out or runs / "figures"
    made = 0
    for name in arguments.names or known:
        try:
            figure, caption = known[name](results)
        except Missing as missing:
            print(f"skipped {name}: {missing}")
            continue
        save(figure, out, name, caption)
        print(f"written to {out / name}.svg, .png", flush=True)
        made += 1
    if made == 0:
        raise ValueError(f"{runs}: nothing to draw any of the figures from")


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument("names", nargs="*", metavar="FIGURE", help="as above; default: all")
    parser.add_argument(
        "--from",
        dest="folder",
        type=pathlib.Path,
        metavar="FOLDER",
        help="with tables and results; default: traces/results and out",
    )
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        metavar="FOLDER",
        help="default: figures/ in that of --from, or in out",
    )
    arguments = parser.parse_args()
    return run_arguments.main(lambda: make_figures(arguments))


if __name__ == "__main__":
    sys.exit(main())
