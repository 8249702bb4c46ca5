"""planted_faults.py: which faults there are in a source, which tests cover it, and what is said of
those that are planted."""

import pathlib
import shutil
import subprocess
import tempfile
import textwrap
import unittest

from in_folder import InFolder, nightly  # isort: skip (finds the scripts)
import covering_tests
import fault_kinds
import planted_faults
from covering_tests import Target
from fault_tree import only_one


def of_line(line: str) -> dict[str, set[str]]:
    """What can become of a line, by kind."""
    found: dict[str, set[str]] = {}
    for fault in fault_kinds.faults_in("a.cpp", line):
        found.setdefault(fault.kind, set()).add(fault.after)
    return found


class Kinds(unittest.TestCase):
    def test_what_can_become_of_a_line(self):
        for line, found in (
            ("x = a + b;", {"operator": {"x = a - b;"}}),
            ("x = std::min(a, b);", {"operator": {"x = std::max(a, b);"}}),
            ("return a < b;", {"condition": {"return a <= b;"}}),
            ("  if (empty()) {", {"condition": {"  if (not empty()) {"}}),
            ("bool on = true;", {"condition": {"bool on = false;"}}),
            ("int n{7};", {"constant": {"int n{8};"}}),
            ("x = 2.5f;", {"constant": {"x = 5.0f;"}}),
            ("x = 3U;", {"constant": {"x = 4U;"}}),
            ("  walk_.work(n);", {"dropped wait": {"  ;"}}),
            ("  await(memory, walk_, ticket);", {"dropped wait": {"  ;"}}),
            ("  ++used_;", {"dropped count": {"  ;"}}),
            ("  n += m;", {"dropped count": {"  ;"}, "operator": {"  n -= m;"}}),
        ):
            with self.subTest(line):
                self.assertEqual(of_line(line), found)

    def test_what_is_not_compiled_stays(self):
        for line in (
            "// a + b, 7",
            "call(/* 7 */);",
            'say("a + b < 7 \\" + 8");',
            'say(R"(a + b)");',
            "#define N 7",
            "static_assert(sizeof(int) == 4);",
            'throw Error(a + b, "7");',
            'SC_REPORT_ERROR("/a", n + 1);',
            "template <int N = 7>",
            "std::vector<int*> a_7b, *p;",
        ):
            with self.subTest(line):
                self.assertEqual(of_line(line), {})

    def test_what_is_said_ends_with_its_statement(self):
        text = 'throw Error(a + b,\n            "7", 8);\nx = a + b;\n'
        self.assertEqual({fault.line for fault in fault_kinds.faults_in("a.cpp", text)}, {3})

    def test_counters_are_swapped_for_others_of_the_file(self):
        text = "counters_.a = x;\ncounters_.b = y;\n"
        swapped = [f.after for f in fault_kinds.faults_in("a.cpp", text) if "swapped" in f.kind]
        self.assertEqual(swapped, ["counters_.b = x;", "counters_.a = y;"])
        alone = fault_kinds.faults_in("a.cpp", "counters_.a = x;\n")
        self.assertEqual(alone, [])

    def test_the_draw(self):
        text = "".join(f"a{n} = b{n} + c{n};\nd{n} = e{n} < f{n};\n" for n in range(40))
        faults = fault_kinds.faults_in("a.cpp", text)
        first = [list(fault_kinds.drawn(faults, seed)) for seed in (1, 1, 2)]
        self.assertEqual(first[0], first[1])
        self.assertNotEqual(first[0], first[2])
        self.assertCountEqual(first[0], faults)
        kinds = [fault.kind for fault in first[0][:6]]
        self.assertEqual(kinds, ["condition", "operator"] * 3)
        # A line more changes the order of no others.
        grown = fault_kinds.faults_in("a.cpp", "x = y + z;\n" + text)
        before = {fault.name() for fault in faults}
        rest = [f.name() for f in fault_kinds.drawn(grown, 1) if f.name() in before]
        operators = [name for name in rest if name.startswith("operator")]
        self.assertEqual(operators, [f.name() for f in first[0] if f.kind == "operator"])

    def test_a_change_in_words(self):
        (fault,) = fault_kinds.faults_in("a.cpp", "  return alpha < beta;")
        self.assertEqual(fault.change(), "`return alpha < beta;` to `return alpha <= beta;`")


class Covering(unittest.TestCase):
    def test_nearest_first(self):
        def target(name, folder, *sources):
            own = (f"{folder}/{name}.cpp",)
            return Target(name, folder, own, frozenset({*sources, *own}), name, (name,))

        unit = "modules/machine/sorting/sorter.cpp"
        targets = [
            target("system_test", "tests/system", unit, "b.cpp", "c.cpp", "d.cpp"),
            target("other_test", "tests/modules/dram", "b.cpp"),
            target("machine_test", "tests/modules/machine", unit, "b.cpp"),
            target("tb_sorter", "testbench/units", unit, "b.cpp"),
        ]
        including = {unit: {unit}, "a.h": {"a.h", "c.cpp"}}
        names = lambda source: [t.name for t in covering_tests.covering(targets, source, including)]
        self.assertEqual(names(unit), ["machine_test", "tb_sorter", "system_test"])
        self.assertEqual(names("a.h"), ["system_test"])

    def test_through_headers(self):
        sources = {
            "a.h": "",
            "b.h": '#include "a.h"\n',
            "c.cpp": '#include <a.h>\n#include "b.h"\n',
            "d.cpp": "#include <a.h>\n",
        }
        with tempfile.TemporaryDirectory() as folder:
            for name, text in sources.items():
                pathlib.Path(folder, name).write_text(text)
            found = covering_tests.includers(pathlib.Path(folder), sources)
        self.assertEqual(found["a.h"], {"a.h", "b.h", "c.cpp"})
        self.assertEqual(found["d.cpp"], {"d.cpp"})


class Refused(InFolder):
    def test_numbers_that_say_nothing(self):
        for option, value, said in (
            ("--faults", "-1", "got -1, expected a number of 1 or more"),
            ("--faults", "0", "got 0, expected a number of 1 or more"),
            ("--minutes-each", "nan", "got nan, expected a number above 0"),
            ("--minutes-each", "0", "got 0.0, expected a number above 0"),
            ("--patience", "0", "got 0.0, expected a number above 0"),
            ("--patience", "inf", "got inf, expected a number above 0"),
            ("--side-by-side", "0", "got 0, expected a number of 1 or more"),
            ("--seed", "-1", "got -1, expected a number of 0 or more"),
        ):
            with self.subTest(option, value=value):
                work, out = self.folder / "work", self.folder / "out"
                words = (option, value, "--work", str(work), "--out", str(out))
                status, line, made = self.ended(planted_faults, *words)
                self.assertEqual(line, f"planted_faults.py: {option}: {said}")
                self.assertEqual((status, made, work.exists()), (2, "", False))


SOURCES = {
    "CMakePresets.json": """
        {"version": 6,
         "configurePresets": [{"name": "release", "generator": "Ninja",
                               "binaryDir": "${sourceDir}/build/release"}],
         "buildPresets": [{"name": "release", "configurePreset": "release"}]}
        """,
    "CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.25)
        project(small LANGUAGES CXX)
        enable_testing()
        include_directories(${CMAKE_SOURCE_DIR})
        add_library(small STATIC algorithm/small.cpp)
        add_executable(small_test tests/small_test.cpp)
        target_link_libraries(small_test PRIVATE small)
        add_test(NAME sum COMMAND small_test sum)
        add_test(NAME always COMMAND small_test always)
        """,
    "algorithm/small.h": "int sum(int a, int b);\nint unused(int a);\n",
    "algorithm/small.cpp": """
        #include "algorithm/small.h"
        int sum(int a, int b) { return a + b; }
        int seen(int a) {
          return a < 5;
        }
        int neither(int a) {
          if (a == a) return 1;
          return 2;
        }
        """,
    "tests/small_test.cpp": """
        #include <cstring>
        #include "algorithm/small.h"
        int main(int, char* argv[]) { return std::strcmp(argv[1], "sum") == 0 && sum(4, 3) != 7; }
        """,
}


@unittest.skipUnless(
    all(map(shutil.which, ("cmake", "ninja", "c++", "git"))), "cmake, ninja, c++ or git is missing"
)
@nightly
class Planting(InFolder):
    def setUp(self):
        super().setUp()
        self.project = self.folder / "project"
        for name, text in SOURCES.items():
            path = self.project / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(textwrap.dedent(text))
        for words in (["init", "-q"], ["add", "."]):
            subprocess.run(["git", "-C", str(self.project), *words], check=True)

    def run_script(self, *more):
        status, said, out = self.ended(
            planted_faults,
            "--project",
            str(self.project),
            "--work",
            str(self.folder / "work"),
            "--out",
            str(self.folder / "out"),
            *more,
        )
        self.assertEqual(status, 0, said)
        return (self.folder / "out" / "planted_faults.md").read_text()

    def lines(self):
        return (self.folder / "out" / "planted_faults.jsonl").read_text().splitlines()

    def test_found_survived_and_the_same(self):
        table = self.run_script("--faults", "100")
        rows = [line for line in table.splitlines() if line.startswith("| ")]
        (found,) = [row for row in rows if "a - b" in row]
        self.assertIn("| found | sum |", found)
        self.assertIn("| survived |", "".join(row for row in rows if "a <= 5" in row))
        self.assertIn("| same programs |", "".join(row for row in rows if "return 3" in row))
        self.assertIn("6 faults: 1 found, 5 survived", table)
        project = (self.project / "algorithm" / "small.cpp").read_text()
        self.assertEqual(project, textwrap.dedent(SOURCES["algorithm/small.cpp"]))

        # Again: nothing is tried, and the table is the same.
        before = self.lines()
        self.assertEqual(self.run_script("--faults", "100"), table)
        self.assertEqual(self.lines(), before)

        # A test more: what survived is tried again, what was found is not.
        test = self.project / "tests" / "small_test.cpp"
        test.write_text(
            test.read_text()
            .replace("#include <c", "int seen(int a);\n#include <c")
            .replace("sum(4, 3) != 7", "(sum(4, 3) != 7 || seen(5))")
        )
        table = self.run_script("--faults", "100")
        (row,) = [line for line in table.splitlines() if "a <= 5" in line]
        self.assertIn("| found | sum |", row)
        again = [line for line in self.lines()[len(before) :] if "a - b" in line]
        self.assertEqual(again, [])

    def test_a_test_that_fails_anyway_finds_nothing(self):
        (self.project / "tests" / "small_test.cpp").write_text("int main() { return 1; }\n")
        self.assertNotIn("| found |", self.run_script("--faults", "100"))

    def test_a_test_that_fails_now_and_then_finds_nothing(self):
        test = self.project / "tests" / "small_test.cpp"
        test.write_text(
            test.read_text()
            .replace("#include <c", "#include <cstdio>\n#include <c")
            .replace(
                " return ",
                """
              if (std::strcmp(argv[1], "always") == 0) {
                if (std::remove("failed") == 0) return 0;
                std::fclose(std::fopen("failed", "w"));
                return 1;
              }
              return """,
            )
        )
        table = self.run_script("--faults", "100")
        self.assertIn("6 faults: 1 found, 5 survived", table)
        self.assertNotIn("| found | always |", table)

    def test_two_do_not_plant_in_one_tree(self):
        with only_one(self.folder / "work"):
            with self.assertRaisesRegex(AssertionError, "another run plants faults there"):
                self.run_script()

    def test_what_is_no_project(self):
        status, said, _ = self.ended(
            planted_faults,
            "--project",
            str(self.folder),
            "--work",
            str(self.folder / "w"),
            "--out",
            str(self.folder / "out"),
        )
        self.assertEqual(status, 2)
        self.assertIn("expected a folder under git", said)


if __name__ == "__main__":
    unittest.main()
