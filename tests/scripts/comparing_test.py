"""Machines beside each other: what their tables compute."""

import argparse
import contextlib
import dataclasses
import io
import json
import math
import pathlib
import unittest
from unittest import mock

from in_folder import InFolder  # isort: skip (finds the scripts)
import results
import tables
from runs.files import content_digest, read_csv
from runs.scenes import Scene
from studies import claims, compare_machines, frame_costs, headline, matched, reproduction
from studies.cases import (
    GPU,
    Case,
    Entry,
    Measured,
    busiest_of_kernels,
    busiest_seconds,
    size_groups,
    sizes_of,
)
from tables import Column, Made

NAMES = [column.name for column in compare_machines.RATIO_COLUMNS]


def measured(*seconds: float, region: float = 0) -> Measured:
    """Whose busiest resource works half of the time."""
    return Measured(
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
        row = compare_machines.ratio_row(25.6, "all", found, "own", "other")
        of = dict(zip(NAMES, row, strict=True))
        self.assertEqual((of["scenes"], of["cases"]), (2, 3))
        self.assertAlmostEqual(of["times as fast"], 2)
        self.assertEqual((of["times as fast, least"], of["times as fast, most"]), (1, 8))
        self.assertAlmostEqual(of["times less energy"], 2)
        self.assertEqual((of["published speed"], of["mm2 over mm2"]), ("", 1))

    def test_ratios_of_one_case(self):
        """Columns by what the two are; the other takes four times as long in either view."""
        own, other = measured(1, 2), measured(4, 8)
        for changed, by_other, columns in (
            ({}, {}, {"times as fast": 4, "both overlapped": 4, "precision": "fp16"}),
            # The machine that is never idle gains nothing from overlapped frames; the other twice.
            (
                {"busiest_seconds": (1, 2)},
                {},
                {
                    "times as fast": 4,
                    "times as fast, least": 4,
                    "times as fast, most": 4,
                    "both overlapped": 2,
                    "both overlapped, least": 2,
                    "both overlapped, most": 2,
                    "only the other overlapped": 2,
                },
            ),
            (
                {},
                {"busiest_seconds": (1, 8)},
                {
                    "both overlapped": 6,  # 4.5 s over 0.75 s
                    "both overlapped, least": 2,
                    "both overlapped, most": 8,
                    "only the other overlapped": 3,
                    "only the other overlapped, least": 1,
                    "only the other overlapped, most": 4,
                },
            ),
            (
                {"decibels": (41.26, 39.0)},
                {"decibels": (math.inf, 58.0)},
                {"dB, least": 39.0, "dB, most": 41.26, "its dB, least": 58.0}
                | {"its dB, most": math.inf},
            ),
            (
                {"decibels": (math.inf, math.inf)},
                {},
                {"dB, least": math.inf, "its dB, least": None, "the other is": "simulated"},
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
                made = compare_machines.ratio_row(25.6, "all", {"s": [of_case]}, "own", "other")
                of = dict(zip(NAMES, made, strict=True))
                for name, value in columns.items():
                    check = self.assertAlmostEqual if type(value) is int else self.assertEqual
                    check(of[name], value, msg=name)

    def test_what_is_published_stands_beside_all_sizes_and_says_what_is_derived(self):
        gpu = dataclasses.replace(measured(1, 2), joules=(5, 10), precision="fp32")
        of_case = {"gscore": measured(1, 1), "paper_text": measured(1, 1), GPU: gpu}
        for own, sizes, speed, joules in (
            ("paper_text", "all", "45.7", "62.9"),
            ("gscore", "all", "21.6", "27.3 derived"),
            ("gscore", "64x36", "", ""),
        ):
            with self.subTest(own, sizes=sizes):
                found = {"s": [of_case]}
                made = compare_machines.ratio_row(25.6, sizes, found, own, GPU)
                of = dict(zip(NAMES, made, strict=True))
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
        pairs = compare_machines.pairs_of(of, list(kinds))
        self.assertEqual(pairs[: len(kinds)], [(name, GPU) for name in kinds])
        self.assertEqual(
            pairs[len(kinds) :],
            [
                ("paper", "gscore"),
                ("exact_fp16", "gscore"),
                ("exact", "gscore_lossless"),
                ("exact", "gscore"),
            ],
        )
        few = compare_machines.pairs_of(of, ["exact", "exact_vq", "gscore_lossless"])
        self.assertEqual(few[3:], [("exact", "gscore_lossless")])

    def test_a_line_for_each_case_and_memory_of_pairs_that_lose_the_same(self):
        case = Case(Scene("s", "a"), "4x2")
        faster = dataclasses.replace(measured(1), peak_gb_s=51.2, binds="dram")
        entries = [
            Entry(case, name, of)
            for name, of in (
                ("gscore_lossless_boxes", measured(6, region=3e6)),
                ("exact", measured(2, 2, region=1e6)),
                ("exact_fp16", measured(1)),
                ("gscore_lossless_boxes", dataclasses.replace(faster, seconds=(2.5,))),
                ("exact_fast", faster),
                (GPU, measured(30)),
            )
        ]
        place = ("s", "4x2")
        made = compare_machines.case_rows(entries, [case])
        for row, expected in zip(
            made,
            (
                (25.6, "exact", "gscore_lossless_boxes", 3, 3, 1.5, 3, 1, 3, "", ""),
                (51.2, "exact_fast", "gscore_lossless_boxes", 2.5, 1, 0.5, 1, 0, 0, "dram", "dram"),
            ),
            strict=True,
        ):
            self.assertEqual(row[:2], place)
            for found, value in zip(row[2:], expected, strict=True):
                check = self.assertEqual if type(value) is str else self.assertAlmostEqual
                check(found, value)

    def test_a_line_for_each_size_and_one_for_all(self):
        arguments = argparse.Namespace(sizes=["4x2", "8x4"], object_sizes=["4x2", "6x6"])
        scenes = [Scene("outside", "a"), Scene("truck", "b")]
        cases = [
            Case(scene, size)
            for scene in scenes
            for size in sizes_of(scene.name, arguments)
        ]
        groups = size_groups(cases, arguments)
        self.assertEqual(list(groups), ["4x2", "6x6, 8x4", "all"])
        times = (3, 9, 12, 9)
        entries = [
            entry
            for case, seconds in zip(cases, times)
            for entry in (
                Entry(case, "gscore", measured(seconds)),
                Entry(case, "exact", measured(3)),
                Entry(
                    case,
                    GPU,
                    dataclasses.replace(measured(30), peak_gb_s=102.4),
                ),
            )
        ]
        rows = compare_machines.ratio_rows(entries, groups, ["gscore", "exact"])
        head = NAMES
        found = [dict(zip(head, row, strict=True)) for row in rows]
        over_gscore = {
            row["sizes"]: (row["cases"], row["times as fast"])
            for row in found
            if (row["machine"], row["than"]) == ("exact", "gscore")
        }
        # Outside 1 and 3, truck 4 and 3: by scene their geometric means.
        for sizes, cases_of, times in (("4x2", 2, 2), ("6x6, 8x4", 2, 3), ("all", 4, 6**0.5)):
            self.assertEqual(over_gscore[sizes][0], cases_of)
            self.assertAlmostEqual(over_gscore[sizes][1], times)
        alone = argparse.Namespace(sizes=["4x2"], object_sizes=["6x6"])
        self.assertEqual(list(size_groups([cases[0]], alone)), ["all"])

    def test_how_long_the_busiest_works(self):
        view = {"frame": {"time_s": 4e-3}, "binding": {"utilisation": 0.75}}
        self.assertAlmostEqual(busiest_seconds(view), 3e-3)
        stages = [("bytes", 2), ("instructions", 4), ("bytes", 3)]
        gpu = {"stages": [{"bound_by": bound, "seconds": s} for bound, s in stages]}
        self.assertEqual(busiest_of_kernels(gpu), 5)
        m = dataclasses.replace(measured(1, 3), busiest_seconds=(0.5, 1.5))
        self.assertEqual((m.frames_a_second(), m.most_frames_a_second()), (0.5, 1))

    def test_the_quickest_and_the_slowest_of_a_machine(self):
        case = Case(Scene("s", "a"), "4x2")
        points = [frame_costs.Timed(case, "exact", 25.6, seconds, 0.5) for seconds in (2, 1, 3)]
        rows = frame_costs.point_rows(points)
        self.assertEqual([row[-1] for row in rows], [frame_costs.PUBLISHED_SECONDS, 1, 3])
        self.assertEqual(len(frame_costs.point_rows(points[:1])), 2)

    def test_every_region_is_of_one_kind(self):
        m = measured(1, region=5)
        of = {"spill": 5, "projected": 7, "frame_buffer": 3, "chunk_table": 11}
        m = dataclasses.replace(m, bytes_by_region=of)
        kinds = [m.bytes(kind) for kind in ("scene", "intermediate", "pixels")]
        self.assertEqual((kinds, m.bytes()), ([11, 12, 3], 26))


class Headline(InFolder):
    """From tables of other studies, with areas that stand in for runs."""

    PAIR = ("exact_fast", "gscore_lossless")

    def setUp(self):
        super().setUp()
        self.write_cases(
            *(("truck", 2, 3), ("truck", 8, 3), ("yard", 1, 12)), ("builtin:object", 64, 64)
        )
        self.write_pictures("fp32", "58.9", "inf")
        head = ("size px", "machine", "mm2", "M cycles", "mJ", "PSNR dB, least", "PSNR dB, most")
        head += ("judged", "ended")
        self.save(
            headline.SEARCHED,
            head,
            [
                ("1x1", "preset exact", 9, 9, 9, 9, 9, "", ""),
                ("1x1", "exact, found", 6, 2, 3, "inf", "inf", 7, "by time"),
                ("2x2", "exact, found", 6, 2, 3, "inf", "inf", 7, "by time"),
                ("1x1", "paper, found", 3, 1, 3, 20, 40, 7, "by time"),
                ("2x2", "paper, found", 3, 4, 12, 15, 30, 7, "by time"),
                ("1x1", "gscore, found", 6, 8, 6, "inf", "inf", 7, "by time"),
                ("2x2", "gscore, found", 6, 8, 6, "inf", "inf", 7, "by time"),
            ],
        )

    def write_cases(self, *cases):
        head = ("scene", "GB/s", "machine", "than", "times as fast", "times less energy")
        rows = [(scene, "25.6", *self.PAIR, *ratios, 50) for scene, *ratios in cases]
        rows += [(scene, "51.2", *self.PAIR, 100, 100, by) for scene, by in (("a", 2), ("b", 0.5))]
        head += ("both overlapped",)
        self.save(headline.CASES, head, rows)

    def write_pictures(self, precision, own_db, other_db):
        head = ("machine", "than", "sizes", "GB/s", "precision")
        head += ("dB, least", "dB, most", "its dB, least", "its dB, most")
        told = (precision, own_db, "inf", other_db, "inf")
        rows = [(*self.PAIR, "all", gb_s, *told) for gb_s in ("25.6", "51.2")]
        self.save(headline.RATIOS, head, rows)

    def save(self, name, head, rows):
        by = Made("x", (f"of {name}",))
        tables.save(self.folder, name, by, [Column(each, "") for each in head], rows)

    def made(self) -> list[dict[str, str]]:
        def area(_, preset: str, channels: int, technology: pathlib.Path) -> tuple[float, dict]:
            counted = json.loads(technology.read_text())["memory_interface"]["counted"]
            own = {"exact_fast": 3}.get(preset, 2)
            return own + (channels if counted else 0), {}

        arguments = argparse.Namespace(
            tables=self.folder, out=self.folder, streaminggs=self.stand_in("")
        )
        with mock.patch.object(headline, "area_mm2", area):
            with mock.patch.object(headline, "PAIRS", [self.PAIR]):
                with contextlib.redirect_stdout(io.StringIO()):
                    headline.make(arguments)
        return tables.read_rows(self.folder, "headline")

    def test_each_trained_scene_counts_once(self):
        """Truck 4 and 3, yard 1 and 12; a built-in scene and the other memory do not count."""
        first, *_ = self.made()
        self.assertEqual(first["machine / baseline"], "exact_fast / gscore_lossless")
        self.assertAlmostEqual(float(first["speed-up"]), 2)
        self.assertAlmostEqual(float(first["energy, baseline over machine"]), 6)
        self.assertEqual(first["area ratio"], "1.5")
        self.assertAlmostEqual(float(first["area ratio with PHY and controller"]), 7 / 6)
        scenes = tables.read_rows(self.folder, "headline_scenes")
        self.assertEqual([row["scene"] for row in scenes], ["truck", "yard"])

    def test_overlapped_frames_with_twice_the_memory(self):
        """Of which no energy is measured; 8 channels in the area."""
        row = self.made()[1]
        self.assertEqual(row["machine / baseline"], "exact_fast / gscore_lossless")
        self.assertEqual(row["frames"], "overlapped, 51.2 GB/s")
        self.assertAlmostEqual(float(row["speed-up"]), 1)
        self.assertEqual(row["energy, baseline over machine"], "")
        self.assertAlmostEqual(float(row["area ratio with PHY and controller"]), 11 / 10)

    def test_what_was_searched_for(self):
        """In cycles 1 / 2 and 4 / 2, in joules 3 / 3 and 12 / 3, in area 6 / 3."""
        *_, of_gscore, row = self.made()
        pairs = headline.SEARCHED_PAIRS
        self.assertEqual(of_gscore["machine / baseline"], pairs["exact", "gscore"])
        self.assertAlmostEqual(float(of_gscore["speed-up"]), 4)
        self.assertEqual(of_gscore["picture"], "both: the reference picture")
        self.assertEqual(row["machine / baseline"], pairs["exact", "paper"])
        self.assertAlmostEqual(float(row["speed-up"]), 1)
        self.assertAlmostEqual(float(row["energy, baseline over machine"]), 2)
        self.assertAlmostEqual(float(row["area ratio"]), 2)
        self.assertEqual(row["area ratio with PHY and controller"], "")
        self.assertEqual(row["picture"], "the reference picture, baseline 15.0 .. 40.0 dB")
        head, rows = read_csv(self.folder / f"{headline.SEARCHED}.csv")
        rows = [[cell.replace("inf", "30") for cell in row] for row in rows]
        self.save(headline.SEARCHED, head, rows)
        self.assertEqual(self.made()[-2]["picture"], "30.0 .. 30.0 dB, baseline 30.0 .. 30.0 dB")
        self.save(headline.SEARCHED, ("size px", "machine"), [("1x1", "preset exact")])
        with self.assertRaisesRegex(ValueError, "no machine of each size that was found"):
            self.made()

    def test_it_names_the_tables_that_it_is_from(self):
        self.made()
        made = tables.facts_of(self.folder, "headline")["made"]
        names = (headline.CASES, headline.RATIOS, headline.SEARCHED)
        self.assertEqual(made["commits"], sorted(f"of {name}" for name in names))
        self.assertEqual(list(made["inputs"]), [f"{name}.csv" for name in names])

    def test_what_pictures_are(self):
        for told, said in (
            (("fp32", "58.9", "inf"), "both: the reference picture"),
            (("fp32", "40", "58.9"), "40.0 .. inf dB, baseline the reference picture"),
            (("fp16", "38", "60"), "in half precision, 38.0 .. inf dB, baseline 60.0 .. inf dB"),
        ):
            self.write_pictures(*told)
            with self.subTest(told):
                self.assertEqual({row["picture"] for row in self.made()[:2]}, {said})
        self.write_pictures("fp32, its fp16", "40", "40")
        with self.assertRaisesRegex(ValueError, "got no row of exact_fast / gscore_lossless at 25"):
            self.made()

    def test_without_trained_scenes_there_is_none(self):
        self.write_cases(("builtin:object", 1, 1))
        with self.assertRaisesRegex(ValueError, "no trained scene of exact_fast / gscore_lossless"):
            self.made()

    def test_that_of_this_repository_is_from_the_tables_beside_it(self):
        made = tables.facts_of(results.TABLES, "headline")["made"]
        for name, digest in made["inputs"].items():
            self.assertEqual(content_digest(results.TABLES / name), digest, name)


class Reproduction(unittest.TestCase):
    def view(
        self, cycles: int, joules: float, psnr_db: float | None = 30.0, halves: int = 25
    ) -> dict:
        return {
            "frame": {"cycles": cycles, "time_s": cycles / 1e9},
            "energy": {"total_j": joules}
            | {"clock_j": joules / 5, "logic_leakage_j": joules / 5, "sram_leakage_j": joules / 10},
            "image": {"psnr_db": psnr_db},
            "area_mm2": {"total": 5.5},
            "config": {"stated_area_mm2": 1.1},
            "dram": {"bytes_by_region": {"second_halves": {"hfu0": {"read": halves}}}},
            "units": {"hfu0": {"counters": {"fine_tests": 1, "splats": 25}}}
            | {"coarse": {"counters": {"coarse_tests_of_parts": 100}}},
        }

    def found(self, kind: claims.Kind, cycles: int, joules: float) -> claims.SceneFound:
        """GSCore: 4 M cycles, 4 mJ and 4 MB."""
        factors = {"": 1, "_no_cgf": 2, "_no_vq_cgf": 3}
        factors |= {claims.TWICE_CFUS: 0.5, claims.TWICE_FFUS: 1}
        return claims.SceneFound(
            kind,
            {
                variant: [self.view(by * cycles, joules, halves=100 if by == 3 else 25)]
                for variant, by in factors.items()
            },
            [self.view(4_000_000, 4e-3, None)],
            [{"seconds": 0.2, "joules": 6e-3}],
        )

    def test_claims_are_of_geometric_means(self):
        real = [self.found(claims.REAL, 1_000_000, 1e-3), self.found(claims.REAL, 4_000_000, 4e-3)]
        found = [*real, self.found(claims.SYNTHETIC, 2_000_000, 2e-3)]
        measured = {claim.name: claim.measured(claim.among(found)) for claim in claims.CLAIMS}
        self.assertAlmostEqual(measured["times as fast as GSCore"], 2)
        self.assertAlmostEqual(measured["times less energy than GSCore"], 2)
        as_stated = measured["times less energy than GSCore, clock and leakage of the stated area"]
        self.assertAlmostEqual(as_stated, 2 / 0.6)
        self.assertAlmostEqual(measured["times less energy than the GPU"], 3)
        self.assertAlmostEqual(measured["fewer bytes of second halves by codebooks, %"], 75)
        self.assertAlmostEqual(measured["GPU, frames/s, real"], 5)
        self.assertAlmostEqual(measured["frames/s, real"], 500)
        self.assertAlmostEqual(measured["frames/s, synthetic"], 500)
        self.assertAlmostEqual(measured["gain of the coarse filter"], 2)
        self.assertAlmostEqual(measured["gain of codebooks without it"], 1.5)
        self.assertAlmostEqual(measured["gain of 8 CFUs over 4"], 2)
        self.assertAlmostEqual(measured["dropped by both filters, %"], 75)
        point = reproduction.Point("paper_text", "96", 4)
        rows = reproduction.claim_rows(point, found)
        passes = {row[0]: row[8] for row in rows}
        self.assertEqual(passes["times as fast as GSCore"], "yes")
        self.assertEqual(passes["gain of codebooks without it"], "no")
        self.assertEqual(rows[0][4:7] + rows[0][9:], ("paper_text", "96", 25.6, None, 30.0, math.inf))
        *_, baselines, passed, of, faster, fail, area = reproduction.serves_row(point, found)
        failing = fail.split("; ")
        again = sum(claim.again for claim in claims.CLAIMS)
        self.assertEqual((baselines, of + 4 + again, area), ("1 of 4", len(rows), 5.5))
        self.assertAlmostEqual(faster, 2)
        self.assertEqual(passed + len(failing) - 3, of)

    def test_what_other_scenes_give_stands_beside_a_claim(self):
        found = [self.found(claims.REAL, 2_000_000, 2e-3), self.found(claims.OTHER_SCENES, 1_000_000, 1e-3)]
        rows = reproduction.claim_rows(reproduction.Point("paper_text", "96", 4), found)
        (speed,) = [row for row in rows if row[0] == "times as fast as GSCore"]
        self.assertEqual((speed[7], speed[9]), (2, 4))

    def test_a_claim_without_a_scene_of_its_kind_is_left_out(self):
        found = [self.found(claims.REAL, 1_000_000, 1e-3)]
        names = [claim.name for claim in claims.claims_of(found)]
        self.assertIn("frames/s, real", names)
        self.assertNotIn("frames/s, synthetic", names)

    def test_a_map_is_beside_one_unit_of_each(self):
        def views(cycles: int) -> list[list[dict]]:
            return [[self.view(cycles, 1e-3)]]

        rows = reproduction.map_rows("paper_text", {("1", "1"): views(8), ("2", "1"): views(4)})
        self.assertEqual([row[:3] for row in rows], [("paper_text", 1, 1), ("paper_text", 2, 1)])
        self.assertAlmostEqual(rows[1][3], 2)

    def test_a_waterfall_takes_every_part_away_in_both_orders(self):
        text = {"vsu": {"ray_lanes": 8}, "hfu": {"ffu_lanes": 16}, "codebook": {"preloaded": False}}
        ideal = {"vsu": {"ray_lanes": 9}, "hfu": {"ffu_lanes": 16}, "codebook": {"preloaded": True}}
        by_part = reproduction.settings_by_part(text, ideal)
        self.assertEqual(list(by_part), list(reproduction.PARTS))
        self.assertEqual(by_part["rays, samples and their tables"], ("vsu.ray_lanes=8",))
        self.assertEqual(by_part["a fine test a cycle"], ())
        orders = dict(reproduction.waterfall_orders(by_part))
        gone = {"vsu.ray_lanes=8", "codebook.preloaded=false"}
        for steps in orders.values():
            self.assertEqual((steps[0][1], set(steps[-1][1])), ((), gone))
        self.assertEqual(orders["backwards"][1][1], ("codebook.preloaded=false",))
        rows = reproduction.waterfall_rows("forwards", [("a", 2.0, 30.0), ("b", 1.0, 29.0)])
        self.assertEqual(rows[0], ("forwards", "as published", 2.1, None, None))
        ends = ("forwards", "a", 2.0, 1.05, 30.0), ("forwards", "b", 1.0, 2.0, 29.0)
        self.assertEqual(tuple(rows[1:]), ends)

    def test_a_key_of_no_part_is_refused(self):
        with self.assertRaisesRegex(ValueError, "storage.encoding: differs between"):
            reproduction.settings_by_part(
                {"storage": {"encoding": "vq"}}, {"storage": {"encoding": "raw"}}
            )

    def test_a_statistic_matches_between_its_bounds(self):
        work = {"listed": 30, "gaussians": 100, "pairs": 150, "tiles": 10, "pixels": 1000}
        gpu = [{"work": work | {"entries_fetched": 80, "blends": 5000}}]
        found = matched.Found(gpu, (), [{"scene": {"voxels": 3000}}])
        by_name = {of.name: of for of in matched.of_kind(claims.REAL)}
        for name, measured in {
            "Gaussians on the screen, %": 30,
            "tiles of a Gaussian on the screen": 5,
            "Gaussians of a tile": 15,
            "Gaussians of a tile until it is finished": 8,
            "blends of a pixel": 5,
        }.items():
            self.assertEqual(by_name[name].measured(found), measured)
            self.assertIsNone(by_name[name].row("scene", measured)[-1])
        voxels = by_name["voxels with a Gaussian"]
        self.assertEqual(voxels.measured(found), 3000)
        self.assertEqual([voxels.row("", n)[-1] for n in (499, 500, 3000, 3001)], [0, 1, 1, 0])


if __name__ == "__main__":
    unittest.main()
