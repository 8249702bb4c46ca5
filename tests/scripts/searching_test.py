"""The search for machines: on a machine made up of formulas, and of each recipe with the command."""

import argparse
import contextlib
import csv
import io
import itertools
import json
import math
import pathlib
import time
import unittest
from unittest import mock

from in_folder import COMMAND, InFolder, nightly  # isort: skip (finds the scripts)
import explore
from exploring import options
from exploring.axes import ORDERS, Space, axis, keys_of, nearest, parse_axis
from exploring.judging import SMALL, Judge, Judged, Task, relative_to
from exploring.measures import objective, requirement
from exploring.record import BY_TIME, BY_TRIALS, ENDS, Record, Work
from exploring.steps import Steps
from runs import simulations
from runs.scenes import Scene
from studies import found

AXES = (
    axis("hfus", 1, 2, 4, 8),
    axis("hfu.lanes", 4, 8, 16, 32),
    axis("rendering.clusters", 1, 2, 4),
    axis("merge.entries", 64, 128, 256),
)
SCENES = (Scene("a", ""), Scene("b", ""))
SPACE = Space((*AXES, *parse_axis("storage.chunk@each=8,16,32", ("a", "b"))))
# Work of two scenes for lanes and for clusters; the chunk that suits each.
WORK = {"a": (900, 100, 16), "b": (100, 400, 32)}
PRESET = {"hfus": 8, "hfu.lanes": 32, "rendering.clusters": 4, "merge.entries": 256}
PRESET |= {"storage.chunk": 16}


def settings(run: simulations.Run) -> dict[str, float]:
    return settings_of(run.overrides)


def settings_of(overrides: tuple[str, ...]) -> dict[str, float]:
    pairs = (override.partition("=") for override in overrides)
    return {**PRESET, **{key: float(value) for key, _, value in pairs}}


def area(s: dict) -> float:
    return s["hfus"] * s["hfu.lanes"] * 0.02 + s["rendering.clusters"] + s["merge.entries"] / 256


def cycles(scene: str, view: int, s: dict) -> float:
    lanes, clusters, chunk = WORK[scene]
    filters = lanes / (s["hfus"] * s["hfu.lanes"])
    spills = 20 * 64 / s["merge.entries"]
    drawn = clusters * (1 + view) / s["rendering.clusters"]
    return filters + drawn + spills + abs(s["storage.chunk"] - chunk)


class Formulas:
    """In the place of the server. 4 HFUs of 32 lanes cannot be. waits: for frames side by side."""

    def __init__(self):
        self.drawn, self.waits = [], 0

    def outcome(self, run):
        s = settings(run)
        if s["hfus"] == 4 and s["hfu.lanes"] == 32:
            return simulations.Outcome(run, refused="cannot be")
        config = {"hfus": s["hfus"], "hfu": {"lanes": s["hfu.lanes"]}}
        config |= {"rendering": {"clusters": s["rendering.clusters"]}}
        config |= {
            "merge": {"entries": s["merge.entries"]},
            "storage": {"chunk": s["storage.chunk"]},
        }
        view = {"area_mm2": {"total": area(s)}, "binding": {"key": "hfu.lanes", "unit": "fine"}}
        view |= {"view": int(run.view), "config": config, "scene": {}, "provenance": {}}
        of = 1.0
        if run.scene != SMALL:
            self.drawn.append((run.scene.name, run.view, run.overrides))
            of = self.cycles(run.scene.name, int(run.view), s)
        view |= {"frame": {"cycles": of, "time_s": of / 1e4, "fps": 1e4 / of}}
        view |= {"image": {"psnr_db": 20.0 + 100 / s["storage.chunk"]}}
        return simulations.Outcome(run, views=(view,))

    cycles = staticmethod(cycles)

    def outcomes(self, runs):
        self.waits += any(run.scene != SMALL for run in runs)
        return [self.outcome(run) for run in runs]


def searched(
    formulas: Formulas,
    objectives: str,
    *required: str,
    views: int = 1,
    trials: int | None = None,
    space: Space = SPACE,
) -> Work:
    task = Task(
        views=tuple((scene, n) for scene in SCENES for n in range(views)),
        keys=(),
        size="",
        config="toy",
        base=(),
        objectives=(objective(objectives),),
        requirements=tuple(map(requirement, required)),
    )
    task = relative_to(task, formulas.outcomes)
    arguments = argparse.Namespace(trials=trials, minutes=0)
    work = Work(arguments, space, Judge(task, formulas.outcomes), Record(task, {}))
    with contextlib.redirect_stderr(io.StringIO()):
        Steps(work).search()
    return work


def stored(best: Judged) -> list[str]:
    return [s.partition("=")[2] for s in best.assignments if "@" in s]


def machines() -> list[dict]:
    """All there can be."""
    values = itertools.product((1, 2, 4, 8), (4, 8, 16, 32), (1, 2, 4), (64, 128, 256))
    names = [a.name for a in AXES]
    return [dict(zip(names, of)) for of in values if of[:2] != (4, 32)]


class Within(unittest.TestCase):
    """The machine that does best in an area."""

    def found(self, budget_mm2: float, *required: str, formulas=None, **how) -> Judged | None:
        required = (f"mm2 <= {budget_mm2}", *required)
        work = searched(formulas or Formulas(), "geomean(cycles)", *required, **how)
        return next(iter(work.made.front()), None)

    @staticmethod
    def best(budget_mm2: float) -> float:
        """Of all machines, each scene stored as suits it."""
        return min(
            (
                cycles("a", 0, {**s, "storage.chunk": 16})
                * cycles("b", 0, {**s, "storage.chunk": 32})
            )
            ** 0.5
            for s in machines()
            if area(s) <= budget_mm2
        )

    def test_finds_about_the_best_that_fits(self):
        for budget in (2, 3, 4, 6, 12):
            with self.subTest(budget):
                best = self.found(budget)
                self.assertTrue(best.holds())
                self.assertLess(best.costs[0] / self.best(budget), 1.1)
                self.assertEqual(stored(best), ["16", "32"])

    def test_what_it_finds_holds_on_all_views(self):
        """It looks at one view of each scene, and draws the best few on all."""
        formulas = Formulas()
        best = self.found(6, formulas=formulas, views=3)
        self.assertEqual(best.drawn, 6)
        others = {overrides for _, view, overrides in formulas.drawn if view != "0"}
        self.assertLessEqual(len(others), 2 * 3)

    def test_the_storage_that_keeps_the_picture(self):
        # Chunks of 16 at most for both; chunks of 4 there are none.
        for least_db, chunks in ((26, ["16", "16"]), (30, ["8", "8"]), (40, None)):
            with self.subTest(least_db):
                best = self.found(6, f"each(psnr_db) >= {least_db}")
                self.assertEqual(best and stored(best), chunks)

    def test_the_picture_of_another_configuration(self):
        """The preset has chunks of 16."""
        best = self.found(6, "each(psnr_db) >= 1 x toy - 0.1")
        self.assertEqual(stored(best), ["16", "16"])
        best = self.found(6, "each(psnr_db) >= 1 x toy - 4")
        self.assertEqual(stored(best), ["16", "32"])

    def test_storage_one_beyond_a_worse_one(self):
        class Bumpy(Formulas):
            @staticmethod
            def cycles(scene, view, s):
                return {8: 50, 16: 100, 32: 80}[s["storage.chunk"]]

        PRESET["storage.chunk"] = 32
        self.addCleanup(PRESET.update, {"storage.chunk": 16})
        self.assertEqual(stored(self.found(12, formulas=Bumpy())), ["8", "8"])

    def test_ends_when_it_has_had_its_trials(self):
        for trials, ended in ((15, BY_TRIALS), (None, "")):
            formulas = Formulas()
            work = searched(formulas, "geomean(cycles)", "mm2 <= 4", trials=trials)
            with self.subTest(trials):
                self.assertEqual(work.made.ended, ended)
                self.assertLessEqual(len(set(formulas.drawn)), 2 * (trials or 1000))

    def test_ends_when_time_is_over(self):
        arguments = argparse.Namespace(trials=None, minutes=1)
        made = Record(Task((), (), "", "", (), (objective("mm2"),), ()), {})
        for gone, ended in ((59, ""), (61, BY_TIME)):
            work = Work(arguments, SPACE, None, made, began=time.monotonic() - gone)
            self.assertEqual(work.may_look(5, math.inf), not ended)
            self.assertEqual(made.ended, ended)
        self.assertIn(ENDS[BY_TIME], made.about())

    def test_growing_until_what_frames_tell_holds(self):
        before = dict(PRESET)
        self.addCleanup(PRESET.update, before)
        PRESET.update({"hfus": 1, "hfu.lanes": 4, "rendering.clusters": 1, "merge.entries": 64})
        for required in ("min(fps) >= 40", "each(cycles) <= 250"):
            with self.subTest(required):
                best = self.found(6, required, views=2)
                self.assertTrue(best.holds())
        self.assertIsNone(self.found(6, "each(cycles) <= 1", views=2))

    def test_a_start_that_cannot_be(self):
        before = dict(PRESET)
        self.addCleanup(PRESET.update, before)
        PRESET.update({"hfus": 5, "hfu.lanes": 32})  # nearest to it are 4
        work = searched(Formulas(), "geomean(cycles)", "mm2 <= 6")
        self.assertEqual(work.made.told(), [])
        self.assertRegex(work.made.not_told()[0], "^Refused: a toy .*: cannot be$")

    @staticmethod
    def searched_for(formulas: Formulas) -> list[float]:
        """Areas of what was drawn, but for the preset, which tells how scenes are stored."""
        return [area(settings_of(overrides)) for *_, overrides in formulas.drawn if overrides]

    def test_nothing_fits(self):
        formulas = Formulas()
        work = searched(formulas, "geomean(cycles)", "mm2 <= 0.5")
        self.assertEqual((work.made.front(), self.searched_for(formulas)), ([], []))
        self.assertRegex(work.made.about(), r"None of 1 holds: 1 too large \(mm2 <= 0.5\)")
        self.assertIn("No steps back from the start lead to mm2 <= 0.5.", work.made.about())

    def test_what_is_too_large_is_not_drawn(self):
        for required in ((), ("min(fps) >= 40",), ("min(fps) >= 1e9",)):
            formulas = Formulas()
            self.found(4, *required, formulas=formulas)
            with self.subTest(required):
                self.assertLessEqual(max(self.searched_for(formulas)), 4)


class Smallest(unittest.TestCase):
    """The smallest machine that holds what is required."""

    SPACE = Space(AXES)

    @staticmethod
    def best(fps: float, views: int) -> float:
        of = [(scene, view) for scene in WORK for view in range(views)]
        return min(
            area(s)
            for s in machines()
            if all(1e4 / cycles(*which, {**PRESET, **s}) >= fps for which in of)
        )

    def found(self, *required: str, formulas=None, **how) -> Work:
        return searched(formulas or Formulas(), "mm2", *required, space=self.SPACE, **how)

    def test_finds_about_the_smallest(self):
        for fps, views in ((30, 1), (50, 1), (60, 1), (30, 2), (40, 2)):
            with self.subTest(fps, views=views):
                (best,) = self.found(f"min(fps) >= {fps}", views=views).made.front()
                self.assertTrue(best.holds())
                self.assertLess(best.costs[0] / self.best(fps, views), 1.1)

    def test_one_hard_view_is_drawn_and_in_the_end_all(self):
        formulas = Formulas()
        work = self.found("min(fps) >= 30", formulas=formulas, views=2)
        (best,) = work.made.front()
        self.assertEqual(best.drawn, 4)
        self.assertLess(len(formulas.drawn), 2 * len(set(formulas.drawn)))
        easy = [of for of in formulas.drawn if of[:2] == ("a", "0")]
        self.assertLessEqual(len(easy), 3)
        self.assertLess(formulas.waits, 0.6 * len(formulas.drawn))

    def test_growing_until_it_is_fast_enough(self):
        """Its binding names lanes, which are all there are from the start on."""
        small = {"hfus": 1, "hfu.lanes": 32, "rendering.clusters": 1, "merge.entries": 64}
        before = dict(PRESET)
        self.addCleanup(PRESET.update, before)
        PRESET.update(small)
        (best,) = self.found("min(fps) >= 60").made.front()
        self.assertLess(1e4 / cycles("b", 0, PRESET), 60)
        self.assertGreaterEqual(best.values[0], 60)
        (best,) = self.found("min(fps) >= 60", trials=7).made.front()
        self.assertGreaterEqual(best.values[0], 60)
        work = self.found("min(fps) >= 1e9")
        self.assertEqual(work.made.front(), [])
        self.assertRegex(work.made.about(), "None of 13 holds: 13 too slow .*misses min.* by 100")
        self.assertIn("One step on any axis gains less than 0.3% of what is", work.made.about())

    def test_only_on_the_way_down_a_machine_that_is_too_large_is_drawn(self):
        """From a start that holds the rate; from another one nothing but the start."""
        (best,) = self.found("min(fps) >= 30", "mm2 <= 6").made.front()
        self.assertLessEqual(best.costs[0], 6)
        formulas = Formulas()
        self.found("min(fps) >= 1e9", "mm2 <= 6", formulas=formulas)
        drawn = [area(settings_of(overrides)) for *_, overrides in formulas.drawn]
        self.assertEqual({size for size in drawn if size > 6}, {area(PRESET)})
        self.assertTrue(any(size <= 6 for size in drawn))

    def test_what_no_view_tells_alone(self):
        best, *_ = self.found("mean(cycles) <= 200").made.front()
        self.assertLessEqual(best.values[0], 200)

    def test_with_nothing_required_nothing_is_left_to_take_away(self):
        (best,) = self.found().made.front()
        self.assertEqual(best.costs[0], min(map(area, machines())))

    def test_ends_when_it_has_had_its_trials(self):
        """With the smallest that it has seen to hold."""
        formulas = Formulas()
        (best,) = self.found("min(fps) >= 30", formulas=formulas, trials=6).made.front()
        self.assertLess(best.costs[0], area(PRESET))
        self.assertLessEqual(len({overrides for *_, overrides in formulas.drawn}), 6)

    def test_what_it_has_found_when_it_has_had_its_trials_holds_on_all_views(self):
        for trials in (1, 2, 3, 5, 8, 13):
            formulas = Formulas()
            work = self.found("min(fps) >= 40", formulas=formulas, views=2, trials=trials)
            with self.subTest(trials):
                best = work.made.best()
                self.assertEqual((best.holds(), best.drawn), (True, 4))
                self.assertLessEqual(len({o for *_, o in formulas.drawn}), trials)


class Starting(unittest.TestCase):
    def test_the_setting_nearest_to_a_preset(self):
        config = {"hfus": 3, "hfu": {"lanes": 16}}
        config |= {"rendering": {"clusters": 9}, "merge": {"entries": 128}}
        self.assertEqual([nearest(a, config) for a in AXES], [2, 2, 2, 1])


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class Recipes(InFolder):
    """On few settings each finds the best of the grid of all of them, and draws fewer."""

    SCENES = ("builtin:object?n=300", "builtin:outdoor?n=300")

    def front(self, out: str, *words: str, objective="mm2") -> tuple[dict[str, str], int]:
        """The best on the front, and how many simulations it took."""
        status, line, _ = self.ended(
            explore,
            *(*self.SCENES, "--streaminggs", COMMAND, "--out", str(self.folder / out)),
            *("-j", "2", "--size", "64x36", *words),
        )
        self.assertEqual(status, 0, line)
        rows = csv.DictReader((self.folder / out / "explore.csv").read_text().splitlines())
        drawn = (self.folder / out / "explore_runs.jsonl").read_text()
        best = min((row for row in rows if row["front"]), key=lambda row: float(row[objective]))
        return best, drawn.count('"size":"64x36"')

    def check(self, name: str, view: str, required: list[str], *free: str):
        told = json.loads((options.RECIPES / f"{name}.json").read_text())
        order = ORDERS[told["machine"]]
        run = simulations.Run(SMALL, config=order.preset)
        config = simulations.read_config(pathlib.Path(COMMAND), run)
        words = [f"--require={text}" for text in required or told["require"]]
        words += [f"--axis={text}" for text in free]
        chosen = {key for text in free for a in parse_axis(text) for key in keys_of(a)}
        keys = {key for a in order.axes for key in keys_of(a)} - chosen
        words += [f"--axis={key}={simulations.value_at(config, key)}" for key in sorted(keys)]
        words += [f"--stereo={told['stereo']}"] if "stereo" in told else []
        of = {"objective": told["objectives"]}
        found, drawn = self.front("found", f"--recipe={name}", "--view", view, *words, **of)
        words += [f"--machine={order.name}", f"--objectives={told['objectives']}"]
        best, of_all = self.front("grid", "--view", view, *words, **of)
        shown = [told["objectives"], *chosen & found.keys()]
        self.assertEqual([found[key] for key in shown], [best[key] for key in shown])
        self.assertLess(drawn, of_all)

    FREE = ("rendering.clusters=1,2,4", "hfus=2,4", "hfu.ffu_lanes=8,16")

    def test_the_smallest(self):
        fast = ["min(fps) >= 0.7 x exact"]
        self.check("smallest", "0,1", fast, *self.FREE)

    def test_the_best_in_an_area(self):
        self.check("exact_in_area", "0", [], *self.FREE, "storage.chunk_gaussians@each=8,16")

    def test_the_smallest_for_two_eyes(self):
        fast = ["min(fps) >= 0.7 x exact"]
        free = ("rendering.clusters=1,2,4", "hfus=2,4", "dram.channels=2,4")
        self.check("headset", "0", fast, *free)

    @nightly
    def test_the_smallest_tile_centric_one_for_two_eyes(self):
        fast = ["min(fps) >= 0.7 x gscore_lossless_boxes"]
        self.check("headset_gscore", "0", fast, "ccus=2,4", "cores=2,4", "dram.channels=2,4")

    @nightly
    def test_the_best_of_paper_order_in_an_area(self):
        self.check("paper_in_area", "0", [], *self.FREE, "storage.voxel_size@each=1,2")

    @nightly
    def test_the_best_tile_centric_one_in_an_area(self):
        free = ("ccus=2,4", "cores=3,4", "ccu.convert_lanes=12,18")
        self.check("gscore_in_area", "0", [], *free, "storage.chunk_gaussians@each=8,16")

    def test_what_is_no_recipe(self):
        path = self.folder / "mine.json"
        of_it = "--recipe .*mine.json: "
        for text, said in (
            (None, "--recipe: got .*mine.json, expected a JSON file or one of exact_in_area, "),
            ("[]", "--recipe: .*mine.json: expected options by name"),
            ('{"axis": [2]}', "--recipe: .*mine.json: axis: got 2, expected a text or a list of"),
            ('{"nosuch": "5"}', f"{of_it}unrecognized arguments: --nosuch=5"),
            ('{"search": "5"}', f"{of_it}--search: invalid choice: '5'"),
            ('{"size": "5"}', f"{of_it}--size: got 5, expected WIDTHxHEIGHT"),
            ('{"minutes": "1e99", "search": "steps"}', f"{of_it}--minutes: got 1e\\+99, expected"),
            ('{"stereo": "ipd=1"}', "--stereo: got nothing, expected ipd=DISTANCE"),
        ):
            eyes = ("--stereo", "") if text and "stereo" in text else ()
            with self.subTest(text):
                if text:
                    path.write_text(text)
                words = ["explore.py", str(self.scene), "--recipe", str(path), *eyes]
                words += ["--axis=hfus=1,2", "--out", str(self.folder / "out")]
                err = io.StringIO()
                with mock.patch("sys.argv", words), contextlib.redirect_stderr(err):
                    with contextlib.suppress(SystemExit):
                        self.assertEqual(explore.main(), 2)
                self.assertRegex(err.getvalue(), rf"\Aexplore.py: {said}.*\n\Z")
                self.assertFalse((self.folder / "out").exists())

    def test_the_command_line_counts(self):
        path = self.folder / "mine.json"
        path.write_text(json.dumps({"axis": ["hfus=2,4"], "require": ["mm2 <= 9"], "view": "0,1"}))
        words = ("--recipe", str(path), "--require", "mm2 <= 8", "--objectives", "mm2")
        found, _ = self.front("found", *words)
        self.assertEqual(
            (found["hfus"], "mm2 <= 8" in found, "mm2 <= 9" in found), ("2", True, False)
        )


class SoFar(unittest.TestCase):
    """What progress says of a search that looks at some views first."""

    def test_what_holds_so_far_is_said_before_what_is_missed(self):
        task = Task(
            tuple((scene, view) for scene in SCENES for view in (0, 1)),
            ("hfus",),
            *("", "", ()),
            (objective("mm2"),),
            (requirement("min(fps) >= 90"),),
        )
        record = Record(task, {})

        def add(hfus: int, mm2: float, violation: float, drawn: int) -> None:
            dropped = "" if drawn == 4 else f"{drawn} of 4 views were looked at"
            told = {"values": (90.0,), "settings": {"hfus": hfus}, "dropped": dropped}
            record.add(
                Judged((f"hfus={hfus}",), (mm2,), **told, violations=(violation,), drawn=drawn)
            )

        add(1, 1.5, 0.1, 1)
        said = "1 too slow (min(fps) >= 90)"
        miss = "the nearest misses min(fps) >= 90 by 10.0% or more, not judged on all views"
        self.assertEqual(record.so_far(), f"none of 1 holds yet: {said}; {miss}")
        add(2, 2.25, -0.1, 1)
        add(4, 2.5, -0.1, 3)
        self.assertEqual(
            record.so_far(),
            "holds so far on 3 of 4 views: mm2 2.5, hfus=4; "
            f"of 3 {said}, 2 not judged on all views",
        )
        add(4, 2.5, -0.1, 4)
        self.assertEqual(
            record.so_far(), "1 holds, 1 not judged on all views; 1 on the front, mm2 2.5"
        )
        about = (
            "3 configurations, of which 1 holds min(fps) >= 90; 1 of them no other one beats.\n\n"
        )
        self.assertEqual(
            record.about(), about + "Not judged on all views, though none is missed so far: 1."
        )


class Fronts(unittest.TestCase):
    def judged(self, *of: tuple[float, float]) -> list[Judged]:
        """Of cycles and the picture's dB."""
        return [
            Judged((f"hfus={n}",), (cycles,), psnr_db=psnr_db, drawn=1)
            for n, (cycles, psnr_db) in enumerate(of)
        ]

    def record(self, *of: tuple[float, float]) -> Record:
        record = Record(Task((), (), "", "", (), (objective("cycles"),), ()), {})
        for judged in self.judged(*of):
            record.add(judged)
        return record

    def test_the_picture_decides_where_pictures_differ(self):
        inf, nan = math.inf, math.nan
        for of, front, shown in (
            (((9, 30.0), (8, 30.04), (7, 30.01)), [7], False),
            (((9, 40.0), (8, 30.0), (7, 35.0)), [7, 9], True),
            (((9, inf), (8, 60.0), (7, 59.95)), [7, 8, 9], True),
            (((9, inf), (8, inf)), [8], False),
            (((9, nan), (8, nan)), [8], False),
            (((9, nan), (8, 30.0), (7, 20.0)), [7, 8], True),
        ):
            record = self.record(*of)
            with self.subTest(of):
                self.assertEqual([judged.costs[0] for judged in record.front()], front)
                self.assertEqual(record.shows_pictures(), shown)
                # The best for one objective is that for the objective.
                self.assertEqual(record.best().costs[0], min(cycles for cycles, _ in of))

    def test_of_points_that_are_alike_the_fastest_is_on_the_front(self):
        points = [
            ("exact", 30.0, bus, cycles, 1.0, 5.0, "")
            for cycles, bus in ((1010, 900), (1005, 900), (2000, 300), (2000, 1000))
        ]
        self.assertEqual(found.near_front(points), [False, True, True, False])


if __name__ == "__main__":
    unittest.main()
