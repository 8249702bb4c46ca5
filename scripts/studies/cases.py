"""What machines are held against each other on: scenes at sizes, with memories; what each takes for
the views of such a case, read off their reports: means over the views, and what ranges need of each
view; and the original rasteriser on a mobile GPU, as `streaminggs gpu` models it."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import itertools
import json
import pathlib
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import IO

from runs import run_arguments
from runs.keeper import Keeper
from runs.scenes import (
    BUILT_IN,
    Scene,
    answered,
    find_scenes,
    shared_names,
    view_numbers_there,
)
from runs.simulations import Run, binders, decibels, joules, mean, mm2

OBJECTS = ("truck", "playbot", "builtin:object")  # whatever their parameters
SIZES, OBJECT_SIZES = ("640x360", "980x545"), ("640x360", "800x800")


@dataclasses.dataclass(frozen=True)
class Case:
    scene: Scene
    size: str

    def cells(self) -> tuple[str, str]:
        return self.scene.name, self.size


def shows_object(name: str) -> bool:
    return any(name == text or name.startswith(f"{text}?") for text in OBJECTS)


def sizes_of(name: str, arguments: argparse.Namespace) -> list[str]:
    if shows_object(name):
        return arguments.object_sizes or OBJECT_SIZES
    return arguments.sizes or SIZES


def check_sizes(arguments: argparse.Namespace, scenes: Sequence[Scene]) -> None:
    """Raises ValueError for what is no size or there twice, and where only the sizes of other
    scenes are given."""
    given = {"--sizes": arguments.sizes, "--object-sizes": arguments.object_sizes}
    for option, sizes in given.items():
        run_arguments.check_once(option, sizes or ())
        for size in sizes or ():
            run_arguments.check_size(option, size)
    asked = {option for option, sizes in given.items() if sizes}
    used = {"--object-sizes" if shows_object(scene.name) else "--sizes" for scene in scenes}
    if asked and not asked & used:
        names = ", ".join(scene.name for scene in scenes)
        objects = ", ".join(OBJECTS)
        raise ValueError(
            f"{asked.pop()}: got only this, expected {used.pop()} for {names} (objects: {objects})"
        )


def check_machines(arguments: argparse.Namespace) -> None:
    """Before hours of simulation. Raises ValueError for what the program refuses to be told of, and
    for what would count twice."""
    run_arguments.check_once("--machines", arguments.machines)
    check_channels(arguments, arguments.machines)


def check_channels(arguments: argparse.Namespace, machines: Sequence[str]) -> None:
    """The same of --channels with each of the machines."""
    run_arguments.check_once("--channels", arguments.channels)
    for machine, channels in itertools.product(machines, arguments.channels):
        words = ["--config", machine, "--set", f"dram.channels={channels}"]
        answered(arguments.streaminggs, "describe", words, machine)


def find_cases(arguments: argparse.Namespace) -> list[Case]:
    """Raises ValueError for what is no scene, size, machine or view, or there twice."""
    scenes = find_scenes(arguments.scenes or shared_names() or BUILT_IN, arguments.cameras)
    check_sizes(arguments, scenes)
    check_machines(arguments)
    for scene in scenes:
        view_numbers_there(arguments.streaminggs, scene, arguments.view)
    return [Case(scene, size) for scene in scenes for size in sizes_of(scene.name, arguments)]


def add_arguments(to: run_arguments.Parser, machines: Sequence[str], channels: list[int]) -> None:
    """Of cases and of the machines that draw them."""
    run_arguments.add_scenes(
        to, f"all real ones, or {', '.join(BUILT_IN)}, each at the sizes of its kind"
    )
    to.add_argument("--sizes", nargs="+", metavar="WxH", help=f"in px; default: {' '.join(SIZES)}")
    to.add_argument(
        "--object-sizes",
        nargs="+",
        metavar="WxH",
        help=f"of {', '.join(OBJECTS)}; default: {' '.join(OBJECT_SIZES)}",
    )
    to.add_argument(
        "--channels",
        nargs="+",
        type=int,
        default=channels,
        metavar="N",
        help="of LPDDR3-1600, 6.4 GB/s each",
    )
    to.add_argument(
        "--machines", nargs="+", default=list(machines), metavar="PRESET", help="to compare"
    )


GPU = "GPU, modelled"
PIXELS = ("frame_buffer",)
# What a machine writes and reads again within a frame.
INTERMEDIATE = ("projected", "tile_lists", "subsets", "spill")
# Regions of the GPU's bytes are kinds.
GPU_KINDS = {"scene": "scene", "intermediate": "intermediate", "frame": "pixels"}
KINDS = ("scene", "intermediate", "pixels")

Views = Sequence[dict]


@dataclasses.dataclass(frozen=True)
class Measured:
    """Bytes: on the bus; of the GPU those that its kernels ask for. busiest_seconds: of each view,
    how long the busiest resource works, which no overlapping of frames makes less. decibels: of
    the views, against the reference picture; none of the GPU. encoding: of the scene. busy: share
    of the frame that a resource works, mean of those that are alike."""

    seconds: tuple[float, ...]
    busiest_seconds: tuple[float, ...]
    joules: tuple[float, ...]
    bytes_by_region: Mapping[str, float]
    joules_by_component: Mapping[str, float]
    busy: Mapping[str, float]
    peak_gb_s: float
    precision: str
    encoding: str = "raw"
    mm2: float | None = None
    decibels: tuple[float, ...] = ()
    binds: str = ""

    def bytes(self, kind: str = "") -> float:
        """All, or those of a kind: scene, intermediate, pixels."""
        return sum(n for name, n in self.bytes_by_region.items() if kind in ("", kind_of(name)))

    def mean_joules(self) -> float:
        return statistics.fmean(self.joules)

    def frames_a_second(self) -> float:
        """Each alone: the next one begins when the one before is done."""
        return 1 / statistics.fmean(self.seconds)

    def most_frames_a_second(self) -> float:
        """A bound on what any overlapping of frames could give."""
        return 1 / statistics.fmean(self.busiest_seconds)

    def draws(self) -> str:
        """In which precision, and from codebooks or records as they are."""
        return f"{self.precision} from codebooks" if "vq" in self.encoding else self.precision


@dataclasses.dataclass(frozen=True)
class Entry:
    """What a machine took for a case with a memory. The GPU has its own one."""

    case: Case
    machine: str
    of: Measured

    @property
    def memory(self) -> float:
        return round(self.of.peak_gb_s, 1)


def kind_of(region: str) -> str:
    if region in GPU_KINDS.values():
        return region
    if region in PIXELS:
        return "pixels"
    return "intermediate" if region in INTERMEDIATE else "scene"


def mean_by_name(each: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Of all names that there are; 0 where a view has none."""
    names = dict.fromkeys(name for of in each for name in of)
    return {name: statistics.fmean(of.get(name, 0) for of in each) for name in names}


def busy_shares(view: dict) -> dict[str, float]:
    """Of each resource, and of the memory's bandwidth."""
    cycles: dict[str, list[int]] = {}
    for unit in view["units"].values():
        for activity in unit["activities"].values():
            cycles.setdefault(activity["resource"], []).append(activity["busy_cycles"])
    frame = view["frame"]["cycles"]
    shares = {name: statistics.fmean(of) / frame for name, of in cycles.items()}
    return {**shares, "DRAM, of its peak bandwidth": view["dram"]["of_peak"]}


def busiest_seconds(view: dict) -> float:
    """Of all resources and the memory's data bus, as the report's `binding` has it."""
    return view["frame"]["time_s"] * view["binding"]["utilisation"]


def busiest_of_kernels(view: dict) -> float:
    """A kernel takes as long as it issues or moves bytes, whichever is longer: so each of the two
    works at least the sum over the kernels that it binds."""
    by_bound: dict[str, float] = {}
    for stage in view["stages"]:
        by_bound[stage["bound_by"]] = by_bound.get(stage["bound_by"], 0) + stage["seconds"]
    return max(by_bound.values())


def component_joules(view: dict) -> dict[str, float]:
    parts = {name: joules_of(view, keys) for name, keys in components(view).items()}
    del parts["all"]
    return parts


def simulated(views: Views) -> Measured:
    """Of one machine with one memory."""
    return Measured(
        seconds=tuple(v["frame"]["time_s"] for v in views),
        busiest_seconds=tuple(map(busiest_seconds, views)),
        joules=tuple(map(joules, views)),
        bytes_by_region=mean_by_name([v["dram"]["bus_bytes_by_region"] for v in views]),
        joules_by_component=mean_by_name([component_joules(v) for v in views]),
        busy=mean_by_name([busy_shares(v) for v in views]),
        peak_gb_s=views[0]["dram"]["peak_gb_s"],
        precision=views[0]["config"]["rendering"]["precision"],
        encoding=views[0]["config"]["storage"]["encoding"],
        mm2=max(map(mm2, views)),
        decibels=tuple(map(decibels, views)),
        binds=binders(views),
    )


def modelled(views: Views) -> Measured:
    """Of the GPU."""
    kinds = {
        name: mean(views, lambda v, key=f"{kind}_bytes": sum(s[key] for s in v["stages"]))
        for kind, name in GPU_KINDS.items()
    }
    return Measured(
        seconds=tuple(v["seconds"] for v in views),
        busiest_seconds=tuple(map(busiest_of_kernels, views)),
        joules=tuple(v["joules"] for v in views),
        bytes_by_region=kinds,
        joules_by_component={"module and memory": mean(views, lambda v: v["joules"])},
        busy=mean_by_name(
            [{s["name"]: s["seconds"] / v["seconds"] for s in v["stages"]} for v in views]
        ),
        peak_gb_s=views[0]["peak_gb_s"],
        precision="fp32",
    )


# What a run of the model has in the place of a preset.
MODEL = "gpu"


def model_all(arguments: argparse.Namespace, runs: Sequence[Run]) -> list[tuple[dict, ...]]:
    """Of each run the views as the model's report has them, with `peak_gb_s`; kept. Raises
    ValueError for what is refused, Failure."""
    keeper = Keeper(arguments.streaminggs, arguments.kept / "gpu")

    def views(run: Run) -> tuple[dict, ...]:
        words = [run.scene.spec, "--view", run.view]
        words += ["--cameras", run.scene.cameras] if run.scene.cameras else []
        words += ["--size", run.size] if run.size else []

        def make(place: pathlib.Path, _: IO) -> dict:
            report = place / "gpu.json"
            answered(arguments.streaminggs, "gpu", [*words, "--out", str(report)], run.label())
            return json.loads(report.read_text())

        _, made = keeper.kept(run.label(), words, make)
        peak = {"peak_gb_s": made["gpu"]["bandwidth_gb_s"]}
        return tuple(view | peak for view in made["views"])

    with concurrent.futures.ThreadPoolExecutor(arguments.side_by_side) as pool:
        return list(pool.map(views, runs))


# Components of energy that are neither logic nor on-chip memory.
OTHER = {
    "clock": ("clock_j",),
    "leakage": ("logic_leakage_j", "sram_leakage_j"),
    "DRAM": ("dram_j",),
    "all": ("total_j",),
}
MEMORIES = ("SRAM: pixels", "SRAM: all else")


def components(view: dict) -> dict[str, tuple[str, ...]]:
    """Name of a row: the keys of the report's energy that it sums."""
    area = {name: mm2 for name, mm2 in view["area_mm2"].items() if not isinstance(mm2, dict)}
    logic = [name for name in area if name not in ("sram", "total")]
    rows = {name: (f"{name}_j",) for name in logic if f"{name}_j" in view["energy"]}
    elsewhere = {key for keys in [*rows.values(), *OTHER.values()] for key in keys}
    # Numbers, not what is split up once more, such as dram_by_region_j.
    taken = [k for k, of in view["energy"].items() if k.endswith("_j") and not isinstance(of, dict)]
    memories = sorted(key for key in taken if key not in elsewhere)
    pixels = tuple(key for key in memories if key == "pixel_state_j")
    rest = tuple(key for key in memories if key != "pixel_state_j")
    return {**rows, **dict(zip(MEMORIES, (pixels, rest))), **OTHER}


def joules_of(view: dict, keys: Iterable[str]) -> float:
    return sum(view["energy"].get(key, 0) for key in keys)


# By scene, the cases of each: what every machine took.
Found = Mapping[str, Sequence[Mapping[str, Measured]]]
OfViews = Callable[[Measured], Sequence[float]]

ALL_SIZES = "all"  # sizes


def alone(m: Measured) -> Sequence[float]:
    return m.seconds


def overlapped(m: Measured) -> Sequence[float]:
    return m.busiest_seconds


def energy(m: Measured) -> Sequence[float]:
    return m.joules


WAYS = ((alone, alone), (overlapped, overlapped), (alone, overlapped), (energy, energy))


def over_scenes(
    found: Found, own: str, other: str, ours: OfViews, theirs: OfViews
) -> tuple[float, float, float]:
    """Each scene counts once: the geometric mean over its cases of what the means over their views
    are to each other, then that over the scenes. Least and most: of single views."""
    pairs = [[(ours(case[own]), theirs(case[other])) for case in of] for of in found.values()]
    mean = statistics.geometric_mean(
        statistics.geometric_mean(statistics.fmean(b) / statistics.fmean(a) for a, b in of_scene)
        for of_scene in pairs
    )
    single = [b / a for of_scene in pairs for views in of_scene for a, b in zip(*views)]
    return mean, min(single), max(single)


def decibel_ends(cases: Sequence[Mapping[str, Measured]], machine: str) -> tuple:
    """Least and most."""
    values = [value for case in cases for value in case[machine].decibels]
    return (min(values), max(values)) if values else (None, None)


def size_groups(of: Sequence[Case], arguments: argparse.Namespace) -> dict[str, list[Case]]:
    """The cases at the first of --sizes and --object-sizes, those at the second, ...; and all."""
    by_place: dict[int, list[Case]] = {}
    for case in of:
        place = sizes_of(case.scene.name, arguments).index(case.size)
        by_place.setdefault(place, []).append(case)
    named = {
        ", ".join(sorted({case.size for case in some})): some
        for _, some in sorted(by_place.items())
    }
    return {**(named if len(named) > 1 else {}), ALL_SIZES: list(of)}
