#!/usr/bin/env python3
"""Exact order against paper order, each with the machine that does best for it in the same area.

Of each order a machine is searched, one for all scenes, within the area of the shipped preset
`paper` (--budgets 1) and larger ones; what belongs to a scene's storage, chunk or voxel size, may
be chosen for each scene. A machine does best when the geometric mean over the scenes, view 0, is
smallest: of cycles; in the first area also one for bytes on the bus and one for joules. Second
halves are raw, memory channels are the preset's, on-chip memory is as large as the rest needs and
counts by its area.

Then the presets and the machines found for cycles draw every view.

Writes fair_fight_front.csv and .md: the points of both orders that no other one beats in picture,
bytes, time, energy and area; fair_fight_machines.md: what was chosen, and as a configuration each
in fair_fight_ORDER_BUDGET_OBJECTIVE.json; fair_fight_views.csv and .md, and their summary. What was
simulated is kept in fair_fight_runs.jsonl, as long as program, presets and technology are the same:
started again, the script goes on where it ended.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import statistics
import sys
from collections.abc import Sequence

from runs import run_arguments
from results import tables
from fair_fight_tables import FRONT_HEAD, assigned_document, found_table, front_rows, near_front
from runs.kept_runs import KeptRuns
from machine_areas import Areas, area_mm2, start_of
from machine_axes import ORDERS, Machine, Order
from machine_search import OBJECTIVES, Point, Search
from machine_views import Contender, views_tables
from runs.scenes import Scene, find_scenes, shared_names
from runs.simulations import Run
from runs.view_numbers import decibels

BUDGET_PRESET = "paper"
PRESETS = ("exact", BUDGET_PRESET, "exact_wide")
RUNS_FILE = "fair_fight_runs.jsonl"
# Those that ask most of a machine first, so that one that is bad for them is given up early.
SCENES_IN_TURN = ("park", "platform", "yard", "garden", "truck", "playbot")
# Below the preset's picture by less than this is as good.
SAME_DB = 0.1
# Of each search so many are drawn on all views, and the best of them is taken.
CANDIDATES = 3


def scenes_in_turn(texts: Sequence[str]) -> list[Scene]:
    names = list(texts) or [n for n in SCENES_IN_TURN if n in shared_names()]
    if not names:
        raise ValueError("no SCENE given, and no real ones are there")
    return find_scenes(names)


def storage_at_start(order: Order, kept: KeptRuns, scenes: Sequence[Scene], size: str) -> list[int]:
    """As the preset stores each scene, or nearest to that."""
    kind = order.storage.name.partition(".")[2]
    found = []
    for outcome in kept.outcomes([Run(s, "0", size, order.preset) for s in scenes]):
        view = outcome.accepted()[0]
        stored = view["scene"].get(kind) or view["config"]["storage"][kind]
        distances = [
            abs(float(setting[0].partition("=")[2]) - stored) for setting in order.storage.settings
        ]
        found.append(distances.index(min(distances)))
    return found


class Fight:
    """Searches of all orders, areas and objectives that are asked for."""

    def __init__(self, arguments: argparse.Namespace, kept: KeptRuns, scenes: Sequence[Scene]):
        self.arguments, self.kept, self.scenes = arguments, kept, scenes
        self.searches: dict[tuple[str, float, str], Search] = {}
        self.best: dict[tuple[str, float, str], Point] = {}

    def paper_area(self) -> float:
        """Of the preset, with codebooks as the scene with the largest needs them."""
        if self.arguments.area:
            return self.arguments.area
        runs = [Run(s, "0", self.arguments.size, BUDGET_PRESET) for s in self.scenes]
        outcomes = self.kept.outcomes(runs)
        return max(area_mm2(outcome.accepted()[0]) for outcome in outcomes)

    def preset_db(self, view: str) -> list[float]:
        """Of each scene, the mean over these views."""
        runs = [Run(s, view, self.arguments.size, BUDGET_PRESET) for s in self.scenes]
        outcomes = self.kept.outcomes(runs)
        return [statistics.fmean(map(decibels, o.accepted())) for o in outcomes]

    def best_of_all_views(self, search: Search) -> Point | None:
        """Of the points that do best on the first view the one that does best on all: the mean over
        the scenes of the means over their views. Where pictures are kept, they must be so on this
        mean, too. None where there is no point."""
        distinct = {(point.machine.at, point.storage): point for point in search.points}
        first = sorted(distinct.values(), key=lambda point: point.mean(search.value))
        if self.arguments.view == "none":
            return first[0] if first else None

        least_db = self.preset_db(self.arguments.view) if search.least_db else []

        def mean(point: Point) -> float:
            runs = [search.run(point.machine, point.storage, n) for n in range(len(self.scenes))]
            runs = [dataclasses.replace(run, view=self.arguments.view) for run in runs]
            drawn = self.kept.outcomes(runs)
            if any(outcome.refused for outcome in drawn):
                return math.inf
            db = [statistics.fmean(map(decibels, outcome.views)) for outcome in drawn]
            if any(of < least - SAME_DB for of, least in zip(db, least_db)):
                return math.inf
            return statistics.geometric_mean(
                statistics.fmean(map(search.value, outcome.views)) for outcome in drawn
            )

        means = [(mean(point), at) for at, point in enumerate(first[:CANDIDATES])]
        best = min(means, default=(math.inf, 0))
        return first[best[1]] if math.isfinite(best[0]) else None

    def check_views(self) -> None:
        """What the tables show last is drawn first: views and sizes that cannot be are refused
        before the search, not behind it."""
        if self.arguments.view == "none":
            return
        drawn = [
            Run(scene, self.arguments.view, size, PRESETS[0])
            for scene in self.scenes
            for size in self.arguments.view_sizes
        ]
        for outcome in self.kept.outcomes(drawn):
            outcome.accepted()

    def search_all(self) -> None:
        arguments, area, areas = self.arguments, self.paper_area(), Areas(self.kept)
        for name in self.arguments.orders:
            order = ORDERS[name]
            machine, harm = start_of(order, self.kept.outcome), {}
            storage = storage_at_start(order, self.kept, self.scenes, arguments.size)
            least_db = [db - SAME_DB for db in self.preset_db("0")] if order.keeps_picture else None
            first, *others = arguments.objectives
            smallest, *larger = arguments.budgets
            for budget, objective, share in (
                (smallest, first, 1.0),
                # These begin where the first one ended, and have less to find.
                *((smallest, other, 0.4) for other in others),
                *((budget, first, 0.4) for budget in larger),
            ):
                search = Search(
                    areas,
                    self.scenes,
                    arguments.size,
                    budget * area,
                    objective,
                    round(share * arguments.most_runs),
                    harm,
                    least_db,
                )
                search.best_from(machine, storage)
                harm = harm or search.harm
                of = (name, budget, objective)
                self.searches[of] = search
                self.take_best(of)
                beside = (order.begins_at, budget, objective)
                self.begin_at(of, beside, machine.order)
                if beside in self.searches:
                    start = start_of(ORDERS[order.begins_at], self.kept.outcome)
                    self.begin_at(beside, of, start.order)
                if objective == first and (point := self.best.get(of)):
                    machine, storage = point.machine, point.storage
                self.write()

    def take_best(self, of: tuple[str, float, str]) -> None:
        if point := self.best_of_all_views(self.searches[of]):
            self.best[of] = point

    def begin_at(
        self, of: tuple[str, float, str], other: tuple[str, float, str], order: Order
    ) -> None:
        """Searches once more, from the best machine of another search; order: of the first, with
        its own lanes."""
        if begin := self.best.get(other):
            search = self.searches[of]
            search.runs_left = max(search.runs_left, round(0.4 * self.arguments.most_runs))
            search.best_from(Machine(order, begin.machine.at), begin.storage)
            self.take_best(of)

    def write(self) -> None:
        """What has been found so far."""
        out = self.arguments.out
        points = [point for search in self.searches.values() for point in search.points]
        front = near_front(points)
        made = run_arguments.how_made(view for p in points for view in p.views)
        rows = front_rows(points, front)
        text = made + tables.markdown(FRONT_HEAD[:-1], [row[:-1] for row in rows if row[-1]])
        tables.write_text(out / "fair_fight_front.csv", tables.csv_text(FRONT_HEAD, rows))
        tables.write_text(out / "fair_fight_front.md", text)
        found = made + found_table(self.best)
        tables.write_text(out / "fair_fight_machines.md", found)
        for (order, budget, objective), point in self.best.items():
            name = f"fair_fight_{order}_{budget:g}_{objective}.json".replace(" ", "_")
            document = assigned_document(self.kept.binary, point.machine, point.views)
            tables.write_text(out / name, json.dumps(document, indent=2) + "\n")

    def contenders(self) -> list[Contender]:
        """The presets, and what was found for the first objective in the first area."""
        presets = [Contender(f"preset {name}", name, ()) for name in PRESETS]
        wanted = (self.arguments.budgets[0], self.arguments.objectives[0])
        found = [
            Contender(
                f"{order}, best {objective}",
                point.machine.order.preset,
                tuple(point.overrides(n) for n in range(len(self.scenes))),
            )
            for (order, budget, objective), point in self.best.items()
            if (budget, objective) == wanted
        ]
        return presets + found


def fight(arguments: argparse.Namespace) -> None:
    for what, given in (
        ("budgets", arguments.budgets),
        ("area", [arguments.area or 1]),
        ("most-runs", [arguments.most_runs]),
    ):
        if bad := [n for n in given if n <= 0]:
            raise ValueError(f"--{what}: {bad[0]:g}, expected more than 0")
    for option in ("orders", "budgets", "objectives", "view_sizes"):
        run_arguments.check_once(f"--{option.replace('_', '-')}", getattr(arguments, option))
    scenes = scenes_in_turn(arguments.scenes)
    kept = KeptRuns(arguments.streaminggs, arguments.out / RUNS_FILE, arguments.side_by_side)
    made = Fight(arguments, kept, scenes)
    made.check_views()
    made.search_all()
    for name in ("fair_fight_machines", "fair_fight_front"):
        print((arguments.out / f"{name}.md").read_text())
    if arguments.view != "none":
        sizes = arguments.view_sizes
        drawn = views_tables(kept, made.contenders(), scenes, arguments.view, sizes)
        tables.write_text(arguments.out / "fair_fight_views.md", drawn.views)
        tables.write_text(arguments.out / "fair_fight_views.csv", drawn.csv)
        tables.write_text(arguments.out / "fair_fight_summary.md", drawn.summary)
        print(f"{drawn.views}\n{drawn.summary}")
    kept.end()


def main() -> int:
    parser = run_arguments.parser(__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    run_arguments.add_side_by_side(parser)
    parser.add_argument("--orders", nargs="+", choices=ORDERS, default=list(ORDERS))
    parser.add_argument(
        "--budgets", nargs="+", type=float, default=[1.0, 2.0], metavar="X", help="of paper's area"
    )
    parser.add_argument(
        "--area", type=float, metavar="MM2", help="of budget 1; default: the preset paper's"
    )
    parser.add_argument(
        "--objectives", nargs="+", choices=OBJECTIVES, default=list(OBJECTIVES), metavar="NAME"
    )
    parser.add_argument(
        "--most-runs",
        type=int,
        default=400,
        help="simulations in the first search of an order; each other gets 0.4 times as many",
    )
    parser.add_argument("--size", default="640x360", metavar="WxH", help="of the search")
    parser.add_argument("--view", default="all", help="that all machines draw in the end, or none")
    parser.add_argument(
        "--view-sizes", nargs="+", default=["640x360", "1280x720"], metavar="WxH", help="of these"
    )
    return run_arguments.main_of_tables(fight, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
