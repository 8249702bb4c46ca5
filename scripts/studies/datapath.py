"""Studies of datapaths: numerical error of each formula, and gates of the Verilog."""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import json
import math
import pathlib
import re
import statistics
import tempfile
from collections.abc import Sequence

import tables
from runs import run_arguments
from runs.scenes import BINARY, REPOSITORY, Failure, answered, program_provenance, shared_folder
from studies.gates import DELAY, NODE_NM, Library, ran, read_library, switched
from tables import Column, Study

STABILITY = BINARY.with_name("stability")

KINDS = (
    Column("formula", "what is computed of a Gaussian"),
    Column("form", "how it is written"),
    Column("in", "arithmetic"),
)
STABILITY_COLUMNS = (
    *KINDS,
    Column("over", "axis of the sweep, from its first place to its last"),
    Column("largest error", "of the places before it breaks", "as in the next column", ".1e"),
    Column("error of", "what the error is relative to or measured in"),
    Column("proven at most", "bound of that error; empty: nothing is proven", "", ".1e"),
    Column("by analysis", "law that the error follows"),
    Column("breaks at", "place from which on it is wrong altogether"),
    Column("what breaks, why, what to do", "in words"),
)
PLACE_COLUMNS = (
    *KINDS,
    Column("axis", "what makes it hard"),
    Column("unit", "of the error"),
    Column("place", "on the axis"),
    Column("error", "largest of the samples"),
    Column("bound", "that is proven"),
    Column("error over bound", "largest of the samples"),
    Column("law", "what the analysis says"),
)


def place_text(place: float) -> str:
    """A power of ten as such."""
    power = round(math.log10(place)) if place > 0 else 0
    if place > 0 and (power > 3 or power < -2) and math.isclose(place, 10.0**power):
        return f"10^{power}"
    return f"{place:.4g}"


def before_it_breaks(study: dict) -> Sequence[dict]:
    """The places of a sweep at which it is whole; the first where it never is."""
    places = study["places"]
    whole = [p["place"] for p in places].index(study["breaks_at"]) if broken(study) else len(places)
    return places[: max(whole, 1)]


def broken(study: dict) -> bool:
    return study["breaks_at"] is not None


def kind(study: dict) -> tuple:
    return (study["formula"], study["form"], study["arithmetic"])


def stability_row(study: dict) -> tuple:
    worst = max(before_it_breaks(study), key=lambda place: place["error"] or 0)
    first, last = study["places"][0]["place"], study["places"][-1]["place"]
    return (
        *kind(study),
        f"{study['axis']} {place_text(first)} .. {place_text(last)}",
        worst["error"],
        study["unit"],
        worst["bound"],
        study["law"],
        place_text(study["breaks_at"]) if broken(study) else "nowhere",
        study["why"],
    )


def place_rows(study: dict) -> list[tuple]:
    measured = ("place", "error", "bound", "error_over_bound", "law")
    return [
        (*kind(study), study["axis"], study["unit"], *(place[key] for key in measured))
        for place in study["places"]
    ]


def measured_stability(program: pathlib.Path, samples: int, seed: int) -> list[dict]:
    """Its studies. Raises ValueError when the program refuses or is another one, Failure
    when it fails."""
    out = answered(program, f"--samples={samples}", ["--seed", str(seed)], program.name)
    try:
        return json.loads(out)["studies"]
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{program}: got no studies, expected those of `stability`") from error


def add_stability_arguments(to: run_arguments.Parser) -> None:
    to.add_argument(
        "--stability", type=pathlib.Path, default=STABILITY, metavar="PROGRAM", help="that measures"
    )
    to.add_argument("--samples", type=int, default=300, help="random cases at each place")
    to.add_argument("--seed", type=int, default=1, help="of the random cases")


def make_stability_table(arguments: argparse.Namespace) -> None:
    studies = measured_stability(arguments.stability, arguments.samples, arguments.seed)
    by = tables.made(arguments.stability, [program_provenance(arguments.stability)])
    tables.write(arguments.out, "stability", by, STABILITY_COLUMNS, map(stability_row, studies))
    rows = [row for study in studies for row in place_rows(study)]
    tables.save(arguments.out, "stability_places", by, PLACE_COLUMNS, rows)


STABILITY_TABLE = Study(
    "stability_table",
    """How far off every formula of one Gaussian is in float and in half, as the units compute it, beside
100 decimal digits: the program `stability` measured, each row swept along what makes it hard. Makes stability, a line a sweep, and stability_places, with
every place of every sweep.
""",
    ("results.py stability_table",),
    add_stability_arguments,
    make_stability_table,
)


VERILOG = REPOSITORY / "modules" / "datapath" / "rtl"
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
# Mappers' scripts. The large one of Yosys saves area; the other one time, then area that is left.
SMALL = (
    "strash; ifraig; scorr; dc2; dretime; strash; &get -n; &nf; &put; buffer -c; topo; upsize; "
    "dnsize; stime"
)
FAST = "strash; ifraig; scorr; dch -f; map -B 0.9; topo; buffer -c; topo; upsize; dnsize; stime"
MAPPINGS = {"small": SMALL, "fast": FAST}


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
NODE_ABOUT = (
    "Area at 32 nm: NAND2 equivalents by 0.40 um2, a NAND2 of NanGate's 45 nm library x (32/45)^2. "
    "Low: the least number, cells alone. High: the most, at 65 % of the area they stand in. "
    "Middle: the geometric mean of all, at 75 %. "
    "A FO4 at 32 nm is 11.5 ps, slow 16 ps; a register takes 5. "
    "Energy: the library's x 32 nm over its gates' length x the square of 0.9 V over its voltage. "
    "Operands are new and random in every cycle. No wires, no layout, no clock."
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
        return (self.library, self.module.name, self.mapping, *sizes, *self.pj)


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
    program = arguments.streaminggs
    by = tables.made(program, [program_provenance(program)], [VERILOG, *paths])
    tables.write(arguments.out, "synthesis", by, SYNTHESIS_COLUMNS, [each.row() for each in mapped])
    rows = [node_row(module, [m for m in mapped if m.module == module]) for module in chosen]
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
