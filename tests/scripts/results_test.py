"""Tables of results: both files, the Markdown that comes from them, and places in READMEs."""

import contextlib
import io
import json
import math
import unittest
from unittest import mock

from in_folder import RESULTS, InFolder  # isort: skip (finds the scripts)
import results
from results import Column, Made, Spread

BY = Made("scripts/results.py one truck", ("abc",))
COLUMNS = (
    Column("scene", "its name"),
    Column("view", "of a camera", form="d"),
    Column("cycles", "of the frame", "cycles", ","),
    Column("PSNR dB", "against the reference picture", "dB", ".1f"),
)
ROWS = (("a|b", 0, 12345, 31.25), ("c", 1, 6, math.inf), ("d", 2, None, None))


class Writing(InFolder):
    def written(self, columns=COLUMNS, rows=ROWS, by=BY, **more) -> str:
        with contextlib.redirect_stdout(io.StringIO()) as out:
            results.write(self.folder, "one", by, columns, rows, **more)
        text = results.markdown_of(self.folder, "one")
        self.assertEqual(out.getvalue(), text + "\n\n")
        return text

    def test_both_files_and_their_markdown(self):
        self.assertEqual(
            self.written(about="What to know."),
            "Made by `scripts/results.py one truck`; commit abc.\n\nWhat to know.\n\n"
            "| scene | view | cycles | PSNR dB |\n| --- | ---: | ---: | --- |\n"
            "| a\\|b | 0 | 12,345 | 31.2 |\n| c | 1 | 6 | equal |\n| d | 2 |  |  |\n",
        )
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
            results.markdown_of(self.folder, "one")

    def test_who_made_it(self):
        words = ["results.py", "one", "truck", "--out", "x", "--side-by-side=1", "--kept", "y"]
        words.append("--cross")
        program = self.folder / "program"
        program.write_text("it")
        told = [{"commit": "b", "version": "1"}, {"commit": ""}, {"commit": "a", "version": "1"}]
        with mock.patch("sys.argv", words):
            scenes = [results.Scene("truck", str(self.scene)), results.Scene("b", "builtin:b?n=1")]
            by = results.made(program, told, [*scenes, self.write_dataset()])
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
            results.write(self.folder, "one", BY, COLUMNS, ROWS)
        text = results.markdown_of(self.folder, "one")
        with contextlib.redirect_stderr(io.StringIO()) as said:
            filled = RESULTS.filled(self.README, self.folder)
        self.assertEqual(filled, self.README.replace("old\n", text))
        self.assertRegex(said.getvalue(), "two.json: not there, its place is left")

    def test_a_table_of_changed_sources_is_refused(self):
        for commits, refused in ((("abc-dirty",), True), (("a", "d-dirty"), True), (("a",), False)):
            with contextlib.redirect_stdout(io.StringIO()):
                results.write(self.folder, "one", Made("x", commits), COLUMNS, ROWS)
            said = contextlib.redirect_stderr(io.StringIO())
            with self.subTest(commits), said:
                if refused:
                    with self.assertRaisesRegex(ValueError, "one.json: commit .*-dirty"):
                        RESULTS.filled(self.README, self.folder)
                else:
                    self.assertIn("12,345", RESULTS.filled(self.README, self.folder))

    def test_readmes_of_sources_only(self):
        for name in ("", "modules/dram", "build/release", "out/x", ".git"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
            (self.folder / name / "README.md").write_text("text\n")
        found = [str(path.relative_to(self.folder)) for path in RESULTS.readmes(self.folder)]
        self.assertEqual(found, ["README.md", "modules/dram/README.md"])

    def test_from_the_command_line(self):
        with contextlib.redirect_stdout(io.StringIO()):
            results.write(self.folder, "one", BY, COLUMNS, ROWS)
        readme = self.folder / "README.md"
        readme.write_text(self.README)
        words = ("--fill", str(readme), "--tables", str(self.folder))
        status, _, out = self.ended(RESULTS, *words)
        self.assertEqual((status, out), (0, f"{readme}\n"))
        self.assertIn("| 12,345 |", readme.read_text())
        status, said, _ = self.ended(RESULTS, "--fill", "nowhere")
        self.assertEqual((status, said), (2, "results.py: nowhere: No such file or directory"))

    def test_no_half_file(self):
        with mock.patch("os.replace", side_effect=OSError(28, "No space left on device")):
            with self.assertRaises(OSError):
                results.write_text(self.folder / "one", "text")
        self.assertEqual(list(self.folder.glob("one*")), [])


if __name__ == "__main__":
    unittest.main()
