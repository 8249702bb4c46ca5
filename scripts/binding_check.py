#!/usr/bin/env python3
"""Whether the resource that a view's `binding` names is the one whose doubling gains most: the
answers of `streaminggs what-if`, a line for each view. Writes binding_check.md and .csv.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import json
import pathlib
import sys
import tempfile

from runs import run_arguments
from results import tables
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import MOST_SIDE_BY_SIDE, REFUSED, Failure, Run, call, program_version, said

HEAD = (
    "scene",
    "view",
    "M cycles",
    "binding names",
    "doubled saves",
    "gains most",
    "doubled saves ",
    "named gains most",
    "why not",
)


@dataclasses.dataclass(frozen=True)
class Answer:
    """Of what-if on one view. Gains are shares of the frame's cycles."""

    scene: str
    answer: dict

    def named(self) -> str:
        return self.answer["base"]["holds_key"]

    def gains(self) -> dict[str, float]:
        """What could be doubled, most first."""
        doubled = [d for d in self.answer.get("doubled", []) if "refused" not in d]
        found = {d["key"]: d["time_saved"] for d in doubled}
        return dict(sorted(found.items(), key=lambda item: -item[1]))

    def named_gains_most(self) -> bool:
        return self.answer["named_gains_most"]

    def row(self) -> tuple:
        gains = self.gains()
        best = next(iter(gains), "")
        named = gains.get(self.named())
        return (
            self.scene,
            self.answer["view"],
            f"{self.answer['base']['cycles'] / 1e6:.3f}",
            self.named(),
            "not doubled" if named is None else f"{named:.1%}",
            best,
            f"{gains[best]:.1%}" if best else "",
            "yes" if self.named_gains_most() else "no",
            "" if self.named_gains_most() else self.answer["verdict"],
        )


def ask(arguments: argparse.Namespace, scene: Scene) -> list[Answer]:
    """Raises Failure, and ValueError where the command refuses."""
    run = Run(scene, arguments.view, arguments.size, arguments.config, tuple(arguments.set))
    with tempfile.TemporaryDirectory(prefix="streaminggs-") as folder:
        out = pathlib.Path(folder) / "what_if.json"
        words = [*run.arguments(), "--out", str(out)]
        done = call(arguments.streaminggs, words, "what-if")
        if done.returncode == REFUSED:
            raise ValueError(f"{run.label()}: {said(done)}")
        if done.returncode != 0:
            raise Failure(f"{run.label()}: {said(done)}")
        print(run.label(), file=sys.stderr, flush=True)
        return [Answer(scene.name, answer) for answer in json.loads(out.read_text())]


def make_table(arguments: argparse.Namespace) -> None:
    scenes = find_scenes(arguments.scenes or shared_names())
    workers = min(MOST_SIDE_BY_SIDE, arguments.side_by_side)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        waiting = [pool.submit(ask, arguments, scene) for scene in scenes]
        try:
            answers = [answer for each in waiting for answer in each.result()]
        finally:
            pool.shutdown(cancel_futures=True)
    rows = [answer.row() for answer in answers]
    right = sum(answer.named_gains_most() for answer in answers)
    version = {"provenance": {"commit": program_version(arguments.streaminggs)}}
    text = run_arguments.how_made([version])
    text += f"The resource named gains most on {right} of {len(answers)} views.\n\n"
    tables.write(arguments.out, "binding_check", text, HEAD, rows)


def main() -> int:
    parser = run_arguments.parser(__doc__, "all real scenes")
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--view", default="0", help="numbers of cameras, as in 0,2, or all")
    parser.add_argument("--size", default="640x360", metavar="WxH", help="in px")
    parser.add_argument("--config", default="exact", help="preset or JSON file")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="over the configuration"
    )
    return run_arguments.main_of_tables(make_table, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
