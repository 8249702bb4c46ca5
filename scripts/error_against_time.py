#!/usr/bin/env python3
"""Error against run time, in diagrams with a table each: what to choose when.

  error_against_time.py truck yard platform park
  error_against_time.py truck --diagrams image tuning

image      pictures against frame time, bytes and energy: order, group, voxel, chunk, merge buffer,
           encoding, precision, finishing, tuning
tuning     quality of test views against wall time: rates of tuning on the scenes, budgets of
           Gaussians in training on data sets
renderers  pictures of the renderers in software, and of thresholds at which a pixel is finished,
           against wall time, by threads

Writes error_NAME.md and .csv, and figures beside them where Matplotlib is there. All frames,
fittings and times are kept in the folder for tables: started again it goes on where it ended.
"""

from __future__ import annotations

import argparse
import pathlib
import sys

import error_image
import error_renderers
import error_tuning
from runs import run_arguments
from drawing.figures_beside import draw_beside
from runs.scenes import find_scenes
from runs.view_numbers import view_numbers_there

DIAGRAMS = {
    "image": error_image.make,
    "tuning": error_tuning.make,
    "renderers": error_renderers.make,
}
FIGURES = {"image": ("error_image", "error_image_kinds")}


def check(arguments: argparse.Namespace) -> None:
    """Before hours of frames. Raises ValueError for numbers that say nothing, and what is twice."""
    run_arguments.check_at_least("--steps", arguments.steps, 0)
    run_arguments.check_at_least("--between", arguments.between, 0)
    run_arguments.check_at_least("--train-steps", arguments.train_steps, 1)
    for budget in arguments.budgets:
        run_arguments.check_at_least("--budgets", budget, 1)
    for rate in arguments.rates:
        run_arguments.check_above_zero("--rates", rate)
    run_arguments.check_above_zero("--downscale", arguments.downscale)
    for option in ("size", "tuning_size"):
        run_arguments.check_size(f"--{option.replace('_', '-')}", getattr(arguments, option))
    for option in ("diagrams", "rates", "budgets", "threads"):
        run_arguments.check_once(f"--{option}", getattr(arguments, option))


def make_diagrams(arguments: argparse.Namespace) -> None:
    check(arguments)
    scenes = find_scenes(arguments.scenes)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, ",".join(arguments.views))
    if "tuning" in arguments.diagrams:
        error_tuning.dataset_folders(arguments)
    for name in arguments.diagrams:
        DIAGRAMS[name](scenes, arguments)
        draw_beside(arguments.out, *FIGURES.get(name, (f"error_{name}",)))


def views(text: str) -> list[str]:
    numbers = text.split(",")
    if not all(number.isdecimal() for number in numbers):
        raise argparse.ArgumentTypeError(f"got '{text}', expected numbers of cameras, as in 0,2")
    return numbers


def main() -> int:
    parser = run_arguments.parser(__doc__)
    parser.add_argument(
        "--diagrams", nargs="+", choices=DIAGRAMS, default=list(DIAGRAMS), metavar="NAME",
        help="which of the three",
    )  # fmt: skip
    parser.add_argument("--view", dest="views", type=views, default="0", help="as in 0,2")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="px of a view")
    parser.add_argument("-j", "--jobs", type=int, default=1, help="frames side by side")
    parser.add_argument("--steps", type=int, default=120, help="of tuning; 0: nothing is tuned")
    parser.add_argument("--tuning-size", default="160x90", metavar="WxH", help="px, for tuning")
    parser.add_argument(
        "--between",
        type=int,
        default=60,
        metavar="N",
        help="cameras between a scene's own to tune on",
    )
    parser.add_argument(
        "--rates", nargs="+", type=float, default=[0.5, 2, 8], metavar="X", help="of tuning"
    )
    parser.add_argument(
        "--datasets", nargs="*", default=["lego"], metavar="DATASET", help="to train on"
    )
    parser.add_argument("--downscale", type=float, default=8, help="of their photographs")
    parser.add_argument("--train-steps", type=int, default=1200, help="of training")
    parser.add_argument(
        "--budgets", nargs="+", type=int, default=[1000, 4000, 16000], metavar="N",
        help="Gaussians that a training may have",
    )  # fmt: skip
    parser.add_argument(
        "--renderers",
        type=pathlib.Path,
        default=error_renderers.PROGRAM,
        metavar="PROGRAM",
        help="that draws and times them",
    )
    parser.add_argument("--threads", nargs="+", type=int, default=[1, 2], metavar="N")
    return run_arguments.main_of_tables(make_diagrams, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
