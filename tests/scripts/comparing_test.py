"""Machines beside each other: what their tables compute."""

import argparse
import dataclasses
import math
import unittest

import in_folder  # noqa: F401, isort: skip (finds the scripts)
import compare_machines
import design_point_seconds
import machine_cases
import machine_measures
import machine_ratios
import machine_tables
from runs.scenes import Scene


def measured(*seconds: float, region: float = 0) -> machine_measures.Measured:
    """Whose busiest resource works half of the time."""
    return machine_measures.Measured(
        seconds=seconds,
        busiest_seconds=tuple(s / 2 for s in seconds),
        joules=seconds,
        bytes_by_region={"spill": region},
        joules_by_component={},
        busy={},
        peak_gb_s=25.6,
        precision="fp16",
        mm2=2,
    )


class Machines(unittest.TestCase):
    def test_a_scene_counts_once_whatever_its_sizes_and_views(self):
        """Of one scene the other takes 2 and 8 times as long: 4. Of another one, 1 time: 2."""
        found = {
            "two sizes": [
                {"own": measured(1, 3), "other": measured(3, 5)},
                {"own": measured(1), "other": measured(8)},
            ],
            "one": [{"own": measured(1), "other": measured(1)}],
        }
        row = machine_ratios.row("25.6", "all", found, "own", "other")
        of = dict(zip(machine_ratios.HEAD, row, strict=True))
        self.assertEqual((of["scenes"], of["cases"], of["times as fast"]), (2, 3, "2.00"))
        self.assertEqual((of["of views"], of["times less energy"]), ("1.00 .. 8.00", "2.00"))
        self.assertEqual((of["published speed"], of["mm2 over mm2"]), ("", "1.00"))

    def test_ratios_of_one_case(self):
        """Columns by what the two are; the other takes four times as long in either view."""
        own, other = measured(1, 2), measured(4, 8)
        for changed, by_other, columns in (
            ({}, {}, {"times as fast": "4.00", "both overlapped": "4.00", "precision": "fp16"}),
            # The machine that is never idle gains nothing from overlapped frames; the other twice.
            (
                {"busiest_seconds": (1, 2)},
                {},
                {
                    "times as fast": "4.00",
                    "of views": "4.00 .. 4.00",
                    "both overlapped": "2.00",
                    "of views, both overlapped": "2.00 .. 2.00",
                    "only the other overlapped": "2.00",
                },
            ),
            (
                {},
                {"busiest_seconds": (1, 8)},
                {
                    "both overlapped": "6.00",  # 4.5 s over 0.75 s
                    "of views, both overlapped": "2.00 .. 8.00",
                    "only the other overlapped": "3.00",
                    "of views, only the other overlapped": "1.00 .. 4.00",
                },
            ),
            (
                {"decibels": (41.26, 39.0)},
                {"decibels": (math.inf, 58.0)},
                {"dB": "39.0 .. 41.3", "its dB": "58.0 .. equal"},
            ),
            (
                {"decibels": (math.inf, math.inf)},
                {},
                {"dB": "equal", "its dB": "not measured", "the other is": "simulated"},
            ),
            (
                {"precision": "fp32"},
                {},
                {
                    "precision": "fp32, its fp16",
                    "the other is": "simulated, in another precision",
                },
            ),
            (
                {"encoding": "vq_packed"},
                {},
                {"precision": "fp16 from codebooks, its fp16", "the other is": "simulated"},
            ),
        ):
            with self.subTest(columns=columns):
                of_case = {
                    "own": dataclasses.replace(own, **changed),
                    "other": dataclasses.replace(other, **by_other),
                }
                made = machine_ratios.row("25.6", "all", {"s": [of_case]}, "own", "other")
                of = dict(zip(machine_ratios.HEAD, made, strict=True))
                self.assertEqual({name: of[name] for name in columns}, columns)

    def test_what_is_published_stands_beside_all_sizes_and_says_what_is_derived(self):
        gpu = dataclasses.replace(measured(1, 2), joules=(5, 10), precision="fp32")
        of_case = {"gscore": measured(1, 1), "paper": measured(1, 1), machine_ratios.GPU: gpu}
        for own, sizes, speed, joules in (
            ("paper", "all", "45.7", "62.9"),
            ("gscore", "all", "21.6", "27.3 derived"),
            ("gscore", "64x36", "", ""),
        ):
            with self.subTest(own, sizes=sizes):
                found = {"s": [of_case]}
                made = machine_ratios.row("25.6", sizes, found, own, machine_ratios.GPU)
                of = dict(zip(machine_ratios.HEAD, made, strict=True))
                self.assertEqual((of["published speed"], of["published energy"]), (speed, joules))
                said = "modelled; joules derived: 5 W x its time"
                self.assertEqual(of["the other is"], said)

    def test_which_machines_are_held_against_each_other(self):
        kinds = {
            "gscore": ("fp16", "raw"),
            "gscore_lossless": ("fp32", "raw"),
            "paper": ("fp16", "vq"),
            "exact": ("fp32", "raw"),
            "exact_fp16": ("fp16", "raw"),
            "exact_vq": ("fp32", "vq"),
        }
        of = {
            name: dataclasses.replace(measured(1), precision=precision, encoding=encoding)
            for name, (precision, encoding) in kinds.items()
        }
        pairs = machine_ratios.pairs_of(of, list(kinds))
        self.assertEqual(pairs[: len(kinds)], [(name, machine_ratios.GPU) for name in kinds])
        self.assertEqual(
            pairs[len(kinds) :],
            [
                ("paper", "gscore"),
                ("exact_fp16", "gscore"),
                ("exact", "gscore_lossless"),
                ("exact", "gscore"),
            ],
        )
        few = machine_ratios.pairs_of(of, ["exact", "exact_vq", "gscore_lossless"])
        self.assertEqual(few[3:], [("exact", "gscore_lossless")])

    def test_a_line_for_each_case_and_memory_of_pairs_that_lose_the_same(self):
        case = machine_cases.Case(Scene("s", "a"), "4x2")
        faster = dataclasses.replace(measured(1), peak_gb_s=51.2, binds="dram")
        entries = [
            machine_tables.Entry(case, name, of)
            for name, of in (
                ("gscore_lossless", measured(6, region=3e6)),
                ("exact", measured(2, 2, region=1e6)),
                ("exact_fp16", measured(1)),
                ("gscore_lossless", dataclasses.replace(faster, seconds=(2.5,))),
                ("exact_fast", faster),
                (machine_ratios.GPU, measured(30)),
            )
        ]
        place = ("s", "4x2")
        self.assertEqual(
            machine_ratios.case_rows(entries, [case]),
            [
                # fmt: off
                (*place, "25.6", "exact", "gscore_lossless", "3.00", "3.00", "1.50", "3.00",
                 "1.00", "3.00", "", ""),
                (*place, "51.2", "exact_fast", "gscore_lossless", "2.50", "1.00", "0.50", "1.00",
                 "0.00", "0.00", "dram", "dram"),
                # fmt: on
            ],
        )

    def test_a_line_for_each_size_and_one_for_all(self):
        arguments = argparse.Namespace(sizes=["4x2", "8x4"], object_sizes=["4x2", "6x6"])
        scenes = [Scene("outside", "a"), Scene("truck", "b")]
        cases = [
            machine_cases.Case(scene, size)
            for scene in scenes
            for size in machine_cases.sizes_of(scene.name, arguments)
        ]
        groups = compare_machines.size_groups(cases, arguments)
        self.assertEqual(list(groups), ["4x2", "6x6, 8x4", "all"])
        times = (3, 9, 12, 9)
        entries = [
            entry
            for case, seconds in zip(cases, times)
            for entry in (
                machine_tables.Entry(case, "gscore", measured(seconds)),
                machine_tables.Entry(case, "exact", measured(3)),
                machine_tables.Entry(
                    case,
                    machine_ratios.GPU,
                    dataclasses.replace(measured(30), peak_gb_s=102.4),
                ),
            )
        ]
        rows = machine_ratios.rows(entries, groups, ["gscore", "exact"])
        head = machine_ratios.HEAD
        found = [dict(zip(head, row, strict=True)) for row in rows]
        over_gscore = {
            row["sizes"]: (row["cases"], row["times as fast"])
            for row in found
            if (row["machine"], row["than"]) == ("exact", "gscore")
        }
        # Outside 1 and 3, truck 4 and 3: by scene their geometric means.
        self.assertEqual(
            over_gscore, {"4x2": (2, "2.00"), "6x6, 8x4": (2, "3.00"), "all": (4, "2.45")}
        )
        alone = argparse.Namespace(sizes=["4x2"], object_sizes=["6x6"])
        self.assertEqual(list(compare_machines.size_groups([cases[0]], alone)), ["all"])

    def test_how_long_the_busiest_works(self):
        view = {"frame": {"time_s": 4e-3}, "binding": {"utilisation": 0.75}}
        self.assertAlmostEqual(machine_measures.busiest_seconds(view), 3e-3)
        stages = [("bytes", 2), ("instructions", 4), ("bytes", 3)]
        gpu = {"stages": [{"bound_by": bound, "seconds": s} for bound, s in stages]}
        self.assertEqual(machine_measures.busiest_of_kernels(gpu), 5)
        m = dataclasses.replace(measured(1, 3), busiest_seconds=(0.5, 1.5))
        self.assertEqual((m.frames_a_second(), m.most_frames_a_second()), (0.5, 1))

    def test_seconds_add_up_as_they_are_printed(self):
        case = machine_cases.Case(Scene("s", "a"), "4x2")
        for seconds, simulating, printed in (
            (1.86, 1.02, ("0.9", "1.0", "1.9")),
            (0.34, 0.26, ("0.0", "0.3", "0.3")),
            (12.94, 8.66, ("4.2", "8.7", "12.9")),
        ):
            with self.subTest(seconds):
                timed = design_point_seconds.Timed(case, "exact", 25.6, seconds, simulating)
                self.assertEqual(timed.row()[-3:], printed)

    def test_parts_are_means_over_the_scenes(self):
        a, b = Scene("a", "a"), Scene("b", "b")
        entries = [
            machine_tables.Entry(machine_cases.Case(scene, size), "m", measured(1, region=value))
            for scene, size, value in ((a, "1x1", 1e6), (a, "2x2", 3e6), (b, "1x1", 6e6))
        ]
        rows = machine_tables.parts_rows(entries, ["m", "n"], lambda m: m.bytes_by_region, 1e6)
        self.assertEqual(rows, [("25.6", "spill", "4.000", "")])

    def test_every_region_is_of_one_kind(self):
        m = measured(1, region=5)
        of = {"spill": 5, "projected": 7, "frame_buffer": 3, "chunk_table": 11}
        m = dataclasses.replace(m, bytes_by_region=of)
        kinds = [m.bytes(kind) for kind in ("scene", "intermediate", "pixels")]
        self.assertEqual((kinds, m.bytes()), ([11, 12, 3], 26))


if __name__ == "__main__":
    unittest.main()
