"""The study of the Verilog in gates: each module on each library, scaled to the node of the ledger."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import json
import pathlib
import re
import statistics
import tempfile
from collections.abc import Mapping, Sequence

import tables
from runs import run_arguments, simulations
from runs.scenes import REPOSITORY, Failure, find_scene, program_provenance, shared_folder
from studies.gates import DELAY, GATED_BITS, NODE_NM, Library, ran, read_library, switched
from studies.verilog import (
    CLOCK_GATE,
    MERGE,
    MODULES,
    OF_KNOWN_ENERGY,
    REGISTER_CLOCK,
    SELECTION,
    SORTING,
    VERILOG,
    Module,
    Parts,
    one,
)
from tables import Column, Study

TECHNOLOGY = REPOSITORY / "testbench" / "cost" / "technology_32nm.json"
OSU018 = pathlib.Path("/usr/share/qflow/tech/osu018/osu018_stdcells.lib")

# Delay of an inverter that drives four of itself, ps for each nm that gates are long: typical, and
# at low voltage and high temperature (Ho, Mai, Horowitz, "The Future of Wires", Proc. IEEE 2001).
FO4_PS_NM = (0.36, 0.5)
# A register's own delay and set-up, FO4 (medium confidence).
REGISTER_FO4 = 5
# NAND2_X1 of NanGate's open library at 45 nm. The part of the area that cells fill is the ledger's.
NAND2_UM2 = 0.798 * (NODE_NM / 45) ** 2
FILLED = {"low": 1.0, "middle": 0.75, "high": 0.65}
SMALL_SCENE = "builtin:object?n=500"  # datapaths are the machine's, whatever it renders
# Mappers' scripts. The large one of Yosys saves area; the other one time, then area that is left.
SMALL = (
    "strash; ifraig; scorr; dc2; dretime; strash; &get -n; &nf; &put; buffer -c; topo; upsize; "
    "dnsize; stime"
)
FAST = "strash; ifraig; scorr; dch -f; map -B 0.9; topo; buffer -c; topo; upsize; dnsize; stime"
MAPPINGS = {"small": SMALL, "fast": FAST}

MODULE = Column("module", "in modules/datapath/rtl, or in rtl of a unit in modules/streaminggs")
SYNTHESIS_COLUMNS = (
    Column("library", "file of its cells"),
    MODULE,
    Column("mapped", "to be small or to be fast"),
    Column("NAND2", "its area by that of the library's smallest NAND2", "", ",.0f"),
    Column("register bits", "flip-flops", "", ",d"),
    Column("FO4", "logic depth of its slowest stage, by an inverter that drives four", "", ".1f"),
    Column("um2", "cells' area in the library", "um2", ",.0f"),
    Column("pJ, settled", "a cycle of random operands, gates that take no time", "pJ", ".3g"),
    Column("pJ, with glitches", "the same, gates that take the same time", "pJ", ".3g"),
    Column("pJ at 32 nm, settled", "scaled as synthesis_32nm says", "pJ", ".3g"),
)
BAND = ("low", "middle", "high")


def bands(name: str, meaning: str, unit: str, form: str) -> tuple[Column, ...]:
    return tuple(Column(f"{name}, {of}", meaning, unit, form) for of in BAND)


NODE_COLUMNS = (
    MODULE,
    Column("register bits", "flip-flops", "", ",d"),
    Column("NAND2, least", "of all libraries and mappings", "", ",.0f"),
    Column("NAND2, most", "likewise", "", ",.0f"),
    Column("FO4, least", "logic depth of the slowest stage, mapped to be fast", "", ".0f"),
    Column("FO4, most", "likewise", "", ".0f"),
    Column("ns, typical", "the most and a register at 32 nm", "ns", ".2f"),
    Column("ns, slow", "likewise", "ns", ".2f"),
    *bands("um2", "at 32 nm, as the gates say", "um2", ",.0f"),
    Column("charged as", "parts of the ledger"),
    Column("charged um2", "their middle", "um2", ",.0f"),
    Column("published as", "parts with published constants"),
    *bands("published um2", "at 32 nm", "um2", ",.0f"),
    Column("pJ, settled, least", "at 32 nm, of all libraries", "pJ", ".3g"),
    Column("pJ, settled, most", "likewise", "pJ", ".3g"),
    Column("pJ, with glitches, least", "likewise", "pJ", ".3g"),
    Column("pJ, with glitches, most", "likewise", "pJ", ".3g"),
    *bands("pJ", "as so much of the published energy of a lane that chains", "pJ", ".3g"),
    Column("charged pJ", "middle of a cycle with work for all", "pJ", ".3g"),
    *bands("published pJ", "at 32 nm", "pJ", ".3g"),
)
NODE_ABOUT = (
    "Area at 32 nm: NAND2 equivalents by 0.40 um2, a NAND2 of NanGate's 45 nm library x (32/45)^2. "
    "Low: the least number, cells alone. High: the most, at 65 % of the area they stand in. "
    "Middle: the geometric mean of those mapped to be fast, at 75 %. "
    "Time: the most depth; a FO4 at 32 nm is 11.5 ps, slow 16 ps; a register takes 5. "
    "Energy, settled and with glitches: the library's x 32 nm over its gates' length x the square "
    "of 0.9 V over its voltage. Operands are new and random in every cycle, but for the words of a "
    "choice: they stand, and which one is chosen is new. No wires, no layout, no clock, but in the last rows: clock pins with a wire to each and buffers. "
    "pJ, low to high: the published energy of a multiplication and an addition times "
    "what the module takes, settled, over what the lane that only chains takes in the same "
    "library. Low: the least. Middle: the geometric mean. High: the most, over what the libraries' "
    "gates say of that lane, settled at 32 nm: the geometric mean."
)


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
        return (self.library, self.module.name, self.mapping, *sizes, *self.pj, self.node_pj[0])


def sources_of(module: Module) -> list[pathlib.Path]:
    """Of the top and what stands below it: the numbers that Yosys gives to nets, and so the gates,
    follow from all that it reads. A file is named after its module."""
    files = {path.stem: path for path in module.sources}
    found: set[str] = set()
    ahead = [module.top]
    while ahead:
        name = ahead.pop()
        if name in files and name not in found:
            found.add(name)
            ahead += re.findall(r"\w+", re.sub("//.*", "", files[name].read_text()))
    return [files[name] for name in sorted(found)]


def in_gates(module: Module, folder: pathlib.Path) -> pathlib.Path:
    """Its logic in gates of no library; what is counted apart is beyond its ports. Raises
    ValueError, Failure."""
    sources = " ".join(map(str, sources_of(module)))
    set_all = "".join(f"chparam -set {p} {module.top}; " for p in module.parameters)
    black = f"blackbox {' '.join(module.apart)}; " if module.apart else ""
    beyond = "".join(f"expose -evert t:{name}; " for name in module.apart)
    gates = folder / f"{re.sub(r'[^a-z0-9]+', '_', module.name)}.il"
    synthesised = f"synth -flatten -top {module.top}; dfflegalize -cell $_DFF_P_ x; {beyond}"
    steps = f"{set_all}{black}{synthesised}clean; write_rtlil {gates}"
    ran(["yosys", "-p", f"read_verilog {sources}; {steps}"])
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
    pj = switched(library, json.loads(netlist.read_text())["modules"], module.interval)
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


def of_clock(library: Library) -> list[Mapped]:
    """Of a register bit, and of a gate where the library has one; the mapping changes nothing."""
    pins = [(REGISTER_CLOCK, 0.0, library.register_clock, 1)]
    if library.gate_clock:
        pins.append((CLOCK_GATE, library.gate_um2, library.gate_clock, GATED_BITS))
    mapped = []
    for (module, um2, pin, bits), mapping in itertools.product(pins, MAPPINGS):
        pj = library.clock_pj(pin, bits)
        node_pj = library.at_node(pj)
        mapped.append(
            Mapped(
                library.name,
                module,
                mapping,
                um2 / library.nand2_um2,
                0,
                0.0,
                um2,
                (pj, pj),
                (node_pj, node_pj),
            )
        )
    return mapped


def priced(parts: Parts, of: str, unit: str) -> list[float]:
    """mm2 or pJ in the ledger's table, low, middle, high. of: `parts`, `published`."""
    rows = json.loads(TECHNOLOGY.read_text())[of]
    return [sum(rows[kind][unit][end] * times for kind, times in parts) for end in BAND]


def beside_lanes(datapath: dict, lanes: int) -> tuple[Parts, Parts]:
    """What stands beside so many lanes of a datapath of a report, and what it does in a cycle."""
    kinds = datapath["beside"].items()
    of_all, of_item = lanes / datapath["lanes"], lanes / datapath["used"]["macs"]
    return (
        tuple((kind, of["parts"] * of_all) for kind, of in kinds),
        tuple((kind, of["operations"] * of_item) for kind, of in kinds),
    )


def charged_as(module: Module, datapaths: Mapping[str, dict]) -> tuple[Parts, Parts]:
    """Parts of the ledger, and their operations in a cycle. datapaths: of a report."""
    if isinstance(module.charged, str):
        return beside_lanes(datapaths[module.charged], module.lanes)
    return module.charged, module.done or module.charged


def known_pj(known: Sequence[Mapped]) -> list[float]:
    """Of the module of known energy, low, middle, high: as published, at most as its gates say."""
    low, middle, high = priced(one("fp32_lane"), "published", "pj")
    return [low, middle, max(high, statistics.geometric_mean(m.node_pj[0] for m in known))]


def pj_of_gates(mapped: Sequence[Mapped], known: Sequence[Mapped]) -> list[float | None]:
    """Low, middle, high; none without the module of known energy."""
    if not known:
        return [None] * len(BAND)
    settled = {(each.library, each.mapping): each.pj[0] for each in known}
    over = [each.pj[0] / settled[each.library, each.mapping] for each in mapped]
    of_known = (min(over), statistics.geometric_mean(over), max(over))
    return [of * pj for of, pj in zip(of_known, known_pj(known))]


def um2_of_gates(mapped: Sequence[Mapped]) -> list[float]:
    """Low, middle, high; 0 of what takes none. Small mappings are too slow for the middle."""
    nand2 = [each.nand2 for each in mapped]
    if not any(nand2):
        return [0.0] * len(BAND)
    middle = statistics.geometric_mean(each.nand2 for each in mapped if each.mapping == "fast")
    count = {"low": min(nand2), "middle": middle, "high": max(nand2)}
    return [count[of] * NAND2_UM2 / FILLED[of] for of in BAND]


def alone(mapped: Sequence[Mapped]) -> dict[str, tuple[Sequence[Mapped], float]]:
    """By part of the ledger, the first module that is charged as it alone, and how many it is."""
    found: dict[str, tuple[Sequence[Mapped], float]] = {}
    for module in dict.fromkeys(each.module for each in mapped):
        if not isinstance(module.charged, str) and len(module.charged) == 1:
            ((kind, times),) = module.charged
            found.setdefault(kind, ([m for m in mapped if m.module == module], times))
    return found


def rest_of(
    module: Module, mapped: Sequence[Mapped], parts: Mapping[str, tuple[Sequence[Mapped], float]]
) -> list[Mapped]:
    """What the module's other parts leave of it, in each library and mapping."""
    rest = []
    for each in (m for m in mapped if m.module == module):
        for kind, count in module.charged:
            if kind == module.rest:
                continue
            modules, times = parts[kind]
            (part,) = (
                m for m in modules if (m.library, m.mapping) == (each.library, each.mapping)
            )
            of = count / times
            each = dataclasses.replace(
                each,
                nand2=each.nand2 - of * part.nand2,
                register_bits=round(each.register_bits - of * part.register_bits),
                pj=(each.pj[0] - of * part.pj[0], each.pj[1] - of * part.pj[1]),
            )
        rest.append(each)
    return rest


def constants(mapped: Sequence[Mapped]) -> dict[str, dict]:
    """Of the ledger, what gates say: mm2 and pj, low, middle, high, and register bits of each part
    that a module is charged as, alone or as its rest."""
    known = [each for each in mapped if each.module.name == OF_KNOWN_ENERGY]
    parts = alone(mapped)
    rests = {
        module.rest: (rest_of(module, mapped, parts), dict(module.charged)[module.rest])
        for module in dict.fromkeys(each.module for each in mapped)
        if module.rest
    }
    found: dict[str, dict] = {}
    for kind, (of_module, times) in {**parts, **rests}.items():
        mm2 = [um2 / times * 1e-6 for um2 in um2_of_gates(of_module)]
        pj = [energy / times for energy in pj_of_gates(of_module, known)]
        bits = of_module[0].register_bits / times
        of_part = {"mm2": dict(zip(BAND, mm2)), "pj": dict(zip(BAND, pj)), "register_bits": bits}
        found[kind] = of_part
    return found


def in_words(parts: Parts) -> str:
    return ", ".join(
        f"{times:,.{0 if times >= 10 or times == int(times) else 2}f} {kind}"
        for kind, times in parts
    )


def node_row(
    module: Module,
    mapped: Sequence[Mapped],
    known: Sequence[Mapped],
    charged: tuple[Parts, Parts],
) -> tuple:
    """Beside the ledger. mapped, known: of this module, of the one of known energy. charged: parts,
    and their operations in a cycle."""
    nand2 = [each.nand2 for each in mapped]
    depth = [each.fo4 for each in mapped if each.mapping == "fast"]
    times = [(max(depth) + REGISTER_FO4) * ps_nm * NODE_NM / 1e3 for ps_nm in FO4_PS_NM]
    parts, operations = charged

    def published(unit: str, factor: float) -> list[float | None]:
        prices = priced(module.published, "published", unit)
        return [price * factor for price in prices] if module.published else [None] * len(BAND)

    return (
        module.name,
        mapped[0].register_bits,
        min(nand2),
        max(nand2),
        min(depth),
        max(depth),
        *times,
        *um2_of_gates(mapped),
        in_words(parts),
        priced(parts, "parts", "mm2")[1] * 1e6,
        in_words(module.published),
        *published("mm2", 1e6),
        *(of(each.node_pj[at] for each in mapped) for at in (0, 1) for of in (min, max)),
        *pj_of_gates(mapped, known),
        priced(operations, "parts", "pj")[1],
        *published("pj", 1),
    )


def default_libraries() -> list[pathlib.Path]:
    found = sorted((shared_folder() / "liberty").glob("*.lib*"))
    return ([OSU018] if OSU018.exists() else []) + found


def add_synthesis_arguments(to: run_arguments.Parser) -> None:
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
    run_arguments.add_program(to)


def make_synthesis(arguments: argparse.Namespace) -> None:
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
        for library in libraries:
            mapped += of_clock(library)
    program = arguments.streaminggs
    sources = [*VERILOG, *SELECTION, *SORTING, *MERGE, *paths]
    by = tables.made(program, [program_provenance(program)], sources)
    tables.write(arguments.out, "synthesis", by, SYNTHESIS_COLUMNS, [each.row() for each in mapped])
    run = simulations.Run(find_scene(SMALL_SCENE), config="exact")
    datapaths = simulations.simulate(program, run).accepted()[0]["datapath"]
    known = [m for m in mapped if m.module.name == OF_KNOWN_ENERGY]
    rows = [
        node_row(
            module, [m for m in mapped if m.module == module], known, charged_as(module, datapaths)
        )
        for module in (*chosen, REGISTER_CLOCK, CLOCK_GATE)
        if any(m.module == module for m in mapped)
    ]
    tables.write(arguments.out, "synthesis_32nm", by, NODE_COLUMNS, rows, NODE_ABOUT)


SYNTHESIS = Study(
    "synthesis",
    """Gates of the datapaths in Verilog: Yosys and ABC map each module to the cells of open libraries,
once as small and once as fast as they can, and random operands go through its gates. Makes

  synthesis       a line for each library and module
  synthesis_32nm  of each module what all libraries say, scaled to 32 nm, beside what is charged

Libraries: Debian's osu018, and those in the folder liberty of ../shared or $SGS_SHARED. There are
no wires, no layout and no clock tree in it.
""",
    ("results.py synthesis",),
    add_synthesis_arguments,
    make_synthesis,
)
