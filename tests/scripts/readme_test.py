"""README.md of the project: its examples print what stands there, its commands exist and take their
options, and it cites the version of the program."""

import contextlib
import io
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from in_folder import COMMAND, REPOSITORY  # isort: skip (finds the scripts)
import streaminggs

TEXT = (REPOSITORY / "README.md").read_text(encoding="utf-8")
EXAMPLE = r"<!-- example: {} -->\n+```\w*\n(.*?)```"
CODE = re.compile(r"`([^`\n]+)`")
WALL_TIME = re.compile(r"(?m)^( +0 .*?)\S+$")  # at the end of a view's line


def example(name: str) -> str:
    return re.search(EXAMPLE.format(name), TEXT, re.DOTALL)[1]


def commands() -> list[list[str]]:
    """Words of each command in a sentence or a table."""
    spans = CODE.findall(re.sub(r"(?s)```.*?```", "", TEXT))
    return [shlex.split(span) for span in spans if span.startswith(("streaminggs ", "scripts/"))]


def help_of(words: list[str]) -> str:
    """Of a command of the program, or of a script in Python."""
    if words[0] == "streaminggs":
        start = [COMMAND] if words[1].startswith("--") else [COMMAND, words[1]]
    else:
        start = [sys.executable, "-B", str(REPOSITORY / words[0])]
    return subprocess.run([*start, "--help"], capture_output=True, text=True, check=True).stdout


class Cites(unittest.TestCase):
    def test_the_version_of_the_program(self):
        build = (REPOSITORY / "CMakeLists.txt").read_text()
        version = re.search(r"project\(\w+ VERSION (\S+)", build)[1]
        self.assertEqual(re.findall(r"version = \{(.*?)\}", TEXT), [version])


@unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
class Examples(unittest.TestCase):
    def test_what_the_first_frame_prints(self):
        """Lines may be left out. Wall time differs."""
        with tempfile.TemporaryDirectory() as out:
            words = ["simulate", "builtin:object?n=60000", "--view", "0", "--out", out]
            self.assertIn(" ".join(f"'{w}'" if "?" in w else w for w in words[:4]),
                          (REPOSITORY / "scripts" / "run.sh").read_text())  # fmt: skip
            printed = subprocess.run([COMMAND, *words], capture_output=True, text=True).stdout
        lines = iter(WALL_TIME.sub(r"\1", printed).splitlines())
        for line in WALL_TIME.sub(r"\1", example("first_frame")).splitlines():
            self.assertIn(line, lines)

    def test_what_the_python_example_prints(self):
        program = mock.patch.dict(streaminggs.run.__kwdefaults__, program=COMMAND)
        with program, contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(example("python"), {})
        self.assertEqual(printed.getvalue(), example("python_prints"))

    def test_options_of_commands(self):
        found = commands()
        self.assertGreater(len(found), 8)
        for words in found:
            with self.subTest(" ".join(words)):
                if words[0].startswith("scripts/"):
                    self.assertTrue((REPOSITORY / words[0]).exists())
                if words[0].endswith(".sh") or "[" in words[0]:
                    continue
                said = help_of(words)
                for option in (word for word in words[1:] if word.startswith("--")):
                    self.assertRegex(said, rf"{option}\b")


if __name__ == "__main__":
    unittest.main()
