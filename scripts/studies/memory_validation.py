"""The memory alone, by tb_dram: streams through it beside closed forms and public simulators."""

from __future__ import annotations

import argparse
import pathlib
import re
from collections.abc import Mapping, Sequence

import tables
from runs.beside import beside, printed
from runs.files import read_json
from runs.scenes import REPOSITORY, program_provenance
from tables import Column

SIMULATED = pathlib.Path(__file__).with_suffix(".json")
PUBLISHED = REPOSITORY / "testbench" / "dram" / "published.json"
MEMSPECS = REPOSITORY / "modules" / "dram" / "memspecs"
WINDOW = 32  # requests outstanding, a data bus

# What tb_dram prints: of a published row bandwidth, row hits, share of the peak, mean and two more
# latencies, power; of a memory its peak, and of each stream the bandwidth over its bound.
OF_STREAM = re.compile(
    r"\| +([\d.]+) +[\d.]+ +[\d.]+ +(\d+)/\d+/\d+ +(\d+) +(\d+)\.\.(\d+) [^|]*\|[^|]*\|"
)
OF_PART = re.compile(r"^(\w+) +([\d.]+)((?: +[\d.]+/[\d.]+){6}) *$", re.MULTILINE)
OF_BANDWIDTH = re.compile(r"^bandwidth +([\d.]+) ", re.MULTILINE)


def of_gb_s(name: str, meaning: str, form: str = ".3f") -> Column:
    return Column(f"{name} GB/s", meaning, "GB/s", form)


STREAM = Column("stream", "closed loop, reads unless it says otherwise; strides are of 32 B")
BOUND = of_gb_s("bound", "in closed form")
OURS = (
    of_gb_s("ours", "bandwidth"),
    Column("ours ns", "mean time that a request is outstanding", "ns", ",d"),
    Column("mW, VDD2", "power of that rail, default set of currents", "mW", ",d"),
    Column("mW, both rails, least", "of both sets of currents", "mW", ",d"),
    Column("mW, both rails, most", "of both sets of currents", "mW", ",d"),
)
THEIRS = {
    "dramsim3": of_gb_s("DRAMsim3", "published"),
    "dramsim3_mean_ns": Column("DRAMsim3 ns", "published mean", "ns", ",d"),
    "ramulator": of_gb_s("Ramulator", "published"),
    "ramulator_mean_ns": Column("Ramulator ns", "published mean", "ns", ",d"),
}
INTERLEAVE = Column("interleave", "bytes that lie together on a channel")
PART_COLUMNS = (
    Column("memspec", "shipped memory"),
    of_gb_s("peak", "of the channel"),
    of_gb_s("seq 64 B", "reads of 64 bytes in sequence"),
    of_gb_s("seq 32 B", "reads of 32 bytes in sequence"),
    of_gb_s("random 64 B", "reads of 64 bytes at random"),
    of_gb_s("its bound", "in closed form"),
    of_gb_s("random 32 B", "reads of 32 bytes at random"),
    of_gb_s("bound of 32 B", "in closed form"),
    of_gb_s("seq 64 B, 30 % writes", "in sequence"),
    of_gb_s("random 64 B, 30 % writes", "at random"),
)
# Streams that other simulators were given: pattern, per cent of writes; where the bound stands
# among those that tb_dram prints of a memory.
STREAMS = {
    "seq 64 B": ("seq", 0, 0),
    "random 64 B": ("rnd", 0, 2),
    "seq 64 B, 30 % writes": ("seq", 30, None),
    "random 64 B, 30 % writes": ("rnd", 30, None),
}


def simulated_columns() -> list[Column]:
    columns = [
        Column("memspec", "shipped memory"),
        Column("simulator", "which other one"),
        Column("its timings", "shipped: those it comes with; ours: those of the memspec"),
    ]
    for name, (_, _, bound) in STREAMS.items():
        if bound is not None:
            less = "in closed form, less all-bank refresh; of the mix too"
            columns.append(of_gb_s(f"{name}: bound", less, ".2f"))
        columns += [of_gb_s(f"{name}: {whose}", "bandwidth") for whose in ("ours", "theirs")]
    return columns


def size_text(count: int) -> str:
    return f"{count // 1024} KB" if count % 1024 == 0 else f"{count} B"


def stream_text(row: Mapping) -> str:
    """Of a row of published.json, whose own names are short."""
    if row["pattern"] == "stride":
        return f"stride {size_text(row['stride'])}"
    text = f"{'random' if row['pattern'] == 'random' else 'seq'} {row['bytes']} B"
    text += f", {row['write_percent']} % writes" if "write_percent" in row else ""
    return text + (f", window {row['window']}" if "window" in row else "")


def stream_rows(text: str, published: Mapping) -> dict[str, list[list]]:
    """By section of published.json, in its order. Raises ValueError where tb_dram printed other
    rows."""
    found = [[float(of[0]), *map(int, of[1:])] for of in OF_STREAM.findall(text)]
    sections = {name: published[name] for name in ("one_channel", "four_channels")}
    if len(found) != (count := sum(map(len, sections.values()))):
        raise ValueError(f"tb_dram: got {len(found)} streams, expected {count} of {PUBLISHED.name}")
    ours = iter(found)
    return {
        name: [
            [stream_text(row), row.get("bound"), *next(ours), *map(row.get, THEIRS)]
            for row in section
        ]
        for name, section in sections.items()
    }


def part_values(text: str) -> dict[str, tuple[float, list[float], list[float]]]:
    """By memory its peak, then of each stream bandwidth and bound. Raises ValueError for none."""
    found = {}
    for name, peak, pairs in OF_PART.findall(text):
        both = [tuple(map(float, pair.split("/"))) for pair in pairs.split()]
        found[name] = (float(peak), [ours for ours, _ in both], [bound for _, bound in both])
    if not found:
        raise ValueError(f"tb_dram: got no memory in {text[-80:]!r}, expected each with its peak")
    return found


def part_row(name: str, peak: float, ours: Sequence[float], bound: Sequence[float]) -> tuple:
    return (name, peak, *ours[:3], bound[2], ours[3], bound[3], *ours[4:])


def bandwidth(program: pathlib.Path, memspec: str, buses: int, stream: str, requests: int) -> float:
    """Of 64 bytes a request."""
    pattern, writes, _ = STREAMS[stream]
    words = ["--stream", pattern, "--bytes", "64", "--write-percent", str(writes)]
    words += ["--window", str(WINDOW * buses), "--requests", str(requests)]
    for setting in ("channels=1", "refresh=all_bank", "front_end_ns=0", "back_end_ns=0"):
        words += ["--set", f"dram.{setting}"]
    text = printed(program, [*words, "--set", f"dram.memspec={memspec}"])
    found = OF_BANDWIDTH.search(text)
    if not found:
        raise ValueError(f"tb_dram: got no bandwidth in {text[:80]!r}, expected one of {memspec}")
    return float(found[1])


def simulated_rows(
    program: pathlib.Path, beside_us: Sequence[Mapping], bounds: Mapping, requests: int
) -> list[list]:
    """bounds: of each memory, by its name, those of its streams without refresh."""
    rows: list[list] = []
    ours: dict[str, list[float]] = {}
    for of in beside_us:
        name = of["memspec"]
        spec = read_json(MEMSPECS / f"{name}.json")
        timing = spec["timing_cycles"]
        buses = spec["organisation"].get("pseudo_channels", 1)
        if name not in ours:
            ours[name] = [bandwidth(program, name, buses, s, requests) for s in STREAMS]
        row = [name, of["simulator"], of["timings"]]
        share = 1 - timing["rfc_all"] / timing["refi"]
        for (_, _, at), here, there in zip(STREAMS.values(), ours[name], of["gb_s"], strict=True):
            row += [] if at is None else [bounds[name][at] * share]
            row += [here, there]
        rows.append(row)
    return rows


def make_memory(arguments: argparse.Namespace) -> None:
    program = beside(arguments.streaminggs, "tb_dram")
    published, simulated = read_json(PUBLISHED), read_json(SIMULATED)
    words = ["--table", "--published", str(PUBLISHED), "--requests", str(arguments.requests)]
    text = printed(program, words)
    by = tables.made(program, [program_provenance(program)], [PUBLISHED])
    out, at_most = arguments.out, f"at most {arguments.requests:,} requests a stream."

    rows = stream_rows(text, published)
    said = f"One channel, peak 6.4 GB/s, window of {WINDOW} requests, {at_most}"
    columns = (STREAM, BOUND, *OURS, *THEIRS.values())
    tables.write(out, "tb_dram_one_channel", by, columns, rows["one_channel"], said)

    interleaves = [row["interleave"] for row in published["four_channels"]]
    four = [[name, *row] for name, row in zip(interleaves, rows["four_channels"])]
    four.sort(key=lambda row: interleaves.index(row[0]))
    columns = (INTERLEAVE, STREAM, BOUND, *OURS, THEIRS["dramsim3"], THEIRS["ramulator"])
    four = [[*row[:-4], row[-4], row[-2]] for row in four]  # nobody published their means
    said = f"Four channels, peak 25.6 GB/s, window of {4 * WINDOW} requests, {at_most}"
    tables.write(out, "tb_dram_four_channels", by, columns, four, said)

    parts = part_values(text)
    said = f"One channel, per-bank refresh, window of {WINDOW} requests a data bus, {at_most}"
    part_rows = [part_row(name, *of) for name, of in parts.items()]
    tables.write(out, "tb_dram_parts", by, PART_COLUMNS, part_rows, said)

    requests = min(arguments.requests, simulated["requests"])
    bounds = {name: bound for name, (_, _, bound) in parts.items()}
    rows_beside = simulated_rows(program, simulated["beside"], bounds, requests)
    said = "\n\n".join(simulated["notes"]).format(requests=f"{requests:,}")
    by = tables.made(program, [program_provenance(program)], [SIMULATED])
    tables.write(out, "memories_beside", by, simulated_columns(), rows_beside, said)
