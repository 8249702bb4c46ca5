"""report.py: what the page holds, what is refused, and how it behaves in a browser. Frames are made
with $STREAMINGGS; the browser is Debian's Chromium, its test is skipped where that is not there."""

import json
import os
import pathlib
import random
import unittest
from unittest import mock

from in_folder import COMMAND, InFolder, nightly  # isort: skip (finds the scripts)
import report
import streaminggs
from reporting import charts
from reporting.folder import find_runs, flat
from runs import simulations
from runs.scenes import call, find_scene
from chromium import NEEDS_BROWSER, Chromium, PageChecks

NEEDS_COMMAND = unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")


@NEEDS_COMMAND
class WithFrames(InFolder):
    GAUSSIANS = 400

    def simulated(
        self, config: str, folder: str, *overrides: str, size: str = "64x36"
    ) -> pathlib.Path:
        out = self.folder / folder
        overrides = ("group_width_px=32", "group_height_px=16", *overrides)
        if config == "gscore":
            overrides = ()
        run = simulations.Run(find_scene(str(self.scene)), "0", size, config, overrides)
        simulations.simulate_into(out, pathlib.Path(COMMAND), run).accepted()
        return out

    def assertHolds(self, page: str, text: str):
        self.assertTrue(text in page, f"not on the page: {text}")

    def page(self, folder: pathlib.Path) -> str:
        status, said, _ = self.ended(report, str(folder))
        self.assertEqual(status, 0, said)
        return (folder / "report.html").read_text()


class Page(WithFrames):
    def test_it_shows_what_the_report_says(self):
        for config in ("exact", "paper", "gscore"):
            with self.subTest(config):
                folder = self.simulated(config, config)
                view = json.loads((folder / "report.json").read_text())["views"][0]
                page = self.page(folder)
                self.assertHolds(page, f"{view['frame']['cycles']:,} cycles")
                self.assertHolds(page, charts.escaped(view["binding"]["explanation"]))
                self.assertHolds(page, charts.escaped(view["provenance"]["command"]))
                for band, times, unit in (
                    (view["energy"]["with_memory_interface_j"], 1e3, "mJ"),
                    (view["area_mm2"]["with_memory_interface"], 1, "mm²"),
                ):
                    amount = charts.number(times * band["middle"])
                    self.assertHolds(page, f"; {amount} {unit} with PHY and controller of the")
                for region in view["dram"]["bytes_by_region"]:
                    self.assertHolds(page, f"<th scope=row>{region.replace('_', ' ')}</th>")
                for entry in view["left_out"]:
                    self.assertHolds(page, charts.escaped(entry["saves"]))
                for key, _ in flat(view["config"]):
                    self.assertHolds(page, f"<td>{key}</td>")
                self.assertEqual(page.count("<figure class=heat"), 0 if config == "gscore" else 5)
                # One copy of each picture.
                pictures = (folder / "view_0").glob("*.png")
                self.assertEqual(page.count('src="data:image/png'), len(list(pictures)))

    def test_a_picture_without_error_has_no_shares(self):
        """By itself, and in a folder of runs."""
        parts = ("encoding", "missed", "misordered", "arithmetic", "pixel_format")
        for config in ("exact_fp16", "paper"):
            report_file = self.simulated(config, f"both/{config}") / "report.json"
            whole = json.loads(report_file.read_text())
            none = dict.fromkeys(parts, {"share": None, "alone": None})
            whole["views"][0]["image"]["error_parts"] = none
            report_file.write_text(json.dumps(whole))
        said = "Of the squared error: encoding none, missed none, misordered none"
        self.assertHolds(self.page(self.folder / "both" / "paper"), said)
        self.assertEqual(self.page(self.folder / "both").count(said), 2)

    def test_several_runs_and_a_table_are_compared(self):
        for config in ("exact", "paper"):
            self.simulated(config, f"both/{config}")
        # A killed writer's last line does not count.
        (self.folder / "both" / "explore.csv").write_text("hfus,cycles\n2,1200\n4,1000\n8")
        page = self.page(self.folder / "both")
        for text in (
            "2 runs, 2 views",
            "explore.csv",
            ">exact, view 0</button>",
            ">paper, view 0<",
        ):
            self.assertHolds(page, text)
        self.assertEqual(page.count("role=tabpanel"), 3)
        # A view of a run by itself, and no page of an earlier time.
        alone = self.page(self.folder / "both" / "exact" / "view_0")
        self.assertFalse("<div role=tablist" in alone)
        self.assertEqual([run.name for run in find_runs(self.folder / "both")], ["exact", "paper"])

    def test_frames_of_a_path(self):
        folder = self.folder / "path"
        words = ["builtin:object?n=100", "--size", "32x18", "--path", "builtin:path"]
        words += ["--frames", "2", "--out", str(folder)]
        done = call(pathlib.Path(COMMAND), words)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page(folder)
        report_file = folder / "report.json"
        text = report_file.read_text()
        whole = json.loads(text)
        summary = whole["summary"]
        slowest = summary["worst_frame"]
        self.assertHolds(page, f"worst {charts.rate(summary['worst_fps'])} (frame {slowest})")
        self.assertHolds(page, f"frame {slowest}, the slowest")
        self.assertHolds(page, charts.escaped(whole["views"][slowest]["binding"]["explanation"]))
        self.assertFalse("hold no Gaussian" in page)
        summary["empty_frames"] = 1
        report_file.write_text(json.dumps(whole))
        self.assertHolds(self.page(folder), "1 hold no Gaussian")
        (folder / "report.html").unlink()
        summary["worst_frame"] = 2
        report_file.write_text(json.dumps(whole))
        self.assertRefused(folder, "summary.worst_frame: got 2 of 2 frames, expected one of them$")
        report_file.write_text(text)
        self.assertEqual(len(streaminggs.load(folder)), 2)
        self.assertHolds(page, "2 frames along the turntable of builtin:object?n=100")
        self.assertHolds(page, "path.csv")

    def test_frames_back_to_back(self):
        words = ["builtin:object?n=100", "--size", "32x18", "--path", "builtin:path"]
        words += ["--frames", "3", "--stream"]
        both = self.folder / "both"
        for name, rate in (("free", "0"), ("held", "100"), ("missed", "400000")):
            out = ["--frame-rate", rate, "--out", str(both / name)]
            done = call(pathlib.Path(COMMAND), words + out)
            self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page(both / "held")
        file = both / "held" / "report.json"
        whole = json.loads(file.read_text())
        stream = whole["stream"]
        watts = [
            f"{charts.number(stream['flow']['power_w'][end])}" for end in ("low", "middle", "high")
        ]
        for text in (
            "3 frames along the turntable of builtin:object?n=100, frames back to back",
            "every frame in its picture, 100 a second",
            f"<b>{watts[1]} W</b>",
            f"{watts[0]} .. {watts[2]} W",
            f"{charts.number(stream['flow']['with_memory_interface_w']['middle'])} W with PHY",
            f"<b>{charts.number(1e3 * stream['latency']['median_s'])} ms</b>",
            "2 frames from the first picture to the last",
            charts.escaped(stream["all"]["provenance"]["command"]),
        ):
            self.assertHolds(page, text)
        self.assertEqual(page.count('src="data:image/png'), 1)
        self.assertFalse("What binds" in page)  # the display does
        self.assertHolds(self.page(both / "free"), "What binds")
        self.assertHolds(self.page(both / "missed"), "frames miss their picture, 400000 a second")
        self.simulated("exact", "both/alone")
        page = self.page(both)
        self.assertHolds(page, "4 runs, 1 views")
        self.assertHolds(page, ">held, frames back to back</button>")
        with self.assertRaisesRegex(ValueError, "got frames back to back, expected views or"):
            streaminggs.load(both / "held")
        self.assertEqual(len(streaminggs.load(both)), 1)
        (both / "held" / "report.html").unlink()
        del stream["flow"]["energy"]["bands"]
        file.write_text(json.dumps(whole))
        self.assertRefused(both / "held", "no 'stream.flow.energy.bands', expected what")

    def test_two_eyes_at_a_rate(self):
        folder = self.folder / "eyes"
        words = ["builtin:object?n=100", "--size", "32x18", "--stereo", "ipd=0.1"]
        words += ["--fit-memories", "--frame-rate", "90,1e6", "--out", str(folder)]
        done = call(pathlib.Path(COMMAND), words)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.page(folder)
        view = json.loads((folder / "report.json").read_text())["views"][0]
        watts = view["fixed_rates"][0]["power_w"]["middle"]
        for text in (
            '<div class=layer data-what="right eye"',
            f"right eye {view['image']['right_eye']['psnr_db']:.2f} dB",
            "<dt>pairs a second</dt>",
            f"; {charts.number(watts)} W at 90 a second; does not hold 1e+06 a second",
        ):
            self.assertHolds(page, text)

    def test_what_a_report_says_is_text(self):
        folder = self.simulated("exact", "hostile")
        report_file = folder / "report.json"
        whole = json.loads(report_file.read_text())
        hostile = "</script><b onclick='x'>\"&"
        whole["views"][0]["scene"]["name"] = whole["views"][0]["provenance"]["command"] = hostile
        whole["failed"] = [{"view": 3, "why": hostile}]
        report_file.write_text(json.dumps(whole))
        page = self.page(folder)
        self.assertFalse(hostile in page)
        self.assertEqual(page.count("</script>"), 1)
        self.assertHolds(page, "view 3 failed")
        # Name, title, tab, heading and command; and why the other failed.
        self.assertEqual(page.count(charts.escaped(hostile)), 6)

    def test_pictures_shrink_until_the_page_is_small_enough(self):
        folder = self.simulated("exact", "large")
        noise = random.Random(1).randbytes(3 * 320 * 180)  # no smaller when it is packed
        for picture in (folder / "view_0").glob("*.png"):
            picture.write_bytes(charts.write_png(320, 180, noise))
        most = len(self.page(folder).encode())
        self.assertGreater(most, 3 * 4 / 3 * len(noise))
        pictures = 3 * 4 / 3 * len(noise)
        for room, said, embedded in (
            (most + 300, "", 3),
            (most - 1000, "Pictures at 1/2 of their width", 3),
            (most - 0.8 * pictures, "Pictures at 1/4 of their width", 3),
            (most - 0.98 * pictures, "Pictures left out", 0),
        ):
            with self.subTest(said), mock.patch("reporting.page.MOST_BYTES", int(room)):
                page = self.page(folder)
                self.assertLessEqual(len(page.encode()), room)
                self.assertEqual(page.count('src="data:image/png'), embedded)
                self.assertEqual("Pictures " in page, bool(said))
                self.assertTrue(said in page)

    def test_what_is_refused(self):
        folder = self.simulated("exact", "broken")
        whole = (folder / "report.json").read_text()
        groups = folder / "view_0" / "groups.csv"
        counts = groups.read_text()

        def broken(path: pathlib.Path, text: str, back: str, said: str):
            path.write_text(text)
            self.assertRefused(folder, said)
            path.write_text(back)

        (self.folder / "empty").mkdir()
        self.assertRefused(self.folder / "empty", "no results, expected report.json")
        self.assertRefused(self.folder / "nowhere", "nowhere: no folder, expected one")
        broken(folder / "report.json", whole[:-20], whole, r"report.json:\d+: .*expected JSON")
        broken(folder / "report.json", "[]", whole, "list, expected an object")
        for text, said in (
            ('{"views": [{"view": 0}]}', "no 'views\\[0\\].scene', expected"),
            ('{"views": [1]}', "views\\[0\\]: got a number, expected an object$"),
            (whole.replace('"psnr_db": ', '"psnr_db": true, "was": ', 1), "psnr_db: got true or"),
            (whole.replace('"units": ', '"units": [], "were": ', 1), "units: got a list, expected"),
        ):
            broken(folder / "report.json", text, whole, said)
        broken(groups, counts + "1,2\n", counts, r"groups.csv:8: got 2 cells, expected 10")
        broken(groups, counts.replace(",0,", ",x,", 1), counts, "groups.csv:2: ")
        table = folder / "l.csv"
        broken(table, "a,b\n1,2\n3\n4,5\n", "a,b\n", "l.csv:3: got 1 cells, expected 2$")
        broken(table, "a,b\n1,2\n3,4,5\n", "a,b\n", "l.csv:3: got 3 cells, expected 2$")
        for text in ("[" * 100_000, '{"a":' * 500 + "1" + "}" * 500):
            deep = "report.json: got JSON of more than 100 levels, expected fewer$"
            broken(folder / "report.json", text, whole, deep)
        frame = folder / "view_0" / "frame.png"
        png = frame.read_bytes()
        empty = png[:16] + bytes(8) + png[24:]
        for content in (b"no picture", png[:20], png[:-1], png[:8] + png[-12:], empty):
            frame.write_bytes(content)
            self.assertRefused(folder, "view_0/frame.png: got no whole PNG, expected one$")
        frame.write_bytes(png[:24] + b"\x10" + png[25:])
        with mock.patch("reporting.page.MOST_BYTES", 0):
            self.assertRefused(folder, "view_0/frame.png: got another kind of PNG, expected 8 bits")

    def test_what_has_no_end_is_not_read(self):
        folder = self.simulated("exact", "endless")
        view = folder / "view_0"
        for path, of in (
            (folder / "report.json", folder),
            (view / "report.json", view),
            (view / "groups.csv", folder),
            (view / "frame.png", folder),
            (view / "error.png", view),
            (self.folder / "sweep.jsonl", self.folder / "sweep.jsonl"),
            (self.folder / "sweep.csv", self.folder / "sweep.csv"),
        ):
            content = path.read_bytes() if path.exists() else b""
            for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
                with self.subTest(path=path.name, of=of.name, make=make):
                    path.unlink(missing_ok=True)
                    make(path)
                    self.assertRefused(of, f"{path.name}: not a regular file, expected one$")
            path.unlink()
            path.write_bytes(content)

    def test_results_are_not_written_over(self):
        folder = self.simulated("exact", "kept")
        kept = folder / "report.json"
        whole = kept.read_bytes()
        for out, said in ((kept, "expected the name of a page"), (folder, "got a folder")):
            with self.subTest(out=out):
                self.assertRefused(folder, said, "--out", str(out))
        self.assertEqual(kept.read_bytes(), whole)
        with self.assertRaisesRegex(ValueError, "written over"):
            report.check_page(self.folder / "sweep.html", self.folder / "sweep.html")

    def assertRefused(self, folder: pathlib.Path, said: str, *words: str):
        status, line, made = self.ended(report, str(folder), *words)
        self.assertRegex(line, said)
        self.assertEqual((status, made), (2, ""))
        self.assertFalse((folder / "report.html").exists())


@NEEDS_BROWSER
@nightly
class InTheBrowser(WithFrames, PageChecks):
    def setUp(self):
        super().setUp()
        for config in ("exact", "paper"):
            self.simulated(config, f"runs/{config}")
        self.page(self.folder / "runs")
        self.page(self.folder / "runs" / "paper")
        self.one, self.several = (self.folder / "runs" / of / "report.html" for of in ("paper", ""))

    def test_it_works_by_keyboard_in_both_themes_and_widths(self):
        with Chromium() as browser:
            browser.prefer("light")
            for page, fragment in ((self.one, ""), (self.several, ""), (self.several, "#tab2")):
                for width in (1280, 400):
                    with self.subTest(page=page, fragment=fragment, width=width):
                        browser.resize(width, 900)
                        browser.open(page, fragment)
                        self.check_whole(browser, page, width)
                self.check_themes(browser)
            self.check_slider(browser)
            self.check_tabs(browser)
            self.check_readings(browser)
            self.assertEqual(browser.complaints(), [])

    def check_slider(self, browser: Chromium):
        browser.open(self.one)
        edge = "document.querySelector('.edge').getBoundingClientRect().left"
        browser.value("document.querySelector('[type=range]').focus()")
        at = browser.value(edge)
        browser.press("ArrowRight", 39)
        self.assertGreater(browser.value(edge), at)
        browser.press("Home", 36)
        self.assertEqual(browser.value("document.querySelector('[type=range]').value"), "0")
        # What is beside the frame, by arrow keys as well.
        browser.value("document.querySelector('[type=radio]').focus()")
        browser.press("ArrowRight", 39)
        shown = "document.querySelector('.layer:not([hidden])').dataset.what"
        self.assertEqual(browser.value(shown), "error")

    def check_tabs(self, browser: Chromium):
        browser.open(self.several)
        selected = "document.querySelector('[aria-selected=true]').textContent"
        visible = "document.querySelectorAll('[role=tabpanel]:not([hidden])').length"
        self.assertEqual(browser.value(selected), "overview")
        browser.value("document.querySelector('[role=tab]').focus()")
        browser.press("ArrowLeft", 37)
        self.assertEqual(browser.value(selected), "paper, view 0")
        self.assertEqual(browser.value(visible), 1)

    def check_readings(self, browser: Chromium):
        """Points of a diagram and groups of a map, by arrow keys."""
        browser.open(self.several)
        reading = "document.querySelector('[data-points] output').textContent"
        browser.value("document.querySelector('[data-points] svg').focus()")
        browser.press("ArrowRight", 39)
        self.assertRegex(browser.value(reading), "view 0|exact|paper")
        browser.open(self.one)
        browser.value("document.querySelector('[data-heat] svg').focus()")
        for key, code in (("ArrowRight", 39), ("ArrowDown", 40)):
            browser.press(key, code)
        reading = "document.querySelector('[data-heat] output').textContent"
        self.assertRegex(browser.value(reading), "group 2, at 0, 16 px: .* cycles")


if __name__ == "__main__":
    unittest.main()
