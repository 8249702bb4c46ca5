"""Libraries of cells, and the energy of netlists of their cells: how often nets switch under random
operands, in many runs at once (the bits of a Python integer are runs), and what the library says of
a change."""

from __future__ import annotations

import dataclasses
import graphlib
import gzip
import math
import pathlib
import random
import re
import shutil
import statistics
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

from runs.scenes import Failure

Bit = int | str  # of a netlist: a net's number, or the constant 0, 1, x
Values = dict[Bit, int]


@dataclasses.dataclass(frozen=True)
class Cell:
    """pj: within it, of a change of its output."""

    output: str
    function: Callable[[Mapping[str, int]], int]
    capacitance_pf: Mapping[str, float]  # of its inputs
    pj: float


@dataclasses.dataclass(frozen=True)
class Gate:
    """name: of what it drives."""

    cell: Cell
    inputs: Mapping[str, Bit]
    output: Bit


def group_of(text: str, begin: int) -> str:
    """What stands in the braces that open from `begin` on."""
    depth, start = 0, text.index("{", begin)
    for at in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[start + 1 : at]
    return text[start + 1 :]


def groups(text: str, kind: str) -> list[tuple[str, str]]:
    """Name and content of each group of a kind, as pin(A) { ... }."""
    heads = re.finditer(rf'\b{kind}\s*\(\s*"?(\w*)"?\s*\)\s*\{{', text)
    return [(head.group(1), group_of(text, head.end() - 1)) for head in heads]


def function_of(text: str) -> Callable[[Mapping[str, int]], int]:
    """Of a library's expression: ! or ' is not; * & or nothing is and; + | is or."""
    text = re.sub(r"(\w+|\([^()]*\))\s*'", r"!\1", text.strip().strip('"'))
    tokens = re.findall(r"\w+|[!*&+|^()]", text)
    code, ended = [], False  # ended: a value stands before
    for token in tokens:
        begins = token not in "*&+|^)"
        if ended and begins:
            code.append("&")
        is_name = token[0].isalnum() or token[0] == "_"
        named = f"of[{token!r}]" if not token.isdigit() else str(-int(token))
        code.append(named if is_name else {"!": "~", "*": "&", "+": "|"}.get(token, token))
        ended = is_name or token == ")"
    return eval(f"lambda of: {' '.join(code)}")  # the tokens are names and operators alone


def cell_of(text: str) -> Cell | None:
    """Of a cell's group; None for one without a function of its inputs, as a register."""
    inputs, outputs = {}, []
    for name, pin in groups(text, "pin"):
        found = re.search(r'(?<!\w)function\s*:\s*"([^"]*)"', pin)
        if found:
            outputs.append((name, found.group(1), pin))
        elif capacitance := re.search(r"(?<!\w)capacitance\s*:\s*\"?([\d.eE+-]+)", pin):
            inputs[name] = float(capacitance.group(1))
    if len(outputs) != 1 or re.search(r"\b(ff|latch)\s*\(", text):
        return None
    name, function, pin = outputs[0]
    return Cell(name, function_of(function), inputs, pj_of_change(pin))


@dataclasses.dataclass(frozen=True)
class ClockPin:
    """Of a register or of a clock gate. pj: within the cell, of both edges of a cycle."""

    pf: float
    pj: float


def clock_pin_of(text: str) -> ClockPin:
    """Raises ValueError where the cell has none."""
    pin = next((pin for name, pin in groups(text, "pin") if name == "CLK"), "")
    pf = one_word(r"(?<!\w)capacitance\s*:\s*\"?([\d.eE+-]+)", pin, "capacitance of CLK")
    return ClockPin(float(pf), 2 * pj_of_change(pin))


def register_of(text: str) -> Cell:
    """Of a flip-flop's group: what its first output and its data take; its clock is left out."""
    pins = groups(text, "pin")
    output, pin = next((n, p) for n, p in pins if re.search(r'direction\s*:\s*"?output', p))
    data = next(p for n, p in pins if n == "D")
    capacitance = re.search(r"(?<!\w)capacitance\s*:\s*\"?([\d.eE+-]+)", data)
    loads = {"D": float(capacitance.group(1)) if capacitance else 0.0}
    return Cell(output, lambda of: of["D"], loads, pj_of_change(pin))


def pj_of_change(pin: str) -> float:
    """The median of what its tables have for rising and falling, over loads and slopes."""
    numbers = []
    for _, power in groups(pin, "internal_power"):
        for values in re.findall(r"\bvalues\s*\((.*?)\)\s*;", power, re.DOTALL):
            numbers += [float(n) for n in re.findall(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?", values)]
    return statistics.median(numbers) if numbers else 0.0


@dataclasses.dataclass(frozen=True)
class Netlist:
    gates: Sequence[Gate]  # each behind those that drive it
    registers: Mapping[Bit, Bit]  # by output: input
    register: Cell
    load_pf: Mapping[Bit, float]
    fed: Mapping[Bit, Sequence[Gate]]  # by what drives them

    def settled(self, sources: Mapping[Bit, int], runs: int) -> Values:
        """Of all nets in a cycle. sources: of inputs and registers."""
        every = (1 << runs) - 1
        values: Values = {"0": 0, "1": every, "x": 0, **sources}
        for gate in self.gates:
            of = {pin: values[bit] for pin, bit in gate.inputs.items()}
            values[gate.output] = gate.cell.function(of) & every
        return values

    def changes(
        self, inputs: Callable[[int], Mapping[Bit, int]], runs: int, first: int, past: int
    ) -> tuple[Counter[Bit], Counter[Bit]]:
        """How often each net changes on the way into the cycles from first on: with gates that take
        no time, and with gates that all take the same. Registers begin with 0."""
        settled: Counter[Bit] = Counter()
        glitching: Counter[Bit] = Counter()
        held = dict.fromkeys(self.registers, 0)
        now: Values = {}
        for cycle in range(past):
            sources = {**inputs(cycle), **held}
            before = now
            if cycle < first:
                now = self.settled(sources, runs)
            else:
                now = self.glitches(before, sources, runs, glitching)
                for bit, value in now.items():
                    settled[bit] += (value ^ before[bit]).bit_count()
            held = {output: now[source] for output, source in self.registers.items()}
        return settled, glitching

    def glitches(
        self, before: Values, sources: Mapping[Bit, int], runs: int, counts: Counter[Bit]
    ) -> Values:
        """Of all nets at the end, each change on the way added to counts. before: in the cycle
        before."""
        every = (1 << runs) - 1
        now = {**before, **sources}
        changed = [bit for bit, value in sources.items() if value != before[bit]]
        for bit in changed:
            counts[bit] += (now[bit] ^ before[bit]).bit_count()
        while changed:
            new = {}
            for gate in {g.output: g for bit in changed for g in self.fed.get(bit, ())}.values():
                of = {pin: now[bit] for pin, bit in gate.inputs.items()}
                value = gate.cell.function(of) & every
                if value != now[gate.output]:
                    counts[gate.output] += (value ^ now[gate.output]).bit_count()
                    new[gate.output] = value
            now |= new
            changed = list(new)
        return now

    def pj_a_cycle(self, changes: Mapping[Bit, int], cycles: int, volts: float) -> float:
        """Within gates, and of the inputs that nets drive; of wires and clocks nothing. cycles: of
        all runs."""
        nets = sum(
            count * self.load_pf.get(bit, 0.0) * volts * volts / 2 for bit, count in changes.items()
        )
        within = sum(changes[gate.output] * gate.cell.pj for gate in self.gates)
        held = sum(changes[output] * self.register.pj for output in self.registers)
        return (nets + within + held) / cycles


def netlist_of(module: Mapping, cells: Mapping[str, Cell], register: Cell) -> Netlist:
    """Of a module as Yosys writes it in JSON. Registers are $_DFF_P_."""
    gates, registers, load = [], {}, {}
    for each in module["cells"].values():
        pins = {pin: bits[0] for pin, bits in each["connections"].items()}
        if each["type"] == "$_DFF_P_":
            registers[pins["Q"]] = pins["D"]
            load[pins["D"]] = load.get(pins["D"], 0.0) + register.capacitance_pf["D"]
            continue
        cell = cells[each["type"]]
        inputs = {pin: bit for pin, bit in pins.items() if pin != cell.output}
        gates.append(Gate(cell, inputs, pins[cell.output]))
        for pin, bit in inputs.items():
            load[bit] = load.get(bit, 0.0) + cell.capacitance_pf[pin]
    fed: dict[Bit, list[Gate]] = {}
    for gate in gates:
        for bit in set(gate.inputs.values()):
            fed.setdefault(bit, []).append(gate)
    return Netlist(in_order(gates), registers, register, load, fed)


def in_order(gates: Sequence[Gate]) -> list[Gate]:
    """Each behind those that drive it."""
    drivers = {gate.output: gate for gate in gates}
    graph = {gate.output: [bit for bit in gate.inputs.values() if bit in drivers] for gate in gates}
    return [drivers[bit] for bit in graphlib.TopologicalSorter(graph).static_order()]


FIXED = ("clock", "reset", "unrounded", "phase")  # inputs that are not random
STANDING = ("words",)  # those that are random and stay: registers that wait to be chosen

NODE_NM = 32

# Energy goes with the gates' length and the square of the voltage.
NODE_VOLTS = 0.9
NODES_NM = {"osu018": 180, "sg13g2": 130, "sky130": 130, "nangate45": 45}
# Of random operands: runs side by side, and cycles of each, of which the first fill pipelines.
RUNS, FILLING, COUNTED = 200, 48, 6

# Wire, pF a um, alike in all nodes (Ho, Mai, Horowitz, Proc. IEEE 2001). Registers are a quarter of
# the logic's area, of which cells fill three quarters: so far apart they stand.
WIRE_PF_UM = 0.2e-3
LOGIC_OF_REGISTERS = 4 / 0.75
# A tree of buffers that each drive four times what they take: they take a quarter of their load,
# a sixteenth and so on, and move as much in themselves.
TREE_OF_LOAD = 1 + 2 / 3
# Bits of a word, whose registers one gate gives the clock.
GATED_BITS = 32

# Cells that a mapper is not to choose: for power domains, clocks, delays, scan and layout.
NOT_MAPPED = re.compile(r"lpflow|clk|dly|probe|sighold|antenna|decap|fill|spare|l?gcp|_s?edf|_sdf")
DELAY = re.compile(r"Delay = *([\d.]+) ps")


@dataclasses.dataclass(frozen=True)
class Library:
    """path: its cells without those that are not to be mapped."""

    name: str
    path: pathlib.Path
    nand2_um2: float
    register_um2: float
    fo4_ps: float
    volts: float
    cells: dict[str, Cell]
    register: Cell
    register_clock: ClockPin
    gate_um2: float | None  # of its smallest clock gate; None: it has none
    gate_clock: ClockPin | None

    def clock_pj(self, pin: ClockPin, bits: int) -> float:
        """A cycle of a pin, its wire and its part of the tree, where one pin stands for so many
        register bits."""
        wire_um = math.sqrt(bits * LOGIC_OF_REGISTERS * self.register_um2)
        load_pf = pin.pf + WIRE_PF_UM * wire_um
        return pin.pj + load_pf * TREE_OF_LOAD * self.volts**2

    def at_node(self, pj: float) -> float:
        """At 32 nm. Raises ValueError where the library's node is not known."""
        for part, nm in NODES_NM.items():
            if part in self.name.lower():
                return pj * NODE_NM / nm * (NODE_VOLTS / self.volts) ** 2
        raise ValueError(f"{self.name}: node unknown, expected one of {', '.join(NODES_NM)}")


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

    def gate_of() -> tuple[float, ClockPin] | tuple[None, None]:
        gating = r'clock_gating_integrated_cell\s*:\s*"?latch_posedge"?\s*;'
        known = [name for name, cell in found.items() if re.search(gating, cell)]
        if not known:
            return None, None
        gate = min(known, key=lambda n: area_of(found[n], n))
        return area_of(found[gate], gate), clock_pin_of(found[gate])

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
        {name: cell for name in found if (cell := cell_of(found[name]))},
        register_of(found[register]),
        clock_pin_of(found[register]),
        *gate_of(),
    )


def random_word(bits: int) -> int:
    """A number not far from 1 in single or half precision, else any bits."""
    word = random.getrandbits(bits)
    if bits == 32:
        return word & 0x807FFFFF | random.randint(120, 134) << 23
    return word & 0x83FF | random.randint(11, 19) << 10 if bits == 16 else word


def random_words(bits: int) -> list[int]:
    """For each run."""
    return [random_word(bits) for _ in range(RUNS)]


def switched(library: Library, modules: dict, interval: int) -> tuple[float, float]:
    """pJ a cycle of random operands, settled and with glitches; lanes round their products. An
    input `phase` counts the cycles of an interval."""
    (module,) = (each for each in modules.values() if each["cells"])
    netlist = netlist_of(module, library.cells, library.register)
    random.seed(1)
    ports = [(n, p["bits"]) for n, p in module["ports"].items() if p["direction"] == "input"]
    standing = {n: random_words(len(bits)) for n, bits in ports if n in STANDING}

    def inputs(cycle: int) -> Values:
        values: Values = {}
        for name, bits in ports:
            if name in FIXED:
                words = [cycle % interval if name == "phase" else 0] * RUNS
            else:
                words = standing.get(name) or random_words(len(bits))
            for at, bit in enumerate(bits):
                values[bit] = sum((word >> at & 1) << run for run, word in enumerate(words))
        return values

    changes = netlist.changes(inputs, RUNS, FILLING, FILLING + COUNTED)
    settled, glitching = (
        netlist.pj_a_cycle(each, COUNTED * RUNS, library.volts) for each in changes
    )
    return settled, glitching
