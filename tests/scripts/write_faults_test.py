"""write_faults.py: what it says of writers that leave half a file, say nothing or go on, and that the
command's outputs are whole at some of the calls; all of them are for the script."""

import pathlib
import shutil
import sys
import unittest
from unittest import mock

from in_folder import COMMAND, InFolder, nightly  # isort: skip (finds the scripts)
import write_faults
from write_faults import Work

# Each writes two pieces to a.bin.
WRITERS = {
    "under its final name": """
        with open("a.bin", "wb", buffering=0) as file:
            if file.write(b"a" * 9) + (file.write(b"b" * 9) or 0) != 18: sys.exit("a.bin: cut")
        """,
    "whole or not at all": """
        try:
            with open("a.bin.part", "wb", buffering=0) as file:
                if file.write(b"a" * 9) + (file.write(b"b" * 9) or 0) != 18: raise OSError("cut")
            os.rename("a.bin.part", "a.bin")
        except OSError as error:
            os.unlink("a.bin.part")
            sys.exit(f"a.bin: {error}")
        """,
    "without looking": """
        with open("a.bin.part", "wb", buffering=0) as file:
            for piece in (b"a" * 9, b"b" * 9):
                try: file.write(piece)
                except OSError: pass
        os.rename("a.bin.part", "a.bin")
        """,
}


class Tampered(unittest.TestCase):
    CALLS = (
        ("one process", ['write(1<a>, "x", 1) = -1 ENOSPC (INJECTED)'], [0]),
        ("one that is killed", ['write(1<a>, "x", 1) = ?', "+++ killed by SIGKILL +++"], [0]),
        (
            "one of two, in the call that it began",
            [
                '17 write(7<pipe:[3]>, "x", 1 <unfinished ...>',
                '18 write(5<b>, "y", 1 <unfinished ...>',
                "17 <... write resumed>) = ?",
                "18 <... write resumed>) = 1",
                "17 +++ killed by SIGKILL +++",
                "16 --- SIGCHLD {si_code=CLD_KILLED, si_status=SIGKILL} ---",
            ],
            [0],
        ),
        ("none", ['write(1<a>, "x", 1) = 1'], []),
    )

    def test_calls_by_table(self):
        for name, calls, expected in self.CALLS:
            with self.subTest(name):
                self.assertEqual(write_faults.tampered(calls), [calls[i] for i in expected])


class Refused(InFolder):
    def test_what_is_refused(self):
        for words, said in (
            (("--most", "-1"), "--most: got -1, expected a number of 0 or more$"),
            (("nope",), "'nope': no such job, expected of: 'simulate', 'simulate, a run is there', "),
        ):
            with self.subTest(words):
                status, line, made = self.ended(write_faults, *words, "--out", str(self.folder))
                self.assertRegex(line, f"^write_faults.py: {said}")
                self.assertEqual((status, made), (2, ""))

    def test_no_trial_is_no_success(self):
        """Where strace may not look, no call is seen."""
        work, words = Work(("w",)), ["sh", "-c", "echo a > a.bin"]
        with mock.patch.object(write_faults.Bench, "most_calls", return_value=0):
            with self.assertRaisesRegex(write_faults.Failure, "^job: no trial: strace"):
                write_faults.tried("job", work, {"w": words}, 0, print)


@unittest.skipUnless(shutil.which("strace"), "strace: not there, Debian's package of that name")
@nightly
class WriteFaults(InFolder):
    def found(self, work: Work, programs: dict, most: int) -> list[str]:
        said: list[str] = []
        rows = write_faults.tried("job", work, programs, most, said.append)
        self.assertGreater(sum(row[3] for row in rows), 0)
        self.assertEqual(sum(row[4] for row in rows), len(said))
        return said

    def found_of(self, writer: str) -> set[str]:
        program = self.folder / "writer.py"
        body = WRITERS[writer].replace("\n        ", "\n")
        program.write_text("import os, sys\n" + body)
        words = [sys.executable, "-ISB", str(program)]
        return {line.partition(": ")[2] for line in self.found(Work(("w",)), {"w": words}, 4)}

    def test_what_is_cut_under_its_name_is_found(self):
        found = self.found_of("under its final name")
        self.assertIn("killed at a write, itself, 2: leaves a.bin, 9 bytes", found)
        self.assertIn("the disk is full, all it starts, 5: leaves a.bin, 5 bytes", found)

    def test_a_fault_that_is_not_noticed_is_found(self):
        found = self.found_of("without looking")
        self.assertIn("a write fails, itself, 1: exit status 0", found)
        self.assertIn("a write fails, itself, 2: leaves a.bin, 9 bytes", found)

    def test_a_writer_of_whole_files_has_none(self):
        self.assertEqual(self.found_of("whole or not at all"), set())

    @unittest.skipUnless(COMMAND, "the command is not built: no SystemC")
    def test_the_command_leaves_whole_outputs(self):
        programs = {write_faults.SG: [str(pathlib.Path(COMMAND).resolve())]}
        for name in ("simulate", "render", "sweep", "train", "report.py"):
            with self.subTest(name):
                self.assertEqual(self.found(write_faults.WORKS[name], programs, 2), [])


if __name__ == "__main__":
    unittest.main()
