"""The search for machines: on a machine made up of formulas, and what it keeps of simulations."""

import dataclasses
import itertools
import pathlib
import tempfile
import unittest

from in_folder import InFolder  # isort: skip (finds the scripts)
import fair_fight_tables
import machine_axes
from runs import simulations
from runs.kept_runs import KeptRuns
from machine_areas import SMALL, Areas
from machine_descent import Descent, TooSlow
from machine_search import Point, Search
from runs.scenes import Scene

AXES = (
    machine_axes.axis("hfus", 1, 2, 4, 8),
    machine_axes.axis("hfu.lanes", 4, 8, 16, 32),
    machine_axes.axis("rendering.clusters", 1, 2, 4),
    machine_axes.axis("merge.entries", 64, 128, 256),
)
ORDER = machine_axes.Order("toy", "toy", (), AXES, machine_axes.axis("storage.chunk", 8, 16, 32))
# Work of two scenes for lanes and for clusters; the chunk that suits each.
WORK = {"a": (900, 100, 16), "b": (100, 400, 32)}


def settings(run: simulations.Run) -> dict[str, float]:
    pairs = (override.partition("=") for override in run.overrides)
    return {key: float(value) for key, _, value in pairs}


def area(s: dict) -> float:
    return s["hfus"] * s["hfu.lanes"] * 0.02 + s["rendering.clusters"] + s["merge.entries"] / 256


def cycles(scene: str, s: dict) -> float:
    lanes, clusters, chunk = WORK[scene]
    filters = lanes / (s["hfus"] * s["hfu.lanes"])
    spills = 20 * 64 / s["merge.entries"]
    return filters + clusters / s["rendering.clusters"] + spills + abs(s["storage.chunk"] - chunk)


class Formulas:
    """In the place of KeptRuns. 4 HFUs of 32 lanes cannot be."""

    def __init__(self):
        self.drawn = []

    def outcome(self, run):
        s = settings(run)
        if s["hfus"] == 4 and s["hfu.lanes"] == 32:
            return simulations.Outcome(run, refused="cannot be")
        view = {"area_mm2": {"total": area(s)}, "binding": {"key": "hfu.lanes"}}
        if run.scene != SMALL:
            self.drawn.append((run.scene.name, run.overrides))
            of = cycles(run.scene.name, s)
            view |= {"view": 0, "frame": {"cycles": of, "fps": 1e4 / of}}
            view["image"] = {"psnr_db": 20.0 + 100 / s["storage.chunk"]}
        return simulations.Outcome(run, views=(view,))

    def outcomes(self, runs):
        return [self.outcome(run) for run in runs]


class Searching(unittest.TestCase):
    SCENES = (Scene("a", ""), Scene("b", ""))

    def found(self, budget_mm2: float, most_runs: int):
        formulas = Formulas()
        search = Search(Areas(formulas), self.SCENES, "", budget_mm2, "cycles", most_runs)
        largest = machine_axes.Machine(ORDER, (3, 3, 2, 2))
        return search.best_from(largest, (1, 1)), formulas

    @staticmethod
    def best(budget_mm2: float) -> float:
        """Of all machines: the smallest product of cycles, each scene stored as suits it."""
        products = []
        for values in itertools.product((1, 2, 4, 8), (4, 8, 16, 32), (1, 2, 4), (64, 128, 256)):
            s = dict(zip(("hfus", "hfu.lanes", "rendering.clusters", "merge.entries"), values))
            if area(s) <= budget_mm2 and values[:2] != (4, 32):
                of = [cycles(n, {**s, "storage.chunk": WORK[n][2]}) for n in WORK]
                products.append(of[0] * of[1])
        return min(products)

    def test_finds_about_the_best_that_fits(self):
        for budget in (2, 3, 4, 6, 12):
            with self.subTest(budget):
                point, _ = self.found(budget, 400)
                self.assertLessEqual(point.area_mm2(), budget)
                a, b = (view["frame"]["cycles"] for view in point.views)
                self.assertLess((a * b / self.best(budget)) ** 0.5, 1.1)
                stored = [point.stored(n) for n in (0, 1)]
                self.assertEqual(stored, ["storage.chunk=16", "storage.chunk=32"])

    def test_the_storage_that_keeps_the_picture(self):
        formulas, largest = Formulas(), machine_axes.Machine(ORDER, (3, 3, 2, 2))
        # Chunks of 16 at most for a; chunks of 8 for b, whatever it would do best with.
        for least_db, stored in (((26, 30), ["16", "8"]), ((26, 40), None)):
            search = Search(
                Areas(formulas), self.SCENES, "", 6, "cycles", 400, least_db=least_db
            )
            point = search.best_from(largest, (2, 2))
            found = point and [point.stored(n).partition("=")[2] for n in (0, 1)]
            self.assertEqual(found, stored)

    def test_storage_one_beyond_a_worse_one(self):
        class Bumpy(Formulas):
            def outcome(self, run):
                found = super().outcome(run)
                s = settings(run)
                if found.views and "frame" in found.views[0]:
                    by_chunk = {8: 50, 16: 100, 32: 80}[s["storage.chunk"]]
                    found.views[0]["frame"]["cycles"] = by_chunk
                return found

        search = Search(Areas(Bumpy()), self.SCENES, "", 12, "cycles", 400)
        machine = machine_axes.Machine(ORDER, (0, 0, 0, 0))
        point = search.best_from(machine, (2, 2))
        self.assertEqual(point.stored(0), "storage.chunk=8")

    def test_growing_until_it_is_fast_enough(self):
        """Its binding names lanes, which are all there are from the start on."""
        order = dataclasses.replace(ORDER, fixed=("storage.chunk=16",))
        small = machine_axes.Machine(order, (0, 3, 0, 0))
        descent = Descent(Formulas(), self.SCENES, "", 60)
        before = descent.draw_all(small, "0")[0].fps()
        grown, drawn = descent.grown(small, "0")
        self.assertLess(before, 60)
        self.assertGreaterEqual(drawn[0].fps(), 60)
        self.assertEqual(grown.at[1], 3)
        descent = Descent(Formulas(), self.SCENES, "", 1e9)
        with self.assertRaisesRegex(TooSlow, "^none: . has .* fps, and one step on any axis"):
            descent.grown(small, "0")

    def test_ends_when_it_has_had_its_runs(self):
        _, formulas = self.found(4, 30)
        self.assertLessEqual(len(formulas.drawn), 36)

    def test_nothing_fits(self):
        self.assertIsNone(self.found(0.5, 400)[0])

    def test_of_points_that_are_alike_the_fastest_is_on_the_front(self):
        def point(cycles, bus_bytes):
            view = {"frame": {"cycles": cycles}, "dram": {"bus_bytes": bus_bytes}}
            view |= {"energy": {"total_j": 1.0}, "area_mm2": {"total": 5.0}}
            view |= {"image": {"psnr_db": 30.0}}
            return Point(None, (), (), (view,))

        points = [point(1010, 900), point(1005, 900), point(2000, 300), point(2000, 1000)]
        self.assertEqual(fair_fight_tables.near_front(points), [False, True, True, False])

    def test_a_machine_as_a_configuration(self):
        view = {"config": {"sram": {"input_bytes": 7, "shared_bytes": 9}}}
        order = machine_axes.Order(
            "toy", "toy", ("x=0.5", "fetch=split"), (machine_axes.axis("hfu.lanes", 8),), None
        )
        with tempfile.TemporaryDirectory() as folder:
            presets = pathlib.Path(folder, "share", "streaminggs", "presets")
            presets.mkdir(parents=True)
            pathlib.Path(folder, "bin").mkdir()
            (presets / "toy.json").write_text('{"machine": "exact", "hfu": {"lanes": 2, "a": 1}}')
            document = fair_fight_tables.assigned_document(
                pathlib.Path(folder, "bin", "streaminggs"),
                machine_axes.Machine(order, (0,)),
                [view],
            )
        self.assertEqual(
            document,
            {
                "machine": "exact",
                "sram": {"input_bytes": 7, "shared_bytes": 9},
                "hfu": {"lanes": 8, "a": 1},
                "x": 0.5,
                "fetch": "split",
            },
        )

    def test_the_start_is_the_machine_nearest_to_a_preset(self):
        config = {"hfus": 3, "hfu": {"lanes": 16}}
        config |= {"rendering": {"clusters": 9}, "merge": {"entries": 128}}
        self.assertEqual(ORDER.start(config).at, (2, 2, 2, 1))


class Keeping(InFolder):
    BODY = """
        with (HERE / "calls").open("a") as file:
            print("call", file=file)
        if SET["hfus"] == "3":
            print("hfus: 3 is odd", file=sys.stderr)
            sys.exit(2)
        if SET["hfus"] == "5":
            print("the frame differs")
            sys.exit(1)
        finish()
        """

    def calls(self) -> int:
        return len((self.folder / "calls").read_text().splitlines())

    def run_all(self, body: str) -> list[simulations.Outcome]:
        kept = KeptRuns(self.stand_in(body), self.folder / "runs.jsonl", 1)
        runs = [
            simulations.Run(Scene("toy", "toy"), overrides=(f"hfus={n}",)) for n in (1, 2, 3, 5)
        ]
        outcomes = kept.outcomes(runs)
        with self.assertRaisesRegex(simulations.Failure, "the frame differs"):
            kept.end()
        return outcomes

    def test_what_was_simulated_is_not_simulated_again(self):
        first = self.run_all(self.BODY)
        self.assertEqual(self.calls(), 4)
        second = self.run_all(self.BODY)
        # What failed is not kept.
        self.assertEqual(self.calls(), 4 + 1)
        self.assertEqual([o.views for o in first], [o.views for o in second])
        self.assertEqual([v["frame"]["cycles"] for o in second for v in o.views], [8, 4])
        self.assertIn("3 is odd", second[2].refused)

    def test_a_line_that_was_not_finished_is_left_out(self):
        self.run_all(self.BODY)
        path = self.folder / "runs.jsonl"
        path.write_text(path.read_text()[:-20])
        self.run_all(self.BODY)
        self.assertEqual(self.calls(), 4 + 2)

    def test_another_program_begins_anew(self):
        self.run_all(self.BODY)
        self.run_all(self.BODY + "\n        # changed\n")
        self.assertEqual(self.calls(), 8)

    def test_whatever_a_run_reads_belongs_to_it(self):
        bin_folder, data = self.folder / "bin", self.folder / "share" / "streaminggs"
        for folder in (bin_folder, data, self.folder / "presets"):
            folder.mkdir(parents=True)
        # As in a build tree: the program's folder of data holds links to the sources.
        (data / "presets").symlink_to(self.folder / "presets")
        preset = self.folder / "presets" / "exact.json"
        cameras, config = self.scene.with_suffix(".json"), self.folder / "mine.json"
        in_config, overriding = self.folder / "a_memspec.json", self.folder / "b_memspec.json"
        config.write_text(f'{{"dram": {{"memspec": "{in_config}"}}}}')
        read = (data / "technology.json", preset, cameras, in_config, overriding)
        for path in read:
            path.write_text("{}")
        program = self.stand_in(self.BODY).rename(bin_folder / "streaminggs")
        calls = bin_folder / "calls"

        def made() -> int:
            """How many simulations there were, after another start of the script."""
            scene = Scene("truck", str(self.scene), str(cameras))
            overrides = (("hfus=1",), ("hfus=3",), ("hfus=1", f"dram.memspec={overriding}"))
            runs = [simulations.Run(scene, config=str(config), overrides=o) for o in overrides]
            KeptRuns(program, self.folder / "runs.jsonl", 1).outcomes(runs)
            return len(calls.read_text().splitlines())

        self.assertEqual(made(), 3)
        self.assertEqual(made(), 3)
        (self.folder / "presets" / "README.md").write_text("For readers.")
        self.assertEqual(made(), 3)
        so_far = 3
        for path, again in zip((*read, config, self.scene), (3, 3, 3, 3, 1, 3, 3)):
            with self.subTest(path.name):
                content = path.read_bytes()
                path.write_bytes(content[:-1] + b"!")  # as long as before
                so_far += again
                self.assertEqual(made(), so_far)
                path.write_bytes(content)
                self.assertEqual(made(), so_far)


if __name__ == "__main__":
    unittest.main()
