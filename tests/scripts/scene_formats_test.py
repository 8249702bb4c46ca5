"""Scenes in the forms of the field, decoded by the command and by the reference decoder,
@playcanvas/splat-transform of npm: equal to the last bit of float, or within what the form rounds.
Skipped where $STREAMINGGS names no command or npm brings no package."""

from __future__ import annotations

import array
import math
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest

from in_folder import COMMAND, REPOSITORY, nightly

PACKAGE = "@playcanvas/splat-transform@3.7.0"
SHARED = pathlib.Path(os.environ.get("SGS_SHARED", REPOSITORY / ".." / "shared"))
FIXTURES = (
    "minimal-raw.spz",
    "minimal-v2.spz",
    "minimal-v3.spz",
    "minimal-v4.spz",
    "minimal.ksplat",
    "minimal.splat",
)


def columns_of(path: pathlib.Path) -> dict[str, array.array]:
    """The columns of a binary .ply of floats, but for normals."""
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    names = [line.split()[2] for line in head.decode().split("\n") if line.startswith("property")]
    values = array.array("f", body)
    return {
        name: values[at :: len(names)]
        for at, name in enumerate(names)
        if name not in ("nx", "ny", "nz")
    }


def units_apart(a: float, b: float) -> int:
    """Floats between two of them."""

    def place(value: float) -> int:
        bits = struct.unpack("<i", struct.pack("<f", value))[0]
        return bits if bits >= 0 else -(bits & 0x7FFFFFFF)

    return abs(place(a) - place(b))


@nightly
@unittest.skipUnless(COMMAND, "$STREAMINGGS names no command")
@unittest.skipUnless(shutil.which("npm"), "npm is not there")
class Decoded(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        install = ["npm", "install", "--no-audit", "--no-fund", "--prefix", folder.name, PACKAGE]
        done = subprocess.run(install, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise unittest.SkipTest(f"npm brings no {PACKAGE}: {done.stderr.strip()[-200:]}")
        cls.scene = cls.folder / "scene.ply"
        cls.convert("builtin:object?n=3000", cls.scene)

    @staticmethod
    def convert(scene: str | pathlib.Path, out: pathlib.Path, *words: str) -> None:
        command = [COMMAND, "convert", str(scene), str(out), *words]
        subprocess.run(command, check=True, capture_output=True)

    @classmethod
    def reference(cls, *words: str | pathlib.Path) -> None:
        program = cls.folder / "node_modules" / "@playcanvas" / "splat-transform" / "bin" / "cli.mjs"
        command = ["node", program, "-q", "-w", "-g", "cpu", *words]
        subprocess.run(list(map(str, command)), check=True, capture_output=True)

    def check_equal(self, scene: pathlib.Path, our_words=(), their_words=()) -> None:
        paths = self.folder / "ours.ply", self.folder / "theirs.ply"
        self.convert(scene, paths[0], *our_words)
        self.reference(*their_words, scene, paths[1])
        ours, theirs = map(columns_of, paths)
        self.assertEqual(set(ours), set(theirs), scene)
        for name, values in theirs.items():
            self.assertEqual(len(values), len(ours[name]))
            apart = max(map(units_apart, values, ours[name]))
            self.assertEqual(apart, 0, f"{scene}: {name}")

    def test_what_the_reference_writes(self):
        for name in ("a.compressed.ply", "a.spz", "a.sog", "sog/meta.json"):
            with self.subTest(name):
                scene = self.folder / name
                scene.parent.mkdir(exist_ok=True)
                self.reference(self.scene, scene)
                self.check_equal(scene)

    def test_levels_of_a_streamed_scene(self):
        scene = self.folder / "lod" / "lod-meta.json"
        scene.parent.mkdir()
        coarse = self.folder / "coarse.ply"
        self.reference(self.scene, "-V", "x,gt,0", coarse)
        self.reference("--lod-chunk-count", "1", self.scene, "-l", "0", coarse, "-l", "1", scene)
        for level in ("0", "1"):
            with self.subTest(level):
                self.check_equal(scene, ["--level", level], ["-L", level])

    def test_gltf(self):
        """Which the reference writes and does not read: exponentials and sigmoids as floats."""
        scene, ours = self.folder / "a.glb", self.folder / "ours.ply"
        self.reference(self.scene, scene)
        self.convert(scene, ours)
        before, after = columns_of(self.scene), columns_of(ours)
        self.assertEqual(set(before), set(after))
        half = 2.0**-24  # of a float, relative
        # The reference turns by a quaternion whose sine of 180 degrees is not quite 0.
        turn = 2.0**-50 * max(max(map(abs, values)) for values in before.values())
        for name, values in before.items():
            for value, other in zip(values, after[name]):
                if name == "opacity":
                    opacity = 1 / (1 + math.exp(-value))
                    most = half * (1 / (1 - opacity) + abs(value) + 1)
                elif name.startswith("scale"):
                    most = half * (1 + 2 * abs(value))
                else:
                    most = turn
                self.assertLessEqual(abs(value - other), most, f"{name}: {value}, {other}")

    @unittest.skipUnless((SHARED / "formats").exists(), "../shared/formats is not there")
    def test_files_of_others(self):
        for name in ("playbot_sog/meta.json", *(f"fixtures/{name}" for name in FIXTURES)):
            with self.subTest(name):
                self.check_equal(SHARED / "formats" / name)


if __name__ == "__main__":
    unittest.main()
