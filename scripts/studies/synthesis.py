"""Gates of the datapaths in Verilog: Yosys and ABC map each module to the cells of open libraries,
once as small and once as fast as they can, and random operands go through its gates. Makes

  synthesis       a line for each library and module
  synthesis_32nm  of each module what all libraries say, scaled to 32 nm, beside what is charged

Libraries: Debian's osu018, and those in the folder liberty of ../shared or $SGS_SHARED. There are
no wires, no layout and no clock tree in it.
"""

from __future__ import annotations

import argparse
import dataclasses
import gzip
import itertools
import json
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import tempfile
from collections.abc import Iterator, Sequence

import tables
from tables import Column, Made
from runs import run_arguments
from runs.scenes import REPOSITORY, shared_folder
from runs.simulations import Failure
from studies import switching

JOBS = ("results.py synthesis",)

VERILOG = REPOSITORY / "modules" / "datapath" / "rtl"
TECHNOLOGY = REPOSITORY / "testbench" / "cost" / "technology_32nm.json"
OSU018 = pathlib.Path("/usr/share/qflow/tech/osu018/osu018_stdcells.lib")

# Delay of an inverter that drives four of itself, ps for each nm that gates are long: typical, and
# at low voltage and high temperature (Ho, Mai, Horowitz, "The Future of Wires", Proc. IEEE 2001).
FO4_PS_NM = (0.36, 0.5)
NODE_NM = 32
# A register's own delay and set-up, FO4 (medium confidence).
REGISTER_FO4 = 5
# NAND2_X1 of NanGate's open library at 45 nm. The part of the area that cells fill is the ledger's.
NAND2_UM2 = 0.798 * (NODE_NM / 45) ** 2
FILLED = {"low": 1.0, "middle": 0.75, "high": 0.65}

# Energy goes with the gates' length and the square of the voltage.
NODE_VOLTS = 0.9
NODES_NM = {"osu018": 180, "sg13g2": 130, "sky130": 130, "nangate45": 45}
CYCLES = 1000  # of random operands

# Cells that a mapper is not to choose: for power domains, clocks, delays, scan and layout.
NOT_MAPPED = re.compile(r"lpflow|clk|dly|probe|sighold|antenna|decap|fill|spare|l?gcp|_s?edf|_sdf")
# Mappers' scripts. The large one of Yosys saves area; the other one time, then area that is left.
SMALL = (
    "strash; ifraig; scorr; dc2; dretime; strash; &get -n; &nf; &put; buffer -c; topo; upsize; "
    "dnsize; stime"
)
FAST = "strash; ifraig; scorr; dch -f; map -B 0.9; topo; buffer -c; topo; upsize; dnsize; stime"
MAPPINGS = {"small": SMALL, "fast": FAST}
DELAY = re.compile(r"Delay = *([\d.]+) ps")


@dataclasses.dataclass(frozen=True)
class Module:
    """top, parameters: in Verilog. charged: so many of a part of the ledger."""

    name: str
    top: str
    charged: str
    times: int = 1
    parameters: tuple[str, ...] = ()


HALF = tuple(
    f"{name} {value}"
    for name, value in (
        ("EXPONENT_BITS", 5),
        ("FRACTION_BITS", 10),
        ("UNROUNDED", 0),
        ("SIGNED_ZERO", 0),
        ("REGISTERS", 0),
    )
)
MODULES = (
    Module("fp32 lane", "fp32_lane", "fp32_lane"),
    Module("fp32 lane that only chains", "lane", "fp32_lane", 1, ("UNROUNDED 0",)),
    Module("fp32 lane without registers", "lane", "fp32_lane", 1, ("REGISTERS 0",)),
    Module("fp16 lane", "fp16_lane", "fp16_lane"),
    Module("fp16 lane without registers", "lane", "fp16_lane", 1, HALF),
    Module("comparator", "comparator", "comparator"),
    Module("comparator that compares and selects", "comparator", "comparator", 1, ("HAS 3",)),
    Module("comparator that adds", "comparator", "comparator", 1, ("HAS 4",)),
    Module("comparator that shifts", "comparator", "comparator", 1, ("HAS 24",)),
    Module("rounding", "rounding", "comparator", 3),
    Module("split of 2^t", "exp2_split", "comparator", 4),
    Module("scaling in half", "half_scale", "comparator"),
    Module("split of 2^t, half", "exp2_split", "comparator", 4, HALF[:2]),
    Module("table of 2^t", "exp2_table", "exp2_table"),
    Module("table of 2^t, half", "exp2_table_half", "exp2_table_half"),
    Module("seed of a reciprocal", "reciprocal_seed", "small_table"),
    Module("seed of a root", "root_seed", "small_table"),
    Module("root of a reach", "reach_table", "small_table"),
    Module("32 register bits", "stage", "register_bit", 32, ("WIDTH 32",)),
)

MODULE = Column("module", "in modules/datapath/rtl")
COLUMNS = (
    Column("library", "file of its cells"),
    MODULE,
    Column("mapped", "to be small or to be fast"),
    Column("NAND2", "its area by that of the library's smallest NAND2", "", ",.0f"),
    Column("register bits", "flip-flops", "", ",d"),
    Column("FO4", "logic depth of its slowest stage, by an inverter that drives four", "", ".1f"),
    Column("um2", "cells' area in the library", "um2", ",.0f"),
    Column("pJ, settled", "a cycle of random operands, gates that take no time", "pJ", ".3g"),
    Column("pJ, with glitches", "the same, gates that take the same time", "pJ", ".3g"),
)
CHARGED = ("low", "middle", "high")
NODE_COLUMNS = (
    MODULE,
    Column("register bits", "flip-flops", "", ",d"),
    Column("NAND2, least", "of all libraries and mappings", "", ",.0f"),
    Column("NAND2, most", "likewise", "", ",.0f"),
    Column("FO4, least", "logic depth of the slowest stage, mapped to be fast", "", ".0f"),
    Column("FO4, most", "likewise", "", ".0f"),
    Column("ns, least", "that and a register at 32 nm: least depth, typical", "ns", ".2f"),
    Column("ns, most", "most depth, slow", "ns", ".2f"),
    *(Column(f"um2, {of}", "at 32 nm, as the gates say", "um2", ",.0f") for of in CHARGED),
    Column("charged as", "parts of the ledger"),
    *(Column(f"charged, {of}", "at 32 nm", "um2", ",.0f") for of in CHARGED),
    Column("pJ, settled, least", "at 32 nm, of all libraries", "pJ", ".3g"),
    Column("pJ, settled, most", "likewise", "pJ", ".3g"),
    Column("pJ, with glitches, least", "likewise", "pJ", ".3g"),
    Column("pJ, with glitches, most", "likewise", "pJ", ".3g"),
    *(Column(f"charged pJ, {of}", "at 32 nm", "pJ", ".3g") for of in CHARGED),
)
ABOUT = (
    "Area at 32 nm: NAND2 equivalents by 0.40 um2, a NAND2 of NanGate's 45 nm library x (32/45)^2. "
    "Low: the least number, cells alone. High: the most, at 65 % of the area they stand in. "
    "Middle: the geometric mean of all, at 75 %. "
    "A FO4 at 32 nm is 11.5 ps, slow 16 ps; a register takes 5. "
    "Energy: the library's x 32 nm over its gates' length x the square of 0.9 V over its voltage. "
    "Operands are new and random in every cycle. No wires, no layout, no clock."
)


@dataclasses.dataclass(frozen=True)
class Library:
    """path: its cells without those that are not to be mapped."""

    name: str
    path: pathlib.Path
    nand2_um2: float
    register_um2: float
    fo4_ps: float
    volts: float
    cells: dict[str, switching.Cell]
    register: switching.Cell

    def at_node(self, pj: float) -> float:
        """At 32 nm. Raises ValueError where the library's node is not known."""
        for part, nm in NODES_NM.items():
            if part in self.name.lower():
                return pj * NODE_NM / nm * (NODE_VOLTS / self.volts) ** 2
        raise ValueError(f"{self.name}: node unknown, expected one of {', '.join(NODES_NM)}")


@dataclasses.dataclass(frozen=True)
class Mapped:
    """pj: a cycle in the library, settled and with glitches. node_pj: the same at 32 nm."""

    library: str
    module: Module
    mapping: str
    nand2: float
    register_bits: int
    fo4: float
    um2: float
    pj: tuple[float, float]
    node_pj: tuple[float, float]

    def row(self) -> tuple:
        sizes = (self.nand2, self.register_bits, self.fo4, self.um2)
        return (self.library, self.module.name, self.mapping, *sizes, *self.pj)


def cells_of(liberty: str) -> Iterator[tuple[str, int, int]]:
    """Name, beginning and end of each cell's group."""
    for head in re.finditer(r'^[ \t]*cell\s*\(\s*"?(\w+)"?\s*\)\s*\{', liberty, re.MULTILINE):
        depth, end = 1, head.end()
        for brace in re.compile(r"[{}]").finditer(liberty, head.end()):
            depth += 1 if brace.group() == "{" else -1
            if depth == 0:
                end = brace.end()
                break
        yield head.group(1), head.start(), end


def one_word(pattern: str, text: str, what: str) -> str:
    found = re.search(pattern, text)
    if not found:
        raise ValueError(f"{what}: not found, expected in a library of cells")
    return found.group(1)


def area_of(cell: str, what: str) -> float:
    return float(one_word(r"\barea\s*:\s*\"?([\d.eE+-]+)", cell, f"area of {what}"))


def ran(words: Sequence[str]) -> str:
    """What a tool says. Raises ValueError where it is not installed, Failure when it fails."""
    if not shutil.which(words[0]):
        raise ValueError(f"{words[0]}: not installed; scripts/tools.sh verilog does it")
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise Failure(f"{words[0]}: {said[-1] if said else 'failed'}")
    return done.stdout


def inverters(count: int, name: str, pin: str, out: str) -> str:
    """A chain of inverters that drive four each."""
    body, outputs = [], ["y"]
    for i in range(count):
        taken, given = f"n{i - 1}" if i else "a", f"n{i}" if i < count - 1 else "y"
        body.append(f"  {name} g{i} ( .{pin}({taken}), .{out}({given}) );")
        for k in range(3 if i < count - 1 else 0):
            outputs.append(f"d{i}_{k}")
            body.append(f"  {name} l{i}_{k} ( .{pin}({given}), .{out}(d{i}_{k}) );")
    wires = ", ".join(f"n{i}" for i in range(count - 1))
    head = f"module chain ( a, {', '.join(outputs)} );\n  input a;\n"
    return (
        f"{head}  output {', '.join(outputs)};\n  wire {wires};\n"
        + "\n".join(body)
        + "\nendmodule\n"
    )


def fo4_ps(cells: pathlib.Path, folder: pathlib.Path, inverter: str, cell: str) -> float:
    """By the timing that paths are measured with: of ten inverters more in a chain, one."""
    pins = {
        one_word(r'direction\s*:\s*"?(\w+)', body, f"direction of {inverter}"): name
        for name, body in re.findall(
            r'\bpin\s*\(\s*"?(\w+)"?\s*\)\s*\{(.*?direction\s*:\s*"?\w+)', cell, re.DOTALL
        )
    }
    delays = []
    for count in (10, 20):
        chain = folder / f"chain_{count}.v"
        chain.write_text(inverters(count, inverter, pins["input"], pins["output"]))
        said = ran(["yosys-abc", "-q", f"read_lib {cells}; read_verilog -m {chain}; topo; stime"])
        delays.append(float(one_word(DELAY.pattern, said, f"delay of {chain.name}")))
    return (delays[1] - delays[0]) / 10


def read_library(path: pathlib.Path, folder: pathlib.Path) -> Library:
    """Raises ValueError for what is none, Failure, OSError."""
    text = gzip.decompress(path.read_bytes()).decode() if path.suffix == ".gz" else path.read_text()
    found = {name: text[begin:end] for name, begin, end in cells_of(text)}
    for name, begin, end in reversed(list(cells_of(text))):
        if NOT_MAPPED.search(name):
            text = text[:begin] + text[end:]
    name = path.name.partition(".")[0]
    cells = folder / f"{name}.lib"
    cells.write_text(text)

    def smallest(pattern: str, what: str, group: str = "") -> str:
        known = [n for n in found if re.search(pattern, n) and re.search(group, found[n])]
        if not known:
            raise ValueError(f"{path}: no {what}, expected a library of cells")
        return min(
            (n for n in known if not NOT_MAPPED.search(n)), key=lambda n: area_of(found[n], n)
        )

    nand2 = smallest(r"(?i)(^|_)nand2_?x?\d+$", "NAND2")
    inverter = smallest(r"(?i)(^|_)inv_?x?1$", "inverter")
    register = smallest(r"(?i)(^|_)df", "flip-flop", r"\bff\s*\(")
    return Library(
        name,
        cells,
        area_of(found[nand2], nand2),
        area_of(found[register], register),
        fo4_ps(cells, folder, inverter, found[inverter]),
        float(one_word(r"\bnom_voltage\s*:\s*\"?([\d.]+)", text, f"voltage of {path}")),
        {name: cell for name in found if (cell := switching.cell_of(found[name]))},
        switching.register_of(found[register]),
    )


def in_gates(module: Module, folder: pathlib.Path) -> pathlib.Path:
    """Its logic in gates of no library. Raises ValueError, Failure."""
    sources = " ".join(str(path) for path in sorted(VERILOG.glob("*.v")))
    parameters = "".join(f"chparam -set {p} {module.top}; " for p in module.parameters)
    gates = folder / f"{module.name.replace(' ', '_').replace('^', '')}.il"
    steps = f"synth -flatten -top {module.top}; dfflegalize -cell $_DFF_P_ x; write_rtlil {gates}"
    ran(["yosys", "-p", f"read_verilog {sources}; {parameters}{steps}"])
    return gates


def mapped_to(
    library: Library, module: Module, gates: pathlib.Path, mapping: str, folder: pathlib.Path
) -> Mapped:
    """Raises ValueError, Failure."""
    script, netlist = folder / "mapping.abc", folder / "netlist.json"
    script.write_text(MAPPINGS[mapping] + "\n")
    steps = f"abc -liberty {library.path} -script {script}; write_json {netlist}"
    said = ran(["yosys", "-p", f"read_rtlil {gates}; {steps}; stat -liberty {library.path}"])
    delays = DELAY.findall(said)
    counted = said.rpartition("Number of cells:")[2]
    cells = dict(re.findall(r"^ +(\S+) +(\d+)$", counted, re.MULTILINE))
    registers = int(cells.get("$_DFF_P_", 0))
    if unknown := [name for name in cells if name.startswith("$") and name != "$_DFF_P_"]:
        raise Failure(f"{module.name}: cells {' '.join(unknown)} were not mapped")
    logic = re.findall(r"Chip area for module .*: ([\d.]+)", counted)
    um2 = (float(logic[-1]) if logic else 0.0) + registers * library.register_um2
    fo4 = float(delays[-1]) / library.fo4_ps if delays else 0.0
    pj = switched(library, json.loads(netlist.read_text())["modules"])
    return Mapped(
        library.name,
        module,
        mapping,
        um2 / library.nand2_um2,
        registers,
        fo4,
        um2,
        pj,
        (library.at_node(pj[0]), library.at_node(pj[1])),
    )


def random_word(bits: int) -> int:
    """A number not far from 1 in single or half precision, else any bits."""
    word = random.getrandbits(bits)
    if bits == 32:
        return word & 0x807FFFFF | random.randint(120, 134) << 23
    return word & 0x83FF | random.randint(11, 19) << 10 if bits == 16 else word


def switched(library: Library, modules: dict) -> tuple[float, float]:
    """pJ a cycle of random operands, settled and with glitches; lanes round their products."""
    (module,) = (each for each in modules.values() if each["cells"])
    netlist = switching.netlist_of(module, library.cells, library.register)
    random.seed(1)
    inputs: dict[switching.Bit, int] = {}
    for name, port in module["ports"].items():
        if port["direction"] == "input":
            held = name in ("clock", "unrounded")
            words = [0 if held else random_word(len(port["bits"])) for _ in range(CYCLES)]
            for at, bit in enumerate(port["bits"]):
                inputs[bit] = sum((word >> at & 1) << cycle for cycle, word in enumerate(words))
    values = netlist.values(inputs, CYCLES)
    settled, glitching = (
        netlist.pj_a_cycle(netlist.changes(values, CYCLES, glitches), CYCLES, library.volts)
        for glitches in (False, True)
    )
    return settled, glitching


def charged(module: Module, unit: str) -> list[float]:
    """mm2 or pj in the ledger: low, middle, high."""
    constant = json.loads(TECHNOLOGY.read_text())["parts"][module.charged][unit]
    return [constant[of] * module.times for of in CHARGED]


def node_row(module: Module, mapped: Sequence[Mapped]) -> tuple:
    """Beside the ledger. mapped: of this module."""
    nand2 = [each.nand2 for each in mapped]
    depth = [each.fo4 for each in mapped if each.mapping == "fast"]
    times = [
        (fo4 + REGISTER_FO4) * ps_nm * NODE_NM / 1e3
        for fo4, ps_nm in zip((min(depth), max(depth)), FO4_PS_NM)
    ]
    count = {"low": min(nand2), "middle": statistics.geometric_mean(nand2), "high": max(nand2)}
    return (
        module.name,
        mapped[0].register_bits,
        min(nand2),
        max(nand2),
        min(depth),
        max(depth),
        *times,
        *(count[of] * NAND2_UM2 / FILLED[of] for of in CHARGED),
        f"{module.times} x {module.charged}",
        *(mm2 * 1e6 for mm2 in charged(module, "mm2")),
        *(of(each.node_pj[at] for each in mapped) for at in (0, 1) for of in (min, max)),
        *charged(module, "pj"),
    )


def default_libraries() -> list[pathlib.Path]:
    found = sorted((shared_folder() / "liberty").glob("*.lib*"))
    return ([OSU018] if OSU018.exists() else []) + found


def add_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "libraries",
        nargs="*",
        type=pathlib.Path,
        metavar="LIBRARY",
        help=".lib, .lib.gz; see above",
    )
    to.add_argument(
        "--modules",
        nargs="+",
        choices=sorted({m.top for m in MODULES}),
        default=[],
        help="tops; without: all",
    )


def make(arguments: argparse.Namespace) -> None:
    paths = arguments.libraries or default_libraries()
    if not paths:
        raise ValueError("no library of cells; scripts/tools.sh verilog installs osu018")
    chosen = [m for m in MODULES if not arguments.modules or m.top in arguments.modules]
    mapped = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        libraries = [read_library(path, folder) for path in paths]
        logic = {module: in_gates(module, folder) for module in chosen}
        for library, (module, gates), mapping in itertools.product(
            libraries, logic.items(), MAPPINGS
        ):
            mapped.append(mapped_to(library, module, gates, mapping, folder))
    by = Made(
        run_arguments.command_line(),
        (),
        (),
        tables.tree_digest(VERILOG),
        {path.name: tables.tree_digest(path) for path in paths},
    )
    tables.write(arguments.out, "synthesis", by, COLUMNS, [each.row() for each in mapped])
    rows = [node_row(module, [m for m in mapped if m.module == module]) for module in chosen]
    tables.write(arguments.out, "synthesis_32nm", by, NODE_COLUMNS, rows, ABOUT)
