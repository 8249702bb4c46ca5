"""report.py of a sweep: what the page says of its points, what is refused, how it behaves in a
browser."""

import html
import json
import pathlib
import re
import shlex
import subprocess
import unittest
from unittest import mock

from in_folder import COMMAND, InFolder, nightly  # isort: skip (finds the scripts)
import report
from reporting import sweep
from chromium import NEEDS_BROWSER, Chromium, PageChecks
from reporting.sweep import read_sweep


def line(cycles, mm2, joules, status="done", technology="32 nm", clock_hz=1e9, **more) -> str:
    """A result as `sweep` writes it. more: of the point."""
    point = {"scene": "s", "view": 0, "config": "exact", "set": {"hfus": 2}, **more}
    result = {"key": "0", "status": status, "point": point}
    if status == "done":
        result["report"] = {
            "frame": {"cycles": cycles, "fps": clock_hz / cycles},
            "energy": {"total_j": joules},
            "area_mm2": {"total": mm2},
            "image": {"psnr_db": None},
            "dram": {"bytes": 1000},
            "binding": {"unit": "fine"},
            "config": {"machine": "exact", **{"a": {"b": True}}, **point["set"]},
            "provenance": {"commit": "0123abc", "technology": technology},
        }
    else:
        result["reason"] = "hfus: 0, expected <more>"
    return json.dumps(result) + "\n"


HEAD_OF_TABLE = "scene,view,config,status,frame.cycles,frame.fps,energy.total_j,area_mm2.total\n"


class Read(InFolder):
    def page(self, text: str, name: str = "sweep.jsonl") -> tuple[int, str]:
        """Exit status, and the page or what was said."""
        path = self.folder / name
        path.write_text(text)
        status, said, _ = self.ended(report, str(path))
        return status, said if status else path.with_suffix(".html").read_text()

    def test_of_two_clocks_the_slower_machine_is_on_no_front(self):
        """Though it takes fewer cycles; the fastest stands first."""
        slow = line(100, 5, 1, clock_hz=1e9, set={"clock_mhz": 1000})
        fast = line(150, 5, 1, clock_hz=2e9, set={"clock_mhz": 2000})
        status, page = self.page(slow + fast)
        self.assertEqual(status, 0)
        facts = json.loads(html.unescape(re.search('data-points="([^"]*)"', page)[1]))
        self.assertEqual(facts["labels"], ["clock_mhz 2000", "clock_mhz 1000"])
        self.assertEqual(facts["best"], [True, False])
        self.assertIn("no other point is better in ms and mm2 and mJ", page)

    def test_memory_that_is_built_is_shown_and_bytes_on_the_bus(self):
        told = json.loads(line(100, 5.0, 1.0))
        sram = {"input_bytes": 3000, "input_available_bytes": 9000, "shared_bytes": 500}
        told["report"] |= {"sram": sram, "dram": {"bytes": 1000, "bus_bytes": 2000}}
        path = self.folder / "sweep.jsonl"
        path.write_text(json.dumps(told) + "\n")
        machine = sweep.Machine(tuple(read_sweep(path)))
        self.assertEqual([machine.value(name) for name in ("SRAM KB", "bus MB")], [3.5, 0.002])

    def test_fitted_memories_are_part_of_the_command_and_of_the_machine(self):
        path = self.folder / "sweep.jsonl"
        path.write_text(line(9, 1, 1) + line(9, 1, 1, fit_memories=True))
        plain, fitted = read_sweep(path)
        self.assertEqual(
            fitted.command(), plain.command().replace(" --set", " --fit-memories --set")
        )

    def test_frames_of_two_eyes_are_beside_no_frame_of_one(self):
        path = self.folder / "sweep.jsonl"
        path.write_text(line(9, 1, 1) + line(9, 1, 1, stereo="ipd=1"))
        points = read_sweep(path)
        self.assertIn(" --stereo ipd=1 ", points[1].command())
        panels = dict(sweep.panels(points))
        self.assertEqual(list(panels)[1:], ["s, view 0", "s, view 0, ipd=1"])

    def test_the_front_is_of_time_area_and_energy(self):
        points = [
            *((100, 5.0, 1.0), (200, 4.0, 1.0), (300, 4.5, 0.5)),  # each best in something
            *((200, 5.0, 1.0), (300, 4.5, 0.6)),
        ]
        text = "".join(line(*of, set={"hfus": at}) for at, of in enumerate(points))
        status, page = self.page(text)
        self.assertEqual(status, 0)
        facts = json.loads(html.unescape(re.search('data-points="([^"]*)"', page)[1]))
        self.assertEqual(facts["best"], [True] * 3 + [False] * 2)
        self.assertEqual(facts["labels"], [f"hfus {at}" for at in (0, 1, 2, 3, 4)])
        at = [facts["names"].index(name) for name in ("ms", "cycles", "mm2", "mJ")]
        expected = [[float(f"{c / 1e6:.6g}"), c, mm2, 1e3 * j] for c, mm2, j in points]
        self.assertEqual([[values[i] for i in at] for values in facts["points"]], expected)

    def test_joules_without_the_memory_s_win_nothing(self):
        less = line(200, 5.0, 0.5, set={"hfus": 1})
        without = less.replace('"total_j": 0.5', '"total_j": 0.5, "memory_known": false')
        for other, kept in ((less, [True, True]), (without, [True, False])):
            status, page = self.page(line(100, 5.0, 1.0) + other)
            self.assertEqual(status, 0)
            facts = json.loads(html.unescape(re.search('data-points="([^"]*)"', page)[1]))
            self.assertEqual(facts["best"], kept)
            self.assertEqual("not known" in page, not kept[1])

    def test_the_picture_counts_where_pictures_differ(self):
        for other_db, kept in ((30.0, [True, False]), (None, [True, True])):
            text = line(200, 5, 1, set={"hfus": 1}).replace('"psnr_db": null', '"psnr_db": 30.0')
            other = line(300, 5, 1, set={"hfus": 2})
            text += other.replace("null", "30.0") if other_db else other
            status, page = self.page(text)
            self.assertEqual(status, 0)
            facts = json.loads(html.unescape(re.search('data-points="([^"]*)"', page)[1]))
            with self.subTest(other_db):
                self.assertEqual(facts["best"], kept)
                self.assertEqual("mJ and PSNR dB" in page, kept[1])

    def test_several_views_are_summed_over_what_all_have(self):
        text = "".join(
            line(100 * hfus + view, 5 + view, 1.0, set={"hfus": hfus}, view=view)
            for hfus, view in ((1, 0), (1, 1), (2, 0), (2, 1), (3, 1))
        )
        path = self.folder / "sweep.jsonl"
        path.write_text(text)
        panels = dict(sweep.panels(read_sweep(path)))
        self.assertEqual(list(panels), ["all", "s, view 0", "s, view 1"])
        shown = {name: len(re.findall("data-open=", text)) for name, text in panels.items()}
        self.assertEqual(shown, {"all": 2, "s, view 0": 2, "s, view 1": 3})
        self.assertIn("<td class=n>401</td>", panels["all"])  # cycles of hfus=2

    def test_area_with_the_memory_s_interface_where_the_result_tells_it(self):
        told = json.loads(line(100, 5.0, 1.0))
        told["report"]["area_mm2"]["with_memory_interface"] = {"middle": 11.25}
        path = self.folder / "sweep.jsonl"
        for text, expected in ((json.dumps(told) + "\n", "11.25"), (line(100, 5.0, 1.0), "")):
            with self.subTest(expected):
                path.write_text(text)
                machine = sweep.Machine(tuple(read_sweep(path)))
                measure = "mm2 with PHY"
                self.assertEqual(sweep.cell(measure, machine.value(measure)), expected)

    def test_what_was_not_done_is_named_as_text(self):
        status, page = self.page(line(9, 1, 1) + line(0, 0, 0, "refused", set={"hfus": 0}))
        self.assertEqual(status, 0)
        self.assertIn("2 points · 1 done · 1 refused · commit 0123abc", page)
        self.assertIn("hfus: 0, expected &lt;more&gt;", page)

    def test_the_last_result_of_a_point_counts(self):
        """And what a killed sweep has left of a line does not."""
        status, page = self.page(line(111, 1, 1) + line(222, 1, 1) + line(333, 1, 1)[:50])
        self.assertEqual(status, 0)
        self.assertIn("<td class=n>222</td>", page)
        self.assertNotIn("<td class=n>111</td>", page)

    def test_a_whole_last_line_counts_without_its_end(self):
        status, page = self.page(line(222, 1, 1) + line(111, 1, 1).rstrip("\n"))
        self.assertEqual(status, 0)
        self.assertIn("<td class=n>111</td>", page)

    def test_what_is_not_to_be_compared_stands_apart(self):
        """Nothing is left out."""
        path = self.folder / "sweep.jsonl"
        for what, more, tabs in (
            ("table", {"technology": "22 nm"}, ["s, view 0, 32 nm", "s, view 0, 22 nm"]),
            ("cameras", {"cameras": "a.json"}, ["all", "s, view 0", "s, view 0, a.json"]),
        ):
            with self.subTest(what):
                path.write_text(line(111, 1, 1) + line(222, 1, 1, **more))
                panels = dict(sweep.panels(read_sweep(path)))
                self.assertEqual(list(panels), tabs)
                for tab, cycles in zip(tabs[-2:], (111, 222)):
                    self.assertIn(f"<td class=n>{cycles}</td>", panels[tab])
                    self.assertEqual(len(re.findall("data-open=", panels[tab])), 1)

    def test_what_failed_and_was_done_later_is_done(self):
        status, page = self.page(line(0, 0, 0, "failed") + line(9, 1, 1))
        self.assertEqual(status, 0)
        self.assertIn("1 points · 1 done · commit", page)

    def test_of_many_points_the_front_is_shown(self):
        ones = [(at, v) for v in (0, 1) for at in range(30)]
        text = "".join(line(9 + at, 9 - at % 3, 1, set={"hfus": at}, view=v) for at, v in ones)
        with mock.patch.object(sweep.tables, "MOST_ROWS", 30):
            status, page = self.page(text)
        self.assertEqual(status, 0)
        self.assertEqual(page.count("data-open="), 3 * 10)
        self.assertEqual(page.count("<td>yes</td>"), 3 * 3)
        self.assertIn("20 points more are in the results", page)

    def test_what_is_refused(self):
        for name, text, said in (
            ("a.jsonl", "", "a.jsonl: no results, expected those of `streaminggs sweep`"),
            ("b.jsonl", line(1, 1, 1) + "{}\n", "b.jsonl:2: got '{}', expected a result"),
            ("c.jsonl", "[]\n", "c.jsonl:1: got '\\[\\]', expected"),
            ("d.jsonl", line(1, 1, 1).replace("total_j", "x"), "d.jsonl:1: got"),
            ("e.jsonl", line(0, 0, 0, "failed"), "no point was done: hfus: 0, expected <more>"),
            ("f.csv", "scene,mJ\na,1\n", "f.csv: no column view, config, status, frame.cycles"),
            ("g.jsonl", 4 * line(1, 1, 1) + "x\n" + line(1, 1, 1), "g.jsonl:5: got 'x', exp"),
            ("h.jsonl", line(1, 1, 1) + "\n", "h.jsonl:2: got ''"),
            ("i.jsonl", line(1, 1, 1, "nonsense"), "i.jsonl:1: got .* expected a result of"),
            ("j.jsonl", line(1, 1, 1).replace('"scene": "s", ', ""), "j.jsonl:1: got"),
            ("k.jsonl", line(1, 1, 1).replace('"cycles": 1', '"cycles": "1"'), "k.jsonl:1: got"),
            ("l.jsonl", line(1, 1, 1).replace('"bytes": 1000', '"bytes": [1]'), "l.jsonl:1: got"),
            ("m.jsonl", "[" * 100_000 + "\n", "m.jsonl:1: got '\\[\\["),
            ("n.csv", HEAD_OF_TABLE + "s,0,exact,done,1,1,1,1\ns,0", "n.csv:3: got 2 cells"),
            ("o.csv", HEAD_OF_TABLE + "s,0,exact,done,x,1,1,1\n", "o.csv:2: got 's,0,exact,done,x"),
            ("p.csv", HEAD_OF_TABLE + "s,0,exact,,,,,\n", "p.csv:2: got 's,0,exact,,"),
        ):
            with self.subTest(name):
                status, told = self.page(text, name)
                self.assertEqual(status, 2)
                self.assertRegex(told, said)
                self.assertFalse((self.folder / name).with_suffix(".html").exists())


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class WithSweep(InFolder):
    def swept(self, *more: str) -> pathlib.Path:
        out = self.folder / "sweep.jsonl"
        words = [COMMAND, "sweep", str(self.scene), "--out", str(out), "--size", "64x36", "-j", "1"]
        words += ["--cameras", str(self.scene.with_suffix(".json")), "--axis", "hfus=2,4"]
        words += ["--axis", "rendering.ellipse_test=true,false", "--set", "group_width_px=32"]
        words += ["--csv", str(out.with_suffix(".csv")), *more]
        subprocess.run(words, check=True, capture_output=True)
        return out


class OfTheCommand(WithSweep):
    def test_a_point_is_run_again_by_its_command(self):
        for more in ((), ("--fit-memories",)):
            out = self.swept(*more)
            for path in (out, out.with_suffix(".csv")):
                for point in read_sweep(path):
                    self.assertEqual("--fit-memories" in point.command(), bool(more))
                    self.assertRunsAgain(point)
            out.unlink()

    def assertRunsAgain(self, point: sweep.Point):
        with self.subTest(command=point.command()):
            _, *words = shlex.split(point.command())
            again = self.folder / "again"
            if "--cameras" not in words:  # a table does not say
                words += ["--cameras", str(self.scene.with_suffix(".json"))]
            done = subprocess.run(
                [COMMAND, *words, "--out", str(again)], capture_output=True, text=True
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            (view,) = json.loads((again / "report.json").read_text())["views"]
            self.assertEqual(view["frame"]["cycles"], point.told["frame.cycles"])
            self.assertEqual(view["area_mm2"]["total"], point.told["area_mm2.total"])
            for key in ("hfus", "rendering.ellipse_test"):
                self.assertEqual(point.resolved[key], point.settings[key])


@NEEDS_BROWSER
@nightly
class InTheBrowser(WithSweep, PageChecks):
    def test_it_works_by_keyboard_in_both_themes_and_widths(self):
        status, said, _ = self.ended(report, str(self.swept()))
        self.assertEqual(status, 0, said)
        page = self.folder / "sweep.html"
        with Chromium() as browser:
            browser.prefer("light")
            for width in (1280, 400):
                with self.subTest(width=width):
                    browser.resize(width, 900)
                    browser.open(page)
                    self.check_whole(browser, page, width)
            self.check_themes(browser)
            self.check_points(browser)
            self.assertEqual(browser.complaints(), [])

    def test_the_diagram_of_every_tab_is_drawn(self):
        points = [(hfus, view) for hfus in (1, 2) for view in (0, 1)]
        path = self.folder / "sweep.jsonl"
        path.write_text("".join(line(h + v, h, h, set={"hfus": h}, view=v) for h, v in points))
        self.assertEqual(self.ended(report, str(path))[0], 0)
        shown = "[...document.querySelectorAll('circle')].filter((c) => c.getClientRects().length)"
        with Chromium() as browser:
            for fragment in ("", "#tab1", "#tab2"):
                with self.subTest(fragment):
                    browser.open(path.with_suffix(".html"), fragment)
                    self.assertEqual(browser.value(f"{shown}.length"), 2)

    def check_points(self, browser: Chromium):
        """A point's configuration from the diagram and from the table, and by keys alone."""
        title = "document.querySelector('.machine h4').textContent"
        self.assertRegex(browser.value(title), "^Point 1: hfus")
        browser.value("document.querySelector('[data-points] svg').focus()")
        for _ in range(4):
            browser.press("ArrowRight", 39)
        reading = browser.value("document.querySelector('[data-points] output').textContent")
        self.assertRegex(reading, "^hfus .*: ms [0-9.]+, mm2 [0-9.]+, mJ [0-9.]+$")
        browser.press("Enter", 13)
        self.assertIn(reading.partition(":")[0], browser.value(title))
        self.assertEqual(browser.value("document.activeElement.tagName"), "H4")
        browser.value("document.querySelector('[data-open=\"2\"]').click()")
        self.assertRegex(browser.value(title), "^Point 3: ")
        rows = "[...document.querySelectorAll('.machine > table td')].map((d) => d.textContent)"
        named = browser.value(rows)
        self.assertIn("hfus", named)
        self.assertIn(f"hfus {named[named.index('hfus') + 1]}", browser.value(title))
        sizes = "new Set([...document.querySelectorAll('circle')].map((c) => c.getAttribute('r')))"
        self.assertGreater(browser.value(f"{sizes}.size"), 1)
        browser.value(
            "{ const s = document.querySelector('[data-axis=size]'); s.value = -1; s.onchange(); }"
        )
        self.assertEqual(browser.value(f"{sizes}.size"), 1)


if __name__ == "__main__":
    unittest.main()
