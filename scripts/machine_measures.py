"""What a machine takes for the views of a case (a scene at a size, with a memory), read off their
reports: means over the views, and what ranges need of each view."""

from __future__ import annotations

import dataclasses
import statistics
from collections.abc import Callable, Mapping, Sequence

from energy_components import components, joules
from runs.simulations import Outcome
from runs.view_numbers import binders, decibels

GPU = "GPU, modelled"
PIXELS = ("frame_buffer",)
# What a machine writes and reads again within a frame.
INTERMEDIATE = ("projected", "tile_lists", "subsets", "spill")
# Regions of the GPU's bytes are kinds.
GPU_KINDS = {"scene": "scene", "intermediate": "intermediate", "frame": "pixels"}
MJ = 1e-3

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


def kind_of(region: str) -> str:
    if region in GPU_KINDS.values():
        return region
    if region in PIXELS:
        return "pixels"
    return "intermediate" if region in INTERMEDIATE else "scene"


def mean(views: Views, value: Callable[[dict], float]) -> float:
    return statistics.fmean(value(view) for view in views)


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
    parts = {name: joules(view, keys) for name, keys in components(view).items()}
    del parts["all"]
    return parts


def simulated(views: Views) -> Measured:
    """Of one machine with one memory."""
    return Measured(
        seconds=tuple(v["frame"]["time_s"] for v in views),
        busiest_seconds=tuple(map(busiest_seconds, views)),
        joules=tuple(v["energy"]["total_j"] for v in views),
        bytes_by_region=mean_by_name([v["dram"]["bus_bytes_by_region"] for v in views]),
        joules_by_component=mean_by_name([component_joules(v) for v in views]),
        busy=mean_by_name([busy_shares(v) for v in views]),
        peak_gb_s=views[0]["dram"]["peak_gb_s"],
        precision=views[0]["config"]["rendering"]["precision"],
        encoding=views[0]["config"]["storage"]["encoding"],
        mm2=max(v["area_mm2"]["total"] for v in views),
        decibels=tuple(map(decibels, views)),
        binds=binders(views),
    )


def modelled(outcome: Outcome) -> Measured:
    """Raises ValueError when the run was refused, Failure when it failed."""
    views = outcome.accepted()
    kinds = {
        name: mean(views, lambda v, key=f"{kind}_bytes": sum(s[key] for s in v["stages"]))
        for kind, name in GPU_KINDS.items()
    }
    total = mean(views, lambda v: v["joules"])
    return Measured(
        seconds=tuple(v["seconds"] for v in views),
        busiest_seconds=tuple(map(busiest_of_kernels, views)),
        joules=tuple(v["joules"] for v in views),
        bytes_by_region=kinds,
        joules_by_component={"module and memory": total},
        busy=mean_by_name(
            [{s["name"]: s["seconds"] / v["seconds"] for s in v["stages"]} for v in views]
        ),
        peak_gb_s=views[0]["peak_gb_s"],
        precision="fp32",
    )
