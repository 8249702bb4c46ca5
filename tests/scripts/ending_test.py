"""How the scripts end, whatever a simulation does: a program stands in for the command."""

import contextlib
import importlib
import io
import unittest
from unittest import mock

from in_folder import REPOSITORY, InFolder  # isort: skip (finds the scripts)
import binding_check
import boundary_study
import compare_machines
import compare_variants
import design_point_seconds
import energy_tables
import error_against_time
import explore
import fair_fight
import fill_readme
import half_by_stage
import published_figures
import quality_table
import simulations
import smallest_machine
import stability_table
import timing
import training_curves
import voxel_study
import work_precision
from scenes import Scene

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
            with self.subTest(what), self.assertRaisesRegex(simulations.Failure, expected):
                simulations.simulate(self.stand_in(body), run)


# Script, and the arguments besides a scene that it cannot do without.
SCRIPTS = (
    (binding_check, ()),
    (boundary_study, ()),
    (compare_variants, ()),
    (energy_tables, ()),
    (explore, ("--axis", "hfus=2,4")),
    (fair_fight, ()),
    (half_by_stage, ()),
    (quality_table, ()),
    (smallest_machine, ()),
    (timing, ()),
    (voxel_study, ()),
    (work_precision, ()),
)
# These ask first whether their settings are known, and take no answer but a good one.
ASKING = (boundary_study, quality_table, voxel_study)


class Ends(InFolder):
    """Bad input: one line that says what is wrong, and exit status 2."""

    def check(self, script, arguments, expected_status, expected_line):
        status, line, _ = self.ended(script, str(self.scene), *arguments)
        self.assertRegex(line, f"^{script.__name__}.py: {expected_line}")
        self.assertEqual(status, expected_status)
        self.assertEqual(list(self.folder.glob("*/*.md")), [])

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
                with self.subTest(what, script=script.__name__):
                    self.check(script, (*needed, *program, *more), *expected)

    def test_of_one_script(self):
        good = self.stand_in("finish()")
        for script, arguments, line in (
            (explore, ("--points", "nowhere"), "nowhere: No such file or directory$"),
            (explore, ("--points", str(self.folder)), ".*: Is a directory$"),
            (explore, ("--axis", "hfus"), "--axis: 'hfus', expected KEY=VALUE"),
            (
                explore,
                ("--axis", "hfus=2", "--objectives", "joules"),
                "report.json has no number at 'energy.total_j'$",
            ),
            (fair_fight, ("--budgets", "1", "0"), "--budgets: 0, expected more than 0$"),
            (fair_fight, ("--area", "-1"), "--area: -1, expected more than 0$"),
            (fair_fight, ("--most-runs", "0"), "--most-runs: 0, expected more than 0$"),
            (smallest_machine, ("--fps", "0"), "--fps: 0, expected a number above 0$"),
            (smallest_machine, ("--fps", "nan"), "--fps: nan, expected a number above 0$"),
            (smallest_machine, ("--fps", "inf"), "--fps: inf, expected a number above 0$"),
            (explore, ("--axis", "hfus=2,4,2"), "--axis: 'hfus=2,4,2', expected different values"),
            (explore, ("--axis", "hfus=2", "--axis", "hfus=4"), "--axis: hfus: there are two$"),
            (
                explore,
                ("--axis", "group=64,32", "--axis", "group_width_px=64"),
                "--axis: group_width_px: there are two$",
            ),
            (training_curves, (), ".*truck.ply: no data set; expected a folder or one of:"),
            (training_curves, ("--minutes", "-1"), "--minutes, --same-bits: expected 0 or more$"),
            *(
                (script, arguments, f"{line}$")
                for script in (compare_machines, design_point_seconds)
                for arguments, line in (
                    ((str(self.scene),), "truck: got it twice, expected each scene once"),
                    (("--object-sizes", "4x4", "8x4", "4x4"), "--object-sizes: got 4x4 twice, .*"),
                    (("--machines", "exact", "exact"), "--machines: got exact twice, .* each once"),
                    (("--channels", "4", "8", "4"), "--channels: got 4 twice, expected each once"),
                    (("--view", "9"), "--view: got '9', expected .* truck's cameras, 0 to 0"),
                )
            ),
            (published_figures, (str(self.scene),), "truck: got it twice, expected each scene"),
            (published_figures, ("--view", "x"), "--view: 'x', expected numbers"),
            (timing, ("--repeats", "0"), "--repeats: 0, expected at least 1$"),
        ):
            with self.subTest(script.__name__, arguments=arguments):
                program = ("--streaminggs", str(good), "--out", str(self.folder / "out"))
                self.check(script, (*arguments, *program), 2, line)

    def test_arguments_that_are_none(self):
        """Of every script there is, also of one that is yet to be written."""
        taking = [
            path.stem
            for path in sorted((REPOSITORY / "scripts").glob("*.py"))
            if "parse_args()" in path.read_text()
        ]
        self.assertIn("report", taking)
        cases = [
            *((name, ("x", "--nope"), "(unrecognized|the following) arg") for name in taking),
            ("explore", ("-j", "x"), "-j: invalid int value: 'x'"),
            ("error_against_time", ("--view", "0,x"), "--view: got '0,x', expected numbers of cam"),
            ("error_against_time", ("--diagrams", "x"), "--diagrams: invalid choice: 'x'"),
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
                        importlib.import_module(name).main()
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
            ("no", 2, "no: not there; scripts/setup.sh builds it$"),
            (str(refusing), 2, "stability: --samples: got 0$"),
            (str(failing), 1, "failing: exit status 1$"),
        ):
            with self.subTest(program):
                ended, line, _ = self.ended(stability_table, "--stability", program, "--out", out)
                self.assertRegex(line, f"^stability_table.py: {said}")
                self.assertEqual(ended, status)
                self.assertEqual(list(self.folder.glob("*/*.md")), [])

    def test_of_the_program_that_draws_and_times(self):
        out = str(self.folder / "out")
        for body, status, said in (
            ("echo 'bench_renderers: got no scene' >&2; exit 2", 2, "bench_renderers: got no"),
            ("exit 1", 1, "renderers: exit status 1$"),
            ("echo scene,ms", 1, ".*renderers: columns scene, ms; expected scene, renderer"),
        ):
            with self.subTest(body):
                program = self.folder / "renderers"
                program.write_text(f"#!/bin/sh\n{body}\n")
                program.chmod(0o755)
                words = ("--diagrams", "renderers", "--renderers", str(program), "--out", out)
                ended, line, _ = self.ended(error_against_time, str(self.scene), *words)
                self.assertRegex(line, f"^error_against_time.py: {said}")
                self.assertEqual(ended, status)
                self.assertEqual(list(self.folder.glob("*/*.md")), [])

    def test_unknown_scene_and_readme(self):
        for script in (explore, fill_readme):
            with self.subTest(script.__name__):
                needed = ("--axis", "hfus=2") if script is explore else ()
                status, line, _ = self.ended(script, "nowhere", *needed)
                self.assertRegex(line, "nowhere: (no scene|No such file)")
                self.assertEqual(status, 2)


if __name__ == "__main__":
    unittest.main()
