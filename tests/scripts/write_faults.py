#!/usr/bin/env python3
"""Whether outputs are whole whatever happens while they are written: runs each command on a small
job again and again, and each time the kernel fails its N-th write or rename, kills it there, or
tells it that nobody reads its output any more: for every N, in the command itself and in what it
starts. strace does it (Debian's package). And with a disk that is full after so many bytes, for as
many sizes. Afterwards

  a file under its final name must be that of a run without fault: the same bytes or, where it states
  times (reports, logs, checkpoints), whole as its kind can be;
  temporaries are left by what was killed, and by nothing else;
  whoever lives ends with exit status 1 or 2 and one line that says why.

Makes the table write_faults: trials and what was found, by command and fault. Exit status 1 where
anything was found; each is a line on stderr.
"""

from __future__ import annotations

import argparse
import collections
import dataclasses
import functools
import json
import math
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator, Sequence

import in_folder  # noqa: F401, isort: skip (finds the scripts)
import tables
from reporting import charts
from runs import run_arguments
from runs.scenes import BINARY, REPOSITORY, Failure
from tables import Column

SCENE = ("builtin:object?n=60", "--size", "16x16")
SMALL = (*SCENE, "--view", "0")
CAMERAS = 9
SIDE_PX = 16
# Of one trial; whoever takes longer hangs.
MOST_SECONDS = 120

CALLS = ("write", "pwrite64", "writev", "rename")
WRITES = "write,pwrite64,writev"
# Files that state times, so that no two runs write them alike.
TIMED = (".json", ".jsonl", ".csv", ".checkpoint", ".html")
# By which the length of these differs between runs, at most.
TIMED_DIGITS = 64
# Of a disk, where --most says nothing.
SIZES = 20
COLUMNS = (
    Column("command", "job that it was tried on"),
    Column("fault", "what the kernel does to its writes"),
    Column("in", "the command itself, or all that it starts"),
    Column("trials", "of the fault", "", ","),
    Column("found", "that were not as they must be", "", ","),
)


@dataclasses.dataclass(frozen=True)
class Work:
    """A command, in whose folder everything is that it reads and writes; and those before it."""

    words: tuple[str, ...]
    before: tuple[tuple[str, ...], ...] = ()


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str
    calls: str  # that are tampered with
    how: str  # as strace has it
    where: str = ""  # what strace says of the descriptor; empty: any


FAULTS = (
    Fault("a write fails", WRITES, "error=ENOSPC"),
    Fault("a rename fails", "rename", "error=EIO"),
    Fault("killed at a write", WRITES, "signal=KILL"),
    Fault("killed at a rename", "rename", "signal=KILL"),
    Fault("nobody reads its output any more", WRITES, "error=EPIPE:signal=PIPE", "(1<"),
)
FULL = "the disk is full"
WHOSE = {"itself": (), "all it starts": ("-f",)}

SG, SCRIPTS = "streaminggs", "scripts"
SIMULATE = (SG, "simulate", *SMALL, "--out", "o", "--vcd", "a.vcd", "--timeline", "a.json")
TUNE = (SG, "tune", *SCENE, "--boundary", "--steps", "4", "--test-every", "2", "--checkpoint", "2")
WORKS = {
    "simulate": Work((*SIMULATE, "--dram-trace", "a.txt")),
    "simulate, a run is there": Work(SIMULATE, (SIMULATE,)),
    "render": Work((SG, "render", *SMALL, "--out", "a.exr")),
    "render, a picture is there": Work(
        (SG, "render", *SMALL, "--out", "a.png"), ((SG, "render", *SMALL, "--out", "a.png"),)
    ),
    "convert": Work((SG, "convert", "builtin:object?n=600", "a.ply")),
    "pack": Work((SG, "pack", "builtin:object?n=600", "--out", "a.sgs")),
    "sweep": Work((SG, "sweep", *SMALL, "--axis", "dram.channels=4,8", "--out", "s.jsonl")
                  + ("--csv", "s.csv")),
    "tune": Work((*TUNE, "--out", "t.ply", "--log", "l.csv", "--pictures", "p")),
    "train": Work((SG, "train", "d", "--steps", "4", "--gaussians", "40", "--test-every", "2")
                  + ("--checkpoint", "2", "--out", "t.ply", "--log", "l.csv")),
    "photographs": Work((SG, "photographs", "d", "--out", "p")),
    "info": Work((SG, "info", SCENE[0])),
    "report.py": Work((SCRIPTS, "report.py", "o"), (SIMULATE,)),
}  # fmt: skip
JOBS = ", ".join(f"'{name}'" for name in WORKS)


def write_dataset(folder: pathlib.Path) -> None:
    """Photographs of one colour by cameras on an arc: every eighth is to test with."""
    (folder / "images").mkdir(parents=True)
    cameras = []
    for i in range(CAMERAS):
        right, ahead = math.cos(i / CAMERAS), math.sin(i / CAMERAS)
        camera = {"id": i, "img_name": f"{i}", "width": SIDE_PX, "height": SIDE_PX}
        camera |= {"fx": 20, "fy": 20, "position": [2 * ahead, 0, -2 * right]}
        camera["rotation"] = [[right, 0, -ahead], [0, 1, 0], [ahead, 0, right]]
        cameras.append(camera)
        picture = charts.write_png(SIDE_PX, SIDE_PX, bytes((200, 100, 50)) * SIDE_PX**2)
        (folder / "images" / f"{i}.png").write_bytes(picture)
    (folder / "cameras.json").write_text(json.dumps(cameras))


def files_below(folder: pathlib.Path) -> dict[str, bytes]:
    """Of waveforms without the second in which they were made."""
    return {
        str(path.relative_to(folder)): re.sub(rb"\$date.*?\$end", b"", path.read_bytes(), 1, re.S)
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def whole(name: str, content: bytes, other: bytes, killed: bool) -> bool:
    """Whether a file that no two runs write alike is one. other: that of a run without fault."""
    suffix = pathlib.Path(name).suffix
    try:
        if suffix == ".json":
            return bool(json.loads(content))
        if suffix == ".jsonl":
            lines = content.split(b"\n")
            # A sweep drops the beginning of a line that whoever was killed has left.
            torn = lines.pop()
            return all(json.loads(line) for line in lines) and (killed or not torn)
    except ValueError:
        return False
    if suffix == ".checkpoint":
        return content[14:18] == zlib.crc32(content[18:]).to_bytes(4, "little")
    if suffix == ".html":
        return content.rstrip().endswith(b"</html>")
    # Lines, whole ones; a log is there before all of it is.
    columns = other.split(b"\n")[0].count(b",")
    lines = content.split(b"\n")
    return not lines.pop() and all(line.count(b",") == columns for line in lines)


def tampered(calls: Sequence[str]) -> list[str]:
    """Lines of strace where the calls begin that were tampered with: those of several processes are
    cut in two, and what a kill has hit is only in the first half."""
    began: dict[str, str] = {}
    hit = []
    for line in calls:
        process, what = line.split(maxsplit=1) if line[:1].isdigit() else ("", line)
        if re.match(r"\w+\(", what):
            began[process] = line
        if "(INJECTED)" in what or "by SIGKILL" in what:
            hit.append(began.get(process, line))
    return hit


KILLED = (-signal.SIGKILL, -signal.SIGPIPE)


@dataclasses.dataclass
class Ended:
    status: int
    said: str
    calls: list[str]  # lines of strace


class Bench:
    """A job in a folder that is the same for every trial."""

    def __init__(self, work: Work, programs: dict[str, Sequence[str]], folder: pathlib.Path):
        self.work, self.programs, self.folder = work, programs, folder
        self.start, self.place = folder / "start", folder / "trial"
        self.log, self.out = folder / "log", folder / "out"
        self.start.mkdir(parents=True)
        write_dataset(self.start / "d")
        for words in work.before:
            done = subprocess.run(
                self.command(words), cwd=self.start, capture_output=True, text=True, check=False
            )
            if done.returncode:
                raise Failure(f"{' '.join(words)}: {done.stderr.strip()}")
        self.before = files_below(self.start)
        self.good = self.undisturbed()
        new = {name: len(b) for name, b in self.good.items() if self.before.get(name) != b}
        said = self.out.stat().st_size
        timed = said > 0 or any(pathlib.Path(name).suffix in TIMED for name in new)
        # What says times is a few digits longer or shorter in each run.
        self.most_bytes = max(1, max([said, *new.values()]) - (TIMED_DIGITS if timed else 0))

    def command(self, words: Sequence[str]) -> list[str]:
        program, *arguments = words
        if program == SCRIPTS:
            script = REPOSITORY / SCRIPTS / arguments[0]
            return [sys.executable, "-B", str(script), *arguments[1:]]
        return [*self.programs[program], *arguments]

    def run(self, under: Sequence[str] = ()) -> Ended:
        """under: words before those of the command."""
        shutil.rmtree(self.place, ignore_errors=True)
        shutil.copytree(self.start, self.place)
        self.log.write_text("")
        try:
            with self.out.open("wb") as channel:
                done = subprocess.run(
                    [*under, *self.command(self.work.words)],
                    cwd=self.place,
                    stdin=subprocess.DEVNULL,
                    stdout=channel,
                    stderr=subprocess.PIPE,
                    timeout=MOST_SECONDS,
                    check=False,
                )
        except subprocess.TimeoutExpired:
            return Ended(-signal.SIGALRM, f"still runs after {MOST_SECONDS} s", [])
        calls = self.log.read_text(errors="replace").splitlines()
        return Ended(done.returncode, done.stderr.decode(errors="replace"), calls)

    def strace(self, *more: str) -> list[str]:
        calls = ",".join(CALLS)
        return ["strace", "-qqq", "-y", "-o", str(self.log), "-e", f"trace={calls}", *more]

    def undisturbed(self) -> dict[str, bytes]:
        ended = self.run()
        if ended.status:
            raise Failure(f"{' '.join(self.work.words)}: {ended.said.strip()}")
        return files_below(self.place)

    def most_calls(self, fault: Fault, whose: Sequence[str]) -> int:
        """Of one process: strace counts each one's own. Of what has no children: 0 with -f."""
        counts: collections.Counter[str] = collections.Counter()
        for line in self.run(self.strace(*whose)).calls:
            call = re.match(r"(\d*) *(\w+)\(", line)
            if call and call[2] in fault.calls.split(","):
                counts[call[1]] += 1
        if whose and len(counts) == 1:
            return 0
        return max(counts.values(), default=0)

    def wrong_at(self, fault: Fault, whose: Sequence[str], number: int) -> Iterator[str]:
        """What is not as it must be when the fault is in the N-th call; nothing where none was."""
        inject = f"inject={fault.calls}:{fault.how}:when={number}"
        ended = self.run(self.strace(*whose, "-e", inject))
        hit = tampered(ended.calls)
        # A pipe is on no disk, and nobody waits for what SystemC's files say of theirs.
        elsewhere = any("<pipe:" in line or fault.where not in line for line in hit)
        if hit and not elsewhere:
            # What cannot be said is not.
            yield from self.wrong(
                ended, 0 if any("write(2<" in line for line in hit) else 1, len(hit)
            )

    def wrong_in(self, size_bytes: int) -> Iterator[str]:
        """The same where no file, nor standard output, can be longer."""
        ended = self.run(("prlimit", f"--fsize={size_bytes}"))
        sizes = [path.stat().st_size for path in (self.out, *self.place.rglob("*"))]
        # Times take a digit more or less: then there was room.
        if ended.status or size_bytes in sizes:
            yield from self.wrong(ended, 1, 2)

    def wrong(self, ended: Ended, least_lines: int, most_lines: int) -> Iterator[str]:
        killed = ended.status in KILLED
        for name, content in files_below(self.place).items():
            if content == self.before.get(name) or self.is_good(name, content, killed):
                continue
            if not (name.endswith(".part") and killed):
                yield f"leaves {name}, {len(content)} bytes"
        if killed:
            return
        if ended.status not in (run_arguments.FAILED, run_arguments.BAD_INPUT):
            yield f"exit status {ended.status}"
        lines = [line for line in ended.said.splitlines() if ": note: " not in line]
        if not least_lines <= len(lines) <= most_lines:
            yield f"says {len(lines)} lines: {' / '.join(lines)[:200]}"

    def is_good(self, name: str, content: bytes, killed: bool) -> bool:
        good = self.good.get(name)
        if content == good:
            return True
        timed = pathlib.Path(name).suffix in TIMED
        # A checkpoint is gone in the end.
        if good is None and not name.endswith(".checkpoint"):
            return False
        return timed and whole(name, content, good or b"", killed)


def chosen(count: int, most: int) -> list[int]:
    """1 to `count`, or `most` of them at equal distances; 0: all."""
    if most == 0 or count <= most:
        return list(range(1, count + 1))
    return sorted({1 + i * (count - 1) // max(most - 1, 1) for i in range(most)})


def tried(
    name: str, work: Work, programs: dict[str, Sequence[str]], most: int, say: Callable[[str], None]
) -> list[tuple]:
    """Rows of the table. Raises Failure where no call was tampered with."""
    rows = []

    def series(fault: str, whose: str, numbers: list[int], wrong: Callable) -> None:
        found = 0
        for number in numbers:
            for what in wrong(number):
                found += 1
                say(f"{name}: {fault}, {whose}, {number}: {what}")
        if numbers:
            rows.append((name, fault, whose, len(numbers), found))

    with tempfile.TemporaryDirectory(prefix="sgs-write-faults-") as folder:
        bench = Bench(work, programs, pathlib.Path(folder) / "bench")
        for fault in FAULTS:
            for whose, follow in WHOSE.items():
                numbers = chosen(bench.most_calls(fault, follow), most)
                series(fault.name, whose, numbers, functools.partial(bench.wrong_at, fault, follow))
        if not rows:
            raise Failure(f"{name}: no trial: strace saw no write")
        sizes = [number - 1 for number in chosen(bench.most_bytes, most or SIZES)]
        series(FULL, "all it starts", sizes, bench.wrong_in)
    return rows


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_at_least("--most", arguments.most, 0)
    unknown = [name for name in arguments.works if name not in WORKS]
    if unknown:
        raise ValueError(f"'{unknown[0]}': no such job, expected of: {JOBS}")
    if shutil.which("strace") is None:
        raise ValueError("strace: not there, expected Debian's package of that name")
    programs = {SG: [str(arguments.streaminggs.resolve())]}
    rows: list[tuple] = []
    for name in arguments.works or WORKS:
        rows += tried(
            name, WORKS[name], programs, arguments.most, lambda line: print(line, file=sys.stderr)
        )
    by = tables.made(arguments.streaminggs, ())
    tables.write(arguments.out, "write_faults", by, COLUMNS, rows)
    if any(row[-1] for row in rows):
        raise Failure(f"{sum(row[-1] for row in rows)} found")


def main() -> int:
    parser = run_arguments.Parser(__doc__)
    parser.add_argument("works", nargs="*", metavar="JOB", help=f"of: {JOBS}")
    parser.add_argument(
        "--most", type=int, default=0, help="trials of a fault; 0: one for every call"
    )
    parser.add_argument(
        "--streaminggs", type=pathlib.Path, default=BINARY, metavar="PROGRAM",
        help="the command",
    )  # fmt: skip
    parser.add_argument(
        "--out", type=pathlib.Path, default=REPOSITORY / "out", metavar="FOLDER",
        help="for tables",
    )  # fmt: skip
    return run_arguments.main_of_tables(make, parser.parse_args())


if __name__ == "__main__":
    sys.exit(main())
