"""Energy of a netlist of library cells: how often its nets switch under random operands, in all
cycles at once (the bits of a Python integer are cycles), and what the library says of a change."""

from __future__ import annotations

import dataclasses
import re
import statistics
from collections.abc import Callable, Mapping, Sequence

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
