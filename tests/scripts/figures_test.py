"""figures.py: each figure from a table with the columns of the script that makes it. Run as a user
runs it; skipped where neither this Python nor Debian's has Matplotlib."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from unittest import mock

from in_folder import COMMAND, REPOSITORY, InFolder, nightly  # isort: skip (finds the scripts)
import figures
import tables
from drawing import block_diagram
from runs import run_arguments, simulations
from runs.scenes import find_scene
from studies import (
    compare_machines,
    error_against_time,
    fitting,
    found,
    frame_costs,
    headline,
    quality,
    reproduction,
    variants,
)

SCRIPT = REPOSITORY / "scripts" / "figures.py"
PYTHONS = (sys.executable, str(run_arguments.DEBIAN))
EXPLORE_HEAD = (
    "hfu.cfus",
    "hfu.ffu_lanes",
    "group",
    "sum(cycles)",
    "mm2",
    "binding",
    "front",
)


def names(columns) -> list[str]:
    return [column.name for column in columns]


def has_matplotlib(python: str) -> bool:
    command = [python, "-c", "import matplotlib"]
    return (
        bool(shutil.which(python)) and not subprocess.run(command, capture_output=True).returncode
    )


def rows(head, *different: dict) -> list[tuple]:
    """A row for each, with 1 to 9 in columns that are not said."""
    return [
        tuple(of.get(name, 1 + (at * 7 + place) % 9) for at, name in enumerate(head))
        for place, of in enumerate(different)
    ]


def grid(key: str, values, other: str, others) -> list[dict]:
    return [{key: value, other: of} for value in values for of in others]


# Of each figure: its table, and what must stand in the SVG as text.
TABLES = {
    "characterisation": (
        "characterisation",
        names(compare_machines.CHARACTER_COLUMNS),
        [
            {"scene": scene, "machine": machine, "GB/s": memory}
            for scene in ("truck", "yard")
            for machine, memory in (("GPU", "9"), ("gscore", "25.6"), ("gscore", "51.2"))
        ],
        ("truck", "GPU", "gscore, 25.6 GB/s", "gscore, 51.2 GB/s", "90 frames/s", "2 to 9"),
    ),
    "dram_by_stage": (
        "characterisation",
        names(compare_machines.CHARACTER_COLUMNS),
        [{"scene": "truck", "scene %": 20, "intermediate %": 70, "pixels %": 10}],
        ("intermediate", "truck"),
    ),
    "tuning_curve": (
        "boundary_study",
        names(fitting.LOOK_COLUMNS),
        [
            {
                "scene": "truck",
                "of the preset's": 1,
                "beta": beta,
                "step": step,
                "misordered": "0.02",
            }
            for beta in ("0", "0.5")
            for step in (0, 500, 1000)
        ],
        ("truck: PSNR", "voxels x 1, beta 0.5", "step"),
    ),
    "training_curve": (
        "training_curves",
        names(fitting.CURVE_COLUMNS),
        [
            {"data set": "lego", "seed": 2, "step": step, "seconds": step / 2, "PSNR dB": "20.1"}
            for step in (400, 800)
        ],
        ("lego, seed 2", "minutes"),
    ),
    "variants": (
        "reproduction_variants",
        names(reproduction.VARIANT_COLUMNS),
        [
            {"scene": "yard", "preset": preset, "with": part}
            for preset in ("paper_text", "paper_ideal")
            for part in reproduction.WITH_PARTS.values()
        ],
        ("yard", "StreamingGS,", "Times less energy, paper_text", "coarse filter"),
    ),
    "voxel_size": (
        "voxel_study",
        names(quality.VOXEL_COLUMNS),
        [
            {"scene": "lego", "of the preset's": size, "scene is": state, "PSNR dB": quality}
            for state, quality in (("as given", "inf"), ("tuned", "30.1"))
            for size in ("0.5", "1", "2")
        ],
        ("lego, tuned", "size of a voxel"),
    ),
    "filter_units": (
        "explore",
        EXPLORE_HEAD,
        [
            {
                "hfu.cfus": cfus,
                "hfu.ffu_lanes": lanes,
                "group": 96,
                "sum(cycles)": 6400 // (cfus + lanes),
            }
            for cfus in (1, 2)
            for lanes in (8, 16)
        ],
        ("hfu.cfus", "2.00", "1.00"),
    ),
    "exploration": (
        "explore",
        EXPLORE_HEAD,
        [
            {"binding": "dram", "front": "yes", "sum(cycles)": 100, "mm2": 5},
            {"binding": "fine", "front": "", "sum(cycles)": 200, "mm2": 6},
        ],
        ("dram binds", "fine binds", "area, mm²", "M cycles against area"),
    ),
    "fronts_of_orders": (
        "fair_fight_front",
        names(found.FRONT),
        grid("order", ("exact", "paper"), "mm2", (4, 5)),
        ("exact", "paper", "area, mm²"),
    ),
    "equal_area": (
        "fair_fight_views",
        names(found.VIEWS),
        grid("machine", ("preset exact", "paper, found"), "size", ("640x360", "1280x720")),
        ("preset exact", "1280x720 px"),
    ),
    "group_size": (
        "energy_groups",
        names(frame_costs.GROUP_COLUMNS),
        grid("preset", ("exact", "paper_no_vq"), "group px", ("32", "64x32")),
        ("64x32", "clock and leakage"),
    ),
}
TABLES["headline"] = (
    "headline_scenes",
    names(headline.SCENE_COLUMNS),
    [{"machine / baseline": "exact / gscore", "scene": scene} for scene in ("truck", "yard")],
    ("exact over gscore", "single scenes", "speed-up", "times the baseline"),
)
TABLES["waterfall"] = (
    "frame_waterfall",
    names(frame_costs.COMPONENT_COLUMNS),
    [
        row | {"mJ": 5, "least mJ": 4, "most mJ": 7}
        for row in grid("preset", ("exact", "gscore"), "mJ of", ("fine", "pixel_state", "all"))
    ],
    ("exact: mJ of a frame", "pixel state", "all", "5.00 (4.00 .. 7.00)"),
)
TABLES["compare_memories"] = (
    "compare_memories",
    names(variants.MEMORY_COLUMNS),
    [
        {"memory": memory, "channels": channels, "scene": "truck", "mJ": mj}
        for memory, mj in (("lpddr3_known", "2"), ("lpddr9_unknown", ""), ("hbm9_unknown", ""))
        for channels in ("1", "2")
    ],
    (
        *("truck: mJ of a frame", "lpddr3_known", "more channels (1, 2)"),
        "Not drawn, no energy is known: lpddr9_unknown, hbm9_unknown.",
    ),
)
MACHINES = ("gscore", "exact", "GPU, modelled")
TABLES |= {
    "compare_machines_rates": (
        "compare_machines",
        names(compare_machines.COLUMNS),
        [
            {"scene": "truck", "size": "4x2", "GB/s": memory, "machine": machine}
            for machine, memory in zip(MACHINES, ("25.6", "25.6", "102.4"))
        ],
        (*MACHINES, "truck 4x2", "Frames a second, 25.6 GB/s", "at most, frames overlapped"),
    ),
    "compare_machines_traffic": (
        "compare_machines_bytes",
        ("scene", "size", "GB/s", "machine", "region", "value"),
        [
            {"scene": "truck", "GB/s": "25.6", "machine": machine, "region": part}
            for machine in MACHINES
            for part in ("tile_lists", "frame_buffer")
        ],
        (*MACHINES, "tile lists", "frame buffer", "on the bus, 25.6 GB/s"),
    ),
    "compare_machines_ratios": (
        "compare_machines_ratios",
        names(compare_machines.RATIO_COLUMNS),
        [
            {
                "GB/s": "25.6",
                "sizes": sizes,
                "machine": machine,
                "than": than,
                "published speed": speed,
            }
            for machine, than, speed in (
                ("paper", "gscore", "2.1"),
                ("exact", "gscore_lossless_boxes", ""),
            )
            for sizes in ("4x2", "all")
        ],
        ("exact / gscore_lossless_boxes, 25.6", "paper / gscore, 25.6", "Speed-up", "published"),
    ),
}
MADE_TOGETHER = {
    "error_image": (
        "error_image",
        names(error_against_time.IMAGE_COLUMNS),
        [
            {"scene": "truck", "order": order, "moved": moved, "to": to, "PSNR dB": quality}
            for order, moved, to, quality in (
                ("exact", "as the preset", "", "inf"),
                ("exact", "precision", "fp16", "63.1"),
                ("paper", "voxel", "x 2", "30"),
                ("tiles", "combined", "gscore", "46"),
            )
        ],
        ("truck: PSNR", "tile-centric", "frame time, ms", "voxel x 2", "equal"),
    ),
    "error_tuning": (
        "error_tuning",
        names(fitting.TUNING_COLUMNS),
        [
            {"what": "tuning", "of": "truck", "moved": "rate", "to": rate, "seconds": seconds}
            for rate in ("0.5", "1")
            for seconds in (1, 2)
        ],
        ("tuning truck: PSNR of test views", "rate 0.5"),
    ),
    "error_renderers": (
        "error_renderers",
        names(error_against_time.RENDERER_COLUMNS),
        [
            {"scene": "truck", "view": view, "renderer": name, "finished below": below}
            | {"threads": threads}
            for view in (0, 3)
            for name, below in (("double", "0.01"), ("double", "0.0001"), ("reference", "0.0001"))
            for threads in (1, 2)
        ],
        ("truck 0, renderers: PSNR", "truck 3, renderers: PSNR", "reference", "2 threads", "0.01"),
    ),
}
TABLES |= MADE_TOGETHER
OF_RUNS = ("roofline", "waits", "traffic")


class Figures(InFolder):
    def made(self, *words: str) -> tuple[int, str, str]:
        """Exit status, output and errors."""
        command = [sys.executable, "-B", str(SCRIPT), "--from", str(self.folder), *words]
        done = subprocess.run(command, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def write(self, name: str) -> None:
        table, head, different, _ = TABLES[name]
        by = tables.Made(f"scripts/results.py {table} truck", ("0123abc",))
        columns = [tables.Column(name, "") for name in head]
        tables.save(self.folder, table, by, columns, rows(head, *different))

    def svg_text(self, name: str) -> str:
        root = xml.etree.ElementTree.parse(self.folder / "figures" / f"{name}.svg").getroot()
        return " ".join(
            " ".join("".join(e.itertext()) for e in root.iter() if e.tag.endswith("text")).split()
        )


@unittest.skipUnless(any(map(has_matplotlib, PYTHONS)), "matplotlib is not installed")
class Drawn(Figures):
    @nightly
    def test_each_from_its_table(self):
        for name, (table, _, _, words) in TABLES.items():
            with self.subTest(name):
                self.write(name)
                status, said, errors = self.made(name)
                self.assertEqual((status, errors), (0, ""))
                self.assertIn("written to", said)
                text = self.svg_text(name)
                for word in (*words, f"scripts/results.py {table} truck", "commit 0123abc"):
                    self.assertIn(word, text)
                png = (self.folder / "figures" / f"{name}.png").read_bytes()
                self.assertGreater(len(png), 5000)
        self.assertEqual(list((self.folder / "figures").glob("*.part")), [])

    @nightly
    def test_claims_with_their_waterfalls_and_maps(self):
        by = tables.Made("scripts/results.py reproduction truck", ("0123abc",))
        presets = ("paper_text", "paper_ideal")
        claims = [
            {"claim": claim, "published": said, "preset": preset, "group px": group}
            | {"passes": "yes" if group == "96" else "no"}
            for claim, said in (("frames/s", 224), ("gain of the coarse filter", "about 1"))
            for preset in presets
            for group in ("64", "96")
        ]
        steps = grid("order", ("forwards", "backwards"), "step", ("all assumptions", "deep queues"))
        made = {
            "claims": (reproduction.CLAIM_COLUMNS, claims),
            "waterfall": (reproduction.WATERFALL_COLUMNS, steps),
            "map": (reproduction.MAP_COLUMNS, grid("preset", presets, "CFUs", (1, 2))),
        }
        for name, (columns, different) in made.items():
            head = names(columns)
            of = [tables.Column(column, "") for column in head]
            tables.save(self.folder, f"reproduction_{name}", by, of, rows(head, *different))
        self.assertEqual(self.made("reproduction")[0], 0)
        text = self.svg_text("reproduction")
        for word in ("groups of 96 px", "frames/s", "GSCore, backwards", "− deep queues", "CFUs of"):
            self.assertIn(word, text)
        self.assertNotIn("coarse filter", text)

    @unittest.skipUnless(COMMAND, "$STREAMINGGS is not set")
    @nightly
    def test_those_of_runs(self):
        for config in ("exact", "paper", "gscore"):
            run = simulations.Run(find_scene(str(self.scene)), "0", "64x36", config)
            simulations.simulate_into(self.folder / config, pathlib.Path(COMMAND), run).accepted()
        status, said, errors = self.made()
        self.assertEqual((status, errors), (0, ""))
        # What has no input is named, with who makes it.
        for name, (table, *_) in TABLES.items():
            self.assertRegex(
                said, rf"skipped {name}: .*{table}.csv is not there; scripts/\w+.py .*makes it"
            )
        for name in OF_RUNS:
            text = self.svg_text(name)
            for config in ("exact", "paper", "gscore"):
                self.assertIn(f"{config}, view 0", text)
        view = json.loads((self.folder / "exact" / "report.json").read_text())["views"][0]
        self.assertIn(view["provenance"]["commit"], self.svg_text("waits"))

    def test_a_picture_without_error_is_drawn_above_all_others(self):
        head = ("mm2", "psnr_db", "binding", "front", "beside")
        for others in ((("4", "38.5", "dram", "", ""), ("5", "44", "dram", "yes", "")), ()):
            with self.subTest(others):
                equal = ("6", "inf", "dram", "yes", "by hand")
                columns = [tables.Column(name, "") for name in head]
                by = tables.Made("scripts/explore.py", ("0123abc",))
                tables.save(self.folder, "explore", by, columns, [*others, equal])
                status, _, errors = self.made("exploration")
                self.assertEqual((status, errors), (0, ""))
                text = self.svg_text("exploration")
                # The name stands beside its point.
                self.assertIn("by hand", text)
                self.assertIn(" 44 equal " if others else " equal ", text)

    def test_the_same_numbers_give_the_same_file(self):
        self.write("variants")
        svg = self.folder / "figures" / "variants.svg"
        first, second = ((self.made("variants"), svg.read_bytes())[1] for _ in range(2))
        self.assertEqual(first, second)

    @unittest.skipUnless(has_matplotlib(sys.executable), "matplotlib is not installed")
    def test_before_anything_was_simulated_tables_are_drawn(self):
        tables = self.folder / "traces" / "results"
        tables.mkdir(parents=True)
        self.write("variants")
        for path in self.folder.glob("reproduction_variants.*"):
            path.rename(tables / path.name)
        with mock.patch.object(figures, "REPOSITORY", self.folder):
            status, said, out = self.ended(figures, "variants", "waits")
        self.assertEqual((status, said), (0, ""))
        self.assertIn("skipped waits", out)
        self.assertTrue((self.folder / "out" / "figures" / "variants.svg").exists())

    def test_what_is_refused(self):
        (self.folder / "reproduction_variants.csv").write_text("scene,mJ\ntruck,1\n")
        (self.folder / "voxel_study.csv").write_text("scene\n")
        for words, said in (
            (("nope",), "nope: no figure, expected headline"),
            (("characterisation",), "nothing to draw"),
            (("variants",), "columns scene, mJ; expected preset"),
            (("voxel_size",), "expected of the preset's"),
            (("--from", "/nowhere"), "--from: /nowhere: no folder"),
        ):
            with self.subTest(said):
                status, _, errors = self.made(*words)
                self.assertEqual(status, 2)
                self.assertIn(said, errors.splitlines()[-1])
                self.assertFalse((self.folder / "figures").exists())


class WithoutMatplotlib(Figures):
    def test_one_line_says_what_is_missing(self):
        # -S: no packages but Python's own; the scripts are found as ever. Debian's does not help.
        command = [sys.executable, "-S", str(SCRIPT), "--from", str(self.folder)]
        tried = {**os.environ, run_arguments.TRIED: "1"}
        done = subprocess.run(command, capture_output=True, text=True, env=tried)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        said = "^.*figures.py: needs python3-matplotlib, which scripts/tools.sh installs\n$"
        self.assertRegex(done.stderr, said)


class BlockDiagram(unittest.TestCase):
    """Without Matplotlib, from rows as `describe` prints them."""

    KEYS = {
        "clock_mhz": "1000",
        **dict.fromkeys(("group_width_px", "group_height_px", "hfus", "sorting_units"), "3"),
        "memory_port.max_outstanding": "16",
    }
    FIFOS = {block.fifo for block in block_diagram.BLOCKS if block.fifo}
    MEMORY = {
        "memory": "lpddr",
        "channels": "4",
        "bits of a channel": "32",
        "most GB/s": "25.6",
        block_diagram.PORT: "64",
    }

    def use(self, name: str) -> dict[str, str]:
        entries = "5 x 7 keys x 8 B" if name in self.FIFOS else "1000 B"
        size = {"memories": "5", "bytes": "1000", "bits wide": "96", "built as": "SRAM"}
        return {"use": name, "arithmetic": entries, **size}

    def drawn(self, *more: str, without: str = "") -> str:
        names = [*block_diagram.SHARED, *self.FIFOS, *more]
        names += [name for block in block_diagram.BLOCKS for name in block.uses]
        lanes = [name for block in block_diagram.BLOCKS for name in block.datapaths]
        return block_diagram.svg(
            "exact",
            self.KEYS,
            [{"datapath": name, "lanes": "20 fp32_lane"} for name in lanes],
            [self.use(name) for name in names if name != without],
            [self.MEMORY],
        )

    def text(self, svg: str) -> list[str]:
        root = xml.etree.ElementTree.fromstring(svg)
        return [element.text for element in root.iter() if element.tag.endswith("text")]

    def test_sizes_are_those_of_the_data_sheet(self):
        text = self.text(self.drawn("chunk queue 0", "chunk queue 1"))
        for expected in (
            *("preset exact: 1000 MHz, groups of 3 x 3 px", "3 x HFU, coarse", "1 x merge"),
            *("tests first halves: 20 lanes, fp32", "blends: 20 + 80 lanes, fp32"),
            "5 memory ports: 64 B a cycle each way, 16 requests in flight each",
            *("3,000 B chunk queue, 8,000 B more", "visits: 5 FIFOs of 7, 96 bits"),
            *("DRAM, 25.6 GB/s", "lpddr: 4 channels of 32 bits"),
        ):
            self.assertIn(expected, text)

    def test_each_memory_has_a_place(self):
        said = "block diagram: {}: expected in one block"
        with self.assertRaisesRegex(ValueError, said.format("a table")):
            self.drawn("a table")
        with self.assertRaisesRegex(ValueError, said.format("pixel state")):
            self.drawn(without="pixel state")


if __name__ == "__main__":
    unittest.main()
