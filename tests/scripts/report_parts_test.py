"""What the page of results is put together from: pictures, numbers, shares, bars, maps, diagrams."""

import json
import random
import re
import struct
import unittest
import zlib

import in_folder  # noqa: F401, isort: skip (finds the scripts)
from runs import files
from reporting import charts, costs, page, tables
from reporting.folder import Table


def filtered_png(width: int, height: int, pixels: bytes) -> bytes:
    """RGB, its rows by filters 0 to 4 in turn, as other writers than ours make them."""
    step, rows, above = 3 * width, b"", bytes(3 * width)
    for y in range(height):
        row = pixels[y * step : (y + 1) * step]
        left = bytes(3) + row[:-3]
        corner = bytes(3) + above[:-3]
        guesses = (
            bytes(step),
            left,
            above,
            bytes((a + b) // 2 for a, b in zip(left, above)),
            bytes(charts.paeth(*three) for three in zip(left, above, corner)),
        )
        rows += bytes([y % 5]) + bytes((a - b) & 255 for a, b in zip(row, guesses[y % 5]))
        above = row
    made = charts.write_png(width, height, pixels)
    begin, data = made.index(b"IDAT") - 4, zlib.compress(rows)
    chunk = b"IDAT" + data
    chunk = struct.pack(">I", len(data)) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return made[:begin] + chunk + made[made.index(b"IEND") - 4 :]


class Parts(unittest.TestCase):
    def test_pictures_are_read_by_every_filter(self):
        pixels = random.Random(1).randbytes(3 * 7 * 10)
        width, height, rows = charts.read_png(filtered_png(7, 10, pixels))
        self.assertEqual((width, height, b"".join(rows)), (7, 10, pixels))

    def test_frame_rates_are_rounded_down(self):
        """As the terminal's: numbers_test has the same."""
        rates = [89.649, 89.96, 99.99, 1 / (1 / 90), 1 / (1 / 89.7), 100, 1234.9]
        told = ["89.6", "89.9", "99.9", "90.0", "89.7", "100", "1,234"]
        self.assertEqual([charts.rate(rate) for rate in rates], told)

    def test_pictures_are_halved(self):
        pixels = bytes(
            channel
            for row in ((10, 20, 200), (30, 40, 200), (255, 255, 255))
            for grey in row
            for channel in (grey, 0, 255 - grey)
        )
        half = charts.halved(charts.write_png(3, 3, pixels))
        self.assertEqual(charts.read_png(half), (1, 1, [bytearray((25, 0, 230))]))

    def test_what_is_no_picture_of_ours_is_refused(self):
        whole = charts.write_png(4, 4, bytes(48))
        for png, said in (
            (b"", "no PNG"),
            (b"GIF89a" + bytes(40), "no PNG"),
            (whole[:50], "PNG: "),
            (whole[:24] + b"\x10" + whole[25:], "8 bits"),
            (charts.write_png(1, 1, bytes(3)), "2 x 2"),
        ):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                charts.halved(png)

    def test_a_share_of_no_error(self):
        for share, text in ((None, "none"), (0, "0 %"), (0.5, "50 %"), (0.012, "1.2 %")):
            self.assertEqual(page.share_text(share), text)

    def test_levels_of_json(self):
        deep = json.loads("[" * 300 + "]" * 300)
        for found, count in ((1, 0), ({}, 1), ([1, {"a": [2]}], 3), (deep, 101)):
            self.assertEqual(files.levels(found), count)

    def test_numbers(self):
        for value, text in (
            (1234567, "1,234,567"),
            (1234.5, "1,234"),
            (0.012345, "0.0123"),
            (0.0, "0"),
        ):
            self.assertEqual(charts.number(value), text)
        for text, value in (("1,234.5", 1234.5), ("12%", 12), ("equal", None), ("", None)):
            self.assertEqual(tables.value_of(text), value)

    def test_units_that_stand_several_times_become_one_line(self):
        spent = [(f"hfu{i}.fine fetch", "fetch", {"busy": i, "idle": 10 - i}) for i in range(3)] + [
            ("vsu walk", "vsu", {"busy": 4, "idle": 6})
        ]
        self.assertEqual(
            costs.by_kind(spent),
            [
                ("hfu.fine fetch × 3", "fetch", {"busy": 3, "idle": 27}),
                ("vsu walk", "vsu", {"busy": 4, "idle": 6}),
            ],
        )

    def test_a_map_shows_each_group_in_its_place(self):
        groups = {
            "x_px": [0, 32, 0, 32],
            "y_px": [0, 0, 32, 32],
            "width_px": [32, 8, 32, 8],
            "height_px": [32, 32, 4, 4],
            "bytes": [0, 5, 10, 10],
            "missed": [0] * 4,
        }
        made = charts.heat_map("Bytes", "B", groups, "bytes")
        self.assertIn('viewBox="0 0 40 36"', made)
        self.assertIn('width="64" height="64"', made)
        self.assertIn("most 10 B", made)
        self.assertIn("none in any group", charts.heat_map("Missed", "", groups, "missed"))

    def test_a_table_becomes_a_diagram_of_its_numbers(self):
        table = Table(
            "explore",
            ("hfus", "group", "cycles", "mm2", "binding", "front"),
            (("2", "64", "1200", "5.5", "fine", "yes"), ("4", "64", "1000", "6.5", "dram", "")),
        )
        made = tables.section(table, "explore.csv")
        self.assertIn("<option value=2 selected>cycles", made)
        self.assertIn("<option value=3 selected>mm2", made)
        self.assertIn("&quot;best&quot;:[true,false]", made)
        self.assertIn("&quot;labels&quot;:[&quot;hfus 2&quot;,&quot;hfus 4&quot;]", made)

    def test_what_is_required_are_the_axes(self):
        """Not lanes against entries."""
        for measured in (("min(fps) >= 90", "mm2 <= 5"), ("mm2 <= 5", "min(fps) >= 90")):
            head = ("hfu.ffu_lanes", "merge.entries", "group", "max(watts)", *measured, "front")
            rows = ((f"{n}", f"{2 * n}", "64", f"{3 * n}", "91", "4.5", "") for n in (1, 2))
            made = tables.section(Table("explore", head, tuple(rows)), "explore.csv")
            with self.subTest(measured):
                for name in measured:
                    self.assertRegex(made, f"<option value=. selected>{re.escape(charts.escaped(name))}")
        head = ("hfu.ffu_lanes", "merge.entries", "group", "max(watts)", "sum(a)", "front")
        rows = (("1", "2", "64", "3", "4", ""), ("2", "4", "64", "6", "8", ""))
        made = tables.section(Table("explore", head, rows), "explore.csv")
        for name in ("max(watts)", "sum(a)"):
            self.assertRegex(made, rf"<option value=. selected>{re.escape(name)}")


if __name__ == "__main__":
    unittest.main()
