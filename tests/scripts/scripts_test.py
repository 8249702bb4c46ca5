"""What the scripts compute themselves: Pareto fronts, tables, SRAM raised by what a refusal says.
The simulator is stood in for by a program that answers as it does."""

import pathlib
import stat
import sys
import tempfile
import textwrap
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

import compare_orders  # noqa: E402
import explore  # noqa: E402
import fill_readme  # noqa: E402
import simulations  # noqa: E402
import tables  # noqa: E402
import work_precision  # noqa: E402
from scenes import Scene, find_scene  # noqa: E402

SCENE = Scene("toy", "builtin:object")


class Pareto(unittest.TestCase):
    def test_what_another_beats_everywhere_is_not_on_the_front(self):
        points = [(1, 9), (5, 5), (9, 1), (6, 6), (5, 6)]
        self.assertEqual(explore.pareto_front(points), [True, True, True, False, False])

    def test_equal_points_stay_together(self):
        self.assertEqual(explore.pareto_front([(2, 2), (2, 2), (3, 2)]), [True, True, False])

    def test_counts_add_up_over_views_costs_do_not(self):
        hfu = {"cfus": 4, "cfu_lanes": 4, "ffu_lanes": 16}
        view = {"frame": {"cycles": 10}, "config": {"hfus": 2, "hfu": hfu}}
        self.assertEqual(explore.objective("cycles", [view, view]), 20)
        self.assertEqual(explore.objective("mac_lanes", [view, view]), 2 * (4 * 4 + 16))
        self.assertEqual(explore.objective("frame.cycles", [view, view, view]), 30)
        with self.assertRaisesRegex(ValueError, "no number at 'frame.joules'"):
            explore.objective("frame.joules", [view])


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

    def test_one_axis_at_a_time_around_the_preset(self):
        merge = {"entries": 2048, "on_overflow": "spill"}
        preset = {"group_px": 128, "chunk_gaussians": 16, "merge": merge}
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

    def test_csv(self):
        self.assertEqual(tables.csv_text(("a", "b"), [(1, "x, y")]), 'a,b\n1,"x, y"\n')

    def test_places_in_the_readme(self):
        readme = "A\n<!-- table: one -->\nold\n<!-- end -->\nB\n<!-- table: two -->\n<!-- end -->\n"
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "one.md").write_text("new\n")
            filled = fill_readme.filled(readme, pathlib.Path(folder))
        self.assertEqual(filled, readme.replace("old", "new"))


class Reports(unittest.TestCase):
    VIEW = {
        "dram": {"bytes_by_region": {"spill": {"merge": {"read": 5, "write": 7}}, "empty": {}}},
        "units": {"merge": {"keys": 3}, "hfu0.coarse": {"keys": 4}, "vsu.walk": {}},
        "image": {"psnr_db": None},
    }

    def test_sums(self):
        self.assertEqual(simulations.region_bytes(self.VIEW, "spill"), 12)
        self.assertEqual(simulations.region_bytes(self.VIEW, "indices"), 0)
        self.assertEqual(simulations.work(self.VIEW, "keys"), 7)
        self.assertEqual(simulations.psnr_text(self.VIEW), "equal")

    def test_value_at_path(self):
        self.assertEqual(compare_orders.value_at({"a": {"b": 3}}, ("a", "b")), 3)


class Simulator(unittest.TestCase):
    def stand_in(self, body: str) -> pathlib.Path:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        program = pathlib.Path(folder.name) / "streaminggs"
        program.write_text(f"#!{sys.executable}\nimport pathlib, sys\n" + textwrap.dedent(body))
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return program

    def test_sram_is_raised_to_what_is_needed_and_said_so(self):
        program = self.stand_in(
            """
            for key, needed in (("sram.input_bytes", 500), ("sram.shared_bytes", 900)):
                if f"{key}={needed}" not in sys.argv:
                    print(f"streaminggs: {key}: 100 bytes are there, {needed} are needed: a + b",
                          file=sys.stderr)
                    sys.exit(2)
            if "--print-config" not in sys.argv:
                out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
                (out / "report.json").write_text('{"views": [{"view": 0}]}')
            """
        )
        outcome = simulations.simulate(program, simulations.Run(SCENE))
        self.assertEqual(outcome.raised, (("sram.input_bytes", 500), ("sram.shared_bytes", 900)))
        self.assertEqual(outcome.views, ({"view": 0},))
        self.assertEqual(outcome.refused, "")

    def test_another_refusal_is_an_outcome(self):
        program = self.stand_in("sys.exit('group_px: 6 is not a multiple of 4')")
        outcome = simulations.simulate(program, simulations.Run(SCENE))
        self.assertEqual(outcome.refused, "group_px: 6 is not a multiple of 4")
        self.assertEqual(outcome.views, ())

    def test_a_frame_that_differs_stops_the_script(self):
        program = self.stand_in(
            """
            if "--print-config" not in sys.argv:
                print("the frame differs from the streaming renderer's")
                sys.exit(1)
            """
        )
        with self.assertRaisesRegex(simulations.Failure, "the frame differs"):
            simulations.simulate(program, simulations.Run(SCENE))

    def test_a_missing_program_is_named(self):
        with self.assertRaisesRegex(simulations.Failure, "scripts/setup.sh builds it"):
            simulations.simulate(pathlib.Path("nowhere/streaminggs"), simulations.Run(SCENE))


if __name__ == "__main__":
    unittest.main()
