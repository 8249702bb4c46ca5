"""explore.py: its tables, what it leaves out, what it keeps. A program stands in for the
command."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import unittest

from in_folder import REPOSITORY, InFolder  # isort: skip (finds the scripts)
from exploring import measures
from runs import run_arguments


class Explorations(InFolder):
    # Another Python, which has Matplotlib, takes seconds to draw.
    ENVIRONMENT = {**os.environ, run_arguments.TRIED: "1"}

    def explore(self, body: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        program = self.stand_in(body)
        command = [sys.executable, "-B", str(REPOSITORY / "scripts" / "explore.py")]
        command += [str(self.scene), "--streaminggs", str(program), "--out", str(self.folder)]
        command += ["-j", "1", "--objectives", "cycles", *arguments]
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            env=self.ENVIRONMENT,
            # Whoever runs the tests in the background has SIGINT ignored.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def rows(self, name: str) -> list[list[str]]:
        return list(csv.reader((self.folder / name).read_text().splitlines()))


class Exploring(Explorations):
    HEAD = ["hfus", "group", "sum(cycles)", "slowest view", "binding", "holds", "front"]

    def test_tables_show_what_was_simulated(self):
        done = self.explore("finish()", "--axis", "hfus=2,4")
        self.assertEqual((done.returncode, done.stderr.count("Traceback")), (0, 0))
        rows = [
            ["2", "112x80", "4", "truck 0", "dram", "", ""],
            ["4", "112x80", "2", "truck 0", "dram", "", "yes"],
        ]
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, *rows])
        self.assertIn("2 configurations; 1 of them no other one beats.", done.stdout)

    def test_how_a_search_ended(self):
        words = ("--search", "steps", "--objectives", "mm2", "--require", "min(fps) >= 2")
        body = 'SET.setdefault("hfus", "8"); finish()'  # where it begins
        for more, judged, ended, said in (
            ((*words, "--trials", "1"), 1, "by trials", "Trials ended the search (--trials): a"),
            ((*words, "--minutes", "9"), 4, "by itself", "The search ended by itself."),
            ((), 4, "", ""),
        ):
            done = self.explore(body, "--axis", "hfus=1,2,4,8", *more)
            with self.subTest(more):
                self.assertEqual(done.returncode, 0, done.stderr)
                facts = json.loads((self.folder / "explore.json").read_text())
                self.assertEqual((facts["judged"], facts["ended"]), (judged, ended))
                self.assertIn(said, facts["about"])
                self.assertIn(said, done.stdout)

    def test_memory_is_as_large_as_needed_unless_it_is_said(self):
        body = """
            with (HERE / "sram").open("a") as file:
                memories = [f"{key}={SET[key]}" for key in SET if key.startswith("sram.")]
                print("--fit-memories" in sys.argv, *memories, file=file)
            finish()
            """
        self.explore(body, "--axis", "hfus=2")
        self.explore(body, "--axis", "hfus=2", "--set", "sram.shared_bytes=900")
        self.explore(body, "--axis", "hfus=2", "--axis", "sram.shared_bytes=700")
        sized = "sram.input_bytes=0 sram.shared_bytes="
        lines = ["True", f"False {sized}900", f"False {sized}700"]
        self.assertEqual((self.folder / "sram").read_text().splitlines(), lines)

    def test_a_refused_configuration_is_named_and_left_out(self):
        body = """
            if SET["hfus"] == "3":
                print("hfus: 3 is odd", file=sys.stderr)
                sys.exit(2)
            finish()
            """
        done = self.explore(body, "--axis", "hfus=2,3")
        self.assertEqual(done.returncode, 0)
        row = ["2", "112x80", "4", "truck 0", "dram", "", "yes"]
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, row])
        self.assertRegex(done.stdout, "Refused: truck .* hfus=3: hfus: 3 is odd")

    def test_what_was_simulated_is_kept(self):
        two = ["2", "112x80", "4", "truck 0", "dram", "", "yes"]
        eight = ["8", "112x80", "1", "truck 0", "dram", "", "yes"]
        for what, end, status, line, kept in (
            (
                "interrupted",
                "os.kill(SCRIPT, signal.SIGINT); time.sleep(1); sys.exit(1)",
                130,
                "interrupted$",
                [two],
            ),
            # Others go on where one failed.
            (
                "failed",
                "print('it differs'); sys.exit(1)",
                1,
                "truck .*: it differs$",
                [[*two[:-1], ""], eight],
            ),
        ):
            with self.subTest(what):
                (self.folder / "explore_runs.jsonl").unlink(missing_ok=True)
                body = f"""
                    if SET["hfus"] == "4":
                        {end}
                    finish()
                    """
                done = self.explore(body, "--axis", "hfus=2,4,8")
                self.assertEqual(done.returncode, status)
                self.assertNotIn("Traceback", done.stderr)
                self.assertRegex(done.stderr.splitlines()[-1], line)
                self.assertEqual(self.rows("explore_partial.csv"), [self.HEAD, *kept])
                facts = json.loads((self.folder / "explore_partial.json").read_text())
                self.assertTrue(facts["about"].startswith("Not complete: "))
                self.assertFalse((self.folder / "explore.csv").exists())

    def test_what_is_required(self):
        """A configuration that has lost is drawn on no further view, and stands on no front."""
        body = """
            if "64x36" not in sys.argv:
                (HERE / f"drawn {SET['hfus']} {sys.argv[sys.argv.index('--view') + 1]}").touch()
            finish()
            """
        cameras = self.scene.with_suffix(".json")
        cameras.write_text(json.dumps(2 * json.loads(cameras.read_text())))
        words = ("--axis", "hfus=1,2,4,8", "--require", "min(fps) >= 3", "--objectives", "mm2")
        done = self.explore(body, *words, "--view", "0,1", "--show", "cycles,area_mm2.total")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(
            [(row[0], *row[2:6], *row[-2:]) for row in self.rows("explore.csv")[1:]],
            [
                ("1", "2", "", "2", "1", "not all views drawn", ""),
                ("2", "3", "", "3", "2", "not all views drawn", ""),
                ("4", "5", "4", "5", "4", "yes", "yes"),
                ("8", "9", "2", "9", "8", "yes", ""),
            ],
        )
        columns = ["mm2", "sum(cycles)", "area_mm2.total", "min(fps) >= 3"]
        self.assertEqual(self.rows("explore.csv")[0][2:6], columns)
        self.assertIn("4 configurations, of which 2 hold min(fps) >= 3; 1 of them", done.stdout)
        band = "mm2 of the best: 4.00 to 6.00 by its sources; 10.00 (9.00 to 11.00) with PHY and"
        self.assertIn(band, done.stdout)
        drawn = sorted(path.name for path in self.folder.glob("drawn*"))
        both = [f"drawn {hfus} {view}" for hfus in (4, 8) for view in (0, 1)]
        # A view that none was drawn on comes first.
        self.assertEqual(drawn, ["drawn 1 0", "drawn 2 1", *both])

    def test_what_any_frame_shows_to_have_lost_is_not_drawn(self):
        body = """
            # Any frame is asked at its own size.
            if "64x36" not in sys.argv:
                (HERE / f"drawn {SET.get('hfus', 'exact')}").touch()
            finish()
            """
        words = ("--axis", "hfus=1,2,4", "--require", "mm2 <= 3", "--require", "min(fps) >= 1")
        words += ("--require", "each(mm2) >= 0.1 x exact", "--require", "config.hfus >= 1")
        done = self.explore(body, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        head, *rows = self.rows("explore.csv")
        columns = [
            head.index(name)
            for name in ("hfus", "sum(cycles)", "mm2 <= 3", "min(fps) >= 1", "holds")
        ]
        self.assertEqual(
            [[row[n] for n in columns] for row in rows],
            [
                ["1", "8", "2", "1", "yes"],
                ["2", "4", "3", "2", "yes"],
                ["4", "", "5", "", "not all views drawn"],
            ],
        )
        drawn = sorted(path.name for path in self.folder.glob("drawn*"))
        self.assertEqual(drawn, ["drawn 1", "drawn 2", "drawn exact"])

    def test_where_none_holds_the_nearest_is_named(self):
        done = self.explore("finish()", "--axis", "hfus=2,4", "--require", "min(fps) >= 5")
        why = "2 too slow (min(fps) >= 5); the nearest misses min(fps) >= 5 by 20.0%"
        self.assertRegex(
            done.stdout, rf"\n\nNone of 2 holds: {re.escape(why)}: hfus=4\.\n+written to .*\n\Z"
        )
        self.assertIn(f"[2/2] none of 2 holds yet: {why}", done.stderr)
        self.assertTrue(
            done.stderr.endswith(f"explore.py: none of 2 holds: {why}: hfus=4\n"), done.stderr
        )
        self.assertEqual(done.returncode, run_arguments.NONE_HOLDS)
        self.assertEqual([row[-2] for row in self.rows("explore.csv")[1:]], ["no", "no"])
        self.assertEqual(list(self.folder.glob("explore_best*")), [])
        done = self.explore(
            "finish()", "--axis", "hfus=2,4", "--require", "min(fps) >= 5", "--require", "mm2 <= 4"
        )
        self.assertIn("1 too slow (min(fps) >= 5), 1 too large (mm2 <= 4);", done.stdout)

    def test_the_best_as_a_configuration(self):
        """Memory is as large as any view needs; what is chosen for a scene is its own."""
        cameras = self.scene.with_suffix(".json")
        cameras.write_text(json.dumps(2 * json.loads(cameras.read_text())))
        done = self.explore("finish()", "--axis", "hfus=2,4", "--view", "0,1")
        path = self.folder / "explore_best.json"
        again = f"streaminggs simulate {self.scene} --config {path} --cameras {cameras} --view 0"
        self.assertTrue(
            done.stdout.endswith(f"\nwritten to {self.folder}\nbest: {path}: {again}\n"),
            done.stdout,
        )
        best = json.loads((self.folder / "explore_best.json").read_text())
        self.assertEqual((best["hfus"], best["sram"]["input_bytes"]), (4, 401))
        done = self.explore("finish()", "--axis", "hfus@each=2,4")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.rows("explore.csv")[0][0], "hfus@truck")
        best = json.loads((self.folder / "explore_best_truck.json").read_text())
        self.assertEqual((best["hfus"], (self.folder / "explore_best.json").exists()), (4, False))
        # Of several objectives there is no best, nor does an earlier one stay.
        self.explore("finish()", "--axis", "hfus=2,4", "--objectives", "cycles,mm2")
        self.assertEqual(list(self.folder.glob("explore_best*")), [])

    def test_watts_of_the_best_at_the_rate_that_is_required(self):
        body = """
            finish()
            path = pathlib.Path(sys.argv[sys.argv.index("--out") + 1]) / "report.json"
            report = json.loads(path.read_text())
            view = report["views"][0]
            view["energy"] = {"total_j": 1 / view["frame"]["cycles"], "memory_known": KNOWN}
            if "--frame-rate" in sys.argv:
                rate = float(sys.argv[sys.argv.index("--frame-rate") + 1])
                watts = {"power_w": band(2 * rate), "with_memory_interface_w": band(3 * rate)}
                view["fixed_rates"] = [{"held": True, **watts}]
            path.write_text(json.dumps(report))
            """
        told = "W of the best at 3 frames a second, truck 0: 6.000 (5.000 to 7.000); "
        told += "9.000 (8.000 to 10.000) with PHY and controller of the memory."
        words = ("--axis", "hfus=2,4", "--objectives", "mm2", "--require")
        for required, known, said in (
            ("min(fps) >= 3", True, True),
            ("min(fps) >= 3", False, False),
            ("mean(fps) >= 3", True, False),
        ):
            with self.subTest(required, known=known):
                done = self.explore(body.replace("KNOWN", str(known)), *words, required)
                self.assertEqual((done.returncode, told in done.stdout), (0, said), done.stderr)

    def test_frames_of_one_eye_and_of_two_are_kept_apart(self):
        body = """
            with (HERE / "count").open("a") as file:
                print(*sys.argv[sys.argv.index("--stereo"):][:2] if "--stereo" in sys.argv else "",
                      file=file)
            finish()
            """
        for eyes in ((), ("--stereo", "ipd=1"), ("--stereo", "ipd=2"), ("--stereo", "ipd=1"), ()):
            done = self.explore(body, "--axis", "hfus=2", "--require", "min(fps) >= 1", *eyes)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(" ".join(eyes), done.stdout.splitlines()[-1])
            path = f"--path {self.scene.with_suffix('.json')} --frames 8 --stream --frame-rate 1\n"
            self.assertEqual(path in done.stdout, bool(eyes))
        drawn = (self.folder / "count").read_text()
        self.assertEqual(drawn, "\n--stereo ipd=1\n--stereo ipd=2\n")

    def test_what_is_beside_has_its_name(self):
        for text, name in (
            ("by hand: hfus=8", "by hand"),
            ("hfus=8", "beside 1"),
            ("all: hfus=8 group=32x16", "all"),
        ):
            with self.subTest(text):
                done = self.explore("finish()", "--axis", "hfus=2,4", "--beside", text)
                self.assertEqual(done.returncode, 0, done.stderr)
                head, *rows = self.rows("explore.csv")
                named = {row[0]: row[head.index("beside")] for row in rows}
                self.assertEqual(named, {"8": name, "2": "", "4": ""})
        for text in ("hfus", "by hand: hfus"):
            with self.subTest(text):
                done = self.explore("finish()", "--axis", "hfus=2,4", "--beside", text)
                self.assertEqual(done.returncode, 2)
                self.assertRegex(done.stderr, "^.*explore.py: --beside: .*, expected KEY=VALUE\n$")

    def test_what_every_configuration_would_be_refused_for_is_said_first(self):
        points = self.folder / "points"
        points.write_text("hfus=2\nhfus=4 nope=1\n")
        axis = ("--axis", "hfus=2,4")
        beside = (*axis, "--beside", "by hand: hfus=8 hfu.cfus=2", "--beside")
        for words, said in (
            (("--axis", "hfux=2,4"), "--axis: got hfux, expected a key of --config exact"),
            (("--points", str(points)), "--points: got nope, expected a key of --config exact"),
            ((*axis, "--set", "nope=1"), "--set: got nope, expected a key of --config exact"),
            ((*axis, "--beside", "nope=1"), "--beside: got nope, expected a key of --config exact"),
            (("--axis", "hfus@b=2,4"), "--axis: got hfus@b, expected one of truck, or each, .*"),
            (
                (*axis, "--search", "steps", "--objectives", "cycles,mm2"),
                "--search steps: got 2 objectives, expected one",
            ),
            (
                (*axis, "--search", "steps", "--study", "a"),
                "--study: has no effect with --search steps",
            ),
            ((*axis, "--view", "0,9"), "--view: got '9', expected .* truck's cameras, 0 to 0"),
            ((*axis, "--size", "64"), "--size: got 64, expected WIDTHxHEIGHT in px"),
            ((*axis, "--set", "hfus=2"), "--set: got hfus, expected a key that not every .*"),
            (
                ("--axis", "group=64,32", "--set", "group_width_px=64"),
                "--set: got group_width_px, expected a key that not every .*",
            ),
            (
                ("--machine", "paper", "--config", "exact"),
                "--machine paper: got --config exact, which has no storage.encoding; "
                "expected paper_text_no_vq or .*",
            ),
            (
                (*beside, "by hand: hfus=4"),
                "--beside: got the name by hand twice, expected each once",
            ),
            (
                (*beside, "hfu.cfus=2 hfus=8"),
                "--beside: got beside 2 with the settings of by hand, expected others",
            ),
        ):
            with self.subTest(words):
                done = self.explore('(HERE / "drawn").touch(); finish()', *words)
                self.assertRegex(done.stderr, rf"\A.*explore.py: {said}\n\Z")
                self.assertEqual((done.returncode, (self.folder / "drawn").exists()), (2, False))
        # Of a list some may say it themselves.
        points.write_text("hfus=2\nhfu.cfus=2\n")
        done = self.explore("finish()", "--points", str(points), "--set", "hfus=4")
        self.assertEqual([row[0] for row in self.rows("explore.csv")[1:]], ["2", "4"], done.stderr)

    def test_measures_that_no_report_has_are_refused_first(self):
        names = "fps, cycles, .*joules_mean"
        for words, said in (
            (("--objectives", "nosuch"), f"--objectives: got nosuch, expected .* {names}"),
            (("--show", "cycles,frame.nosuch"), "--show: got frame.nosuch, expected .*"),
            (("--require", "min(fsp) >= 90"), "--require: got fsp, expected a number's path .*"),
            (("--show", "config.hfu"), "--show: got config.hfu, expected a number's path .*"),
            (("--show", "filter_lanes"), "--show: report.json has nothing to count .*"),
        ):
            with self.subTest(words):
                body = '"64x36" in sys.argv or (HERE / "drawn").touch(); finish()'
                done = self.explore(body, "--axis", "hfus=2,4", *words)
                self.assertRegex(done.stderr, rf"\A.*explore.py: {said}\n\Z")
                self.assertEqual((done.returncode, (self.folder / "drawn").exists()), (2, False))
        done = self.explore("finish()", "--axis", "hfus=2,4", "--show", "config.sram.input_bytes")
        self.assertEqual(done.returncode, 0, done.stderr)
        # Regions of another frame may be others.
        measures.check_there({}, "dram.bytes_by_region.spill.merge.read")

    def test_what_was_simulated_is_not_simulated_again(self):
        body = """
            with (HERE / "count").open("a") as file:
                print(SET["hfus"], file=file)
            finish()
            """
        program = ("--axis", "hfus=2,4")
        self.explore(body, *program)
        first = self.rows("explore.csv")
        self.explore(body, *program)
        self.assertEqual(self.rows("explore.csv"), first)
        self.assertEqual((self.folder / "count").read_text(), "2\n4\n")


class Drawing(Explorations):
    ENVIRONMENT = None

    def test_the_front_is_drawn_where_it_can_be(self):
        words = ("--axis", "hfus=2,4,8", "--require", "min(fps) >= 3", "--objectives", "mm2")
        done = self.explore("finish()", *words, "--beside", "by hand: hfus=6")
        if "needs python3-matplotlib" in done.stderr:
            self.skipTest("matplotlib is not installed")
        self.assertEqual((done.returncode, "no figure" in done.stderr), (0, False))
        text = (self.folder / "exploration.svg").read_text()
        for said in ("required: min(fps) &gt;= 3", "by hand", "area, mm²", "scripts/explore.py"):
            self.assertIn(said, text)
        self.assertTrue((self.folder / "exploration.png").exists())
        # What is required are the axes, whatever else is to be small.
        words = ("--axis", "hfus=2,4,8", "--require", "min(fps) >= 3", "--require", "mm2 <= 6")
        done = self.explore("finish()", *words, "--objectives", "mean(cycles)")
        self.assertEqual((done.returncode, "no figure" in done.stderr), (0, False), done.stderr)
        text = (self.folder / "exploration.svg").read_text()
        for said in (
            "required: min(fps) &gt;= 3",
            "required: mm2 &lt;= 6",
            "M cycles against area",
        ):
            self.assertIn(said, text)
        self.assertIn("min(fps) against area", text)
        words = ("--axis", "hfus=2,4,8", "--require", "min(fps) >= 3", "--objectives", "cycles")
        done = self.explore("finish()", *words, "--require", "max(cycles) <= 4")
        self.assertEqual((done.returncode, "no figure" in done.stderr), (0, False), done.stderr)
        # Nor what was never drawn.
        words = ("--axis", "hfus=2,4,8", "--require", "min(fps) >= 3", "--require", "mm2 <= 1")
        done = self.explore("finish()", *words)
        self.assertEqual(done.returncode, run_arguments.NONE_HOLDS)
        self.assertIn("explore.csv: no configuration was drawn\n", done.stderr)
        self.assertEqual(list(self.folder.glob("exploration.*")), [])
        # One number alone has nothing to be drawn against; that is no failure.
        done = self.explore("finish()", "--axis", "hfus=2,4")
        self.assertEqual((done.returncode, list(self.folder.glob("exploration.*"))), (0, []))
        self.assertIn(
            "no figure: skipped exploration: columns hfus, group, sum(cycles)", done.stderr
        )

    def test_filters_are_drawn_as_a_map(self):
        axes = ("--axis", "hfu.cfus=1,2", "--axis", "hfu.ffu_lanes=8,16")
        body = """
            CFUS, LANES = (int(SET[key]) for key in ("hfu.cfus", "hfu.ffu_lanes"))
            finish()
            path = pathlib.Path(sys.argv[sys.argv.index("--out") + 1]) / "report.json"
            report = json.loads(path.read_text())
            view = report["views"][0]
            view["config"]["hfu"] = {"cfus": CFUS, "ffu_lanes": LANES}
            view["frame"]["cycles"] = 6400 // (CFUS * LANES)
            path.write_text(json.dumps(report))
            """
        done = self.explore(body, *axes)
        if "needs python3-matplotlib" in done.stderr:
            self.skipTest("matplotlib is not installed")
        self.assertEqual((done.returncode, "no figure" in done.stderr), (0, False), done.stderr)
        text = (self.folder / "filter_units.svg").read_text()
        for said in ("hfu.cfus", "hfu.ffu_lanes", "4.00", "1.00"):
            self.assertIn(said, text)


if __name__ == "__main__":
    unittest.main()
