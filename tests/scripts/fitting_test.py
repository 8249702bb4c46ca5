"""Trainings and tunings: what is kept of them, how they are stopped and go on; and what the study
of quality makes of logs and pictures. A program stands in for the command."""

import concurrent.futures
import math
import pathlib
import signal
import subprocess
import sys
import time
import unittest

from in_folder import REPOSITORY, InFolder  # isort: skip (finds the scripts)
from runs.keeper import Fitted, Fitting, KeptFittings
from runs.scenes import Failure
from studies import fitting, quality, subjects
from studies.subjects import Subject, Tunings

BODY = """
    if "--version" in sys.argv:
        print("streaminggs 1.0 (abc)")
        sys.exit(0)
    def path(word):
        return pathlib.Path(sys.argv[sys.argv.index(word) + 1])
    with (HERE / "calls").open("a") as file:
        print(*sys.argv[1:], file=file)
    def leave(text):
        path("--out").write_text(text)
        path("--log").write_text("step,seconds\\n7,2.5\\n")
    def stopped(*_):
        pathlib.Path(f"{path('--out')}.checkpoint").write_text("half")
        leave("half")
        sys.exit(130)
    signal.signal(signal.SIGINT, stopped)
    if "refused" in sys.argv:
        print("streaminggs: --steps: 0", file=sys.stderr)
        sys.exit(2)
    if "failing" in sys.argv:
        print("streaminggs: step 3: not finite", file=sys.stderr)
        sys.exit(1)
    if "slow" in sys.argv and "--resume" not in sys.argv:
        (HERE / "started").touch()
        time.sleep(60)
    leave("whole")
    """


class Keeping(InFolder):
    def setUp(self):
        super().setUp()
        self.program = self.stand_in(BODY)

    def kept(self, side_by_side: int = 1) -> KeptFittings:
        return KeptFittings(self.program, self.folder / "fittings", side_by_side)

    def calls(self) -> list[str]:
        path = self.folder / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def test_what_is_done_is_not_done_again(self):
        one, other = Fitting("a b", "tune", ("x.ply",)), Fitting("a b", "tune", ("y.ply",))
        first, second, same = self.kept().all([one, other, one])
        self.assertEqual(first.scene, same.scene)
        self.assertNotEqual(first.scene, second.scene)
        self.assertEqual(first.log, [{"step": "7", "seconds": "2.5"}])
        self.assertEqual(first.scene.read_text(), "whole")
        called = [line.split()[:2] for line in self.calls()]
        self.assertEqual(called, [["tune", "x.ply"], ["tune", "y.ply"]])
        self.assertEqual(self.kept().all([one])[0], first)
        self.assertEqual(len(self.calls()), 2)
        self.kept().all([Fitting("a b", "tune", ("x.ply",), copy=1)])
        self.assertEqual(len(self.calls()), 3)

    def test_whatever_it_reads_belongs_to_it(self):
        photographs = self.folder / "photographs"
        photographs.mkdir()
        for path in (self.scene, photographs / "0.png"):
            path.write_text("old")
            fitting = Fitting("a", "tune", (str(self.scene), "--data", str(photographs)))
            before = len(self.calls())
            self.kept().all([fitting, fitting])
            path.write_text("new")
            self.kept().all([fitting])
            with self.subTest(path.name):
                self.assertEqual(len(self.calls()), before + 2)
        self.program = self.stand_in(BODY + "\n    # changed\n")
        self.kept().all([fitting])
        self.assertEqual(len(self.calls()), 5)
        self.program.with_name("streaminggs-commands").write_text("another tune")
        self.kept().all([fitting])
        self.assertEqual(len(self.calls()), 6)

    def test_what_ends_badly_is_not_kept_and_stops_the_others(self):
        cases = (
            ("refused", ValueError, "^a: streaminggs: --steps: 0$"),
            ("failing", Failure, "^a: streaminggs: step 3: not finite$"),
        )
        for number, (word, error, text) in enumerate(cases):
            # Another one each time: it would be resumed.
            slow = Fitting("slow", "train", ("slow",), copy=number)
            began = time.monotonic()
            with self.subTest(word), self.assertRaisesRegex(error, text):
                self.kept(side_by_side=2).all([Fitting("a", "train", (word,)), slow])
            self.assertLess(time.monotonic() - began, 30)
        self.assertEqual(list(self.folder.glob("fittings/*/made.json")), [])

    def test_stopped_when_its_time_is_over(self):
        (fitted,) = self.kept().all([Fitting("slow", "train", ("slow",), most_seconds=4)])
        self.assertEqual(fitted.scene.read_text(), "half")
        self.assertGreaterEqual(fitted.seconds, 4)
        self.assertEqual(list(self.folder.glob("fittings/*/*.checkpoint")), [])
        self.kept().all([fitted.fitting])
        self.assertEqual(len(self.calls()), 1)

    def test_a_script_that_was_killed_told_no_seconds(self):
        head = "step,seconds,loss\n"
        log = head + "400,2.5,0.1\n800,5000.25,0.1\n"
        for number, (what, told, logged, least) in enumerate(
            (
                ("the log knows", "", log, 5000.25),
                ("the script knew more", "7000", log, 7000),
                ("no look yet", "", head, 0),
                ("no log", "", "", 0),
            )
        ):
            fitting = Fitting("a", "train", ("x",), copy=number)
            place = self.kept().keeper.place(fitting.label, fitting.facts())
            place.mkdir(parents=True)
            (place / "scene.ply.checkpoint").write_bytes(b"half")
            if told:
                (place / "seconds").write_text(told)
            if logged:
                (place / "log.csv").write_text(logged)
            with self.subTest(what):
                (fitted,) = self.kept().all([fitting])
                self.assertIn("--resume", self.calls()[-1])
                self.assertGreater(fitted.seconds, least)
                self.assertLess(fitted.seconds, least + 60)

    def test_two_scripts_do_not_make_the_same_at_once(self):
        slow = Fitting("slow", "train", ("slow",), most_seconds=2)
        with concurrent.futures.ThreadPoolExecutor() as pool:
            both = [pool.submit(self.kept().all, [slow]) for _ in range(2)]
            first, second = (one.result() for one in both)
        self.assertEqual(first, second)
        self.assertEqual(len(self.calls()), 1)

    def test_ctrl_c_saves_and_the_next_start_goes_on(self):
        script = self.folder / "script.py"
        script.write_text(f"""\
import pathlib, sys
sys.path.insert(0, {str(REPOSITORY / "scripts")!r})
from runs import run_arguments
from runs.keeper import Fitting, KeptFittings
def work():
    kept = KeptFittings(pathlib.Path({str(self.program)!r}), pathlib.Path("fittings"), 1)
    kept.all([Fitting("slow", "train", ("slow",)), Fitting("next", "train", ("next",))])
sys.exit(run_arguments.main(work))
""")
        words = [sys.executable, "-B", str(script)]
        running = subprocess.Popen(words, cwd=self.folder, stderr=subprocess.PIPE, text=True)
        while not (self.folder / "started").exists():
            self.assertIsNone(running.poll())
            time.sleep(0.02)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=30)
        self.assertEqual(running.returncode, 130, said)
        self.assertRegex(said, "interrupted\n$")
        (checkpoint,) = self.folder.glob("fittings/*/*.checkpoint")
        self.assertEqual(len(self.calls()), 1)
        subprocess.run(words, cwd=self.folder, stderr=subprocess.DEVNULL, check=True)
        self.assertIn(f"--resume {checkpoint.relative_to(self.folder)}", self.calls()[1])
        self.assertFalse(checkpoint.exists())
        self.assertEqual(len(list(self.folder.glob("fittings/*/made.json"))), 2)


class Words(InFolder):
    CALLS = Tunings(3, 5, "group", "rendered", 1, "fp16", ("vsu.ray_step_px=1",))

    def test_a_scene_that_was_tuned_is_held_to_what_it_was(self):
        scene = Subject("a", "a.ply", "a.json", "64x36", 7)
        photographed = Subject("b", "b.ply", dataset="b")
        smaller = Subject("b", "b.ply", dataset="b", downscale=2)
        own = "--cameras a.json --size 64x36 --between 7"
        for subject, given, text in (
            (scene, "a.ply", own),
            (scene, "t.ply", f"{own} --target a.ply"),
            (photographed, "t.ply", "--data b"),
            (smaller, "t.ply", "--data b --downscale 2"),
        ):
            words = self.CALLS.quantised(subject, given, "paper", ()).words
            with self.subTest(given, subject=subject.name):
                self.assertEqual(words[:4], (given, "--quantise", "--config", "paper"))
                self.assertEqual(" ".join(words[4:-4]), text)

    def test_settings_of_paper_order_reach_its_tuning_alone(self):
        subject = Subject("b", "b.ply", dataset="b")
        words = "--fit-memories --set rendering.precision=fp16 "
        words += "--set storage.voxel_size=0.5 --set vsu.ray_step_px=1"
        self.assertEqual(" ".join(self.CALLS.boundary(subject, 0.5, 0.05).words[4:11]), words)
        self.assertNotIn("--set", self.CALLS.streaming(subject, 0.1).words)

    def test_steps_alone_are_as_many_and_as_long(self):
        photographed = Subject("b", "b.ply", dataset="b")
        words = "b.ply --streaming --config exact --data b --steps"
        alone = quality.steps_alone(photographed, self.CALLS)
        self.assertEqual(
            {name: " ".join(fitting.words) for name, fitting in alone.items()},
            {
                "as long as boundary-aware": f"{words} 3 --price 0 --test-every 500 --rate 1",
                "as long as quantisation-aware": f"{words} 5 --price 0 --test-every 500",
            },
        )
        priced = " ".join(self.CALLS.streaming(photographed, 0.03).words)
        self.assertEqual(priced, f"{words} 3 --price 0.03 --test-every 500")
        self.assertEqual(quality.prices_of(photographed, [0.03, 0]), [0, 0.03])
        scene = Subject("a", "a.ply", "a.json", "64x36", 7)
        self.assertEqual(quality.steps_alone(scene, self.CALLS), {})
        self.assertEqual(quality.prices_of(scene, [0.03]), [0.03])

    def test_views_are_looked_for_before_anything_is_trained(self):
        program = self.stand_in("print('to train from  9\\nto test with  4 (every 8th by name)')")
        sources = subjects.find_sources([str(self.scene), str(self.folder)])
        for views, of_all, of_data in (
            ("all", "", ""),
            ("0", "", ""),
            ("3", "got '3', expected all, or numbers from 0 to 0, .* of truck$", ""),
            ("3,0", "got '3', expected all, or numbers from 0 to 0, .* of truck$", ""),
            ("4", "got '4'", "got '4', expected all, or numbers from 0 to 3, .* of "),
            ("0,0", "got '0'", "got '0'"),
            ("", "got ''", "got ''"),
            ("-1", "got '-1'", "got '-1'"),
        ):
            for asked, error in ((sources, of_all), (sources[1:], of_data)):
                with self.subTest(views, asked=asked):
                    if error:
                        with self.assertRaisesRegex(ValueError, f"^--view: {error}"):
                            quality.check_views(program, asked, views)
                    else:
                        quality.check_views(program, asked, views)

    def test_a_data_set_is_a_folder(self):
        self.assertEqual(subjects.dataset_folder(str(self.folder)), self.folder)
        self.assertIsNone(subjects.dataset_folder(str(self.scene)))

    def test_a_scene_may_be_a_folder(self):
        """With cameras elsewhere, beside a data set that has its own."""
        folder, cameras = self.folder / "streamed", str(self.scene.with_suffix(".json"))
        folder.mkdir()
        (folder / "lod-meta.json").touch()
        photographs = str(self.write_dataset())
        scene, dataset = subjects.find_sources([str(folder), photographs], [cameras])
        self.assertEqual((scene.name, scene.cameras), ("streamed", cameras))
        self.assertEqual(str(dataset), photographs)


class Numbers(InFolder):
    def test_from_the_first_look_to_the_last(self):
        keys = ("test_psnr_db", "reference_psnr_db", "misordered_gaussians", "misordered_pixels")
        looks = [(0, 20, 40, 0.5, 0.2, 0.01), (9, 24, 30, 0.1, 0.1, 0)]
        log = [dict(zip(("step", *keys, "l_cbp"), map(str, look))) for look in looks]
        row = fitting.boundary_row(
            ("a", 0.4, 1, 0.05), Fitted(None, pathlib.Path(), log, 1.0)
        )
        self.assertEqual(row[4:], (9, 40, 20, 24, 30, 0.5, 0.1, 0.2, 0.1, 0.01, 0))

    def test_a_frame_that_equals_its_target(self):
        def view(psnr_db):
            return {"target": {"psnr_db": psnr_db}}

        for psnr_db, mean in (((20.0, 30.0), 25), ((20.0, None), 20), ((None, None), math.inf)):
            self.assertEqual(quality.mean_psnr(list(map(view, psnr_db))), mean)

    def test_infinity_of_compare(self):
        for text, psnr_db in (("inf", None), ("31.5", 31.5)):
            program = self.stand_in(f"print('psnr_db {text}'); print('ssim 0.9')")
            found = quality.compared(program, self.scene, self.scene)
            self.assertEqual(found, (psnr_db, 0.9))

    def test_scenes_that_differ_are_a_failure(self):
        def fitted(name, text):
            (self.folder / name).write_text(text)
            log = [{"step": "1500"}]
            return Fitted(Fitting("lego", "train", ()), self.folder / name, log, 1.0)

        same = [fitted("a", "bits"), fitted("b", "bits")]
        self.assertEqual(fitting.compared_bits(same), "after 1,500 steps")
        with self.assertRaisesRegex(Failure, "lego: 1500 steps, twice: .* differ"):
            fitting.compared_bits([same[0], fitted("c", "bitz")])


if __name__ == "__main__":
    unittest.main()
