#!/usr/bin/env python3
"""Figures of results that lie on disk, as SVG and PNG, one function each: the paper's, with its own
numbers where it has any, and ours. Captions name the file, the command and the commit that the
numbers are from. A figure whose input is not there is skipped by name, with the script that makes
it.

  figures.py                      all that can be made from out/, into out/figures/
  figures.py variants roofline    these two

The paper's: characterisation, dram_by_stage, tuning_curve, variants, voxel_size, filter_units.
Ours: training_curve; exploration, fronts_of_orders, equal_area, group_size;
compare_machines_rates, _traffic and _ratios; error_image, error_image_kinds,
error_tuning and error_renderers; and of the runs of `simulate` below the folder
roofline, waits, traffic.

Needs Debian's python3-matplotlib, which scripts/tools.sh installs.
"""

from __future__ import annotations

import argparse
import pathlib
import sys

from runs import debian_python, run_arguments, simulations
from drawing.figure_inputs import Missing, Results


def make_figures(arguments: argparse.Namespace) -> None:
    """Raises ValueError where nothing could be made, and for a table that is none."""
    debian_python.need("matplotlib", "python3-matplotlib")
    from drawing import figure_style  # these need it
    from drawing import figures_of_comparison, figures_of_errors
    from drawing import figures_of_exploration, figures_of_image_errors
    from drawing import figures_of_machines, figures_of_paper, figures_of_tuning

    known = {
        **figures_of_paper.FIGURES,
        **figures_of_tuning.FIGURES,
        **figures_of_exploration.FIGURES,
        **figures_of_machines.FIGURES,
        **figures_of_comparison.FIGURES,
        **figures_of_image_errors.FIGURES,
        **figures_of_errors.FIGURES,
    }
    for name in arguments.names:
        if name not in known:
            raise ValueError(f"{name}: no figure, expected {', '.join(known)}")
    results = Results(arguments.folder)
    if not results.folder.is_dir():
        raise ValueError(f"--from: {results.folder}: no folder, expected one with results")
    out = arguments.out or results.folder / "figures"
    made = 0
    for name in arguments.names or known:
        try:
            figure, caption = known[name](results)
        except Missing as missing:
            print(f"skipped {name}: {missing}")
            continue
        figure_style.save(figure, out, name, caption)
        print(f"written to {out / name}.svg, .png", flush=True)
        made += 1
    if made == 0:
        raise ValueError(f"{results.folder}: nothing to draw any of the figures from")


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument("names", nargs="*", metavar="FIGURE", help="as above; default: all")
    parser.add_argument(
        "--from",
        dest="folder",
        type=pathlib.Path,
        default=simulations.REPOSITORY / "out",
        metavar="FOLDER",
        help="with results",
    )
    parser.add_argument(
        "--out", type=pathlib.Path, metavar="FOLDER", help="default: figures/ in that of --from"
    )
    arguments = parser.parse_args()
    return run_arguments.main(lambda: make_figures(arguments))


if __name__ == "__main__":
    sys.exit(main())
