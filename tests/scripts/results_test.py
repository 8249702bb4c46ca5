"""Tables of results: both files, the Markdown that comes from them, and places in READMEs."""

import contextlib
import dataclasses
import importlib
import io
import json
import math
import re
import shlex
import subprocess
import sys
import time
import unittest
from unittest import mock

from in_folder import REPOSITORY, InFolder  # isort: skip (finds the scripts)
import results
import tables
from exploring import options
from exploring.record import SETTING
from reporting import results_page
from runs.files import content_digest, write_text
from runs.scenes import Scene
from studies import found
from studies.found import SMALLEST_MACHINE
from tables import Column, Made, Spread

BY = Made("scripts/results.py one truck", ("abc",), ("0.2.0",))
COLUMNS = (
    Column("scene", "its name"),
    Column("view", "of a camera", form="d"),
    Column("cycles", "of the frame", "cycles", ","),
    Column("PSNR dB", "against the reference picture", "dB", ".1f"),
)
ROWS = (("a|b", 0, 12345, 31.25), ("c", 1, 6, math.inf), ("d", 2, None, None))


KEYS = [f"{of}/KEYS.md" for of in ("modules/streaminggs", "modules/gscore", "algorithm/memory")]


class Writing(InFolder):
    def written(self, columns=COLUMNS, rows=ROWS, by=BY, **more) -> str:
        with contextlib.redirect_stdout(io.StringIO()) as out:
            tables.write(self.folder, "one", by, columns, rows, **more)
        text = tables.markdown_of(self.folder, "one")
        self.assertEqual(out.getvalue(), text + "\n\n")
        return text

    def test_both_files_and_their_markdown(self):
        self.assertEqual(
            self.written(about="What to know."),
            "Made by `scripts/results.py one truck`; commit abc.\n\nWhat to know.\n\n"
            "| scene | view | cycles | PSNR dB |\n| --- | ---: | ---: | --- |\n"
            "| a\\|b | 0 | 12,345 | 31.2 |\n| c | 1 | 6 | equal |\n| d | 2 |  |  |\n",
        )
        for by, said in (
            (Made("x", ()), "Made by `x`."),
            (Made("x", ("abc",)), "Made by an earlier program, commit abc; `x` makes it now."),
            (Made("", ("abc",)), "Made by an earlier program, commit abc; no command makes it now."),
        ):
            self.assertTrue(self.written(by=by).startswith(f"{said}\n\n"))
        csv = (self.folder / "one.csv").read_text()
        self.assertEqual(
            csv, "scene,view,cycles,PSNR dB\na|b,0,12345,31.25\nc,1,6,inf\nd,2,,\n"
        )
        facts = json.loads((self.folder / "one.json").read_text())
        self.assertEqual(facts["columns"][2]["unit"], "cycles")
        self.assertEqual(facts["columns"][2]["meaning"], "of the frame")

    def test_numbers_keep_every_digit(self):
        self.written((Column("s", "time", "s", ".1f"),), ((1 / 3,),))
        self.assertEqual((self.folder / "one.csv").read_text(), "s\n0.3333333333333333\n")

    def test_only_some_rows(self):
        columns = (*COLUMNS[:2], Column("front", "whether none beats it"))
        text = self.written(columns, (("a", 1, True), ("b", 2, False)), only={"front": "yes"})
        self.assertRegex(text, r"\n\| scene \| view \|\n.*\n\| a \| 1 \|\n$")

    def test_the_ends_of_a_range_stand_together(self):
        ends = (Column(f"dB, {end}", "", "dB", ".1f") for end in ("least", "most"))
        columns = (Column("s", ""), *ends)
        text = self.written(columns, (("a", 1, 2.5), ("b", 3, 3.01), ("c", None, None)))
        self.assertRegex(text, r"\| s \| dB, least .. most \|\n.*\n\| a \| 1.0 .. 2.5 \|\n")
        self.assertTrue(text.endswith("| b | 3.0 |\n| c |  |\n"), text)
        self.assertIn("\na,1,2.5\n", (self.folder / "one.csv").read_text())

    def test_spread_out(self):
        columns = (*COLUMNS[:1], Column("what", ""), Column("ms", "", "ms", ".1f"))
        rows = (("a", "x", 1), ("a", "y", 2), ("b", "y", 3))
        text = self.written(columns, rows, spread=Spread("scene", "{ms} ms"))
        self.assertTrue(
            text.endswith(
                "| what | a | b |\n| --- | --- | --- |\n"
                "| x | 1.0 ms |  |\n| y | 2.0 ms | 3.0 ms |\n"
            ),
            text,
        )

    def test_means_of_means(self):
        """Of scene a 1 and 3, of scene b 6: (2 + 6) / 2."""
        columns = (Column("scene", ""), Column("size", ""), Column("machine", ""))
        columns += (Column("MB", "", "MB", ".1f"),)
        rows = (("a", "1x1", "m", 1), ("a", "2x2", "m", 3), ("b", "1x1", "m", 6))
        text = self.written(columns, rows, spread=Spread("machine", "{MB}", ("scene", "size")))
        self.assertTrue(text.endswith("| m |\n| ---: |\n| 4.0 |\n"), text)

    def test_what_no_table_has(self):
        with self.assertRaisesRegex(AssertionError, "one: 2 cells"):
            self.written(rows=(("a", 1),))
        with self.assertRaisesRegex(AssertionError, "two columns of one name"):
            self.written((COLUMNS[0], COLUMNS[0]), (("a", "b"),))
        (self.folder / "one.json").write_text("{}")
        with self.assertRaisesRegex(ValueError, "one.json: expected what says how a table"):
            tables.markdown_of(self.folder, "one")

    def test_who_made_it(self):
        words = ["results.py", "one", "truck", "--out", "x", "--side-by-side=1", "--kept", "y"]
        words.append("--cross")
        program = self.folder / "program"
        program.write_text("it")
        told = [{"commit": "b", "version": "1"}, {"commit": ""}, {"commit": "a", "version": "1"}]
        with mock.patch("sys.argv", words):
            scenes = [Scene("truck", str(self.scene)), Scene("b", "builtin:b?n=1")]
            by = tables.made(program, told, [*scenes, self.write_dataset()])
        self.assertEqual(by.command, "scripts/results.py one truck --cross")
        self.assertEqual((by.commits, by.releases), (("a", "b"), ("1",)))
        self.assertEqual(list(by.inputs), ["truck.ply", "builtin:b?n=1", "photographs"])
        lengths = [len(digest) for digest in by.inputs.values()]
        self.assertEqual(lengths, [16, 0, 16])
        self.assertEqual(len(by.program), 64)


class Places(InFolder):
    README = "A\n<!-- table: one -->\nold\n<!-- end -->\nB\n<!-- table: two -->\n<!-- end -->\n"

    def test_places_in_the_readme(self):
        with contextlib.redirect_stdout(io.StringIO()):
            tables.write(self.folder, "one", BY, COLUMNS, ROWS)
        text = tables.markdown_of(self.folder, "one")
        with contextlib.redirect_stderr(io.StringIO()) as said:
            filled = results.filled(self.README, self.folder)
        self.assertEqual(filled, self.README.replace("old\n", text))
        self.assertRegex(said.getvalue(), "two.json: not there, its place is left")

    def test_a_table_of_changed_sources_is_refused(self):
        for commits, refused in ((("abc-dirty",), True), (("a", "d-dirty"), True), (("a",), False)):
            with contextlib.redirect_stdout(io.StringIO()):
                tables.write(self.folder, "one", Made("x", commits), COLUMNS, ROWS)
            said = contextlib.redirect_stderr(io.StringIO())
            with self.subTest(commits), said:
                if refused:
                    with self.assertRaisesRegex(ValueError, "one.json: commit .*-dirty"):
                        results.filled(self.README, self.folder)
                else:
                    self.assertIn("12,345", results.filled(self.README, self.folder))

    def test_pages_of_sources_only(self):
        for name in ("", "modules/dram", "build/release", "out/x", ".git"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
            for page in ("README.md", "PAPER.md"):
                (self.folder / name / page).write_text("text\n")
        found = [str(path.relative_to(self.folder)) for path in results.markdown_files(self.folder)]
        pages = ["PAPER.md", "README.md", "modules/dram/PAPER.md", "modules/dram/README.md"]
        self.assertEqual(found, pages)

    def test_from_the_command_line(self):
        with contextlib.redirect_stdout(io.StringIO()):
            tables.write(self.folder, "one", BY, COLUMNS, ROWS)
        readme = self.folder / "README.md"
        readme.write_text(self.README)
        words = ("--fill", str(readme), "--tables", str(self.folder))
        status, _, out = self.ended(results, *words)
        self.assertEqual((status, out), (0, f"{readme}\n"))
        self.assertIn("| 12,345 |", readme.read_text())
        status, said, _ = self.ended(results, "--fill", "nowhere")
        self.assertEqual((status, said), (2, "results.py: nowhere: No such file or directory"))

    def test_no_half_file(self):
        with mock.patch("os.replace", side_effect=OSError(28, "No space left on device")):
            with self.assertRaises(OSError):
                write_text(self.folder / "one", "text")
        self.assertEqual(list(self.folder.glob("one*")), [])


class Pages(InFolder):
    """What is written of tables: by question, and all of them on one page."""

    def setUp(self):
        super().setUp()
        self.tables = self.folder / "tables"
        self.tables.mkdir()
        self.write_table("one", Made("x", ("abc",), ("0.2.0",)))
        self.ask()

    def write_table(self, name: str, by: Made):
        tables.save(self.tables, name, by, COLUMNS, ROWS, "What to know.")

    def ask(self, **more):
        asked = {"question": "Which?", "finding": "This one.", "table": "one", "command": "make it"}
        (self.tables / "questions.json").write_text(json.dumps([asked | more]))

    def test_a_question(self):
        self.ask(
            columns=["scene", "cycles"], rows={"scene": ["a|b", "c"]}, caveats=["It is small."]
        )
        text = results_page.readme(self.tables)
        self.assertIn("\n## Which?\n\nThis one.\n\n<!-- rows: one -->\nMade by `x`;", text)
        self.assertIn("| scene | cycles |\n| --- | ---: |\n| a\\|b | 12,345 |\n| c | 6 |\n", text)
        self.assertIn("\nAll rows: [one.csv](one.csv). Made again by `make it`.\n<!-- end -->", text)
        self.assertIn("<!-- end -->\n\n- It is small.\n\n## All tables\n", text)
        self.assertIn("| [one](one.csv) | `x` |", text)

    def test_no_number_in_a_finding(self):
        self.ask(finding="It takes 31.2 dB.")
        with self.assertRaisesRegex(ValueError, "Which.: a finding with a number: 31.2"):
            results_page.readme(self.tables)

    def test_what_does_not_fit_the_table(self):
        for more, said in (
            ({"rows": {"scene": ["z"]}}, "0 rows of one, expected 1 to 10"),
            ({"columns": ["joules"]}, "no column joules"),
            ({"picture": "x"}, "unexpected keyword argument 'picture'"),
        ):
            self.ask(**more)
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                results_page.readme(self.tables)
        self.ask()
        tables.save(self.tables, "one", BY, COLUMNS, ROWS * 4)
        with self.assertRaisesRegex(ValueError, "12 rows of one"):
            results_page.readme(self.tables)

    def test_the_page_of_all(self):
        (self.tables / "one.svg").write_text("<svg/>")
        self.ask(figure="one.svg")
        text = results_page.html(self.tables)
        for part in (
            *("<h3>Which?</h3>", "This one.", "a|b", "12,345", "31.25", "sortable", "What to know."),
            *("against the reference picture", "data:image/svg+xml;base64,PHN2Zy8+", "make it"),
        ):
            self.assertIn(part, text)

    def test_tables_of_several_releases(self):
        self.write_table("two", Made("y", ("abc",), ("0.2.0",)))
        self.assertEqual(results_page.faults(self.tables), [])
        for by in (Made("y", ("abc",), ("0.1.0",)), Made("y", ("d",), ("0.2.0",))):
            self.write_table("two", by)
            with self.subTest(by):
                first, *named = results_page.faults(self.tables)
                self.assertEqual(first, "tables of 2 programs, expected one")
                self.assertIn("0.2.0, abc: one", named)
        self.write_table("two", Made("y", ("abc", "d"), ("0.2.0",)))
        self.assertIn("0.2.0, d: two", results_page.faults(self.tables))

    def test_tables_that_nobody_can_make_again(self):
        """Also where all are alike in it."""
        typed, again = "one (`y`), two (`y`)", "one (--all energy), two (--all energy)"
        for by, said in (
            (Made("y", ()), f"tables name no commit, since no study writes them: {typed}"),
            (
                Made("scripts/results.py energy truck", ()),
                f"tables name no commit, to be made again: {again}",
            ),
            (Made("y", ("abc",)), "tables name no release: one, two"),
            (Made("y", ("abc-dirty",), ("1",)), "tables are of uncommitted sources: one, two"),
        ):
            for name in ("one", "two"):
                self.write_table(name, by)
            with self.subTest(by):
                self.assertEqual(results_page.faults(self.tables), [f"2 {said}"])

    def test_commands_that_are_not_there(self):
        script, study = "scripts/timing.py a", "scripts/results.py time a"
        for command, gone in (
            ("scripts/explore.py a; scripts/results.py timing a", ()),
            ("scripts/results.py --all timing", ()),
            ("streaminggs simulate SCENE", ()),
            ("", ()),
            (script, (script,)),
            (f"scripts/results.py timing; {study}; {script}", (study, script)),
            ("scripts/results.py --all time", ("scripts/results.py --all time",)),
        ):
            self.write_table("one", Made(command, ("abc",), ("0.2.0",)))
            expected = [f"one: its command is not there: {call}" for call in gone]
            with self.subTest(command):
                self.assertEqual(list(results.gone(self.tables)), expected)
        self.assertIn(expected[0], self.ended(results, "--check", "--tables", str(self.tables))[1])

    def test_commands_of_this_repository_are_there(self):
        self.assertEqual(list(results.gone(results.TABLES)), [])

    def test_settings_of_this_repository_are_keys(self):
        """As --set takes them, or explore.py for one scene."""
        pages = "".join((REPOSITORY / page).read_text() for page in KEYS)
        keys = {"group", *re.findall(r"^\| `([\w.]+)`", pages, re.MULTILINE)}
        for name in ("smallest_machine", "fair_fight_front"):
            for row in tables.read_rows(results.TABLES, name):
                given = {re.split("[@=]", setting)[0] for setting in row["setting"].split()}
                self.assertLess(given, keys)

    def test_tables_that_are_made_of_tables(self):
        """With what is wrong in these."""
        digest = content_digest(self.tables / "one.csv")
        of_one = Made("y", ("abc",), ("0.2.0",), inputs={"one.csv": digest})
        self.write_table("two", of_one)
        self.assertEqual(results_page.faults(self.tables), [])
        self.write_table("one", Made("x", ("abc",)))
        said = "two is made of tables that name no release: one"
        self.assertIn(said, results_page.faults(self.tables))
        self.write_table("two", dataclasses.replace(of_one, commits=("abc", "d")))
        self.assertIn("1 tables mix commits: two (abc, d)", results_page.faults(self.tables))
        self.write_table("two", dataclasses.replace(of_one, releases=("0.1.0", "0.2.0")))
        said = "1 tables mix releases: two (0.1.0, 0.2.0)"
        self.assertIn(said, results_page.faults(self.tables))
        self.write_table("two", dataclasses.replace(of_one, inputs={"one.csv": "another"}))
        said = "two was made of another one.csv than there is"
        self.assertIn(said, results_page.faults(self.tables))

    def test_check_from_the_command_line(self):
        words = ("--check", "--tables", str(self.tables))
        with mock.patch.object(results, "REPOSITORY", self.folder):
            status, said, _ = self.ended(results, *words)
            self.assertEqual(status, 2)
            self.assertIn("tables/README.md: not what its tables give", said)
            status, _, out = self.ended(results, "--pages", "--tables", str(self.tables))
            self.assertEqual((status, out), (0, "tables/README.md\nout/results.html\n"))
            self.assertEqual(self.ended(results, *words), (0, "", ""))
            self.write_table("two", Made("y", ("d",), ("0.2.0",)))
            self.ended(results, "--pages", "--tables", str(self.tables))
            self.assertIn("0.2.0, d: two", self.ended(results, *words)[1])

    @unittest.expectedFailure
    def test_tables_of_this_repository_are_of_one_program(self):
        """They are not yet. When they are this passes, which unittest reports as a failure."""
        self.assertEqual(results_page.faults(results.TABLES), [])

    def test_pages_of_this_repository(self):
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(results.out_of_date(results.TABLES), [])

    def test_minutes_of_studies(self):
        """Not by other words of a command."""
        for command in (
            "scripts/results.py energy a; scripts/results.py energy b",
            "scripts/results.py --all energy",
        ):
            by = Made(f"{command} --machines timing", (), minutes=12.4)
            self.write_table("energy_groups", by)
            status, _, out = self.ended(results, "--list", "--tables", str(self.tables))
            self.assertEqual(status, 0)
            self.assertRegex(out, r"energy +12 min  Where the energy of a frame goes")
            for name in ("timing", "stability_table"):
                self.assertRegex(out, rf"{name} +not timed  \w")

    def test_what_a_person_says_stays(self):
        said = "A person says this."
        (self.tables / "about.json").write_text(json.dumps({"one": said}))
        for _ in range(2):
            self.write_table("one", Made("x", ("abc",), ("0.2.0",)))
            text = tables.markdown_of(self.tables, "one")
            self.assertIn(f"\n\nWhat to know.\n\n{said}\n\n", text)
            self.assertIn(said, results_page.html(self.tables))


class Smallest(InFolder):
    """Of explorations that are made up."""

    ENDED = "by time"
    HEAD = ("hfus", "mm2", *found.SHOWN, "min(fps) >= 90", "slowest view", "front")

    def explored(self, *rows: tuple) -> str:
        columns = [Column(name, SETTING if name == "hfus" else "") for name in self.HEAD]
        by = Made("scripts/explore.py truck", ("abc",), ("0.2.0",), "p", {"truck.ply": "1"})
        search = {"judged": len(rows), "ended": self.ENDED}
        tables.save(self.folder / "explored", "explore", by, columns, rows, more=search)
        return f"1280x720={self.folder / 'explored'}"

    START = (8, 6.5, 4, 0.04, 4.9, 9.5, 135, "truck 0", "")
    BEST = (3, 5, 2.5, 0.02, 3.8, 7.2, 90.8, "yard 1", "yes")

    def test_the_best_stands_beside_the_start(self):
        better_picture = (4, 5.5, *self.BEST[2:])
        found = self.explored(self.START, better_picture, self.BEST)
        words = ("--found", found, "--out", str(self.folder))
        status, line, _ = self.ended(SMALLEST_MACHINE, *words)
        self.assertEqual(status, 0, line)
        (row,) = tables.read_rows(self.folder, "smallest_machine")
        torn = self.folder / "torn.csv"
        torn.write_text("a,b\n1,2\n3\n")
        with self.assertRaisesRegex(ValueError, "torn.csv:3: got 1 cells, expected 2$"):
            tables.read_rows(self.folder, "torn")
        self.assertEqual(
            list(row.values()),
            ["1280x720", "90.0", "5.0", "3.8", "7.2", "2.5", "20.0", "90.8", "yard 1"]
            + ["135.0", "6.5", "3", "by time", "hfus=3"],
        )
        by = tables.facts_of(self.folder, "smallest_machine")["made"]
        self.assertEqual((by["commits"], by["inputs"]), (["abc"], {"truck.ply": "1"}))

    def test_what_is_none(self):
        for words, said in (
            ((), "--found: expected WxH=FOLDER"),
            (("--found", self.explored(self.START)), "no machine holds what was required"),
            (("--found", "1x1=nowhere"), "nowhere/explore.json: No such file"),
        ):
            with self.subTest(said):
                status, line, _ = self.ended(SMALLEST_MACHINE, *words, "--out", str(self.folder))
                self.assertEqual(status, 2)
                self.assertIn(said, line)
        with mock.patch.object(self, "ENDED", ""):
            words = ("--found", self.explored(self.BEST), "--out", str(self.folder))
        said = "explore.json: got no 'ended', expected that of an exploration with --search"
        self.assertIn(said, self.ended(SMALLEST_MACHINE, *words)[1])


class Stated(InFolder):
    """Jobs of studies, by scripts that are made up."""

    def setUp(self):
        super().setUp()
        self.scripts = self.folder / "scripts"
        self.scripts.mkdir()
        (self.scripts / "results.py").write_text(f"""\
import pathlib, sys, time
sys.path.insert(0, {str(REPOSITORY / "scripts")!r})
import tables
here, of = pathlib.Path({str(self.folder)!r}), sys.argv[2]
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
with (here / "calls").open("a") as file:
    print(of, file=file)
while (here / "hold").exists() and of == "b":
    time.sleep(0.05)
if of == "bad":
    sys.exit(1)
by = tables.Made(f"results.py one {{of}}", (of,), ("1",), "p", {{of: "0"}})
tables.save(out, "one", by, (tables.Column("s", "") ,), ((of,), (2,)), f"About {{of}}.")
if of == "b":
    tables.save(out, "two", by, (tables.Column("s", ""),), ())
""")
        (self.folder / "make.py").write_text(f"""\
import pathlib, sys
sys.path.insert(0, {str(REPOSITORY / "scripts")!r})
from results import Jobs
from tables import Study
def arguments(to):
    to.add_argument("scenes", nargs="*")
    to.add_argument("--program", type=pathlib.Path)
here = pathlib.Path({str(self.folder)!r})
jobs = Jobs(here / "truck.ply", here / "scripts", here / "kept", here)
study = Study("one", "", sys.argv[1:], arguments, print, {{"another": ["read"]}})
jobs.make(study, here / "made")
""")

    def words(self, *calls: str) -> list[str]:
        return [sys.executable, "-B", str(self.folder / "make.py"), *calls]

    def calls(self) -> list[str]:
        path = self.folder / "calls"
        return path.read_text().split() if path.exists() else []

    BOTH = ("results.py one a", "results.py one b")

    def test_killed_it_goes_on(self):
        hold = self.folder / "hold"
        hold.touch()
        first = subprocess.Popen(self.words(*self.BOTH))
        while self.calls() != ["a", "b"]:
            self.assertIsNone(first.poll())
            time.sleep(0.02)
        first.kill()
        first.wait()
        self.assertFalse((self.folder / "made").exists())
        hold.unlink()
        for _ in range(2):
            subprocess.run(self.words(*self.BOTH), check=True)
            self.assertEqual(self.calls(), ["a", "b", "b"])
            made = self.folder / "made"
            self.assertEqual((made / "one.csv").read_text(), "s\na\n2\nb\n2\n")
            facts = json.loads((made / "one.json").read_text())
            self.assertEqual(facts["about"], "About a.\n\nAbout b.")
            by = facts["made"]
            self.assertEqual(by["command"], "results.py one a; results.py one b")
            self.assertEqual((by["commits"], by["inputs"]), (["a", "b"], {"a": "0", "b": "0"}))
            self.assertGreater(by["minutes"], 0)
        self.assertTrue((self.folder / "made" / "two.csv").exists())

    def test_how_long_it_took(self):
        subprocess.run(self.words(*self.BOTH), check=True)
        facts = json.loads((self.folder / "made" / "one.json").read_text())
        first = facts["made"]["minutes"]
        self.assertGreater(first, 0)
        # Of another script, or data of one, everything is made again, of what is kept: so the first
        # time counts.
        for times, name in ((2, "results.py"), (3, "listed.json")):
            with (self.scripts / name).open("a") as file:
                print("# changed", file=file)
            subprocess.run(self.words(*self.BOTH), check=True)
            self.assertEqual(self.calls(), ["a", "b"] * times)
            facts = json.loads((self.folder / "made" / "one.json").read_text())
            self.assertGreater(facts["made"]["minutes"], first)

    def test_what_a_job_reads(self):
        """Scenes and data sets of ../shared by name, all of them without one, programs, tables of
        another study: of each change it is made again."""
        shared, program = self.folder / "shared", self.folder / "program"
        table = self.folder / "made" / "read.csv"
        files = [shared / path for path in ("scenes/a.ply.xz", "cameras/a.json", "data/b/image")]
        for path in (*files, program, table):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        times = 0
        for call, changed in (
            (f"results.py one a --program {program}", (files[0], files[1], program, table)),
            ("results.py one b", (files[2],)),
            ("results.py one", files),
        ):
            for path in (None, *changed):
                with self.subTest(call, changed=path):
                    if path:
                        path.write_text(f"{path} {times}")
                    times += 1
                    with mock.patch.dict("os.environ", SGS_SHARED=str(shared)):
                        for _ in range(1 if path else 2):
                            subprocess.run(self.words(call), check=True)
                            self.assertEqual(len(self.calls()), times)

    def test_studies_come_behind_those_that_they_read(self):
        known = results.studies()
        order = results.in_order(known, known)
        self.assertEqual(sorted(order), list(known))
        for name, study in known.items():
            for other in study.reads:
                self.assertLess(order.index(other), order.index(name), (other, name))
        self.assertLess(order.index("quality_table"), order.index("headline"))
        few = ["headline", "quality_table"]
        self.assertEqual(results.in_order(known, few), ["quality_table", "headline"])

    def test_what_fails_writes_no_table(self):
        done = subprocess.run(
            self.words("results.py one a", "results.py one bad"), stderr=subprocess.PIPE, text=True
        )
        self.assertIn("results.py one bad --out", done.stderr)
        self.assertIn("ended with exit status 1", done.stderr)
        self.assertFalse((self.folder / "made").exists())

    def test_questions_name_columns_that_studies_write(self):
        """So that a table made again can be shown."""
        written = set()
        for path in results.STUDIES.glob("*.py"):
            for value in vars(importlib.import_module(f"studies.{path.stem}")).values():
                if isinstance(value, tuple):
                    written |= {of.name for of in value if isinstance(of, Column)}
        for of in results_page.questions(results.TABLES):
            with self.subTest(of.question):
                self.assertEqual({*of.columns, *of.rows} - written, set())

    def test_every_study_states_one_that_it_takes(self):
        known = results.studies()
        for name, study in known.items():
            calls = study.jobs
            self.assertTrue(any(call.startswith(f"results.py {name}") for call in calls), name)
            for script, *words in map(shlex.split, calls):
                with self.subTest(name, words=words):
                    if script == "results.py":
                        results.parser_of(known[words[0]]).parse_args(words[1:])
                    else:
                        self.assertEqual(script, "explore.py")
                        self.assertIn(words[words.index("--recipe") + 1], options.recipes())

    def test_one_study_alone_does_not_write_over_the_tables_of_this_repository(self):
        for study in results.studies().values():
            arguments = results.parser_of(study).parse_args([])
            self.assertEqual(arguments.out, results.OUT)
        self.assertFalse(results.OUT.is_relative_to(results.TABLES))

    def test_what_is_refused(self):
        for commit, words, said in (
            ("abc", ("--all", "nope"), "--all: got nope, expected some of binding_check"),
            ("abc-dirty", ("--all",), "commit abc-dirty, expected one of committed sources"),
        ):
            with self.subTest(said), mock.patch.object(
                results, "program_provenance", return_value={"commit": commit}
            ):
                status, line, _ = self.ended(results, *words)
                self.assertEqual(status, 2)
                self.assertIn(said, line)


if __name__ == "__main__":
    unittest.main()
