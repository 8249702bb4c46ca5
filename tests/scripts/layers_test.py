"""Includes follow the layers: no folder points upward, no machine's room knows another's, and no
folders of algorithm/ stand in a circle."""

import graphlib
import pathlib
import re
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^#include "((\w+)/[^"]+)"', re.MULTILINE)

# What each may include beside itself.
LAYERS = {
    "algorithm": set(),
    "tlm": set(),
    "modules": {"algorithm", "tlm"},
    "testbench": {"algorithm", "tlm", "modules"},
}


def included(folder: str) -> dict[str, set[str]]:
    """Of each source below a folder the files that it includes, by their paths."""
    paths = (path for path in (REPOSITORY / folder).rglob("*") if path.suffix in (".h", ".cpp"))
    return {
        str(path.relative_to(REPOSITORY)): {found[0] for found in INCLUDE.findall(path.read_text())}
        for path in paths
    }


class Layers(unittest.TestCase):
    def test_no_folder_points_upward(self):
        for folder, below in LAYERS.items():
            for source, others in included(folder).items():
                found = {other.partition("/")[0] for other in others}
                self.assertLessEqual(found, below | {folder}, source)

    def test_no_machine_knows_another(self):
        rooms = ("modules/streaminggs", "modules/gscore")
        for room, other in (rooms, rooms[::-1]):
            for source, others in included(room).items():
                self.assertEqual([path for path in others if path.startswith(other)], [], source)

    def test_no_circle_in_algorithm(self):
        folders: dict[str, set[str]] = {}
        for source, others in included("algorithm").items():
            folder = source.split("/")[1]
            folders.setdefault(folder, set()).update(
                other.split("/")[1] for other in others if other.split("/")[1] != folder
            )
        self.assertIn("splat", folders["render"])
        graphlib.TopologicalSorter(folders).prepare()  # raises CycleError, which names the circle


if __name__ == "__main__":
    unittest.main()
