"""The study of single parts beside what others publish, simpler ways and limits."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping

import tables
from runs import run_arguments
from runs.beside import beside, markdown_table, printed
from runs.files import read_json
from runs.scenes import REPOSITORY, program_provenance
from studies.bench_validation import SCENES, make_codebooks, make_precision
from studies.gpu_validation import make_gpu
from studies.memory_validation import make_memory
from tables import Column, Study

TECHNOLOGY = REPOSITORY / "testbench" / "cost" / "technology_32nm.json"

BEYOND = "would get larger, farther or brighter than a scene may hold"
LIMIT_COLUMNS = (
    Column("scene", "300 Gaussians, 64 px wide, made hard in this way"),
    Column("rates", "which of the original's rates are multiplied"),
    Column("loss at first", "before the first step", "", "g"),
    Column("loss after 40 steps", "with the original's rates", "", "g"),
    Column("best factor", "of the rates, by the loss after 40 steps", "", "g"),
    Column("its loss", "after 40 steps", "", "g"),
    Column("completes up to", "largest factor with which all steps are done", "", "g"),
    Column("stops at", "smallest factor that stops", "", "g"),
    Column("message", f"that the tuning gives; beyond the limits: {BEYOND}"),
    Column(
        "state kept",
        "whether the last good state is within limits, draws in numbers and is restored equal",
    ),
)


def factor(text: str) -> float | None:
    """Of 10^POWER; None for `none`."""
    return float(text.replace("10^", "1e")) if text.startswith("10^") else None


def limit_rows(text: str) -> Iterator[tuple]:
    """Raises ValueError."""
    for scene, rates, first, last, best, completes, stops, kept in markdown_table(text, 8)[1]:
        of_best, _, best_loss = best.partition(": ")
        stops_at, _, message = stops.partition(": ")
        yield (
            *(scene, rates, float(first), float(last), factor(of_best), float(best_loss)),
            *(factor(completes), factor(stops_at), message.replace(BEYOND, "beyond the limits")),
            kept == "yes",
        )


def make_tuning(arguments: argparse.Namespace) -> None:
    program = beside(arguments.streaminggs, "tuning_limits")
    rows = limit_rows(printed(program, ["--decades", str(arguments.decades)]))
    by = tables.made(program, [program_provenance(program)])
    tables.write(arguments.out, "tuning_limits", by, LIMIT_COLUMNS, rows)


# Published memories by how their names begin in the technology table.
POINTS = {
    "cacti45": "CACTI, 45 nm (fakeram45)",
    "cacti22": "CACTI, 22 nm (ZigZag), two ports",
    "horowitz45": "Horowitz, 45 nm",
    "cacti32": "CACTI, 32 nm: a port that reads, one that writes / one port",
    "ihp130": "IHP, 130 nm: two ports that read and write / one",
    "openram130": "OpenRAM, 130 nm: a second port that reads / one",
}
SRAM_ABOUT = (
    "Formula over published figure, or ratio of two (/), minus 1, in %; empty: not published. "
    "Published figures are those of testbench/cost/technology_32nm.json, with their sources."
)
SRAM_COLUMNS = (
    Column("point", "who published the memory"),
    Column("rows x width", "of its bits"),
    Column("area %", "of the formula over the published one, at 32 nm", "%", "+.1f"),
    Column("energy of a read %", "likewise", "%", "+.1f"),
)


def sram_rows(sram: Mapping) -> Iterator[tuple]:
    """sram: of the technology table, whose formula technology.h states."""
    second = sram["second_port"]["middle"]

    def row(name: str, of: Mapping, *over: float | None) -> tuple:
        width = of["width_bits"]
        rows = f"{of['bits'] // width} x {width} bit"
        percents = [None if ratio is None else 100 * (ratio - 1) for ratio in over]
        return (POINTS[name.partition("_")[0]], rows, *percents)

    for name, of in sram["points"].items():
        bits, width, root = of["bits"], of["width_bits"], math.sqrt(of["bits"])
        um2 = (bits * sram["um2_bit"] + width * sram["um2_width"]) * second ** (of["ports"] - 1)
        pj = width * (sram["pj_width"] + sram["pj_cell"] * root) + sram["pj_decode"] * root
        area = um2 / (of["um2"] * of["um2_scale"]) if of["um2"] else None
        yield row(name, of, area, pj / (of["pj"] * of["pj_scale"]) if of["pj"] else None)
    for name, of in sram["pairs"].items():
        yield row(name, of, second / (of["two_um2"] / of["one_um2"]), None)


def make_sram(arguments: argparse.Namespace) -> None:
    program = arguments.streaminggs
    by = tables.made(program, [program_provenance(program)], [TECHNOLOGY])
    rows = sram_rows(read_json(TECHNOLOGY)["sram"])
    tables.write(arguments.out, "sram_formula", by, SRAM_COLUMNS, rows, SRAM_ABOUT)


PARTS: Mapping[str, Callable[[argparse.Namespace], None]] = {
    "memory": make_memory,
    "gpu": make_gpu,
    "sram": make_sram,
    "codebooks": make_codebooks,
    "precision": make_precision,
    "tuning": make_tuning,
}


def add_arguments(to: run_arguments.Parser) -> None:
    run_arguments.add_scenes(to, f"{', '.join(SCENES)} for pictures, all real ones for gpu")
    run_arguments.add_side_by_side(to)
    to.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="to measure")
    to.add_argument("--requests", type=int, default=100_000, help="to the memory, of a stream")
    to.add_argument("--decades", type=int, default=36, help="of learning rates that are tried")


def make(arguments: argparse.Namespace) -> None:
    run_arguments.check_once("--parts", arguments.parts)
    for part in arguments.parts:
        PARTS[part](arguments)


VALIDATION = Study(
    "validation",
    """Parts of the model alone, beside what others publish or a simpler way. Makes of the part

  memory     tb_dram_one_channel, tb_dram_four_channels, memories_beside: streams beside DRAMsim3
             and Ramulator; tb_dram_parts: every shipped memory beside a closed form
  gpu        gpu_checks: the model of the GPU beside published rates and shares
  sram       sram_formula: the formula of on-chip memory beside the memories that it is fitted to
  codebooks  quantisation: pictures from codebooks beside plain k-means
  precision  blending_precision: pictures of each arithmetic of blending beside double
  tuning     tuning_limits: up to which learning rates hard scenes are tuned

Needs tb_dram, bench_quantisation, bench_precision and tuning_limits beside the command, as a whole
build has them.
""",
    ("results.py validation",),
    add_arguments,
    make,
)
