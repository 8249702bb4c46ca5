"""explore.py: its tables, what it leaves out, what it keeps. A program stands in for the command."""

import csv
import signal
import subprocess
import sys
import unittest

from in_folder import REPOSITORY, InFolder


class Exploring(InFolder):
    def explore(self, body: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        program = self.stand_in(body)
        command = [sys.executable, "-B", str(REPOSITORY / "scripts" / "explore.py")]
        command += [str(self.scene), "--streaminggs", str(program), "--out", str(self.folder)]
        command += ["--objectives", "cycles", "--side-by-side", "1", *arguments]
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            # Whoever runs the tests in the background has SIGINT ignored.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def rows(self, name: str) -> list[list[str]]:
        return list(csv.reader((self.folder / name).read_text().splitlines()))

    HEAD = ["hfus", "group", "cycles", "binding", "pareto"]

    def test_tables_show_what_was_simulated(self):
        done = self.explore("finish()", "--axis", "hfus=2,4")
        self.assertEqual((done.returncode, done.stderr.count("Traceback")), (0, 0))
        rows = [["2", "112x80", "4", "dram", ""], ["4", "112x80", "2", "dram", "yes"]]
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, *rows])
        self.assertIn("1 of 2 configurations are on the Pareto front", done.stdout)

    def test_memory_is_as_large_as_needed_unless_it_is_said(self):
        body = """
            with (HERE / "sram").open("a") as file:
                print(SET["sram.input_bytes"], SET["sram.shared_bytes"], file=file)
            finish()
            """
        self.explore(body, "--axis", "hfus=2")
        self.explore(body, "--axis", "hfus=2", "--set", "sram.shared_bytes=900")
        self.explore(body, "--axis", "hfus=2", "--axis", "sram.shared_bytes=700")
        self.assertEqual((self.folder / "sram").read_text(), "0 0\n0 900\n0 700\n")

    def test_a_refused_configuration_is_named_and_left_out(self):
        body = """
            if SET["hfus"] == "3":
                print("hfus: 3 is odd", file=sys.stderr)
                sys.exit(2)
            finish()
            """
        done = self.explore(body, "--axis", "hfus=2,3")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.rows("explore.csv"), [self.HEAD, ["2", "112x80", "4", "dram", "yes"]])
        self.assertRegex(done.stdout, "Refused: truck .* hfus=3: hfus: 3 is odd")

    def test_what_was_simulated_is_kept(self):
        for what, end, status, line in (
            (
                "interrupted",
                "os.kill(os.getppid(), signal.SIGINT); time.sleep(1)",
                130,
                "interrupted$",
            ),
            ("failed", "print('it differs'); sys.exit(1)", 1, "truck .*: it differs$"),
        ):
            with self.subTest(what):
                body = f"""
                    if SET["hfus"] == "4":
                        {end}
                    finish()
                    """
                done = self.explore(body, "--axis", "hfus=2,4,8")
                self.assertEqual(done.returncode, status)
                self.assertNotIn("Traceback", done.stderr)
                self.assertRegex(done.stderr.splitlines()[-1], line)
                kept = self.rows("explore_partial.csv")
                self.assertEqual(kept, [self.HEAD, ["2", "112x80", "4", "dram", "yes"]])
                text = (self.folder / "explore_partial.md").read_text()
                self.assertTrue(text.startswith("Not complete: 1 of 3 configurations.\n"))
                self.assertFalse((self.folder / "explore.csv").exists())


if __name__ == "__main__":
    unittest.main()
