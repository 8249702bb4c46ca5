"""The block diagram of the preset `exact`, as SVG, from what `streaminggs describe` prints of it: units
from above to below, as a frame passes them, with lanes and memories; FIFOs between them; the
memory's ports and channels beside them. It has a background of its own and follows the theme of the reader."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from xml.sax.saxutils import escape

Rows = Sequence[Mapping[str, str]]


@dataclasses.dataclass(frozen=True)
class Block:
    """A unit. number: key of how many there are. uses: its on-chip memories, without the FIFO of
    that name behind it. traffic: what it moves, with the side that it moves to."""

    name: str
    does: str
    datapaths: tuple[str, ...]
    uses: tuple[str, ...]
    fifo: str
    traffic: str
    number: str = ""
    writes: bool = False
    reads: bool = True


BLOCKS = (
    Block(
        *("VSU", "walks the chunk tree", ("chunk_test",)),
        (
            *("upper nodes", "nodes in flight", "nodes in test", "keys of open nodes"),
            *("chunk queue", "node queue", "final visits"),
            *("entries that come back", "entries put aside"),
        ),
        *("visits", "tree, overflow"),
        writes=True,
    ),
    Block(
        *("HFU, coarse", "tests first halves", ("coarse",), ("input", "slices")),
        *("keys to sorting", "first halves", "hfus"),
    ),
    Block(
        *("sorting", "sorts the keys of a chunk", ()),
        ("key sorters", "compared keys", "sorted places"),
        *("keys to merge", "", "sorting_units"),
    ),
    Block(
        *("merge", "releases keys in final order", ()),
        (
            *("waiting keys", "spilled runs", "fronts of runs", "rest of fronts"),
            *("spill blocks", "spill writes"),
        ),
        *("keys to HFUs", "spill"),
        writes=True,
    ),
    Block(
        *("HFU, fine", "makes splats", ("fine",), ("second halves", "fetched candidates")),
        *("splats to rendering", "second halves", "hfus"),
    ),
    Block(
        *("rendering", "blends", ("subtile_blend", "conic", "spans_begin", "row_span", "drain")),
        (
            *("pixel state", "finished pixels", "splats under way", "begun spans", "spans"),
            *("cluster queues", "sub-tiles in the loop", "pixel writes"),
        ),
        *("", "pixels"),
        writes=True,
        reads=False,
    ),
)
PORT = "a port's bytes a cycle"  # column of the memory's table
# Of all units: a table in each port, a mask where finished sub-tiles are looked up.
SHARED = ("outstanding transactions", "finished sub-tiles")

WIDTH, TOP = 580, 84
HEIGHT, GAP = 66, 44  # of a block, between two
DRAM, LEFT, RIGHT, BACK = (14, 84), 194, 506, 548  # columns, from left to right

STYLE = """
    svg { --page: #fdfdfb; --ink: #1b2433; --soft: #455065; --unit: #e3ebf5; --edge: #2c5282;
          --dram: #e6eadf; --green: #3f6b2c; --red: #9b2c4d; --queue: #fdf0d9 }
    @media (prefers-color-scheme: dark) {
      svg { --page: #14181f; --ink: #eef2f8; --soft: #b9c3d3; --unit: #223450; --edge: #8fb4e3;
            --dram: #2b3626; --green: #9ccb84; --red: #f09ab2; --queue: #4a3a1c } }
    text { fill: var(--ink); font-size: 14px; text-anchor: middle }
    .name { font-size: 16px; font-weight: bold }
    .side { fill: var(--soft); text-anchor: start; font-size: 13px }
    .page { fill: var(--page); stroke: var(--soft) }
    .unit { fill: var(--unit); stroke: var(--edge); stroke-width: 1.6 }
    .dram { fill: var(--dram); stroke: var(--green); stroke-width: 1.6 }
    .queue { fill: var(--queue); stroke: var(--ink) }
    .wire, .bus, .back { fill: none; stroke: var(--ink); stroke-width: 2 }
    .bus { stroke: var(--green) }
    .back { stroke: var(--red); stroke-dasharray: 5 4 }
    .head { fill: var(--ink) } .bus-head { fill: var(--green) } .back-head { fill: var(--red) }
    .moved { fill: var(--green) } .told { fill: var(--red) }
"""


def text(x: float, y: float, what: str, kind: str = "", upright: bool = False) -> str:
    """upright: from below to above."""
    named = f' class="{kind}"' if kind else ""
    place = f'transform="translate({x} {y}) rotate(-90)"' if upright else f'x="{x}" y="{y}"'
    return f"  <text{named} {place}>{escape(what)}</text>\n"


def box(x: float, y: float, width: float, height: float, kind: str, round_px: int = 5) -> str:
    place = f'x="{x}" y="{y}" width="{width}" height="{height}" rx="{round_px}"'
    return f'  <rect class="{kind}" {place}/>\n'


def arrow(start: tuple[float, float], end: tuple[float, float], kind: str, head: str) -> str:
    """Along an axis."""
    (x, y), (to_x, to_y) = start, end
    along, across = ((to_x > x) - (to_x < x), (to_y > y) - (to_y < y)), 4
    base = to_x - 8 * along[0], to_y - 8 * along[1]
    sides = " ".join(
        f"{base[0] + side * along[1]},{base[1] + side * along[0]}" for side in (-across, across)
    )
    return (
        f'  <path class="{kind}" d="M{x} {y}L{base[0]} {base[1]}"/>\n'
        f'  <polygon class="{head}" points="{to_x},{to_y} {sides}"/>\n'
    )


def of_several(name: str) -> str:
    """`chunk queue 3` is a part of `chunk queue`."""
    return re.sub(r" \d+$", "", name)


def bytes_by_use(uses: Rows) -> dict[str, int]:
    found: dict[str, int] = {}
    for use in uses:
        name = of_several(use["use"])
        found[name] = found.get(name, 0) + int(use["bytes"])
    return found


def check_places(found: Mapping[str, int]) -> None:
    """Raises ValueError for a memory that no block has."""
    placed = {*SHARED, *(name for b in BLOCKS for name in (*b.uses, b.fifo) if name)}
    if unknown := found.keys() ^ placed:
        raise ValueError(f"block diagram: {', '.join(sorted(unknown))}: expected in one block each")


def lanes_line(block: Block, datapaths: Rows) -> str:
    """All lanes of its units; of several datapaths the first, and the rest."""
    lanes = {row["datapath"]: row["lanes"].split() for row in datapaths}
    counts = [int(lanes[name][0]) for name in block.datapaths]
    if not counts:
        return block.does
    kind = lanes[block.datapaths[0]][1].removesuffix("_lane").removesuffix("_chaining")
    more = f" + {sum(counts[1:])}" if counts[1:] else ""
    return f"{block.does}: {counts[0]}{more} lanes, {kind}"


def memory_line(block: Block, found: Mapping[str, int]) -> str:
    """The largest memory by name, and the rest."""
    largest = max(block.uses, key=lambda name: found[name])
    rest = sum(found[name] for name in block.uses) - found[largest]
    return f"{found[largest]:,} B {largest}" + (f", {rest:,} B more" if rest else "")


def fifo_line(name: str, uses: Rows) -> str:
    """`visits: 4 x 4, 128 bits`: how many FIFOs, entries of each."""
    (use,) = (row for row in uses if row["use"] == name)
    count = int(use["memories"])
    entries = re.search(r"(\d+) (?:visits|keys|splats)", use["arithmetic"])
    if entries is None:
        raise ValueError(f"block diagram: {name}: {use['arithmetic']}: expected entries of a FIFO")
    several = f"{count} FIFOs of" if count > 1 else "FIFO of"
    return f"{name}: {several} {entries[1]}, {use['bits wide']} bits"


def block_at(y: float, block: Block, keys: Mapping[str, str], datapaths: Rows, uses: Rows) -> str:
    middle, centre = (LEFT + RIGHT) / 2, y + HEIGHT / 2
    number = int(keys[block.number]) if block.number else 1
    drawn = box(LEFT, y, RIGHT - LEFT, HEIGHT, "unit")
    drawn += text(middle, y + 20, f"{number} x {block.name}", "name")
    drawn += text(middle, y + 39, lanes_line(block, datapaths))
    drawn += text(middle, y + 57, memory_line(block, bytes_by_use(uses)))
    if block.traffic:
        drawn += text((DRAM[1] + LEFT) / 2, centre - 9, block.traffic, "moved")
        if block.reads:
            drawn += arrow((DRAM[1], centre), (LEFT, centre), "bus", "bus-head")
        if block.writes:
            below = centre + (9 if block.reads else 0)
            drawn += arrow((LEFT, below), (DRAM[1], below), "bus", "bus-head")
    if block.fifo:
        top = y + HEIGHT
        drawn += arrow((LEFT + 40, top), (LEFT + 40, top + GAP), "wire", "head")
        drawn += "".join(box(LEFT + 27, top + 5 + 9 * at, 26, 9, "queue", 0) for at in range(3))
        drawn += text(LEFT + 60, top + GAP / 2 + 4, fifo_line(block.fifo, uses), "side")
    return drawn


def finished(bottom: float) -> str:
    """From `bottom` on: what rendering tells the units before it. Sorting has nothing to drop."""
    told = [at for at, block in enumerate(BLOCKS) if block.name not in ("sorting", "rendering")]
    drawn = f'  <path class="back" d="M{RIGHT} {bottom}H{BACK}V{TOP + HEIGHT / 2}"/>\n'
    for at in told:
        y = TOP + at * (HEIGHT + GAP) + HEIGHT / 2
        drawn += arrow((BACK, y), (RIGHT, y), "back", "back-head")
    return drawn + text(BACK + 20, (TOP + bottom) / 2, "finished groups and sub-tiles", "told", True)


def svg(preset: str, keys: Mapping[str, str], datapaths: Rows, uses: Rows, memory: Rows) -> str:
    """Raises ValueError where a memory has no place, KeyError where a block has no row."""
    found = bytes_by_use(uses)
    check_places(found)
    of = {
        kind: sum(int(use["bytes"]) for use in uses if use["built as"] == kind)
        for kind in ("SRAM", "registers")
    }
    (ports,) = (row["memories"] for row in uses if row["use"] == "outstanding transactions")
    (dram,) = memory
    bottom = TOP + len(BLOCKS) * (HEIGHT + GAP) - GAP
    height = bottom + 18
    group = f"{keys['group_width_px']} x {keys['group_height_px']} px"
    head = (
        f"preset {preset}: {keys['clock_mhz']} MHz, groups of {group}",
        f"on chip: {of['SRAM']:,} B of SRAM, {of['registers']:,} B of registers",
        f"{ports} memory ports: {dram[PORT]} B a cycle each way, "
        f"{keys['memory_port.max_outstanding']} requests in flight each",
    )
    name = f"{dram['memory']}: {dram['channels']} channels of {dram['bits of a channel']} bits"
    drawn = box(1, 1, WIDTH - 2, height - 2, "page")
    drawn += text(WIDTH / 2, 24, head[0], "name")
    drawn += text(WIDTH / 2, 46, head[1]) + text(WIDTH / 2, 66, head[2])
    drawn += box(DRAM[0], TOP, DRAM[1] - DRAM[0], bottom - TOP, "dram")
    middle, centre = (DRAM[0] + DRAM[1]) / 2, (TOP + bottom) / 2
    drawn += text(middle - 8, centre, f"DRAM, {dram['most GB/s']} GB/s", "name", True)
    drawn += text(middle + 16, centre, name, "", True)
    for at, block in enumerate(BLOCKS):
        drawn += block_at(TOP + at * (HEIGHT + GAP), block, keys, datapaths, uses)
    drawn += finished(bottom - HEIGHT / 2)
    about = f"Block diagram of the preset {preset}, from streaminggs describe"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" '
        "font-family=\"'DejaVu Sans', Verdana, Helvetica, Arial, sans-serif\">\n"
        f"  <title>{about}</title>\n  <style>{STYLE}  </style>\n{drawn}</svg>\n"
    )
