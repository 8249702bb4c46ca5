"""The Verilog in gates, and the constants that follow."""

import dataclasses
import json
import pathlib
import shutil
import tempfile
import unittest

from in_folder import nightly  # isort: skip (finds the scripts)
import tables
from runs.scenes import REPOSITORY
from studies import gates, synthesis, verilog

HAS_GATES = shutil.which("yosys") and synthesis.OSU018.exists()
TABLES = REPOSITORY / "traces" / "results"


class Synthesis(unittest.TestCase):
    CELLS = """library(of) {
  cell (NAND2X1) { area : 2; pin(Y) { function : "(!(A B))"; timing() { } } }
  cell ("clkinv_1") {
    area : 1;
  }
}
"""
    STAGE = next(module for module in verilog.MODULES if module.top == "stage")
    ADDER = next(module for module in verilog.MODULES if module.name == "adder")

    def test_cells_of_a_library(self):
        found = {name: self.CELLS[a:b] for name, a, b in gates.cells_of(self.CELLS)}
        self.assertEqual(list(found), ["NAND2X1", "clkinv_1"])
        self.assertEqual(gates.area_of(found["NAND2X1"], "NAND2X1"), 2)
        self.assertNotIn("clkinv_1", found["NAND2X1"])

    def test_gates_switch(self):
        """x = not (a b), y = x or a but not both, held in a register: nets' values and changes by hand."""
        nand = gates.cell_of(
            "pin(A) { capacitance : 1; } pin(B) { capacitance : 1; } "
            'pin(Y) { function : "(A B)\'"; internal_power() { values ("2, 2"); } }'
        )
        either = gates.cell_of(
            'pin(A) { capacitance : 1; } pin(B) { capacitance : 1; } pin(Y) { function : "A^B"; }'
        )
        register = gates.register_of(
            "ff (IQ) { } pin(D) { direction : input; capacitance : 4; } pin(Q) { direction : output; }"
        )

        def gate(kind: str, **pins: int) -> dict:
            return {"type": kind, "connections": {pin: [bit] for pin, bit in pins.items()}}

        cells = {
            "one": gate("XOR", A=4, B=1, Y=5),
            "nand": gate("NAND", A=1, B=2, Y=4),
            "held": gate("$_DFF_P_", D=5, Q=6, C=3),
        }
        netlist = gates.netlist_of({"cells": cells}, {"NAND": nand, "XOR": either}, register)
        values = netlist.settled({1: 0b0110, 2: 0b1010, 3: 0, 6: 0}, 4)
        self.assertEqual((values[4], values[5]), (0b1101, 0b1011))

        def inputs(cycle: int) -> dict:
            return {1: 0b0110 >> cycle & 1, 2: 0b1010 >> cycle & 1, 3: 0}

        settled, glitching = netlist.changes(inputs, 1, 1, 4)
        self.assertEqual([settled[bit] for bit in (1, 2, 4, 5, 6)], [2, 3, 2, 2, 2])
        # At first a rises before x falls, and y falls for a while.
        self.assertEqual([glitching[bit] for bit in (1, 2, 4, 5, 6)], [2, 3, 2, 4, 2])
        # a drives two inputs, b and x one, y the register; a change of x takes 2 pJ within.
        self.assertAlmostEqual(
            netlist.pj_a_cycle(settled, 3, 1.0), (2 * 2 + 3 + 2 + 4 * 2) / 2 / 3 + 2 * 2 / 3
        )
        # A register that takes itself: it turns in each cycle in which a is set.
        turns = {"one": gate("XOR", A=6, B=1, Y=5), "held": gate("$_DFF_P_", D=5, Q=6, C=3)}
        netlist = gates.netlist_of({"cells": turns}, {"XOR": either}, register)
        self.assertEqual(netlist.changes(inputs, 1, 1, 4)[0][6], 2)

    def test_the_clock_of_registers_and_of_gates(self):
        pin = gates.clock_pin_of(
            'pin(CLK) { capacitance : 0.002; internal_power() { values ("3, 3"); } }'
        )
        self.assertEqual((pin.pf, pin.pj), (0.002, 6))
        with self.assertRaisesRegex(ValueError, "capacitance of CLK: not found"):
            gates.clock_pin_of("pin(D) { capacitance : 0.002; }")
        gate = gates.ClockPin(0.004, 1)
        names = ("a", pathlib.Path(), 1.0, 3.0, 1.0, 2.0, {}, None, pin)
        library = gates.Library(*names, 9.0, gate)
        # A register stands in 3 x 4 / 0.75 um2, 4 um apart: 0.0008 pF of wire to each.
        self.assertAlmostEqual(library.clock_pj(pin, 1), 6 + (0.002 + 0.0008) * 4 * 5 / 3)
        self.assertAlmostEqual(library.clock_pj(gate, 4), 1 + (0.004 + 0.0016) * 4 * 5 / 3)
        register, gated = (
            synthesis.of_clock(dataclasses.replace(library, name="osu018"))[at] for at in (0, -1)
        )
        self.assertEqual((register.module, register.um2), (verilog.REGISTER_CLOCK, 0))
        self.assertEqual((gated.module, gated.um2), (verilog.CLOCK_GATE, 9))
        # A library without a gate says what its registers take.
        without = gates.Library("osu018", *names[1:], None, None)
        self.assertEqual(
            {each.module for each in synthesis.of_clock(without)}, {verilog.REGISTER_CLOCK}
        )

    def test_a_library_without_a_nand_is_refused(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "of.lib"
            path.write_text(self.CELLS.replace("NAND2X1", "NOR2X1"))
            with self.assertRaisesRegex(ValueError, "of.lib: no NAND2, expected a library of cel"):
                gates.read_library(path, pathlib.Path(name))

    def test_at_32_nm_the_most_depth_is_typical_and_slow(self):
        mapped = [
            synthesis.Mapped("a", self.STAGE, "small", 100, 32, 90, 1, (3, 9), (100, 2 * 100)),
            synthesis.Mapped("a", self.STAGE, "fast", 200, 32, 20, 1, (4, 8), (200, 2 * 200)),
            synthesis.Mapped("b", self.STAGE, "fast", 400, 32, 45, 1, (2, 6), (400, 2 * 400)),
        ]
        charged = synthesis.charged_as(self.STAGE, {})
        name, bits, least, most, *depth_and_area = synthesis.node_row(
            self.STAGE, mapped, mapped, charged
        )
        self.assertEqual((name, bits, least, most), ("32 register bits", 32, 100, 400))
        nand2 = 0.798 * 1024 / 2025
        expected = (20, 45, 50 * 0.01152, 50 * 0.016, 100 * nand2, 80000**0.5 * nand2 / 0.75)
        for got, wanted in zip(depth_and_area, (*expected, 400 * nand2 / 0.65)):
            self.assertAlmostEqual(got, wanted)
        self.assertEqual(depth_and_area[13:17], [100, 400, 200, 800])
        # As much energy as the module whose energy is published, at most as its gates say.
        low, middle, _ = synthesis.priced(verilog.LANE, "published", "pj")
        for got, wanted in zip(depth_and_area[17:20], (low, middle, 200)):
            self.assertAlmostEqual(got, wanted)

    def test_energy_is_so_much_of_the_published_one(self):
        """Settled. Low: the least of libraries. Middle: their geometric mean. High: the most."""

        def mapped(library: str, *pj: float) -> synthesis.Mapped:
            return synthesis.Mapped(library, self.ADDER, "fast", 1, 0, 1, 1, pj, (2 * high, 0))

        low, middle, high = synthesis.priced(verilog.LANE, "published", "pj")
        got = synthesis.pj_of_gates(
            [mapped("a", 1, 30), mapped("b", 8, 5)], [mapped("a", 10, 100), mapped("b", 20, 100)]
        )
        for value, wanted in zip(got, (0.1 * low, 0.2 * middle, 0.4 * 2 * high)):
            self.assertAlmostEqual(value, wanted)
        self.assertEqual(synthesis.pj_of_gates([], []), [None] * 3)

    def test_a_rest_is_what_the_other_parts_leave(self):
        exchange = next(module for module in verilog.MODULES if module.rest == "exchange_bit")
        compares = next(m for m in verilog.MODULES if m.charged == verilog.one("comparator"))

        def mapped(module: verilog.Module, mapping: str, nand2: float, pj: float):
            return synthesis.Mapped("a", module, mapping, nand2, 0, 1, 1, (pj, pj), (1, 1))

        of_all = [
            mapped(module, mapping, factor * nand2, factor * pj)
            for module, nand2, pj in ((exchange, 1000, 7), (compares, 100, 2))
            for mapping, factor in (("small", 1), ("fast", 3))
        ]
        rest = synthesis.rest_of(exchange, of_all, synthesis.alone(of_all))
        self.assertEqual([(m.nand2, m.pj) for m in rest], [(800, (3, 3)), (2400, (9, 9))])
        # Low of all, middle of the fast alone.
        low, middle, _ = synthesis.um2_of_gates(rest)
        self.assertAlmostEqual(middle / low, 3 / 0.75)

    def test_parts_beside_lanes_go_with_the_lanes(self):
        beside = {"adder": {"parts": 24, "operations": 16}}
        datapaths = {"of": {"lanes": 256, "used": {"macs": 190}, "beside": beside}}
        module = dataclasses.replace(self.ADDER, charged="of", lanes=4)
        parts, operations = synthesis.charged_as(module, datapaths)
        self.assertEqual(parts, (("adder", 24 * 4 / 256),))
        self.assertAlmostEqual(operations[0][1], 16 * 4 / 190)

    def test_the_ledger_charges_what_the_gates_say(self):
        """Each row that has gates, by the rule and by the table of what was mapped."""
        every = (*verilog.MODULES, verilog.REGISTER_CLOCK, verilog.CLOCK_GATE)
        modules = {module.name: module for module in every}
        mapped = [
            synthesis.Mapped(
                row["library"],
                modules[row["module"]],
                row["mapped"],
                float(row["NAND2"]),
                int(row["register bits"]),
                float(row["FO4"]),
                float(row["um2"]),
                (float(row["pJ, settled"]), float(row["pJ, with glitches"])),
                (float(row["pJ at 32 nm, settled"]), 0),
            )
            for row in tables.read_rows(TABLES, "synthesis")
        ]
        ledger = json.loads(synthesis.TECHNOLOGY.read_text())["parts"]
        expected = synthesis.constants(mapped)
        self.assertGreater(len(expected), 15)
        for kind, of_unit in expected.items():
            self.assertAlmostEqual(ledger[kind]["register_bits"], of_unit.pop("register_bits"), 6)
            for unit, band in of_unit.items():
                for end, wanted in band.items():
                    got = ledger[kind][unit][end]
                    with self.subTest(kind=kind, unit=unit, end=end):
                        self.assertLessEqual(abs(got - wanted), 1e-5 * wanted)

    @nightly
    @unittest.skipUnless(HAS_GATES, "yosys or osu018 is not installed")
    def test_the_table_is_of_these_sources(self):
        table = tables.read_rows(TABLES, "synthesis")
        wanted = {
            (row["module"], row["mapped"]): row for row in table if "osu018" in row["library"]
        }
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            library = gates.read_library(synthesis.OSU018, folder)
            for module in verilog.MODULES:
                logic = synthesis.in_gates(module, folder)
                for mapping in synthesis.MAPPINGS:
                    row = synthesis.mapped_to(library, module, logic, mapping, folder).row()
                    expected = list(wanted[module.name, mapping].values())
                    self.assertEqual([str(cell) for cell in row], expected)

    @unittest.skipUnless(HAS_GATES, "yosys or osu018 is not installed")
    def test_registers_and_an_adder_in_cells(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            library = gates.read_library(synthesis.OSU018, folder)
            # A flip-flop of this library has four times the area of its NAND2.
            self.assertEqual(library.register_um2, 4 * library.nand2_um2)
            # 0.18 um: 65 to 90 ps by the rule of the study.
            self.assertGreater(library.fo4_ps, 60)
            self.assertLess(library.fo4_ps, 100)
            logic = synthesis.in_gates(self.STAGE, folder)
            registers = synthesis.mapped_to(library, self.STAGE, logic, "small", folder)
            self.assertEqual(
                (registers.register_bits, registers.nand2, registers.fo4), (32, 128, 0)
            )
            # Half of its bits change in a cycle.
            expected = 16 * library.register.pj
            self.assertAlmostEqual(registers.pj[0], registers.pj[1])
            self.assertGreater(registers.pj[0], 0.9 * expected)
            logic = synthesis.in_gates(self.ADDER, folder)
            small, fast = (
                synthesis.mapped_to(library, self.ADDER, logic, mapping, folder)
                for mapping in synthesis.MAPPINGS
            )
            self.assertGreater(small.pj[1], small.pj[0])
            self.assertEqual(small.register_bits, 0)
            self.assertGreater(small.nand2, 32 * 4)
            self.assertLess(fast.fo4, small.fo4)


if __name__ == "__main__":
    unittest.main()
