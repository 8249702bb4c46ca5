"""A copy of the project's sources in which faults are planted, its build, and its tests."""

from __future__ import annotations

import concurrent.futures
import contextlib
import fcntl
import hashlib
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import threading
from collections.abc import Iterator

import covering_tests
from covering_tests import Target, Test
from fault_kinds import Fault

PRESET = "release"
# A fault may take all there is; more than this no test needs.
MOST_MEMORY_BYTES = 4 << 30
MOST_FILE_BYTES = 1 << 30


class DoesNotCompile(Exception):
    pass


class DoesNotBuild(Exception):
    """What is compiled does not link, or does not run when its tests are listed; names the step."""


def limit() -> None:
    for what, most in (
        (resource.RLIMIT_AS, MOST_MEMORY_BYTES),
        (resource.RLIMIT_FSIZE, MOST_FILE_BYTES),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(what)[1]
        resource.setrlimit(what, (most if hard < 0 else min(most, hard), hard))


def digest_of(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


@contextlib.contextmanager
def only_one(work: pathlib.Path) -> Iterator[None]:
    """Raises ValueError when another run has its tree in this folder."""
    work.mkdir(parents=True, exist_ok=True)
    with (work / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise ValueError(f"--work: {work}: another run plants faults there") from error
        yield


class FaultTree:
    """files: tracked ones, as they stand in the project. patience: seconds that a test may take.
    Raises ValueError where there is nothing to copy."""

    def __init__(self, project: pathlib.Path, work: pathlib.Path, jobs: int, patience: float):
        self.project, self.jobs, self.patience = project.resolve(), jobs, patience
        self.folder = work.resolve() / "tree"
        self.build = self.folder / "build" / PRESET
        self.files = self.copied()
        self.digests = {name: digest_of((self.folder / name).read_bytes()) for name in self.files}
        self.digest = digest_of("".join(self.digests.values()).encode())
        self.environment = {
            **os.environ,
            "GIT_CEILING_DIRECTORIES": str(self.folder.parent),  # a commit is no part of a program
            "CCACHE_BASEDIR": str(self.folder),
            "CCACHE_NOHASHDIR": "1",
            "SGS_SHARED": os.environ.get("SGS_SHARED", str(self.project.parent / "shared")),
        }
        if shutil.which("ccache"):
            self.environment["CMAKE_CXX_COMPILER_LAUNCHER"] = "ccache"
        self.without_fault: dict[str, str] = {}  # by name of a target, its programs' digest
        self.sound: dict[str, bool] = {}  # by name of a test, whether it passes without a fault
        self.original = ""  # of the file with a fault; empty: there is none
        self.configure()

    def copied(self) -> list[str]:
        """Makes the copy what the project is; a file that is the same keeps its time."""
        asked = subprocess.run(
            ["git", "-C", str(self.project), "ls-files", "-z"], capture_output=True, text=True
        )
        if asked.returncode:
            raise ValueError(f"--project: {self.project}: expected a folder under git")
        files = {f for f in asked.stdout.split("\0") if (self.project / f).is_file()}
        for name in files:
            self.copy(name)
        for folder, folders, names in os.walk(self.folder):
            if folder == str(self.folder) and "build" in folders:
                folders.remove("build")
            for name in names:
                path = pathlib.Path(folder, name)
                if str(path.relative_to(self.folder)) not in files:
                    path.unlink()
        return sorted(files)

    def copy(self, name: str) -> None:
        source, copy = self.project / name, self.folder / name
        if copy.is_file() and copy.read_bytes() == source.read_bytes():
            return
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(source.read_bytes())
        copy.chmod(source.stat().st_mode)

    def commit(self) -> str:
        command = ["git", "-C", str(self.project), "describe", "--always", "--dirty"]
        return subprocess.run(command, capture_output=True, text=True).stdout.strip()

    def configure(self) -> None:
        covering_tests.ask(self.build)
        done = subprocess.run(
            ["cmake", "--preset", PRESET],
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
        )
        if done.returncode:
            raise ValueError(f"--project: {self.project}: {done.stderr.strip()[-500:]}")

    def executables(self) -> list[Target]:
        """Those that are tests."""
        return covering_tests.tested(self.build, covering_tests.executables(self.build).values())

    def plant(self, fault: Fault) -> None:
        path = self.folder / fault.path
        self.original = path.read_text()
        lines = self.original.splitlines(keepends=True)
        at = fault.line - 1
        if lines[at].rstrip("\n") != fault.before:
            raise ValueError(f"{path}: line {fault.line} is not what the fault is planted in")
        lines[at] = fault.after + "\n"
        path.write_text("".join(lines))

    def restore(self, fault: Fault) -> None:
        (self.folder / fault.path).write_text(self.original)
        self.original = ""

    def programs_of(self, target: Target) -> str:
        """Builds it; the digest of what it is and what it runs."""
        if not self.original and target.name in self.without_fault:
            return self.without_fault[target.name]
        self.built(target)
        digest = hashlib.sha256()
        for name in target.programs:
            digest.update((self.build / name).read_bytes())
        if not self.original:
            self.without_fault[target.name] = digest.hexdigest()
        return digest.hexdigest()

    def built(self, target: Target) -> None:
        command = ["cmake", "--build", "--preset", PRESET, "--target", target.name]
        building = subprocess.Popen(
            [*command, "-j", str(self.jobs)],
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            said, _ = building.communicate()
        except BaseException:  # interrupted: the compilers are to end as well
            os.killpg(building.pid, signal.SIGKILL)
            raise
        if building.returncode == 0:
            return
        failed = [line for line in said.splitlines() if line.startswith("FAILED: ")]
        step = failed[0].split()[1] if failed else said.strip()[-200:]
        if not self.original:
            raise ValueError(f"{target.name} does not build without a fault: {step}")
        raise (DoesNotCompile if step.endswith(".o") else DoesNotBuild)(step)

    def tests_of(self, target: Target) -> list[Test]:
        """Of the normal suite, those that run it and pass without a fault."""
        own = str(self.build / target.program)
        return [
            test
            for test in covering_tests.tests(self.build)
            if test.command[0] == own and self.sound.get(test.name, True)
        ]

    def first_failure(self, target: Target) -> tuple[Test | None, int]:
        """The test that fails, and how many had passed."""
        return self.first_failing(self.tests_of(target))

    def first_failing(self, tests: list[Test]) -> tuple[Test | None, int]:
        stop = threading.Event()
        passed = 0
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            waiting = {pool.submit(self.passes, test, stop): test for test in tests}
            try:
                for done in concurrent.futures.as_completed(waiting):
                    if not done.result():
                        return waiting[done], passed
                    passed += 1
            finally:  # also of what is interrupted no test goes on
                stop.set()
                pool.shutdown(cancel_futures=True)
        return None, passed

    def passes_without(self, test: Test, target: Target) -> bool:
        if test.name not in self.sound:
            self.without_fault.pop(target.name, None)
            self.programs_of(target)
            self.sound[test.name] = self.passes(test, threading.Event())
        return self.sound[test.name]

    def passes(self, test: Test, stop: threading.Event) -> bool:
        """As ctest judges it. Ended as soon as it is asked to stop."""
        process = subprocess.Popen(
            test.command,
            cwd=test.folder or self.build,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            errors="replace",
            start_new_session=True,
            preexec_fn=limit,
        )
        ended = threading.Event()

        def watch() -> None:
            waited = 0.0
            while waited < self.patience and not stop.is_set():
                if ended.wait(0.2):
                    return
                waited += 0.2
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)

        watcher = threading.Thread(target=watch)
        watcher.start()
        said, _ = process.communicate()
        ended.set()
        watcher.join()
        if process.returncode == test.skip_status:
            return True
        return process.returncode == 0 and not (test.fails_on and test.fails_on.search(said))
