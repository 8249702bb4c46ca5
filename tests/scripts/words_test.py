"""Every README.md, and PAPER.md beside one, keeps to the rules of its prose: a budget of words, short
sentences, no number that somebody measured and typed, no history, no dead link. Tables between
`<!-- table: NAME -->` or `<!-- rows: NAME -->` and `<!-- end -->` are generated: nothing here reads
them."""

from __future__ import annotations

import dataclasses
import pathlib
import re
import statistics
import unittest
from collections.abc import Iterator

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
NOT_SOURCES = ("build", "out")

# Words a file may have outside generated tables.
BUDGETS = {
    "README.md": 1300,
    "algorithm/README.md": 500,
    "algorithm/dataset/README.md": 900,
    "algorithm/memory/README.md": 1200,
    "algorithm/render/README.md": 1500,
    "algorithm/scene_files/README.md": 500,
    "algorithm/splat/README.md": 1800,
    "algorithm/train/README.md": 1500,
    "algorithm/tune/README.md": 1200,
    "algorithm/vq/README.md": 500,
    "modules/README.md": 1200,
    "modules/datapath/README.md": 600,
    "modules/datapath/rtl/README.md": 800,
    "modules/display/README.md": 360,
    "modules/dram/README.md": 1200,
    "modules/gscore/README.md": 1500,
    "modules/streaminggs/PAPER.md": 2400,
    "modules/streaminggs/README.md": 2500,
    "modules/streaminggs/hfu/README.md": 700,
    "modules/streaminggs/merge/README.md": 600,
    "modules/streaminggs/merge/rtl/README.md": 300,
    "modules/streaminggs/rendering/README.md": 700,
    "modules/streaminggs/rendering/rtl/README.md": 600,
    "modules/streaminggs/sorting/README.md": 20,
    "modules/streaminggs/sorting/rtl/README.md": 200,
    "modules/streaminggs/vsu/README.md": 900,
    "scripts/README.md": 1500,
    "testbench/README.md": 500,
    "testbench/configs/README.md": 1200,
    "testbench/cost/README.md": 1500,
    "testbench/gpu/README.md": 700,
    "testbench/streaminggs/README.md": 2500,
    "testbench/units/README.md": 500,
    "tests/README.md": 1200,
    "tlm/README.md": 700,
    "traces/README.md": 700,
    "traces/results/README.md": 1500,
}
LONGEST = 25  # words of a sentence
MEDIAN, NINTH_TENTH = 14, 26  # words of a file's sentences, at most

GENERATED = re.compile(r"<!-- (?:table|rows): (\w+) -->\n.*?<!-- end -->", re.DOTALL)
FENCED = re.compile(r"^( *)```.*?^\1```", re.DOTALL | re.MULTILINE)
KEYS = ("key", "argument")  # how the head of a table of keys begins
CODE = re.compile(r"`[^`]*`")
IMAGE = re.compile(r"!\[[^]]*\]\([^)]*\)")
LINK = re.compile(r"\[([^]]*)\]\(([^)\s]*)\)")
SOURCE = re.compile(r"`([\w./-]*?)(\w+|\{[\w,]+\})\.(h|cpp|\{h,cpp\})`")
ITEM = re.compile(r"\s*([-*]|\d+\.)\s+")
SENTENCE_END = re.compile(r"(?<=[.!?])\**\)?\s+(?=[^a-z\s])")
MEASURED = re.compile(r"(?<![\w.])\d[\d,.]*(?: million| M)?\s?-?(dB|mm2|mJ|W|fps|frames a second|cycles?|%)(?!\w)")
COMMIT = re.compile(r"\b(?=\w*\d)(?=\w*[a-f])[0-9a-f]{7,40}\b")
FRAGMENT = re.compile(r"(Of|That|What)\b(?!.*\?$)", re.IGNORECASE)


@dataclasses.dataclass(frozen=True)
class Piece:
    """A paragraph, an item of a list, a heading or a cell of a table, from its first line on."""

    line: int
    text: str
    kind: str  # prose, heading, cell, key (a cell of a table of keys)


def blanked(text: str, what: re.Pattern[str]) -> str:
    """Without what is found; lines keep their numbers."""
    return what.sub(lambda found: "\n" * found.group(0).count("\n"), text)


def pieces(text: str) -> list[Piece]:
    """All that is not code and not generated."""
    found: list[Piece] = []
    kind_of_cells = ""  # within a table
    before = ""
    in_code = False
    for number, line in enumerate(blanked(blanked(text, GENERATED), FENCED).split("\n"), 1):
        stripped = line.strip()
        in_code = line.startswith("    ") and (in_code or not before)
        if in_code or not stripped:
            kind_of_cells = ""
        elif stripped.startswith("|"):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", stripped)[1:-1]]
            if not kind_of_cells:
                kind_of_cells = "key" if cells[0].lower().startswith(KEYS) else "cell"
            if not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
                found += [Piece(number, cell, kind_of_cells) for cell in cells if cell]
        elif stripped.startswith("#"):
            found.append(Piece(number, stripped.lstrip("# "), "heading"))
        elif before and found and found[-1].kind == "prose" and not ITEM.match(line):
            found[-1] = dataclasses.replace(found[-1], text=f"{found[-1].text} {stripped}")
        else:
            found.append(Piece(number, ITEM.sub("", line, 1).strip(), "prose"))
        before = "" if stripped.startswith(("|", "#")) else stripped
    return found


def plain(text: str) -> str:
    """As it is read: links and pictures by their words."""
    return LINK.sub(r"\1", IMAGE.sub("", text))


def sentences(text: str) -> Iterator[str]:
    for sentence in SENTENCE_END.split(plain(text)):
        if word_count(sentence):
            yield sentence.strip()


def word_count(text: str) -> int:
    return sum(bool(re.search(r"\w", word)) for word in text.split())


def lengths(text: str) -> list[int]:
    return [
        word_count(sentence)
        for piece in pieces(text)
        if piece.kind == "prose"
        for sentence in sentences(piece.text)
    ]


def ninth_tenth(numbers: list[int]) -> int:
    return sorted(numbers)[(9 * len(numbers) - 1) // 10]


def faults_of_prose(text: str) -> Iterator[tuple[int, str]]:
    """What no sentence, heading or cell may be: line, what is wrong."""
    for piece in pieces(text):
        read = CODE.sub("`code`", plain(piece.text))
        if piece.kind != "key" and (found := MEASURED.search(read)):
            yield piece.line, f"a number beside {found.group(1)}: {found.group(0)}"
        if found := COMMIT.search(read):
            yield piece.line, f"a commit: {found.group(0)}"
        if piece.kind == "heading":
            continue
        for sentence in sentences(piece.text):
            if FRAGMENT.match(sentence):
                yield piece.line, f"a fragment: {sentence}"
            if word_count(sentence) > LONGEST:
                yield piece.line, f"{word_count(sentence)} words: {sentence}"


def faults_of_length(text: str) -> Iterator[tuple[int, str]]:
    counts = lengths(text)
    if counts and statistics.median(counts) > MEDIAN:
        yield 1, f"the median sentence has {statistics.median(counts)} words, over {MEDIAN}"
    if counts and ninth_tenth(counts) > NINTH_TENTH:
        yield 1, f"a sentence in ten has {ninth_tenth(counts)} words or more, over {NINTH_TENTH}"


def faults_of_budget(text: str, budget: int) -> Iterator[tuple[int, str]]:
    words = len(blanked(text, GENERATED).split())
    if words > budget:
        yield 1, f"{words} words, over {budget}"


def headings(text: str) -> set[str]:
    """As links name them."""
    found: set[str] = set()
    for piece in pieces(text):
        if piece.kind == "heading":
            name = re.sub(r"[^\w\- ]", "", plain(piece.text).lower()).replace(" ", "-")
            found.add(name)
    return found


def faults_of_links(path: pathlib.Path, text: str) -> Iterator[tuple[int, str]]:
    for piece in pieces(text):
        for _, target in LINK.findall(CODE.sub("", piece.text)):
            name, _, heading = target.partition("#")
            file = path.parent / name if name else path
            if target.startswith(("http:", "https:")):
                continue
            if not file.exists():
                yield piece.line, f"a link to {target}, where nothing is"
            elif heading and heading not in headings(file.read_text("utf-8") if name else text):
                yield piece.line, f"a link to {target}, which has no such heading"


def faults_of_sources(path: pathlib.Path, text: str) -> Iterator[tuple[int, str]]:
    """Headers and sources that are named and not there: below the README's folder, or by a path
    from it or from the repository."""
    for piece in pieces(text):
        for folder, stem, ending in SOURCE.findall(piece.text):
            name = f"{folder}{stem}.{ending.replace('{h,cpp}', 'h')}"
            if not any(
                (start / name).exists() or "/" not in name and any(start.rglob(name))
                for start in (path.parent, REPOSITORY)
            ):
                yield piece.line, f"`{name}`, which is not there"


def readmes() -> dict[str, pathlib.Path]:
    found = {}
    for path in sorted([*REPOSITORY.rglob("README.md"), *REPOSITORY.rglob("PAPER.md")]):
        place = path.relative_to(REPOSITORY)
        if place.parts[0] not in NOT_SOURCES and not place.parts[0].startswith("."):
            found[place.as_posix()] = path
    return found


class Readmes(unittest.TestCase):
    def check(self, name: str, faults: Iterator[tuple[int, str]]) -> None:
        with self.subTest(name):
            self.assertEqual([f"{name}:{line}: {fault}" for line, fault in faults], [])

    def test_each_has_a_budget_and_keeps_it(self):
        for name, path in readmes().items():
            self.assertIn(name, BUDGETS)
            text = path.read_text(encoding="utf-8")
            self.check(name, faults_of_budget(text, BUDGETS[name]))

    def test_prose(self):
        for name, path in readmes().items():
            text = path.read_text(encoding="utf-8")
            self.check(name, faults_of_prose(text))
            self.check(name, faults_of_length(text))

    def test_sources_that_are_named(self):
        for name, path in readmes().items():
            self.check(name, faults_of_sources(path, path.read_text(encoding="utf-8")))

    def test_links(self):
        for name, path in readmes().items():
            self.check(name, faults_of_links(path, path.read_text(encoding="utf-8")))


class Planted(unittest.TestCase):
    """Each rule finds what breaks it."""

    def planted(self, text: str) -> list[tuple[int, str]]:
        return list(faults_of_prose(text))

    def test_a_measured_number(self):
        for number in ("31.2 dB", "6.5 mm2", "2.2 mJ", "4 W", "90 fps", "881,367 cycles", "19 %"):
            unit = number.split()[1]
            with self.subTest(number):
                text = f"# A unit\n\nIt is known.\nThe frame takes {number} here.\n"
                self.assertEqual(self.planted(text), [(3, f"a number beside {unit}: {number}")])
        self.assertTrue(self.planted("| scene | loss |\n|---|---|\n| truck | 3 % |\n"))
        self.assertTrue(self.planted("It saves\n12\n% of them.\n"))
        self.assertTrue(self.planted("- It takes 2.1 M cycles.\n"))

    def test_numbers_that_stand_where_they_may(self):
        for text in (
            "<!-- table: x -->\n| dB |\n| 31 dB |\n<!-- end -->\n",
            "```\n31.2 dB\n```\n",
            "Printed:\n\n    fps 90 fps\n",
            "| key | default |\n|---|---|\n| `depth` | 3 cycles |\n",
            "An entry has 16 B, and `4 cycles` is code.\n",
        ):
            with self.subTest(text):
                self.assertEqual(self.planted(text), [])

    def test_a_commit(self):
        self.assertEqual(self.planted("Made at dddf637.\n"), [(1, "a commit: dddf637")])
        self.assertEqual(self.planted("It has 1234567 entries, effaced.\n"), [])

    def test_a_fragment(self):
        for text in ("Of a splat the rows.", "That it takes.", "| row |\n|---|\n| of a splat |"):
            with self.subTest(text):
                self.assertEqual(len(self.planted(text)), 1)
        self.assertEqual(self.planted("What binds? The memory does.\n\n## What binds\n"), [])

    def test_a_long_sentence(self):
        self.assertEqual(self.planted("word " * LONGEST + ".\n\nAnother one.\n"), [])
        self.assertEqual(len(self.planted("A word. " + "word " * (LONGEST + 1) + ".\n")), 1)

    def test_sentences_that_are_long_on_the_whole(self):
        short, long = "Ten words. " * 10, ("word " * 20 + "end. ") * 11
        self.assertEqual(list(faults_of_length(short.replace("words", "w " * 9))), [])
        self.assertEqual(len(list(faults_of_length(short.title() + long.title()))), 1)

    def test_a_word_too_many(self):
        text = "One two three.\n<!-- table: x -->\n| many words |\n<!-- end -->\n"
        self.assertEqual(list(faults_of_budget(text, 3)), [])
        self.assertEqual(list(faults_of_budget(text, 2)), [(1, "3 words, over 2")])

    def test_a_source_that_is_gone(self):
        path = REPOSITORY / "tlm" / "README.md"
        text = "`activity.h`, `memory_port.{h,cpp}`, `../tlm/phase.h`, `tlm/phase.h`, `x.json`\n"
        self.assertEqual(list(faults_of_sources(path, text)), [])
        for name in ("gone.h", "../tlm/gone.{h,cpp}"):
            with self.subTest(name):
                self.assertEqual(len(list(faults_of_sources(path, f"`{name}`\n"))), 1)

    def test_a_dead_link(self):
        path = REPOSITORY / "README.md"
        self.assertEqual(list(faults_of_links(path, "# A b\n[x](#a-b) [y](LICENSE)\n")), [])
        for target in ("#c", "nowhere.md"):
            with self.subTest(target):
                self.assertEqual(len(list(faults_of_links(path, f"# A b\n\n[x]({target})\n"))), 1)


if __name__ == "__main__":
    unittest.main()
