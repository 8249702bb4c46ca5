"""What the scripts compute themselves, how they end, and that each makes its tables with the
command. Where it matters how a simulation ends, a program that answers as the command does stands
in for it. $STREAMINGGS names the command; without it the tests that need it are skipped."""

import contextlib
import csv
import io
import os
import pathlib
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import textwrap
import unittest
from unittest import mock

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

import compare_orders  # noqa: E402
import compare_variants  # noqa: E402
import explore  # noqa: E402
import fill_readme  # noqa: E402
import objectives  # noqa: E402
import run_arguments  # noqa: E402
import simulations  # noqa: E402
import tables  # noqa: E402
import timing  # noqa: E402
import tuned_orders  # noqa: E402
import work_precision  # noqa: E402
from scenes import Scene, find_scene  # noqa: E402

COMMAND = os.environ.get("STREAMINGGS", "")
SCENE = Scene("toy", "builtin:object")


class Pareto(unittest.TestCase):
    def test_what_another_beats_everywhere_is_not_on_the_front(self):
        points = [(1, 9), (5, 5), (9, 1), (6, 6), (5, 6)]
        self.assertEqual(objectives.pareto_front(points), [True, True, True, False, False])

    def test_equal_points_stay_together(self):
        self.assertEqual(objectives.pareto_front([(2, 2), (2, 2), (3, 2)]), [True, True, False])

    def test_counts_add_up_over_views_costs_do_not(self):
        hfu = {"cfus": 4, "cfu_lanes": 4, "ffu_lanes": 16}
        view = {
            "frame": {"cycles": 10},
            "dram": {"bytes": 70},
            "config": {"hfus": 2, "hfu": hfu},
            "sram": {
                "input_bytes": 1,
                "input_available_bytes": 5,
                "shared_available_bytes": 6,
                "uses": [],
            },
            "area_mm2": {"total": 1.5},
        }
        for name, of_two_views in (
            ("cycles", 20),
            ("dram_bytes", 140),
            ("mac_lanes", 2 * (4 * 4 + 16)),
            ("sram_bytes", 11),
            ("frame.cycles", 20),
            ("area_mm2.total", 1.5),
            ("config.hfus", 2),
            ("sram.input_bytes", 1),
        ):
            with self.subTest(name):
                self.assertEqual(objectives.objective(name, [view, view]), of_two_views)
        with self.assertRaisesRegex(ValueError, "no number at 'frame.joules'"):
            objectives.objective("frame.joules", [view])


class Configurations(unittest.TestCase):
    def test_axis(self):
        self.assertEqual(explore.parse_axis("hfus=2,4"), ["hfus=2", "hfus=4"])
        for bad in ("hfus", "=2", "hfus=", "hfus=2,"):
            with self.assertRaises(ValueError):
                explore.parse_axis(bad)

    def test_points_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "points"
            path.write_text("hfus=2 group_px=64 # small\n\n# none\nhfus=4\n")
            self.assertEqual(explore.read_points(path), [("hfus=2", "group_px=64"), ("hfus=4",)])
            path.write_text("hfus=2\nhfus 4\n")
            with self.assertRaisesRegex(ValueError, ":2: 'hfus'"):
                explore.read_points(path)
            path.write_text("# none\n")
            with self.assertRaisesRegex(ValueError, "points: no configurations"):
                explore.read_points(path)

    def test_one_axis_at_a_time_around_the_preset(self):
        merge = {"entries": 2048, "on_overflow": "spill"}
        preset = {"group_px": 128, "storage": {"chunk_gaussians": 16}, "merge": merge}
        points = work_precision.combinations(preset, cross=False)
        # 6 sizes x 2 policies, and 3 groups and 4 chunks that are not the preset's.
        self.assertEqual(len(points), 12 + 3 + 4)
        self.assertEqual(len(set(points)), len(points))
        self.assertEqual(len(work_precision.combinations(preset, cross=True)), 4 * 5 * 6 * 2)

    def test_unknown_scene_is_refused_with_what_there_is(self):
        with self.assertRaisesRegex(ValueError, "nowhere: no scene; expected .*builtin:object"):
            find_scene("nowhere")


class Tables(unittest.TestCase):
    def test_markdown(self):
        table = tables.markdown(("name", "n"), [("a|b", 12345), ("c", 6)])
        self.assertEqual(table, "| name | n |\n| --- | ---: |\n| a\\|b | 12,345 |\n| c | 6 |\n")

    def test_fractions_stand_at_the_right_too(self):
        table = tables.markdown(("J",), [(0.000123456789,), (1.5e-9,)])
        self.assertEqual(table, "| J |\n| ---: |\n| 0.000123457 |\n| 1.5e-09 |\n")

    def test_csv(self):
        self.assertEqual(tables.csv_text(("a", "b"), [(1, "x, y")]), 'a,b\n1,"x, y"\n')

    def test_places_in_the_readme(self):
        readme = "A\n<!-- table: one -->\nold\n<!-- end -->\nB\n<!-- table: two -->\n<!-- end -->\n"
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "one.md").write_text("new\n")
            filled = fill_readme.filled(readme, pathlib.Path(folder))
        self.assertEqual(filled, readme.replace("old", "new"))

    def test_readmes_of_sources_only(self):
        with tempfile.TemporaryDirectory() as folder:
            top = pathlib.Path(folder)
            for name in ("", "modules/dram", "build/release", "out/x", ".git"):
                (top / name).mkdir(parents=True, exist_ok=True)
                (top / name / "README.md").write_text("text\n")
            found = [str(path.relative_to(top)) for path in fill_readme.readmes(top)]
        self.assertEqual(found, ["README.md", "modules/dram/README.md"])


class Reports(unittest.TestCase):
    VIEW = {
        "dram": {"bytes_by_region": {"spill": {"merge": {"read": 5, "write": 7}}, "empty": {}}},
        "units": {
            "merge": {"activities": {"merge": {"busy_cycles": 9}}, "counters": {"keys": 3}},
            "hfu0.coarse": {"activities": {}, "counters": {"keys": 4}},
            "vsu": {"activities": {}, "counters": {}},
        },
        "image": {"psnr_db": None},
    }

    def test_sums(self):
        self.assertEqual(simulations.region_bytes(self.VIEW, "spill"), 12)
        self.assertEqual(simulations.region_bytes(self.VIEW, "indices"), 0)
        self.assertEqual(simulations.work(self.VIEW, "keys"), 7)
        self.assertEqual(simulations.psnr_text(self.VIEW), "equal")

    def test_value_at_path(self):
        self.assertEqual(compare_orders.value_at({"a": {"b": 3}}, ("a", "b")), 3)


    def test_what_the_filters_remove(self):
        def unit(**counters):
            return {"activities": {}, "counters": counters}

        units = {
            "hfu0.coarse": unit(coarse_tests=100, coarse_passed=50),
            "hfu0.fine": unit(fine_tests=50, splats=20),
            "rendering": unit(splats=7),
        }
        self.assertEqual(compare_variants.removed([{"units": units}]), "50% / 60% / 80.0%")

    def test_where_a_table_comes_from(self):
        words = ["explore.py", "truck", "--out", "x", "--side-by-side=1", "--streaminggs", "y"]
        words.append("--cross")
        views = [{"provenance": {"commit": "abc"}}, {"provenance": {}}]
        with mock.patch("sys.argv", words):
            made = run_arguments.how_made(views)
        self.assertEqual(made, "Made by `scripts/explore.py truck --cross`; commit abc.\n\n")


class InFolder(unittest.TestCase):
    """A folder of its own with a small trained scene, truck.ply, and its camera."""

    GAUSSIANS = 64

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "truck.ply"
        self.write_scene()

    def write_scene(self):
        names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity"]
        names += [f"scale_{axis}" for axis in range(3)] + [f"rot_{part}" for part in range(4)]
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {self.GAUSSIANS}"]
        head += [*(f"property float {name}" for name in names), "end_header", ""]
        size, turn = (-3, -3, -3), (1, 0, 0, 0)
        body = b"".join(
            struct.pack("<14f", i % 8 / 8, i // 8 / 8, i % 5 / 5, i % 3, 0, 1, 2, *size, *turn)
            for i in range(self.GAUSSIANS)
        )
        self.scene.write_bytes("\n".join(head).encode() + body)
        self.scene.with_suffix(".json").write_text(
            """[{"id": 0, "img_name": "0", "width": 64, "height": 36, "fx": 60, "fy": 60,
                 "position": [0.5, 0.5, -2], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}]"""
        )

    def stand_in(self, body: str) -> pathlib.Path:
        """A program in the command's place. It has SET, the values of --set, and `finish()`, which
        writes the report of a view that took 8 cycles over the number of HFUs."""
        program = self.folder / "streaminggs"
        prelude = f"""\
            #!{sys.executable}
            import json, os, pathlib, signal, sys, time
            HERE = pathlib.Path(__file__).parent
            SET = dict(word.split("=") for word in sys.argv if "=" in word)
            def finish():
                hfus = int(SET.get("hfus", 1))
                view = {{"frame": {{"cycles": 8 // hfus}}, "binding": {{"unit": "dram"}},
                        "config": {{"hfus": hfus, "group_px": 112}}, "provenance": {{}}}}
                out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
                (out / "report.json").write_text(json.dumps({{"views": [view]}}))
            """
        program.write_text(textwrap.dedent(prelude) + textwrap.dedent(body))
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return program

    def ended(self, script, *arguments: str) -> tuple[int, str, str]:
        """Exit status, last line of stderr and stdout of a script that gets these arguments."""
        out, said = io.StringIO(), io.StringIO()
        words = [f"{script.__name__}.py", *arguments]
        with mock.patch("sys.argv", words), contextlib.redirect_stdout(out):
            with contextlib.redirect_stderr(said):
                status = script.main()
        return status, said.getvalue().rstrip().rpartition("\n")[2], out.getvalue()


class Simulator(InFolder):
    def test_outcomes(self):
        for what, body, expected in (
            ("views", "finish()", ([8], "")),
            (
                "a refusal",
                "print('group_px: 6 is\\nodd', file=sys.stderr); sys.exit(2)",
                ([], "group_px: 6 is odd"),
            ),
        ):
            with self.subTest(what):
                outcome = simulations.simulate(self.stand_in(body), simulations.Run(SCENE))
                cycles = [view["frame"]["cycles"] for view in outcome.views]
                self.assertEqual((cycles, outcome.refused), expected)

    def test_failures(self):
        for what, body, expected in (
            (
                "frame that differs",
                "print('a table'); print('the frame differs'); sys.exit(1)",
                "^toy exact hfus=2: the frame differs$",
            ),
            ("crash", "os.kill(os.getpid(), signal.SIGKILL)", "^toy exact hfus=2: exit status -9$"),
        ):
            run = simulations.Run(SCENE, overrides=("hfus=2",))
            with self.subTest(what), self.assertRaisesRegex(simulations.Failure, expected):
                simulations.simulate(self.stand_in(body), run)


# Script, and the arguments besides a scene that it cannot do without.
SCRIPTS = (
    (compare_orders, ()),
    (compare_variants, ()),
    (explore, ("--axis", "hfus=2,4")),
    (timing, ()),
    (tuned_orders, ()),
    (work_precision, ()),
)


class Ends(InFolder):
    """Bad input: one line that says what is wrong, and exit status 2."""

    def check(self, script, arguments, expected_status, expected_line):
        status, line, _ = self.ended(script, str(self.scene), *arguments)
        self.assertRegex(line, f"^{script.__name__}.py: {expected_line}")
        self.assertEqual(status, expected_status)
        self.assertEqual(list(self.folder.glob("*/*.md")), [])

    def test_of_every_script(self):
        file = self.folder / "file"
        file.write_text("not a program\n")
        refusing = "print('streaminggs: --view: 99, expected 0', file=sys.stderr); sys.exit(2)"
        differing = "print('the frame differs'); sys.exit(1)"
        cases = (
            ("--out is a file", "finish()", ("--out", str(file)), 2, "--out: .*expected a folder"),
            ("--out below a file", "finish()", ("--out", f"{file}/x"), 2, "--out: .* a folder"),
            ("no program", "", ("--streaminggs", "no"), 2, "no: not there; scripts/setup.sh"),
            ("not a program", "", ("--streaminggs", str(file)), 2, ".*file: cannot be run: Perm"),
            ("all refused", refusing, (), 2, "(truck .*: )?streaminggs: --view: 99, expected 0$"),
            ("differs", differing, (), 1, "truck .*: the frame differs$"),
        )
        for what, body, more, status, line in cases:
            program = ("--streaminggs", str(self.stand_in(body)), "--out", str(self.folder / "out"))
            for script, needed in SCRIPTS:
                # It asks for the resolved configuration first, and takes no answer but a good one.
                if what == "differs" and script is work_precision:
                    status = 2
                    line = "the frame differs$"
                with self.subTest(what, script=script.__name__):
                    self.check(script, (*needed, *program, *more), status, line)

    def test_of_one_script(self):
        good = self.stand_in("finish()")
        for script, arguments, line in (
            (explore, ("--points", "nowhere"), "nowhere: No such file or directory$"),
            (explore, ("--points", str(self.folder)), ".*: Is a directory$"),
            (explore, ("--axis", "hfus"), "--axis: 'hfus', expected KEY=VALUE"),
            (
                explore,
                ("--axis", "hfus=2", "--objectives", "joules"),
                "--objectives: report.json has no number at 'joules'$",
            ),
            (timing, ("--repeats", "0"), "--repeats: 0, expected at least 1$"),
        ):
            with self.subTest(script.__name__, arguments=arguments):
                program = ("--streaminggs", str(good), "--out", str(self.folder / "out"))
                self.check(script, (*program, *arguments), 2, line)

    def test_unknown_scene_and_readme(self):
        for script in (explore, fill_readme):
            with self.subTest(script.__name__):
                needed = ("--axis", "hfus=2") if script is explore else ()
                status, line, _ = self.ended(script, "nowhere", *needed)
                self.assertRegex(line, "nowhere: (no scene|No such file)")
                self.assertEqual(status, 2)


class Exploring(InFolder):
    def explore(self, body: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        program = self.stand_in(body)
        command = [sys.executable, "-B", str(REPOSITORY / "scripts" / "explore.py")]
        command += [str(self.scene), "--streaminggs", str(program), "--out", str(self.folder)]
        command += ["--objectives", "cycles", "--side-by-side", "1", *arguments]
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            # Whoever runs the tests in the background has SIGINT ignored.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def rows(self, name: str) -> list[list[str]]:
        return list(csv.reader((self.folder / name).read_text().splitlines()))

    HEAD = ["hfus", "group_px", "cycles", "binding", "pareto"]

    def test_tables_show_what_was_simulated(self):
        done = self.explore("finish()", "--axis", "hfus=2,4")
        self.assertEqual((done.returncode, done.stderr.count("Traceback")), (0, 0))
        rows = [["2", "112", "4", "dram", ""], ["4", "112", "2", "dram", "yes"]]
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, *rows])
        self.assertIn("1 of 2 configurations are on the Pareto front", done.stdout)

    def test_memory_is_as_large_as_needed_unless_it_is_said(self):
        body = """
            with (HERE / "sram").open("a") as file:
                print(SET["sram.input_bytes"], SET["sram.shared_bytes"], file=file)
            finish()
            """
        self.explore(body, "--axis", "hfus=2")
        self.explore(body, "--axis", "hfus=2", "--set", "sram.shared_bytes=900")
        self.explore(body, "--axis", "hfus=2", "--axis", "sram.shared_bytes=700")
        self.assertEqual((self.folder / "sram").read_text(), "0 0\n0 900\n0 700\n")

    def test_a_refused_configuration_is_named_and_left_out(self):
        body = """
            if SET["hfus"] == "3":
                print("hfus: 3 is odd", file=sys.stderr)
                sys.exit(2)
            finish()
            """
        done = self.explore(body, "--axis", "hfus=2,3")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, ["2", "112", "4", "dram", "yes"]])
        self.assertRegex(done.stdout, "Refused: truck .* hfus=3: hfus: 3 is odd")

    def test_what_was_simulated_is_kept(self):
        for what, end, status, line in (
            (
                "interrupted",
                "os.kill(os.getppid(), signal.SIGINT); time.sleep(1)",
                130,
                "interrupted$",
            ),
            ("failed", "print('it differs'); sys.exit(1)", 1, "truck .*: it differs$"),
        ):
            with self.subTest(what):
                body = f"""
                    if SET["hfus"] == "4":
                        {end}
                    finish()
                    """
                done = self.explore(body, "--axis", "hfus=2,4,8")
                self.assertEqual(done.returncode, status)
                self.assertNotIn("Traceback", done.stderr)
                self.assertRegex(done.stderr.splitlines()[-1], line)
                kept = self.rows("explore_partial.csv")
                self.assertEqual(kept, [self.HEAD, ["2", "112", "4", "dram", "yes"]])
                text = (self.folder / "explore_partial.md").read_text()
                self.assertTrue(text.startswith("Not complete: 1 of 3 configurations.\n"))
                self.assertFalse((self.folder / "explore.csv").exists())


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class WithTheCommand(InFolder):
    def made(self, script, *arguments: str) -> str:
        """The tables of a script, after it has ended well."""
        status, line, tables_of_it = self.ended(
            script, str(self.scene), "--streaminggs", COMMAND, "--out", str(self.folder), *arguments
        )
        self.assertEqual(status, 0, line)
        return tables_of_it

    def test_every_script_makes_its_tables(self):
        for script, arguments, lines in (
            (compare_orders, ("--sizes", "64x36"), {"| truck | 0 |": 2, "| 0 | exact |": 1}),
            (compare_variants, ("--size", "64x36"), {"| truck |": 8 + 1 + 2, "| StreamingGS |": 2}),
            (
                explore,
                ("--axis", "hfus=2,4", "--axis", "group_px=16,32"),
                {"of 4 configurations": 1, "Refused": 0},
            ),
            (explore, ("--config", "paper", "--axis", "hfus=2"), {"| 2 | 32 |": 1}),
            (timing, ("--repeats", "1", "--configs", "exact", "paper"), {"| truck | 64 |": 2}),
            (tuned_orders, (), {"| truck |": 1}),
            (work_precision, (), {"| truck | 0 |": 20, "| 4,096 |": 2}),
        ):
            with self.subTest(script.__name__, arguments=arguments):
                made = self.made(script, *arguments)
                self.assertRegex(made, f"Made by `scripts/{script.__name__}.py ")
                for text, count in lines.items():
                    self.assertEqual(made.count(text), count, f"{text} in\n{made}")

    def test_memory_is_as_large_as_needed(self):
        scene = find_scene(str(self.scene))
        for config in ("exact", "paper_no_vq"):
            with self.subTest(config):
                overrides = (*simulations.SRAM_AS_NEEDED, "hfus=2", "group_px=48")
                run = simulations.Run(scene, config=config, overrides=overrides)
                (view,) = simulations.simulate(pathlib.Path(COMMAND), run).accepted()
                for memory in ("input", "shared"):
                    needed = view["sram"][f"{memory}_bytes"]
                    self.assertGreater(needed, 0)
                    self.assertEqual(needed, view["sram"][f"{memory}_available_bytes"])
                    self.assertEqual(needed, view["config"]["sram"][f"{memory}_bytes"])

    def test_what_the_command_refuses(self):
        for script, arguments, line in (
            (explore, ("--axis", "hfus=2", "--config", "nope"), "streaminggs: .*nope"),
            (explore, ("--axis", "hfus=2", "--view", "99"), "--view: '99'"),
            (explore, ("--axis", "group_px=0"), "group_px: got 0 with sram.shared_bytes 0"),
            (explore, ("--axis", "hfu=2"), "--set hfu=2: "),
            (compare_orders, ("--sizes", "3"), "--size: '3'"),
            (compare_variants, ("--view", "x"), "--view: 'x'"),
            (timing, ("--view", "7"), "--view: '7'"),
            (timing, ("--configs", "nope"), "streaminggs: .*nope"),
            (work_precision, ("--view", "7"), "--view: '7'"),
            (work_precision, ("--set", "nope=1"), "streaminggs: .*nope"),
        ):
            with self.subTest(script.__name__, arguments=arguments):
                status, said, made = self.ended(
                    script,
                    str(self.scene),
                    *("--streaminggs", COMMAND, "--out", str(self.folder)),
                    *arguments,
                )
                self.assertRegex(said, line)
                self.assertEqual((status, made), (2, ""))


if __name__ == "__main__":
    unittest.main()
