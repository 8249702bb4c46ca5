"""What the scripts compute themselves."""

import json
import math
import pathlib
import re
import tempfile
import unittest
from unittest import mock

import in_folder  # noqa: F401, isort: skip (finds the scripts)
import results
from exploring import measures
from exploring.axes import (
    Axis,
    Space,
    axis,
    of_scene,
    parse_axes,
    parse_axis,
    read_points,
    with_own,
)
from runs import beside, simulations
from runs.scenes import REPOSITORY, Failure, Scene, find_scene, find_scenes
from runs.simulations import pareto_front
from studies import (
    areas,
    bench_validation,
    cases,
    choices,
    frame_costs,
    gpu_validation,
    memory_validation,
    power,
    stability,
    stream_shares,
    validation,
    variants,
)


class StreamShares(unittest.TestCase):
    def test_reads_are_told_apart_by_the_row_that_is_open(self):
        trace = ["# head", "1 0 ACT 0 3 7", "2 0 RD 0 3 1", "3 0 ACT 0 3 8", "4 0 RDA 0 3 1"]
        bursts, moved = stream_shares.read_bursts([*trace, "5 0 WR 0 3 1", "# commands 5"])
        self.assertEqual([burst[3:] for burst in bursts], [("7", "1"), ("8", "1")])
        self.assertEqual(moved, 3)
        view = {"burst_bytes": 1e6}
        frames = [(bursts, view), (bursts[:1], view), ([], view)]
        self.assertEqual(stream_shares.row_of("s", "p", frames), ("s", "p", 2, 2, 0.5, 0))

    def test_cameras_of_another_form_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "c.json")
            for text in ('{"frames": []}', "[]", '[{"position": [0, 0, 0]}]', "[1]"):
                path.write_text(text)
                with self.assertRaisesRegex(ValueError, "c.json: got no list of cameras"):
                    stream_shares.first_camera(Scene("s", "s.ply", str(path)))
        with self.assertRaisesRegex(ValueError, "builtin: got no list"):
            stream_shares.first_camera(Scene("builtin", "builtin:object"))

    def test_a_head_turns_and_moves_across(self):
        start = {"position": [1, 2, 3], "rotation": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]}
        moved = stream_shares.turned(start, 270)
        got = [[round(value, 12) for value in row] for row in moved["rotation"]]
        self.assertEqual(got, [[-1, 0, 0], [0, 1, 0], [0, 0, -1]])
        self.assertEqual(moved["position"], [1, 2, 3 - 270 * stream_shares.DISTANCE])


class Pareto(unittest.TestCase):
    def test_what_another_beats_everywhere_is_not_on_the_front(self):
        points = [(1, 9), (5, 5), (9, 1), (6, 6), (5, 6)]
        self.assertEqual(pareto_front(points), [True, True, True, False, False])

    def test_equal_points_stay_together(self):
        self.assertEqual(pareto_front([(2, 2), (2, 2), (3, 2)]), [True, True, False])


class Measures(unittest.TestCase):
    HFU = {"cfus": 4, "cfu_lanes": 4, "ffu_lanes": 16}

    def view(self, cycles: int, mm2: float, psnr_db: float | None = None) -> dict:
        return {
            "frame": {"cycles": cycles, "fps": 1000 / cycles},
            "dram": {"bytes": 70},
            "config": {"hfus": 2, "hfu": self.HFU},
            "sram": {"input_bytes": 1, "input_available_bytes": 5, "shared_available_bytes": 6},
            "area_mm2": {"total": mm2, "with_memory_interface": {"middle": mm2 + 5}},
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
            ("mm2_with_phy", 6.6),
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

    def test_a_sum_is_named_one(self):
        views = [self.view(10, 1.5), self.view(40, 1.6)]
        views = [{**view, "energy": {"total_j": n}} for n, view in enumerate(views, start=1)]
        for text, name, value in (
            ("cycles", "sum(cycles)", 50),
            ("joules", "sum(joules)", 3),
            ("joules_mean", "joules_mean", 1.5),
            ("mean(joules)", "mean(joules)", 1.5),
            ("mm2", "mm2", 1.6),
            ("sum(cycles)", "sum(cycles)", 50),
        ):
            with self.subTest(text):
                found = measures.measure(text)
                self.assertEqual((found.text, found.of(views)), (name, value))
        self.assertEqual(measures.requirement("joules <= 3").name, "sum(joules) <= 3")

    def test_joules_without_the_memory_s_are_no_number(self):
        energy = {"total_j": 3, "mean_power_w": 4, "memory_known": False}
        view = {**self.view(10, 1.5), "energy": energy, "memory_interface": {"memspec": "mine"}}
        for text in ("joules", "max(watts)", "mean(energy.mean_power_w)"):
            with self.subTest(text), self.assertRaisesRegex(ValueError, "known: mine does not"):
                measures.measure(text).of([view])
        self.assertEqual(measures.measure("cycles").of([view]), 10)
        for text in ("fps", "frame.fps", "psnr_db", "watts"):
            with self.subTest(text), self.assertRaisesRegex(ValueError, r"expected min\("):
                measures.measure(text)

    def test_the_upper_end_of_the_area(self):
        view = self.view(10, 4.1)
        view["area_mm2"]["bands"] = {"total": {"low": 3.0, "middle": 4.1, "high": 6.2}}
        required = measures.requirement("mm2_high <= 5")
        self.assertAlmostEqual(required.violation([view]), 0.24)
        self.assertTrue(required.measure.is_of_the_machine())
        self.assertEqual(required.missed_in_words(), "too large")

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

    def scenes(self) -> list[dict]:
        """One of two views, one of one."""
        cycles = {("a", 0): 10, ("a", 1): 30, ("b", 0): 80}
        views = [{**self.view(n, 1.5, n / 2), "view": v} for (_, v), n in cycles.items()]
        return [{**view, "scene_name": name} for view, (name, _) in zip(views, cycles)]

    def test_a_scene_counts_once(self):
        self.assertAlmostEqual(measures.objective("geomean(cycles)").cost(self.scenes()), 40)
        for text in ("20", "40", "50"):
            with self.subTest(text):
                required = measures.requirement(f"each(cycles) <= {text}")
                # Of the means 20 and 80 the worst.
                self.assertAlmostEqual(required.violation(self.scenes()[:2]), 20 / float(text) - 1)
                self.assertAlmostEqual(required.violation(self.scenes()), 80 / float(text) - 1)

    def test_what_is_required_beside_a_configuration(self):
        reference = self.scenes()
        slower = [
            {**view, **self.view(2 * view["frame"]["cycles"], 3, view["image"]["psnr_db"] - 1)}
            for view in reference
        ]
        for text, violation in (
            ("mm2 <= 1 x paper", 1.0),
            ("mm2 <= 2 x paper + 1", -0.25),
            ("geomean(cycles) <= 1 x paper", 1.0),
            # Of a: 9 dB for 10 less 0.5; of b 39 for 39.5.
            ("each(psnr_db) >= 1 x paper - 0.5", 0.5 / 9.5),
            ("each(psnr_db) >= 1 x paper - 1", 0.0),
        ):
            with self.subTest(text):
                required = measures.requirement(text)
                self.assertEqual(required.reference, "paper")
                required = required.relative_to(reference)
                self.assertAlmostEqual(required.violation(slower), violation)
        equal = [{**view, "image": {"psnr_db": None}} for view in reference]
        required = measures.requirement("each(psnr_db) >= 1 x paper - 0.1").relative_to(equal)
        self.assertEqual((required.violation(equal), required.room(equal)), (0, 0))

    def test_room(self):
        views = [self.view(10, 1.5), self.view(40, 1.6)]
        for text, room in (
            ("min(fps) >= 12.5", math.log(2)),
            ("min(fps) >= 50", -math.log(2)),
            ("max(cycles) <= 80", math.log(2)),
            ("max(cycles) <= 20", -math.log(2)),
            ("min(fps) >= 0", 25),
        ):
            with self.subTest(text):
                self.assertAlmostEqual(measures.requirement(text).room(views), room)

    def test_what_is_none(self):
        for text, what in (
            ("min(fps) >= x paper", "--require: 'x paper', expected a number, or one x CONFIG"),
            ("mm2 <= nan x paper", "--require: 'nan x paper', expected a number"),
            ("mm2 <= 1 x paper - b", "--require: '1 x paper - b', expected a number"),
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
        (axis,) = parse_axis("hfus=2,4")
        self.assertEqual(axis.settings, (("hfus=2",), ("hfus=4",)))
        for bad in ("hfus", "=2", "hfus=", "hfus=2,"):
            with self.assertRaises(ValueError):
                parse_axis(bad)

    def test_points_of_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "points"
            path.write_text("hfus=2 group=64 # small\n\n# none\nhfus=4\n")
            (axis,) = read_points(path)
            group = ("group_width_px=64", "group_height_px=64")
            self.assertEqual(axis.settings, (("hfus=2", *group), ("hfus=4",)))
            path.write_text("hfus=2\nhfus 4\n")
            with self.assertRaisesRegex(ValueError, ":2: 'hfus'"):
                read_points(path)
            path.write_text("# none\n")
            with self.assertRaisesRegex(ValueError, "points: no configurations"):
                read_points(path)

    def test_of_axes(self):
        axes = parse_axes(["hfus=2,4", "group=32,64x16,96"])
        both = Space(axes)
        self.assertEqual((both.size(), both.keys()), (6, ("hfus", "group")))
        self.assertEqual(list(both.all())[:4], [(0, 0), (0, 1), (0, 2), (1, 0)])
        self.assertEqual(set(both.neighbours((0, 1))), {(1, 1), (0, 0), (0, 2)})
        setting = ("hfus=4", "group_width_px=64", "group_height_px=16")
        self.assertEqual(both.assignments((1, 1)), setting)

    def test_a_search_can_begin_at_the_preset_itself(self):
        given = (axis("hfus", 1, 2, 4), axis("hfu.lanes", 3, 2, 1), axis("fetch", "a", "b"))
        given += (axis("sram.bytes", 1, 9), axis("clusters", 1, 2))
        config = {"hfus": 3, "hfu": {"lanes": 5}, "fetch": "c", "sram": {"bytes": 5}, "clusters": 2}
        values = [[s.partition("=")[2] for (s,) in a.settings] for a in with_own(given, config)]
        self.assertEqual(values[:2], [["1", "2", "3", "4"], ["5", "3", "2", "1"]])
        self.assertEqual(values[2:], [["a", "b"], ["1", "9"], ["1", "2"]])

    def test_axes_of_a_machine_stand_behind_those_that_are_named(self):
        given = (Axis("hfus", (("hfus=1",),)), Axis("clusters", (("clusters=1",), ("clusters=2",))))
        axes = parse_axes(["hfus=2,4"], given)
        self.assertEqual([axis.name for axis in axes], ["clusters", "hfus"])

    def test_what_is_chosen_for_each_scene(self):
        scopes = ("a", "b")
        axes = parse_axes(["hfus=2,4", "storage.chunk@each=8,16"], (), scopes)
        self.assertEqual(
            [(a.name, a.scope) for a in axes[1:]], [(f"storage.chunk@{s}", s) for s in scopes]
        )
        both = Space(axes)
        at = (1, 0, 1)
        self.assertEqual(of_scene(both.assignments(at), "b"), ("hfus=4", "storage.chunk=16"))
        self.assertEqual(both.machine(at), ("hfus=4", "storage.chunk=8"))
        self.assertEqual(both.keys(), ("hfus", "storage.chunk@a", "storage.chunk@b"))
        with self.assertRaisesRegex(ValueError, "storage.chunk@a: there are two"):
            parse_axes(["storage.chunk@each=8,16", "storage.chunk@a=4,8"], (), scopes)
        with self.assertRaisesRegex(ValueError, "storage.chunk@a: there are two"):
            parse_axes(["storage.chunk=8,16", "storage.chunk@a=4,8"], (), scopes)


class Configurations(unittest.TestCase):
    def test_shapes_of_groups(self):
        for shape, width, height in (("64", 64, 64), ("160x120", 160, 120), ("4x64", 4, 64)):
            both = (f"group_width_px={width}", f"group_height_px={height}")
            self.assertEqual(simulations.group_assignments(shape), both)
            self.assertEqual(simulations.expanded(("hfus=2", f"group={shape}")), ("hfus=2", *both))
            config = {"group_width_px": width, "group_height_px": height}
            self.assertEqual(simulations.shape_of(config), shape)
        for bad in ("", "x", "64x", "1x2x3", "-4", "big"):
            with self.assertRaises(ValueError):
                simulations.group_assignments(bad)

    def test_one_axis_at_a_time_around_the_preset(self):
        merge = {"entries": 2048, "on_overflow": "spill"}
        preset = {
            "group_width_px": 128,
            "group_height_px": 128,
            "storage": {"chunk_gaussians": 16},
            "merge": merge,
        }
        points = variants.combinations(preset, cross=False)
        # 6 sizes x 2 policies, and 3 groups and 5 chunks that are not the preset's.
        self.assertEqual(len(points), 12 + 3 + 5)
        self.assertEqual(len(set(points)), len(points))
        self.assertEqual(len(variants.combinations(preset, cross=True)), 4 * 6 * 6 * 2)

    def test_unknown_scene_is_refused_with_what_there_is(self):
        with self.assertRaisesRegex(ValueError, "nowhere: no scene; expected .*builtin:object"):
            find_scene("nowhere")

    def test_a_scene_twice_is_refused(self):
        text = "builtin:object?n=1"
        for texts in ([text, text], [text, "builtin:outdoor", text]):
            with self.assertRaisesRegex(ValueError, "n=1: got it twice, expected each scene once"):
                find_scenes(texts)

    def test_scenes_by_path(self):
        """Of any form, with cameras of any form; what is in them the program reads."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for path in ("a.spz", "a.json", "b.ply", "photographs/x", "c/meta.json", "d/b.ply"):
                (folder / path).parent.mkdir(exist_ok=True)
                (folder / path).touch()
            a, b, c, other_b = (str(folder / path) for path in ("a.spz", "b.ply", "c", "d/b.ply"))
            photographs, file = str(folder / "photographs"), str(folder / "a.json")
            for texts, cameras, expected in (
                ([a], [], [("a", file)]),
                ([a, b, c], [photographs], [(of, photographs) for of in "abc"]),
                ([a, c], [photographs, file], [("a", photographs), ("c", file)]),
                (["builtin:object", b], [file], [("builtin:object", ""), ("b", file)]),
            ):
                with self.subTest(texts=texts, cameras=cameras):
                    found = find_scenes(texts, cameras)
                    self.assertEqual([scene.spec for scene in found], texts)
                    self.assertEqual([(scene.name, scene.cameras) for scene in found], expected)
            for texts, cameras, said in (
                ([b], [], "b.ply: expected its cameras in .*/b.json, or by --cameras"),
                ([c], [], "c: expected its cameras in .*/c.json, or by --cameras"),
                ([b], ["nowhere"], "--cameras: nowhere: not there"),
                (["builtin:object"], [file], "--cameras: got 1 for 0 scenes that are paths"),
                ([a, b, c], [file] * 2, "--cameras: got 2 for 3 scenes that are paths"),
                ([b, other_b], [file], "d/b.ply: named b as .*b.ply is, expected another name"),
            ):
                with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                    find_scenes(texts, cameras)


class Stability(unittest.TestCase):
    """Rows of a study that is whole at its first two places, and infinite at its last."""

    STUDY = {
        "formula": "x",
        "form": "as written",
        "arithmetic": "float",
        "axis": "size",
        "unit": "of x",
        "law": "u",
        "why": "Too large.",
        "breaks_at": 1e6,
        "places": [
            {"place": 1, "error": 1e-7, "bound": 2e-7, "error_over_bound": 0.5, "law": 1e-6},
            {"place": 1000, "error": 3e-3, "bound": None, "error_over_bound": 0.1, "law": None},
            {"place": 1e6, "error": None, "bound": None, "error_over_bound": 0, "law": None},
        ],
    }

    def test_a_row_tells_of_what_comes_before_it_breaks(self):
        row = stability.stability_row(self.STUDY)
        self.assertEqual(row[3:9], ("size 1 .. 10^6", 3e-3, "of x", None, "u", "10^6"))
        whole = self.STUDY | {"breaks_at": None, "places": self.STUDY["places"][:1]}
        row = stability.stability_row(whole)
        self.assertEqual(row[3:9], ("size 1 .. 1", 1e-7, "of x", 2e-7, "u", "nowhere"))

    def test_never_whole(self):
        broken = self.STUDY | {"breaks_at": 1000, "places": self.STUDY["places"][1:]}
        self.assertEqual(stability.stability_row(broken)[4], 3e-3)

    def test_every_place_is_in_the_csv(self):
        rows = stability.place_rows(self.STUDY)
        self.assertEqual(rows[1][5:], (1000, 3e-3, None, 0.1, None))
        self.assertEqual(len(rows), 3)


class Power(unittest.TestCase):
    @staticmethod
    def energy(**joules: float) -> dict:
        """With each component from half to three times its middle; the clock without a band."""
        bands = {
            f"{name}_j": {"low": j, "middle": j, "high": j}
            if name == "clock"
            else {"low": j / 2, "middle": j, "high": 3 * j}
            for name, j in joules.items()
        }
        ends = {end: sum(band[end] for band in bands.values()) for end in ("low", "middle", "high")}
        middle = {key: band["middle"] for key, band in bands.items()}
        return {**middle, "total_j": ends["middle"], "bands": {**bands, "total_j": ends}}

    def view(self, **joules: float) -> dict:
        rest = self.energy(dram=1.0)
        area = {"fine": 1.0, "sram": 1.0, "total": 2.0}
        energy = self.energy(**joules)
        # PHY and controller take 1, 2, 4 J of a frame and as much of a rest.
        of_interface = {"low": 1, "middle": 2, "high": 4}
        total = energy["bands"]["total_j"]
        energy["with_memory_interface_j"] = {end: total[end] + j for end, j in of_interface.items()}
        watts = {
            end: 60 * (total[end] + rest["bands"]["total_j"][end] + 2 * j)
            for end, j in of_interface.items()
        }
        rates = [
            {"per_s": 60.0, "held": True, "rest": rest, "with_memory_interface_w": watts},
            {"per_s": 90.0, "held": False},
        ]
        return {
            "frame": {"fps": 70.0},
            "area_mm2": area,
            "energy": energy,
            "fixed_rates": rates,
        }

    def test_a_rate_that_is_not_held_has_no_power(self):
        alone, at_60, at_90 = power.spent_by_rate(self.view(fine=2.0, dram=4.0))
        self.assertEqual((alone[0].rate, alone[0].middle, alone[0].rest), (70, 6, 0))
        self.assertEqual((alone[1].low, alone[1].middle, alone[1].high), (4, 8, 22))
        without = at_60[0]
        self.assertEqual((without.middle, without.rest, without.low, without.high), (7, 1, 3.5, 21))
        watts = (420, 210, 1260, 60 * 11, 60 * 5.5, 60 * 29)
        self.assertEqual(power.cells(at_60), (7 / simulations.MJ, 1 / 7, *watts))
        self.assertIsNone(at_90)
        row = power.power_row("x", 90, at_90, at_60)
        self.assertEqual(row[2:10], (None,) * 8)
        self.assertEqual(row[-6:], (None,) * 6)
        row = power.power_row("x", 60, at_60, at_60)
        self.assertEqual((len(row), row[-6:]), (len(power.POWER_COLUMNS), (1,) * 6))

    def test_a_source_of_error_stands_at_one_end_in_both_machines(self):
        ours, others = (
            power.spent_by_rate(self.view(fine=fine, dram=dram, clock=1.0))[0][0]
            for fine, dram in ((2.0, 4.0), (4.0, 2.0))
        )
        self.assertEqual(power.gain_band(ours, ours), (1, 1, 1))
        # Least with logic at its low end and DRAM at its high one, most the other way round.
        self.assertEqual(
            power.gain_band(ours, others), (1, (2 + 6 + 1) / (1 + 12 + 1), (12 + 1 + 1) / 9)
        )

    def test_the_memorys_interface_is_a_source_of_error_of_its_own(self):
        ours, others = (power.spent_by_rate(self.view(fine=fine))[0][1] for fine in (2.0, 6.0))
        # Least with logic at its low end and the interface at its high one.
        self.assertEqual(power.gain_band(ours, others), (2, (3 + 4) / (1 + 4), (18 + 1) / (6 + 1)))

    def test_over_scenes_a_source_stands_at_one_end_as_well(self):
        """Two scenes whose logic and DRAM change places: what one loses the other one gains."""
        views = [self.view(fine=2.0, dram=4.0), self.view(fine=4.0, dram=2.0)]
        row = power.gain_row(("a", "b"), {"a": views, "b": views[::-1]})
        self.assertEqual(row[0], "a / b")
        for cell in row[1:4]:
            self.assertAlmostEqual(cell, 1)
        self.assertAlmostEqual(row[4], (2 + 6) / (1 + 12))


class Areas(unittest.TestCase):
    ROWS = {
        "lane": {"mm2": {"middle": 100e-6}, "register_bits": 64},
        "comparator": {"mm2": {"middle": 10e-6}, "register_bits": 0},
        "exchange_bit": {"mm2": {"middle": 2e-6}, "register_bits": 0},
        "clock_gate": {"mm2": {"middle": 3e-6}, "register_bits": 0},
    }
    VIEW = {
        "config": {"rendering": {"clusters": 2}},
        "provenance": {"configuration": "mine"},
        "datapath": {
            "subtile_blend": {
                "lane": "lane",
                "lanes": 8,
                "beside": {"comparator": {"parts": 4, "operations": 9}},
                "used": {"macs": 24, "interval_cycles": 4},
            }
        },
        "ledger": {
            "lines": [
                {"what": "sorting: comparator", "per_cycle": 20},
                {"what": "sorting: exchange_bit", "per_cycle": 700},
                {"what": "key sorters: reads", "per_cycle": 1},
            ]
        },
        "area_mm2": {
            **{"ccu": 2.3, "lists": 0.2, "qsu": 0.1, "bsu": 0.3, "rendering": 2.53},
            **{"sram": 1.0, "memory_path": 0.1, "total": 5.53},
        },
    }

    def test_of_a_pixel_a_cycle(self):
        area, ours = areas.blend_row(self.VIEW, self.ROWS)
        # 8 lanes with 2 gates each and 4 comparators; 2 x 16 pixels every 4 cycles.
        self.assertAlmostEqual(area, (8 * (100 + 2 * 3) + 40) / 8)
        self.assertIn("mine: 1.5 multiply-accumulates on lane", ours)

    def test_of_a_compare_exchange(self):
        area, ours = areas.sorting_row(self.VIEW, self.ROWS)
        self.assertAlmostEqual(area, 2 * 10 + 70 * 2)  # 10 of them
        self.assertIn("keys of 64 bits, places of 6", ours)

    def test_registers_that_are_shared(self):
        technology = {"parts": {**self.ROWS, "register_bit": self.ROWS["lane"]}}
        folded = {"parts": 120, "operations": 90}
        datapaths = {
            "folded": {
                "lanes": 6,
                "beside": {"register_bit": folded},
                "used": {"macs": 11, "interval_cycles": 4},
            },
            "a lane a step": {
                "lanes": 6,
                "beside": {"register_bit": folded},
                "used": {"macs": 3, "interval_cycles": 1},
            },
        }
        (row,) = areas.sharing_rows("mine", {"datapath": datapaths}, technology)
        # Two copies of three lanes.
        self.assertEqual(row[:5], ("mine", "folded", 2, 60, 0.5))
        self.assertAlmostEqual(row[5], 60 * (100 + 2 * 3) * 1e-6)

    def test_beside_gscore(self):
        rows = {part: of for part, *of in areas.gscore_rows(self.VIEW)}
        self.assertEqual(rows["VRUs"], [2.53, 2.53, 0])
        self.assertAlmostEqual(rows["CCUs"][2], 1)
        self.assertEqual(rows["tile tests, lists"], [0.2, None, None])
        self.assertAlmostEqual(rows["QSUs, BSUs"][0], 0.4)
        self.assertEqual(rows["all"][2], 0)
        parts = sum(of for _, _, of in areas.GSCORE_PARTS[:-1] if of)
        self.assertAlmostEqual(parts, areas.GSCORE_PARTS[-1][2])
        self.assertAlmostEqual(areas.TO_32NM * 3.95, areas.GSCORE_PARTS[-1][2], places=2)


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
                self.assertEqual(simulations.binders(views), text)

    def test_components_of_energy_hold_every_joule(self):
        keys = ("vsu_j", "merge_j", "pixel_state_j", "input_j", "clock_j", "sram_leakage_j")
        middles = {key: 2.0**n for n, key in enumerate((*keys, "dram_j"))}
        view = {
            "area_mm2": {"vsu": 1, "merge": 1, "sram": 1, "total": 3, "bands": {}, "by_owner": {}},
            "energy": {**middles, "dram_by_region_j": {"spill": 1.0}, "bands": {}},
        }
        rows = cases.components(view)
        self.assertEqual(rows["SRAM: pixels"], ("pixel_state_j",))
        self.assertEqual(rows["SRAM: all else"], ("input_j",))
        summed = [cases.joules_of(view, of) for name, of in rows.items() if name != "all"]
        self.assertEqual(sum(summed), 2.0**7 - 1)

    def test_the_ordering_table_grows_with_the_group(self):
        config = {"group_width_px": 64, "group_height_px": 64, "vsu": {"table_bytes": 4096}}
        for shape, expected in (("16", 4096), ("64", 4096), ("128", 16384), ("160x120", 19200)):
            with self.subTest(shape):
                keys = simulations.group_assignments(shape)
                made = frame_costs.table_bytes(config, keys)
                self.assertEqual(made, (f"vsu.table_bytes={expected}",))
                self.assertEqual(frame_costs.table_bytes({"vsu": {}}, keys), ())

    def test_whether_the_named_resource_gains_most(self):
        for gains, most, noise in (
            ((0.2, 0.1), True, ""),
            ((0.1, 0.2), False, ""),
            ((0.004, 0.2), False, "a"),
            ((0.001, 0.004), True, "a, b"),
        ):
            doubled = [
                {"key": key, "time_saved": gain, "time_below_noise": gain < 0.005}
                for key, gain in zip("ab", gains)
            ]
            base = {"cycles": 1e6, "holds_key": "a"}
            answer = {"view": 0, "base": base, "doubled": doubled}
            answer |= {"named_gains_most": most, "verdict": "why"}
            with self.subTest(gains):
                row = frame_costs.binding_row("x", answer)
                self.assertEqual(row[4], gains[0])
                self.assertEqual(row[6:], (max(gains), most, noise, "" if most else "why"))


class Choices(unittest.TestCase):
    """What choices.json lists, and what its cells are."""

    LISTED = json.loads(choices.LISTED.read_text())
    PAGES = ("modules/streaminggs", "modules/gscore", "modules/dram", "algorithm/memory")

    def test_settings_are_keys_and_presets_are_there(self):
        pages = [(REPOSITORY / page / "KEYS.md").read_text() for page in self.PAGES]
        keys = {key for page in pages for key in re.findall(r"^\| `([\w.]+)`", page, re.MULTILINE)}
        presets = {path.stem for path in variants.CONFIGS.glob("*.json")}
        for of in choices.listed().values():
            named = re.findall(r"{([\w.]+)}", of.about)
            for runs in of.runs:
                with self.subTest(of.name, presets=runs.presets):
                    text = " ".join([runs.set, *runs.rows])
                    given = {setting.partition("=")[0] for setting in text.split()}
                    self.assertLessEqual({*given, *named}, keys | {simulations.GROUP})
                    self.assertLessEqual(set(runs.presets), presets)

    def test_nothing_stands_there_twice_or_for_nobody(self):
        names = [of["name"] for of in self.LISTED["tables"]]
        self.assertEqual(len(set(names)), len(names))
        texts = [path.read_text() for path in results.markdown_files(REPOSITORY)]
        for of in choices.listed().values():
            with self.subTest(of.name):
                place = f"<!-- table: {of.name} -->"
                self.assertEqual(sum(text.count(place) for text in texts), 1)
                with mock.patch.object(choices, "find_scene", lambda name: Scene(name, name)):
                    rows = [(row.run, row.at) for row in choices.asked(of)]
                self.assertEqual(len(set(rows)), len(rows))
        used = {column.name for of in choices.listed().values() for column in of.columns}
        self.assertEqual(used, set(self.LISTED["columns"]))

    def view(self, cycles: int, spilled: int) -> dict:
        """Of four Gaussians of 16 and 40 B, in a frame of 30 B."""
        regions = {"first_halves": 70, "second_halves": 160, "spill": spilled, "frame_buffer": 30}
        requested = {name: {"unit": {"read": count}} for name, count in regions.items()}
        return {
            "frame": {"cycles": cycles},
            "scene": {"second_half_bytes": 40},
            "limit": {"contributing_gaussians": 4, "bytes_read_once": 4 * 56 + 30},
            "dram": {
                "bytes_by_region": requested,
                "bus_bytes_by_region": {"spill": spilled},
                "row_hits": 3,
                "row_misses": 1,
                "row_conflicts": 2,
            },
            "units": {"vsu": {"waited": 2}},
            "datapath": {"fine": {"macs": 9}},
        }

    def test_cells(self):
        run = simulations.Run(Scene("truck", "truck.ply"), size="64x36")
        before, after = self.view(8, 0), self.view(10, 127)
        of = choices.Measured(run, "hfus=4", "datapath.fine", after, before)
        for text, expected in (
            ("scene", "truck"),
            ("size", "64x36"),
            ("settings", "hfus=4"),
            ("part", "fine"),
            ("frame.cycles", 10),
            (".macs", 9),
            ("of_preset:frame.cycles", 8),
            ("change:frame.cycles", 25),
            ("of_frame:units.vsu.waited", 20),
            ("row_hits", 50),
            ("bus_mb:spill", 127e-6),
            ("over_limit:first_halves", 6 / 254),
            ("over_limit:second_halves", 0),
            ("over_limit:spill", 0.5),
        ):
            with self.subTest(text):
                self.assertEqual(choices.value(of, text), expected)
        for text, said in (("frame.nope", "nope: not in the report"), ("change:units", "got {")):
            with self.subTest(text), self.assertRaisesRegex(ValueError, said):
                choices.value(of, text)


class Validation(unittest.TestCase):
    """What programs beside the command print, and formulas."""

    def test_streams_stand_in_the_order_of_their_file(self):
        seq = {"pattern": "sequential", "bytes": 64, "bound": 6.2, "dramsim3": 6.1}
        stride = {"pattern": "stride", "bytes": 32, "stride": 4096, "ramulator_mean_ns": 9}
        writes = {"pattern": "random", "bytes": 64, "write_percent": 30, "window": 1}
        published = {"one_channel": [seq], "four_channels": [stride, writes]}
        line = "{} |  {}  0.991  95.6      335/320/492   274    280..324   5.7   1798 | a | b"
        lines = [line.format(name, gb_s) for name, gb_s in (("s", 6), ("4 KB t", 5), ("u", 4))]
        ours = [335, 274, 280, 324]
        rows = memory_validation.stream_rows("\n".join(["stream | ours", *lines]), published)
        self.assertEqual(rows["one_channel"], [["seq 64 B", 6.2, 6, *ours, 6.1, None, None, None]])
        first, second = rows["four_channels"]
        self.assertEqual(first, ["stride 4 KB", None, 5, *ours, None, None, None, 9])
        self.assertEqual(second[:3], ["random 64 B, 30 % writes, window 1", None, 4])
        with self.assertRaisesRegex(ValueError, "got 1 streams, expected 3 of published.json"):
            memory_validation.stream_rows(lines[0], published)

    def test_memories_stand_beside_their_bounds(self):
        pairs = "    ".join(f"{at}.5/{at + 9}.0 " for at in range(6))
        parts = memory_validation.part_values(f"memspec  peak seq\nlpddr3  6.400  {pairs}\n")
        row = memory_validation.part_row("lpddr3", *parts["lpddr3"])
        self.assertEqual(row, ("lpddr3", 6.4, 0.5, 1.5, 2.5, 11, 3.5, 12, 4.5, 5.5))
        with self.assertRaisesRegex(ValueError, "got no memory"):
            memory_validation.part_values("memspec peak")

    def test_every_foreign_memory_is_one_of_ours(self):
        for of in json.loads(memory_validation.SIMULATED.read_text())["beside"]:
            with self.subTest(of["memspec"], simulator=of["simulator"]):
                self.assertTrue((memory_validation.MEMSPECS / f"{of['memspec']}.json").exists())
                self.assertEqual(len(of["gb_s"]), len(memory_validation.STREAMS))

    def test_pictures_of_codebooks(self):
        kinds = (f" {kind}, dB | s |" for kind in ("plain", "a, b", "c", "d"))
        head = f"PSNR\n| scene | SH degree |{''.join(kinds)}\n| --- |\n"
        line = "| a | 3 | 1.5 2.5 | 9.0 | 3 4 | 9 | 5 6 | 9 | 7 8 | 9 |"
        rows = bench_validation.quantisation_rows(head + line)
        self.assertEqual(len(rows), 2 * 4)
        self.assertEqual(rows[1], ("a", 3, "plain", 1, 2.5))
        self.assertEqual(rows[3], ("a", 3, "a, b", 1, 4))
        with self.assertRaisesRegex(ValueError, "expected a table of 10 columns"):
            bench_validation.quantisation_rows(head + "| a | 3 |")

    def test_pictures_of_arithmetics(self):
        head = f"PSNR\n| view | {' | '.join('abcdef')} |\n| --- |\n"
        cells = " | ".join(f"{at}.5, {at}.6" for at in range(6))
        rows = bench_validation.precision_rows(f"{head}| a b 3 | {cells} |\n")
        self.assertEqual(len(rows), 6 * 2)
        self.assertEqual(rows[3], ("a b", 3, "b", "reached by the ellipse", 1.6))

    def test_programs_beside_the_command(self):
        line = "/x/tb_dram: not there; scripts/setup.sh release tb_dram builds it"
        with self.assertRaisesRegex(ValueError, line):
            beside.beside(pathlib.Path("/x/streaminggs"), "tb_dram")
        shell = pathlib.Path("/bin/sh")
        self.assertEqual(beside.printed(shell, ["-c", "echo a; echo b >&2"]), "a\n")
        for status, kind, said in ((2, ValueError, "^c$"), (1, Failure, "sh: exit status 1: a c")):
            with self.subTest(status), self.assertRaisesRegex(kind, said):
                beside.printed(shell, ["-c", f"echo a; echo b >&2; echo c >&2; exit {status}"])

    def test_limits_of_tuning(self):
        row = "| s | all | 0.1 | 0.2 | 10^1: 0.3 | {} | {} | {} |"
        for cells, expected in (
            (("10^2", f"10^3: step 4: x {validation.BEYOND}", "yes"),)
            + ((100, 1000, "step 4: x beyond the limits", True),),
            (("10^20", "never", "NO"), (1e20, None, "", False)),
            (("none", "10^0: why", "yes"), (None, 1, "why", True)),
        ):
            with self.subTest(cells):
                head = f"{'| x ' * 8}|\n|---|\n"
                (found,) = validation.limit_rows(head + row.format(*cells))
                self.assertEqual(found, ("s", "all", 0.1, 0.2, 10, 0.3, *expected))

    def test_the_formula_of_memories(self):
        """16 bits, 4 at once: one port has 16 x 2 + 4 x 3 um2 and takes 4 (1 + 4) + 3 x 4 pJ."""
        sram = {"um2_bit": 2, "um2_width": 3, "pj_width": 1, "pj_cell": 1, "pj_decode": 3}
        sram["second_port"] = {"middle": 2.5}
        point = {"bits": 16, "width_bits": 4, "ports": 1, "um2": 80, "um2_scale": 0.5}
        point |= {"pj": 0, "pj_scale": 1}
        both = {**point, "ports": 2, "um2": 0, "pj": 64, "pj_scale": 0.5}
        sram["points"] = {"cacti45_4x4": point, "cacti22_4x4": both}
        sram["pairs"] = {"ihp130_4x4": {"bits": 16, "width_bits": 4, "one_um2": 1, "two_um2": 2}}
        rows = list(validation.sram_rows(sram))
        self.assertEqual([row[1] for row in rows], ["4 x 4 bit"] * 3)
        for row, area, energy in zip(rows, (10, None, 25), (None, 0, None)):
            for got, expected in zip(row[2:], (area, energy)):
                self.assertEqual(got if got is None else round(got, 9), expected, row)
        known = json.loads(validation.TECHNOLOGY.read_text())["sram"]
        count = len(known["points"]) + len(known["pairs"])
        self.assertEqual(len(list(validation.sram_rows(known))), count)

    def test_the_gpu_beside_what_is_published(self):
        moved = {"scene_bytes": 1, "intermediate_bytes": 2, "frame_bytes": 1}
        seconds = {"sort": 1, "ranges": 1, "rendering": 6}
        stages = [{"name": name, "seconds": of, **moved} for name, of in seconds.items()]
        view = {"seconds": 0.25, "joules": 2, "stages": stages}
        rows = list(gpu_validation.gpu_rows([view], [view, {**view, "seconds": 0.5}], [view], "s"))
        found = {row[2]: row[4:] for row in rows}
        self.assertEqual(found["intermediate bytes"][:3], (85, 50, 50))
        self.assertEqual(found["rate"][:3], (13, 2, 4))
        self.assertEqual(found["time of sort and ranges"], (21, 25, 25, "s"))


if __name__ == "__main__":
    unittest.main()
