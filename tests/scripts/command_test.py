"""Every script makes its tables with the command; skipped where $STREAMINGGS does not name it."""

import csv
import dataclasses
import json
import pathlib
import subprocess
import unittest
from unittest import mock

from in_folder import COMMAND, REPOSITORY, InFolder, file_of, name_of, nightly  # isort: skip (finds the scripts)
import explore
import tables
from runs import simulations
from runs.scenes import find_scene, program_provenance
from runs.simulations import value_at
from studies import (
    choices,
    claims,
    gpu_validation,
    headset,
    headset_published,
    published,
    reproduction,
)
from studies.choices import CHOICES
from studies.compare_machines import COMPARE_MACHINES
from studies.stability import STABILITY_TABLE
from studies.error_against_time import ERROR_AGAINST_TIME
from studies.fitting import BOUNDARY_STUDY, TRAINING_CURVES
from studies.found import FAIR_FIGHT, PRESETS
from studies.frame_costs import BINDING_CHECK, ENERGY, TIMING
from studies.headset import HEADSET
from studies.headset_published import Published, Setting
from studies.matched import MATCHED_SCENES
from studies.published import PUBLISHED_FIGURES
from studies.reproduction import REPRODUCTION
from studies.quality import QUALITY_TABLE, VOXEL_STUDY
from studies.validation import VALIDATION
from studies.variants import HALF_BY_STAGE, WORK_PRECISION

RENDERERS = pathlib.Path(COMMAND).with_name("bench_renderers") if COMMAND else ""
SMALL_ERRORS = ("--size", "64x36", "--renderers", str(RENDERERS))
SMALL_ERRORS += (
    "--tuning-size",
    "64x36",
    "--between",
    "0",
    "--steps",
    "2",
    "--rates",
    "0.5",
    "--datasets",
)
SMALL_TUNING = ("--size", "64x36", "--between", "0", "--steps", "4")


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class WithTheCommand(InFolder):
    def made(self, script, *arguments: str) -> str:
        """The tables of a script, after it has ended well."""
        status, line, tables_of_it = self.ended(
            script, str(self.scene), "--streaminggs", COMMAND, "--out", str(self.folder), *arguments
        )
        self.assertEqual(status, 0, line)
        return tables_of_it

    @nightly
    def test_every_script_makes_its_tables(self):
        for script, arguments, lines in (
            (BINDING_CHECK, ("--size", "64x36"), {"| truck | 0 |": 1, "of 1 views": 1}),
            (
                COMPARE_MACHINES,
                ("--sizes", "64x36", "--object-sizes", "64x36", "--channels", "4")
                + ("--machines", "gscore_lossless_boxes", "exact", "--view", "0"),
                {"| truck | 64x36 | 25.6 | exact |": 2, "| 102.4 | GPU, modelled |": 2}
                | {"| exact | gscore_lossless_boxes | fp32 | 62.3 | 62.3 | 1 | 1 |": 1}
                | {"| exact | GPU, modelled | fp32 | 62.3 |  | 1 | 1 |": 1}
                | {"| frame_buffer |": 1},
            ),
            (
                TIMING,
                ("--object-sizes", "64x36", "--machines", "exact", "--repeats", "1"),
                {"| truck | 64x36 | 25.6 | exact |": 2, "| 47.70 |": 1},
            ),
            (
                CHOICES,
                ("--size", "64x36", "--view", "0"),
                {"Made by ": len(choices.listed()), "| exact_wide | truck |": 1}
                | {"in flight | truck |": 1, "| dram.scheduler=fcfs |": 1}
                | {"| paper | fine | 0 |": 1, "{": 0, "None": 0},
            ),
            (
                ENERGY,
                ("--groups", "16", "64x32"),
                {"| exact | all |": 1, "| paper_no_vq | 64x32 |": 1} | {"View 0 at 640x360 px": 2},
            ),
            (
                explore,
                ("--axis", "hfus=2,4", "--axis", "group=16,64x32"),
                {"4 configurations; ": 1, "Refused": 0},
            ),
            (explore, ("--config", "paper", "--axis", "hfus=1"), {"| 1 | 64 |": 1}),
            (
                explore,
                ("--config", "gscore", "--axis", "cores=1,2"),
                {"| cores | sum(cycles) | sum(dram_bytes) | sram_bytes | mm2 |": 1, "\n| 1 |": 1},
            ),
            (
                MATCHED_SCENES,
                ("--synthetic", "builtin:object?n=500", "--size", "64x36"),
                {"| GSCore, frames/s | 106 | 79.5 | 132.5 |": 1},
            ),
            (
                explore,
                ("--recipe", "paper_in_area", "--size", "64x36", "--trials", "2"),
                {"2 configurations, of which ": 1},
            ),
            (HALF_BY_STAGE, ("--size", "64x36"), {"| truck | 0 |": 1, "| depth keys |": 1}),
            (WORK_PRECISION, (), {"| truck | 0 |": 22, "| 4,096 |": 2}),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "image", "tuning", "renderers", *SMALL_ERRORS),
                {"| truck | 0 | exact |": 29, "| truck | 0 | paper |": 20 + 2, "| tuning |": 2 + 3}
                | {"| truck | 0 | tiles |": 5}
                | {"| tuning | truck | rate | 0.5 |": 3, "| truck | 0 | double |": 5 * 2}
                | {"| truck | 0 | paper order in half |": 2},
            ),
            (
                BOUNDARY_STUDY,
                (*SMALL_TUNING, "--betas", "0", "0.5", "--voxels", "1", "0.5"),
                {"| truck |": 4 * 2 + 4, "| 0.5 | 4 |": 2 + 2},
            ),
            (
                QUALITY_TABLE,
                (*SMALL_TUNING, "--quantised-steps", "3", "--prices", "0.1"),
                {"| truck | own pictures |": 2, "| truck | paper |": 4, "| truck | exact |": 5},
            ),
            (
                VOXEL_STUDY,
                (*SMALL_TUNING, "--voxels", "1", "2"),
                {"| as given |": 2, "| tuned |": 2},
            ),
        ):
            with self.subTest(name_of(script), arguments=arguments):
                made = self.made(script, *arguments)
                self.assertRegex(made, f"Made by `scripts/{file_of(script)} ")
                for text, count in lines.items():
                    self.assertEqual(made.count(text), count, f"{text} in\n{made}")

    def test_where_no_machine_holds(self):
        """The status says so to a script."""
        words = ("--recipe", "smallest", "--require", "min(fps) >= 100000", "--trials", "2")
        words += ("--streaminggs", COMMAND, "--out", str(self.folder))
        status, line, _ = self.ended(explore, str(self.scene), *words)
        self.assertEqual(status, 3)
        self.assertRegex(line, r"too slow \(min\(fps\) >= 100000\); the nearest misses min\(fps\)")

    @nightly
    def test_both_orders_in_one_area(self):
        """What explore.py found is drawn beside presets."""
        found = []
        for order in ("exact", "gscore", "paper"):
            status, line, _ = self.ended(
                explore,
                *(str(self.scene), "--streaminggs", COMMAND, "--recipe", f"{order}_in_area"),
                *("--size", "64x36", "--trials", "3", "--require", "mm2 <= 1.2 x gscore_lossless_boxes"),
                *("--out", str(self.folder / order)),
            )
            self.assertEqual(status, 0, line)
            found.append(f"{order}={self.folder / order}")
        made = self.made(FAIR_FIGHT, "--sizes", "64x36", "--found", *found)
        names = [f"preset {name}" for name in PRESETS]
        names += ["exact, found", "gscore, found", "paper, found"]
        for name in names:
            self.assertEqual(made.count(f"| 64x36 | truck | {name} |"), 2, made)
            self.assertEqual(made.count(f"| 64x36 | {name} |"), 1, made)
        rows = tables.read_rows(self.folder, "fair_fight_front")
        self.assertEqual({row["order"] for row in rows}, {"exact", "gscore", "paper"})
        self.assertIn("yes", [row["on the front"] for row in rows])

    @nightly
    def test_figures_are_drawn_from_the_tables(self):
        small = ("--sizes", "64x36", "--object-sizes", "64x36", "--channels", "4", "--view", "0")
        machines = ("--machines", "gscore_boxes", "exact_fp16")
        self.made(COMPARE_MACHINES, *small, *machines)
        drawn = sorted(self.folder.glob("*.svg"))
        names = ["compare_machines_rates", "compare_machines_ratios", "compare_machines_traffic"]
        self.assertEqual([path.stem for path in drawn], names)
        for path in drawn:
            text = path.read_text()
            self.assertIn("exact_fp16", text)
            path.unlink()
        # Again, without a simulation, from the tables alone; and the last one from nothing.
        script = [str(REPOSITORY / "scripts" / "figures.py"), *names]
        script += ["--from", str(self.folder), "--out", str(self.folder)]
        self.assertEqual(subprocess.run(script, check=False).returncode, 0)
        self.assertEqual(drawn[-1].read_text(), text)
        (self.folder / "compare_machines_bytes.csv").unlink()
        done = subprocess.run(script, capture_output=True, text=True, check=False)
        self.assertRegex(done.stdout, "skipped compare_machines_traffic: .*_bytes.csv is not there")

    def test_choices_stand_beside_the_preset(self):
        """Changes, what the preset has, and datapaths, which only whole reports have."""
        names = ("streaming_sensitivity", "gscore_storage_order", "pixel_counts")
        made = self.made(CHOICES, "--size", "64x36", "--tables", *names)
        self.assertEqual(made.count("View 0, 64x36 px."), 2)
        self.assertIn("Scene truck, view 0, 64x36 px.", made)
        kept = (self.folder / "kept" / "choices.jsonl").read_text()
        taken = {}
        for each in map(json.loads, kept.splitlines()):
            settings = {*each["point"]["set"].items()} - {("sram.shared_bytes", 0)}
            taken[each["point"]["config"], *settings] = each["report"]["frame"]["cycles"]
        for row in tables.read_rows(self.folder, names[0]):
            key, _, text = row["change"].partition("=")
            cycles = taken[row["preset"], (key, int(text))]
            self.assertAlmostEqual(
                float(row["cycles, %"]), 100 * (cycles / taken[(row["preset"],)] - 1)
            )

    def test_an_interruption_loses_no_simulation(self):
        small = ("--sizes", "64x36", "--object-sizes", "64x36", "--channels", "4", "--view", "0")
        self.made(COMPARE_MACHINES, *small, "--machines", "gscore", "exact")
        kept = (self.folder / "kept" / "compare_machines.jsonl").read_text()
        self.made(COMPARE_MACHINES, *small, "--machines", "gscore", "exact")
        self.assertEqual((self.folder / "kept" / "compare_machines.jsonl").read_text(), kept)

    def test_a_headset_is_drawn_once(self):
        """Frames back to back and two eyes; what is kept is not drawn again."""
        words = ("builtin:object?n=200", "--streaminggs", COMMAND, "--out", str(self.folder))
        words += ("--sizes", "48x32", "--channels", "4", "--rates", "500", "--frames", "2")
        beside = {Setting(2, "48x32", 4): (Published("another", 1, None, "its scenes"),)}
        with mock.patch.object(headset_published, "PUBLISHED", beside):
            self.check_headset(words)

    def check_headset(self, words):
        status, line, _ = self.ended(HEADSET, *words)
        self.assertEqual(status, 0, line)
        rows = tables.read_rows(self.folder, "headset_rates")
        machines = {row["machine"] for row in rows}
        self.assertEqual((len(rows), len(machines)), (12, 3))
        rate = {(row["machine"], row["frames"]): float(row["frames/s"]) for row in rows}
        for machine in machines:
            back_to_back = rate[machine, "back to back"]
            self.assertGreater(back_to_back, rate[machine, "alone"])
            self.assertGreater(back_to_back, rate[machine, "two eyes, back to back"])
        for row in tables.read_rows(self.folder, "headset_second_eye"):
            self.assertTrue(0 < float(row["bytes"]) < 1, row)
        second = {row["machine"]: row for row in tables.read_rows(self.folder, "headset_second_eye")}
        ratios = tables.read_rows(self.folder, "headset_ratios")
        self.assertEqual(
            [(row["machine"], row["frames"]) for row in ratios],
            [(machine, way.name) for machine in headset.OURS for way in headset.WAYS],
        )
        for row in ratios:
            area = float(row["mm2"]) / float(row["its mm2"])
            self.assertAlmostEqual(float(row["area ratio"]), area)
        *ours, other = tables.read_rows(self.folder, "headset_stereo")
        self.assertEqual(other["speed-up"], "1.7")
        for row in ours:
            more = float(second[row["machine"]]["cycles"])
            self.assertAlmostEqual(float(row["speed-up"]), 2 / (1 + more))
        *ours, other = tables.read_rows(self.folder, "headset_published")
        for row in ours:
            pairs = rate[row["machine"], "two eyes, back to back"]
            self.assertAlmostEqual(float(row["frames/s"]), pairs)
        self.assertEqual((len(ours), other["frames/s"]), (2, "1"))
        for row in tables.read_rows(self.folder, "headset_power"):
            self.assertEqual(row["missed"], "0")
            shares = [float(row[f"{state}, time"]) for state in headset.STATES]
            self.assertAlmostEqual(sum(shares), 1, 3)
            watts = [float(row[f"{of}, W"]) for of in (*headset.STATES, "commands")]
            self.assertAlmostEqual(sum(watts), float(row["memory W"]))
        with mock.patch.object(headset, "call", side_effect=AssertionError("drawn again")):
            self.assertEqual(self.ended(HEADSET, *words)[0], 0)

    def test_gscore_at_its_best_for_a_headset(self):
        program = pathlib.Path(COMMAND)
        for size, way, said in (
            ("64x36", headset.ALONE, {"lists.tiles=12", "lists.lines=6"}),
            ("64x36", headset.PAIRS_BACK_TO_BACK, {"lists.tiles=24", "lists.sets=2"}),
            ("640x360", headset.ALONE, {"sorting.list_entries=2304"}),
            ("2064x2208", headset.ALONE, {"sorting.list_entries=1024"}),
        ):
            with self.subTest(size, way=way.name):
                found = set(headset.settings_of(program, headset.OTHERS, size, way))
                self.assertLessEqual(said, found)
                self.assertEqual("lists.sets=2" in found, way.stream)
                entries = next(each for each in found if "list_entries" in each)
                self.assertGreaterEqual(int(entries.partition("=")[2]), 1024)

    @nightly
    def test_the_paper_is_reproduced_from_small_frames(self):
        kinds = {"REAL": claims.REAL, "SYNTHETIC": claims.SYNTHETIC}
        small = {name: dataclasses.replace(kind, size="64x36") for name, kind in kinds.items()}
        words = ("--synthetic", "builtin:object?n=200", "--groups", "32", "--channels", "4")
        with mock.patch.multiple(reproduction, **small):
            made = self.made(REPRODUCTION, *words)
        for text, lines in (
            ("| times as fast as GSCore | 2.1 |", 2),
            ("| truck | 64x36 | paper_ideal | 32 |", 1),
            ("| forwards | all assumptions |", 1),
            ("| backwards | deep queues |", 1),
        ):
            self.assertEqual(made.count(text), lines, f"{text}: {made}")

    def test_published_figures_stand_beside_ours(self):
        small = {
            "ALIKE_IN_GAUSSIANS": "builtin:object?n=300",
            "ALIKE_IN_PAIRS": "builtin:object?n=600",
            "ABLATION_CASES": (("builtin:object?n=300", "64x36"),),
            "RATES": {"64x36": (66.7, 1743)},
            "LEGO_SIZE": "64x36",
        }
        small["GPU_CASES"] = (("builtin:object?n=300", "64x36", 4.9),)
        with mock.patch.multiple(published, **small):
            made = self.made(PUBLISHED_FIGURES)
        for text, count in {
            "| features in | Gaussians |": 2,
            "| lists out | pairs |": 2,
            "| truck | 64 | 64x36 |": 1,
            "| both | 1.86 |": 1,
            "| time, rendering % | 60 |": 1,
            "| frames/s, calibrated to | 4.9 |": 1,
        }.items():
            self.assertEqual(made.count(text), count, f"{text} in\n{made}")

    def check_validation(self, parts: dict[str, dict[str, int]]):
        small = ("builtin:object?n=300", "64x36")
        words = ("--requests", "4000", "--decades", "0", "--parts", *parts)
        with mock.patch.multiple(gpu_validation, OUTDOOR=small, AS_GBU=small, REAL_SIZE="64x36"):
            made = self.made(VALIDATION, *words)
        for lines in parts.values():
            for text, count in lines.items():
                self.assertEqual(made.count(text), count, f"{text} in\n{made}")

    def test_parts_stand_beside_others(self):
        benches = ("bench_quantisation", "bench_precision")
        if not all(pathlib.Path(COMMAND).with_name(name).exists() for name in benches):
            self.skipTest("benchmarks are not built")
        self.check_validation(
            {
                "gpu": {"| time of sort and ranges | % | 21 |": 1, "| truck, 64x36 |": 4},
                "sram": {"| Horowitz, 45 nm | 1024 x 64 bit |": 1},
                "codebooks": {"| truck | 0 | plain k-means |": 1, "| truck | 0 | ours, ": 3},
                "precision": {"| scene | float | pixels in half |": 1},
                "tuning": {"| yes |": 14},
            }
        )

    @nightly
    def test_the_memory_stands_beside_others(self):
        self.check_validation(
            {"memory": {"| Ramulator 2.1 |": 5, "| DRAMsim3 |": 4, "| 32 KB | stride 4 KB |": 1}}
        )

    def test_from_photographs_to_tables(self):
        photographs = str(self.write_dataset())
        training = ("--train-steps", "20", "--gaussians", "200")
        for script, arguments, lines in (
            (
                TRAINING_CURVES,
                ("--seeds", "1", "2", "--same-bits", "5"),
                {"| photographs | 1 |": 20 + 1, "| photographs | 2 |": 20 + 1}
                | {"| after 5 steps |": 1},
            ),
            (
                QUALITY_TABLE,
                ("--steps", "4", "--quantised-steps", "3", "--prices", "0.1", "--view", "0"),
                {"| photographs | photographs |": 3, "| photographs | exact |": 8 + 1}
                | {"| photographs | reference |": 1, "| as long as ": 2},
            ),
            (VOXEL_STUDY, ("--steps", "4", "--voxels", "1"), {"| photographs | 1 |": 2}),
        ):
            with self.subTest(name_of(script)):
                status, line, made = self.ended(
                    script,
                    photographs,
                    *("--streaminggs", COMMAND, "--out", str(self.folder / "out")),
                    *training,
                    *arguments,
                )
                self.assertEqual(status, 0, line)
                for text, count in lines.items():
                    self.assertEqual(made.count(text), count, f"{text} in\n{made}")
        # Two seeds, one of them twice for fewer steps; then seven tunings of two, and no training.
        self.assertEqual(len(list((self.folder / "kept").glob("fittings/*_seed_*"))), 4)
        self.assertEqual(len(list((self.folder / "kept").glob("fittings/*/scene.*"))), 4 + 7)

    def test_whatever_makes_a_table_names_its_program(self):
        """Release and commit, of the command or of a program beside it."""
        self.made(BINDING_CHECK, "--size", "64x36")
        stability = pathlib.Path(COMMAND).with_name("stability")
        words = ("--stability", str(stability), "--samples", "1", "--out", str(self.folder))
        if stability.exists():
            self.assertEqual(self.ended(STABILITY_TABLE, *words)[0], 0)
        programs = {"binding_check": pathlib.Path(COMMAND)}
        programs |= {"stability": stability} if stability.exists() else {}
        for name, program in programs.items():
            told = program_provenance(program)
            by = tables.facts_of(self.folder, name)["made"]
            with self.subTest(name):
                self.assertTrue(all(told.values()))
                self.assertEqual(by["releases"], [told["version"]])
                self.assertEqual(by["commits"], [told["commit"]])

    def test_an_exploration_begins_at_the_machine_that_simulate_runs(self):
        """What memories decide there stays when a key changes."""
        scene = find_scene(str(self.scene))
        listed = ("lists.tiles", "lists.lines", "sorting.list_entries")
        open_group = ("group_width_px=0", "group_height_px=0")
        for config, key, values, decided, settings in (
            ("exact", "hfus", (4, 8), (), ()),
            ("exact", "hfus", (4, 8), ("group_width_px", "group_height_px"), open_group),
            ("paper_no_vq", "hfus", (4, 8), ("storage.voxel_size",), ()),
            ("gscore_lossless", "cores", (4, 8), listed, ()),
        ):
            with self.subTest(config, decided=decided):
                overrides = (f"{key}={values[0]}", *settings)
                run = simulations.Run(scene, config=config, overrides=overrides)
                (view,) = simulations.simulate(pathlib.Path(COMMAND), run).accepted()
                status, said, _ = self.ended(
                    *(explore, str(self.scene), "--streaminggs", COMMAND, "--config", config),
                    *("--out", str(self.folder / "out"), "-j", "1"),
                    *(word for setting in settings for word in ("--set", setting)),
                    *("--axis", f"{key}={values[0]},{values[1]}"),
                    *("--objectives", "cycles,dram.bus_bytes,joules,mm2"),
                    *("--show", ",".join(f"config.{each}" for each in decided)),
                )
                self.assertEqual(status, 0, said)
                table = (self.folder / "out" / "explore.csv").read_text().splitlines()
                begin, changed = csv.DictReader(table)
                self.assertEqual(int(begin["sum(cycles)"]), view["frame"]["cycles"])
                self.assertEqual(int(begin["sum(dram.bus_bytes)"]), view["dram"]["bus_bytes"])
                self.assertEqual(float(begin["sum(joules)"]), view["energy"]["total_j"])
                self.assertEqual(float(begin["mm2"]), view["area_mm2"]["total"])
                for each in decided:
                    value = value_at(view["config"], each)
                    for row in (begin, changed):
                        self.assertEqual(float(row[f"config.{each}"]), value)

    def test_what_the_command_refuses(self):
        for script, arguments, line in (
            (explore, ("--axis", "hfus=2", "--config", "nope"), "--config nope: no file"),
            (explore, ("--axis", "hfus=2", "--view", "99"), "--view: got '99'"),
            (
                *(explore, ("--axis", "group=0", "--set", "sram.shared_bytes=0")),
                "group_width_px: got 0 with sram.shared_bytes 0",
            ),
            (explore, ("--axis", "group=1x2x3"), "group: '1x2x3', expected"),
            (ENERGY, ("--groups", "wide"), "group: 'wide', expected"),
            (explore, ("--axis", "hfu=2"), "--set hfu=2: "),
            (BINDING_CHECK, ("--view", "7"), "--view: got '7'"),
            (ENERGY, ("--size", "3"), "--size: got '3'"),
            (COMPARE_MACHINES, ("--object-sizes", "3x"), "--object-sizes: got 3x, expected WIDTH"),
            (COMPARE_MACHINES, ("--sizes", "64x36"), "--sizes: got only this, expected --object-"),
            (COMPARE_MACHINES, ("--machines", "nope"), "--config nope: no file"),
            (COMPARE_MACHINES, ("--channels", "3"), "dram.channels: got 3, expected a power"),
            (REPRODUCTION, ("--channels", "0"), "dram.channels: got 0, expected "),
            (CHOICES, ("--view", "0,1"), "--view: got 0,1, expected the number of a camera"),
            (CHOICES, ("--size", "3"), "--size: got 3, expected WIDTHxHEIGHT in px"),
            (TIMING, ("--view", "7"), "--view: got '7'"),
            (TIMING, ("--machines", "nope"), "--config nope: no file"),
            (WORK_PRECISION, ("--view", "7"), "--view: got '7'"),
            (WORK_PRECISION, ("--set", "nope=1"), "streaminggs: .*nope"),
            (ERROR_AGAINST_TIME, ("--view", "7"), "--view: got '7'"),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "tuning", "--datasets", "nope"),
                "nope: no data set; expected",
            ),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "tuning", "--datasets", "--steps", "0"),
                "--steps: 0 and no --datasets: nothing to fit",
            ),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "renderers", "--renderers", "nope"),
                "nope: not there; scripts/setup.sh builds it",
            ),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "renderers", "--renderers", str(RENDERERS), "--threads", "0"),
                "--threads: got '0', expected a whole number from 1 to 999",
            ),
            (
                ERROR_AGAINST_TIME,
                ("--diagrams", "renderers", "--renderers", str(RENDERERS), "--size", "3"),
                "--size: got 3, expected WIDTHxHEIGHT in px",
            ),
            (BOUNDARY_STUDY, ("--size", "3"), "truck boundary .*--size: got '3'"),
            (BOUNDARY_STUDY, ("--betas", "-1"), "truck boundary .*--beta"),
            (QUALITY_TABLE, ("--view", "7"), "--view: got '7'"),
            (VOXEL_STUDY, ("--view", "7"), "--view: got '7'"),
            *(
                (script, ("--paper-set", "nope=1"), "streaminggs: --set nope=1: nope: unknown key")
                for script in (BOUNDARY_STUDY, QUALITY_TABLE, VOXEL_STUDY)
            ),
            (TRAINING_CURVES, (), "truck.ply: no data set; expected a folder"),
        ):
            with self.subTest(name_of(script), arguments=arguments):
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
