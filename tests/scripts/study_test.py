"""explore.py with a study that several workers share, one of which is killed. A program stands in
for the command; the databases are real ones."""

import contextlib
import csv
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest
from collections.abc import Iterator

from in_folder import COMMAND, REPOSITORY, InFolder, nightly

PYTHON = "/usr/bin/python3"
SERVER = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"))
LOST_AFTER = 4  # seconds


def has(*modules: str) -> bool:
    words = [PYTHON, "-c", f"import {', '.join(modules)}"]
    with contextlib.suppress(OSError):
        return subprocess.run(words, stderr=subprocess.DEVNULL, check=False).returncode == 0
    return False


def free_port() -> int:
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


@contextlib.contextmanager
def postgresql() -> Iterator[str]:
    """URL of an empty database of a server of its own, on loopback."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        as_user: list[str] = []
        if os.geteuid() == 0:  # the server refuses to be root
            as_user = ["runuser", "-u", "postgres", "--"]
            shutil.chown(folder, "postgres")
            folder.chmod(0o700)

        def call(tool: str, *words: str) -> None:
            command = [*as_user, str(SERVER[-1].with_name(tool)), *words]
            subprocess.run(command, check=True, capture_output=True, cwd=folder)

        port = free_port()
        call("initdb", "-D", f"{folder}/data", "-A", "trust", "-U", "explorer", "--no-sync")
        options = f"-p {port} -h 127.0.0.1 -k {folder}"
        log = f"{folder}/log"
        call("pg_ctl", "-D", f"{folder}/data", "-o", options, "-l", log, "-w", "start")
        try:
            yield f"postgresql://explorer@127.0.0.1:{port}/postgres"
        finally:
            call("pg_ctl", "-D", f"{folder}/data", "-m", "immediate", "stop")


@unittest.skipUnless(has("optuna"), "python3-optuna is not installed")
class Studies(InFolder):
    BODY = """
        time.sleep(0.5)
        with (HERE / "drawn").open("a") as file:
            print(SET["hfus"], file=file)
        while (HERE / "hold").exists():
            time.sleep(0.05)
        finish()
        """

    def words(self, out: str, *more: str) -> list[str]:
        words = [PYTHON, "-B", str(REPOSITORY / "scripts" / "explore.py"), str(self.scene)]
        words += ["--streaminggs", str(self.folder / "streaminggs")]
        words += ["--out", str(self.folder / out)]
        words += ["-j", "1", "--lost-after", str(LOST_AFTER), "--objectives", "cycles,mm2"]
        return [*words, "--axis", "hfus=1,2,3,4,5,6,7,8", *more]

    def rows(self, out: str) -> list[list[str]]:
        return list(csv.reader((self.folder / out / "explore.csv").read_text().splitlines()))

    def drawn(self) -> list[int]:
        path = self.folder / "drawn"
        return sorted(map(int, path.read_text().split())) if path.exists() else []

    def check_killed(self, storage: str):
        """Two workers, of which the first is killed in the middle of a configuration."""
        self.stand_in(self.BODY)
        subprocess.run(self.words("alone"), check=True, capture_output=True)
        (self.folder / "drawn").unlink(missing_ok=True)
        study = ("--study", "grid", "--storage", storage)
        first = subprocess.Popen(
            self.words("first", *study), stderr=subprocess.PIPE, start_new_session=True
        )
        for _ in range(1200):
            if self.drawn():
                break
            time.sleep(0.1)
        # With its simulation, so that the configuration is drawn by nobody.
        time.sleep(0.15)
        os.killpg(first.pid, signal.SIGKILL)
        first.communicate()
        before = self.drawn()
        self.assertTrue(0 < len(before) < 8, before)
        self.check_together("second", "third", study)
        self.assertEqual(sorted(set(self.drawn())), list(range(1, 9)))
        # The one that was under way when its worker died may have been drawn already.
        self.assertLessEqual(len(self.drawn()), 9)

    def check_together(self, one: str, other: str, study: tuple[str, ...]):
        """Both started at once: each ends with the table that one alone makes."""
        workers = [
            subprocess.Popen(
                self.words(name, *study),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
            for name in (one, other)
        ]
        for worker in workers:
            said = worker.communicate(timeout=120)[1]
            self.assertEqual(worker.returncode, 0, said)
        for name in (one, other):
            self.assertEqual(sorted(self.rows(name)), sorted(self.rows("alone")))

    def check_begun_at_once(self, storage: str):
        self.stand_in(self.BODY)
        subprocess.run(self.words("alone"), check=True, capture_output=True)
        study = ("--study", "begun at once", "--storage", storage)
        self.check_together("left", "right", study)

    def test_what_is_too_large_is_told_and_not_drawn(self):
        at_once = 'if "64x36" in sys.argv: finish(); sys.exit()'
        self.stand_in(self.BODY.replace("time.sleep(0.5)", at_once))
        for most, held, status, why in (
            (4, 3, 0, "3 hold mm2 <= 4"),
            (1, 0, 3, r"None of 8 holds: 8 too large \(mm2 <= 1\); the nearest misses mm2 <= 1"),
        ):
            (self.folder / "drawn").unlink(missing_ok=True)
            words = ("--search", "random", "--require", f"mm2 <= {most}")
            done = subprocess.run(self.words(f"{most}", *words), capture_output=True, text=True)
            with self.subTest(most):
                self.assertEqual(done.returncode, status, done.stderr)
                self.assertRegex(done.stdout, why)
                self.assertEqual(self.drawn(), list(range(1, held + 1)))
                self.assertEqual(len(self.rows(f"{most}")), 1 + 8)

    def test_a_file(self):
        """One worker at a time; what a killed one had under way the next takes up at once."""
        self.stand_in(self.BODY)
        subprocess.run(self.words("alone"), check=True, capture_output=True)
        (self.folder / "drawn").unlink()
        study = ("--study", "grid", "--storage", f"sqlite:///{self.folder}/study.db")
        hold = self.folder / "hold"  # the first stays at work until the other has looked
        hold.touch()
        first = subprocess.Popen(
            self.words("first", *study), stderr=subprocess.PIPE, start_new_session=True
        )
        while not self.drawn():
            time.sleep(0.1)
        other = subprocess.run(self.words("other", *study), capture_output=True, text=True)
        self.assertIn("another worker has it, expected postgresql:// for several", other.stderr)
        self.assertEqual(other.returncode, 2)
        os.killpg(first.pid, signal.SIGKILL)
        first.communicate()
        hold.unlink()
        self.assertEqual(len(self.drawn()), 1)
        subprocess.run(self.words("second", *study), check=True, capture_output=True, timeout=120)
        self.assertEqual(sorted(self.rows("second")), sorted(self.rows("alone")))
        self.assertLessEqual(len(self.drawn()), 9)

    @unittest.skipUnless(SERVER and has("psycopg2"), "postgresql is not installed")
    @nightly
    def test_a_server(self):
        with postgresql() as url:
            self.check_begun_at_once(url)
            self.check_killed(url)

    def test_a_search_finds_the_smallest_that_holds(self):
        self.stand_in('SET.setdefault("hfus", "2"); finish()')  # where it begins
        words = self.words("out", "--search", "tpe", "--require", "min(fps) >= 3")
        words[words.index("cycles,mm2")] = "mm2"
        words += ["--trials", "8"]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        front = [row for row in self.rows("out")[1:] if row[-1]]
        self.assertEqual([row[0] for row in front], ["3"])

    @nightly
    def test_trials_are_what_is_judged(self):
        """Of two threads as of one; not what is beside; of a study what earlier runs judged."""
        self.stand_in("time.sleep(0.2); finish()")
        words = ("-j", "2", "--search", "random", "--beside", "by hand: hfus=8 hfu.cfus=2")
        for more, trials, drawn in (
            (("--study", "a"), 3, 1 + 3),
            (("--study", "a"), 3, 1 + 3),
            (("--study", "a"), 5, 1 + 5),
            # In the same folder: what is kept counts, but for what no study has.
            ((), 5, 1 + 5),
        ):
            with self.subTest(more, trials=trials):
                told = ("--trials", str(trials), *more)
                done = subprocess.run(
                    self.words("out", *words, *told), capture_output=True, text=True, check=False
                )
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(len(self.rows("out")) - 1, drawn, done.stderr)

    @unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
    @nightly
    def test_the_axes_of_a_machine_begin_at_its_preset(self):
        for machine in ("exact", "paper"):
            with self.subTest(machine):
                words = self.words(machine, "--machine", machine, "--search", "random")
                words[words.index("--streaminggs") + 1] = COMMAND
                words += ["--trials", "2", "--size", "64x36"]
                done = subprocess.run(words, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(" on the front", done.stderr)

    @nightly
    def test_another_content_of_a_file_is_another_task(self):
        self.stand_in("finish()")
        config, memspec = self.folder / "mine.json", self.folder / "memspec.json"
        memspec.write_text("{}")
        config.write_text(f'{{"dram": {{"memspec": "{memspec}"}}}}')
        words = self.words("out", "--study", "a", "--config", str(config))
        words[words.index("hfus=1,2,3,4,5,6,7,8")] = "hfus=1"
        subprocess.run(words, check=True, capture_output=True)
        for path in (config, memspec, self.scene, self.scene.with_suffix(".json")):
            with self.subTest(path.name):
                content = path.read_bytes()
                path.write_bytes(content + b" ")
                done = subprocess.run(words, capture_output=True, text=True, check=False)
                self.assertRegex(done.stderr, "--study a: there is one of another task\n$")
                path.write_bytes(content)
        subprocess.run(words, check=True, capture_output=True)

    def test_what_is_refused(self):
        self.stand_in("finish()")
        db = f"sqlite:///{self.folder}/study.db"
        subprocess.run(self.words("out", "--study", "a", "--storage", db), capture_output=True)
        for more, line in (
            (("--study", "a", "--storage", db, "--axis", "hfu.cfus=1,2"), "--study a: there is one of"),
            (("--study", "a", "--storage", db, "--size", "64x36"), "--study a: there is one of"),
            (("--study", "b", "--storage", "nowhere:///x"), "--storage: nowhere:///x: "),
            (("--study", "b", "--storage", "sqlite:////no/x"), "--storage: sqlite:////no/x: can"),
            (("--study", "b", "--lost-after", "1"), "--lost-after: 1, expected at least 4"),
        ):
            with self.subTest(more):
                done = subprocess.run(self.words("out", *more), capture_output=True, text=True)
                self.assertRegex(done.stderr.rstrip().rpartition("\n")[2], f"explore.py: {line}")
                self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    unittest.main()
