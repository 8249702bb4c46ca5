"""How the scripts end, whatever a simulation does: a program stands in for the command."""

import contextlib
import importlib
import io
import os
import shutil
import subprocess
import unittest
from unittest import mock

from in_folder import REPOSITORY, InFolder, file_of, name_of, nightly  # isort: skip (finds the scripts)
import explore
import results
from runs import simulations
from runs.scenes import Failure, Scene
from studies import error_against_time
from studies.choices import CHOICES
from studies.compare_machines import COMPARE_MACHINES
from studies.stability import STABILITY_TABLE
from studies.error_against_time import ERROR_AGAINST_TIME
from studies.fitting import BOUNDARY_STUDY, TRAINING_CURVES
from studies.frame_costs import BINDING_CHECK, ENERGY, TIMING
from studies.published import PUBLISHED_FIGURES
from studies.quality import QUALITY_TABLE, VOXEL_STUDY
from studies.variants import HALF_BY_STAGE, WORK_PRECISION

SCENE = Scene("toy", "builtin:object")


class Simulator(InFolder):
    def test_outcomes(self):
        for what, body, expected in (
            ("views", "finish()", ([8], "")),
            (
                "a refusal",
                "print('group_width_px: 6 is\\nodd', file=sys.stderr); sys.exit(2)",
                ([], "group_width_px: 6 is odd"),
            ),
        ):
            with self.subTest(what):
                outcome = simulations.simulate(self.stand_in(body), simulations.Run(SCENE))
                cycles = [view["frame"]["cycles"] for view in outcome.views]
                self.assertEqual((cycles, outcome.refused), expected)

    def test_failures(self):
        for what, body, expected in (
            (
                "frame that differs",
                "print('a table'); print('the frame differs'); sys.exit(1)",
                "^toy exact hfus=2: the frame differs$",
            ),
            ("crash", "os.kill(os.getpid(), signal.SIGKILL)", "^toy exact hfus=2: exit status -9$"),
        ):
            run = simulations.Run(SCENE, overrides=("hfus=2",))
            with self.subTest(what), self.assertRaisesRegex(Failure, expected):
                simulations.simulate(self.stand_in(body), run)


# Script, and the arguments besides a scene that it cannot do without.
SCRIPTS = (
    (BINDING_CHECK, ()),
    (BOUNDARY_STUDY, ()),
    (CHOICES, ("--tables", "merge_heap")),
    (ENERGY, ()),
    (explore, ("--axis", "hfus=2,4")),
    (HALF_BY_STAGE, ()),
    (QUALITY_TABLE, ()),
    (TIMING, ()),
    (VOXEL_STUDY, ()),
    (WORK_PRECISION, ()),
)
# These ask first whether their settings are known, and take no answer but a good one.
ASKING = (BOUNDARY_STUDY, QUALITY_TABLE, VOXEL_STUDY)


class Ends(InFolder):
    """Bad input: one line that says what is wrong, and exit status 2."""

    def check(self, script, arguments, expected_status, expected_line):
        status, line, _ = self.ended(script, str(self.scene), *arguments)
        self.assertRegex(line, f"^{file_of(script)}: {expected_line}")
        self.assertEqual(status, expected_status)
        self.assertEqual(list(self.folder.glob("*/*.csv")), [])
        out = self.folder / "out"
        self.assertTrue(not out.exists() or any(out.iterdir()), "it left an empty folder")

    def test_of_every_script(self):
        file = self.folder / "file"
        file.write_text("not a program\n")
        refusing = "print('streaminggs: --view: 99, expected 0', file=sys.stderr); sys.exit(2)"
        differing = "print('the frame differs'); sys.exit(1)"
        cases = (
            ("--out is a file", "finish()", ("--out", str(file)), 2, "--out: .*expected a folder"),
            ("--out below a file", "finish()", ("--out", f"{file}/x"), 2, "--out: .* a folder"),
            ("no program", "", ("--streaminggs", "no"), 2, "no: not there; scripts/setup.sh"),
            ("not a program", "", ("--streaminggs", str(file)), 2, ".*file: cannot be run: Perm"),
            ("all refused", refusing, (), 2, "(truck .*: )?streaminggs: --view: 99, expected 0$"),
            ("differs", differing, (), 1, "truck .*: the frame differs$"),
        )
        for what, body, more, status, line in cases:
            program = ("--streaminggs", str(self.stand_in(body)), "--out", str(self.folder / "out"))
            for script, needed in SCRIPTS:
                # Some first simulate a small scene that tells areas.
                expected = status, line.replace("truck", "(truck|area)")
                if what == "differs" and script in ASKING:
                    expected = 1, "info .*: the frame differs$"
                with self.subTest(what, script=name_of(script)):
                    self.check(script, (*needed, *program, *more), *expected)

    def test_wall_times_are_of_codebooks_that_are_made(self):
        keeping = self.stand_in("print(os.environ['STREAMINGGS_CACHE']); sys.exit(1)")
        program = ("--streaminggs", str(keeping), "--out", str(self.folder / "out"))
        with mock.patch.dict("os.environ"):
            os.environ["STREAMINGGS_CACHE"] = "kept"
            self.check(TIMING, program, 1, "truck .*: off$")

    def test_of_one_script(self):
        good = self.stand_in("finish()")
        fifo = self.folder / "fifo"
        os.mkfifo(fifo)
        for script, arguments, line in (
            (explore, ("--points", "nowhere"), "nowhere: No such file or directory$"),
            *(
                (explore, ("--points", name), f"{name}: not a regular file, expected one$")
                for name in (str(self.folder), str(fifo), "/dev/zero")
            ),
            (explore, ("--axis", "hfus"), "--axis: 'hfus', expected KEY=VALUE"),
            (
                explore,
                ("--axis", "hfus=2", "--objectives", "joules"),
                "report.json has no number at 'energy.total_j'$",
            ),
            (explore, ("--axis", "hfus=2,4,2"), "--axis: 'hfus=2,4,2', expected different values"),
            (explore, ("--axis", "hfus=2", "--axis", "hfus=4"), "--axis: hfus: there are two$"),
            (
                explore,
                ("--axis", "group=64,32", "--axis", "group_width_px=64"),
                "--axis: group_width_px: there are two$",
            ),
            (TRAINING_CURVES, (), ".*truck.ply: no data set; expected a folder or one of:"),
            (TRAINING_CURVES, ("--minutes", "-1"), "--minutes, --same-bits: expected 0 or more$"),
            *(
                (script, arguments, f"{line}$")
                for script in (COMPARE_MACHINES, TIMING)
                for arguments, line in (
                    ((str(self.scene),), "truck: got it twice, expected each scene once"),
                    (("--object-sizes", "4x4", "8x4", "4x4"), "--object-sizes: got 4x4 twice, .*"),
                    (("--machines", "exact", "exact"), "--machines: got exact twice, .* each once"),
                    (("--channels", "4", "8", "4"), "--channels: got 4 twice, expected each once"),
                    (("--view", "9"), "--view: got '9', expected .* truck's cameras, 0 to 0"),
                )
            ),
            (PUBLISHED_FIGURES, (str(self.scene),), "truck: got it twice, expected each scene"),
            (PUBLISHED_FIGURES, ("--view", "x"), "--view: 'x', expected numbers"),
            (TIMING, ("--repeats", "0"), "--repeats: got 0, expected a number of 1 or more$"),
            *(
                (script, (option, value, value), f"{option}: got {value} twice, .* each once$")
                for script, option, value in (
                    (ERROR_AGAINST_TIME, "--diagrams", "image"),
                    (ERROR_AGAINST_TIME, "--rates", "2.0"),
                    (ERROR_AGAINST_TIME, "--budgets", "1000"),
                    (ERROR_AGAINST_TIME, "--threads", "1"),
                    (BOUNDARY_STUDY, "--voxels", "0.5"),
                    (BOUNDARY_STUDY, "--betas", "0.5"),
                    (ENERGY, "--groups", "64"),
                    (QUALITY_TABLE, "--prices", "0.5"),
                    (TRAINING_CURVES, "--seeds", "1"),
                    (VOXEL_STUDY, "--voxels", "0.5"),
                )
            ),
            (
                ERROR_AGAINST_TIME,
                ("--datasets", str(self.folder), f"{self.folder}/."),
                "--datasets: got .* twice, expected each once$",
            ),
        ):
            with self.subTest(name_of(script), arguments=arguments):
                program = ("--streaminggs", str(good), "--out", str(self.folder / "out"))
                self.check(script, (*arguments, *program), 2, line)

    def test_arguments_that_are_none(self):
        """Of every script there is, also of one that is yet to be written."""
        taking = [
            path.stem
            for path in sorted((REPOSITORY / "scripts").glob("*.py"))
            if "parse_args()" in path.read_text() and path.stem != "results"
        ]
        self.assertIn("report", taking)
        cases = [
            *((name, ("x", "--nope"), "(unrecognized|the following) arg") for name in taking),
            *(("results", (name, "--nope"), "unrecognized arg") for name in results.studies()),
            ("results", ("x",), "STUDY: invalid choice: 'x'"),
            ("results", ("error_against_time", "--view", "0,x"), "--view: got '0,x', expected num"),
            ("results", ("error_against_time", "--diagrams", "x"), "--diagrams: invalid choice"),
            ("explore", ("-j", "x"), "-j: invalid int value: 'x'"),
            ("explore", ("--search", "x"), "--search: invalid choice: 'x'"),
            ("explore", ("--axis", "a=1", "--points", "x"), "--points: not allowed with"),
            ("report", (), "the following arguments are required: RESULTS"),
            ("figures", ("--from",), "--from: expected one argument"),
        ]
        for name, arguments, expected in cases:
            with self.subTest(name, arguments=arguments):
                said = io.StringIO()
                words = [f"{name}.py", *arguments]
                with mock.patch("sys.argv", words), contextlib.redirect_stderr(said):
                    with self.assertRaises(SystemExit) as ended:
                        (results if name == "results" else importlib.import_module(name)).main()
                self.assertEqual(ended.exception.code, 2)
                self.assertRegex(said.getvalue(), rf"\A{name}\.py: {expected}.*\n\Z")

    def test_of_the_program_that_measures(self):
        refusing = self.folder / "refusing"
        refusing.write_text("#!/bin/sh\necho 'stability: --samples: got 0' >&2\nexit 2\n")
        failing = self.folder / "failing"
        failing.write_text("#!/bin/sh\nexit 1\n")
        for program in (refusing, failing):
            program.chmod(0o755)
        out = str(self.folder / "out")
        for program, status, said in (
            ("/bin/echo", 2, "/bin/echo: got no studies, expected those of `stability`$"),
            ("no", 2, "no: not there; scripts/setup.sh builds it$"),
            (str(refusing), 2, "stability: --samples: got 0$"),
            (str(failing), 1, "failing: exit status 1$"),
        ):
            with self.subTest(program):
                ended, line, _ = self.ended(STABILITY_TABLE, "--stability", program, "--out", out)
                self.assertRegex(line, f"^results.py: {said}")
                self.assertEqual(ended, status)
                self.assertEqual(list(self.folder.glob("*/*.csv")), [])

    def test_of_a_program_that_is_another_one(self):
        """Nothing waits for its answers."""
        program = self.folder / "another"
        axis = ("--axis", "hfus=1,2", "--streaminggs", str(program), "--out")
        for body, said in (
            ("echo nothing", "got no configuration in JSON, expected one$"),
            ("""echo '{"hfus": 1, "sram": {}}'""", "got no answers, expected those of `sweep`$"),
        ):
            with self.subTest(body):
                program.write_text(f"#!/bin/sh\n{body}\n")
                program.chmod(0o755)
                words = (*axis, str(self.folder / "out"))
                ended, line, _ = self.ended(explore, str(self.scene), *words)
                self.assertRegex(line, f"^explore.py: {program}: {said}")
                self.assertEqual(ended, 2)

    def test_of_the_program_that_draws_and_times(self):
        out = str(self.folder / "out")
        for body, status, said in (
            ("echo 'bench_renderers: got no scene' >&2; exit 2", 2, "bench_renderers: got no"),
            ("exit 1", 1, "renderers: exit status 1$"),
            ("echo scene,ms", 1, ".*renderers: columns scene, ms; expected scene, view, renderer"),
        ):
            with self.subTest(body):
                program = self.folder / "renderers"
                program.write_text(f"#!/bin/sh\n{body}\n")
                program.chmod(0o755)
                words = ("--diagrams", "renderers", "--renderers", str(program), "--out", out)
                ended, line, _ = self.ended(ERROR_AGAINST_TIME, str(self.scene), *words)
                self.assertRegex(line, f"^results.py: {said}")
                self.assertEqual(ended, status)
                self.assertEqual(list(self.folder.glob("*/*.csv")), [])

    @nightly
    def test_what_is_drawn_and_timed(self):
        """All views of each scene at the size, once, under the scene's whole name."""
        program = self.folder / "renderers"
        head = ",".join(column.name for column in error_against_time.RENDERER_COLUMNS)
        program.write_text(
            f"""#!/bin/sh
            echo "$@" >>{self.folder}/asked
            echo "{head}"
            for view in $(echo "$7" | tr , ' '); do
              echo "object,$view,double,1,$3,1,1,double,9,9,9"
            done
            """
        )
        program.chmod(0o755)
        info = "print('cameras 9') if 'info' in sys.argv else print('1 (0123abc)')"
        words = ("builtin:object?n=300", "--diagrams", "renderers", "--renderers", str(program))
        words += ("--streaminggs", str(self.stand_in(info)), "--out", str(self.folder / "out"))
        words += ("--threads", "1", "2", "--view", "0,3")
        asked = []
        for more, size in (((), "640x360"), (("--size", "8x4"), "8x4")):
            for _ in range(2):
                status, line, made = self.ended(ERROR_AGAINST_TIME, "builtin:object", *words, *more)
                self.assertEqual(status, 0, line)
                for scene in ("builtin:object", "builtin:object?n=300"):
                    for view in (0, 3):
                        self.assertEqual(made.count(f"| {scene} | {view} | double |"), 2)
            asked += [
                f"{scene} --threads {threads} --size {size} --view 0,3"
                for threads in (1, 2)
                for scene in ("builtin:object", "builtin:object?n=300")
            ]
        self.assertEqual((self.folder / "asked").read_text().splitlines(), asked)

    def test_of_fuzzers(self):
        """What they are told is looked at before anything is installed or built."""
        scripts, seeds = self.folder / "scripts", self.folder / "tests" / "fuzz" / "corpus"
        for folder in (scripts, seeds / "ply", seeds / "png"):
            folder.mkdir(parents=True)
        shutil.copy(REPOSITORY / "scripts" / "fuzz.sh", scripts)
        (scripts / "debian_packages.sh").write_text("echo installing\nexit 9\n")
        for words, status, out, said in (
            (("--help",), 0, r"usage: fuzz.sh .*\nBuilds the (.|\n)*\nReaders: ply png\n", ""),
            (("--nope",), 2, "", "usage: fuzz.sh .*\n"),
            (("ply", "0"), 2, "", "fuzz.sh: SECONDS: got '0', expected 1 or more\n"),
            (("ply", "-5"), 2, "", "usage: fuzz.sh .*\n"),
            (("ply", "nope"), 2, "", "fuzz.sh: nope: no such reader, expected of: ply png\n"),
            (("..",), 2, "", r"fuzz.sh: \.\.: no such reader, expected of: ply png\n"),
            (("ply", "png", "10"), 9, "installing\n", ""),
            ((), 9, "installing\n", ""),
        ):
            with self.subTest(words):
                command = ["bash", str(scripts / "fuzz.sh"), *words]
                done = subprocess.run(command, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, status, done.stderr)
                self.assertRegex(done.stdout, rf"\A{out}\Z")
                self.assertRegex(done.stderr, rf"\A{said}\Z")

    def test_of_suites_of_tests(self):
        scripts = self.folder / "scripts"
        scripts.mkdir()
        shutil.copy(REPOSITORY / "scripts" / "test.sh", scripts)
        for name, body in (
            ("debian_packages.sh", "install_missing() { :; }"),
            ("tools.sh", ":"),
            ("setup.sh", 'echo "$@"; exit 9'),
        ):
            (scripts / name).write_text(f"#!/bin/sh\n{body}\n")
            (scripts / name).chmod(0o755)
        for words, status, out in (
            ((), 9, "release\n"),
            (("release",), 9, "release\n"),
            (("asan",), 9, "asan sanitized_tests\n"),
            (("nightly",), 9, "release\n"),
            (("full",), 2, ""),
            (("release", "nightly"), 2, ""),
        ):
            with self.subTest(words):
                command = ["bash", str(scripts / "test.sh"), *words]
                done = subprocess.run(command, capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stdout), (status, out))
                self.assertEqual(done.stderr.startswith("usage: test.sh "), status == 2)

    def test_a_first_frame_leaves_no_older_program(self):
        scripts = self.folder / "scripts"
        others = self.folder / "build" / "release" / "bin" / "streaminggs-commands"
        for folder in (scripts, others.parent):
            folder.mkdir(parents=True)
        shutil.copy(REPOSITORY / "scripts" / "run.sh", scripts)
        (scripts / "setup.sh").write_text('#!/bin/sh\necho "$@"\nexit 9\n')
        (scripts / "setup.sh").chmod(0o755)
        for built in ("release streaminggs\n", "release streaminggs streaminggs-commands\n"):
            command = ["bash", str(scripts / "run.sh")]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (9, built))
            others.touch()

    def test_a_first_frame_names_the_page_of_its_report_first(self):
        scripts = self.folder / "scripts"
        command = self.folder / "build" / "release" / "bin" / "streaminggs"
        for folder in (scripts, command.parent):
            folder.mkdir(parents=True)
        shutil.copy(REPOSITORY / "scripts" / "run.sh", scripts)
        for file, body in (
            (scripts / "setup.sh", ":"),
            (command, 'for last; do :; done; mkdir -p "$last"; echo simulated "$last"'),
            (scripts / "report.py", '[ -d "$1" ] && [ "$2" = --out ] && echo page >"$3"; echo made'),
        ):
            file.write_text(f"#!/bin/sh\n{body}\n")
            file.chmod(0o755)
        run = ["bash", str(scripts / "run.sh")]
        done = subprocess.run(run, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        page = "out/first_frame/report.html"
        self.assertRegex(
            done.stdout,
            rf"\Asimulated out/first_frame\n\nOpen\n  {page} .*\nBeside it are\n  out/(.|\n)*\Z",
        )
        self.assertEqual((self.folder / page).read_text(), "page\n")

    def test_unknown_scene(self):
        status, line, _ = self.ended(explore, "nowhere", "--axis", "hfus=2")
        self.assertRegex(line, "nowhere: no scene")
        self.assertEqual(status, 2)


class Starts(unittest.TestCase):
    def test_what_names_an_interpreter_can_be_started_and_nothing_else(self):
        asked = subprocess.run(
            ["git", "-C", str(REPOSITORY), "ls-files", "--stage", "-z"], capture_output=True
        )
        if asked.returncode:
            self.skipTest("not under git, which keeps what can be started")
        entries = asked.stdout.decode().split("\0")[:-1]
        modes = {name: entry[:6] for entry, _, name in (e.partition("\t") for e in entries)}
        for name, mode in modes.items():
            file = REPOSITORY / name
            if file.is_file():  # not removed, which git has not been told yet
                with self.subTest(name), file.open("rb") as content:
                    self.assertEqual(mode == "100755", content.read(2) == b"#!", mode)
        self.assertIn("scripts/report.py", modes)


if __name__ == "__main__":
    unittest.main()
