"""Which tests cover a source: those whose program holds it, nearest first. Read from what CMake
says of its targets and from the #include lines."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import re
import subprocess
from collections.abc import Iterable, Mapping

QUERY = pathlib.Path(".cmake", "api", "v1", "query", "codemodel-v2")
REPLY = pathlib.Path(".cmake", "api", "v1", "reply")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# Of names of programs, no help to tell what they test.
COMMON_WORDS = {"test", "tb", "full", "unit", "cpp", "h", "algorithm", "modules", "tests"}
LONG = "full"  # label of tests that the normal suite leaves out, and in the names of their programs
WHOLE = "tests/system"  # of tests of all units together, which take longest


@dataclasses.dataclass
class Target:
    name: str
    folder: str  # of its CMakeLists.txt, from the project's
    own: tuple[str, ...]  # sources of itself, from the project's folder
    sources: frozenset[str]  # from the project's folder; also of all targets that it is made of
    program: str  # from the build folder
    programs: tuple[str, ...]  # with those that it runs


@dataclasses.dataclass(frozen=True)
class Test:
    name: str
    command: tuple[str, ...]
    folder: str  # where it runs; empty: in the build folder
    skip_status: int | None  # exit status of what has been skipped
    fails_on: re.Pattern | None  # in what it says


def ask(build: pathlib.Path) -> None:
    """Before CMake configures: it is to say what its targets are."""
    (build / QUERY).parent.mkdir(parents=True, exist_ok=True)
    (build / QUERY).touch()


def executables(build: pathlib.Path) -> dict[str, Target]:
    """By name, each with all that goes into it."""
    index = json.loads(max((build / REPLY).glob("index-*.json")).read_text())
    reply = index["reply"]["codemodel-v2"]["jsonFile"]
    model = json.loads((build / REPLY / reply).read_text())["configurations"][0]
    said = {
        target["id"]: json.loads((build / REPLY / target["jsonFile"]).read_text())
        for target in model["targets"]
    }
    return {
        target["name"]: gathered(key, said)
        for key, target in said.items()
        if target["type"] == "EXECUTABLE"
    }


def gathered(key: str, said: Mapping[str, dict]) -> Target:
    everything, waiting = set(), [key]
    while waiting:
        one = waiting.pop()
        if one not in everything:
            everything.add(one)
            waiting += [below["id"] for below in said[one].get("dependencies", ())]
    parts = [said[one] for one in everything]
    return Target(
        said[key]["name"],
        said[key]["paths"]["source"],
        tuple(source["path"] for source in said[key].get("sources", ())),
        frozenset(source["path"] for part in parts for source in part.get("sources", ())),
        said[key]["artifacts"][0]["path"],
        tuple(
            sorted(
                artifact["path"]
                for part in parts
                if part["type"] == "EXECUTABLE"
                for artifact in part.get("artifacts", ())
            )
        ),
    )


def includers(project: pathlib.Path, files: Iterable[str]) -> dict[str, set[str]]:
    """Of each file those that include it, themselves or through others; with itself."""
    files = set(files)
    direct: dict[str, set[str]] = {file: set() for file in files}
    for file in files:
        for name in INCLUDE.findall((project / file).read_text(errors="replace")):
            if name in direct:
                direct[name].add(file)
    found = {}
    for file in files:
        reached, waiting = {file}, [file]
        while waiting:
            for above in direct[waiting.pop()] - reached:
                reached.add(above)
                waiting.append(above)
        found[file] = reached
    return found


def words(path: str) -> set[str]:
    return set(re.split(r"[\W_]+", path)) - COMMON_WORDS


def closeness(target: Target, source: str) -> tuple:
    """To sort by: tests of parts before those of the whole; then those of the folder of the source
    and those named after it; then the smaller program, which says more about what it holds."""
    folder = pathlib.PurePath(target.folder).parts
    folder = folder[1:] if folder[:1] == ("tests",) else folder
    shared = 0
    for ours, its in zip(folder, pathlib.PurePath(source).parts):
        if ours != its:
            break
        shared += 1
    of_target = words(target.name).union(*(words(pathlib.PurePath(own).stem) for own in target.own))
    named = of_target & words(source)
    alike = len(named) + 2 * len(named & words(pathlib.PurePath(source).stem))
    return (target.folder == WHOLE, -2 * shared - alike, len(target.sources), target.name)


def covering(
    targets: Iterable[Target], source: str, including: Mapping[str, set[str]]
) -> list[Target]:
    """The targets whose programs change with a source, nearest first."""
    with_it = including[source]
    held = [target for target in targets if target.sources & with_it]
    return sorted(held, key=lambda target: closeness(target, source))


def tested(build: pathlib.Path, targets: Iterable[Target]) -> list[Target]:
    """Those that are tests of the normal suite, built or not: ctest names no program that is not."""
    said = "".join(path.read_text() for path in build.rglob("CTestTestfile.cmake"))
    return [
        target
        for target in targets
        if LONG not in target.name.split("_")
        # As add_test() has it, or Catch2's list of the tests in it.
        and (f'"{build / target.program}"' in said or f"/{target.name}_include" in said)
    ]


def tests(build: pathlib.Path) -> list[Test]:
    """Of the normal suite, as far as it is built."""
    command = ["ctest", "--show-only=json-v1"]
    shown = subprocess.run(command, cwd=build, check=True, capture_output=True).stdout
    found = []
    for test in json.loads(shown)["tests"]:
        properties = {p["name"]: p["value"] for p in test.get("properties", ())}
        if "command" in test and LONG not in properties.get("LABELS", ()):
            fails_on = properties.get("FAIL_REGULAR_EXPRESSION")
            found.append(
                Test(
                    test["name"],
                    tuple(test["command"]),
                    properties.get("WORKING_DIRECTORY", ""),
                    properties.get("SKIP_RETURN_CODE"),
                    re.compile("|".join(fails_on)) if fails_on else None,
                )
            )
    return found
