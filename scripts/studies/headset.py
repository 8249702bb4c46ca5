"""Study of what a headset asks of machines: frames back to back, a second eye, a display's rate."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import functools
import itertools
import json
import pathlib
import statistics
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import IO

import tables
from exploring.judging import SMALL
from runs import run_arguments
from runs.keeper import Keeper
from runs.scenes import REFUSED, Failure, Scene, answered, call, find_scenes, said
from runs.simulations import FIT_MEMORIES, MB, MJ, Run, check_memory_known, read_config
from studies import headset_published
from studies.headset_published import Setting
from tables import SCENE, SIZE, Column, Study

SCENES = ("truck", "playbot", "yard", "park", "platform", "garden")
HEADSET_SIZES = ("640x360", "2064x2208")
RATES = (60, 90, 120)
TILE_PX = 16

OTHERS = "gscore_lossless_boxes"
OURS = ("exact", "exact_fast")  # the second has about the others' area
LEAST_ENTRIES = 1024  # of a list on chip: shorter ones split the lists of large frames


@dataclasses.dataclass(frozen=True)
class Way:
    """How the frames of a path are drawn. rate: of the display; 0: as fast as it goes."""

    name: str
    eyes: int
    stream: bool
    rate: int = 0


ALONE, BACK_TO_BACK = Way("alone", 1, False), Way("back to back", 1, True)
PAIRS, PAIRS_BACK_TO_BACK = Way("two eyes", 2, False), Way("two eyes, back to back", 2, True)
WAYS = (ALONE, BACK_TO_BACK, PAIRS, PAIRS_BACK_TO_BACK)


def at_rate(rate: int) -> Way:
    return Way(f"two eyes at {rate}", 2, True, rate)


@functools.cache
def entries_of(binary: pathlib.Path, machine: str, size: str) -> int:
    """Of a list on chip: as many as the preset chooses for a frame of one eye, or LEAST_ENTRIES.
    Raises ValueError, Failure."""
    run = Run(SMALL, size=size, config=machine, fit_memories=True)
    return max(read_config(binary, run)["sorting"]["list_entries"], LEAST_ENTRIES)


def settings_of(binary: pathlib.Path, machine: str, size: str, way: Way) -> tuple[str, ...]:
    """A machine at its best. GSCore's has room for the lists of all tiles: of a frame that takes
    several passes each reads the scene again. In a stream it projects the next frame ahead. Raises
    ValueError, Failure."""
    if not machine.startswith("gscore"):
        return ()
    width, height = (-(-int(side) // TILE_PX) for side in size.split("x"))
    tiles = way.eyes * width * height
    lists = (f"lists.tiles={tiles}", f"lists.lines={-(-tiles // 2)}")
    entries = f"sorting.list_entries={entries_of(binary, machine, size)}"
    ahead = ("lists.sets=2",) if way.stream else ()
    return (*ahead, "sram.buffer_bytes=0", *lists, entries)


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One call of the command: the frames of a path, which is that of the scene's cameras."""

    scene: Scene
    size: str
    channels: int
    machine: str
    settings: tuple[str, ...]
    way: Way
    frames: int
    apart: float

    def words(self) -> list[str]:
        path = self.scene.cameras or "builtin:path"
        words = [self.scene.spec, "--path", path, "--frames", str(self.frames)]
        words += ["--size", self.size, "--config", self.machine, FIT_MEMORIES]
        words += [a for s in (*self.settings, f"dram.channels={self.channels}") for a in ("--set", s)]
        if self.way.eyes > 1:
            words += ["--stereo", f"ipd={self.apart}"]
        if self.way.stream:
            words += ["--stream", "--frame-rate", str(self.way.rate)]
        return words

    def label(self) -> str:
        parts = (self.scene.name, self.size, self.machine, f"{self.channels} ch", self.way.name)
        return " ".join(parts)


# Of a view's report, or that of a whole stream: what no number here depends on is long.
KEPT = ("frame", "image", "dram", "energy", "area_mm2", "provenance")


def shortened(report: dict) -> dict:
    def short(view: dict) -> dict:
        return {key: view[key] for key in KEPT if key in view}

    if stream := report.get("stream"):
        return {"stream": {**stream, "all": short(stream["all"])}}
    return {"views": [short(view) for view in report["views"]]}


def drawn_all(arguments: argparse.Namespace, of: Sequence[Drawn]) -> dict[Drawn, dict]:
    """The report of each, kept. Raises ValueError for what is refused, Failure."""
    keeper = Keeper(arguments.streaminggs, arguments.kept / "headset")

    def report(drawn: Drawn) -> dict:
        def make(_: pathlib.Path, __: IO) -> dict:
            with tempfile.TemporaryDirectory(prefix="streaminggs-") as out:
                done = call(arguments.streaminggs, [*drawn.words(), "--out", out])
                if done.returncode == REFUSED:
                    raise ValueError(f"{drawn.label()}: {said(done)}")
                if done.returncode != 0:
                    raise Failure(f"{drawn.label()}: {said(done)}")
                print(drawn.label(), file=sys.stderr, flush=True)
                return shortened(json.loads(pathlib.Path(out, "report.json").read_text()))

        return keeper.kept(drawn.label(), drawn.words(), make)[1]

    each = list(dict.fromkeys(of))
    with concurrent.futures.ThreadPoolExecutor(arguments.side_by_side) as pool:
        waiting = [pool.submit(report, drawn) for drawn in each]
        try:
            return dict(zip(each, (done.result() for done in waiting)))
        finally:
            keeper.stopping = True
            pool.shutdown(cancel_futures=True)


@dataclasses.dataclass(frozen=True)
class Taken:
    """By a frame of one eye or two, mean over the path behind its first frame, which in a stream has
    no other before it; but for a stream's bytes and joules, which its report has of all frames."""

    seconds: float
    bytes: float
    joules: float
    mm2: float
    peak_gb_s: float

    def row(self) -> tuple:
        return (1 / self.seconds, self.seconds * 1e3, self.bytes / MB, self.joules / MJ, self.mm2)


def taken(report: dict) -> Taken:
    if stream := report.get("stream"):
        flow, all_frames = stream["flow"], stream["all"]
        check_memory_known(all_frames)
        return Taken(
            1 / stream["frames_per_s"],
            flow["bytes"] / flow["frames"],
            flow["energy"]["total_j"] / flow["frames"],
            all_frames["area_mm2"]["total"],
            all_frames["dram"]["peak_gb_s"],
        )
    views = report["views"]
    for view in views:
        check_memory_known(view)
    return Taken(
        statistics.fmean(view["frame"]["time_s"] for view in views[1:]),
        statistics.fmean(view["dram"]["bytes"] for view in views[1:]),
        statistics.fmean(view["energy"]["total_j"] for view in views[1:]),
        max(view["area_mm2"]["total"] for view in views),
        views[0]["dram"]["peak_gb_s"],
    )


CASE = (
    SCENE,
    SIZE,
    Column("GB/s", "peak of the DRAM", "GB/s", ".1f"),
    Column("machine", "preset"),
)
RATE_COLUMNS = (
    *CASE,
    Column("frames", "each alone, or the next begins while this one is drawn; of one eye or two"),
    Column("frames/s", "of one eye or of two, mean over the path but its first", "1/s", ".1f"),
    Column("ms", "of a frame, likewise", "ms", ".3f"),
    Column("MB", "requested of the DRAM for a frame", "MB", ".2f"),
    Column("mJ", "of a frame", "mJ", ".3f"),
    Column("mm2", "area, with what two frames or two eyes take", "mm2", ".2f"),
)
SECOND_EYE_COLUMNS = (
    *CASE,
    Column("bytes", "that the second eye adds, over those of one eye", "", ".2f"),
    Column("cycles", "likewise, frames alone", "", ".2f"),
    Column("joules", "likewise, frames alone", "", ".2f"),
    Column("cycles, back to back", "likewise", "", ".2f"),
    Column("joules, back to back", "likewise", "", ".2f"),
    Column("area", "likewise", "", ".2f"),
)
RATIO_COLUMNS = (
    SIZE,
    CASE[2],
    Column("machine", f"preset, over {OTHERS}"),
    Column("frames", "as in the table of rates"),
    Column("speed-up", "geometric mean over the scenes", "", ".2f"),
    Column("speed-up of a scene, least", "of the scenes", "", ".2f"),
    Column("speed-up of a scene, most", "likewise", "", ".2f"),
    Column("energy gain", f"joules of {OTHERS} over the machine's, likewise", "", ".2f"),
    Column("energy gain of a scene, least", "of the scenes", "", ".2f"),
    Column("energy gain of a scene, most", "likewise", "", ".2f"),
    Column("area ratio", "machine over the other", "", ".2f"),
    Column("mm2", "of the machine, the largest of the scenes", "mm2", ".2f"),
    Column("its mm2", "of the other, likewise", "mm2", ".2f"),
)
STATES = ("active", "precharged", "power_down", "self_refresh")
POWER_COLUMNS = (
    *CASE,
    Column("rate", "pictures of two eyes a second that the display shows", "1/s", "d"),
    Column("missed", "frames that miss their picture, of the path", "", "d"),
    Column("W", "while frames come at this rate, memory included", "W", ".3f"),
    Column("W, least", "all sources at their low end", "W", ".3f"),
    Column("W, most", "all sources at their high end", "W", ".3f"),
    Column("memory W", "of it", "W", ".3f"),
    *(
        column
        for state in STATES
        for column in (
            Column(f"{state}, time", "share, mean over the memory's ranks", "", ".1%"),
            Column(f"{state}, W", "of the memory, above commands", "W", ".4f"),
        )
    ),
    Column("commands, W", "of the memory: what is above its states", "W", ".4f"),
    Column("latency ms", "motion to photon, poses sent with pictures, median", "ms", ".2f"),
    Column("latency ms, worst", "the same", "ms", ".2f"),
    Column("late latched ms", "the pose of the moment when the frame begins, median", "ms", ".2f"),
    Column("late latched ms, worst", "the same", "ms", ".2f"),
    Column(
        "can begin later ms", "least wait for a picture: poses may be so much later", "ms", ".2f"
    ),
)


@dataclasses.dataclass(frozen=True)
class Case:
    scene: Scene
    size: str
    channels: int
    machine: str

    def drawn(self, way: Way, arguments: argparse.Namespace) -> Drawn:
        """Raises ValueError, Failure."""
        settings = settings_of(arguments.streaminggs, self.machine, self.size, way)
        case = (self.scene, self.size, self.channels, self.machine, settings)
        return Drawn(*case, way, arguments.frames, arguments.ipd)

    def cells(self, peak_gb_s: float) -> tuple:
        return (self.scene.name, self.size, peak_gb_s, self.machine)


ByWay = Mapping[Way, Taken]


def second_eye_row(case: Case, of: ByWay) -> tuple:
    def more(value: Callable[[Taken], float], two: Way, one: Way) -> float:
        return value(of[two]) / value(of[one]) - 1

    return (
        *case.cells(of[ALONE].peak_gb_s),
        more(lambda t: t.bytes, PAIRS, ALONE),
        more(lambda t: t.seconds, PAIRS, ALONE),
        more(lambda t: t.joules, PAIRS, ALONE),
        more(lambda t: t.seconds, PAIRS_BACK_TO_BACK, BACK_TO_BACK),
        more(lambda t: t.joules, PAIRS_BACK_TO_BACK, BACK_TO_BACK),
        more(lambda t: t.mm2, PAIRS, ALONE),
    )


def stereo_row(cases: Sequence[Case], of: Mapping[Case, ByWay]) -> tuple:
    """cases: a machine's, of all scenes."""

    def gain(two: Way, one: Way) -> float:
        pairs = [(of[case][two], of[case][one]) for case in cases]
        return statistics.geometric_mean(2 * b.seconds / a.seconds for a, b in pairs)

    case, more = cases[0], max(of[c][PAIRS].mm2 - of[c][ALONE].mm2 for c in cases)
    place = (case.size, of[case][ALONE].peak_gb_s, case.machine)
    return (*place, gain(PAIRS, ALONE), gain(PAIRS_BACK_TO_BACK, BACK_TO_BACK), more, "")


def ratio_row(size: str, machine: str, way: Way, pairs: Sequence[tuple[Taken, Taken]]) -> tuple:
    """pairs: ours and the other, of a scene each."""

    def ends(value: Callable[[Taken], float]) -> tuple[float, float, float]:
        gains = [value(other) / value(ours) for ours, other in pairs]
        return statistics.geometric_mean(gains), min(gains), max(gains)

    area = statistics.geometric_mean(ours.mm2 / other.mm2 for ours, other in pairs)
    speed, joules = ends(lambda t: t.seconds), ends(lambda t: t.joules)
    mm2 = (max(taken.mm2 for taken in of) for of in zip(*pairs))
    return (size, pairs[0][0].peak_gb_s, machine, way.name, *speed, *joules, area, *mm2)


def beside_rows(setting: Setting, peak_gb_s: float, ours: Mapping[str, Sequence[Taken]]) -> list:
    """ours: by machine, of each scene."""
    case = (setting.eyes, setting.size, peak_gb_s)
    measured = [
        (
            *(*case, machine, statistics.geometric_mean(1 / t.seconds for t in of)),
            *(min(1 / t.seconds for t in of), max(1 / t.seconds for t in of)),
            *(statistics.fmean(t.bytes for t in of) / MB, max(t.mm2 for t in of), ""),
        )
        for machine, of in ours.items()
    ]
    published = [
        (*case, each.machine, each.rate, None, None, each.mb, None, each.differs)
        for each in headset_published.PUBLISHED[setting]
    ]
    return measured + published


def power_row(case: Case, rate: int, report: dict) -> tuple:
    stream = report["stream"]
    flow, memory = stream["flow"], stream["flow"]["memory"]
    check_memory_known(stream["all"])
    time_s = flow["time_s"]
    of_states = [
        cell
        for state in STATES
        for cell in (memory[state]["time_s"] / time_s, memory[state]["energy_j"] / time_s)
    ]
    commands = sum(joules for joules in memory.values() if not isinstance(joules, dict))
    latency, late = stream["latency"], stream["latched_late"]
    milliseconds = (latency["median_s"], latency["worst_s"], late["median_s"], late["worst_s"])
    return (
        *case.cells(stream["all"]["dram"]["peak_gb_s"]),
        *(rate, stream["missed_frames"]),
        *(flow["power_w"][end] for end in ("middle", "low", "high")),
        flow["energy"]["dram_j"] / time_s,
        *of_states,
        commands / time_s,
        *(1e3 * of for of in (*milliseconds, stream["least_wait_s"])),
    )


def add_headset_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, " ".join(SCENES))
    run_arguments.add_side_by_side(to)
    to.add_argument(
        "--sizes",
        nargs="+",
        default=list(HEADSET_SIZES),
        metavar="WxH",
        help="of an eye, in px",
    )
    to.add_argument(
        "--channels",
        nargs="+",
        type=int,
        default=[4, 8],
        metavar="N",
        help="of LPDDR3-1600, 6.4 GB/s each; rates of a display with the first",
    )
    to.add_argument(
        "--rates", nargs="*", type=int, default=list(RATES), metavar="N", help="of a display, 1/s"
    )
    to.add_argument("--frames", type=int, default=4, metavar="N", help="along the scene's cameras")
    to.add_argument("--ipd", type=float, default=0.064, help="of the eyes, in the world's units")


def check_headset(arguments: argparse.Namespace) -> None:
    """Before hours of simulation. Raises ValueError."""
    for option in ("sizes", "channels", "rates"):
        run_arguments.check_once(f"--{option}", getattr(arguments, option))
    for size in arguments.sizes:
        run_arguments.check_size("--sizes", size)
    run_arguments.check_at_least("--frames", arguments.frames, 2)
    run_arguments.check_above_zero("--ipd", arguments.ipd)
    for rate in arguments.rates:
        run_arguments.check_at_least("--rates", rate, 1)
    for channels in arguments.channels:
        words = ["--config", OURS[0], "--set", f"dram.channels={channels}"]
        answered(arguments.streaminggs, "describe", words, OURS[0])


def make_headset(arguments: argparse.Namespace) -> None:
    check_headset(arguments)
    scenes = find_scenes(arguments.scenes or list(SCENES), arguments.cameras)
    machines = (OURS[0], OTHERS)
    # Small pictures first; only these of the machine of alike area.
    of_places = {
        place: machines if n else (*OURS, OTHERS)
        for n, place in enumerate(itertools.product(arguments.sizes, arguments.channels))
    }
    cases = [
        Case(scene, *place, machine)
        for place, drawn in of_places.items()
        for scene in scenes
        for machine in drawn
    ]
    rated = [case for case in cases if case.channels == arguments.channels[0]]
    ways = {case: list(WAYS) for case in cases}
    for case in rated:
        ways[case] += map(at_rate, arguments.rates)
    beside = {
        (setting, machine): [
            Case(scene, setting.size, setting.channels, machine).drawn(
                PAIRS_BACK_TO_BACK if setting.eyes > 1 else BACK_TO_BACK, arguments
            )
            for scene in scenes
        ]
        for setting, machine in itertools.product(headset_published.PUBLISHED, machines)
    }
    asked = [case.drawn(way, arguments) for case, of_case in ways.items() for way in of_case]
    asked += [drawn for of_setting in beside.values() for drawn in of_setting]
    reports = drawn_all(arguments, asked)
    of = {c: {w: taken(reports[c.drawn(w, arguments)]) for w in WAYS} for c in cases}
    provenances = [
        view["provenance"]
        for report in reports.values()
        for view in report.get("views") or [report["stream"]["all"]]
    ]
    by = tables.made(arguments.streaminggs, provenances, scenes)
    about = (
        f"{arguments.frames} frames along the cameras of each scene, eyes {arguments.ipd:g} apart; "
        f"{OTHERS} with room for the lists of all tiles, in a stream for two sets of them. A frame of "
        "two eyes is two pictures. Areas are not equal: they stand beside."
    )
    rows = [
        (*case.cells(t.peak_gb_s), way.name, *t.row())
        for case, by_way in of.items()
        for way, t in by_way.items()
    ]
    tables.write(arguments.out, "headset_rates", by, RATE_COLUMNS, rows, about)
    rows = [second_eye_row(*case) for case in of.items()]
    tables.write(arguments.out, "headset_second_eye", by, SECOND_EYE_COLUMNS, rows, about)
    rows = [
        ratio_row(
            place[0],
            machine,
            way,
            [
                tuple(of[Case(scene, *place, each)][way] for each in (machine, OTHERS))
                for scene in scenes
            ],
        )
        for place, drawn in of_places.items()
        for machine in drawn
        if machine != OTHERS
        for way in WAYS
    ]
    tables.write(arguments.out, "headset_ratios", by, RATIO_COLUMNS, rows, about)
    rows = []
    for setting in headset_published.PUBLISHED:
        ours = {m: [taken(reports[drawn]) for drawn in beside[setting, m]] for m in machines}
        rows += beside_rows(setting, ours[OTHERS][0].peak_gb_s, ours)
    tables.write(arguments.out, "headset_published", by, headset_published.COLUMNS, rows, about)
    rows = [
        stereo_row([Case(scene, *place, machine) for scene in scenes], of)
        for place, drawn in of_places.items()
        for machine in drawn
    ]
    rows.append(headset_published.STEREO)
    columns = headset_published.STEREO_COLUMNS
    tables.write(arguments.out, "headset_stereo", by, columns, rows, about)
    rows = [
        power_row(case, rate, reports[case.drawn(at_rate(rate), arguments)])
        for case in rated
        for rate in arguments.rates
    ]
    about += " Numbers are those between the pictures of the first frame and of the last one."
    tables.write(arguments.out, "headset_power", by, POWER_COLUMNS, rows, about)


HEADSET = Study(
    "headset",
    f"""What a headset asks of {OURS[0]} and {OTHERS}: frames of a path alone and back to back, of one eye and
of two, by size and bandwidth; two eyes at the rates of a display. {OURS[1]}, which has about the
same area, is drawn at the first size and bandwidth. Makes

  headset_rates       frames a second, bytes, joules and area of a frame each way
  headset_second_eye  what the second eye adds to the first: bytes, cycles, joules, area
  headset_ratios      speed, energy and area over {OTHERS} each way, over the scenes
  headset_published   rates back to back beside those of Nebula and Neo, and what differs
  headset_stereo      two eyes over two frames of one eye, beside Nebula's on GSCore
  headset_power       watts by state of the memory, latency, at rates of a display

Each machine is at its best, with all of it charged: GSCore's has room for the lists of all tiles of
both eyes, and in a stream projects a frame while the one before it is drawn.
""",
    ("results.py headset",),
    add_headset_arguments,
    make_headset,
)
