"""What tests of scripts share: the scripts themselves, a small scene, and a program that answers as
the command does. $STREAMINGGS names the command; it is empty where there is none."""

import contextlib
import io
import json
import math
import os
import pathlib
import stat
import struct
import sys
import tempfile
import textwrap
import unittest
import zlib
from unittest import mock

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

COMMAND = os.environ.get("STREAMINGGS", "")
os.environ["STREAMINGGS_CACHE"] = "off"  # the user's is none of theirs


import results  # isort: skip (found only now)
from tables import Study  # isort: skip

# Marks a test or a class that takes long. A shorter test enters the same code.
nightly = unittest.skipUnless(os.environ.get("SGS_NIGHTLY"), "nightly: $SGS_NIGHTLY is not set")


class InFolder(unittest.TestCase):
    """A folder of its own with a small trained scene, truck.ply, and its camera."""

    GAUSSIANS = 64

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "truck.ply"
        self.write_scene()

    def write_scene(self):
        names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity"]
        names += [f"scale_{axis}" for axis in range(3)] + [f"rot_{part}" for part in range(4)]
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {self.GAUSSIANS}"]
        head += [*(f"property float {name}" for name in names), "end_header", ""]
        size, turn = (-3, -3, -3), (1, 0, 0, 0)
        body = b"".join(
            struct.pack("<14f", i % 8 / 8, i // 8 / 8, i % 5 / 5, i % 3, 0, 1, 2, *size, *turn)
            for i in range(self.GAUSSIANS)
        )
        self.scene.write_bytes("\n".join(head).encode() + body)
        self.scene.with_suffix(".json").write_text(
            """[{"id": 0, "img_name": "0", "width": 64, "height": 36, "fx": 60, "fy": 60,
                 "position": [0.5, 0.5, -2], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}]"""
        )

    def write_dataset(self) -> pathlib.Path:
        """Nine small photographs of one colour, by cameras on an arc: two of them to test with."""
        folder = self.folder / "photographs"
        (folder / "images").mkdir(parents=True)
        width, height = 24, 18
        cameras = []
        for i in range(9):
            right, ahead = math.cos(i / 9), math.sin(i / 9)
            camera = {"id": i, "img_name": f"{i}", "width": width, "height": height}
            camera |= {"fx": 20, "fy": 20, "position": [2 * ahead, 0, -2 * right]}
            camera["rotation"] = [[right, 0, -ahead], [0, 1, 0], [ahead, 0, right]]
            cameras.append(camera)
        (folder / "cameras.json").write_text(json.dumps(cameras))
        rows = (b"\0" + bytes((200, 100, 50)) * width) * height
        parts = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),)
        parts += ((b"IDAT", zlib.compress(rows)), (b"IEND", b""))
        png = b"\x89PNG\r\n\x1a\n" + b"".join(
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
            for name, data in parts
        )
        for i in range(9):
            (folder / "images" / f"{i}.png").write_bytes(png)
        return folder

    def stand_in(self, body: str) -> pathlib.Path:
        """A program in the command's place. It has SET, the values of --set, SCRIPT, the process
        that asked, and `finish()`, which writes the report of a view that took 8 cycles over the
        number of HFUs, and has one more mm2 than those. It has a configuration to print, and
        describes any. As `sweep` it does for each point what it does for one."""
        program = self.folder / "streaminggs"
        prelude = f"""\
            #!{sys.executable} -IS
            import json, os, pathlib, signal, subprocess, sys, tempfile, time
            HERE = pathlib.Path(__file__).parent
            SET = dict(word.split("=") for word in sys.argv if "=" in word)
            SCRIPT = int(os.environ.get("SCRIPT", os.getppid()))
            if "--print-config" in sys.argv:
                memories = {{"input_bytes": 0, "codebook_bytes": 0, "shared_bytes": 0}}
                sides = {{"group_width_px": 112, "group_height_px": 80}}
                filters = {{"cfus": 4, "ffu_lanes": 16}}
                hfus = int(SET.get("hfus", 1))
                print(json.dumps({{"hfus": hfus, **sides, "hfu": filters, "sram": memories}}))
                sys.exit()
            if "describe" in sys.argv:
                sys.exit()
            def band(middle):
                return {{"low": middle - 1, "middle": middle, "high": middle + 1}}
            def finish():
                hfus = int(SET.get("hfus", 1))
                number = int(sys.argv[sys.argv.index("--view") + 1])
                frame = {{"cycles": 8 // hfus, "time_s": 1e-9 * (8 // hfus), "fps": hfus}}
                config = {{"hfus": hfus, "group_width_px": 112, "group_height_px": 80}}
                config["sram"] = {{"input_bytes": 100 * hfus + number, "codebook_bytes": 0}}
                view = {{"view": number, "frame": frame, "binding": {{"unit": "dram"}},
                        "config": config,
                        "area_mm2": {{
                            "total": 1 + hfus,
                            "bands": {{"total": band(1 + hfus)}},
                            "with_memory_interface": band(6 + hfus),
                        }},
                        "provenance": {{}}}}
                out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
                (out / "report.json").write_text(json.dumps({{"views": [view]}}))
            def swept(point):
                with tempfile.TemporaryDirectory() as out:
                    words = [__file__, "simulate", "--view", str(point["view"]), "--out", out]
                    for name in ("size", "stereo"):
                        words += [f"--{{name}}", point[name]] if name in point else []
                    words += ["--fit-memories"] if point.get("fit_memories") else []
                    for key, value in point["set"].items():
                        words += ["--set", f"{{key}}={{value}}"]
                    environment = {{**os.environ, "SCRIPT": str(os.getppid())}}
                    done = subprocess.run(words, capture_output=True, text=True, env=environment)
                    said = " ".join((done.stderr or done.stdout).split())
                    if done.returncode:
                        status = "refused" if done.returncode == 2 else "failed"
                        return {{"status": status, "reason": said}}
                    report = json.loads((pathlib.Path(out) / "report.json").read_text())
                    return {{"status": "done", "report": report["views"][0]}}
            if "sweep" in sys.argv:
                results = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
                lines = results.read_text().splitlines() if results.exists() else []
                known = dict(map(json.loads, lines))
                for line in sys.stdin:
                    point = json.loads(line)
                    number = point.pop("id")
                    key = json.dumps([point, pathlib.Path(__file__).read_text()])
                    kept = key in known
                    if not kept:
                        known[key] = swept(point)
                        if known[key]["status"] != "failed":
                            with results.open("a") as file:
                                file.write(json.dumps([key, known[key]]) + "\\n")
                    print(json.dumps({{"id": number, "kept": kept, **known[key]}}), flush=True)
                sys.exit()
            """
        program.write_text(textwrap.dedent(prelude) + textwrap.dedent(body))
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return program

    def ended(self, script, *arguments: str) -> tuple[int, str, str]:
        """Exit status, last line of stderr and stdout of a script that gets these arguments. A study
        of results.py keeps in the test's folder what it simulates, trains and tunes."""
        out, said = io.StringIO(), io.StringIO()
        words = [file_of(script), *arguments]
        if isinstance(script, Study):
            words = ["results.py", script.name, *arguments, "--kept", str(self.folder / "kept")]
            script = results
        with mock.patch("sys.argv", words), contextlib.redirect_stdout(out):
            with contextlib.redirect_stderr(said):
                status = script.main()
        return status, said.getvalue().rstrip().rpartition("\n")[2], out.getvalue()


def name_of(script) -> str:
    """Of a study, or of the module of another script."""
    return script.name if isinstance(script, Study) else script.__name__


def file_of(script) -> str:
    """That a user starts."""
    return "results.py" if isinstance(script, Study) else f"{script.__name__}.py"
