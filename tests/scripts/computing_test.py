"""What the scripts compute themselves."""

import math
import pathlib
import tempfile
import unittest
from unittest import mock

import in_folder  # noqa: F401, isort: skip (finds the scripts)
import binding_check
import energy_components
import energy_tables
from runs import group_shapes
import measures
from runs import run_arguments
import search_space
from runs import simulations
import stability_table
from results import tables
from runs import view_numbers
import work_precision
from machine_axes import Axis
from runs.scenes import find_scene, find_scenes


class Pareto(unittest.TestCase):
    def test_what_another_beats_everywhere_is_not_on_the_front(self):
        points = [(1, 9), (5, 5), (9, 1), (6, 6), (5, 6)]
        self.assertEqual(measures.pareto_front(points), [True, True, True, False, False])

    def test_equal_points_stay_together(self):
        self.assertEqual(measures.pareto_front([(2, 2), (2, 2), (3, 2)]), [True, True, False])


class Measures(unittest.TestCase):
    HFU = {"cfus": 4, "cfu_lanes": 4, "ffu_lanes": 16}

    def view(self, cycles: int, mm2: float, psnr_db: float | None = None) -> dict:
        return {
            "frame": {"cycles": cycles, "fps": 1000 / cycles},
            "dram": {"bytes": 70},
            "config": {"hfus": 2, "hfu": self.HFU},
            "sram": {"input_bytes": 1, "input_available_bytes": 5, "shared_available_bytes": 6},
            "area_mm2": {"total": mm2},
            "image": {"psnr_db": psnr_db},
        }

    def test_of_two_views(self):
        views = [self.view(10, 1.5), self.view(40, 1.6, 30.0)]
        for text, expected in (
            ("cycles", 50),
            ("dram_bytes", 140),
            ("filter_lanes", 2 * (4 * 4 + 16)),
            ("sram_bytes", 11),
            ("frame.cycles", 50),
            ("mm2", 1.6),
            ("config.hfus", 2),
            ("sram.input_bytes", 1),
            ("mean(cycles)", 25),
            ("min:max( cycles )", 40),
            ("worst(cycles)", 40),
            ("max:worst(fps)", -25),
            ("max:mean(fps)", -62.5),
            ("max:min(psnr_db)", -30),
        ):
            with self.subTest(text):
                self.assertEqual(measures.objective(text).cost(views), expected)
        self.assertEqual(measures.measure("min(psnr_db)").of(views[:1]), math.inf)

    def test_99_of_100(self):
        views = [self.view(cycles, 1) for cycles in range(1, 201)]
        self.assertEqual(measures.measure("p99(cycles)").of(views), 198)
        self.assertEqual(measures.measure("p99(cycles)").of(views[:5]), 5)

    def test_requirements(self):
        views = [self.view(10, 1.5), self.view(40, 1.6)]
        for text, violation, lost_at_once in (
            ("min(fps) >= 50", 0.5, True),
            ("min(fps)>=20", -0.25, False),
            ("max(cycles) <= 20", 1, True),
            ("cycles <= 40", 0.25, True),
            ("mean(fps) >= 125", 0.5, False),
            ("mm2 <= 1.6", 0, False),
            ("min(fps) >= 0", -25, False),
        ):
            with self.subTest(text):
                required = measures.requirement(text)
                self.assertAlmostEqual(required.violation(views), violation)
                self.assertEqual(required.is_lost(views), lost_at_once)

    def test_what_is_none(self):
        for text, what in (
            ("fps", "--require: 'fps', expected MEASURE >= NUMBER"),
            ("min(fps) > 3", "--require: 'min\\(fps\\) > 3', expected"),
            ("avg(fps) >= 3", "--require: 'avg\\(fps\\)': avg, expected one of sum, mean"),
            ("worst(fps) >= 3", "--require: .*worst, expected one of"),
            ("min(fps >= 3", "--require: 'min\\(fps', expected PATH or AGGREGATE"),
            ("min(fps) >= x", "--require: 'x', expected a number"),
            ("min(fps) >= inf", "--require: 'inf', expected a number"),
        ):
            with self.subTest(text), self.assertRaisesRegex(ValueError, what):
                measures.requirement(text)
        for text, what in (
            ("least:fps", "--objectives: 'least:fps', expected min:MEASURE or max:MEASURE"),
            ("p50(fps)", "--objectives: .*p50, expected one of .*worst"),
            ("", "--objectives: '', expected"),
        ):
            with self.subTest(text), self.assertRaisesRegex(ValueError, what):
                measures.objective(text)
        with self.assertRaisesRegex(ValueError, "no number at 'frame.joules'"):
            measures.objective("frame.joules").cost([self.view(1, 1)])


class Spaces(unittest.TestCase):
    def test_axis(self):
        axis = search_space.parse_axis("hfus=2,4")
        self.assertEqual(axis.settings, (("hfus=2",), ("hfus=4",)))
        for bad in ("hfus", "=2", "hfus=", "hfus=2,"):
            with self.assertRaises(ValueError):
                search_space.parse_axis(bad)

    def test_points_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "points"
            path.write_text("hfus=2 group=64 # small\n\n# none\nhfus=4\n")
            (axis,) = search_space.read_points(path)
            group = ("group_width_px=64", "group_height_px=64")
            self.assertEqual(axis.settings, (("hfus=2", *group), ("hfus=4",)))
            path.write_text("hfus=2\nhfus 4\n")
            with self.assertRaisesRegex(ValueError, ":2: 'hfus'"):
                search_space.read_points(path)
            path.write_text("# none\n")
            with self.assertRaisesRegex(ValueError, "points: no configurations"):
                search_space.read_points(path)

    def test_of_axes(self):
        axes = search_space.parse_axes(["hfus=2,4", "group=32,64x16,96"])
        space = search_space.Space(axes)
        self.assertEqual((space.size(), space.keys()), (6, ("hfus", "group")))
        self.assertEqual(list(space.all())[:4], [(0, 0), (0, 1), (0, 2), (1, 0)])
        self.assertEqual(set(space.neighbours((0, 1))), {(1, 1), (0, 0), (0, 2)})
        setting = ("hfus=4", "group_width_px=64", "group_height_px=16")
        self.assertEqual(space.assignments((1, 1)), setting)

    def test_axes_of_a_machine_stand_behind_those_that_are_named(self):
        given = (Axis("hfus", (("hfus=1",),)), Axis("clusters", (("clusters=1",), ("clusters=2",))))
        axes = search_space.parse_axes(["hfus=2,4"], given)
        self.assertEqual([axis.name for axis in axes], ["clusters", "hfus"])


class Configurations(unittest.TestCase):
    def test_shapes_of_groups(self):
        for shape, width, height in (("64", 64, 64), ("160x120", 160, 120), ("4x64", 4, 64)):
            both = (f"group_width_px={width}", f"group_height_px={height}")
            self.assertEqual(group_shapes.assignments(shape), both)
            self.assertEqual(group_shapes.expanded(("hfus=2", f"group={shape}")), ("hfus=2", *both))
            self.assertEqual(group_shapes.setting_text(both), f"group={shape}")
            config = {"group_width_px": width, "group_height_px": height}
            self.assertEqual(group_shapes.shape_of(config), shape)
        self.assertEqual(group_shapes.setting_text(("hfus=2", "fetch=split")), "hfus=2")
        for bad in ("", "x", "64x", "1x2x3", "-4", "big"):
            with self.assertRaises(ValueError):
                group_shapes.assignments(bad)

    def test_one_axis_at_a_time_around_the_preset(self):
        merge = {"entries": 2048, "on_overflow": "spill"}
        preset = {
            "group_width_px": 128,
            "group_height_px": 128,
            "storage": {"chunk_gaussians": 16},
            "merge": merge,
        }
        points = work_precision.combinations(preset, cross=False)
        # 6 sizes x 2 policies, and 3 groups and 5 chunks that are not the preset's.
        self.assertEqual(len(points), 12 + 3 + 5)
        self.assertEqual(len(set(points)), len(points))
        self.assertEqual(len(work_precision.combinations(preset, cross=True)), 4 * 6 * 6 * 2)

    def test_unknown_scene_is_refused_with_what_there_is(self):
        with self.assertRaisesRegex(ValueError, "nowhere: no scene; expected .*builtin:object"):
            find_scene("nowhere")

    def test_a_scene_twice_is_refused(self):
        text = "builtin:object?n=1"
        for texts in ([text, text], [text, "builtin:outdoor", text]):
            with self.assertRaisesRegex(ValueError, "n=1: got it twice, expected each scene once"):
                find_scenes(texts)


class Stability(unittest.TestCase):
    """Rows of a study that is whole at its first two places, and infinite at its last."""

    STUDY = {
        "formula": "x",
        "form": "as written",
        "taken": True,
        "arithmetic": "float",
        "axis": "size",
        "unit": "of x",
        "law": "u",
        "operations": "2 x",
        "why": "Too large.",
        "breaks_at": 1e6,
        "places": [
            {"place": 1, "error": 1e-7, "bound": 2e-7, "error_over_bound": 0.5, "law": 1e-6},
            {"place": 1000, "error": 3e-3, "bound": None, "error_over_bound": 0.1, "law": None},
            {"place": 1e6, "error": None, "bound": None, "error_over_bound": 0, "law": None},
        ],
    }

    def test_a_row_tells_of_what_comes_before_it_breaks(self):
        row = stability_table.row_of(self.STUDY)
        self.assertEqual(row[4:9], ("size 1 .. 10^6", "3.0e-03 of x", "nothing", "u", "10^6"))
        whole = self.STUDY | {"breaks_at": None, "places": self.STUDY["places"][:1]}
        row = stability_table.row_of(whole)
        self.assertEqual(row[4:9], ("size 1 .. 1", "1.0e-07 of x", "2.0e-07", "u", "nowhere"))

    def test_never_whole(self):
        broken = self.STUDY | {"breaks_at": 1000, "places": self.STUDY["places"][1:]}
        self.assertEqual(stability_table.row_of(broken)[5], "3.0e-03 of x")

    def test_every_place_is_in_the_csv(self):
        rows = stability_table.csv_rows(self.STUDY)
        self.assertEqual(rows[1][6:], (1000, 3e-3, None, 0.1, None))
        self.assertEqual(len(rows), 3)


class Tables(unittest.TestCase):
    def test_markdown(self):
        table = tables.markdown(("name", "n"), [("a|b", 12345), ("c", 6)])
        self.assertEqual(table, "| name | n |\n| --- | ---: |\n| a\\|b | 12,345 |\n| c | 6 |\n")

    def test_fractions_stand_at_the_right_too(self):
        table = tables.markdown(("J",), [(0.000123456789,), (1.5e-9,)])
        self.assertEqual(table, "| J |\n| ---: |\n| 0.000123457 |\n| 1.5e-09 |\n")

    def test_csv(self):
        self.assertEqual(tables.csv_text(("a", "b"), [(1, "x, y")]), 'a,b\n1,"x, y"\n')


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
        self.assertEqual(simulations.region_bytes(self.VIEW, "codebooks"), 0)
        self.assertEqual(simulations.work(self.VIEW, "keys"), 7)
        self.assertEqual(simulations.psnr_text(self.VIEW), "equal")

    def test_the_worst_waiting_of_vsu(self):
        def activity(reads):
            return {"waited_cycles": {"reads": reads, "room": 90}}

        vsu = {"activities": {"walk": activity(7), "hand_out": activity(3)}}
        view = {"units": {"vsu": vsu}, "frame": {"cycles": 100}}
        self.assertEqual(view_numbers.vsu_waits(view), 0.07)

    def test_a_share_stands_beside_the_resource_that_it_is_of(self):
        def view(unit, share, holds):
            return {"binding": {"unit": unit, "utilisation": share, "holds": holds}}

        fine = [
            view("fine", 0.56, "vsu.memory"),
            view("fine", 0.6, "hfu0"),
            view("fine", 0.7, "fine"),
        ]
        for views, text in (
            ([view("dram", 0.8, "dram")], "dram 80%"),
            ([view("dram", 0.8, "dram"), view("dram", 0.9, "dram")], "dram 80% .. 90%"),
            ([view("vsu", 0.5, "vsu.memory")], "vsu 50% -> vsu.memory"),
            ([view("vsu", 0.1, "")], "vsu 10%"),
            ([view("vsu", 0.7, "vsu"), *fine], "fine 56% .. 70% -> hfu0 or vsu.memory, vsu 70%"),
        ):
            with self.subTest(text):
                self.assertEqual(view_numbers.binders(views), text)

    def test_components_of_energy_hold_every_joule(self):
        keys = ("vsu_j", "merge_j", "pixel_state_j", "input_j", "clock_j", "sram_leakage_j")
        middles = {key: 2.0**n for n, key in enumerate((*keys, "dram_j"))}
        view = {
            "area_mm2": {"vsu": 1, "merge": 1, "sram": 1, "total": 3, "bands": {}},
            "energy": {**middles, "dram_by_region_j": {"spill": 1.0}, "bands": {}},
        }
        rows = energy_components.components(view)
        self.assertEqual(rows["SRAM: pixels"], ("pixel_state_j",))
        self.assertEqual(rows["SRAM: all else"], ("input_j",))
        summed = [energy_components.joules(view, of) for name, of in rows.items() if name != "all"]
        self.assertEqual(sum(summed), 2.0**7 - 1)

    def test_the_ordering_table_grows_with_the_group(self):
        config = {"group_width_px": 64, "group_height_px": 64, "vsu": {"table_bytes": 4096}}
        for shape, expected in (("16", 4096), ("64", 4096), ("128", 16384), ("160x120", 19200)):
            with self.subTest(shape):
                keys = group_shapes.assignments(shape)
                made = energy_tables.table_bytes(config, keys)
                self.assertEqual(made, (f"vsu.table_bytes={expected}",))
                self.assertEqual(energy_tables.table_bytes({"vsu": {}}, keys), ())

    def test_whether_the_named_resource_gains_most(self):
        for gains, most in (((0.2, 0.1), True), ((0.1, 0.2), False)):
            doubled = [{"key": k, "time_saved": g} for k, g in zip("ab", gains)]
            base = {"cycles": 1e6, "holds_key": "a"}
            answer = {"view": 0, "base": base, "doubled": doubled}
            answer |= {"named_gains_most": most, "verdict": "why"}
            with self.subTest(gains):
                row = binding_check.Answer("x", answer).row()
                named, best = f"{gains[0]:.1%}", f"{max(gains):.1%}"
                self.assertEqual(row[4], named)
                self.assertEqual(row[6:], (best, *(("yes", "") if most else ("no", "why"))))

    def test_where_a_table_comes_from(self):
        words = ["explore.py", "truck", "--out", "x", "--side-by-side=1", "--streaminggs", "y"]
        words.append("--cross")
        views = [{"provenance": {"commit": "abc"}}, {"provenance": {}}]
        with mock.patch("sys.argv", words):
            made = run_arguments.how_made(views)
        self.assertEqual(made, "Made by `scripts/explore.py truck --cross`; commit abc.\n\n")


if __name__ == "__main__":
    unittest.main()
