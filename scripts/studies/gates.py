"""Libraries of cells, and the energy of netlists of their cells: how often nets switch under random
operands, in all cycles at once (the bits of a Python integer are cycles), and what the library says
of a change."""

from __future__ import annotations

import dataclasses
import gzip
import pathlib
import random
import re
import shutil
import statistics
import subprocess
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

    def values(self, inputs: Mapping[Bit, int], cycles: int) -> Values:
        """Of all nets, settled in each cycle. Registers begin with 0."""
        every = (1 << cycles) - 1
        values: Values = {"0": 0, "1": every, "x": 0, **inputs}
        drivers = {gate.output: gate for gate in self.gates}
        # Without loops: each register is reached from the inputs.
        wanted = [*self.registers.values(), *drivers]
        while wanted:
            bit = wanted[-1]
            if bit in values:
                wanted.pop()
                continue
            gate = drivers.get(bit)
            sources = list(gate.inputs.values()) if gate else [self.registers[bit]]
            missing = [source for source in sources if source not in values]
            if missing:
                wanted += missing
            elif gate:
                of = {pin: values[source] for pin, source in gate.inputs.items()}
                values[bit] = gate.cell.function(of) & every
            else:
                values[bit] = values[sources[0]] << 1 & every
        for output, source in self.registers.items():
            values[output] = values[source] << 1 & every
        return values

    def changes(self, values: Values, cycles: int, with_glitches: bool) -> dict[Bit, int]:
        """How often each net changes. with_glitches: every gate takes the same time; without, none
        takes any."""
        between = (1 << cycles - 1) - 1
        if not with_glitches:
            return {bit: ((v ^ v >> 1) & between).bit_count() for bit, v in values.items()}
        driven = {gate.output for gate in self.gates}
        now = {bit: v & between if bit in driven else v >> 1 for bit, v in values.items()}
        counts = {
            bit: ((v ^ v >> 1) & between).bit_count() if bit not in driven else 0
            for bit, v in values.items()
        }
        fed: dict[Bit, list[Gate]] = {}
        for gate in self.gates:
            for bit in set(gate.inputs.values()):
                fed.setdefault(bit, []).append(gate)
        touched = {gate.output: gate for gate in self.gates}
        while touched:
            new = {}
            for output, gate in touched.items():
                of = {pin: now[bit] for pin, bit in gate.inputs.items()}
                value = gate.cell.function(of) & between
                if value != now[output]:
                    counts[output] += (value ^ now[output]).bit_count()
                    new[output] = value
            now |= new
            touched = {g.output: g for bit in new for g in fed.get(bit, ())}
        return counts

    def pj_a_cycle(self, changes: Mapping[Bit, int], cycles: int, volts: float) -> float:
        """Within gates, and of the inputs that nets drive; of wires and clocks nothing."""
        nets = sum(
            count * self.load_pf.get(bit, 0.0) * volts * volts / 2 for bit, count in changes.items()
        )
        within = sum(changes[gate.output] * gate.cell.pj for gate in self.gates)
        held = sum(changes[output] * self.register.pj for output in self.registers)
        return (nets + within + held) / (cycles - 1)


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
    return Netlist(gates, registers, register, load)


NODE_NM = 32

# Energy goes with the gates' length and the square of the voltage.
NODE_VOLTS = 0.9
NODES_NM = {"osu018": 180, "sg13g2": 130, "sky130": 130, "nangate45": 45}
CYCLES = 1000  # of random operands

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
    netlist = netlist_of(module, library.cells, library.register)
    random.seed(1)
    inputs: dict[Bit, int] = {}
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
