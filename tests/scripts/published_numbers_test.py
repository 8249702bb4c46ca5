"""No source that computes reads a published result: the numbers that ours are held against stand in
scripts that print them, and nowhere in the C++ of algorithm, modules, tlm and testbench."""

import math
import pathlib
import re
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("algorithm", "modules", "tlm", "testbench")

PUBLISHED = (
    # StreamingGS: speed and energy over its GPU and its GSCore, rates, what filters drop, area.
    *(45.7, 21.6, 22.2, 62.9, 27.3, 21.5, 2.1, 2.3, 2.06, 4.9, 8.5, 224, 388),
    *(76.3, 0.763, 0.237, 23.7, 92.3, 0.923, 5.37, 5.53, 41, 49, 85),
    # GSCore: rates, bytes and counts of a frame, gains, area, power; the time of a simulation.
    *(190, 182.2, 78.8, 9.5, 3.1, 1570804, 334000, 168000, 1.71, 1.15, 1.86, 15.86, 3.95, 0.87),
    47.7,
    # Neo: rates, bytes; GBU: joules, watts; Speedy-Splat: a frame's time.
    *(66.7, 31.1, 15.8, 104.6, 1743, 346.5, 1.27, 16.5, 7.48),
)

# (file, number): what it means there. An entry that is not found any more fails too.
OTHER_MEANINGS: dict[tuple[str, float], str] = {
    # Operands that a longest path is looked for with.
    ("modules/streaminggs/vsu/vsu_datapaths.cpp", 2.1): "a position",
    ("modules/streaminggs/vsu/vsu_datapaths.cpp", 3.1): "a position",
    # Places, sizes and colours in the built-in scenes.
    ("testbench/builtin/buildings.cpp", 1.15): "half of a flag's width",
    ("testbench/builtin/buildings.cpp", 3.1): "half of a house's length",
    ("testbench/builtin/object_scene.cpp", 1.15): "a ball's place",
    ("testbench/builtin/object_scene.cpp", 2.3): "a camera's height",
    ("testbench/builtin/object_scene.cpp", 4.9): "a camera's distance",
    ("testbench/builtin/outdoor_scene.cpp", 2.1): "a camera's distance",
    ("testbench/builtin/outdoor_scene.cpp", 9.5): "a camera's place",
    ("testbench/builtin/plants.cpp", 8.5): "a meadow's radius",
    ("testbench/builtin/terrain.cpp", 1.15): "a pond's rim over its radius",
    ("testbench/builtin/terrain.cpp", 2.3): "scale of a terrain's noise",
    ("testbench/builtin/terrain.cpp", 190): "height of hills",
    ("testbench/builtin/toy_rocket.cpp", 0.87): "blue in white",
}

NOT_CODE = re.compile(
    r"//[^\n]*|/\*.*?\*/" r'|R"(\w*)\(.*?\)\1"' r'|"(?:\\.|[^"\\\n])*"' r"|'(?:\\.|[^'\\\n])'",
    re.DOTALL,
)
# With marks between thousands; an exponent is a unit.
NUMBER = re.compile(r"(?<![\w.'])(\d[\d']*(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?[fFlLuU]*(?![\w.])")


def digits(number: float) -> str:
    """Its significant digits: 334'000, 334e3 and 0.334e6 are one."""
    return f"{number:.12e}".partition("e")[0].rstrip("0").rstrip(".")


def same(number: float, literal: float) -> bool:
    """Of three digits or more also a thousand times as large or small: 47.7 s are 47,700 ms."""
    if len(digits(number).replace(".", "")) <= 2 or not literal:
        return number == literal
    thousands = round(math.log10(literal / number), 6)
    return thousands % 3 == 0


def literals(text: str) -> set[float]:
    code = NOT_CODE.sub(" ", text)
    return {float(found.group(1).replace("'", "")) for found in NUMBER.finditer(code)}


def published_in(text: str) -> set[float]:
    by_digits: dict[str, list[float]] = {}
    for number in PUBLISHED:
        by_digits.setdefault(digits(number), []).append(number)
    return {
        number
        for literal in literals(text)
        for number in by_digits.get(digits(literal), [])
        if same(number, literal)
    }


def sources():
    for folder in FOLDERS:
        for pattern in ("*.h", "*.cpp"):
            yield from sorted((REPOSITORY / folder).rglob(pattern))


class PublishedNumbers(unittest.TestCase):
    def test_no_source_that_computes_has_one(self):
        found = {
            (str(path.relative_to(REPOSITORY)), number)
            for path in sources()
            for number in published_in(path.read_text())
        }
        self.assertGreater(len(list(sources())), 300)
        self.assertEqual(found - OTHER_MEANINGS.keys(), set(), "a published result in the code")
        self.assertEqual(OTHER_MEANINGS.keys() - found, set(), "no longer there")

    def test_one_would_be_found(self):
        for text, number in (
            ("double speed_up = 45.7;", 45.7),
            ("return 21.6F * x;", 21.6),
            ("constexpr double kRate{190};", 190),
            ("seconds(47.7e-3)", 47.7),
            ("n = 334'000;", 334000),
            ("n = 1'570'804U;", 1570804),
            ('log("x"); f(66.70);', 66.7),
        ):
            with self.subTest(text):
                self.assertEqual(published_in(text), {number})
        harmless = ("// 45.7", '"45.7 times"', "/* 21.6\n */", "145.7", "41.5", "a190", "0x190")
        for text in harmless:
            with self.subTest(text):
                self.assertEqual(published_in(text), set())


if __name__ == "__main__":
    unittest.main()
