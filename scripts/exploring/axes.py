"""What an exploration may choose from: axes of settings, with those of the machine of each order; the
space that they span; or a list of configurations, which is one axis of whole settings."""

from __future__ import annotations

import dataclasses
import itertools
import math
import pathlib
import re
from collections.abc import Iterator, Mapping, Sequence

from runs.files import read_text
from runs.simulations import GROUP, GROUP_KEYS, expanded, group_assignments

Assignments = tuple[str, ...]
# How many there are of what other axes make larger, and what excludes what: a step on another axis
# takes about the same area wherever these are alike.
STRUCTURE = ("hfus", "hfu.cfus", "hfu.ffus", "fetch", "rendering.clusters", "ccus", "cores")
# KEY@SCENE=VALUE holds for one scene, such as how it is stored; KEY@each=... is an axis for each.
EACH = "each"


@dataclasses.dataclass(frozen=True)
class Axis:
    """Settings from little to much hardware, each of them one assignment or several that go
    together."""

    name: str
    settings: tuple[Assignments, ...]

    @property
    def scope(self) -> str:
        """The label of the scene that it is for; empty: all of them."""
        return scope_of(self.name)


def label(scene: str) -> str:
    """Of a scene's name, as it stands in a key: what ends a key is not in it."""
    return scene.replace("=", ":")


def key_of(assignment: str) -> str:
    """As the configuration has it."""
    return assignment.partition("=")[0].partition("@")[0]


def scope_of(assignment: str) -> str:
    """The label of the scene that it is for; empty: all of them."""
    return assignment.partition("=")[0].partition("@")[2]


def scoped(assignment: str, scope: str) -> str:
    key, _, value = assignment.partition("=")
    return f"{key}@{scope}={value}"


def unscoped(assignment: str) -> str:
    return f"{key_of(assignment)}={assignment.partition('=')[2]}"


def sizes_memory(assignments: Assignments) -> bool:
    """But for codebooks', which is none that follows from other keys."""
    memories = [key for key in map(key_of, assignments) if key.startswith("sram.")]
    return any(key != "sram.codebook_bytes" for key in memories)


def of_scene(assignments: Assignments, scope: str) -> Assignments:
    """What holds for a scene, as the command takes it."""
    return tuple(unscoped(a) for a in assignments if scope_of(a) in ("", scope))


def axis(key: str, *values: object) -> Axis:
    return Axis(key, tuple((f"{key}={value}",) for value in values))


@dataclasses.dataclass(frozen=True)
class Order:
    """A preset with the axes of its machine, and what is the same in all of these. blend: the
    datapath that blends, on lanes of the axis blend_lanes."""

    name: str
    preset: str
    fixed: Assignments
    axes: tuple[Axis, ...]
    blend: str = "subtile_blend"
    blend_lanes: str = "rendering.cluster_lanes"

    def with_blend(self, macs: int) -> Order:
        """With as many lanes as blend 4 x 4 pixels in 8, 6, ... 1 cycles; what lies between would
        be idle."""
        lanes = axis(self.blend_lanes, *(-(-macs // n) for n in (8, 6, 4, 3, 2, 1)))
        return dataclasses.replace(
            self, axes=tuple(lanes if a.name == lanes.name else a for a in self.axes)
        )


def with_own(axes: Sequence[Axis], config: Mapping) -> tuple[Axis, ...]:
    """Each axis of numbers also with the configuration's own, so that a search may begin at it. But
    for memories, whose sizes follow from all else."""

    def with_its_own(a: Axis) -> Axis:
        value: object = config
        for part in a.name.split("."):
            value = value.get(part) if isinstance(value, Mapping) else None
        there = [number(s.partition("=")[2]) for setting in a.settings for s in setting]
        single = all(len(setting) == 1 for setting in a.settings) and None not in there
        if isinstance(value, bool) or not isinstance(value, int | float) or not single:
            return a
        if sizes_memory(a.settings[0]) or not value or value in there:
            return a
        rises = there == sorted(there)
        place = sum((of < value) == rises for of in there)
        own = (f"{a.name}={value:g}",)
        return Axis(a.name, (*a.settings[:place], own, *a.settings[place:]))

    return tuple(map(with_its_own, axes))


def number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def distance(assignment: str, config: dict) -> float:
    """0: the configuration has this value; of numbers their ratio, less 1."""
    wanted = assignment.partition("=")[2]
    value: object = config
    for part in key_of(assignment).split("."):
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, str) or number(wanted) is None:
        return 0 if value == wanted else 1000
    a, b = float(value or 0) + 1, number(wanted) + 1
    return max(a, b) / min(a, b) - 1


def nearest(a: Axis, config: dict) -> int:
    distances = [sum(distance(s, config) for s in setting) for setting in a.settings]
    return distances.index(min(distances))


def groups(*shapes: object) -> Axis:
    return Axis(GROUP, tuple(group_assignments(shape) for shape in shapes))


# Beside them shapes that cut a frame of 640 x 360 evenly.
SQUARES = (32, 48, 64, 80, 96, 112, 128)
SHAPES = (*SQUARES, "128x120", "160x120", "216x120", "160x180", "320x180")

COMMON = (
    axis("hfus", 1, 2, 3, 4, 6, 8, 9),
    axis("rendering.clusters", 1, 2, 3, 4, 5, 6, 8),
    axis("rendering.cluster_lanes", 480),
    # As many as give an interval of whole cycles, or several rows at once.
    axis("rendering.begin_lanes", 6, 8, 11, 16, 25, 40, 76),
    axis("rendering.span_lanes", 5, 8, 10, 20, 40, 60),
    axis("hfu.ffu_lanes", 4, 8, 12, 16, 20, 24, 32, 48, 64),
    axis("hfu.cfus", 1, 2, 4),
    axis("hfu.cfu_lanes", 1, 2, 3, 4, 6, 8, 12, 16),
    axis("hfu.second_half_slots", 4, 6, 8, 16, 24, 32, 48),
    axis("hfu.candidate_fifo_entries", 7, 10, 16, 24, 32),
    axis("memory_port.max_outstanding", 4, 8, 16, 32),
    axis("sorting_units", 1, 2, 4),
    axis("rendering.span_slots", 8, 16, 32, 48, 64),
)
# In both orders second halves are raw, since what codebooks cost and gain is a matter of its own,
# and a filter's test takes what was counted on the code that runs it.
ALIKE = ("storage.encoding=raw", "sram.codebook_bytes=0", "hfu.cost=counted")

EXACT = Order(
    "exact",
    "exact",
    ALIKE,
    (
        groups(*SHAPES),
        axis("merge.entries", 128, 256, 512, 768, 1024, 1536, 2048, 3072),
        axis("vsu.test_lanes", 16, 32, 64, 128),
        axis("vsu.nodes_in_flight", 1, 2, 4, 8),
        axis("vsu.queue_entries", 128, 256, 512, 768),
        axis("hfu.input_slots", 2, 3, 5, 8),
        axis("rendering.input_fifo_entries", 8, 14, 20, 32, 64),
        *COMMON,
    ),
)


def lists(gaussians: int, entries: int) -> Assignments:
    return (f"sorting.buffer_entries={entries}", f"vsu.visit_gaussians={gaussians}")


PAPER = Order(
    "paper",
    "paper_text_no_vq",
    ALIKE,
    (
        groups(*SHAPES),
        axis("vsu.groups_ahead", 1, 2, 4),
        Axis("voxels of a ray", (("vsu.sample_step_voxels=0.5",), ("vsu.sample_step_voxels=0",))),
        axis("vsu.samples_per_cycle", 1, 2, 4, 8),
        axis("vsu.ray_lanes", 8, 16, 32, 48, 64),
        axis("vsu.renaming_bytes", 16384, 65536, 262144),
        axis("vsu.adjacency_lines", 64, 256, 1024),
        axis("hfu.ffus", 1, 2, 4),
        axis("fetch", "split", "shared"),
        axis("hfu.slice_gaussians", 16, 32, 64, 128, 256, 512),
        axis("hfu.input_slots", 2, 3, 4),
        axis("sorting.input_fifo_entries", 4, 7, 12, 20, 32, 64),
        Axis(
            "lists",
            (lists(64, 64), lists(128, 128), lists(256, 256), lists(512, 512), lists(0, 1024)),
        ),
        axis("vsu.rays_in_flight", 16, 32, 48, 64, 96, 128, 192),
        axis("vsu.step_lanes", 8, 12, 24),
        axis("vsu.ray_step_px", 4, 2, 1),
        axis("vsu.table_bytes", 2048, 4096, 8192, 16384, 32768),
        axis("vsu.node_fetches", 3, 7, 15, 31),
        axis("vsu.node_cache_bytes", 1536, 2048, 4096, 8192, 16384, 32768),
        axis("rendering.input_fifo_entries", 4, 8, 14, 20, 32, 64),
        axis("rendering.pixel_buffers", 1, 2),
        *COMMON,
    ),
)

# The lists take what the memory leaves, so that its size is an axis.
TILES = Order(
    "gscore",
    "gscore_lossless_boxes",
    ("storage.encoding=raw",),
    (
        axis("ccus", 2, 3, 4, 6, 8),
        axis("cores", 2, 3, 4, 5, 6, 8),
        axis("sram.buffer_bytes", 208896, 278528, 348160, 389120, 430080, 471040, 512000),
        axis("tiles.subtiles_across", 1, 2, 4),
        axis("culling.test_lanes", 6, 8, 10, 12, 16, 32),
        axis("culling.nodes_tested", 8, 16, 32, 64),
        axis("culling.nodes_in_flight", 2, 4, 8),
        axis("culling.nodes_in_test", 2, 4, 8),
        axis("ccu.cull_lanes", 1, 2, 3, 4, 8, 12, 23),
        axis("ccu.convert_lanes", 8, 12, 18, 24, 36, 48),
        axis("ccu.slice_gaussians", 4, 8, 16, 32),
        axis("ccu.input_slots", 2, 4, 8),
        axis("ccu.second_half_slots", 8, 16, 24, 32, 48),
        axis("lists.tile_lanes", 10, 14, 20, 40),
        axis("lists.part_lanes", 12, 18, 25, 34, 50),
        axis("lists.line_bytes", 32, 64, 128),
        axis("sorting.list_buffers", 1, 2, 3),
        axis("sorting.chunk_entries", 64, 128, 256),
        axis("rendering.core_lanes", 94),
        axis("rendering.sorted_entries", 64, 128, 256, 512),
        axis("rendering.record_slots", 24, 48, 64, 96, 128),
        axis("rendering.pixel_buffers", 1, 2),
        axis("rendering.drain_pixels_per_cycle", 1, 2, 4),
        axis("memory_port.max_outstanding", 16, 32, 48, 64),
    ),
    *("blend", "rendering.core_lanes"),
)
ORDERS = {order.name: order for order in (EXACT, PAPER, TILES)}


At = tuple[int, ...]  # for each axis the number of its setting
LIST = "point"  # name of the axis that a list of configurations is


@dataclasses.dataclass(frozen=True)
class Space:
    axes: tuple[Axis, ...]

    def assignments(self, at: At) -> Assignments:
        return tuple(s for axis, i in zip(self.axes, at) for s in axis.settings[i])

    def machine(self, at: At) -> Assignments:
        """Where what is chosen for each scene takes least."""
        settings = [a.settings[0 if a.scope else i] for a, i in zip(self.axes, at)]
        return tuple(
            dict.fromkeys(
                unscoped(s) if a.scope else s
                for a, setting in zip(self.axes, settings)
                for s in setting
            )
        )

    def all(self) -> Iterator[At]:
        """The last axis is the fastest."""
        return itertools.product(*(range(len(axis.settings)) for axis in self.axes))

    def size(self) -> int:
        return math.prod(len(axis.settings) for axis in self.axes)

    def keys(self) -> tuple[str, ...]:
        """That its settings have, in their order; a group's two as one."""
        keys = [s.partition("=")[0] for a in self.axes for setting in a.settings for s in setting]
        return tuple(dict.fromkeys(GROUP if key in GROUP_KEYS else key for key in keys))

    def moved(self, at: At, which: int, step: int) -> At | None:
        """Along one axis; None beyond its end."""
        if not 0 <= at[which] + step < len(self.axes[which].settings):
            return None
        return (*at[:which], at[which] + step, *at[which + 1 :])

    def neighbours(self, at: At) -> Iterator[At]:
        """One step on one axis: less first, since settings stand from little to much."""
        for step in (-1, 1):
            for which in range(len(self.axes)):
                if moved := self.moved(at, which, step):
                    yield moved

    def described(self) -> list:
        """For a study that others join: two spaces are one where this is equal."""
        return [[axis.name, [list(setting) for setting in axis.settings]] for axis in self.axes]


def parse_axis(text: str, scopes: Sequence[str] = ()) -> list[Axis]:
    """Of `KEY=V1,V2`, or of `KEY@SCENE=V1,V2`; scopes: what SCENE may be. Raises ValueError."""
    key, equals, values = text.partition("=")
    if not key or not equals or not all(values.split(",")):
        raise ValueError(f"--axis: '{text}', expected KEY=VALUE,VALUE,...")
    key, at, scope = key.partition("@")
    settings = tuple(expanded((f"{key}={value}",)) for value in values.split(","))
    if len(set(settings)) < len(settings):
        raise ValueError(f"--axis: '{text}', expected different values")
    if not at:
        return [Axis(key, settings)]
    return [
        Axis(f"{key}@{one}", tuple(tuple(scoped(s, one) for s in setting) for setting in settings))
        for one in (scopes if scope == EACH else [scope])
    ]


def parse_axes(
    texts: Sequence[str], machine: Sequence[Axis] = (), scopes: Sequence[str] = ()
) -> tuple[Axis, ...]:
    """machine: axes that come before, but for those that a text replaces. Raises ValueError, also
    where two texts set one key: the later would win unseen."""
    own = [axis for text in texts for axis in parse_axis(text, scopes)]
    keys = [key for axis in own for key in keys_of(axis)]
    for key in keys:
        if keys.count(key) > 1 or ("@" in key and key.partition("@")[0] in keys):
            raise ValueError(f"--axis: {key}: there are two")
    return (*(axis for axis in machine if not set(keys_of(axis)) & set(keys)), *own)


def keys_of(axis: Axis) -> list[str]:
    return [s.partition("=")[0] for s in axis.settings[0]]


def parse_point(text: str, place: str) -> Assignments:
    """Of `KEY=VALUE KEY=VALUE ...`. Raises ValueError."""
    for assignment in text.split():
        if "=" not in assignment:
            raise ValueError(f"{place}: '{assignment}', expected KEY=VALUE")
    return expanded(text.split())


def parse_named(text: str, number: int, place: str) -> tuple[str, Assignments]:
    """Of `NAME: KEY=VALUE ...`, where the name may be left out. number: which one of several it is.
    Raises ValueError."""
    name, point = re.fullmatch(r"(?:([^=:]+):(?:\s|$))?(.*)", text, re.DOTALL).groups()
    return (name or f"beside {number}").strip(), parse_point(point, place)


def read_points(path: pathlib.Path) -> tuple[Axis, ...]:
    """Configurations of a file, one a line; `#` begins a comment. Raises ValueError."""
    points: list[Assignments] = []
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if assignments := parse_point(line.partition("#")[0], f"{path}:{number}"):
            points.append(assignments)
    if not points:
        raise ValueError(f"{path}: no configurations, expected KEY=VALUE ... on each line")
    return (Axis(LIST, tuple(points)),)
