"""waveform_view.py: the GTKWave view that it makes of a small VCD file."""

import pathlib
import subprocess
import sys
import tempfile
import textwrap
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = REPOSITORY / "scripts" / "waveform_view.py"

VCD = """
    $timescale 1 ps $end
    $scope module SystemC $end
    $scope module machine $end
    $scope module colours $end
    $var wire   32  aaaai  fill [31:0]  $end
    $upscope $end
    $scope module reader1 $end
    $scope module add $end
    $var wire    1  aaaad  busy       $end
    $upscope $end
    $upscope $end
    $scope module reader0 $end
    $scope module add $end
    $var wire    1  aaaab  busy       $end
    $var wire    3  aaaae  waits_for [2:0]  $end
    $upscope $end
    $scope module memory $end
    $var wire   64  aaaac  bytes_outstanding [63:0]  $end
    $upscope $end
    $var wire   32  aaaaa  group [31:0]  $end
    $upscope $end
    $upscope $end
    $scope module dram $end
    $scope module channel0 $end
    $var wire   64  aaaaj  row_hits [63:0]  $end
    $upscope $end
    $upscope $end
    $upscope $end
    $enddefinitions  $end
    #0
    0aaaab
    #1600000
    1aaaab
    """


class View(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.vcd = pathlib.Path(self.folder.name) / "a.vcd"
        self.view = pathlib.Path(self.folder.name) / "a.gtkw"

    def tearDown(self):
        self.folder.cleanup()

    def run_script(self, text):
        self.vcd.write_text(textwrap.dedent(text))
        return subprocess.run([sys.executable, "-B", SCRIPT, self.vcd, "--out", self.view],
                              capture_output=True, text=True, check=False)

    def test_every_signal_once_by_unit_in_the_order_of_tracing(self):
        self.assertEqual(self.run_script(VCD).returncode, 0)
        lines = self.view.read_text().splitlines()
        shown = [line for line in lines if line[0] in "+-"]
        self.assertEqual(shown, [
            "-reader0",
            "+{reader0 group} SystemC.machine.reader0.group[31:0]",
            "+{reader0 add busy} SystemC.machine.reader0.add.busy",
            "+{reader0 memory bytes_outstanding} "
            "SystemC.machine.reader0.memory.bytes_outstanding[63:0]",
            "+{reader0 add waits_for} SystemC.machine.reader0.add.waits_for[2:0]",
            "-reader0",
            "-reader1",
            "+{reader1 add busy} SystemC.machine.reader1.add.busy",
            "-reader1",
            "-queues between the units",
            "+{colours fill} SystemC.machine.colours.fill[31:0]",
            "-queues between the units",
            "-dram.channel0",
            "+{dram channel0 row_hits} SystemC.dram.channel0.row_hits[63:0]",
            "-dram.channel0",
        ])
        # A bit, a number and a curve.
        for name, flag in (("add busy", "@28"), ("add waits_for", "@24"),
                           ("memory bytes_outstanding", "@8024")):
            shown = next(i for i, li in enumerate(lines) if li.startswith("+{reader0 " + name))
            self.assertEqual(lines[shown - 1], flag)
        # The second of two equal units begins folded.
        self.assertEqual(lines[lines.index("-reader0") - 1], "@800200")
        self.assertEqual(lines[lines.index("-reader1") - 1], "@c00200")

    def test_the_zoom_follows_the_length(self):
        def zoom(text):
            self.run_script(text)
            line = next(li for li in self.view.read_text().splitlines() if li.startswith("*"))
            return float(line[1:].split()[0])

        self.assertAlmostEqual(zoom(VCD) - zoom(VCD.replace("1600000", "6400000")), 2, places=5)

    def test_what_is_no_waveform_is_refused_in_one_line(self):
        for text in ("", "no VCD", VCD.split("#0")[0]):
            with self.subTest(text=text):
                outcome = self.run_script(text)
                self.assertEqual(outcome.returncode, 2)
                self.assertRegex(outcome.stderr, r"^\S*waveform_view.py: .*expected.*\n$")
                self.assertFalse(self.view.exists())

    def test_a_file_that_is_not_there_is_named(self):
        command = [sys.executable, "-B", str(SCRIPT), "nofile", "--out", str(self.view)]
        outcome = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(outcome.returncode, 2)
        self.assertRegex(outcome.stderr, r"^\S*waveform_view.py: nofile: No such file.*\n$")


if __name__ == "__main__":
    unittest.main()
