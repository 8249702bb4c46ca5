"""streaminggs.py: the command from Python."""

import importlib.util
import math
import pathlib
import subprocess
import sys
import unittest
from unittest import mock

from in_folder import COMMAND, InFolder  # isort: skip (finds the scripts)
import streaminggs


class Reports(unittest.TestCase):
    def test_leaves_and_numbers(self):
        view = {"frame": {"cycles": 7, "drained": True}, "left_out": [{"what": "a", "count": 2}]}
        self.assertEqual(
            dict(streaminggs.leaves(view)),
            {
                "frame.cycles": 7,
                "frame.drained": True,
                "left_out.0.what": "a",
                "left_out.0.count": 2,
            },
        )
        self.assertEqual(streaminggs.numbers(view), {"frame.cycles": 7, "left_out.0.count": 2})

    def test_differences_by_size(self):
        before = {"a": 10, "b": 0, "c": "x", "same": 1, "host": {"wall_s": 1}, "gone": 5}
        after = {"a": 11, "b": 1, "c": "y", "same": 1, "host": {"wall_s": 2}, "d": 100}
        found = streaminggs.diff(before, after)
        self.assertEqual({path for path, *_ in found[:-1]}, {"b", "c", "gone", "d"})
        self.assertEqual(found[-1], ("a", 10, 11, 0.1))
        self.assertIn(("gone", 5, None, float("inf")), found)
        self.assertEqual(streaminggs.diff(before, before), [])

    def test_an_empty_folder_is_refused(self):
        here = pathlib.Path(__file__).parent
        for folder, said in ((here, "no report.json"), ("nope", "nope: no folder")):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                streaminggs.load(folder)


    def test_one_is_no_list(self):
        for points, scenes, said in (
            ([{"hfus": 2}], "builtin:object", "scenes: got 'builtin:object', expected a list"),
            ([{"hfus": 2}], pathlib.Path("a.ply"), "scenes: got .*a.ply.*, expected a list"),
            ({"hfus": 2}, ["builtin:object"], "points: got {'hfus': 2}, expected a list"),
            ("hfus=2", ["builtin:object"], "points: got 'hfus=2', expected a list"),
        ):
            with self.subTest(said), self.assertRaisesRegex(ValueError, f"^{said}$"):
                streaminggs.sweep(points, scenes)
        for given, said in (({"stereo": 0.064}, "stereo: got 0.064"), ({"size": 64}, "size: got 64")):
            with self.subTest(said):
                with self.assertRaisesRegex(ValueError, f"^{said}, expected a text$"):
                    streaminggs.run("builtin:object", **given)
                with self.assertRaisesRegex(ValueError, f"^{said}, expected a text$"):
                    streaminggs.sweep([], ["builtin:object"], **given)
        with self.assertRaisesRegex(ValueError, "^more: got 'config', expected a list$"):
            streaminggs.table([], more="config")
        with self.assertRaisesRegex(ValueError, "^hfus: got '24', expected a list$"):
            streaminggs.grid({"hfus": "24"})

    def test_without_pandas_a_line_says_what_has_it(self):
        said = "^pandas: not there; apt-get install python3-pandas$"
        with mock.patch.dict(sys.modules, {"pandas": None}):
            with self.assertRaisesRegex(ValueError, said):
                streaminggs.table([{"frame": {"cycles": 7}}])


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class Running(InFolder):
    def run_one(self, **more):
        return streaminggs.run(str(self.scene), size="64x36", program=COMMAND, **more)

    def test_what_it_runs_it_loads(self):
        settings = {"hfus": 2, "rendering.ellipse_test": False}
        views = self.run_one(settings=settings, out=self.folder / "out")
        self.assertEqual(views, streaminggs.load(self.folder / "out"))
        self.assertEqual(views[0]["config"]["hfus"], 2)
        self.assertIs(views[0]["config"]["rendering"]["ellipse_test"], False)
        self.assertTrue((self.folder / "out" / "view_0" / "frame.png").exists())
        (again,) = self.run_one(settings=settings)
        self.assertEqual(streaminggs.diff(views[0], again), [])
        (other,) = self.run_one(settings=settings | {"hfus": 4})
        self.assertIn(("config.hfus", 2, 4, 1.0), streaminggs.diff(again, other))

    def test_memories_are_fitted(self):
        for config, settings in (
            ("exact", {"hfus": 8}),
            ("paper_no_vq", {"hfus": 8}),
            ("gscore", {"cores": 2}),
        ):
            with self.subTest(config):
                given = {"config": config, "settings": settings, "fit_memories": True}
                (view,) = self.run_one(**given)
                memories = [key for key in view["config"]["sram"] if key != "codebook_bytes"]
                for memory in memories:
                    needed = view["sram"][memory]
                    self.assertGreater(needed, 0)
                    self.assertEqual(view["config"]["sram"][memory], needed)
                    available = memory.replace("_bytes", "_available_bytes")
                    self.assertEqual(view["sram"][available], needed)
                (row,) = self.sweep(
                    [settings], config=config, fit_memories=True, more=["sram"]
                )
                self.assertEqual(row["sram." + memories[0]], view["sram"][memories[0]])
        with self.assertRaisesRegex(ValueError, "sram.shared_bytes=9: got it with --fit-memories"):
            self.run_one(settings={"sram.shared_bytes": 9}, fit_memories=True)

    def test_cameras_may_lie_elsewhere(self):
        cameras = self.scene.with_suffix(".json").rename(self.folder / "elsewhere.json")
        (view,) = self.run_one(cameras=str(cameras), config="paper")
        self.assertEqual(view["scene"]["name"], "truck")

    def test_what_the_command_refuses(self):
        for more, said in (
            ({"settings": {"nope": 1}}, "nope: unknown key"),
            ({"view": 9}, "--view: got '9'"),
            ({"config": "nope"}, "nope"),
        ):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                self.run_one(**more)

    def sweep(self, points, **more):
        more = {"size": "64x36", "program": COMMAND, "jobs": 2, **more}
        with mock.patch.object(streaminggs, "frame", list):
            return streaminggs.sweep(points, [self.scene], **more)

    def test_a_sweep_is_as_single_runs(self):
        axes = {"hfus": [2, 4], "rendering.ellipse_test": [True, False]}
        points = streaminggs.grid(axes)
        results, config = self.folder / "sweep.jsonl", self.folder / "mine.json"
        config.write_text('{"machine": "exact"}')
        more = {"fit_memories": True, "config": config, "stereo": "ipd=0.1"}
        rows = self.sweep(points, results=results, **more)
        for point, row in zip(points, rows, strict=True):
            (view,) = self.run_one(settings=point, **more)
            self.assertEqual(view["camera"]["eyes_apart"], 0.1)
            told = streaminggs.numbers(view)
            for path in ("frame.cycles", "dram.bytes", "area_mm2.total", "energy.total_j"):
                self.assertEqual(row[path], told[path])
            self.assertEqual(row["binding.holds"], view["binding"]["holds"])
            self.assertEqual({key: row[key] for key in axes}, point)
            self.assertEqual((row["scene"], row["view"], row["status"]), ("truck", 0, "done"))
        # What the file holds is not simulated again.
        kept = results.read_text()
        again = self.sweep(points, results=results, **more)
        self.assertEqual((again, results.read_text()), (rows, kept))

    def test_scenes_and_cameras_of_other_forms(self):
        """A packed scene on all views of a data set."""
        packed, photographs = self.folder / "packed.sgs", self.write_dataset()
        words = ["pack", str(self.scene), "--out", str(packed)]
        words += ["--cameras", str(self.scene.with_suffix(".json"))]
        subprocess.run([COMMAND, *words], check=True, capture_output=True)
        rows = streaminggs.sweep(
            [{}], [packed], "all", cameras=photographs, size="64x48", program=COMMAND
        )
        rows = rows if isinstance(rows, list) else rows.to_dict("records")
        self.assertEqual([row["view"] for row in rows], list(range(9)))
        self.assertEqual({(row["scene"], row["status"]) for row in rows}, {("packed", "done")})

    def test_what_a_sweep_is_refused(self):
        for point, more, other, said in (
            ({"hfus": 2}, {"views": 9}, "refused", "view"),
            ({"hfus": 2}, {"config": "nope"}, "refused", "nope"),
            ({"nope": 1}, {}, "done", "nope: unknown key"),
        ):
            with self.subTest(said):
                good, bad = self.sweep([{"hfus": 4}, point], **more)
                self.assertEqual((good["status"], bad["status"]), (other, "refused"))
                self.assertIn(said, bad["reason"])
        for more, said in (
            ({"views": "x"}, "--view: 'x', expected numbers"),
            ({"views": "0,0"}, "--view: '0,0', expected each number once"),
            ({"jobs": 0}, "jobs: 0, expected at least 1"),
        ):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                self.sweep([{"hfus": 2}], **more)

    def test_columns_are_the_same_whatever_was_simulated(self):
        """Words among them, and none that no report has."""
        columns = [path for of in streaminggs.COLUMNS.values() for path in of]
        filled = set()
        for config in ("exact", "paper", "gscore"):
            (row,) = self.sweep([{}], config=config)
            self.assertEqual(list(row), ["scene", "view", "status", "reason", *columns])
            self.assertEqual(row["config.machine"], config)
            self.assertEqual(row["config.dram.memspec"], "lpddr3_1600_4gb")
            self.assertIn("dram", row["binding.explanation"])
            filled |= {path for path in columns if row[path] not in (None, "")}
        self.assertEqual(set(columns) - filled, set())
        (row,) = self.sweep([{}], more=["config.hfu", "units.merge"])
        self.assertLess(len(columns) + 40, len(row))
        self.assertEqual(row["config.hfu.cfus"], 1)
        self.assertNotIn("config.hfus", row)

    def test_an_equal_picture_has_infinite_psnr(self):
        (row,) = self.sweep([{}], settings={"framebuffer": "rgb32f"})
        self.assertEqual(row["image.psnr_db"], math.inf)

    @unittest.skipUnless(importlib.util.find_spec("pandas"), "pandas is not installed")
    def test_a_data_frame(self):
        table = streaminggs.table(self.run_one())
        self.assertEqual(table["frame.width_px"].tolist(), [64])
        rows = streaminggs.sweep([{"hfus": 2}], [str(self.scene)], size="64x36", program=COMMAND)
        self.assertEqual(rows["frame.width_px"].tolist(), [64])


if __name__ == "__main__":
    unittest.main()
